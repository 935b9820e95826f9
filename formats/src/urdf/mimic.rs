//! Which joint follows which.

use crate::xml::markup::hint;
use articulated_core::diagnostic::{Code, Diagnostics, Place, quote};
use std::collections::HashMap;

use articulated_core::listed;
use articulated_core::suggest::Suggester;

use super::ast::{DraftJoint, DraftMimic, has_one_coordinate};
use super::joints::kinds_with;
use crate::cycles::{around, cycles};
use crate::xml::number::is_expression;

/// For each joint, the joints that it follows.
pub(crate) struct Leaders {
    pub(crate) first: Vec<Option<usize>>,
    /// Those of [`DraftJoint::also`]; `None` for a missing joint, which has been reported.
    pub(crate) also: Vec<Vec<Option<usize>>>,
}

/// For each joint, the joints that it follows.
pub(crate) fn leaders(joints: &[DraftJoint], log: &mut Diagnostics) -> Leaders {
    let mut index = HashMap::new();
    for (i, joint) in joints.iter().enumerate() {
        joint.name.as_deref().into_iter().for_each(|name| *index.entry(name).or_insert(i) = i);
    }
    let mut suggester = Suggester::default();
    let mut leaders = Vec::with_capacity(joints.len());
    let mut also = Vec::with_capacity(joints.len());
    for follower in joints {
        let mut leader_of = |mimic: &DraftMimic| {
            report_follower(follower, mimic, log);
            let leader = index.get(mimic.leader.name.as_str()).copied();
            match leader {
                Some(leader) => {
                    report_leader(follower, mimic, &joints[leader], log);
                    // Of several leaders no range is known before their limits are added up.
                    if follower.also.is_empty() {
                        warn_of_motion(follower, mimic, &joints[leader], log);
                    }
                }
                None if is_expression(&mimic.leader.name) => {}
                None => report_unknown(follower, mimic, joints, &mut suggester, log),
            }
            leader
        };
        leaders.push(follower.mimic.as_ref().and_then(&mut leader_of));
        also.push(follower.also.iter().map(&mut leader_of).collect());
    }
    report_rings(joints, &leaders, log);
    let all = Leaders { first: leaders, also };
    report_chains(joints, &all, log);
    all
}

/// Reports leaders that follow several joints, and followers of several joints that lead
/// themselves.
fn report_chains(joints: &[DraftJoint], leaders: &Leaders, log: &mut Diagnostics) {
    for (start, follower) in joints.iter().enumerate() {
        let own = leaders.first[start].iter().zip(&follower.mimic);
        let further = leaders.also[start].iter().zip(&follower.also).filter_map(|(leader, mimic)| Some((leader.as_ref()?, mimic)));
        for (&leader, mimic) in own.chain(further) {
            // Along the chain of single leaders; a ring of these has been reported.
            let chain = std::iter::successors(Some(leader), |&j| leaders.first[j]).take(joints.len());
            let Some(end) = chain.into_iter().find(|&j| !joints[j].also.is_empty()) else { continue };
            let found = if end == start {
                "a joint that leads itself".to_owned()
            } else {
                format!("{}, which follows several joints", joints[end].subject())
            };
            error(follower, mimic, Code::LeaderCannotLead, found, "a joint to follow that moves by itself, or follows one that does", log);
        }
    }
}

fn error(follower: &DraftJoint, mimic: &DraftMimic, kind: Code, found: String, expected: &str, log: &mut Diagnostics) {
    let subject = follower.subject();
    let place = Place { at: mimic.leader.at, subject: &subject, field: "mimic" };
    log.error(place, kind, found, expected);
}

fn report_follower(follower: &DraftJoint, mimic: &DraftMimic, log: &mut Diagnostics) {
    if follower.kind.is_some_and(|kind| !has_one_coordinate(kind)) {
        let found = "a follower that does not have exactly one coordinate".to_owned();
        let expected = format!("a {} joint", kinds_with(has_one_coordinate));
        error(follower, mimic, Code::FollowerCannotFollow, found, &expected, log);
    }
}

fn report_leader(follower: &DraftJoint, mimic: &DraftMimic, leader: &DraftJoint, log: &mut Diagnostics) {
    if leader.kind.is_some_and(|kind| !has_one_coordinate(kind)) {
        let found = format!("{}, which does not have exactly one coordinate", quote(&mimic.leader.name));
        let expected = format!("a {} joint to follow", kinds_with(has_one_coordinate));
        error(follower, mimic, Code::LeaderCannotLead, found, &expected, log);
    }
}

/// Warns of a follower that does not move, or moves beyond its limits.
fn warn_of_motion(follower: &DraftJoint, mimic: &DraftMimic, leader: &DraftJoint, log: &mut Diagnostics) {
    let subject = follower.subject();
    let place = Place { at: mimic.leader.at, subject: &subject, field: "mimic" };
    let (multiplier, offset) = (mimic.multiplier.unwrap_or(1.0), mimic.offset.unwrap_or(0.0));
    if multiplier == 0.0 {
        let expected = "another number: with 0 the joint does not move; used as written";
        return log.warning(place, Code::MimicZero, "the multiplier 0", expected);
    }
    let (Some(own), Some(led)) = (follower.limit, leader.limit) else { return };
    let [a, b] = [led.lower, led.upper].map(|q| multiplier * q + offset);
    let (least, most) = (a.min(b), a.max(b));
    // Bounds are printed with some digits.
    let slack = 1e-3 * (own.upper - own.lower).abs();
    if led.lower <= led.upper && own.lower <= own.upper && (least < own.lower - slack || own.upper + slack < most) {
        let found = format!("a range of {least:.4} to {most:.4}, as {} moves within its limits", leader.subject());
        let expected = format!("a range within this joint's limits, {} to {}; used as written", own.lower, own.upper);
        log.warning(place, Code::MimicRange, found, expected);
    }
}

fn report_unknown(follower: &DraftJoint, mimic: &DraftMimic, joints: &[DraftJoint], suggester: &mut Suggester, log: &mut Diagnostics) {
    let name = &mimic.leader.name;
    let others = joints.iter().filter_map(|j| j.name.as_deref()).filter(|other| Some(*other) != follower.name.as_deref());
    let hint = hint(suggester.nearest(name, others));
    let found = format!("{}, which is not a joint of this file", quote(name));
    error(follower, mimic, Code::UnknownLeader, found, &format!("the name of a joint{hint}"), log);
}

fn report_rings(joints: &[DraftJoint], leaders: &[Option<usize>], log: &mut Diagnostics) {
    let leader = |joint: usize| leaders[joint];
    for start in cycles(joints.len(), leader) {
        let Some(mimic) = &joints[start].mimic else { continue };
        let found = if leader(start) == Some(start) {
            "a joint that mimics itself".to_owned()
        } else {
            let names = around(start, leader).map(|joint| joints[joint].subject());
            format!("a cycle of joints that mimic each other: {}", listed(names))
        };
        error(&joints[start], mimic, Code::MimicRing, found, "a joint to follow that moves on its own", log);
    }
}
