//! Effects put on the bodies of a model.

use alloc::string::{String, ToString};
use alloc::vec;
use alloc::vec::Vec;
use core::fmt;

use nalgebra::Vector3;

use super::{Applied, BodyEffect, Effect, EffectId, JointEffect, On};
use crate::joint::Joint;
use crate::model::{Frame, Model};
use crate::spatial::{Placement, from_rpy};
use crate::suggest::nearest;

/// Why an effect cannot be had: one thing that is wrong with it, of which there may be several.
#[derive(Clone, Debug, PartialEq)]
pub struct EffectError {
    /// Its place in the list.
    pub index: usize,
    /// Which.
    pub effect: EffectId,
    /// The joint or link.
    pub on: String,
    /// What is wrong.
    pub fault: Fault,
}

/// What is wrong with an effect.
#[derive(Clone, Debug, PartialEq)]
pub enum Fault {
    /// No moving joint, or no link, of this name.
    Unknown {
        /// What it acts on.
        on: On,
        /// The name most like it.
        nearest: Option<String>,
    },
    /// The same effect is on this joint already.
    Twice,
    /// A motor drives a joint that others follow, not one that follows.
    Follows,
    /// The link is fixed to the base: nothing feels it.
    Still,
    /// The joint has no single coordinate for the law.
    NoCoordinate,
    /// A wrong number of parameters.
    Length {
        /// How many there are.
        found: usize,
        /// How many there must be.
        expected: usize,
    },
    /// Numbers that are not finite, out of their range, or that break the rule of their field.
    Number {
        /// The parameter's name.
        field: &'static str,
        /// The number, or all of the field.
        found: Vec<f64>,
        /// What it must be.
        expected: String,
    },
}

impl fmt::Display for EffectError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (effect, on) = (self.effect.row(), &self.on);
        let kind = if effect.on == On::Joint { "joint" } else { "link" };
        write!(f, "{} on {kind} {on:?}: ", effect.name)?;
        match &self.fault {
            Fault::Unknown { on, nearest } => {
                write!(
                    f,
                    "there is no {}",
                    if *on == On::Joint {
                        "joint of this name that moves"
                    } else {
                        "frame of this name (every link has one until frames are chosen: effects go first)"
                    }
                )?;
                nearest.iter().try_for_each(|n| write!(f, "; the nearest is {n:?}"))
            }
            Fault::Twice => write!(f, "given twice: expected one for a joint"),
            Fault::Follows => write!(f, "the joint follows another: expected the joint that it follows, which is what a motor drives"),
            Fault::Still => write!(f, "the link is fixed to the base, nothing would feel it: expected a link that moves"),
            Fault::NoCoordinate => {
                write!(f, "the law needs a coordinate for each degree of freedom, which a ball or a free joint does not have")
            }
            Fault::Length { found, expected } => write!(f, "found {found} parameters, expected {expected}"),
            Fault::Number { field, found, expected } => {
                write!(f, "{field}: found ")?;
                found.iter().enumerate().try_for_each(|(k, x)| write!(f, "{}{x}", if k > 0 { ", " } else { "" }))?;
                write!(f, ", expected {expected}")
            }
        }
    }
}

impl core::error::Error for EffectError {}

/// All that is wrong with effects that were asked for, a line each.
#[derive(Clone, Debug, PartialEq)]
pub struct EffectErrors(pub Vec<EffectError>);

impl core::ops::Deref for EffectErrors {
    type Target = [EffectError];

    fn deref(&self) -> &[EffectError] {
        &self.0
    }
}

impl fmt::Display for EffectErrors {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.iter().enumerate().try_for_each(|(k, one)| write!(f, "{}{one}", if k > 0 { "\n" } else { "" }))
    }
}

impl core::error::Error for EffectErrors {}

impl Model<f64> {
    /// The same robot with these effects besides those that it has. Several on one link add up; one that does nothing ([`Effect::is_nothing`]) is left out. All that is wrong is told at
    /// once. The model must still have all its frames.
    pub fn with_effects(mut self, applied: &[Applied]) -> Result<Self, EffectErrors> {
        let mut errors = Vec::new();
        for (index, one) in applied.iter().enumerate() {
            let mut faults = check(one);
            if faults.is_empty() {
                faults.extend(self.put(one).err());
            }
            let told = |fault| EffectError { index, effect: one.effect, on: one.on.clone(), fault };
            errors.extend(faults.into_iter().map(told));
        }
        if errors.is_empty() { Ok(self) } else { Err(EffectErrors(errors)) }
    }

    fn put(&mut self, one: &Applied) -> Result<(), Fault> {
        match one.effect.row().on {
            _ if one.effect.row().is_nothing(&one.parameters) => self.has(one),
            On::Joint => self.put_on_joint(one),
            On::Link => self.put_on_link(one),
        }
    }

    /// Whether there is what an effect of nothing would be on.
    fn has(&self, one: &Applied) -> Result<(), Fault> {
        match one.effect.row().on {
            On::Joint => self.joint_for(one).map(|_| ()),
            On::Link => self.link_for(one).map(|_| ()),
        }
    }

    fn put_on_joint(&mut self, one: &Applied) -> Result<(), Fault> {
        for i in self.joint_for(one)? {
            let body = &mut self.bodies[i];
            let on = |freedom| JointEffect { effect: one.effect, freedom, parameters: one.parameters.clone() };
            body.effects.joint.extend((0..body.joint.nv()).map(on));
        }
        Ok(())
    }

    /// The bodies of the joint that it is to be on.
    fn joint_for(&self, one: &Applied) -> Result<Vec<usize>, Fault> {
        let bodies: Vec<usize> = self.outward().filter(|&i| self.bodies[i].name == one.on).collect();
        if bodies.is_empty() {
            return Err(Fault::Unknown { on: On::Joint, nearest: nearest(&one.on, self.bodies.iter().skip(1).map(|b| b.name.as_str())) });
        }
        for body in bodies.iter().map(|&i| &self.bodies[i]) {
            if body.effects.joint.iter().any(|e| e.effect == one.effect) {
                return Err(Fault::Twice);
            }
            if matches!(body.joint, Joint::Spherical | Joint::Floating) && one.effect.row().needs_coordinate() {
                return Err(Fault::NoCoordinate);
            }
            if one.effect == EffectId::motor && body.coordinates.mimic.is_some() {
                return Err(Fault::Follows);
            }
        }
        Ok(bodies)
    }

    fn put_on_link(&mut self, one: &Applied) -> Result<(), Fault> {
        let frame = self.link_for(one)?;
        let at = Placement { rotation: from_rpy(one.at.rpy), position: Vector3::from(one.at.xyz) };
        let (body, placement) = (frame.body, frame.placement.compose(&at));
        let parameters = normalised(one.effect, &one.parameters);
        self.bodies[body].effects.body.push(BodyEffect { effect: one.effect, placement, parameters });
        Ok(())
    }

    /// The frame of the link that it is to be on.
    fn link_for(&self, one: &Applied) -> Result<&Frame<f64>, Fault> {
        let Some(frame) = self.frames.iter().find(|f| f.name == one.on) else {
            return Err(Fault::Unknown { on: On::Link, nearest: nearest(&one.on, self.frames.iter().map(|f| f.name.as_str())) });
        };
        if frame.body == 0 { Err(Fault::Still) } else { Ok(frame) }
    }
}

/// The normal of a plane to length 1.
fn normalised(effect: EffectId, parameters: &[f64]) -> Vec<f64> {
    let mut parameters = parameters.to_vec();
    if effect == EffectId::contact {
        let at = start(effect.row(), "normal");
        let normal = &mut parameters[at..at + 3];
        let largest = normal.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        let length = largest * libm::sqrt(normal.iter().map(|x| x / largest * (x / largest)).sum());
        normal.iter_mut().for_each(|x| *x /= length);
    }
    parameters
}

/// Place of the first number of a field.
fn start(effect: &Effect, name: &str) -> usize {
    effect.fields.iter().take_while(|f| f.name != name).map(|f| f.len).sum()
}

/// What of the numbers is not what the fields want, or not what they must be together.
fn check(one: &Applied) -> Vec<Fault> {
    let (row, p) = (one.effect.row(), &one.parameters);
    if p.len() != row.len() {
        return vec![Fault::Length { found: p.len(), expected: row.len() }];
    }
    let wrong = |field: &'static str, found: &[f64], expected: String| Fault::Number { field, found: found.to_vec(), expected };
    let (mut faults, mut rest) = (Vec::new(), p.as_slice());
    for field in row.fields {
        let (own, others) = rest.split_at(field.len);
        let beyond = own.iter().find(|x| !field.range.has(**x));
        faults.extend(beyond.map(|x| wrong(field.name, &[*x], field.range.to_string())));
        rest = others;
    }
    let unbounded = one.at.xyz.iter().chain(&one.at.rpy).find(|x| !x.is_finite());
    faults.extend(unbounded.map(|x| wrong("xyz or rpy", &[*x], "finite numbers".into())));
    // What numbers must be together is asked of numbers that may be.
    let broken = row.broken(p).filter(|_| faults.is_empty()).and_then(|(field, own)| Some((field.name, own, field.rule?.expected)));
    faults.extend(broken.map(|(field, own, expected)| wrong(field, own, expected.into())));
    faults
}

#[cfg(test)]
mod tests {

    use super::*;
    use crate::description::{Base, Description, Joint, JointKind, Link, Origin};

    /// A carriage on a rail, a ball that hangs on it, and a lamp on the base.
    fn robot() -> Model<f64> {
        let link = |name: &str| Link { name: name.into(), inertial: None };
        let joint = |name: &str, kind, child| Joint { name: name.into(), kind, child, axis: [1.0, 0.0, 0.0], ..Joint::default() };
        let joints = vec![
            joint("slide", JointKind::Prismatic, 1),
            Joint { parent: 1, ..joint("hang", JointKind::Spherical, 2) },
            joint("glue", JointKind::Fixed, 3),
        ];
        let links = ["rail", "carriage", "ball", "lamp"].map(link).to_vec();
        Model::new(&Description { name: "robot".into(), links, joints }, Base::Fixed).unwrap()
    }

    fn on(effect: EffectId, on: &str, parameters: &[f64]) -> Applied {
        Applied { effect, on: on.into(), at: Origin::default(), parameters: parameters.to_vec() }
    }

    #[test]
    fn an_effect_of_nothing_is_refused_where_one_that_does_something_is_and_left_out_elsewhere() {
        let robot = robot().with_effects(&[on(EffectId::damping, "slide", &[1.0])]).unwrap();
        let acts = |effect: EffectId, name: &str, number: f64| {
            let mut parameters = vec![0.0; effect.row().len()];
            parameters[0] = number;
            let with = robot.clone().with_effects(&[on(effect, name, &parameters)]);
            with.map(|with| with.bodies.iter().map(|b| b.effects.kinds().len()).sum::<usize>()).map_err(|errors| errors.0[0].fault.clone())
        };
        let cases = [
            (EffectId::spring, ["slide", "slid", "hang", "glue", "ball"]),
            (EffectId::damping, ["slide", "slid", "hang", "glue", "ball"]),
            (EffectId::drag, ["carriage", "carriag", "ball", "rail", "lamp"]),
        ];
        for (effect, names) in cases {
            for name in names {
                let [nothing, something] = [0.0, 2.0].map(|number| acts(effect, name, number));
                assert_eq!(nothing.clone().err(), something.clone().err(), "{effect:?} on {name}");
                assert!(nothing.is_err() || nothing == Ok(1) && something.is_ok_and(|n| n > 1), "{effect:?} on {name}");
            }
        }
    }
}
