//! The bundled robots: nine URDF files, written for this project from published figures. Their sources, and what each
//! of them exercises, stand in the crate's README.

use articulated_core::description::Base;

/// A robot that comes with the crate.
#[derive(Clone, Copy, Debug)]
pub struct Bundled {
    /// Its name on the command line; the file is `<name>.urdf`.
    pub name: &'static str,
    /// The text of the URDF.
    pub urdf: &'static str,
    /// The base it is meant to be used with.
    pub base: Base,
    /// What it is, in a line.
    pub summary: &'static str,
}

macro_rules! robots {
    ($($name:literal, $base:ident, $summary:literal;)*) => {
        &[$(Bundled {
            name: $name,
            urdf: include_str!(concat!("../urdf/", $name, ".urdf")),
            base: Base::$base,
            summary: $summary,
        }),*]
    };
}

/// All of them, from small to large.
pub const ROBOTS: &[Bundled] = robots! {
    "simple_pendulum", Fixed, "one revolute joint; closed form";
    "double_pendulum", Fixed, "two parallel axes; closed form";
    "cart_pole", Fixed, "a cart on a rail and a pole on the cart; closed form";
    "ur5_like", Fixed, "six-axis arm, inertias of cylinders";
    "panda_like", Fixed, "seven-axis arm, full inertia tensors";
    "gripper_arm", Fixed, "small arm with two joints that follow another";
    "quadruped", Floating, "four legs of three joints";
    "golfer", Fixed, "a golfer's trunk, lead arm and club, 15 joints";
    "humanoid", Floating, "30 joints, two arms, two legs, neck and trunk";
};

/// The robot called `name`.
pub fn robot(name: &str) -> Option<&'static Bundled> {
    ROBOTS.iter().find(|r| r.name == name)
}

#[cfg(test)]
mod tests {
    use super::{ROBOTS, robot};

    #[test]
    fn every_name_finds_its_own_file() {
        assert_eq!(ROBOTS.len(), 9);
        for r in ROBOTS {
            assert_eq!(robot(r.name).map(|found| found.urdf), Some(r.urdf));
            assert!(r.urdf.contains(&format!("<robot name=\"{}\"", r.name)), "{}", r.name);
        }
        assert!(robot("Humanoid").is_none());
    }
}
