//! A robot as requested: its document read, other robots appended, payloads attached, shafts made
//! to bend, joints locked, frames chosen, then its model with all effects. The edits are made in
//! this order, so that a payload may hang on an appended robot, and a lock may hold its joints.
//!
//! A refused edit is reported and left out; the others are made.

use std::collections::HashSet;
use std::path::Path;

use articulated_core::description::{Description, EditError, Editor};
use articulated_core::diagnostic::{At, Code, Diagnostic, Diagnostics, Place, Span, Spanned, Subject, Unused, quote};
use articulated_core::effect::{Applied, EffectError, Fault};
use articulated_core::model::{Model, ModelError};
use articulated_core::suggest::Suggester;
use articulated_formats::world::{GivenContact, MOST_GIVEN, World};
use articulated_formats::{Options, Reading, SNAP_EXPECTED, can_snap, read_with};

use super::options::{RobotOptions, RobotRequest};
use crate::effects::{Edited, Resolved};
use crate::series::open_table;
use crate::world::RobotInWorld;

/// A robot as requested.
#[derive(Clone, Debug)]
pub struct BuiltRobot {
    /// The robot, edited, with the findings about its document and the edits.
    pub reading: Reading,
    /// Its model with gravity, effects and the reference of wrenches, and with a frame for every
    /// link.
    pub model: Model<f64>,
    /// The scene's effects, their places in the scene, and active, inactive and unused content.
    pub resolved: Resolved,
    /// All effects: the scene's, then the request's.
    pub effects: Vec<Applied>,
    /// The frames that are requested and exist; `None`: all.
    pub frames: Option<Vec<String>>,
}

impl BuiltRobot {
    /// The model with the frames that are requested.
    #[must_use]
    pub fn framed(&self, model: Model<f64>) -> Model<f64> {
        match &self.frames {
            Some(names) => model.clone().with_frames(names).unwrap_or(model),
            None => model,
        }
    }
}

impl RobotRequest<'_> {
    /// Reads the robot and edits it, and makes its model with all effects.
    ///
    /// # Errors All findings, if one of them is an error.
    pub fn build(&self) -> Result<BuiltRobot, Diagnostics> {
        let mut log = Diagnostics::new(self.scene.map_or(self.file, |scene| &scene.file));
        let robot = self.build_into(&mut log);
        match robot {
            Some(robot) => log.result(robot),
            None => Err(log.result(()).err().unwrap_or_default()),
        }
    }

    /// As [`build`](Self::build), and reports to a collector. `None`: there is no robot, and an
    /// error says why. Refused edits are left out.
    pub fn build_into(&self, log: &mut Diagnostics) -> Option<BuiltRobot> {
        let mut own = log.apart();
        let robot = self.build_all(&mut own);
        self.scene.iter().for_each(|scene| scene.keep_certain(&mut own));
        log.take(own);
        robot
    }

    /// As [`build_into`](Self::build_into), and reports errors in the file of the scene's table,
    /// relative to `folder`: for a scene that has other errors.
    pub fn check_with_table(&self, folder: &Path, log: &mut Diagnostics) -> Option<BuiltRobot> {
        let robot = self.build_into(log);
        if let Some(scene) = self.scene {
            let in_world = robot.as_ref().map(|robot| RobotInWorld { model: &robot.model, world: &robot.reading.world });
            scene.check_table(in_world, &mut |name| open_table(folder, name), log);
        }
        robot
    }

    fn build_all(&self, log: &mut Diagnostics) -> Option<BuiltRobot> {
        self.check_numbers(log);
        let mut editing = self.edit(log)?;
        let model = self.bare_model(&editing, log)?;
        let (resolved, model, effects) = self.with_effects(&editing, model, log);
        editing.reading.warnings.extend(resolved.warnings.iter().cloned());
        editing.warn(&effects);
        let Editing { reading, frames, .. } = editing;
        Some(BuiltRobot { reading, model, resolved, effects, frames })
    }

    /// The robot read and edited, without a model. For programs that only need the description.
    ///
    /// # Errors
    /// All findings about the document and the edits, if one is an error.
    pub fn read(&self) -> Result<Reading, Diagnostics> {
        let mut log = Diagnostics::new(self.file);
        self.check_numbers(&mut log);
        let editing = self.edit(&mut log);
        match editing {
            Some(mut editing) if log.is_ok() => {
                editing.warn(&self.options.effects);
                Ok(editing.reading)
            }
            _ => Err(log.result(()).err().unwrap_or_default()),
        }
    }

    /// Checks numbers that are invalid for any robot.
    fn check_numbers(&self, log: &mut Diagnostics) {
        let wrong = |key, found, expected| Diagnostic::error("", (Default::default(), key), Code::Number, found, expected);
        if let Some(gravity) = self.options.gravity.filter(|gravity| gravity.iter().any(|x| !x.is_finite())) {
            log.push(wrong("gravity", format!("{gravity:?}"), "three finite numbers in m/s²"));
        }
        if let Some(x) = self.options.snap_angles.filter(|x| !can_snap(*x)) {
            log.push(wrong("snap_angles", x.to_string(), SNAP_EXPECTED));
        }
    }

    /// The document, with all edits that can be made.
    fn edit(&self, log: &mut Diagnostics) -> Option<Editing<'_>> {
        let reading =
            read_with(&self.options.included, self.document, &self.reader_options()).map_err(|findings| log.take(findings)).ok()?;
        let mut reading = reading;
        self.give_contacts(&mut reading.world, log);
        let coupling_files = vec![self.file.to_owned(); reading.world.couplings.len()];
        let mut editing = Editing { request: *self, reading, coupling_files, springs: Vec::new(), frames: None };
        let mut refused = log.apart();
        let appended = editing.edit(&mut refused);
        editing.refuse_second_base(&mut refused);
        editing.choose_frames(&mut refused);
        if !appended {
            // Names of the appended robot, which is missing here, are not unknown.
            refused.errors.retain(|error| !matches!(error.code, Code::UnknownLink | Code::UnknownJoint) || error.field == "append");
        }
        log.take(refused);
        appended.then_some(editing)
    }

    /// Notes in the world which contacts a caller finds. A pair that does not touch is an error.
    fn give_contacts(&self, world: &mut World, log: &mut Diagnostics) {
        for (k, given) in self.options.given_contacts.iter().enumerate() {
            let GivenContact { shapes: [first, second], places } = &given.value;
            let key = format!("given_contacts[{k}]");
            let mut refuse = |found: String, expected: &str| {
                let place = given.span.as_ref().map_or(At::Nowhere, |span| span.at);
                let file = given.span.as_ref().map_or(self.file, |span| span.file.as_str());
                log.push(Diagnostic::error(file, (place, key.as_str()), Code::UnknownName, found, expected));
            };
            if !(1..=MOST_GIVEN).contains(places) {
                refuse(format!("{places} places"), "1 to 64 places");
            }
            let known = world.touching.as_ref().is_some_and(|touching| touching.may_touch(&given.value.shapes));
            if !known {
                refuse(
                    format!("no pair of the geoms {} and {} that may touch", quote(first), quote(second)),
                    "names of two geoms of the robot's file (MJCF) on two bodies, which their masks let touch",
                );
            }
        }
        if let Some(touching) = &mut world.touching {
            touching.given = self.options.given_contacts.iter().map(|given| given.value.clone()).collect();
        }
    }

    fn bare_model(&self, editing: &Editing<'_>, log: &mut Diagnostics) -> Option<Model<f64>> {
        let refusal = |error: ModelError| Diagnostic::refusal(self.file, Place::DOCUMENT, Code::Model, error.to_string());
        self.model(&editing.reading).map_err(|error| log.push(refusal(error))).ok()
    }

    /// The model of the robot read, with the request's gravity and reference of wrenches, without
    /// effects.
    fn model(&self, reading: &Reading) -> Result<Model<f64>, ModelError> {
        let gravity = self.options.gravity_in(&reading.world).map(|x| if x.is_finite() { x } else { 0.0 });
        let model = Model::new(&reading.description, self.options.base)?;
        let (actuators, _) = reading.world.actuators_of(&model);
        let (constraints, _) = reading.world.constraints_of(&reading.description, &model);
        let model = model.with_actuators(actuators).with_constraints(constraints);
        Ok(model.with_gravity(gravity).with_wrenches_in(self.options.wrench_reference))
    }

    /// The model of a robot of this request whose description was changed since, with its effects.
    /// `None`: it is no longer a valid robot.
    #[must_use]
    pub fn model_of(&self, robot: &BuiltRobot) -> Option<Model<f64>> {
        self.model(&robot.reading).ok()?.with_effects(&robot.effects).ok()
    }

    /// The model with the scene's effects and the request's, without those that are refused.
    fn with_effects(&self, editing: &Editing<'_>, model: Model<f64>, log: &mut Diagnostics) -> (Resolved, Model<f64>, Vec<Applied>) {
        let mut own = log.apart();
        let resolved = self.scene.map_or_else(Resolved::default, |scene| {
            let Reading { description, unused, world, .. } = &editing.reading;
            let robot = Edited { description, file: self.file, base: self.options.base, unused, world, shafts: &editing.springs };
            let resolved = scene.resolve_into(&robot, &mut own);
            if self.checks_motion {
                scene.check_file_step(&editing.reading.world, &mut own);
                own.take(scene.fits(RobotInWorld { model: &model, world: &editing.reading.world }).err().unwrap_or_default());
            }
            // Names that a refused shaft would have added.
            let refused: Vec<&str> = scene
                .shafts
                .iter()
                .zip(&editing.springs)
                .filter(|(_, own)| own.is_none())
                .map(|(asked, _)| asked.shaft.joint.as_str())
                .collect();
            own.errors.retain(|error| !(error.code == Code::UnknownName && is_about_shaft(error, &refused)));
            resolved
        });
        let scenes = resolved.effects.len();
        let effects: Vec<Applied> = resolved.effects.iter().chain(&self.options.effects).cloned().collect();
        let (model, refused) = match model.clone().with_effects(&effects) {
            Ok(model) => (model, Vec::new()),
            Err(errors) => (model, errors.0),
        };
        for error in &refused {
            if let Some(finding) = self.number_of_the_file(error, &resolved, &editing.reading.unused) {
                own.push(finding);
                continue;
            }
            let (file, place) = match (self.scene, error.index < scenes) {
                (Some(scene), true) => (scene.file.as_str(), (resolved.places[error.index], resolved.keys[error.index].as_str())),
                _ => (self.file, Default::default()),
            };
            own.push(Diagnostic::refusal(file, place, Code::Effect, error.to_string()));
        }
        log.take(own);
        (resolved, model, effects)
    }

    /// A finding about a number of the robot's file that an effect uses, at its place there.
    /// `None`: the number is not from the file, or the scene has a place of its own.
    fn number_of_the_file(&self, error: &EffectError, resolved: &Resolved, unused: &[Unused]) -> Option<Diagnostic> {
        let Fault::Number { field, found, expected } = &error.fault else { return None };
        let numbers = resolved.places.get(error.index).filter(|place| **place == At::Nowhere);
        let effect = numbers.and_then(|_| resolved.report.on.get(error.index))?;
        let tag = effect.numbers.iter().find(|number| number.name == *field)?.from?;
        let subject = Subject::Joint(error.on.clone());
        // Numbers that scenes may use are reported with their places.
        let of_tag = |one: &&Unused| {
            one.subject == subject && one.tag.strip_prefix(tag).is_some_and(|rest| rest.is_empty() || rest.starts_with(" of "))
        };
        let (file, line) = match unused.iter().find(of_tag) {
            Some(one) => (one.tag[tag.len()..].strip_prefix(" of ").unwrap_or(self.file), one.line),
            None => (self.file, None),
        };
        // The last word of a tag is the attribute.
        let attribute = tag.rsplit(' ').next().unwrap_or(tag);
        let place = Place { at: line.map_or(At::Nowhere, At::line_of), subject: &subject, field: attribute };
        let found = found.iter().map(f64::to_string).collect::<Vec<_>>().join(", ");
        Some(Diagnostic::error(file, place, Code::Effect, found, expected))
    }

    pub(super) fn reader_options(&self) -> Options {
        Options {
            file: self.file.to_owned(),
            base: self.options.base,
            allow_unphysical_inertia: self.options.allow_unphysical_inertia,
            first_of_duplicates: self.options.first_of_duplicates,
            leave_out: self.options.leave_out.clone(),
            allow_unknown_version: self.options.allow_unknown_version,
            snap_angles: self.options.snap_angles.filter(|x| can_snap(*x)),
            formats: self.options.formats,
            arguments: self.options.arguments.clone(),
            packages: self.options.packages.clone(),
            contact_meshes: self.options.contact_meshes,
        }
    }
}

/// Whether a finding is about a joint or a link of a refused shaft.
fn is_about_shaft(error: &Diagnostic, refused: &[&str]) -> bool {
    let may_name = |name: &str| refused.iter().any(|joint| articulated_core::description::Shaft::may_name(joint, name));
    error.field.split(['.', '[']).any(may_name)
}

/// A robot while it is edited.
pub(super) struct Editing<'a> {
    pub(super) request: RobotRequest<'a>,
    pub(super) reading: Reading,
    /// The file of each coupling of the world.
    pub(super) coupling_files: Vec<String>,
    /// The springs and dampings of each shaft; `None` for a refused one.
    springs: Vec<Option<Vec<Applied>>>,
    frames: Option<Vec<String>>,
}

/// The place of an entry for messages: its own, or the robot's file.
pub(super) struct Entry<'a> {
    span: Option<&'a Span>,
    /// The key in a file, and the key of an entry that no file contains.
    key: (String, &'static str),
}

impl<'a> Entry<'a> {
    pub(super) fn of<T>(entry: &'a Spanned<T>, key: &'static str) -> Self {
        Self { span: entry.span.as_ref(), key: (key.to_owned(), key) }
    }

    fn named<T>(entry: &'a Spanned<T>, file_key: String, key: &'static str) -> Self {
        Self { span: entry.span.as_ref(), key: (file_key, key) }
    }
}

impl Editing<'_> {
    /// Makes all edits that can be made. Returns whether all robots were appended.
    fn edit(&mut self, log: &mut Diagnostics) -> bool {
        let mut description = std::mem::take(&mut self.reading.description);
        let mut editor = Editor::of(&mut description);
        let options: &RobotOptions = self.request.options;
        let before = log.count();
        options.append.iter().for_each(|other| self.append(other, &mut editor, log));
        let appended = log.count() == before;
        for payload in &options.payloads {
            let at = Entry::of(payload, "payload");
            self.take(&at, editor.attach(payload).map(drop), log);
        }
        for shaft in &options.shafts {
            let at = Entry::named(shaft, format!("effects.shaft.{}", shaft.joint), "shaft");
            let result = editor.shaft(shaft);
            self.springs.push(result.as_ref().ok().cloned());
            self.take(&at, result.map(drop), log);
        }
        for coupling in &options.coupling {
            let at = Entry::named(coupling, format!("coupling.{}", coupling.joint), "coupling");
            self.take(&at, editor.couple(coupling), log);
        }
        if options.file_coupling {
            self.couple_as_the_files_say(appended, &mut editor, log);
        }
        for lock in &options.lock {
            let (joint, coordinates) = &lock.value;
            let at = Entry::named(lock, format!("lock.{joint}"), "lock");
            self.take(&at, editor.lock(joint, coordinates), log);
        }
        self.reading.description = description;
        appended
    }

    /// Equations of the robot's file and of appended ones are edits. Warnings that they are
    /// not applied are removed. `appended`: whether all robots were appended.
    fn couple_as_the_files_say(&mut self, appended: bool, editor: &mut Editor<'_>, log: &mut Diagnostics) {
        if appended && self.reading.world.couplings.is_empty() {
            let place = (Default::default(), "coupling");
            let found = "\"file\", and the robot's file has no equations that joints can follow";
            log.error(place, Code::Edit, found, "no key coupling, or a table of joints");
        }
        let couplings = std::mem::take(&mut self.reading.world.couplings);
        for ((coupling, at), file) in couplings.into_iter().zip(std::mem::take(&mut self.coupling_files)) {
            let joint = coupling.joint.clone();
            let entry = Spanned::new(coupling, &file, at);
            self.take(&Entry::named(&entry, format!("joint {joint:?}"), "coupling"), editor.couple(&entry), log);
        }
        self.reading.warnings.retain(|warning| warning.field != "coupling");
    }

    fn refuse(&self, at: &Entry<'_>, code: Code, sentence: String, log: &mut Diagnostics) {
        log.push(match at.span {
            Some(span) => Diagnostic::refusal(&span.file, (span.at, at.key.0.as_str()), code, sentence),
            None => Diagnostic::refusal(self.request.file, (Default::default(), at.key.1), code, sentence),
        });
    }

    pub(super) fn take(&self, at: &Entry<'_>, result: Result<(), EditError>, log: &mut Diagnostics) {
        if let Err(error) = result {
            let code = match &error {
                EditError::UnknownLink { .. } => Code::UnknownLink,
                EditError::UnknownJoint { .. } => Code::UnknownJoint,
                _ => Code::Edit,
            };
            self.refuse(at, code, error.to_string(), log);
        }
    }

    /// Refuses a floating base for a robot that floats by a free joint of its own.
    fn refuse_second_base(&self, log: &mut Diagnostics) {
        if let Err(error) = ModelError::of_base(&self.reading.description, self.request.options.base) {
            self.refuse(&Entry { span: None, key: (String::new(), "base") }, Code::Edit, error.to_string(), log);
        }
    }

    /// The frames that exist, each once.
    fn choose_frames(&mut self, log: &mut Diagnostics) {
        let Some(frames) = &self.request.options.frames else { return };
        let Description { links, frames: others, .. } = &self.reading.description;
        let known = || links.iter().map(|link| link.name.as_str()).chain(others.iter().map(|frame| frame.name.as_str()));
        let names: HashSet<&str> = known().collect();
        let (mut seen, mut suggester, mut chosen) = (HashSet::new(), Suggester::default(), Vec::new());
        for frame in frames {
            let (name, at) = (&frame.value, Entry::of(frame, "frames"));
            if !names.contains(name.as_str()) {
                let nearest = suggester.nearest(name, known()).map(str::to_owned);
                self.take(&at, Err(EditError::UnknownLink { name: name.clone(), nearest }), log);
            } else if seen.insert(name) {
                chosen.push(name.clone());
            } else {
                self.refuse(&at, Code::DuplicateName, format!("{name:?} is listed twice"), log);
            }
        }
        self.frames = Some(chosen);
    }
}

#[cfg(test)]
mod tests {
    use articulated_core::description::{Base, Origin, Payload, Shaft};
    use articulated_core::diagnostic::Subject;
    use articulated_core::effect::EffectId;
    use articulated_formats::MOST_SNAPPED;

    use super::*;
    use crate::Appended;

    /// An implausible inertia, which is a warning.
    const LINK: &str = "<inertial><mass value='1'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='3'/></inertial>";

    /// A link that turns on another, between these bounds, with an unused colour; its axis is
    /// nearly z.
    fn robot(name: &str) -> String {
        format!(
            "<robot name='{name}'><link name='base'>{LINK}</link><link name='tip'>{LINK}<visual/></link>
            <joint name='hinge' type='revolute'><parent link='base'/><child link='tip'/><origin rpy='1.5707963 0 0'/><axis xyz='0 0 2'/>
            <limit lower='-1' upper='2' effort='1' velocity='1'/><calibration rising='0'/></joint></robot>"
        )
    }

    fn request() -> TestRequest {
        let mut asked = TestRequest { file: "arm.urdf", urdf: robot("arm"), options: RobotOptions::default() };
        asked.options.snap_angles = Some(1e-6);
        asked
    }

    /// A request with its document.
    struct TestRequest {
        file: &'static str,
        urdf: String,
        options: RobotOptions,
    }

    fn read(own: &TestRequest) -> Result<Reading, Diagnostics> {
        RobotRequest { file: own.file, document: own.urdf.as_bytes(), options: &own.options, scene: None, checks_motion: false }.read()
    }

    fn appended(at: &str) -> Appended {
        Appended {
            document: robot("hand").into_bytes(),
            file: "hand.urdf".into(),
            at: at.into(),
            prefix: "left_".into(),
            origin: Origin::default(),
        }
    }

    #[test]
    fn a_tolerance_of_angles_is_above_nothing() {
        for (tolerance, found) in [(0.0, "0"), (MOST_SNAPPED * 2.0, "1"), (f64::NAN, "NaN")] {
            let mut asked = request();
            asked.options.snap_angles = Some(tolerance);
            let expected = "expected a finite number above 0, at most 0.5 rad; leave it out to snap none";
            assert_eq!(read(&asked).unwrap_err().to_string(), format!("snap_angles: found {found}, {expected}"));
        }
    }

    /// The keys of refused entries, and what was found there.
    fn refused(asked: &TestRequest) -> Vec<String> {
        read(asked).unwrap_err().errors.into_iter().map(|error| format!("{}: {}", error.field, error.found)).collect()
    }

    fn begin_with(told: &[String], expected: &[&str]) {
        let alike = told.iter().zip(expected).all(|(told, expected)| told.starts_with(expected));
        assert!(told.len() == expected.len() && alike, "{told:?}");
    }

    #[test]
    fn what_is_said_of_an_appended_robot_is_said_of_the_whole() {
        let alone = read(&request()).unwrap();
        let mut asked = request();
        asked.options.append.push(appended("tip"));
        let both = read(&asked).unwrap();
        let hand = |problems: &[Diagnostic]| problems.iter().filter(|p| p.file() == "hand.urdf").count();
        assert_eq!((hand(&both.snapped), both.snapped.len()), (alone.snapped.len(), 2 * alone.snapped.len()));
        assert_eq!(both.warnings.len() - hand(&both.warnings), alone.warnings.len());
        assert!(hand(&both.warnings) == alone.warnings.len() && !alone.warnings.is_empty(), "{:?}", both.warnings);
        // The mass of its root moves; that of a fixed base has no effect.
        let held = |reading: &Reading| reading.unused.iter().filter(|u| u.tag == "inertial").count();
        assert_eq!((held(&both), held(&alone)), (1, 1));
        let subjects: Vec<&Subject> = both.unused.iter().map(|u| &u.subject).collect();
        for subject in [Subject::Link("tip".into()), Subject::Link("left_tip".into()), Subject::Joint("left_hinge".into())] {
            assert!(subjects.contains(&&subject), "{subjects:?}");
        }
    }

    #[test]
    fn a_lock_is_told_of_where_it_is_beyond_a_bound() {
        for (at, beyond) in [(-1.5, true), (-1.0, false), (0.0, false), (2.0, false), (2.5, true)] {
            let mut asked = request();
            asked.options.lock.push(("hinge".into(), vec![at]).into());
            let warnings = read(&asked).unwrap().warnings;
            assert_eq!(warnings.iter().any(|w| w.code == Code::BeyondLimit), beyond, "{at}");
        }
    }

    /// The range of a ball is a cone about the identity; q and −q are one rotation.
    #[test]
    fn a_lock_of_a_ball_is_told_of_where_its_angle_is_beyond_the_range() {
        let ball =
            "<mujoco><worldbody><body name='b'><joint name='ball' type='ball' range='0 60'/><geom size='0.1'/></body></worldbody></mujoco>";
        for (degrees, sign, beyond) in
            [(61.0_f64, 1.0, true), (59.0, 1.0, false), (60.0, 1.0, false), (59.0, -1.0, false), (179.0, -1.0, true)]
        {
            let half = degrees.to_radians() / 2.0;
            let [axis, w] = [half.sin() / 3.0, half.cos()].map(|x| sign * x);
            let mut asked = TestRequest { file: "ball.xml", urdf: ball.into(), options: RobotOptions::default() };
            asked.options.lock.push(("ball".into(), vec![axis, -2.0 * axis, 2.0 * axis, w]).into());
            let warnings = read(&asked).unwrap().warnings;
            assert_eq!(warnings.iter().any(|w| w.code == Code::BeyondLimit), beyond, "{degrees} {sign}");
        }
    }

    #[test]
    fn a_load_is_told_of_where_the_base_holds_it() {
        let warned = |change: &dyn Fn(&mut RobotOptions)| {
            let mut asked = request();
            change(&mut asked.options);
            read(&asked).unwrap().warnings.iter().filter(|w| w.field == "payload").count()
        };
        let load = |link: &str, mass: f64| Payload { link: link.into(), mass, ..Payload::default() };
        assert_eq!(warned(&|o| o.payloads.extend([load("base", 1.0), load("tip", 1.0), load("base", 0.0)].map(Into::into))), 1);
        let locked = |o: &mut RobotOptions| {
            o.payloads.push(load("tip", 1.0).into());
            o.lock.push(("hinge".into(), vec![0.0]).into());
        };
        assert_eq!(warned(&locked), 1);
        assert_eq!(warned(&|o| (o.base, o.payloads) = (Base::Floating, vec![load("base", 1.0).into()])), 0);
    }

    #[test]
    fn a_load_that_misses_the_triangle_inequality_is_told_of_and_used_as_a_links_inertia_is() {
        let told = |inertia: [f64; 6]| {
            let mut asked = request();
            asked.options.payloads.push(Payload { link: "tip".into(), mass: 1.0, inertia, ..Payload::default() }.into());
            let warnings = read(&asked).unwrap().warnings.into_iter().filter(|w| w.field == "payload");
            warnings.map(|w| (w.code, w.found, w.expected)).collect::<Vec<_>>()
        };
        let expected = "none greater than the other two together (triangle inequality); used as given";
        let of = |found: &str| vec![(Code::InertiaTriangle, format!("the principal moments {found} kg·m²"), expected.to_owned())];
        assert_eq!(told([1.0, 0.0, 0.0, 1.0, 0.0, 3.0]), of("1.000e0, 1.000e0, 3.000e0"));
        // The moments 0, 1 − 0.0009 and 1 + 0.0009.
        assert_eq!(told([0.0, 0.0, 0.0, 1.0, 0.0009, 1.0]), of("0, 9.991e-1, 1.001e0"));
        assert_eq!(told([0.0, 0.0, 0.0, 1.0, 1e-7, 1.0]), []);
    }

    /// A body with a free joint on the root of this name, with this content.
    fn free(root: &str, content: &str) -> TestRequest {
        let urdf = format!(
            "<robot name='quad'><link name='{root}'>{content}</link><link name='stand'/><link name='trunk'>{LINK}</link>
            <joint name='foot' type='fixed'><parent link='{root}'/><child link='stand'/></joint>
            <joint name='f' type='floating'><parent link='stand'/><child link='trunk'/></joint></robot>"
        );
        let options = RobotOptions { base: Base::Floating, ..RobotOptions::default() };
        TestRequest { file: "quad.urdf", urdf, options }
    }

    #[test]
    fn a_floating_base_beside_a_free_joint_of_the_root_is_refused() {
        for (root, content) in [("world", ""), ("base", ""), ("world", LINK)] {
            let told = read(&free(root, content)).unwrap_err();
            let sentence =
                "base: link \"trunk\" has the free joint \"f\" already: leave out --floating (base = \"floating\", Base::Floating)";
            assert_eq!(told.to_string(), format!("quad.urdf: {sentence}"), "{root}");
        }
        // A root with mass of its own, a joint that is locked, or no floating base
        assert!(read(&free("base", LINK)).is_ok());
        let mut locked = free("world", "");
        locked.options.lock.push(("f".into(), vec![0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]).into());
        assert!(read(&locked).is_ok());
        let mut fixed = free("world", "");
        fixed.options.base = Base::Fixed;
        assert!(read(&fixed).is_ok());
    }

    /// A hand and, fixed to it, a tip and a lamp.
    fn club() -> TestRequest {
        let fixed = |link: &str| {
            format!(
                "<link name='{link}'>{LINK}</link><joint name='to_{link}' type='fixed'><parent link='hand'/><child link='{link}'/>
                <origin xyz='1 0 0'/></joint>"
            )
        };
        let urdf = format!("<robot name='club'><link name='hand'>{LINK}</link>{}{}</robot>", fixed("tip"), fixed("lamp"));
        TestRequest { file: "club.urdf", urdf, options: RobotOptions::default() }
    }

    #[test]
    fn mass_that_a_shaft_carries_or_takes_is_not_held_by_the_base() {
        let held = |shaft: Option<Shaft>| {
            let mut asked = club();
            asked.options.shafts.extend(shaft.map(Into::into));
            let unused = read(&asked).unwrap().unused.into_iter().filter(|u| u.tag == "inertial");
            unused.map(|u| u.subject.to_string()).collect::<Vec<_>>()
        };
        let shaft = |mass| Some(Shaft { joint: "to_tip".into(), segments: 2, stiffness: 1.0, mass, ..Shaft::default() });
        assert_eq!(held(None), ["link \"hand\"", "link \"tip\"", "link \"lamp\""]);
        assert_eq!(held(shaft(Some(0.1))), ["link \"hand\"", "link \"lamp\""]);
        assert_eq!(held(shaft(None)), ["link \"lamp\""]);
    }

    #[test]
    fn what_thousands_of_edits_and_effects_use_is_soon_found() {
        let count = 5000;
        let link = |k| format!("<link name='l{k}'>{LINK}</link>");
        let joint = |k| {
            format!(
                "<joint name='j{k}' type='continuous'><parent link='tip'/><child link='l{k}'/><axis xyz='0 0 1'/>
                <dynamics damping='0.5' friction='0.25'/></joint>"
            )
        };
        let all: String = (0..count).map(link).chain((0..count).map(joint)).collect();
        let mut asked = request();
        asked.urdf = robot("arm").replace("</robot>", &(all + "</robot>"));
        let damping = |k| Applied { effect: EffectId::damping, on: format!("j{k}"), at: Origin::default(), parameters: vec![0.5] };
        asked.options.effects = (1..count).map(damping).collect();
        asked.options.lock = (0..count).map(|k| (format!("j{k}"), vec![0.0]).into()).collect();
        asked.options.payloads = vec![Payload { link: "l0".into(), mass: 1.0, ..Payload::default() }.into(); count];
        let reading = read(&asked).unwrap();
        let left = |tag: &str| reading.unused.iter().filter(|u| u.tag == tag).map(|u| u.subject.to_string()).collect::<Vec<_>>();
        assert_eq!((left("dynamics damping"), left("dynamics friction").len()), (vec!["joint \"j0\"".to_owned()], count));
        assert_eq!(reading.warnings.iter().filter(|w| w.field == "payload").count(), 0);
    }

    #[test]
    fn each_frame_is_listed_once_and_is_a_link() {
        let mut asked = request();
        asked.options.frames = Some(["tip", "base", "tap", "tip"].map(Into::into).to_vec());
        begin_with(&refused(&asked), &["frames: the robot has no link or frame \"tap\"", "frames: \"tip\" is listed twice"]);
    }

    #[test]
    fn very_many_frames_that_there_are_not_are_told_soon_and_the_first_with_what_was_meant() {
        let mut asked = request();
        let links: String = (0..5000).map(|k| format!("<link name='link_{k:05}'/>")).collect();
        let joint = |k| format!("<joint name='j{k}' type='fixed'><parent link='tip'/><child link='link_{k:05}'/></joint>");
        let robot = robot("arm").replace("</robot>", &(links + &(0..5000).map(joint).collect::<String>() + "</robot>"));
        asked.urdf = robot;
        asked.options.frames = Some((0..5000).map(|k| format!("lynk_{k:05}").into()).collect());
        let errors = read(&asked).unwrap_err().errors;
        let meant = |error: &Diagnostic| error.found.contains("did you mean");
        assert_eq!((errors.len(), meant(&errors[0]), meant(&errors[999])), (1001, true, false));
        assert!(errors[1000].to_string().ends_with("found 4000 more that are not listed"));
    }

    #[test]
    fn where_a_robot_cannot_be_appended_its_names_are_not_unknown() {
        let mut asked = request();
        asked.options.append.push(appended("top"));
        asked.options.payloads.push(Payload { link: "left_tip".into(), mass: 1.0, ..Payload::default() }.into());
        asked.options.payloads.push(Payload { link: "tip".into(), mass: -1.0, ..Payload::default() }.into());
        asked.options.lock.push(("left_hinge".into(), vec![0.0]).into());
        asked.options.frames = Some(vec!["left_tip".into()]);
        let mass = "payload: load on link \"tip\": mass";
        begin_with(&refused(&asked), &["append: the robot has no link or frame \"top\"", mass]);
        asked.options.append[0].at = "tip".into();
        begin_with(&refused(&asked), &[mass]);
        asked.options.append.clear();
        let [payload, lock, frame] = ["payload: ", "lock: ", "frames: "];
        begin_with(&refused(&asked), &[payload, mass, lock, frame]);
    }
}
