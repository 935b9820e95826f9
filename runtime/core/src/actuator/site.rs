//! Actuators that push at a frame of a body, and others that pull two frames to each other.
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

use super::{ActuatorLaw, Actuators};
use crate::Scalar;
use crate::algorithm::{Placed, Workspace};
use crate::index::BodyId;
use crate::model::Model;
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

/// Length and Jacobian row of an actuator on a frame, in a state.
#[derive(Clone, Debug)]
pub(crate) struct SiteRow<S> {
    /// The place of its law.
    pub(crate) law: usize,
    pub(crate) length: S,
    /// ∂l/∂q: the degrees of freedom, each with its entry.
    pub(crate) row: Vec<(usize, S)>,
}

impl<S: Scalar> SiteRow<S> {
    /// l̇.
    pub(super) fn rate(&self, v: &[S]) -> S {
        self.row.iter().fold(S::zero(), |sum, (k, own)| sum + *own * v[*k])
    }
}

impl<S: Scalar> SiteDrive<S> {
    /// The same with `f` of each constant, always in the same order.
    pub fn map<T: Scalar>(&self, f: impl Fn(S) -> T + Copy) -> SiteDrive<T> {
        let frame = |own: &SiteFrame<S>| SiteFrame { body: own.body, placement: own.placement.map(f) };
        let gear = Wrench { moment: self.gear.moment.map(f), force: self.gear.force.map(f) };
        SiteDrive { site: frame(&self.site), reference: self.reference.as_ref().map(frame), gear }
    }

    /// Its length and its row.
    fn row(&self, bodies: &Placed<'_, S>) -> (S, Vec<(usize, S)>) {
        let place = |own: &SiteFrame<S>| bodies.frame(own.body, &own.placement);
        let along = |own: &SiteFrame<S>, w: &Wrench<S>| bodies.torques(own.body, &own.placement, w);
        let at = place(&self.site);
        let Some(reference) = &self.reference else {
            return (S::zero(), along(&self.site, &self.gear.turned(&at.rotation)));
        };
        let from = place(reference);
        let turn = log_rotation(&(from.rotation.transpose() * at.rotation));
        let apart = rotate_back(&from.rotation, at.position - from.position);
        let length = self.gear.force.dot(&apart) + self.gear.moment.dot(&turn);
        let w = self.gear.turned(&from.rotation);
        let (own, other) = (along(&self.site, &w), along(reference, &w));
        let carries = |row: &[(usize, S)], k: usize| row.iter().any(|(own, _)| *own == k);
        let moves = own.iter().filter(|(k, _)| !carries(&other, *k)).copied();
        let against = other.iter().filter(|(k, _)| !carries(&own, *k)).map(|(k, x)| (*k, -*x));
        (length, moves.chain(against).collect())
    }
}

impl<S: Scalar> Actuators<S> {
    /// Whether an actuator pushes at a frame.
    pub fn has_sites(&self) -> bool {
        self.laws.iter().any(|law| law.site.is_some())
    }

    /// The frames that actuators push, with those that they move against.
    pub fn frames(&self) -> impl Iterator<Item = &SiteFrame<S>> {
        self.laws.iter().filter_map(|law| law.site.as_ref()).flat_map(|own| core::iter::once(&own.site).chain(&own.reference))
    }

    /// The same, mutable: for changes of the frames of bodies.
    pub fn frames_mut(&mut self) -> impl Iterator<Item = &mut SiteFrame<S>> {
        let all = self.laws.iter_mut().filter_map(|law| law.site.as_mut());
        all.flat_map(|own| core::iter::once(&mut own.site).chain(&mut own.reference))
    }

    /// The actuators of frames in a state.
    pub(crate) fn site_rows(&self, model: &Model<S>, ws: &mut Workspace<S>, q: &[S]) -> Vec<SiteRow<S>> {
        if !self.has_sites() {
            return Vec::new();
        }
        let bodies = Placed::at(model, ws, q);
        let row = |(law, own): (usize, &ActuatorLaw<S>)| {
            let (length, row) = own.site.as_ref()?.row(&bodies);
            Some(SiteRow { law, length, row })
        };
        self.laws.iter().enumerate().filter_map(row).collect()
    }

    /// τ += gᵀ f of actuators of frames: before those of joints, whose bounds count for all.
    pub(crate) fn add_site_torques(&self, inputs: &[S], rows: &[SiteRow<S>], v: &[S], tau: &mut [S]) {
        for own in rows {
            let Some(law) = self.laws.get(own.law) else { continue };
            let force = law.bounded(inputs.get(own.law).copied().unwrap_or(S::zero()), own.length, own.rate(v));
            own.row.iter().for_each(|(k, gear)| tau[*k] += *gear * force);
        }
    }
}
