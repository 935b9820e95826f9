//! Numbers of joints outside `<joint>`: the inertias of rotors in `<transmission>` (ROS, Drake),
//! and the springs in `<gazebo reference="joint">`. A scene may turn them on: they are kept in the
//! joint's dynamics. The rigid-body dynamics do not use them, so they cause no errors.

use std::collections::BTreeMap;

use articulated_core::diagnostic::{At, Code, Diagnostics, Place, Subject, quote};
use articulated_core::suggest::Suggester;

use super::ast::{DraftJoint, has_one_coordinate};
use crate::xml::element::Tag;
use crate::xml::markup::hint;
use crate::xml::number::{self, is_expression};

/// Tags with the inertia of a rotor about its own axis, kg·m².
const ROTOR: [&str; 3] = ["motorInertia", "rotorInertia", "drake:rotor_inertia"];
/// Tags with revolutions of the rotor per revolution of the joint.
const GEAR: [&str; 3] = ["mechanicalReduction", "mechanical_reduction", "drake:gear_ratio"];

const KEPT: &str = "kept for scenes that turn on such forces; no part of the rigid-body dynamics";
const NOT_USED: &str = "the inertia of the rotor is not used";
const NO_FORCE: &str = "no such force acts";

/// Keeps I n² of the rotors that transmissions state.
pub(crate) fn keep_rotors(robot: &Tag<'_>, joints: &mut [DraftJoint], log: &mut Diagnostics) {
    let index = by_name(joints);
    let mut suggester = Suggester::default();
    let mut kept: BTreeMap<usize, Vec<Rotor>> = BTreeMap::new();
    for tag in robot.children().filter(|tag| tag.is("transmission")) {
        warn_of_unknown_joints(&tag, &index, &mut suggester, log);
        let Some(stated) = tag.descendants().find(|inner| is_one_of(inner, &ROTOR)) else {
            tag.unused(log, tag.name(), "settings of a controller; no inertia of a rotor");
            continue;
        };
        match rotor(&tag, &stated, joints, &index, log) {
            Some((joint, rotor)) => kept.entry(joint).or_default().push(rotor),
            None => tag.unused(log, tag.name(), NOT_USED),
        }
    }
    for (joint, rotors) in kept {
        let subject = joints[joint].subject();
        match rotors.as_slice() {
            [one] => {
                joints[joint].dynamics.armature = Some(one.armature);
                log.unused_at(one.at, &subject, "joint armature".to_owned(), KEPT);
            }
            several => {
                let place = Place { at: several[1].at, subject: &subject, field: "transmission" };
                let found = format!("{} transmissions with the inertia of a rotor", several.len());
                log.warning(place, Code::LostDynamics, found, format!("one for each joint: {NOT_USED}"));
                several.iter().for_each(|one| log.unused_at(one.at, &Subject::Document, "transmission".to_owned(), NOT_USED));
            }
        }
    }
}

/// A rotor, seen behind its gear.
struct Rotor {
    /// kg·m² for a joint that turns, kg for one that slides.
    armature: f64,
    /// The place of its transmission.
    at: At,
}

fn by_name(joints: &[DraftJoint]) -> BTreeMap<String, usize> {
    joints.iter().enumerate().rev().filter_map(|(i, joint)| Some((joint.name.clone()?, i))).collect()
}

fn is_one_of(tag: &Tag<'_>, names: &[&str]) -> bool {
    names.iter().any(|name| tag.is(name))
}

fn warn_of_unknown_joints(tag: &Tag<'_>, index: &BTreeMap<String, usize>, suggester: &mut Suggester, log: &mut Diagnostics) {
    for joint in tag.children().filter(|child| child.is("joint")) {
        let Some((name, at)) = joint.attribute("name") else { continue };
        if index.contains_key(name) || is_expression(name) {
            continue;
        }
        let near = hint(suggester.nearest(name, index.keys().map(String::as_str)));
        let found = format!("{}, which is not a joint of this file", quote(name));
        let expected = format!("the name of a joint{near}; the transmission is not used");
        log.warning(Place { at, ..joint.place("transmission joint") }, Code::UnknownJoint, found, expected);
    }
}

/// The joint of a transmission, and its rotor. A warning if the transmission does not state them.
fn rotor(
    tag: &Tag<'_>,
    stated: &Tag<'_>,
    joints: &[DraftJoint],
    index: &BTreeMap<String, usize>,
    log: &mut Diagnostics,
) -> Option<(usize, Rotor)> {
    let inside = |which: fn(&str) -> bool| tag.children().filter(move |child| which(&child.name())).collect::<Vec<_>>();
    let of_joints = inside(|name| name.to_lowercase().ends_with("joint"));
    let actuators = inside(|name| name.to_lowercase().ends_with("actuator"));
    if of_joints.len() != 1 || actuators.len() != 1 {
        let found = format!("the inertia of a rotor in a transmission of {} joints and {} actuators", of_joints.len(), actuators.len());
        let expected = format!("one <joint> and one <actuator>: {NOT_USED}");
        log.warning(stated.place(&stated.name()), Code::LostDynamics, found, expected);
        return None;
    }
    // An unknown joint has been reported.
    let joint = *index.get(of_joints[0].attribute("name")?.0)?;
    let subject = joints[joint].subject();
    let holders = || [tag, &of_joints[0], &actuators[0]].into_iter().map(|holder| holder.of(&subject));
    let inertia = agreed(holders(), &ROTOR, "inertia of the rotor", log);
    let gear = agreed(holders(), &GEAR, "gear ratio", log);
    let (inertia, gear) = (inertia??, gear?.unwrap_or(1.0));
    if joints[joint].kind.is_some_and(|kind| !has_one_coordinate(kind)) {
        let expected = format!("a joint with one coordinate: {NOT_USED}");
        log.warning(stated.of(&subject).place("transmission"), Code::LostDynamics, "the inertia of a rotor", expected);
        return None;
    }
    if inertia < 0.0 || gear == 0.0 {
        let found = format!("the inertia {inertia} behind the gear ratio {gear}");
        let expected = format!("an inertia of at least 0 and a gear ratio other than 0: {NOT_USED}");
        log.warning(stated.of(&subject).place("transmission"), Code::Negative, found, expected);
        return None;
    }
    Some((joint, Rotor { armature: inertia * gear * gear, at: tag.at() }))
}

/// The number that all tags of these names state; `Some(None)` without such tags. `None`, with a
/// warning, if a number is missing or two differ.
fn agreed<'a>(holders: impl Iterator<Item = Tag<'a>>, names: &[&str], what: &str, log: &mut Diagnostics) -> Option<Option<f64>> {
    let mut first: Option<(f64, String)> = None;
    for tag in holders.flat_map(|holder| holder.children().collect::<Vec<_>>()).filter(|tag| is_one_of(tag, names)) {
        let number = number_of(&tag, NOT_USED, log)?;
        match &first {
            None => first = Some((number, tag.name())),
            Some((other, name)) if *other != number => {
                let found = format!("the {what} {number} in <{}> beside {other} in <{name}>", tag.name());
                log.warning(tag.place("transmission"), Code::Together, found, format!("one {what}: {NOT_USED}"));
                return None;
            }
            Some(_) => {}
        }
    }
    Some(first.map(|(number, _)| number))
}

/// The number in `value` or in the text of a tag; `None`, with a warning, if it is not a number.
fn number_of(tag: &Tag<'_>, rest: &str, log: &mut Diagnostics) -> Option<f64> {
    let (text, at) = tag.attribute("value").or_else(|| tag.text()).unwrap_or(("", tag.at()));
    let number = number::parse(text.trim()).ok();
    if number.is_none() && !(tag.reports_expressions() && is_expression(text)) {
        let field = format!("<{}>", tag.name());
        log.warning(Place { at, ..tag.place(&field) }, Code::NotANumber, quote(text.trim()), format!("a decimal number; {rest}"));
    }
    number
}

/// The tag of Gazebo with the stiffness of a spring at a joint.
pub(crate) const SPRING: &str = "springStiffness";

/// Keeps the springs that Gazebo has at joints: `<springStiffness>` and `<springReference>` inside
/// `<gazebo reference="joint">`.
pub(crate) fn keep_springs(robot: &Tag<'_>, joints: &mut [DraftJoint], log: &mut Diagnostics) {
    let index = by_name(joints);
    for gazebo in robot.children().filter(|tag| tag.is("gazebo")) {
        let Some((reference, _)) = gazebo.attribute("reference") else { continue };
        let Some(tag) = gazebo.children().find(|child| child.is(SPRING)) else { continue };
        let stiffness = number_of(&tag, NO_FORCE, log);
        if stiffness == Some(0.0) {
            continue;
        }
        let place = tag.place("<springStiffness>");
        let lost = |found: String, expected: &str, log: &mut Diagnostics| {
            log.warning(place, Code::LostDynamics, found, format!("{expected}; {NO_FORCE}"));
        };
        let found = format!("a spring inside <gazebo reference={}>", quote(reference));
        let has_one = |joint: &&mut DraftJoint| joint.kind.is_none_or(has_one_coordinate);
        let Some(joint) = index.get(reference).map(|at| &mut joints[*at]).filter(has_one) else {
            lost(found, "the name of a joint with one coordinate", log);
            continue;
        };
        let Some(stiffness) = stiffness else { continue };
        let rest = gazebo.children().find(|child| child.is("springReference"));
        let at_rest = rest.as_ref().and_then(|rest| number_of(rest, NO_FORCE, log));
        if joint.dynamics.stiffness.is_some() {
            lost(found, "one spring for each joint: the first is kept", log);
            continue;
        }
        (joint.dynamics.stiffness, joint.dynamics.rest) = (Some(stiffness), at_rest);
        let subject = joint.subject();
        log.unused_at(tag.at(), &subject, "joint stiffness".to_owned(), KEPT);
        if let (Some(rest), Some(_)) = (rest, at_rest) {
            log.unused_at(rest.at(), &subject, "joint springref".to_owned(), KEPT);
        }
    }
}
