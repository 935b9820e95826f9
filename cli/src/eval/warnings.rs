//! Warnings about unreliable results: non-finite numbers, or a mass matrix that is singular at the
//! state.

use articulated_core::algorithm::checked::checked_forward_dynamics;
use articulated_core::algorithm::{Argument, Workspace};
use articulated_core::model::Model;

use super::report::FunctionReport;
use crate::states::State;

/// More are counted, not listed.
const MOST: usize = 10;

/// Warnings about the functions' results, one line each; `file` has the states.
pub(super) fn of_results(functions: &[FunctionReport], states: &[State], model: &Model<f64>, file: &str) -> Vec<String> {
    let inverse = functions.iter().filter(|f| f.function.inverts_mass_matrix()).map(|f| f.function.name).collect::<Vec<_>>().join(", ");
    let mut ws = Workspace::new(model);
    let mut lines = Vec::new();
    for (k, state) in states.iter().enumerate() {
        if let Some(why) = state.get(Argument::Q).filter(|_| !inverse.is_empty()).and_then(|q| singular(model, &mut ws, q)) {
            lines.push(format!("{file}: states[{k}]: {inverse}: {why}"));
        }
        for f in functions {
            let both = [&f.outcomes[k].generic, &f.outcomes[k].generated];
            let found = both.into_iter().flatten().map(|out| not_finite(out)).find(|found| !found.is_empty());
            if let [first, others @ ..] = &found.unwrap_or_default()[..] {
                let others = match others.len() {
                    0 => String::new(),
                    1 => ", nor is 1 other".into(),
                    n => format!(", nor are {n} others"),
                };
                lines.push(format!("{file}: states[{k}]: {}: number {first} of the result is not finite{others}", f.function.name));
            }
        }
    }
    let more = lines.len().saturating_sub(MOST);
    lines.truncate(MOST);
    lines.extend((more > 0).then(|| format!("{file}: {more} more results that are not finite, or of a singular mass matrix")));
    lines
}

/// Indices of the numbers that are not finite.
fn not_finite(out: &[f64]) -> Vec<usize> {
    (0..out.len()).filter(|&at| !out[at].is_finite()).collect()
}

/// The reason why solutions with the mass matrix are meaningless at these coordinates.
fn singular(model: &Model<f64>, ws: &mut Workspace<f64>, q: &[f64]) -> Option<String> {
    let (zero, mut out) = (vec![0.0; model.nv()], vec![0.0; model.nv()]);
    checked_forward_dynamics(model, ws, q, &zero, &zero, &mut out).err().map(|singular| singular.to_string())
}
