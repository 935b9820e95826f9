//! Degrees of freedom with the bounds and the friction of their joints, mimic joints included.

use articulated_core::effect::{EffectId, JointEffect};
use articulated_core::model::Body;

use crate::session::Session;

/// A degree of freedom: its index in its joint, and the coordinate and rate that it moves with. Its
/// own coordinate is multiplier · coordinate + offset.
pub(crate) struct Freedom<'s> {
    /// The body that the joint carries; it has the joint's name.
    pub(crate) body: &'s Body<f64>,
    freedom: usize,
    pub(crate) q: usize,
    pub(crate) v: usize,
    pub(crate) multiplier: f64,
    offset: f64,
}

impl Session {
    /// All degrees of freedom, mimic joints included. Those of a quaternion have no coordinates of
    /// their own, and so no bounds.
    pub(crate) fn freedoms(&self) -> impl Iterator<Item = Freedom<'_>> {
        self.model.bodies().iter().skip(1).flat_map(|body| {
            let (at, follow) = (&body.coordinates, body.coordinates.mimic);
            let (multiplier, offset) = follow.map_or((1.0, 0.0), |f| (f.multiplier, f.offset));
            let one = move |freedom| Freedom { body, freedom, q: at.q + freedom, v: at.v + freedom, multiplier, offset };
            (0..body.joint.nv()).filter(move |_| multiplier != 0.0).map(one)
        })
    }

    /// Name for events of a degree of freedom: its joint, with an index where that has several.
    pub(crate) fn name_of(&self, at: &Freedom<'_>) -> String {
        let several = self.model.joints().iter().find(|joint| joint.name == at.joint() && joint.v.1 > 1);
        several.map_or_else(|| at.joint().to_owned(), |joint| format!("{}[{}]", joint.name, at.v - joint.v.0))
    }

    /// Bounds of the coordinate that a degree of freedom moves with: those of the effect if its
    /// joint has it, else those of the file; rad or m.
    pub(crate) fn bounds(&self, at: &Freedom<'_>) -> Option<(f64, f64)> {
        let limit = at.effect(EffectId::limit).filter(|limit| !limit.effect.row().is_of_rotation(at.body.joint));
        let own = match limit.map(|limit| limit.parameters.as_slice()) {
            Some([lower, upper, ..]) => Some((*lower, *upper)),
            _ => None,
        };
        own.or_else(|| self.of_the_file(at.body)).map(|bounds| at.of_the_coordinate(bounds))
    }

    /// Ball joints with a bound of the angle of their rotation: name, place in q, and the bound of
    /// the effect if the joint has it, else that of the file; rad.
    pub(crate) fn cones(&self) -> impl Iterator<Item = (&str, usize, f64)> {
        let balls = self.model.bodies().iter().skip(1).filter(|body| body.joint.is_rotation_about_point());
        balls.filter_map(|body| {
            let limit = body.effects.joint.iter().find(|e| e.effect == EffectId::limit);
            let own = limit.and_then(|limit| limit.parameters.first().copied());
            let upper = own.or_else(|| self.cone_of_the_file(body))?;
            Some((body.name.as_str(), body.coordinates.q, upper))
        })
    }

    /// The bound that the file gives the angle of a ball joint, rad. A bound of 0 is none.
    pub(crate) fn cone_of_the_file(&self, body: &Body<f64>) -> Option<f64> {
        let joint = self.description.joints.iter().find(|joint| joint.name == body.name && body.joint.is_rotation_about_point())?;
        joint.limit.map(|limit| limit.upper).filter(|upper| *upper > 0.0 && upper.is_finite())
    }

    /// The bounds that the file gives a joint of one degree of freedom, those of one that follows
    /// another too.
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

    /// Its own coordinate at coordinate `q` of the joint that it moves with.
    pub(crate) fn own_coordinate(&self, q: f64) -> f64 {
        self.multiplier * q + self.offset
    }

    /// Converts bounds of its own coordinate to bounds of the coordinate that it moves with.
    fn of_the_coordinate(&self, (lower, upper): (f64, f64)) -> (f64, f64) {
        let [a, b] = [lower, upper].map(|x| (x - self.offset) / self.multiplier);
        if self.multiplier < 0.0 { (b, a) } else { (a, b) }
    }
}
