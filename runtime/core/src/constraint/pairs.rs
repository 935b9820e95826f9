//! The contacts of all pairs of shapes.
//!
//! Pairs of one sort have the same forms and the same law, with other numbers. They are rows of one
//! table: generated code has each sort once.

use alloc::vec;
use alloc::vec::Vec;
use core::cell::RefCell;

use super::contact::{self, Contact};
use super::motion::Twists;
use super::{Constraints, Pair};
use crate::Scalar;
use crate::algorithm::Placed as Bodies;
use crate::collision::{Form, Placed, Touch, are_near, touches};
use crate::index::BodyId;
use crate::scalar::flag;
use crate::spatial::{Placement, Twist, Vector3};

/// Contacts of a pair.
pub(super) struct Found<S> {
    /// The place of the pair in [`Constraints::pairs`].
    pub(super) pair: usize,
    /// The bodies, the base first.
    pub(super) bodies: [BodyId; 2],
    pub(super) dimension: usize,
    /// A row for each place, see [`Contact::of`].
    pub(super) rows: Vec<S>,
}

/// A pair with its place in [`Constraints::pairs`].
type Numbered<'a, S> = (usize, &'a Pair<S>);

/// What of a pair is not a number.
#[derive(PartialEq)]
struct Sort {
    forms: [usize; 2],
    dimension: usize,
    power: Option<u32>,
    is_reversed: bool,
}

/// The contacts of all pairs, with places about the origin. `twists`: of all bodies about it.
pub(super) fn contacts<S: Scalar>(
    constraints: &Constraints<S>,
    placed: &Bodies<'_, S>,
    (origin, twists): (Vector3<S>, &Twists<S>),
    given: &[S],
) -> Vec<Found<S>> {
    let shape = |pair: &Pair<S>| pair.shapes.map(|shape| &constraints.shapes[shape]);
    let sort = |pair: &Pair<S>| Sort {
        forms: shape(pair).map(|shape| shape.form.rank()),
        dimension: pair.dimension,
        power: pair.soft.impedance.twice_power(),
        is_reversed: shape(pair)[1].body.is_base(),
    };
    let mut sorts: Vec<(Sort, Vec<Numbered<'_, S>>)> = Vec::new();
    for (index, pair) in constraints.pairs.iter().enumerate().filter(|(_, pair)| pair.given == 0) {
        let own = sort(pair);
        match sorts.iter_mut().find(|(other, _)| *other == own) {
            Some((_, pairs)) => pairs.push((index, pair)),
            None => sorts.push((own, [(index, pair)].into())),
        }
    }
    let place = |shape: usize| {
        let shape = &constraints.shapes[shape];
        let at = match shape.body.is_base() {
            true => shape.placement,
            false => placed.frame(shape.body, &shape.placement),
        };
        Placement { position: at.position - origin, ..at }
    };
    let mut found = Vec::new();
    for (Sort { dimension, is_reversed, .. }, pairs) in sorts {
        let (_, first) = pairs[0];
        let forms = shape(first).map(|shape| &shape.form);
        let length = contact::length_of_place(dimension);
        let places = length * Form::places(forms[0], forms[1]).unwrap_or(0);
        let mut table = Vec::new();
        for (_, pair) in &pairs {
            let bodies = shape(pair).map(|shape| shape.body);
            let (forms, relative) = (shape(pair).map(|shape| &shape.form), twists[bodies[1]] - twists[bodies[0]]);
            table.extend(numbers(|see| {
                pair.map(see);
                forms.iter().for_each(|form| _ = form.map(see));
                pair.shapes.iter().for_each(|shape| _ = place(*shape).map(see));
                relative.to_array().iter().for_each(|x| _ = see(*x));
            }));
        }
        let mut results = vec![S::zero(); places * pairs.len()];
        S::for_each(pairs.len(), &table, &mut [], &mut results, |row, _, rows| {
            let row = RefCell::new(row.iter());
            let next = |other: S| row.borrow_mut().next().copied().unwrap_or(other);
            let pair = first.map(next);
            let forms = forms.map(|form| form.map(next));
            let [one, other] = pair.shapes.map(|_| Placement::identity().map(next));
            let relative = Twist { angular: Vector3::zeros().map(next), linear: Vector3::zeros().map(next) };
            let both = [(&forms[0], one), (&forms[1], other)];
            let both = both.map(|(form, Placement { rotation, position })| Placed { form, rotation, position });
            S::when(are_near(&both, pair.margin).positive(), rows, |rows| {
                for (touch, row) in touches(&both[0], &both[1], pair.margin).iter().zip(rows.chunks_mut(length)) {
                    let acts = flag::<S>((pair.margin - touch.distance).positive()) * touch.exists;
                    S::when(acts.positive(), row, |row| {
                        let contact = Contact::new(&pair, constraints.cone, touch, &relative);
                        row.copy_from_slice(&if is_reversed { contact.reversed() } else { contact }.place());
                    });
                }
            });
        });
        for ((index, pair), places) in pairs.iter().zip(results.chunks(places.max(1))) {
            let [one, other] = shape(pair).map(|shape| shape.body);
            let rows = places.chunks(length).flat_map(|place| Contact::row_of(pair, place)).collect();
            found.push(Found { pair: *index, bodies: if is_reversed { [other, one] } else { [one, other] }, dimension, rows });
        }
    }
    if !given.is_empty() {
        of_caller(constraints, (origin, twists), given, &mut found);
    }
    found
}

/// How many numbers a contact of a caller has: 1 or 0, the distance, the point and the normal in
/// the world.
pub const GIVEN: usize = 8;

/// The contacts that a caller gives, in the order of their pairs.
fn of_caller<S: Scalar>(constraints: &Constraints<S>, (origin, twists): (Vector3<S>, &Twists<S>), given: &[S], found: &mut Vec<Found<S>>) {
    let bodies = |pair: &Pair<S>| pair.shapes.map(|shape| constraints.shapes[shape].body);
    // Contacts of one dimension, power and direction are rows of a table, beside their pairs.
    type Key = (usize, Option<u32>, bool);
    let mut tables: Vec<(Key, Vec<usize>, Vec<S>)> = Vec::new();
    for (index, own) in constraints.pair_of_given().zip(given.chunks(GIVEN)) {
        let pair = &constraints.pairs[index];
        let [one, other] = bodies(pair);
        let key = (pair.dimension, pair.soft.impedance.twice_power(), other.is_base());
        let place = tables.iter().position(|(known, ..)| *known == key).unwrap_or_else(|| {
            tables.push((key, Vec::new(), Vec::new()));
            tables.len() - 1
        });
        let (_, pairs, table) = &mut tables[place];
        pairs.push(index);
        table.extend(numbers(|see| _ = pair.map(see)));
        table.extend(own.iter().chain(&(twists[other] - twists[one]).to_array()));
    }
    for ((dimension, _, is_reversed), pairs, table) in tables {
        let (first, length) = (&constraints.pairs[pairs[0]], contact::length_of_place(dimension));
        let mut results = vec![S::zero(); length * pairs.len()];
        S::for_each(pairs.len(), &table, &mut [], &mut results, |row, _, place| {
            let row = RefCell::new(row.iter());
            let next = |other: S| row.borrow_mut().next().copied().unwrap_or(other);
            let pair = first.map(next);
            let three = || Vector3::zeros().map(next);
            let (exists, distance) = (next(S::zero()), next(S::zero()));
            let touch = Touch { exists, distance, point: three() - origin, normal: three(), tangent: None };
            let relative = Twist { angular: three(), linear: three() };
            let acts = flag::<S>((pair.margin - distance).positive()) * flag::<S>(exists.positive());
            S::when(acts.positive(), place, |place| {
                let contact = Contact::new(&pair, constraints.cone, &touch, &relative);
                place.copy_from_slice(&if is_reversed { contact.reversed() } else { contact }.place());
            });
        });
        for (pair, place) in pairs.into_iter().zip(results.chunks(length)) {
            let [one, other] = bodies(&constraints.pairs[pair]);
            let rows = Contact::row_of(&constraints.pairs[pair], place);
            found.push(Found { pair, bodies: if is_reversed { [other, one] } else { [one, other] }, dimension, rows });
        }
    }
}

/// The numbers that `visit` sees, in order.
fn numbers<S: Scalar>(visit: impl FnOnce(&dyn Fn(S) -> S)) -> Vec<S> {
    let numbers = RefCell::new(Vec::new());
    visit(&|x| {
        numbers.borrow_mut().push(x);
        x
    });
    numbers.into_inner()
}
