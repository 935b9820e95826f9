//! The same robot with its lengths measured in another unit.

use alloc::vec::Vec;

use nalgebra::Vector3;

use crate::Scalar;
use crate::model::Model;

impl<S: Scalar> Model<S> {
    /// The model with lengths in a unit of `metres`: offsets and gravity divided by it, masses m times its square, moments h times it; second moments, kg·m², stay.
    ///
    /// Where every joint only turns ([`Model::only_turns`]), torques, M(q), energies and what follows from them are those of the model itself: all that has a length in it is
    /// inside. What is one in the unit takes no multiplication ([`Model::units`]). Frames are not kept, and effects on bodies must not be there.
    ///
    /// # Panics
    /// If an effect acts on a body: it would measure in metres still.
    pub fn in_unit_of(&self, metres: S) -> Self {
        let mut model = self.clone();
        model.frames.clear();
        model.gravity = model.gravity.map(|x| x / metres);
        for body in &mut model.bodies {
            assert!(body.effects.body.is_empty(), "an effect on {}", body.name);
            body.placement.position = body.placement.position.map(|x| x / metres);
            for inertia in [&mut body.inertia].into_iter().chain(body.lent.as_deref_mut()) {
                inertia.mass = inertia.mass * metres * metres;
                inertia.first *= metres;
            }
        }
        model
    }

    /// Whether no joint slides, so that no coordinate, rate or force of a joint has a length in it.
    pub fn only_turns(&self) -> bool {
        self.outward().all(|i| !self.bodies[i].joint.moves_origin())
    }
}

impl Model<f64> {
    /// Units of length, m, in which some constant is one: the lever of a joint on a moving body along an axis, gravity along one, a body's moment h along one, a mass. Each unit once, in this order.
    pub fn units(&self) -> Vec<f64> {
        let moving = || self.outward().map(|i| &self.bodies[i]);
        let levers = moving().filter(|body| body.parent != 0).map(|body| body.placement.position);
        let moments = moving().map(|body| body.for_torques().first.map(|h| 1.0 / h));
        let masses = moving().map(|body| Vector3::x() / body.for_torques().mass.sqrt());
        let mut units = Vec::new();
        for unit in levers.chain([self.gravity]).chain(moments).chain(masses).flat_map(|v| [v.x, v.y, v.z]).map(f64::abs) {
            if unit > 0.0 && unit.is_finite() && !units.contains(&unit) {
                units.push(unit);
            }
        }
        units
    }
}
