//! The same robot with its lengths measured in another unit.

use articulated_core::Scalar;
use articulated_core::index::BodyId;
use articulated_core::model::Model;
use articulated_core::spatial::{SpatialInertia, Vector3};

use super::view::View;

impl<S: Scalar> View<S> {
    /// The view with lengths in a unit of `metres`: offsets and gravity divided by it, masses m
    /// times its square, moments h times it; second moments, kg·m², stay.
    ///
    /// Where no joint moves an origin ([`no_joint_moves_origin`]), torques, M(q), energies and
    /// quantities that follow from them are those of the robot itself: lengths are internal only.
    /// Numbers that are one in the unit take no multiplication ([`View::units`]). Frames are not
    /// kept.
    ///
    /// # Panics
    /// If an effect acts on a body: it would still measure in metres.
    #[must_use]
    pub fn in_unit_of(&self, metres: S) -> Self {
        let View { model, mut formulation } = self.clone();
        let in_unit = |inertia: &mut SpatialInertia<S>| {
            inertia.mass = inertia.mass * metres * metres;
            inertia.first *= metres;
        };
        let model = model.without_frames().changed(|parts| {
            parts.gravity = parts.gravity.map(|x| x / metres);
            for body in &mut parts.bodies {
                assert!(body.effects.body.is_empty(), "an effect on {}", body.name);
                body.placement.position = body.placement.position.map(|x| x / metres);
                in_unit(&mut body.inertia);
            }
        });
        formulation.torque_inertias.iter_mut().for_each(in_unit);
        View { model, formulation }
    }
}

/// Whether no coordinate, rate or force of a joint has a length in it.
pub fn no_joint_moves_origin<S: Scalar>(model: &Model<S>) -> bool {
    model.outward().all(|i| !model.bodies()[i].joint.moves_origin())
}

impl View<f64> {
    /// Units of length, m, in which some constant is one: the lever of a joint on a moving body
    /// along an axis, gravity along one, a body's moment h along one, a mass. Each unit once, in
    /// this order.
    pub fn units(&self) -> Vec<f64> {
        let model = &self.model;
        let levers =
            model.outward().map(|i| &model.bodies()[i]).filter(|body| body.parent != BodyId::BASE).map(|body| body.placement.position);
        let moments = model.outward().map(|i| self.torque_inertia(i).first.map(|h| 1.0 / h));
        let masses = model.outward().map(|i| Vector3::x() / self.torque_inertia(i).mass.sqrt());
        let mut units = Vec::new();
        for unit in levers.chain([model.gravity()]).chain(moments).chain(masses).flat_map(|v| [v.x, v.y, v.z]).map(f64::abs) {
            if unit > 0.0 && unit.is_finite() && !units.contains(&unit) {
                units.push(unit);
            }
        }
        units
    }
}
