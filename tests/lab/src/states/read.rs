//! States from a file: either format, then the same checks.

use articulated_codegen::nearest;
use articulated_core::algorithm::Argument;
use articulated_core::model::Model;
use articulated_core::spatial::{NORM_TOLERANCE, input_norm};
use articulated_core::step::{ACT, CTRL};
use articulated_scene::beyond_sense;

use super::random::normalise;
use super::{Slot, State, known_arguments, owner, quaternions, slots};
use crate::table::counted;

/// Quaternions with norms this close to one cause no warning: the rounding of the four numbers.
const ROUNDING: f64 = 4.0 * f64::EPSILON;
/// At most this many errors are listed.
const MOST: usize = 100;

/// States that were read, with warnings.
#[derive(Clone, Debug, Default)]
pub struct States {
    /// The states in the order of the file.
    pub states: Vec<State>,
    /// Corrections, a line each.
    pub warnings: Vec<String>,
}

/// Contents and errors so far.
pub(super) struct Found<'a> {
    pub(super) model: &'a Model<f64>,
    pub(super) errors: Vec<String>,
    warnings: Vec<String>,
    states: Vec<State>,
    /// The first implausibly large coordinate, and the number of other states with one.
    beyond: Option<(String, usize)>,
}

impl<'a> Found<'a> {
    pub(super) fn new(model: &'a Model<f64>) -> Self {
        Self { model, errors: Vec::new(), warnings: Vec::new(), states: Vec::new(), beyond: None }
    }

    pub(super) fn error(&mut self, place: &str, what: impl std::fmt::Display) {
        self.errors.push(format!("{place}: {what}"));
    }

    /// Takes one argument of one state after checking length, numbers and quaternions.
    pub(super) fn take(&mut self, state: &mut State, argument: Argument, place: &str, mut numbers: Vec<f64>) {
        let expected = argument.len(self.model.shape());
        if numbers.len() != expected {
            return self.error(place, format!("found {}, expected {expected}", counted(numbers.len(), "number")));
        }
        let bad: Vec<usize> = (0..expected).filter(|&k| !numbers[k].is_finite()).collect();
        for &k in &bad {
            let name = self.number_name(argument, k);
            self.error(place, format!("{name}: found {}, expected a finite number", numbers[k]));
        }
        match argument {
            Argument::Q | Argument::Target if bad.is_empty() => self.check_quaternions(place, &mut numbers),
            Argument::Uniform => self.check_uniform(place, &numbers),
            _ => {}
        }
        if argument == Argument::Q
            && let Some(line) = beyond_sense(self.model, &numbers).first()
        {
            self.beyond.get_or_insert_with(|| (format!("{place}: {line}"), 0)).1 += 1;
        }
        state.set(argument, numbers);
    }

    pub(super) fn push(&mut self, state: State) {
        self.states.push(state);
    }

    fn check_quaternions(&mut self, place: &str, q: &mut [f64]) {
        let model = self.model;
        for (joint, at) in quaternions(model) {
            let (quaternion, name) = (&mut q[at..at + 4], &joint.name);
            match input_norm(quaternion) {
                Err(norm) => {
                    self.error(place, format!("joint {name:?}: found a quaternion of norm {norm}, expected 1 within {NORM_TOLERANCE:e}"));
                }
                Ok(norm) if (norm - 1.0).abs() > ROUNDING => {
                    normalise(quaternion);
                    self.warnings.push(format!("{place}: joint {name:?}: quaternion of norm {norm} was normalised"));
                }
                Ok(_) => {}
            }
        }
    }

    fn check_uniform(&mut self, place: &str, numbers: &[f64]) {
        for (k, x) in numbers.iter().enumerate().filter(|(_, x)| x.is_finite() && !(0.0..1.0).contains(*x)) {
            let name = self.number_name(Argument::Uniform, k);
            self.error(place, format!("{name}: found {x}, expected 0 or more and less than 1"));
        }
    }

    /// The joint or link that number `k` belongs to.
    fn number_name(&self, argument: Argument, k: usize) -> String {
        let slots = slots(argument, self.model);
        let Some(slot) = slots.iter().find(|s| (s.at..s.at + s.count).contains(&k)) else { return format!("[{k}]") };
        let name = format!("{} {:?}", owner(argument), slot.name);
        if slot.count == 1 { name } else { format!("{name}[{}]", k - slot.at) }
    }

    /// The part of this name, or an error that names the nearest.
    pub(super) fn slot(&mut self, place: &str, argument: Argument, name: &str) -> Option<usize> {
        let slots = slots(argument, self.model);
        let found = slots.iter().position(|s| s.name == name);
        if found.is_none() {
            let near = nearest(name, slots.iter().map(|s| s.name)).map_or_else(|| there_are(&slots), |near| hint(Some(near)));
            self.error(
                place,
                match argument {
                    Argument::Wrenches => format!("found link {name:?}, which is not a frame here{near}"),
                    ACT | CTRL => format!("found actuator {name:?}, which has no number in {} of this robot{near}", argument.name()),
                    _ => format!("found joint {name:?}, which is not a coordinate of this robot{near}"),
                },
            );
        }
        found
    }

    /// The argument of this name, or an error that names the nearest.
    pub(super) fn argument(&mut self, place: &str, name: &str) -> Option<Argument> {
        let found = known_arguments().find(|a| a.name() == name);
        if found.is_none() {
            let names: Vec<&str> = known_arguments().map(Argument::name).collect();
            let near = nearest(name, names.iter().copied());
            self.error(place, format!("found {name:?}, expected one of {}{}", names.join(", "), hint(near)));
        }
        found
    }

    pub(super) fn finish(mut self) -> Result<States, Vec<String>> {
        if self.errors.is_empty() && self.states.is_empty() {
            self.errors.push("found no state, expected at least one".into());
        }
        if let Some((line, count)) = self.beyond {
            self.warnings.push(if count > 1 { format!("{line} (and {} more states)", count - 1) } else { line });
        }
        if self.errors.is_empty() {
            return Ok(States { states: self.states, warnings: self.warnings });
        }
        Err(listed(self.errors))
    }
}

/// The first of many errors, and how many more there are.
pub fn listed(mut errors: Vec<String>) -> Vec<String> {
    let more = errors.len().saturating_sub(MOST);
    errors.truncate(MOST);
    errors.extend((more > 0).then(|| format!("and {more} more")));
    errors
}

/// All names, or the first of many.
fn there_are(slots: &[Slot<'_>]) -> String {
    format!("; there are {}", articulated_core::listed(slots.iter().map(|s| s.name)))
}

fn hint(near: Option<String>) -> String {
    near.map_or_else(String::new, |n| format!("; did you mean {n:?}?"))
}

/// Numbers by name, gathered until all are there. Links that are not named carry no wrench.
pub(super) struct Gathering {
    argument: Argument,
    numbers: Vec<Option<f64>>,
}

impl Gathering {
    pub(super) fn new(argument: Argument, found: &Found<'_>) -> Self {
        let absent = (argument == Argument::Wrenches).then_some(0.0);
        Self { argument, numbers: vec![absent; argument.len(found.model.shape())] }
    }

    pub(super) fn argument(&self) -> Argument {
        self.argument
    }

    /// Sets a number.
    pub(super) fn set(&mut self, at: usize, x: f64) {
        if let Some(number) = self.numbers.get_mut(at) {
            *number = Some(x);
        }
    }

    /// All numbers, or errors that name the joints without.
    pub(super) fn finish(self, state: &mut State, place: &str, found: &mut Found<'_>) {
        let missing: Vec<usize> = (0..self.numbers.len()).filter(|&k| self.numbers[k].is_none()).collect();
        for &k in &missing {
            let name = found.number_name(self.argument, k);
            found.error(place, format!("{name}: found nothing, expected a number"));
        }
        if missing.is_empty() {
            found.take(state, self.argument, place, self.numbers.into_iter().flatten().collect());
        }
    }
}
