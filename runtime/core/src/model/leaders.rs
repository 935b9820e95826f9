//! The final leaders of joints that follow others.

use alloc::vec;
use alloc::vec::Vec;

use crate::description::{ById, Joint, JointId, MOST_DEGREE, Mimic};

/// The final leader of each joint.
pub(super) type Leads = ById<JointId, Option<Mimic>>;

/// Number of leaders that are visited one by one, with multipliers multiplied in their order;
/// beyond them, the known result is used.
const WALKED: usize = 16;

/// For each joint that follows another, its final leader: the joint at the end of its chain, which
/// follows none or is locked. `None` where a chain has no end, and for joints that follow none.
/// Work grows as the number of joints does, however long the chains are.
pub(super) fn leads(joints: &ById<JointId, Joint>) -> Leads {
    let mut leads: Leads = vec![None; joints.len()].into();
    let mut seen: ById<JointId, bool> = vec![false; joints.len()].into();
    for start in joints.ids() {
        let (mut chain, mut at) = (Vec::new(), start);
        while let Some(mimic) = joints.get(at).and_then(followed).filter(|_| !seen[at]) {
            seen[at] = true;
            chain.push((at, mimic));
            at = mimic.joint;
        }
        for (joint, mimic) in chain.into_iter().rev() {
            leads[joint] = lead(joints, &leads, mimic);
        }
    }
    leads
}

/// The final leader of each further term of a joint that follows several: `None` as in [`leads`].
pub(super) fn others(joints: &ById<JointId, Joint>, leads: &Leads, joint: &Joint) -> Vec<Option<Mimic>> {
    joint.also.iter().map(|term| lead(joints, leads, *term)).collect()
}

/// The final leader of the chain that begins with `first`; beyond its first few joints, `known` has
/// it already.
fn lead(joints: &ById<JointId, Joint>, known: &Leads, first: Mimic) -> Option<Mimic> {
    let (mut lead, mut walked) = (first, 0);
    while let Some(own) = followed(joints.get(lead.joint)?) {
        // A joint that follows several has no single leader.
        if !joints[lead.joint].also.is_empty() {
            return None;
        }
        let next = if walked < WALKED { own } else { known[lead.joint]? };
        lead = composed(&lead, &next)?;
        walked += 1;
    }
    Some(lead)
}

/// f(g(x)) of the leader's leader x. `None` if its degree is above [`MOST_DEGREE`].
fn composed(outer: &Mimic, inner: &Mimic) -> Option<Mimic> {
    if (outer.higher, inner.higher) == ([0.0; 3], [0.0; 3]) {
        // multiplier · (m x + o) + offset
        let (multiplier, offset) = (outer.multiplier * inner.multiplier, outer.multiplier * inner.offset + outer.offset);
        return Some(Mimic::linear(inner.joint, multiplier, offset));
    }
    if outer.degree() * inner.degree() > MOST_DEGREE {
        return None;
    }
    let powers = |law: &Mimic| [law.offset, law.multiplier, law.higher[0], law.higher[1], law.higher[2]];
    let (outer, g) = (powers(outer), powers(inner));
    // Horner: p ← p g + c
    let mut p = [0.0; MOST_DEGREE + 1];
    for c in outer.into_iter().rev() {
        let mut product = [0.0; MOST_DEGREE + 1];
        for (i, x) in p.iter().enumerate() {
            g.iter().enumerate().filter(|(k, _)| i + k <= MOST_DEGREE).for_each(|(k, y)| product[i + k] += x * y);
        }
        product[0] += c;
        p = product;
    }
    let [offset, multiplier, higher @ ..] = p;
    Some(Mimic { joint: inner.joint, multiplier, offset, higher })
}

/// How a joint follows another; a locked one follows none.
fn followed(joint: &Joint) -> Option<Mimic> {
    joint.mimic.filter(|_| joint.locked.is_none())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Joints that follow those of these indices.
    fn joints(leaders: &[Option<usize>]) -> ById<JointId, Joint> {
        let follow = |(k, joint): (usize, usize)| Mimic::linear(JointId(joint), 1.0 + 0.3 / (k + 3) as f64, 0.1 * k as f64 - 0.7);
        let joint = |(k, leader): (usize, &Option<usize>)| Joint { mimic: leader.map(|l| follow((k, l))), ..Default::default() };
        leaders.iter().enumerate().map(joint).collect()
    }

    /// From leader to leader, in their order.
    fn walked(joints: &ById<JointId, Joint>, start: JointId) -> (f64, f64) {
        let (mut at, mut multiplier, mut offset) = (start, 1.0, 0.0);
        while let Some(next) = joints[at].mimic {
            (at, multiplier, offset) = (next.joint, multiplier * next.multiplier, multiplier * next.offset + offset);
        }
        (multiplier, offset)
    }

    #[test]
    fn a_chain_of_followers_is_what_walking_through_it_gives_and_to_the_bit_where_it_is_short() {
        let chain: Vec<Option<usize>> = (0..200_usize).map(|k| k.checked_sub(1)).collect();
        let joints = joints(&chain);
        for (k, found) in leads(&joints).into_iter().enumerate().skip(1) {
            let (found, (multiplier, offset)) = (found.unwrap(), walked(&joints, JointId(k)));
            let far = [found.multiplier / multiplier - 1.0, found.offset / offset - 1.0];
            assert!(
                found.joint == JointId(0) && far.iter().all(|x| x.abs() < if k < WALKED { f64::MIN_POSITIVE } else { 1e-13 }),
                "{k}: {far:?}"
            );
        }
    }

    #[test]
    fn the_order_of_the_file_does_not_count() {
        let count = 100;
        let backward: Vec<Option<usize>> = (0..count).map(|k| Some(k + 1).filter(|k| *k < count)).collect();
        let found = leads(&joints(&backward));
        assert!(
            found.iter().take(count - 1).all(|lead| lead.is_some_and(|lead| lead.joint == JointId(count - 1)))
                && found[JointId(count - 1)].is_none()
        );
    }

    #[test]
    fn a_chain_ends_at_a_locked_joint_and_rings_and_joints_that_are_not_there_end_none() {
        let mut ring: Vec<Option<usize>> = (0..50).map(|k| Some((k + 1) % 50)).collect();
        ring.extend([Some(7), Some(50), None, Some(52), Some(1000)]);
        let mut joints = joints(&ring);
        let found = leads(&joints);
        let ends = |found: &Leads| (0..55).filter_map(|k| Some((k, found[JointId(k)]?.joint.0))).collect::<Vec<_>>();
        assert_eq!(ends(&found), [(53, 52)]);
        joints[JointId(20)].locked = Some(vec![0.5]);
        let found = ends(&leads(&joints));
        assert_eq!(found.len(), 52);
        assert!(found.iter().all(|(joint, end)| *end == if *joint == 53 { 52 } else { 20 }), "{found:?}");
    }
}
