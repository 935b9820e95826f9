//! What of a robot moves.

use articulated_core::description::{Base, Description, Joint, JointKind};

/// Whether the joint lets its child move.
pub(crate) fn moves(joint: &Joint) -> bool {
    joint.kind != JointKind::Fixed && joint.locked.is_none()
}

/// For each link, whether it is fixed to the base.
pub(crate) fn still(description: &Description, base: Base) -> Vec<bool> {
    let mut still = vec![false; description.links.len()];
    if base == Base::Floating {
        return still;
    }
    let mut fixed = vec![Vec::new(); description.links.len()];
    for joint in description.joints.iter().filter(|j| !moves(j) && j.parent < still.len()) {
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
