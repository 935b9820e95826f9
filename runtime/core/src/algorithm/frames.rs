//! Twists, accelerations and Jacobians of frames, in three references ([`Reference`]).
//!
//! All read the outward sweep in world axes ([`super::common`]): a column of a Jacobian is the
//! motion subspace of one degree of freedom on the way from the frame to the base, taken at another
//! point and turned. Lynch & Park 2017, §5.1; Featherstone 2008, §2.9 and §2.11.

use super::Workspace;
use super::common::{Axes, accelerations, on_the_way, positions, positions_of_frames, twists};
use super::workspace::Column;
use crate::Scalar;
use crate::index::BodyId;
use crate::model::{Frame, Model};
use crate::spatial::{Placement, Reference, Twist, Vector3};

macro_rules! in_three_references {
    ($($(#[$doc:meta])* $name:ident, $body:ident, $world:ident, $aligned:ident, ($($argument:ident),*);)*) => {$(
        $(#[$doc])*
        ///
        /// # Panics
        /// If a slice is shorter than stated; [`super::Function::call`] and
        /// [`crate::dynamics::Dynamics`] check and return an error.
        pub fn $body<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, $($argument: &[S],)* out: &mut [S]) {
            $name(model, ws, Reference::Body, $($argument,)* out);
        }

        #[doc = concat!("As [`", stringify!($body), "`], in world axes about the world frame's origin.")]
        ///
        /// # Panics
        /// Likewise.
        pub fn $world<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, $($argument: &[S],)* out: &mut [S]) {
            $name(model, ws, Reference::World, $($argument,)* out);
        }

        #[doc = concat!("As [`", stringify!($body), "`], in world axes about the frame's origin.")]
        ///
        /// # Panics
        /// Likewise.
        pub fn $aligned<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, $($argument: &[S],)* out: &mut [S]) {
            $name(model, ws, Reference::WorldAligned, $($argument,)* out);
        }
    )*};
}

in_three_references! {
    /// Twists of all frames, [ω; v] in rad/s and m/s, in axes of the frame about its origin.
    ///
    /// q: `[nq]`; v: `[nv]`; out: `[frames][6]`.
    frame_twists, twists_body, twists_world, twists_world_aligned, (q, v);

    /// Time derivatives of the twists of all frames, rad/s² and m/s², gravity not added: spatial
    /// accelerations. About the frame's origin in world axes: [ω̇; p̈], the true acceleration of
    /// the origin.
    ///
    /// q: `[nq]`; v: `[nv]`; a: `[nv]`, or empty for zeros; out: `[frames][6]`.
    frame_accelerations, accelerations_body, accelerations_world, accelerations_world_aligned, (q, v, a);

    /// Jacobians of all frames: twist = J v, with the six rows of the twist [ω; v] of the same
    /// reference (`_body`: own axes, own origin; `_world`: world axes, the world's origin;
    /// `_world_aligned`: world axes, own origin) and a column for each degree of freedom.
    ///
    /// q: `[nq]`; out: `[frames][6][nv]`, 1 and m per rad, or m per m.
    frame_jacobians, jacobians_body, jacobians_world, jacobians_world_aligned, (q);

    /// dJ/dt of the Jacobians of all frames.
    ///
    /// q: `[nq]`; v: `[nv]`; out: `[frames][6][nv]`.
    frame_jacobian_rates, jacobian_rates_body, jacobian_rates_world, jacobian_rates_world_aligned, (q, v);
}

/// A frame in world axes: its placement in the world frame, and its origin from that of its body.
struct Place<S> {
    frame: Placement<S>,
    offset: Vector3<S>,
}

impl<S: Scalar> Place<S> {
    fn new(ws: &Workspace<S>, frame: &Frame<S>) -> Self {
        let body = &ws.common[frame.body];
        let x = Placement { rotation: body.rotation, position: Vector3::zeros() }.compose(&frame.placement);
        Self { frame: Placement { rotation: x.rotation, position: body.position + x.position }, offset: x.position }
    }

    /// A twist that is in world axes about the frame's origin, in the axes and about the point of
    /// the reference.
    fn refer(&self, x: Twist<S>, reference: Reference) -> Twist<S> {
        match reference {
            Reference::WorldAligned => x,
            Reference::World => x.at(-self.frame.position),
            Reference::Body => x.turned_back(&self.frame.rotation),
        }
    }
}

fn frame_twists<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, reference: Reference, q: &[S], v: &[S], out: &mut [S]) {
    positions(model, ws, Axes::Base, q);
    twists(model, ws, Axes::Base, v);
    for (frame, out) in model.frames.iter().zip(out.chunks_exact_mut(6)) {
        let place = Place::new(ws, frame);
        let twist = twist_of(ws, frame, &place);
        out.copy_from_slice(&place.refer(twist, reference).to_array());
    }
}

/// In world axes, about the frame's origin; zero for the base.
fn twist_of<S: Scalar>(ws: &Workspace<S>, frame: &Frame<S>, place: &Place<S>) -> Twist<S> {
    if frame.body == BodyId::BASE { Twist::zero() } else { ws.common[frame.body].twist.at(place.offset) }
}

fn frame_accelerations<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, reference: Reference, q: &[S], v: &[S], a: &[S], out: &mut [S]) {
    positions(model, ws, Axes::Base, q);
    twists(model, ws, Axes::Base, v);
    let zeros = core::mem::take(&mut ws.zeros);
    accelerations(model, ws, v, if a.is_empty() { &zeros } else { a }, Vector3::zeros());
    ws.zeros = zeros;
    for (frame, out) in model.frames.iter().zip(out.chunks_exact_mut(6)) {
        if frame.body == BodyId::BASE {
            out.fill(S::zero());
            continue;
        }
        let place = Place::new(ws, frame);
        let mut acceleration = ws.common[frame.body].acceleration.at(place.offset);
        if reference == Reference::WorldAligned {
            // p̈ = spatial acceleration + ω × ṗ
            let twist = twist_of(ws, frame, &place);
            acceleration.linear += twist.angular.cross(&twist.linear);
        }
        out.copy_from_slice(&place.refer(acceleration, reference).to_array());
    }
}

fn frame_jacobians<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, reference: Reference, q: &[S], out: &mut [S]) {
    positions_of_frames(model, ws, q);
    for (frame, out) in model.frames.iter().zip(out.chunks_exact_mut((6 * model.nv).max(1))) {
        jacobian(model, ws, frame, reference, out);
    }
}

/// The Jacobian of one frame, `[6][nv]`; after [`positions`] in world axes, or
/// [`positions_of_frames`].
pub(super) fn jacobian<S: Scalar>(model: &Model<S>, ws: &Workspace<S>, frame: &Frame<S>, reference: Reference, out: &mut [S]) {
    let place = Place::new(ws, frame);
    columns(model, ws, frame.body, out, |c, d| place.refer(c.axis.at(d + place.offset), reference));
}

fn frame_jacobian_rates<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, reference: Reference, q: &[S], v: &[S], out: &mut [S]) {
    positions(model, ws, Axes::Base, q);
    twists(model, ws, Axes::Base, v);
    for (frame, out) in model.frames.iter().zip(out.chunks_exact_mut((6 * model.nv).max(1))) {
        let place = Place::new(ws, frame);
        let twist = twist_of(ws, frame, &place);
        columns(model, ws, frame.body, out, |c, d| {
            let (axis, mut rate) = (c.axis.at(d + place.offset), c.s_dot.at(d + place.offset));
            match reference {
                Reference::World => {}
                // The point moves: d/dt (s_v + s_ω × (p − o)) has s_ω × ṗ besides.
                Reference::WorldAligned => rate.linear += axis.angular.cross(&twist.linear),
                // d/dt (Ad(T⁻¹) S) = Ad(T⁻¹) (Ṡ − V × S)
                Reference::Body => rate = rate - twist.cross(&axis),
            }
            place.refer(rate, reference)
        });
    }
}

/// Fills `[6][nv]` with `column(c, d)` for every column c on the way from `body` to the base, d
/// being the origin of `body` from that of the column's body.
fn columns<S: Scalar>(
    model: &Model<S>,
    ws: &Workspace<S>,
    body: BodyId,
    out: &mut [S],
    column: impl Fn(&Column<S>, Vector3<S>) -> Twist<S>,
) {
    out.fill(S::zero());
    on_the_way(model, ws, body, Vector3::zeros(), |c, d| {
        for (row, x) in column(c, d).to_array().into_iter().enumerate() {
            out[row * model.nv + c.at] += x;
        }
    });
}

/// ∂(placements)/∂q in the tangent space: for each of the twelve numbers of a frame a row.
///
/// q: `[nq]`; out: `[frames][12][nv]`. Columns of R turn with s_ω: `∂R = [s_ω]× R`; the origin
/// moves with the frame's Jacobian.
///
/// # Panics
/// If a slice is shorter than stated; [`super::Function::call`] and [`crate::dynamics::Dynamics`]
/// check and return an error.
pub fn placement_derivatives<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, q: &[S], out: &mut [S]) {
    positions_of_frames(model, ws, q);
    let nv = model.nv;
    out.fill(S::zero());
    for (frame, out) in model.frames.iter().zip(out.chunks_exact_mut((12 * nv).max(1))) {
        let place = Place::new(ws, frame);
        on_the_way(model, ws, frame.body, place.offset, |column, d| {
            let (at, twist) = (column.at, column.axis.at(d));
            for k in 0..3 {
                let turned = twist.angular.cross(&place.frame.rotation.column(k).into_owned());
                (0..3).for_each(|row| out[(3 * row + k) * nv + at] += turned[row]);
                out[(9 + k) * nv + at] += twist.linear[k];
            }
        });
    }
}
