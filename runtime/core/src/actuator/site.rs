//! Transmissions at a frame of a body, and between two frames that pull each other.
//!
//! ```text
//! without a reference:   l = 0,   l̇ = gᵀ V               V: twist of the frame in its axes
//! with a reference:      l = g_fᵀ R_rᵀ (p − p_r) + g_mᵀ log(R_rᵀ R),
//!                        l̇ = gᵀ (V − V_r)              in axes of the reference
//! ```
//!
//! A rotor of a drone has no reference. Joints that move both frames have no entry in ∂l/∂q.
//! Source: MuJoCo documentation, Actuation model (site transmission).

use alloc::vec::Vec;

use crate::Scalar;
use crate::algorithm::Placed;
use crate::index::BodyId;
use crate::spatial::screw::log_rotation;
use crate::spatial::{Placement, Wrench, rotate_back};

/// Transmission of an actuator on a frame of a body.
#[derive(Clone, Debug, PartialEq)]
pub struct SiteDrive<S = f64> {
    /// The frame.
    pub site: SiteFrame<S>,
    /// The reference frame, if there is one.
    pub reference: Option<SiteFrame<S>>,
    /// g: the wrench of a force of one, in axes of the frame, or of the reference.
    pub gear: Wrench<S>,
}

/// A frame of a body.
#[derive(Clone, Debug, PartialEq)]
pub struct SiteFrame<S = f64> {
    /// The body.
    pub body: BodyId,
    /// The frame in the body's frame.
    pub placement: Placement<S>,
}

impl<S: Scalar> SiteDrive<S> {
    /// The same with `f` of each constant, always in the same order.
    pub fn map<T: Scalar>(&self, f: impl Fn(S) -> T + Copy) -> SiteDrive<T> {
        let frame = |own: &SiteFrame<S>| own.map(f);
        let gear = Wrench { moment: self.gear.moment.map(f), force: self.gear.force.map(f) };
        SiteDrive { site: frame(&self.site), reference: self.reference.as_ref().map(frame), gear }
    }

    /// Its length and its row.
    pub(super) fn row(&self, bodies: &Placed<'_, S>) -> (S, Vec<(usize, S)>) {
        let place = |own: &SiteFrame<S>| bodies.frame(own.body, &own.placement);
        let at = place(&self.site);
        let Some(reference) = &self.reference else {
            return (S::zero(), bodies.torques(self.site.parts(), BodyId::BASE, &self.gear.turned(&at.rotation)));
        };
        let from = place(reference);
        let turn = log_rotation(&(from.rotation.transpose() * at.rotation));
        let apart = rotate_back(&from.rotation, at.position - from.position);
        let length = self.gear.force.dot(&apart) + self.gear.moment.dot(&turn);
        let w = self.gear.turned(&from.rotation);
        (length, bodies.torques_between(self.site.parts(), reference.parts(), &w))
    }
}

impl<S: Scalar> SiteFrame<S> {
    /// The body, and the frame in it.
    pub(super) fn parts(&self) -> (BodyId, &Placement<S>) {
        (self.body, &self.placement)
    }

    /// The same with `f` of each constant, always in the same order.
    pub fn map<T: Scalar>(&self, f: impl Fn(S) -> T + Copy) -> SiteFrame<T> {
        SiteFrame { body: self.body, placement: self.placement.map(f) }
    }
}
