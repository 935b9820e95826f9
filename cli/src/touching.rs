//! What touches in a state with constraints, with which forces, and how exact its acceleration is.

use articulated_core::algorithm::{FunctionError, Workspace};
use articulated_core::constraint::CONTACT;
use articulated_core::model::Model;
use articulated_core::step::{State, step};
use serde::Serialize;

/// A place where shapes touch.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Contact {
    /// Names of the shapes.
    pub(crate) shapes: [String; 2],
    /// m.
    pub(crate) point: [f64; 3],
    /// From the world to the body, or from the first body to the second.
    pub(crate) normal: [f64; 3],
    /// On this body, N.
    pub(crate) force: [f64; 3],
    /// On this body about the point, N·m.
    pub(crate) moment: [f64; 3],
}

/// What constraints do in a state.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Touching {
    /// No less than the distance of the acceleration from the optimum, over the acceleration
    /// without constraints, both in the norm of the mass matrix.
    pub(crate) relative_error: f64,
    /// Steps of Newton's method.
    pub(crate) search_steps: u32,
    /// What touches.
    pub(crate) contacts: Vec<Contact>,
}

impl Touching {
    /// In a state, with these controls.
    pub(crate) fn of(model: &Model<f64>, ws: &mut Workspace<f64>, state: &State, ctrl: &[f64]) -> Result<Self, FunctionError> {
        let mut call = |name: &str, inputs: &[&[f64]], out: &mut [f64]| match step(name) {
            Some(row) => row.call(model, ws, inputs, out),
            None => Ok(()),
        };
        let (nv, count) = (model.nv(), model.shape().contacts);
        let warm = if state.warm.is_empty() { vec![0.0; nv] } else { state.warm.clone() };
        let mut found = vec![0.0; nv + 3];
        call("constrained_search", &[&state.q, &state.v, &state.act, ctrl, &warm], &mut found)?;
        let mut places = vec![0.0; CONTACT * count];
        call("contact_forces", &[&state.q, &state.v, &found[..nv]], &mut places)?;
        let constraints = model.constraints();
        let acts = constraints.pair_of_contacts().zip(places.chunks(CONTACT)).filter(|(_, place)| place[0] == 1.0);
        let of = |(pair, place): (usize, &[f64])| {
            let three = |k: usize| [place[k], place[k + 1], place[k + 2]];
            Contact {
                shapes: constraints.pairs[pair].shapes.map(|shape| constraints.shapes[shape].name.clone()),
                point: three(1),
                normal: three(4),
                force: three(7),
                moment: three(10),
            }
        };
        let [error, size, steps] = [found[nv], found[nv + 1], found[nv + 2]];
        let relative_error = if error > 0.0 { error / size } else { error };
        Ok(Self { relative_error, search_steps: steps as u32, contacts: acts.map(of).collect() })
    }

    /// Whether the search found the acceleration.
    pub(crate) fn is_found(&self) -> bool {
        self.relative_error <= FOUND
    }
}

/// A larger relative error is of a search that did not find the acceleration.
pub(crate) const FOUND: f64 = 1e-8;
