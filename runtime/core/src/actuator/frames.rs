//! Forces on frames of bodies, in place of joints.

use alloc::vec::Vec;

use super::path::{self, Strand};
use super::site::{SiteDrive, SiteFrame};
use super::{ActuatorLaw, Actuators};
use crate::Scalar;
use crate::algorithm::{Placed, Workspace};
use crate::model::Model;

/// Transmission of a force on frames of bodies.
#[derive(Clone, Debug, PartialEq)]
pub enum FrameDrive<S = f64> {
    /// It pushes at a frame.
    Site(SiteDrive<S>),
    /// It pulls along a path.
    Path(Vec<Strand<S>>),
}

/// Length and Jacobian row of a force on frames, in a state.
#[derive(Clone, Debug)]
pub(crate) struct FrameRow<S> {
    /// The place of its law: in [`Actuators::laws`], then in [`Actuators::passive`].
    pub(super) law: usize,
    pub(super) length: S,
    /// ∂l/∂q: the degrees of freedom, each with its entry.
    pub(super) row: Vec<(usize, S)>,
}

impl<S: Scalar> FrameRow<S> {
    /// l̇.
    pub(super) fn rate(&self, v: &[S]) -> S {
        self.row.iter().fold(S::zero(), |sum, (k, own)| sum + *own * v[*k])
    }

    /// τ += gᵀ f.
    pub(super) fn add(&self, law: &ActuatorLaw<S>, input: S, v: &[S], tau: &mut [S]) {
        let force = law.bounded(input, self.length, self.rate(v));
        self.row.iter().for_each(|(k, gear)| tau[*k] += *gear * force);
    }
}

impl<S: Scalar> FrameDrive<S> {
    /// The same with `f` of each constant, always in the same order.
    pub fn map<T: Scalar>(&self, f: impl Fn(S) -> T + Copy) -> FrameDrive<T> {
        match self {
            Self::Site(site) => FrameDrive::Site(site.map(f)),
            Self::Path(strands) => FrameDrive::Path(strands.iter().map(|strand| strand.map(f)).collect()),
        }
    }

    /// Its frames.
    fn frames(&self) -> Vec<&SiteFrame<S>> {
        match self {
            Self::Site(own) => core::iter::once(&own.site).chain(&own.reference).collect(),
            Self::Path(strands) => strands.iter().flat_map(|strand| &strand.points).collect(),
        }
    }

    fn frames_mut(&mut self) -> Vec<&mut SiteFrame<S>> {
        match self {
            Self::Site(own) => core::iter::once(&mut own.site).chain(&mut own.reference).collect(),
            Self::Path(strands) => strands.iter_mut().flat_map(|strand| &mut strand.points).collect(),
        }
    }

    /// Its length and its row.
    fn row(&self, bodies: &Placed<'_, S>) -> (S, Vec<(usize, S)>) {
        match self {
            Self::Site(site) => site.row(bodies),
            Self::Path(strands) => path::row(strands, bodies),
        }
    }
}

impl<S: Scalar> Actuators<S> {
    /// All forces: those with controls, and the passive ones behind them.
    pub(super) fn all(&self) -> impl Iterator<Item = &ActuatorLaw<S>> + Clone {
        self.laws.iter().chain(&self.passive)
    }

    /// Whether a force acts on frames.
    pub fn has_frames(&self) -> bool {
        self.all().any(|law| law.frames.is_some())
    }

    /// The frames on which forces act.
    pub fn frames(&self) -> impl Iterator<Item = &SiteFrame<S>> {
        self.all().filter_map(|law| law.frames.as_ref()).flat_map(FrameDrive::frames)
    }

    /// The same, mutable: for changes of the frames of bodies.
    pub fn frames_mut(&mut self) -> impl Iterator<Item = &mut SiteFrame<S>> {
        let all = self.laws.iter_mut().chain(&mut self.passive);
        all.filter_map(|law| law.frames.as_mut()).flat_map(FrameDrive::frames_mut)
    }

    /// The forces on frames in a state.
    pub(crate) fn frame_rows(&self, model: &Model<S>, ws: &mut Workspace<S>, q: &[S]) -> Vec<FrameRow<S>> {
        if !self.has_frames() {
            return Vec::new();
        }
        let bodies = Placed::at(model, ws, q);
        let row = |(law, own): (usize, &ActuatorLaw<S>)| {
            let (length, row) = own.frames.as_ref()?.row(&bodies);
            Some(FrameRow { law, length, row })
        };
        self.all().enumerate().filter_map(row).collect()
    }

    /// The rows of actuators, or those of passive forces, each with its law and its input.
    pub(super) fn laws_of<'a>(
        &'a self,
        rows: &'a [FrameRow<S>],
        inputs: &'a [S],
        is_passive: bool,
    ) -> impl Iterator<Item = (&'a FrameRow<S>, &'a ActuatorLaw<S>, S)> {
        let input = move |row: &FrameRow<S>| inputs.get(row.law).filter(|_| !is_passive).copied().unwrap_or(S::zero());
        let own = rows.iter().filter(move |row| (row.law >= self.laws.len()) == is_passive);
        own.filter_map(move |row| Some((row, self.all().nth(row.law)?, input(row))))
    }
}
