//! A request for generated code.

use std::borrow::Cow;

use articulated_core::diagnostic::{Diagnostics, Spanned};
use articulated_core::lanes::Real;
use articulated_core::precision::Precision;
use articulated_scene::{BuiltRobot, RobotOptions, RobotRequest, Scene};

use crate::function_groups;
use crate::function_spec::UserFunctions;
use crate::language::Target;
use crate::language::rust::is_name;

/// A robot's document and the options of generation. Macro, build script and command line all fill
/// one of these.
#[derive(Clone, Debug)]
pub struct Request {
    /// The bytes of the robot's file.
    pub document: Vec<u8>,
    /// The file's name, for messages and for the header of the generated file; not opened.
    pub file: String,
    /// The scene whose effects act on the robot, if any. The options already contain its other
    /// entries.
    pub scene: Option<Scene>,
    /// The options.
    pub options: Options,
}

/// The options of a scene, the macro's keys or the command line's flags.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// The robot: its base, its edits, its frames, its effects.
    pub robot: RobotOptions,
    /// The requested functions, each as [`crate::FunctionSpec::parse`] reads it: a name of
    /// [`articulated_core::algorithm::functions`], or `name = first + second(a = 0)`.
    pub functions: Vec<Spanned<String>>,
    /// Functions of the user, which `functions` may name.
    pub users: UserFunctions,
    /// The functions that `motion` in `functions` means: those that the motion of a scene calls;
    /// empty without such a scene.
    pub motion: Vec<String>,
    /// Constants of the model that stay inputs: `payload(link)`, `inertia(link)`, `origin(joint)`,
    /// `gravity`, and numbers of an effect that is on, as `damping(joint)`, `contact(link)`.
    pub parameters: Vec<Spanned<String>>,
    /// Names to use in generated code instead of those made from the robot's names: (name in the
    /// file, name in code).
    pub rename: Vec<Spanned<(String, String)>>,
    /// Compute isomorphic limbs at once, one per lane of a vector, where that is cheaper.
    pub limbs: bool,
    /// Precision of the functions. Batch functions have the precision of their number type.
    pub level: Precision,
    /// Limit of the predicted code size of all functions together, megabytes (10⁶ bytes): see
    /// [`MAX_CODE_SIZE`](crate::MAX_CODE_SIZE), which is the default.
    pub max_code_size: u64,
    /// The types of numbers for which there are functions of many states at once too.
    pub batch: Vec<Real>,
    /// The target language, with its options.
    pub target: Target,
    /// Whether the ledger has counts after each model pass, for which the functions are traced once
    /// more per pass. The code is the same. Build scripts and the macro leave it off.
    pub stages: bool,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            robot: RobotOptions::default(),
            functions: vec!["placements".into(), "inverse_dynamics".into()],
            users: UserFunctions::default(),
            motion: Vec::new(),
            parameters: Vec::new(),
            rename: Vec::new(),
            limbs: true,
            level: Precision::default(),
            max_code_size: crate::MAX_CODE_SIZE,
            batch: Vec::new(),
            target: Target::default(),
            stages: true,
        }
    }
}

impl Options {
    /// Another name in Rust for a joint or link, in place of one that it had.
    pub fn set_name(&mut self, from: &str, to: &str) {
        self.rename.retain(|names| names.0 != from);
        self.rename.push((from.to_owned(), to.to_owned()).into());
    }
}

impl Request {
    /// A request with default options: fixed base, standard gravity, `placements` and
    /// `inverse_dynamics`.
    pub fn new(file: impl Into<String>, document: impl Into<Vec<u8>>) -> Self {
        Self { document: document.into(), file: file.into(), scene: None, options: Options::default() }
    }

    /// The requested robot.
    pub fn robot(&self) -> RobotRequest<'_> {
        let scene = self.scene.as_ref();
        RobotRequest { file: &self.file, document: &self.document, options: &self.options.robot, scene, checks_motion: false }
    }

    /// The requested robot, edited, with its model and effects.
    ///
    /// # Errors
    /// All findings about the document, the edits and the effects, if one of them is an error.
    pub fn build_robot(&self) -> Result<BuiltRobot, Diagnostics> {
        self.robot().build()
    }

    /// Sets frames chosen by a program. Renamings of links outside these frames are then unused,
    /// and are removed without a finding.
    pub fn set_frames(&mut self, frames: &[String]) {
        let unused = if self.options.rename.is_empty() { Vec::new() } else { self.links_without_a_joint() };
        let is_left_out = |(from, to): &(String, String)| is_name(to) && unused.contains(from) && !frames.contains(from);
        self.options.rename.retain(|names| !is_left_out(names));
        self.options.robot.set_frames(frames.iter().cloned());
    }

    /// Links whose name no moving joint has; empty if the robot cannot be built.
    fn links_without_a_joint(&self) -> Vec<String> {
        let Ok(BuiltRobot { model: whole, .. }) = self.build_robot() else { return Vec::new() };
        let is_joint = |name: &String| whole.joints().iter().any(|joint| joint.name == *name);
        whole.frames().iter().map(|frame| frame.name.clone()).filter(|name| !is_joint(name)).collect()
    }

    /// The request with implied options: groups replaced by their functions; without `std`, no
    /// detection of processor features and no multiply-adds.
    pub(crate) fn normalized(&self) -> Cow<'_, Self> {
        let functions = function_groups::expanded(&self.options.functions, &self.options.motion);
        if !self.options.rust().no_std && functions == self.options.functions {
            return Cow::Borrowed(self);
        }
        let mut request = self.clone();
        let options = &mut request.options;
        options.functions = functions;
        if options.rust().no_std {
            options.level.fused = false;
            let rust = options.rust_mut();
            (rust.forbid_unsafe, rust.runtime) = (true, None);
        }
        Cow::Owned(request)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_links_that_a_program_leaves_out_are_no_mistake_and_others_are() {
        const ARM: &str = "<robot name='arm'><link name='base'/><link name='fore'/><link name='tip'><inertial><mass value='1'/>\
            <inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial></link>\
            <joint name='fore' type='continuous'><parent link='base'/><child link='fore'/></joint>\
            <joint name='wrist' type='fixed'><parent link='fore'/><child link='tip'/></joint></robot>";
        let told = |from: &str, to: &str| {
            let mut request = Request::new("arm.urdf", ARM);
            request.options.set_name(from, to);
            request.set_frames(&["tip".into()]);
            assert_eq!(request.options.robot.frames.as_deref(), Some(&["tip".into()][..]));
            crate::generate(&request).map(|generated| generated.source).map_err(|error| error.to_string())
        };
        assert!(["fore", "tip"].iter().all(|name| told(name, "OTHER").unwrap().contains("pub const OTHER: usize = 0;")));
        assert!(!told("base", "OTHER").unwrap().contains("OTHER"));
        for (from, to, reason) in [("wrist", "OTHER", "no joint that moves"), ("nobody", "OTHER", "no link"), ("base", "fn", "identifier")]
        {
            assert!(told(from, to).is_err_and(|told| told.contains(reason)), "{from} {to}");
        }
    }

    #[test]
    fn without_std_there_is_nothing_that_needs_it_and_all_else_stays() {
        let mut request = Request::new("robot", "");
        request.options.rust_mut().runtime = Some("::articulated".into());
        assert_eq!(request.normalized().options, request.options);
        request.options.rust_mut().no_std = true;
        let mut expected = request.options.clone();
        (expected.rust_mut().forbid_unsafe, expected.level.fused, expected.rust_mut().runtime) = (true, false, None);
        assert!(request.options.level.fused);
        assert_eq!(request.normalized().options, expected);
    }
}
