//! A model taken apart: plain data that may be changed, and checked when it is put together again.

use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;

use nalgebra::Vector3;

use super::{Body, Frame, JointInfo, Model, ModelError};
use crate::Scalar;
use crate::actuator::Actuators;
use crate::collision::Form;
use crate::constraint::{Bound, Constraints, Length, Sum};
use crate::effect::Field;
use crate::index::{BodyId, ById, FrameId};
use crate::spatial::Reference;

/// The parts of a model. [`Model::into_parts`] returns them, [`Model::from_parts`] takes them.
#[derive(Clone, Debug)]
pub struct ModelParts<S = f64> {
    /// As [`Model::name`].
    pub name: String,
    /// As [`Model::gravity`], m/s².
    pub gravity: Vector3<S>,
    /// As [`Model::wrench_reference`].
    pub wrench_reference: Reference,
    /// As [`Model::bodies`].
    pub bodies: ById<BodyId, Body<S>>,
    /// As [`Model::frames`].
    pub frames: ById<FrameId, Frame<S>>,
    /// As [`Model::joints`].
    pub joints: Vec<JointInfo>,
    /// As [`Model::actuators`].
    pub actuators: Actuators<S>,
    /// As [`Model::constraints`].
    pub constraints: Constraints<S>,
}

impl<S: Scalar> Model<S> {
    /// The model's parts.
    #[must_use]
    pub fn into_parts(self) -> ModelParts<S> {
        let Self { name, gravity, wrench_reference, bodies, frames, joints, actuators, constraints, .. } = self;
        ModelParts { name, gravity, wrench_reference, bodies, frames, joints, actuators, constraints }
    }

    /// A model of these parts. Its indices are checked, its numbers may be any.
    ///
    /// # Errors
    /// [`ModelError::Structure`] of the first part that breaks one of these rules:
    ///
    /// * Body 0 is the base. Each other body has a parent before it, in depth-first order.
    /// * Coordinates and rates are numbered in the order of the bodies. A follower has those of a
    ///   body that does not follow, and both have one degree of freedom.
    /// * `joints` have the same coordinates and rates in the same order.
    /// * Frames are on bodies that exist.
    /// * Effects act on degrees of freedom that exist, with as many numbers as their fields have.
    pub fn from_parts(parts: ModelParts<S>) -> Result<Self, ModelError> {
        let (nq, nv) = parts.check()?;
        let ModelParts { name, gravity, wrench_reference, bodies, frames, joints, actuators, constraints } = parts;
        Ok(Self { name, gravity, wrench_reference, bodies, frames, joints, nq, nv, actuators, constraints })
    }

    /// The same model with its parts changed, here with bodies that weigh twice as much:
    ///
    /// ```
    /// use articulated_core::model::Model;
    ///
    /// fn twice_as_heavy(model: Model<f64>) -> Model<f64> {
    ///     model.changed(|parts| parts.bodies.iter_mut().for_each(|body| body.inertia = body.inertia.map(|x| 2.0 * x)))
    /// }
    /// ```
    ///
    /// # Panics
    /// If `change` breaks a rule of [`Self::from_parts`].
    #[must_use]
    pub fn changed(self, change: impl FnOnce(&mut ModelParts<S>)) -> Self {
        let mut parts = self.into_parts();
        change(&mut parts);
        Self::from_parts(parts).unwrap_or_else(|error| panic!("{error}"))
    }
}

/// The refusal of a part.
fn refused(part: String, found: String, expected: &'static str) -> ModelError {
    ModelError::Structure { part, found, expected }
}

impl<S: Scalar> ModelParts<S> {
    /// The numbers of coordinates and of degrees of freedom, if the parts fit together.
    fn check(&self) -> Result<(usize, usize), ModelError> {
        self.check_tree()?;
        let sizes = self.check_coordinates()?;
        self.check_joints(sizes)?;
        if let Some(frame) = self.frames.iter().find(|frame| self.bodies.get(frame.body).is_none()) {
            let part = format!("frame {:?}", frame.name);
            return Err(refused(part, format!("body {}", frame.body), "the index of a body"));
        }
        self.check_effects()?;
        self.check_actuators(sizes)?;
        self.check_constraints(sizes)?;
        Ok(sizes)
    }

    fn check_actuators(&self, (nq, nv): (usize, usize)) -> Result<(), ModelError> {
        if let Some(frame) = self.actuators.frames().find(|frame| self.bodies.get(frame.body).is_none()) {
            return Err(refused("the frame of an actuator".into(), format!("body {}", frame.body), "a body of the model"));
        }
        for law in self.actuators.laws.iter().chain(&self.actuators.passive) {
            let beyond = law.drives.iter().find(|drive| {
                let (of_q, of_v) = if drive.gear.len() == 3 { (4, 3) } else { (1, drive.gear.len()) };
                drive.q.saturating_add(of_q) > nq || drive.v.saturating_add(of_v) > nv
            });
            if let Some(drive) = beyond {
                let found = format!("coordinate {} and rate {}", drive.q, drive.v);
                return Err(refused(format!("actuator {:?}", law.name), found, "those of a joint"));
            }
        }
        Ok(())
    }

    fn check_constraints(&self, (nq, nv): (usize, usize)) -> Result<(), ModelError> {
        let Constraints { limits, friction, sums, anchors, shapes, pairs, cone: _ } = &self.constraints;
        for length in sums.iter().flat_map(Sum::lengths) {
            match length {
                Length::Sum(terms) if terms.iter().any(|term| term.q >= nq || term.v >= nv) => {
                    return Err(refused("a sum of coordinates".into(), "others".into(), "those of joints"));
                }
                Length::Path(strands) if strands.iter().flat_map(|own| &own.points).any(|own| self.bodies.get(own.body).is_none()) => {
                    return Err(refused("a path".into(), "points of other bodies".into(), "bodies of the model"));
                }
                _ => {}
            }
        }
        if let Some(body) = anchors.iter().flat_map(|anchor| &anchor.bodies).find(|body| self.bodies.get(**body).is_none()) {
            return Err(refused("frames that are held together".into(), format!("body {body}"), "a body of the model"));
        }
        for limit in limits {
            let (of_q, of_v) = if let Bound::Angle(_) = limit.bound { (4, 3) } else { (1, 1) };
            if limit.q.saturating_add(of_q) > nq || limit.v.saturating_add(of_v) > nv {
                let found = format!("coordinate {} and rate {}", limit.q, limit.v);
                return Err(refused("a limit".into(), found, "those of a joint"));
            }
        }
        if let Some(own) = friction.iter().find(|own| own.v >= nv) {
            return Err(refused("dry friction".into(), format!("rate {}", own.v), "that of a joint"));
        }
        if let Some(shape) = shapes.iter().find(|shape| self.bodies.get(shape.body).is_none()) {
            return Err(refused(format!("shape {:?}", shape.name), format!("body {}", shape.body), "a body of the model"));
        }
        for pair in pairs {
            let [Some(first), Some(second)] = pair.shapes.map(|shape| shapes.get(shape)) else {
                return Err(refused("a pair".into(), format!("shapes {:?}", pair.shapes), "shapes of the model"));
            };
            let part = || format!("the pair of {:?} and {:?}", first.name, second.name);
            if first.body == second.body {
                return Err(refused(part(), "one body".into(), "two bodies"));
            }
            if pair.given == 0 && Form::places(&first.form, &second.form).is_none() {
                let found = format!("a {} and a {}", first.form.name(), second.form.name());
                return Err(refused(part(), found, "a pair of `collision::Form::places`"));
            }
            if !matches!(pair.dimension, 1 | 3 | 4 | 6) {
                return Err(refused(part(), format!("dimension {}", pair.dimension), "1, 3, 4 or 6"));
            }
        }
        Ok(())
    }

    fn check_tree(&self) -> Result<(), ModelError> {
        if self.bodies.first().is_none_or(|base| base.parent != BodyId::BASE) {
            return Err(refused("body 0".into(), "no base".into(), "a body that is its own parent"));
        }
        // The path from the base to the body before, which the next body has to hang on.
        let mut path = Vec::from([BodyId::BASE]);
        for (i, body) in self.bodies.with_ids().skip(1) {
            while path.last().is_some_and(|last| *last != body.parent) {
                path.pop();
            }
            if path.is_empty() {
                return Err(refused(self.body(i), format!("parent {}", body.parent), "a body before it, in depth-first order"));
            }
            path.push(i);
        }
        Ok(())
    }

    fn check_coordinates(&self) -> Result<(usize, usize), ModelError> {
        let (mut nq, mut nv) = (0, 0);
        let mut leaders = Vec::new();
        for (i, body) in self.bodies.with_ids().skip(1).filter(|(_, body)| body.coordinates.mimic.is_none()) {
            let (q, v) = (body.coordinates.q, body.coordinates.v);
            if (q, v) != (nq, nv) {
                return Err(refused(self.body(i), format!("coordinates from {q} and rates from {v}"), "those after the body before"));
            }
            if (body.joint.nq(), body.joint.nv()) == (1, 1) {
                leaders.push((nq, nv));
            }
            nq += body.joint.nq();
            nv += body.joint.nv();
        }
        for (i, body) in self.bodies.with_ids().skip(1).filter(|(_, body)| body.coordinates.mimic.is_some()) {
            let at = (body.coordinates.q, body.coordinates.v);
            if (body.joint.nq(), body.joint.nv()) != (1, 1) || leaders.binary_search(&at).is_err() {
                return Err(refused(
                    self.body(i),
                    format!("a follower of coordinate {}", at.0),
                    "one degree of freedom, and a leader with one",
                ));
            }
        }
        Ok((nq, nv))
    }

    fn check_joints(&self, (nq, nv): (usize, usize)) -> Result<(), ModelError> {
        let (mut q, mut v) = (0, 0);
        for joint in &self.joints {
            let (of_q, of_v) = joint.kind.sizes();
            if joint.q != (q, of_q) || joint.v != (v, of_v) {
                let found = format!("coordinates {:?} and rates {:?}", joint.q, joint.v);
                return Err(refused(format!("joint {:?}", joint.name), found, "those after the joint before, as many as its kind has"));
            }
            (q, v) = (q + of_q, v + of_v);
        }
        if (q, v) != (nq, nv) {
            return Err(refused("joints".into(), format!("{q} coordinates and {v} rates"), "as many as the bodies have"));
        }
        Ok(())
    }

    fn check_effects(&self) -> Result<(), ModelError> {
        for (i, body) in self.bodies.with_ids() {
            let count = |fields: &[Field]| fields.iter().map(|field| field.len).sum::<usize>();
            let joint = body.effects.joint.iter().map(|on| {
                let row = on.effect.row();
                let freedoms = if row.is_of_rotation(body.joint) { 1 } else { body.joint.nv() };
                (on.effect, on.parameters.len(), on.freedom < freedoms && row.acts_on(body.joint), count(row.fields_on(body.joint)))
            });
            let link = body.effects.body.iter().map(|on| (on.effect, on.parameters.len(), true, on.effect.row().len()));
            for (effect, found, acts, expected) in joint.chain(link) {
                if !acts || found != expected {
                    let found = format!("{} with {found} numbers", effect.row().name);
                    return Err(refused(
                        self.body(i),
                        found,
                        "an effect on a degree of freedom of its joint, with a number for each field",
                    ));
                }
            }
        }
        Ok(())
    }

    fn body(&self, i: BodyId) -> String {
        format!("body {i} of joint {:?}", self.bodies[i].name)
    }
}

#[cfg(test)]
mod tests {
    use alloc::string::ToString;
    use alloc::vec;

    use super::*;
    use crate::description::{Base, Description, Joint, JointId, JointKind, Link, LinkId, Mimic};
    use crate::effect::{EffectId, JointEffect};

    /// A base, a chain of three joints of which the last follows the first, and a branch.
    fn robot() -> Model {
        let links = ["base", "a", "b", "c", "d"].map(|name| Link { name: name.into(), ..Link::default() });
        let joint = |name: &str, parent, child, mimic: Option<usize>| Joint {
            name: name.into(),
            kind: JointKind::Continuous,
            parent: LinkId(parent),
            child: LinkId(child),
            axis: [0.0, 0.0, 1.0],
            mimic: mimic.map(|joint| Mimic::linear(JointId(joint), 2.0, 0.0)),
            ..Joint::default()
        };
        let joints = [joint("ja", 0, 1, None), joint("jb", 1, 2, None), joint("jc", 2, 3, Some(0)), joint("jd", 1, 4, None)].into();
        let description = Description { name: "robot".into(), links: links.into(), joints, ..Description::default() };
        Model::new(&description, Base::Floating).unwrap()
    }

    #[test]
    fn a_model_of_its_own_parts_is_the_model() {
        let model = robot();
        let again = Model::from_parts(model.clone().into_parts()).unwrap();
        assert_eq!((again.nq, again.nv), (model.nq, model.nv));
        assert_eq!(format!("{again:?}"), format!("{model:?}"));
    }

    #[test]
    fn parts_that_do_not_fit_together_are_refused_with_their_name() {
        type Change = fn(&mut ModelParts<f64>);
        let cases: [(Change, &str); 12] = [
            (|p| p.bodies = ById::default(), "body 0"),
            (|p| p.bodies[BodyId(3)].parent = BodyId(3), "body 3 of joint \"jb\""),
            (|p| p.bodies[BodyId(3)].parent = BodyId(4), "body 3"),
            // The branch ends where a body hangs on the trunk again.
            (|p| _ = p.bodies.push(Body { parent: BodyId(3), ..p.bodies[BodyId(4)].clone() }), "body 6"),
            (|p| p.bodies[BodyId(3)].coordinates.v = 6, "body 3"),
            (|p| p.bodies[BodyId(4)].coordinates.q = 8 + 7, "body 4"),
            (|p| p.bodies[BodyId(4)].joint = crate::joint::Joint::Spherical, "body 4"),
            (|p| p.joints[1].q.0 = 3, "joint \"ja\""),
            (|p| drop(p.joints.pop()), "joints"),
            (|p| p.frames[FrameId(0)].body = BodyId(9), "frame \"base\""),
            (
                |p| p.bodies[BodyId(3)].effects.joint.push(JointEffect { effect: EffectId::damping, freedom: 1, parameters: vec![1.0] }),
                "body 3",
            ),
            (
                |p| p.bodies[BodyId(3)].effects.joint.push(JointEffect { effect: EffectId::damping, freedom: 0, parameters: vec![] }),
                "body 3",
            ),
        ];
        for (k, (change, named)) in cases.into_iter().enumerate() {
            let mut parts = robot().into_parts();
            change(&mut parts);
            let error = Model::from_parts(parts).map(|_| ()).unwrap_err().to_string();
            assert!(error.contains(named) && error.contains("expected"), "{k}: {error}");
        }
    }
}
