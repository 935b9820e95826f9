//! Numbers of effects in a robot's file: in a URDF, `<dynamics>` and `<limit>`.

use articulated_core::description::{ById, Joint, JointId, JointKind};
use articulated_core::effect::{Effect, EffectId, Zeros, effects};
use articulated_formats::world::World;

use super::collision;
use super::resolve::Filled;

/// Effects on links that a file may have, whole, with what has them there.
const ON_LINKS: [(EffectId, &str); 5] = [
    (EffectId::gravity_compensation, "gravcomp"),
    (EffectId::box_drag, "medium"),
    (EffectId::ellipsoid_drag, "medium"),
    (EffectId::tether, "stiffness of the free joint"),
    (EffectId::added_mass, "armature of the free joint"),
];

/// Effects on joints that `effects."*" = "file"` requests too.
const ON_JOINTS: [EffectId; 5] =
    [EffectId::damping, EffectId::polynomial_damping, EffectId::spring, EffectId::polynomial_spring, EffectId::armature];

/// Whether a file's numbers for this effect are of a smooth force, or of an inertia.
pub(super) fn is_smooth(effect: EffectId) -> bool {
    ON_JOINTS.contains(&effect) || of_link(effect).is_some()
}

/// The effects that `effects."*" = "file"` turns on, of those that the file has.
pub fn smooth_in_file(joints: &ById<JointId, Joint>, world: &World) -> impl Iterator<Item = &'static Effect> {
    effects().iter().filter(|row| is_smooth(row.id)).filter(|row| {
        // Fields without which it vanishes are the strength of each.
        let strengths = row.fields.iter().filter(|field| field.zeros != Zeros::Count).filter_map(|field| tag(row.id, field.name));
        let tags: Vec<&str> = strengths.collect();
        let of_joint = |joint: &Joint| tags.iter().filter_map(|tag| number(joint, tag)).any(|number| number != 0.0);
        joints.iter().any(of_joint) || world.effects.iter().any(|(own, _)| own.effect == row.id)
    })
}

/// What has an effect on links in the file.
pub(super) fn of_link(effect: EffectId) -> Option<&'static str> {
    ON_LINKS.iter().find(|(id, _)| *id == effect).map(|(_, name)| *name)
}

/// Whether the format has numbers for this effect.
pub(crate) fn offers(row: &Effect) -> bool {
    of_link(row.id).is_some() || row.fields.iter().any(|field| tag(row.id, field.name).is_some())
}

/// The word for the robot's file; `file` is a synonym.
pub(super) fn source(word: &str) -> &str {
    if word == "file" { "urdf" } else { word }
}

/// The words for the possible sources of an effect's numbers in the robot's file.
pub(crate) fn sources(row: &Effect) -> impl Iterator<Item = &'static str> {
    let urdf = Some(if of_link(row.id).is_some() { "file" } else { "urdf" }).filter(|_| offers(row));
    let collision = Some(collision::WORD).filter(|_| collision::offers(row));
    urdf.into_iter().chain(collision)
}

/// The tag and attribute that a field is taken from.
pub(crate) fn tag(effect: EffectId, field: &str) -> Option<&'static str> {
    match (effect, field) {
        (EffectId::damping, "damping") => Some("dynamics damping"),
        (EffectId::polynomial_damping, "quadratic") => Some("joint damping, quadratic"),
        (EffectId::polynomial_damping, "cubic") => Some("joint damping, cubic"),
        (EffectId::friction, "friction") => Some("dynamics friction"),
        (EffectId::armature, "inertia") => Some("joint armature"),
        (EffectId::spring, "stiffness") => Some("joint stiffness"),
        (EffectId::spring | EffectId::polynomial_spring, "rest") => Some("joint springref"),
        (EffectId::polynomial_spring, "quadratic") => Some("joint stiffness, quadratic"),
        (EffectId::polynomial_spring, "cubic") => Some("joint stiffness, cubic"),
        (EffectId::limit, "lower") => Some("limit lower"),
        (EffectId::limit, "upper") => Some("limit upper"),
        (EffectId::motor, "torque") => Some("limit effort"),
        (EffectId::motor, "speed") => Some("limit velocity"),
        _ => None,
    }
}

/// A URDF has effort and velocity of the joint, behind the gear: the motor's torque is smaller, and
/// its speed larger, by the gear ratio.
pub(super) fn before_the_gear(effect: EffectId, filled: &mut [Filled]) {
    let [torque, speed, (gear, _), ..] = filled else { return };
    let Some(gear) = gear.first().filter(|_| effect == EffectId::motor) else { return };
    torque.0.iter_mut().filter(|_| torque.1.is_some()).for_each(|x| *x /= gear);
    speed.0.iter_mut().filter(|_| speed.1.is_some()).for_each(|x| *x *= gear);
}

/// The number of a tag for a joint; `None` if it is missing or infinite.
pub(crate) fn number(joint: &Joint, tag: &str) -> Option<f64> {
    let number = match tag {
        "dynamics damping" => joint.dynamics.damping?,
        "joint damping, quadratic" => joint.dynamics.damping_terms?[0],
        "joint damping, cubic" => joint.dynamics.damping_terms?[1],
        "joint stiffness, quadratic" => joint.dynamics.stiffness_terms?[0],
        "joint stiffness, cubic" => joint.dynamics.stiffness_terms?[1],
        "dynamics friction" => joint.dynamics.friction?,
        "joint armature" => joint.dynamics.armature?,
        "joint stiffness" => joint.dynamics.stiffness?,
        "joint springref" => joint.dynamics.rest?,
        "limit lower" => joint.limit?.lower,
        // The largest angle of a ball joint; 0 if `<limit>` does not contain it.
        "limit upper" if joint.kind == JointKind::Spherical => Some(joint.limit?.upper).filter(|upper| *upper > 0.0)?,
        "limit upper" => joint.limit?.upper,
        "limit effort" => joint.limit?.effort,
        "limit velocity" => joint.limit?.velocity,
        _ => return None,
    };
    number.is_finite().then_some(number)
}
