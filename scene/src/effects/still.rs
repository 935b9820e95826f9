//! The moving joints and links of a robot.

use articulated_core::description::{Base, ById, Description, Joint, JointId, LinkId};

/// For each joint, whether its child can move: it is not fixed, not locked, and does not follow
/// only such joints. A cyclic chain of followers can move.
pub(crate) fn moving(description: &Description) -> ById<JointId, bool> {
    let joints = &description.joints;
    let mut moving: ById<JointId, bool> = vec![true; joints.len()].into();
    let mut seen: ById<JointId, bool> = vec![false; joints.len()].into();
    for start in joints.ids() {
        let (mut chain, mut next) = (Vec::new(), Some(start));
        while let Some(at) = next.filter(|at| !seen[*at]) {
            seen[at] = true;
            chain.push(at);
            moving[at] = !joints[at].kind.is_fixed() && joints[at].locked.is_none();
            next = leader(joints, at).filter(|_| moving[at]);
        }
        // The last one first: its leader was visited before.
        for at in chain.into_iter().rev() {
            moving[at] &= leader(joints, at).is_none_or(|leader| moving[leader]);
        }
    }
    // None of these joints leads another joint.
    for (at, joint) in joints.iter().enumerate().filter(|(_, joint)| !joint.also.is_empty()) {
        let mut leaders = joint.mimic.iter().chain(&joint.also);
        moving[JointId(at)] &= leaders.any(|mimic| moving.get(mimic.joint).is_none_or(|moves| *moves));
    }
    moving
}

/// The one joint that this one follows.
fn leader(joints: &ById<JointId, Joint>, at: JointId) -> Option<JointId> {
    joints[at].mimic.filter(|_| joints[at].also.is_empty()).map(|mimic| mimic.joint).filter(|leader| joints.get(*leader).is_some())
}

/// For each link, whether it is fixed to the base.
pub fn still(description: &Description, base: Base) -> ById<LinkId, bool> {
    let mut still: ById<LinkId, bool> = vec![false; description.links.len()].into();
    if base == Base::Floating {
        return still;
    }
    let mut fixed: ById<LinkId, Vec<LinkId>> = vec![Vec::new(); description.links.len()].into();
    for (joint, moves) in description.joints.iter().zip(moving(description)) {
        if let Some(children) = fixed.get_mut(joint.parent).filter(|_| !moves) {
            children.push(joint.child);
        }
    }
    let mut open: Vec<LinkId> = description.root().into_iter().collect();
    while let Some(link) = open.pop() {
        if let Some(seen) = still.get_mut(link).filter(|seen| !**seen) {
            *seen = true;
            open.append(&mut fixed[link]);
        }
    }
    still
}

#[cfg(test)]
mod tests {
    use articulated_core::description::Mimic;

    use articulated_core::description::JointKind;

    use super::*;

    #[test]
    fn what_follows_a_joint_that_does_not_move_does_not_move_however_long_the_chain_and_rings_move() {
        let count = 20_000;
        let follow = |joint| Some(Mimic::linear(JointId(joint), 1.0, 0.0));
        let mut joints: Vec<Joint> =
            (0..count).map(|k| Joint { kind: JointKind::Revolute, mimic: follow(k + 1), ..Joint::default() }).collect();
        joints[count - 1].mimic = None;
        let of = |joints: &[Joint]| moving(&Description { joints: joints.to_vec().into(), ..Description::default() }).into_vec();
        assert_eq!(of(&joints), vec![true; count]);
        joints[count / 2].locked = Some(vec![0.0]);
        let expected: Vec<bool> = (0..count).map(|k| k > count / 2).collect();
        assert_eq!(of(&joints), expected);
        (joints[count / 2].locked, joints[count / 2].kind) = (None, JointKind::Fixed);
        assert_eq!(of(&joints), expected);
        joints[count / 2].kind = JointKind::Revolute;
        (joints[count - 1].mimic, joints[7].mimic) = (follow(3), follow(count));
        assert_eq!(of(&joints), vec![true; count]);
    }

    #[test]
    fn what_follows_several_joints_moves_while_one_of_them_does() {
        let follow = |joint| Mimic::linear(joint, 1.0, 0.0);
        let mut joints = vec![Joint { kind: JointKind::Revolute, ..Joint::default() }; 4];
        (joints[0].mimic, joints[0].also) = (Some(follow(JointId(1))), vec![follow(JointId(2))]);
        let of = |joints: &[Joint]| moving(&Description { joints: joints.to_vec().into(), ..Description::default() });
        for (first, second) in [(false, false), (true, false), (false, true), (true, true)] {
            joints[1].locked = first.then(|| vec![0.0]);
            joints[2].locked = second.then(|| vec![0.0]);
            assert_eq!(of(&joints), [!(first && second), !first, !second, true].into());
        }
    }
}
