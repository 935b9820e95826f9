//! Degrees of freedom with the bounds and the friction of their joints, mimic joints included.

use articulated_core::effect::{EffectId, JointEffect};
use articulated_core::index::BodyId;
use articulated_core::joint::Follow;
use articulated_core::model::Body;

use crate::session::Session;

/// A degree of freedom: its index in its joint, and the coordinates and rates that it moves with.
/// Its own coordinate is Σ law(coordinate) + offset.
pub(crate) struct Freedom<'s> {
    /// The body that the joint carries; it has the joint's name.
    pub(crate) body: &'s Body<f64>,
    freedom: usize,
    /// What it moves with.
    pub(crate) own: Terms,
}

/// One term, or several for a joint that follows several others.
#[derive(Clone)]
pub(crate) struct Terms {
    all: Vec<Term>,
    offset: f64,
}

/// A coordinate that a degree of freedom moves with, and the rate of that.
#[derive(Clone, Copy)]
struct Term {
    q: usize,
    v: usize,
    /// Zero at zero.
    law: Follow<f64>,
}

impl Session {
    /// All degrees of freedom, mimic joints included. Those of a quaternion have no coordinates of
    /// their own, and so no bounds.
    pub(crate) fn freedoms(&self) -> impl Iterator<Item = Freedom<'_>> {
        let bodies = self.model.bodies();
        // A joint that follows several others has several bodies: only the last one counts here.
        let is_last = |k: BodyId| bodies.get(BodyId(k.0 + 1)).is_none_or(|next| self.model.series(next).nth(1).is_none());
        self.model.outward().filter(move |k| is_last(*k)).flat_map(move |k| {
            let body = &bodies[k];
            let offset = self.model.series(body).filter_map(|part| part.coordinates.mimic).map(|follow| follow.offset).sum();
            let one = move |freedom| {
                let term = |part: &Body<f64>| {
                    let (at, itself) = (&part.coordinates, Follow { multiplier: 1.0, offset: 0.0, higher: None });
                    let law = at.mimic.map_or(itself, |follow| Follow { offset: 0.0, ..follow });
                    Term { q: at.q + freedom, v: at.v + freedom, law }
                };
                let moves = |term: &Term| term.law.multiplier != 0.0 || term.law.higher.is_some();
                let all = self.model.series(body).map(term).filter(moves).collect();
                Freedom { body, freedom, own: Terms { all, offset } }
            };
            (0..body.joint.nv()).map(one).filter(|one| !one.own.all.is_empty())
        })
    }

    /// Name for events of a degree of freedom: its joint, with an index if the joint has several.
    pub(crate) fn name_of(&self, at: &Freedom<'_>) -> String {
        let several = self.model.joints().iter().find(|joint| joint.name == at.joint() && joint.v.1 > 1);
        several.map_or_else(|| at.joint().to_owned(), |joint| format!("{}[{}]", joint.name, at.own.all[0].v - joint.v.0))
    }

    /// Bounds of its own coordinate: the effect's if its joint has it, else the file's; rad or m.
    pub(crate) fn bounds(&self, at: &Freedom<'_>) -> Option<(f64, f64)> {
        let limit = at.effect(EffectId::limit).filter(|limit| !limit.effect.row().is_of_rotation(at.body.joint));
        let own = match limit.map(|limit| limit.parameters.as_slice()) {
            Some([lower, upper, ..]) => Some((*lower, *upper)),
            _ => None,
        };
        own.or_else(|| self.of_the_file(at.body))
    }

    /// Ball joints with a bound on their rotation angle: name, index in q, and the bound of the
    /// effect if the joint has it, else that of the file; rad.
    pub(crate) fn cones(&self) -> impl Iterator<Item = (&str, usize, f64)> {
        let balls = self.model.bodies().iter().skip(1).filter(|body| body.joint.is_rotation_about_point());
        balls.filter_map(|body| {
            let limit = body.effects.joint.iter().find(|e| e.effect == EffectId::limit);
            let own = limit.and_then(|limit| limit.parameters.first().copied());
            let upper = own.or_else(|| self.cone_of_the_file(body))?;
            Some((body.name.as_str(), body.coordinates.q, upper))
        })
    }

    /// The file's bound on the angle of a ball joint, rad. 0 means no bound.
    pub(crate) fn cone_of_the_file(&self, body: &Body<f64>) -> Option<f64> {
        let joint = self.description.joints.iter().find(|joint| joint.name == body.name && body.joint.is_rotation_about_point())?;
        joint.limit.map(|limit| limit.upper).filter(|upper| *upper > 0.0 && upper.is_finite())
    }

    /// The file's bounds of a joint of one degree of freedom, mimic joints included.
    pub(crate) fn of_the_file(&self, body: &Body<f64>) -> Option<(f64, f64)> {
        let joint = self.description.joints.iter().find(|joint| joint.name == body.name && body.joint.nv() == 1)?;
        joint.limit.filter(|_| joint.kind.has_bounds()).map(|l| (l.lower, l.upper))
    }
}

impl<'s> Freedom<'s> {
    /// The joint's name.
    pub(crate) fn joint(&self) -> &'s str {
        &self.body.name
    }

    /// Its effect of this kind.
    pub(crate) fn effect(&self, effect: EffectId) -> Option<&'s JointEffect<f64>> {
        self.body.effects.joint.iter().find(|e| e.effect == effect && e.freedom == self.freedom)
    }
}

impl Terms {
    /// The last of the coordinates, and of the rates, that it depends on.
    pub(crate) fn last(&self) -> [Option<usize>; 2] {
        [self.all.iter().map(|term| term.q).max(), self.all.iter().map(|term| term.v).max()]
    }

    /// Its own coordinate at `q` `[nq]`; `None` if `q` is too short.
    pub(crate) fn coordinate(&self, q: &[f64]) -> Option<f64> {
        self.all.iter().try_fold(self.offset, |sum, term| Some(sum + term.law.value(*q.get(term.q)?)))
    }

    /// Its own rate at `q` `[nq]` and `v` `[nv]`. Without a coordinate of its own, as a degree of
    /// freedom of a quaternion, it follows none.
    pub(crate) fn rate(&self, q: &[f64], v: &[f64]) -> f64 {
        let slope = |term: &Term| q.get(term.q).map_or(term.law.multiplier, |q| term.law.slope(*q));
        self.all.iter().map(|term| slope(term) * v[term.v]).sum()
    }
}
