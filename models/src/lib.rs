//! The bundled robots: eleven URDF files, written for this project from published figures, two MJCF
//! files with contacts, and the bundled scenes. The crate's README names their sources and their
//! purpose.
//!
//! Two robots are also generated code: [`quadruped`] by the macro, [`panda_like`] by the build
//! script. A user's crate generates any of them in the same few lines.
//!
//! ```
//! use articulated_core::description::Base;
//!
//! let arm = articulated_models::robot("ur5_like").expect("it is bundled");
//! assert!(arm.base == Base::Fixed && arm.urdf.contains("<robot name=\"ur5_like\""));
//! assert_eq!(articulated_models::ROBOTS.len(), 11);
//! ```

use articulated_core::description::Base;

/// A robot that comes with the crate.
#[derive(Clone, Copy, Debug)]
pub struct Bundled {
    /// Its name on the command line; the file is [`Bundled::file`].
    pub name: &'static str,
    /// The text of the file: URDF, or MJCF of the robots of [`MJCF`].
    pub urdf: &'static str,
    /// The base it is meant to be used with.
    pub base: Base,
    /// Summary, one line.
    pub summary: &'static str,
}

impl Bundled {
    /// Name of its file in errors.
    pub fn file(&self) -> String {
        let ending = if MJCF.iter().any(|own| own.name == self.name) { "xml" } else { "urdf" };
        format!("{}.{ending}", self.name)
    }
}

macro_rules! robots {
    ($folder:literal, $ending:literal; $($name:literal, $base:ident, $summary:literal;)*) => {
        &[$(Bundled {
            name: $name,
            urdf: include_str!(concat!("../", $folder, "/", $name, ".", $ending)),
            base: Base::$base,
            summary: $summary,
        }),*]
    };
}

/// Robots of URDF files, from small to large.
pub const ROBOTS: &[Bundled] = robots! {
    "urdf", "urdf";
    "simple_pendulum", Fixed, "one revolute joint; closed form";
    "double_pendulum", Fixed, "two parallel axes; closed form";
    "cart_pole", Fixed, "a cart on a rail and a pole on the cart; closed form";
    "ur5_like", Fixed, "six-axis arm, inertias of cylinders";
    "panda_like", Fixed, "seven-axis arm, full inertia tensors";
    "gripper_arm", Fixed, "small arm with two joints that follow another";
    "quadruped", Floating, "four legs of three joints";
    "golfer", Fixed, "a golfer's trunk, lead arm and club, 15 joints";
    "humanoid", Floating, "30 joints, two arms, two legs, neck and trunk";
    "spinning_top", Fixed, "a symmetric top on a ball joint; closed form";
    "t_handle", Floating, "a free rigid body with three different moments; closed form";
};

/// Robots of MJCF files, with a floor, actuators and keyframes: for functions with constraints, and
/// for scenes with a law.
pub const MJCF: &[Bundled] = robots! {
    "mjcf", "xml";
    "landing_quadruped", Fixed, "MJCF: four legs of three joints on a floor, position servos";
    "standing_humanoid", Fixed, "MJCF: 15 joints on flat feet and a floor, position servos";
};

/// The robot called `name`.
pub fn robot(name: &str) -> Option<&'static Bundled> {
    ROBOTS.iter().chain(MJCF).find(|r| r.name == name)
}

/// A scene that comes with the crate: TOML, as the crate `articulated-scene` reads it. The robot
/// that it names is among [`ROBOTS`] or [`MJCF`].
#[derive(Clone, Copy, Debug)]
pub struct BundledScene {
    /// Its name on the command line; the file is `<name>.toml`.
    pub name: &'static str,
    /// The text of the scene.
    pub toml: &'static str,
}

impl BundledScene {
    /// Name of its file in errors.
    pub fn file(&self) -> String {
        format!("{}.toml", self.name)
    }

    /// Summary, one line: the scene's first line.
    pub fn summary(&self) -> &'static str {
        let line = self.toml.lines().next().unwrap_or_default();
        line.trim_start_matches("summary = \"").trim_end_matches('"')
    }
}

macro_rules! scenes {
    ($($name:literal)*) => {
        &[$(BundledScene { name: $name, toml: include_str!(concat!("../scenes/", $name, ".toml")) }),*]
    };
}

/// Scenes that an integrator steps, from small to large.
pub const SCENES: &[BundledScene] = scenes! {
    "pendulum"
    "double_pendulum"
    "cart_pole"
    "spinning_top"
    "t_handle"
    "chain"
    "arm"
    "underwater_arm"
    "quadruped_drop"
    "golf_swing"
    "humanoid_float"
};

/// Scenes of [`MJCF`] robots, with contacts by MuJoCo's law.
pub const LAW_SCENES: &[BundledScene] = scenes! {
    "quadruped_lands"
    "humanoid_stands"
};

/// The scene called `name`.
pub fn scene(name: &str) -> Option<&'static BundledScene> {
    SCENES.iter().chain(LAW_SCENES).find(|s| s.name == name)
}

/// The seven-axis arm, fixed base, written out by this crate's build script.
#[cfg(feature = "generated")]
pub mod panda_like {
    include!(concat!(env!("OUT_DIR"), "/panda_like.rs"));
}

#[cfg(feature = "generated")]
articulated::robot! {
    /// The quadruped, floating base, written out by the macro.
    pub mod quadruped {
        urdf = "urdf/quadruped.urdf",
        base = floating,
        functions = [placements, inverse_dynamics, bias_forces, gravity_torque, mass_matrix, forward_dynamics],
    }
}

#[cfg(all(test, feature = "generated"))]
mod tests {
    use articulated::Dynamics;

    use articulated_codegen::scene::{Scene, open_in};
    use articulated_scene::{Controller, Robot};

    use super::{ROBOTS, SCENES, panda_like, quadruped, robot, scene};

    #[test]
    fn every_name_finds_its_own_file() {
        assert_eq!(ROBOTS.len(), 11);
        for r in ROBOTS {
            assert_eq!(robot(r.name).map(|found| found.urdf), Some(r.urdf));
            assert!(r.urdf.contains(&format!("<robot name=\"{}\"", r.name)), "{}", r.name);
        }
        assert!(robot("Humanoid").is_none());
    }

    /// Written once for generated and generic robots: torque that holds the robot where it is, by a
    /// function that knows only the trait.
    fn holding<R: Dynamics>(robot: &R, q: &[f64]) -> Vec<f64> {
        let (mut ws, n) = (robot.workspace(), robot.shape().nv);
        let (mut tau, zero) = (vec![0.0; n], vec![0.0; n]);
        robot.inverse_dynamics(&mut ws, q, &zero, &zero, &mut tau).unwrap();
        tau
    }

    #[test]
    fn both_ways_give_what_the_generic_model_gives() {
        let model = |name: &str| {
            let r = robot(name).unwrap();
            articulated::load_bytes(name, r.urdf.as_bytes(), r.base).unwrap()
        };
        let q = [0.1, -0.4, 0.7, -1.9, 0.3, 1.2, -0.5];
        for (a, b) in holding(&panda_like::Robot, &q).iter().zip(holding(&model("panda_like"), &q)) {
            assert!((a - b).abs() < 1e-12, "{a} {b}");
        }
        let mut q = [0.2; quadruped::NQ];
        q[3..7].copy_from_slice(&[0.5, -0.5, 0.5, 0.5]);
        let still = holding(&quadruped::Robot, &q);
        for (a, b) in still.iter().zip(holding(&model("quadruped"), &q)) {
            assert!((a - b).abs() < 1e-11, "{a} {b}");
        }
        // The base carries the whole weight.
        let weight = still[3..6].iter().map(|f| f * f).sum::<f64>().sqrt();
        assert!((weight - 90.0 * 9.81).abs() < 1e-9, "{weight}");
    }

    #[test]
    fn every_scene_reads_and_fits_its_robot() {
        assert!(scene("golf_swing").is_some() && scene("golf").is_none());
        for bundled in SCENES {
            let scene = Scene::read(bundled.name, bundled.toml).unwrap_or_else(|e| panic!("{e}"));
            assert_eq!(scene.summary, bundled.summary());
            assert!(matches!(&scene.robot, Robot::Bundled(name) if robot(name).is_some()), "{}", bundled.name);
            let robots: Vec<_> =
                ROBOTS.iter().map(|r| articulated_scene::Bundled { name: r.name, document: r.urdf, base: r.base }).collect();
            let prepared = open_in(scene, std::path::Path::new(""), &robots).unwrap_or_else(|e| panic!("{e}"));
            let model = prepared.robot.model;
            let (q, v) = prepared.scene.start(&model).unwrap_or_else(|e| panic!("{e}"));
            assert_eq!((q.len(), v.len()), (model.nq(), model.nv()), "{}", bundled.name);
            let controller =
                prepared.scene.controller(&model, &mut |file| Err(format!("{file} is not bundled"))).unwrap_or_else(|e| panic!("{e}"));
            assert_eq!(controller == Controller::None, prepared.scene.control == Default::default(), "{}", bundled.name);
            assert!(prepared.scene.simulation.is_some(), "{}", bundled.name);
            // Every function that the scene requests exists; a wrong name would be reported.
            for function in prepared.scene.code.functions.iter().flatten() {
                assert!(articulated_core::algorithm::function::<f64>(function).is_some(), "{}: {function}", bundled.name);
            }
        }
    }
}
