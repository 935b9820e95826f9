//! What of a robot moves.

use articulated_core::description::{Base, Description, Joint, JointKind};

/// Whether the joint lets its child move: it is not fixed, not locked, and does not follow one that is locked.
pub(crate) fn moves(description: &Description, joint: &Joint) -> bool {
    let mut joint = joint;
    // A chain of joints that follow each other is no longer than there are joints.
    for _ in 0..=description.joints.len() {
        if joint.kind == JointKind::Fixed || joint.locked.is_some() {
            return false;
        }
        match joint.mimic.and_then(|mimic| description.joints.get(mimic.joint)) {
            Some(leader) => joint = leader,
            None => return true,
        }
    }
    true
}

/// For each link, whether it is fixed to the base.
pub fn still(description: &Description, base: Base) -> Vec<bool> {
    let mut still = vec![false; description.links.len()];
    if base == Base::Floating {
        return still;
    }
    let mut fixed = vec![Vec::new(); description.links.len()];
    for joint in description.joints.iter().filter(|j| j.parent < still.len() && !moves(description, j)) {
        fixed[joint.parent].push(joint.child);
    }
    let mut open: Vec<usize> = description.root().into_iter().collect();
    while let Some(link) = open.pop() {
        if let Some(seen) = still.get_mut(link).filter(|seen| !**seen) {
            *seen = true;
            open.append(&mut fixed[link]);
        }
    }
    still
}
