//! Frames turned about the axes of their joints, to where rotations have zeros.

use articulated_core::Scalar;
use articulated_core::algorithm::Formulation;
use articulated_core::index::{BodyId, ById, FrameId};
use articulated_core::joint::Angle;
use articulated_core::model::{Body, BodyLink, ModelParts};
use articulated_core::spatial::{Matrix3, Placement, Vector3, nearest_rotation, rotate_back};

use super::view::View;
use super::zeros::{count, or_zero, within};

/// Turns the frame of each revolute body about its axis, so that the fixed rotations between joints
/// have fewer numbers.
///
/// A frame may point anywhere around the axis of its joint if the joint's angle is counted from
/// there: a fixed rotation R followed by Rz(q) is R' followed by Rz(q + o), with R = R' Rz(o). So
/// of a rotation given by three angles one is left, or none where the axis is a coordinate axis of
/// its parent, and the constant o goes into the sine and cosine of q. A body is turned for its
/// children too where that costs less. Exact for all joint torques; frames of links stay where they
/// are in space.
pub fn turn<S: Scalar>(view: View<S>) -> View<S> {
    let View { model, mut formulation } = view;
    let mut hanging = ById::<BodyId, _>::from(vec![Hanging::default(); model.bodies().len()]);
    model.outward().for_each(|i| hanging[model.bodies()[i].parent].bodies.push(i));
    model.frames().with_ids().for_each(|(k, frame)| hanging[frame.body].frames.push(k));
    let model = model.changed(|parts| {
        for (i, hanging) in hanging.with_ids().skip(1) {
            let body = &parts.bodies[i];
            if !body.joint.is_rotation_about_axis() || !known(&body.placement.rotation) {
                continue;
            }
            let angle = best(&parts.bodies, i, &hanging.bodies);
            if !angle.is_zero() {
                turn_body(parts, i, &angle, hanging);
            }
            // On the base only gravity is turned, and that once and for all.
            if parts.bodies[i].parent != BodyId::BASE {
                count_from_there(&mut parts.bodies[i], &mut formulation, i);
            }
        }
    });
    View { model, formulation }
}

/// Children of a body: other bodies, and frames of links.
#[derive(Clone, Default)]
struct Hanging {
    bodies: Vec<BodyId>,
    frames: Vec<FrameId>,
}

/// Instructions for a number of a rotation (of angular velocity and acceleration, acceleration,
/// moment and force), of an offset, of h and of Σ off the diagonal, and for an angle counted from
/// elsewhere.
const ROTATION: u32 = 5;
const OFFSET: u32 = 5;
const FIRST: u32 = 5;
const SECOND: u32 = 4;
const ANGLE: u32 = 4;

/// The best angle of body `i` for its children, among zero and the angles that bring the axis of a
/// child into a coordinate plane.
fn best<S: Scalar>(bodies: &ById<BodyId, Body<S>>, i: BodyId, children: &[BodyId]) -> Angle<S> {
    let mut best: Option<(u32, Angle<S>)> = None;
    for child in children.iter().map(|&k| &bodies[k]).filter(|b| known(&b.placement.rotation)) {
        let z = child.placement.rotation.column(2);
        if z.x == S::zero() || z.y == S::zero() {
            continue;
        }
        let length = (z.x * z.x + z.y * z.y).sqrt();
        let (x, y) = (z.x / length, z.y / length);
        // The new x-axis, or the new y-axis, below the child's axis.
        for angle in [Angle { sin: y, cos: x }, Angle { sin: -x, cos: y }] {
            let none = || (cost(bodies, i, &Angle::zero(), children), Angle::zero());
            let cost = cost(bodies, i, &angle, children);
            let before = *best.get_or_insert_with(none);
            if cost < before.0 {
                best = Some((cost, angle));
            }
        }
    }
    best.map_or_else(Angle::zero, |(_, angle)| angle)
}

/// The cost of body `i` and of the rotations and offsets of its children after a turn.
fn cost<S: Scalar>(bodies: &ById<BodyId, Body<S>>, i: BodyId, angle: &Angle<S>, children: &[BodyId]) -> u32 {
    let inertia = bodies[i].inertia.turned(&angle.rotation().transpose());
    let (h, s) = (inertia.first, inertia.second);
    let own = FIRST * count(&[h.x, h.y]) + SECOND * count(&[s.m12, s.m13, s.m23]) + if is_quarter(angle) { 0 } else { ANGLE };
    children.iter().map(|&k| &bodies[k]).fold(own, |sum, child| {
        let (rotation, position) = (turned(&child.placement.rotation, angle), back(angle, child.placement.position));
        let from_there = child.joint.is_rotation_about_axis().then(|| plain(&rotation)).flatten();
        let (rotation, angle) = from_there.unwrap_or((rotation, Angle::zero()));
        let numbers = rotation.iter().filter(|x| **x != S::zero() && **x != S::one() && **x != -S::one()).count() as u32;
        sum + ROTATION * numbers + OFFSET * count(position.as_slice()) + if is_quarter(&angle) { 0 } else { ANGLE }
    })
}

/// Whether the turn at most exchanges sine and cosine of q.
fn is_quarter<S: Scalar>(angle: &Angle<S>) -> bool {
    angle.sin == S::zero() || angle.cos == S::zero()
}

/// Turns the frame of body `i` about its axis, with the joint's frame.
fn turn_body<S: Scalar>(parts: &mut ModelParts<S>, i: BodyId, angle: &Angle<S>, hanging: &Hanging) {
    let rotation = angle.rotation();
    let body = &mut parts.bodies[i];
    body.placement.rotation = nearest_rotation(&(body.placement.rotation * rotation).map(tidy));
    body.inertia = body.inertia.turned(&rotation.transpose());
    if let Some(BodyLink { placement, .. }) = &mut body.link {
        *placement = Placement { rotation: rotation.transpose() * placement.rotation, position: back(angle, placement.position) };
    }
    let turn = |x: &mut Placement<S>| {
        *x = Placement { rotation: nearest_rotation(&turned(&x.rotation, angle)), position: back(angle, x.position) }
    };
    hanging.bodies.iter().for_each(|&k| turn(&mut parts.bodies[k].placement));
    hanging.frames.iter().for_each(|&k| turn(&mut parts.frames[k].placement));
    parts.bodies[i].effects.body.iter_mut().for_each(|e| turn(&mut e.placement));
    parts.actuators.frames_mut().filter(|own| own.body == i).for_each(|own| turn(&mut own.placement));
}

/// Replaces the fixed rotation of body `i` by the plain one about the same axis, and counts the
/// joint's angle from there.
fn count_from_there<S: Scalar>(body: &mut Body<S>, formulation: &mut Formulation<S>, i: BodyId) {
    body.placement.rotation = body.placement.rotation.map(tidy);
    if let Some((rotation, angle)) = plain(&body.placement.rotation) {
        body.placement.rotation = rotation;
        formulation.rotations[i].offset = angle;
    }
}

/// R' and o with R = R' Rz(o): R' is the same for all R with this third column, as in the model's
/// builder. `None` if no coordinate axis is perpendicular to that column.
fn plain<S: Scalar>(r: &Matrix3<S>) -> Option<(Matrix3<S>, Angle<S>)> {
    let (o, x, z) = (S::zero(), r.column(0), r.column(2).into_owned());
    let k = match [z.x == o, z.y == o, z.z == o] {
        [true, false, true] if within(o, z.y) => 2,
        [false, true, true] => 1,
        zeros => zeros.iter().position(|zero| *zero)?,
    };
    let new_x = Vector3::from_fn(|j, _| if j == k { S::one() } else { o });
    let new_y = z.cross(&new_x);
    let angle = nearest_rotation(&Angle { sin: tidy(new_y.dot(&x)), cos: tidy(new_x.dot(&x)) }.rotation());
    let angle = Angle { sin: angle.m21, cos: angle.m11 };
    Some((Matrix3::from_columns(&[new_x, new_y, z]), angle))
}

/// A rotation or a direction of the parent's, when the parent is turned.
fn turned<S: Scalar>(r: &Matrix3<S>, angle: &Angle<S>) -> Matrix3<S> {
    (angle.rotation().transpose() * r).map(tidy)
}

fn back<S: Scalar>(angle: &Angle<S>, x: Vector3<S>) -> Vector3<S> {
    let size = x.fold(S::zero(), |sum, x| sum + x.abs());
    rotate_back(&angle.rotation(), x).map(|x| or_zero(x, size))
}

/// Snaps a rotation entry to 0 or ±1 within rounding error.
fn tidy<S: Scalar>(x: S) -> S {
    let one = S::one();
    let near = |value: S| or_zero(x - value, one) == S::zero();
    [S::zero(), one, -one].into_iter().find(|value| near(*value)).unwrap_or(x)
}

/// Whether the numbers are known, and not symbols.
fn known<S: Scalar>(r: &Matrix3<S>) -> bool {
    r.iter().all(|x| within(x.abs(), S::one() + S::one()))
}
