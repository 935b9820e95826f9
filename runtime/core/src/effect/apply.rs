//! Effects put on the bodies of a model.

use alloc::string::{String, ToString};
use alloc::vec;
use alloc::vec::Vec;
use core::fmt;

use super::places::Places;
use super::{Applied, BodyEffect, Effect, EffectId, Enters, Field, JointEffect, On};
use crate::Scalar;
use crate::index::{BodyId, FrameId};
use crate::model::Model;
use crate::spatial::Placement;

/// One error of an effect; there may be several.
#[derive(Clone, Debug, PartialEq)]
pub struct EffectError {
    /// Its place in the list.
    pub index: usize,
    /// Which.
    pub effect: EffectId,
    /// The joint or link.
    pub on: String,
    /// Its error.
    pub fault: Fault,
}

/// Errors of an effect.
#[derive(Clone, Debug, PartialEq)]
pub enum Fault {
    /// No moving joint, or no link, of this name.
    Unknown {
        /// Its target.
        on: On,
        /// The name most like it.
        nearest: Option<String>,
    },
    /// The same effect is on this joint already.
    Twice,
    /// A motor drives a joint that others follow, not one that follows.
    Follows,
    /// A rotor on a joint that follows several others: its inertia would be between those.
    FollowsSeveral,
    /// The link is fixed to the base: the effect would change nothing.
    Still,
    /// A floating base has no joint to be damped, sprung or driven.
    Base,
    /// The joint has no coordinates or rotation for the law: a free joint.
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
        /// The expected value, in words.
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
            Fault::FollowsSeveral => {
                f.write_str("the joint follows several others, and its rotor would be an inertia between them: expected rotors on the joints that it follows")
            }
            Fault::Follows => write!(f, "the joint follows another: expected the joint that it follows, which is what a motor drives"),
            Fault::Still => write!(f, "the link is fixed to the base, nothing would feel it: expected a link that moves"),
            Fault::Base => {
                write!(f, "the floating base is no joint of the robot: expected one that is, or an effect on the link that floats")
            }
            Fault::NoCoordinate => {
                write!(
                    f,
                    "the law needs a coordinate for each degree of freedom, or a rotation about a point, and a free joint has neither"
                )
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

/// Errors of requested effects, one line each.
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
    /// The same robot with these effects besides those that it has. Several on one link add up; one
    /// that does nothing ([`Effect::is_nothing`]) is left out. All errors are reported at once. The
    /// model must still have all its frames.
    pub fn with_effects(mut self, applied: &[Applied]) -> Result<Self, EffectErrors> {
        if applied.is_empty() {
            return Ok(self);
        }
        let (mut places, mut errors) = (Places::of(&self), Vec::new());
        for (index, one) in applied.iter().enumerate() {
            let mut faults = check(one, places.fields(&self, one));
            if faults.is_empty() {
                faults.extend(self.put(one, &mut places).err());
            }
            let told = |fault| EffectError { index, effect: one.effect, on: one.on.clone(), fault };
            errors.extend(faults.into_iter().map(told));
        }
        if errors.is_empty() { Ok(self) } else { Err(EffectErrors(errors)) }
    }

    fn put(&mut self, one: &Applied, places: &mut Places) -> Result<(), Fault> {
        // An effect that does nothing is left out, if its target exists.
        let is_nothing = one.effect.row().is_nothing(&one.parameters);
        match one.effect.row().on {
            On::Joint => {
                let bodies = places.bodies(self, &one.on)?;
                self.check_joint(bodies, one)?;
                if !is_nothing {
                    self.put_on_joint(bodies, one);
                }
            }
            On::Link => {
                let frame = places.frame(self, &one.on)?;
                if !is_nothing {
                    self.put_on_link(frame, one);
                }
            }
        }
        Ok(())
    }

    /// Whether the joint with these bodies can have the effect.
    fn check_joint(&self, bodies: &[BodyId], one: &Applied) -> Result<(), Fault> {
        for body in bodies.iter().map(|&i| &self.bodies[i]) {
            if body.effects.joint.iter().any(|e| e.effect == one.effect) {
                return Err(Fault::Twice);
            }
            if bodies.len() > 1 && body.coordinates.mimic.is_some() && one.effect.row().enters == Enters::Inertia {
                return Err(Fault::FollowsSeveral);
            }
            if !one.effect.row().acts_on(body.joint) {
                return Err(Fault::NoCoordinate);
            }
            if one.effect.row().enters == Enters::Drive && body.coordinates.mimic.is_some() {
                return Err(Fault::Follows);
            }
        }
        Ok(())
    }

    fn put_on_joint(&mut self, bodies: &[BodyId], one: &Applied) {
        let follows = |i: &&BodyId| self.bodies[**i].coordinates.mimic.is_some();
        // One law for the sum of the coordinates of a joint that follows several.
        let last = bodies.last().filter(follows).map(core::slice::from_ref);
        for &i in last.unwrap_or(bodies) {
            let body = &mut self.bodies[i];
            let parameters = with_unit_vectors(one.effect.row(), one.parameters.clone());
            let on = |freedom| JointEffect { effect: one.effect, freedom, parameters: parameters.clone() };
            // One law for all rates of a ball joint.
            let count = if one.effect.row().is_of_rotation(body.joint) { 1 } else { body.joint.nv() };
            body.effects.joint.extend((0..count).map(on));
        }
    }

    fn put_on_link(&mut self, frame: FrameId, one: &Applied) {
        let frame = &self.frames[frame];
        let at: Placement<f64> = one.at.placement();
        let (body, placement) = (frame.body, frame.placement.compose(&at));
        let parameters = with_unit_vectors(one.effect.row(), one.parameters.clone());
        self.bodies[body].effects.body.push(BodyEffect { effect: one.effect, link: one.on.clone(), placement, parameters });
    }
}

/// The numbers of an effect, with its directions ([`super::Field::is_direction`]) of length one.
fn with_unit_vectors(effect: &Effect, mut parameters: Vec<f64>) -> Vec<f64> {
    // A direction of zeros is an error already.
    directions(effect, &mut parameters, |vector| _ = super::unit::normalise(vector));
    parameters
}

fn directions<S>(effect: &Effect, parameters: &mut [S], mut change: impl FnMut(&mut [S])) {
    let (fields, mut rest) = (effect.fields_of(parameters.len()), parameters);
    for field in fields {
        let Some((own, others)) = rest.split_at_mut_checked(field.len) else { return };
        if field.is_direction {
            change(own);
        }
        rest = others;
    }
}

impl Effect {
    /// Numbers of the effect that are symbols, with its directions ([`super::Field::is_direction`])
    /// made of length one: as [`Model::with_effects`] does with numbers.
    pub fn with_unit_vectors<S: Scalar>(&self, mut parameters: Vec<S>) -> Vec<S> {
        directions(self, &mut parameters, |vector| {
            let length = vector.iter().fold(S::zero(), |sum, x| sum + *x * *x).sqrt();
            vector.iter_mut().for_each(|x| *x = *x / length);
        });
        parameters
    }
}

/// Validates each parameter against the range of its field, then the effect's joint constraint.
fn check(one: &Applied, fields: &[Field]) -> Vec<Fault> {
    let (row, p) = (one.effect.row(), &one.parameters);
    let expected = fields.iter().map(|field| field.len).sum();
    if p.len() != expected {
        return vec![Fault::Length { found: p.len(), expected }];
    }
    let wrong = |field: &'static str, found: &[f64], expected: String| Fault::Number { field, found: found.to_vec(), expected };
    let (mut faults, mut rest) = (Vec::new(), p.as_slice());
    for field in fields {
        let (own, others) = rest.split_at(field.len);
        let beyond = own.iter().find(|x| !field.range.has(**x));
        faults.extend(beyond.map(|x| wrong(field.name, &[*x], field.range.to_string())));
        rest = others;
    }
    let rpy = one.at.rotation.rpy();
    let unbounded = one.at.xyz.iter().chain(&rpy).find(|x| !x.is_finite());
    faults.extend(unbounded.map(|x| wrong("xyz or rpy", &[*x], "finite numbers".into())));
    // Rules on several numbers are checked only if each number is valid.
    let broken = row.broken(p).filter(|_| faults.is_empty()).and_then(|(field, own)| Some((field.name, own, field.rule?.expected)));
    faults.extend(broken.map(|(field, own, expected)| wrong(field, own, expected.into())));
    faults
}

#[cfg(test)]
mod tests {

    use alloc::format;

    use super::*;
    use crate::description::{Base, Description, Joint, JointKind, Link, LinkId, Origin};

    /// A carriage on a rail, a ball that hangs on it, and a lamp on the base.
    fn robot() -> Model<f64> {
        let link = |name: &str| Link { name: name.into(), ..Link::default() };
        let joint = |name: &str, kind, child| Joint { name: name.into(), kind, child, axis: [1.0, 0.0, 0.0], ..Joint::default() };
        let joints = vec![
            joint("slide", JointKind::Prismatic, LinkId(1)),
            Joint { parent: LinkId(1), ..joint("hang", JointKind::Spherical, LinkId(2)) },
            joint("glue", JointKind::Fixed, LinkId(3)),
        ];
        let links = ["rail", "carriage", "ball", "lamp"].map(link).to_vec();
        Model::new(&Description { name: "robot".into(), links: links.into(), joints: joints.into(), frames: Vec::new() }, Base::Fixed)
            .unwrap()
    }

    fn on(effect: EffectId, on: &str, parameters: &[f64]) -> Applied {
        Applied { effect, on: on.into(), at: Origin::default(), parameters: parameters.to_vec() }
    }

    #[test]
    fn thousands_of_effects_are_soon_put_and_of_wrong_names_the_first_are_told_with_what_was_meant() {
        let count = 10_000;
        let links = (0..=count).map(|k| Link { name: format!("link_{k}"), ..Link::default() }).collect();
        let joint = |k: usize| Joint {
            name: format!("joint_{k}"),
            kind: JointKind::Continuous,
            parent: LinkId(k),
            child: LinkId(k + 1),
            axis: [0.0, 0.0, 1.0],
            ..Joint::default()
        };
        let joints = (0..count).map(joint).collect();
        let chain = Model::new(&Description { name: "chain".into(), links, joints, frames: Vec::new() }, Base::Fixed).unwrap();
        let each = |effect: EffectId, name: &str| -> Vec<Applied> {
            let parameters = vec![1.0; effect.row().len()];
            (1..count).map(|k| on(effect, &format!("{name}_{k}"), &parameters)).collect()
        };
        let all = [each(EffectId::damping, "joint"), each(EffectId::drag, "link")].concat();
        let with = chain.clone().with_effects(&all).unwrap();
        assert!((2..count).all(|i| with.bodies[BodyId(i)].effects.kinds().len() == 2));
        for (effect, name) in [(EffectId::damping, "jount"), (EffectId::drag, "lunk")] {
            let errors = chain.clone().with_effects(&each(effect, name)).unwrap_err().0;
            let meant = |error: &EffectError| matches!(error.fault, Fault::Unknown { nearest: Some(_), .. });
            assert_eq!((errors.len(), meant(&errors[0]), meant(&errors[count - 2])), (count - 1, true, false));
        }
    }

    #[test]
    fn a_floating_base_has_no_joint_that_effects_are_on() {
        let description = Description {
            name: "one".into(),
            links: [Link { name: "body".into(), ..Link::default() }].into(),
            joints: Vec::new().into(),
            frames: Vec::new(),
        };
        let floating = Model::new(&description, Base::Floating).unwrap();
        let errors = floating.with_effects(&[on(EffectId::damping, crate::model::FLOATING_BASE, &[1.0])]).unwrap_err();
        assert_eq!(errors.0[0].fault, Fault::Base);
        assert!(errors.to_string().contains("the floating base is no joint of the robot"));
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

    #[test]
    fn a_normal_of_any_length_is_that_of_length_one() {
        let normal = |n: [f64; 3]| {
            let parameters = [&[0.1, 1e3, 0.5, 0.3, 1e-2], &n[..], &[0.2, 0.0]].concat();
            let with = robot().with_effects(&[on(EffectId::contact, "ball", &parameters)]).unwrap();
            let effects = &with.bodies[with.frames[FrameId(2)].body].effects.body;
            assert_eq!((effects.len(), &effects[0].parameters[..5], effects[0].parameters[8]), (1, &parameters[..5], 0.2));
            effects[0].parameters[5..8].to_vec()
        };
        assert_eq!([normal([0.0, 3.0, 4.0]), normal([0.0, 3e-200, -4e-200])], [[0.0, 0.6, 0.8], [0.0, 0.6, -0.8]]);
        // Vectors whose length exceeds the range of numbers.
        assert_eq!(normal([0.0, -f64::MAX, f64::MAX]), normal([0.0, -5e-324, 5e-324]));
        assert_eq!(normal([0.0, -f64::MAX, f64::MAX]), normal([0.0, -1.0, 1.0]));
    }
}
