//! Names that links and joints of a robot have, while it is edited.

use alloc::collections::BTreeMap;
use alloc::format;
use alloc::string::{String, ToString};

use super::{Description, JointId, LinkId};

/// The indices of a robot's links and joints by their names.
#[derive(Clone, Debug, Default)]
pub(super) struct Names {
    links: BTreeMap<String, LinkId>,
    frames: BTreeMap<String, usize>,
    joints: BTreeMap<String, JointId>,
    /// For names that were requested and taken, the first number that may be free. Names are only
    /// added, so lower numbers stay taken.
    numbers: BTreeMap<String, usize>,
}

impl Names {
    pub(super) fn of(robot: &Description) -> Self {
        let mut names = Self::default();
        robot.links.with_ids().for_each(|(index, link)| names.add_link(&link.name, index));
        robot.joints.with_ids().for_each(|(index, joint)| names.add_joint(&joint.name, index));
        robot.frames.iter().enumerate().for_each(|(index, frame)| names.add_frame(&frame.name, index));
        names
    }

    /// Where several have one name, the first is found.
    pub(super) fn add_link(&mut self, name: &str, index: LinkId) {
        self.links.entry(name.to_string()).or_insert(index);
    }

    /// As [`Self::add_link`].
    pub(super) fn add_joint(&mut self, name: &str, index: JointId) {
        self.joints.entry(name.to_string()).or_insert(index);
    }

    /// A name of a frame that is not a link.
    pub(super) fn add_frame(&mut self, name: &str, index: usize) {
        self.frames.entry(name.to_string()).or_insert(index);
    }

    /// Whether a link or another frame has this name.
    pub(super) fn has_frame(&self, name: &str) -> bool {
        self.links.contains_key(name) || self.frames.contains_key(name)
    }

    pub(super) fn link(&self, name: &str) -> Option<LinkId> {
        self.links.get(name).copied()
    }

    /// A frame that is not a link.
    pub(super) fn frame(&self, name: &str) -> Option<usize> {
        self.frames.get(name).copied()
    }

    pub(super) fn joint(&self, name: &str) -> Option<JointId> {
        self.joints.get(name).copied()
    }

    pub(super) fn has(&self, name: &str) -> bool {
        self.has_frame(name) || self.joints.contains_key(name)
    }

    /// `name`, or with the first number from 2 on that no link and no joint has.
    pub(super) fn free(&mut self, name: &str) -> String {
        if !self.has(name) {
            return name.to_string();
        }
        let mut number = self.numbers.get(name).copied().unwrap_or(2);
        let mut free = format!("{name}_{number}");
        while self.has(&free) {
            number += 1;
            free = format!("{name}_{number}");
        }
        self.numbers.insert(name.to_string(), number);
        free
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_free_name_has_the_first_number_that_none_has() {
        let mut names = Names::default();
        let taken = |names: &mut Names| {
            let name = names.free("tip");
            names.add_link(&name, LinkId(0));
            name
        };
        assert_eq!([0; 2].map(|_| taken(&mut names)), ["tip", "tip_2"]);
        names.add_joint("tip_3", JointId(0));
        names.add_link("tip_5", LinkId(0));
        assert_eq!([0; 3].map(|_| taken(&mut names)), ["tip_4", "tip_6", "tip_7"]);
        // A name that was not taken stays free.
        assert_eq!([0; 2].map(|_| names.free("tip")), ["tip_8", "tip_8"]);
    }
}
