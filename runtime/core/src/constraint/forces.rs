//! Where contacts act, and with which forces.

use alloc::collections::BTreeMap;
use alloc::vec;
use alloc::vec::Vec;

use super::contact::{self, Contact};
use super::motion;
use super::pairs::{self, Found};
use super::{Constraints, Pair};
use crate::Scalar;
use crate::algorithm::{Placed as Bodies, Workspace};
use crate::collision::Form;
use crate::model::Model;
use crate::spatial::Twist;

/// How many numbers a place of contact has: whether it acts, its point, its normal, force and
/// moment.
pub const CONTACT: usize = 13;

impl<S> Constraints<S> {
    /// In how many places its pairs may touch.
    pub fn contacts(&self) -> usize {
        self.pairs.iter().map(|pair| self.places(pair)).sum()
    }

    /// The pair of each contact that a caller gives, in their order.
    pub fn pair_of_given(&self) -> impl Iterator<Item = usize> {
        self.pairs.iter().enumerate().flat_map(|(index, pair)| core::iter::repeat_n(index, pair.given))
    }

    /// The pair of each place where shapes may touch, in their order.
    pub fn pair_of_contacts(&self) -> impl Iterator<Item = usize> {
        self.pairs.iter().enumerate().flat_map(|(index, pair)| core::iter::repeat_n(index, self.places(pair)))
    }

    fn places(&self, pair: &Pair<S>) -> usize {
        if pair.given > 0 {
            return 0;
        }
        let [first, second] = pair.shapes.map(|shape| &self.shapes[shape].form);
        Form::places(first, second).unwrap_or(0)
    }
}

/// Contacts at the acceleration x, of origins d²p/dt²: `out` `[contacts + given][13]` has for each
/// place, and for each given contact, 1, the point, the normal, the force and the moment about the
/// point, in axes of the world; zeros where nothing touches. The normal is from the world to the
/// body, or from the first body of the pair to the second; force and moment act on this body.
///
/// `given`: contacts that a caller found, `[given][8]`, or empty: they have no rows then.
pub(crate) fn contact_forces<S: Scalar>(
    model: &Model<S>,
    ws: &mut Workspace<S>,
    (q, v, given): (&[S], &[S], &[S]),
    x: &[S],
    out: &mut [S],
) {
    out.fill(S::zero());
    let constraints = &model.constraints;
    let placed = Bodies::at(model, ws, q);
    let origin = motion::origin(model, &placed);
    let columns = motion::columns(&placed, origin);
    let [rates, accelerations] = [v, x].map(|x| motion::twists(model, &columns, x));
    // The next place of each pair
    let mut next = vec![0; constraints.pairs.len()];
    let places: Vec<usize> = constraints.pair_of_contacts().chain(constraints.pair_of_given()).collect();
    places.iter().enumerate().rev().for_each(|(place, pair)| next[*pair] = place);
    // Contacts of one dimension: rows of a table, and their places
    let mut tables: BTreeMap<usize, (Vec<S>, Vec<usize>)> = BTreeMap::new();
    for Found { pair, bodies: [one, other], dimension, rows } in pairs::contacts(constraints, &placed, (origin, &rates), given) {
        let relative = (accelerations[other] - accelerations[one]).to_array();
        let (table, places) = tables.entry(dimension).or_default();
        for row in rows.chunks(contact::length(dimension)) {
            table.extend(row.iter().chain(&relative));
            places.push(next[pair]);
            next[pair] += 1;
        }
    }
    for (dimension, (table, places)) in tables {
        let mut found = vec![S::zero(); CONTACT * places.len()];
        S::for_each(places.len(), &table, &mut [], &mut found, |row, _, out| {
            S::when(row[0].positive(), out, |out| {
                let (row, relative) = row.split_at(contact::length(dimension));
                let contact = Contact::of(row, dimension);
                let twist = Twist::from_array(core::array::from_fn(|k| relative[k]));
                let cost = contact.cost(constraints.cone, &contact.rates(&twist));
                let pushed: Vec<S> = cost.slope[..dimension].iter().map(|slope| -*slope).collect();
                let [force, moment] = contact.acting(&pushed);
                out[0] = S::one();
                for (out, vector) in out[1..].chunks_mut(3).zip([contact.point() + origin, contact.normal(), force, moment]) {
                    out.copy_from_slice(vector.as_slice());
                }
            });
        });
        for (place, row) in places.iter().zip(found.chunks(CONTACT)) {
            out[place * CONTACT..][..CONTACT].copy_from_slice(row);
        }
    }
}
