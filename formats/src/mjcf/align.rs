//! Free bodies with the frame of their inertia: `align` of a free joint and `alignfree`.

use super::axes::{in_axes, principal};
use super::bodies::{Body, Kind};
use super::mass::Mass;
use crate::pose::{IDENTITY, Pose, conjugate, rotate, scale};

/// Moves the frames of free bodies without children to their centres of mass and principal axes, if
/// the file requests it. Coordinates of the free joint are those of that frame.
pub(crate) fn align(bodies: &mut [Body<'_>], inertials: &mut [Option<Mass>]) {
    let mut has_child = vec![false; bodies.len()];
    bodies.iter().skip(1).for_each(|body| has_child[body.parent] = true);
    for ((body, inertial), has_child) in bodies.iter_mut().zip(inertials).zip(has_child).skip(1) {
        let Some(own) = inertial.as_mut().filter(|_| !has_child && is_aligned(body)) else { continue };
        let axes = own.axes.unwrap_or_else(|| principal(own.inertia).1);
        let frame = own.pose.then(&Pose { rotation: axes, ..Pose::default() });
        own.inertia = in_axes(axes, own.inertia);
        (own.pose, own.axes) = (Pose::default(), Some(IDENTITY));
        body.pose = body.pose.then(&frame);
        let inverse = inverse(&frame);
        body.geoms.iter_mut().for_each(|geom| geom.move_by(&inverse));
        body.sites.iter_mut().for_each(|site| site.pose = inverse.then(&site.pose));
    }
}

fn is_aligned(body: &Body<'_>) -> bool {
    let [joint] = body.joints.as_slice() else { return false };
    let says = match joint.element.text("align") {
        Some("true") => true,
        Some("false") => false,
        _ => body.settings.compiler.align_free,
    };
    joint.kind == Kind::Free && says
}

fn inverse(pose: &Pose) -> Pose {
    let rotation = conjugate(pose.rotation);
    Pose { position: scale(rotate(rotation, pose.position), -1.0), rotation }
}
