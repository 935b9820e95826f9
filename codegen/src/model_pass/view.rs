//! The generator's view of a robot.

use articulated_core::Scalar;
use articulated_core::algorithm::{Formulation, FrameRotation, Function, FunctionError, Variant, Workspace};
use articulated_core::index::{BodyId, ById};
use articulated_core::model::{Body, Model, ModelParts};
use articulated_core::spatial::SpatialInertia;

/// A robot as the generator traces it.
#[derive(Clone, Debug)]
pub struct View<S> {
    /// The model. With the rotations of the formulation it has the torques of the robot; without
    /// them, its revolute joints have other zero angles.
    pub model: Model<S>,
    /// How the algorithms compute on it.
    pub formulation: Formulation<S>,
}

impl<S: Scalar> View<S> {
    /// Of a model as it is.
    pub fn new(model: Model<S>) -> Self {
        let rotations = ById::from(vec![FrameRotation::of_joint(); model.bodies().len()]);
        Self { model, formulation: Formulation { rotations, ..Formulation::default() } }
    }

    /// A workspace for calls of functions on the view's model.
    pub fn workspace(&self) -> Workspace<S> {
        Workspace::with_formulation(&self.model, self.formulation.clone())
    }

    /// Evaluates a function in one of its ways. Errors: as [`Function::call_by`].
    pub fn call_by(&self, function: &Function<S>, way: &Variant<S>, arguments: &[&[S]], out: &mut [S]) -> Result<(), FunctionError> {
        function.call_by(way, &self.model, &mut self.workspace(), arguments, out)
    }

    /// The view's data of body `i`, with `f` applied to each constant, always in the same order.
    pub(crate) fn map_body<T: Scalar>(&self, i: BodyId, f: impl Fn(S) -> T + Copy) -> BodyView<T> {
        let body = self.model.bodies()[i].map(f);
        let rotation = self.formulation.rotations[i].map(f);
        BodyView { body, rotation, torque_inertia: self.formulation.torque_inertias.get(i).map(|inertia| inertia.map(f)) }
    }

    /// Whether the frame of body `i` rotates with its joint.
    pub fn rotates(&self, i: BodyId) -> bool {
        !self.formulation.rotations[i].share.is_zero()
    }

    /// Mass properties of body `i` for inverse dynamics.
    pub(super) fn torque_inertia(&self, i: BodyId) -> &SpatialInertia<S> {
        self.formulation.torque_inertias.get(i).unwrap_or(&self.model.bodies()[i].inertia)
    }
}

/// A view's data of one body.
pub(crate) struct BodyView<S> {
    body: Body<S>,
    rotation: FrameRotation<S>,
    torque_inertia: Option<SpatialInertia<S>>,
}

impl<S: Scalar> BodyView<S> {
    /// Replaces the data of body `i` in the parts of a view.
    pub(crate) fn put(self, i: BodyId, parts: &mut ModelParts<S>, formulation: &mut Formulation<S>) {
        parts.bodies[i] = self.body;
        formulation.rotations[i] = self.rotation;
        if let (Some(to), Some(inertia)) = (formulation.torque_inertias.get_mut(i), self.torque_inertia) {
            *to = inertia;
        }
    }
}

impl View<f64> {
    /// The same with constants in another scalar.
    pub fn cast<T: Scalar>(&self) -> View<T> {
        View { model: self.model.cast(), formulation: self.formulation.map(T::from_f64) }
    }
}
