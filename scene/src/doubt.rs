//! Consequences of errors in a scene: a scene with errors is checked further without the wrong
//! keys, and findings that may come from their absence are left out.

use articulated_core::diagnostic::{Code, Diagnostic, Diagnostics};
use articulated_core::model::FLOATING_BASE;
use articulated_core::suggest::nearest;

use crate::scene::{KEYS, Scene};
use crate::shaft;
use crate::table::MEANT;

/// Keys at the top that change neither the reading of the robot nor its links, joints and base.
const HARMLESS: [&str; 17] = [
    "summary",
    "gravity",
    "functions",
    "parameters",
    "frames",
    "wrenches_in",
    "effects",
    "simulation",
    "initial",
    "control",
    "impact",
    "rename",
    "limbs",
    "batch",
    "level",
    "forbid_unsafe",
    "max_code_size",
];

/// Keys at the top that neither add nor remove names.
const OF_KNOWN_NAMES: [&str; 3] = ["base", "lock", "coupling"];

impl Scene {
    /// Whether a key at the top of the text, or one below it, is wrong or misspelt and was left
    /// out.
    #[must_use]
    pub fn doubts(&self, key: &str) -> bool {
        self.doubted().any(|doubted| doubted == key)
    }

    /// Leaves out the findings about a robot that may follow from keys that were left out.
    pub fn keep_certain(&self, log: &mut Diagnostics) {
        if !self.left_out.is_empty() {
            log.errors.retain(|error| self.is_certain(error));
        }
    }

    /// The keys at the top that were left out, in whole or in part; for a misspelt key, the
    /// intended one. Shafts, which add joints, are a key of their own.
    fn doubted(&self) -> impl Iterator<Item = &str> {
        self.left_out.iter().filter_map(|path| {
            let mut parts = path.split(['.', '[']);
            let top = parts.next().unwrap_or_default();
            if top == "effects" && parts.next().is_some_and(|part| nearest(part, [shaft::NAME]).is_some()) {
                return Some(shaft::NAME);
            }
            if MEANT.iter().any(|(other, _)| *other == top) {
                return Some("base");
            }
            let keys = || KEYS.iter().map(|row| row.name);
            let meant = nearest(top, keys());
            keys().find(|key| *key == top).or_else(|| keys().find(|key| Some(*key) == meant.as_deref()))
        })
    }

    /// Whether a finding about the robot does not depend on the keys that were left out.
    fn is_certain(&self, error: &Diagnostic) -> bool {
        let only = |keys: &[&str]| self.doubted().all(|key| HARMLESS.contains(&key) || keys.contains(&key));
        match error.code {
            Code::UnknownFunction | Code::File => true,
            // A table that cannot be opened is an error of its own.
            _ if error.field == "control.file" => true,
            Code::UnknownName | Code::UnknownLink | Code::UnknownJoint | Code::DuplicateName | Code::Rename | Code::NameClash => {
                only(&OF_KNOWN_NAMES) && !(error.field.contains(FLOATING_BASE) && self.doubts("base"))
            }
            // Entries of the list of parameters name effects.
            Code::Parameter => only(&[]) && !self.doubts("effects"),
            // A joint takes its missing numbers from the entry of all joints.
            Code::MissingKey => only(&[]) && !self.doubts("effects"),
            // The word `motion` needs a simulation.
            Code::FunctionSpec => only(&[]) && !self.doubts("simulation"),
            _ => only(&[]),
        }
    }
}

#[cfg(test)]
mod tests {
    use articulated_core::description::Base;
    use articulated_core::diagnostic::At;

    use super::*;
    use crate::Opened;

    const DOOR: &str = "<robot name='door'><link name='frame'/><link name='leaf'><inertial><mass value='8'/>
        <inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='0.5'/></inertial></link>
        <joint name='hinge' type='continuous'><parent link='frame'/><child link='leaf'/><axis xyz='0 0 1'/></joint></robot>";

    /// All findings about a scene and its robot, without the name of the file.
    fn told(text: &str) -> Vec<String> {
        let mut log = Diagnostics::new("s.toml");
        let scene = Scene::read_into("s.toml", text, &mut log).expect("TOML");
        let robot = Opened::new(scene, "door.urdf", DOOR.into(), Base::Fixed, vec![]);
        robot.robot().build_into(&mut log);
        let errors = log.result(()).err().unwrap_or_default().errors;
        errors.iter().map(|error| format!("{}: {}", error.line().unwrap_or_default(), error.field)).collect()
    }

    #[test]
    fn mistakes_of_the_text_and_names_of_the_robot_are_told_together() {
        let scene = "frames = ['leef']\nsumary = 'a door'\n[effects]\ndamping = { hinje = 1, hinge = -1 }\n[initial]\nq = { hing = 1 }";
        assert_eq!(told(scene), ["1: frames", "2: sumary", "4: effects.damping.hinge", "4: effects.damping.hinje", "6: initial.q.hing"]);
    }

    #[test]
    fn what_may_follow_from_a_key_that_was_left_out_is_not_told() {
        // The base may be meant to float, and there may be more links than there are.
        let base = "[initial]\nbase = {}\nq = { hing = 1, __floating_base__ = [0, 0, 0, 0, 0, 0, 1] }";
        assert_eq!(told(&format!("floating = true\n{base}")), ["1: floating", "4: initial.q.hing"]);
        assert_eq!(told(&format!("summary = ''\n{base}")), ["3: initial.base", "4: initial.q.hing", "4: initial.q.__floating_base__"]);
        let names = "frames = ['left_leaf']\neffects = { damping = { left_hinge = 1 } }";
        for append in
            ["append = { file = 3, at = 'leaf', prefix = 'left_' }", "apend = { file = 'door.urdf', at = 'leaf', prefix = 'left_' }"]
        {
            assert_eq!(told(&format!("{append}\n{names}")).len(), 1, "{append}");
        }
        assert_eq!(told(names).len(), 2);
        let shaft = "effects = { damping = { hinge_1 = 1 }, shft = { hinge = { segments = 1, stiffness = 1 } } }";
        assert_eq!(told(shaft), ["1: effects.shft"]);
    }

    #[test]
    fn a_misspelt_key_is_the_one_that_was_meant() {
        let doubted = |left_out: &str| Scene { left_out: vec![left_out.into()], ..Scene::default() };
        let meant = [("urfd", "urdf"), ("free_flyer", "base"), ("append[1].at", "append"), ("effects.shaft.x", "shaft"), ("args", "args")];
        for (left_out, key) in meant {
            assert!(doubted(left_out).doubts(key), "{left_out}");
        }
        assert!(doubted("whatever").doubted().next().is_none() && Scene::default().doubted().next().is_none());
        let mut log = Diagnostics::new("s.toml");
        log.error((At::Nowhere, "functions"), Code::UnknownFunction, "one", "another");
        doubted("append").keep_certain(&mut log);
        assert_eq!(log.count(), 1);
    }
}
