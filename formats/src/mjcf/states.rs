//! States: where the file starts, and the section `<keyframe>`.

use std::ops::Range;

use articulated_core::diagnostic::{At, Code, Diagnostics, Subject};

use super::actuators::Control;
use super::bodies::{Extent, Kind};
use super::element::Element;
use super::scope::{Known, Scope, coordinates, freedoms, reference};
use super::values::Values;
use crate::pose::{IDENTITY, conjugate, rotate, scalar_last};
use crate::world::{Keyframe, World};

/// The initial state in MuJoCo, if it differs from that of joints at rest.
pub(crate) fn home(scope: &Scope<'_>) -> Option<Keyframe> {
    let at_rest = |known: &Known<'_>, q: &[f64]| match known.joint.kind {
        Kind::Free => q[..6] == [0.0; 6] && q[6] == 1.0,
        _ => known.joint.reference == 0.0,
    };
    let all: Vec<(&Known<'_>, Vec<f64>)> = scope.joints.iter().map(|known| (known, reference(scope, known))).collect();
    if all.iter().all(|(known, q)| at_rest(known, q)) {
        return None;
    }
    let q = all.into_iter().map(|(known, q)| (known.name.to_owned(), q)).collect();
    Some(Keyframe { name: "qpos0".to_owned(), q, place: At::Nowhere, ..Keyframe::default() })
}

/// Reads all keyframes: of the main document, then of attached ones.
pub(crate) fn keyframes(scope: &mut Scope<'_>, controls: &[Control], has_unread_joints: bool, world: &mut World, log: &mut Diagnostics) {
    let mut number = 0;
    for index in 0..scope.tree.parts.len() {
        let part = scope.part(index);
        // Copies have no states of their own.
        if part.extent == Extent::Copy || !part.is_first {
            continue;
        }
        for element in part.settings.keyframes.iter().copied().filter(|element| element.is("key")) {
            for name in ["mpos", "mquat", "plastic"] {
                let attribute = element.attribute(name).filter(|attribute| !attribute.value.trim().is_empty());
                if let Some(attribute) = attribute.filter(|_| index == 0) {
                    let why = "states of moved bodies and of springs are not read";
                    element.unused(&Subject::Document, Some(attribute), why, log);
                }
            }
            if part.extent == Extent::Attached {
                scope.unread(element, "a state of a model of which a part is attached", None, log);
                number += 1;
                continue;
            }
            let key = Key { element, bodies: part.bodies.clone(), parts: part.parts.clone(), has_unread_joints };
            let name = scope.full(index, element).unwrap_or_else(|| format!("key_{number}"));
            number += 1;
            let state = Keyframe { name, place: scope.place(element), ..key.state(scope, controls, world, log) };
            world.keyframes.push(state);
        }
    }
}

/// A keyframe, with the bodies and parts that its vectors contain.
struct Key<'a> {
    element: &'a Element,
    bodies: Range<usize>,
    parts: Range<usize>,
    has_unread_joints: bool,
}

impl Key<'_> {
    /// The numbers of an attribute, if it has any; if there are too few, those of `rest` complete
    /// them.
    fn numbers(&self, name: &str, rest: &[f64], log: &mut Diagnostics) -> Option<Vec<f64>> {
        let subject = Subject::Document;
        let mut numbers = Values::alone(self.element, &subject).list(name, log).filter(|numbers| !numbers.is_empty())?;
        let (found, count) = (numbers.len(), rest.len());
        if self.has_unread_joints && found != count {
            let why = "the file has joints that are not read";
            self.element.unused(&subject, self.element.attribute(name), why, log);
            return None;
        }
        if found > count {
            let expected = format!("at most {count}, for all joints or actuators of the file");
            self.element.error((&subject, name), Code::WrongCount, format!("{found} numbers"), expected, log);
            return None;
        }
        numbers.extend_from_slice(&rest[found..]);
        Some(numbers)
    }

    fn state(&self, scope: &Scope<'_>, controls: &[Control], world: &World, log: &mut Diagnostics) -> Keyframe {
        let own: Vec<&Known<'_>> = scope.joints.iter().filter(|known| self.bodies.contains(&known.body)).collect();
        let at_rest: Vec<f64> = own.iter().flat_map(|known| scalar_first(known.joint.kind, &reference(scope, known))).collect();
        let still: Vec<f64> = own.iter().flat_map(|known| vec![0.0; freedoms(known.joint.kind)]).collect();
        let positions = self.numbers("qpos", &at_rest, log);
        let rates = self.numbers("qvel", &still, log);
        let (mut q, mut v) = (Vec::new(), Vec::new());
        let (mut at, mut at_rate) = (0, 0);
        for known in &scope.joints {
            let (name, kind) = (known.name.to_owned(), known.joint.kind);
            let (mut coordinate, mut rate) = (reference(scope, known), vec![0.0; freedoms(kind)]);
            if self.bodies.contains(&known.body) {
                let (from, from_rate) = (at, at_rate);
                (at, at_rate) = (at + coordinates(kind), at_rate + freedoms(kind));
                if let Some(numbers) = &positions {
                    coordinate = scalar_last_of(kind, &numbers[from..at]);
                }
                if let Some(numbers) = &rates {
                    rate = twist(kind, &numbers[from_rate..at_rate], &coordinate);
                }
            }
            q.push((name.clone(), coordinate));
            v.push((name, rate));
        }
        if positions.is_none() {
            q = world.home.as_ref().map(|home| home.q.clone()).unwrap_or_default();
        }
        if rates.is_none() {
            v.clear();
        }
        let activation = self.activation(controls, world, log);
        Keyframe { q, v, control: self.control(controls, world, log), activation, ..Keyframe::default() }
    }

    /// The activations of the actuators that are read, 0 of those without; empty if all are zero.
    fn activation(&self, controls: &[Control], world: &World, log: &mut Diagnostics) -> Vec<f64> {
        let own: Vec<&Control> = controls.iter().filter(|control| self.parts.contains(&control.part)).collect();
        let count = own.iter().map(|control| control.activations).sum();
        let Some(numbers) = self.numbers("act", &vec![0.0; count], log) else { return Vec::new() };
        let mut of_actuators = vec![0.0; world.actuators.len()];
        let mut next = numbers.into_iter();
        for control in own {
            let values: Vec<f64> = next.by_ref().take(control.activations).collect();
            if let (Some(actuator), [value]) = (control.actuator, values.as_slice()) {
                of_actuators[actuator] = *value;
            }
        }
        of_actuators
    }

    /// The controls of the actuators that are read; empty if all are zero.
    fn control(&self, controls: &[Control], world: &World, log: &mut Diagnostics) -> Vec<f64> {
        let own: Vec<&Control> = controls.iter().filter(|control| self.parts.contains(&control.part)).collect();
        let Some(numbers) = self.numbers("ctrl", &vec![0.0; own.len()], log) else { return Vec::new() };
        let mut all = vec![0.0; world.actuators.len()];
        for (control, number) in own.iter().zip(numbers) {
            if let Some(actuator) = control.actuator {
                all[actuator] = number;
            }
        }
        all
    }
}

/// Coordinates of MuJoCo in the conventions of a description.
fn scalar_last_of(kind: Kind, q: &[f64]) -> Vec<f64> {
    let (position, quaternion) = q.split_at(q.len().saturating_sub(4));
    match kind {
        Kind::Free | Kind::Ball => {
            let quaternion = scalar_last(quaternion.try_into().unwrap_or(IDENTITY));
            position.iter().copied().chain(quaternion).collect()
        }
        Kind::Slide | Kind::Hinge => q.to_vec(),
    }
}

/// Coordinates of a description in the conventions of MuJoCo.
fn scalar_first(kind: Kind, q: &[f64]) -> Vec<f64> {
    let mut all = q.to_vec();
    if matches!(kind, Kind::Free | Kind::Ball) {
        all[q.len().saturating_sub(4)..].rotate_right(1);
    }
    all
}

/// Rates: of a free joint (v in the world; ω in the body) as the twist [ω; Rᵀ v].
fn twist(kind: Kind, rates: &[f64], q: &[f64]) -> Vec<f64> {
    match (kind, rates, q) {
        (Kind::Free, [u, v, w, a, b, c], [_, _, _, x, y, z, s]) => {
            let [u, v, w] = rotate(conjugate([*s, *x, *y, *z]), [*u, *v, *w]);
            vec![*a, *b, *c, u, v, w]
        }
        _ => rates.to_vec(),
    }
}
