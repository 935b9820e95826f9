//! Cost of checking the pivots of forward dynamics.
//!
//! The checked form is the generic library's and is not generated; here it is traced as if it were,
//! so that its operations can be counted.

use articulated_core::Scalar;
use articulated_core::algorithm::checked::{articulated_body_pivots, factored_pivots, least_pivot};
use articulated_core::algorithm::{Argument, articulated_body, forward_dynamics};
use articulated_core::model::Model;
use num_traits::Zero;

use crate::graph::Graph;
use crate::ledger::{Entry, depth};
use crate::model_pass::View;
use crate::pass;
use crate::sym::{self, Sym};

/// The costs of forward dynamics by ABA, or by M = Lᵀ D L where joints follow others, and of the
/// same with the smallest D/(Σ|terms|) compared with its lower bound.
pub fn checked_cost(model: &Model<f64>) -> [Entry; 2] {
    let passed = View::new(model.clone()).passed();
    let follows = model.has_followers();
    let way = if follows { "LTDL" } else { "ABA" };
    let [plain, checked] = [false, true].map(|looks| sym::trace(|| traced(&passed.cast(), follows, looks)));
    [entry(format!("forward_dynamics by {way}"), plain), entry(format!("checked_forward_dynamics by {way}"), checked)]
}

/// The arguments of forward dynamics.
const ARGUMENTS: [Argument; 3] = [Argument::Q, Argument::V, Argument::Tau];

/// Accelerations, and by how much the smallest pivot is beyond its least.
fn traced(view: &View<Sym>, follows: bool, looks: bool) -> Vec<Sym> {
    let model = &view.model;
    let shape = model.shape();
    let [q, v, tau] = [0, 1, 2].map(|place| (0..ARGUMENTS[place].len(shape)).map(|k| Sym::input(place, k)).collect::<Vec<_>>());
    let (mut ws, mut out) = (view.workspace(), vec![Sym::zero(); model.nv()]);
    if follows {
        forward_dynamics(model, &mut ws, &q, &v, &tau, &mut out);
    } else {
        articulated_body(model, &mut ws, &q, &v, &tau, &mut out);
    }
    if !looks {
        return out;
    }
    let mut smallest: Option<Sym> = None;
    let see = |_: usize, left: Sym| smallest = Some(smallest.map_or(left, |s| Sym::select((s - left).positive(), left, s)));
    if follows {
        factored_pivots(model, &mut ws, &q, see);
    } else {
        articulated_body_pivots(model, &mut ws, see);
    }
    out.extend(smallest.map(|s| s - least_pivot()));
    out
}

fn entry(function: String, traced: Graph) -> Entry {
    let mut stages = vec![("requested", traced.requested().clone()), ("trace", traced.counts())];
    let graph = pass::run_all(traced, |name, graph| stages.push((name, graph.counts())));
    Entry { function, ways: Vec::new(), stages, depth: depth(&graph), lanes: 1, arguments: ARGUMENTS.to_vec() }
}
