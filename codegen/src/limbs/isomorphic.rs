//! Isomorphic limbs of a robot: their indices, and their constants as symbols.

use std::cell::RefCell;
use std::collections::{BTreeSet, HashMap};
use std::mem::{Discriminant, discriminant};

use articulated_core::Scalar;
use articulated_core::actuator::{ActuatorLaw, Actuators, Filter, Transmission};
use articulated_core::algorithm::{Argument, Dim};
use articulated_core::index::{BodyId, FrameId};
use articulated_core::model::Model;

use super::branches::{Limbs, isomorphic_branches};
use crate::graph::{MOST, Value};
use crate::model_pass::View;
use crate::sym::Sym;

/// The isomorphic branches of a robot, one per lane.
pub(crate) struct IsomorphicLimbs {
    pub(crate) width: usize,
    limbs: Vec<Limbs>,
    q: Indices,
    v: Indices,
    frames: Indices,
    controls: Indices,
    activations: Indices,
    actuators: Drives,
}

/// The parts of the actuators that correspond, one per lane, by their places in the lists of
/// [`Actuators`]. Those of several joints, of sites and of followers are outside limbs.
#[derive(Default)]
struct Drives {
    laws: Vec<Vec<usize>>,
    bounds: Vec<Vec<usize>>,
    passive: Vec<Vec<usize>>,
}

/// For each index of a vector that belongs to a limb, the corresponding indices, one per lane.
type Indices = HashMap<usize, Vec<usize>>;

impl IsomorphicLimbs {
    /// The branches for this number of lanes; `None` if there are none.
    pub(crate) fn of(model: &Model<f64>, width: usize) -> Option<Self> {
        let limbs = isomorphic_branches(model, width);
        if limbs.is_empty() {
            return None;
        }
        let empty = Indices::new;
        let mut alike = Self {
            width,
            limbs,
            q: empty(),
            v: empty(),
            frames: empty(),
            controls: empty(),
            activations: empty(),
            actuators: Drives::default(),
        };
        for bodies in alike.bodies() {
            let first = &model.bodies()[bodies[0]].joint;
            let start = |at: fn(&Model<f64>, BodyId) -> usize| bodies.iter().map(|&i| at(model, i)).collect::<Vec<_>>();
            align(&mut alike.q, &start(|m, i| m.bodies()[i].coordinates.q), first.nq());
            align(&mut alike.v, &start(|m, i| m.bodies()[i].coordinates.v), first.nv());
            let frames = frames_of(model, &bodies);
            for k in 0..frames[0].len() {
                align(&mut alike.frames, &frames.iter().map(|f| f[k].0).collect::<Vec<_>>(), 1);
            }
        }
        alike.align_actuators(model.actuators());
        Some(alike)
    }

    /// Finds the actuators that correspond: as many on each of the corresponding joints.
    fn align_actuators(&mut self, all: &Actuators<f64>) {
        let sets: BTreeSet<&Vec<usize>> = self.v.values().collect();
        for freedoms in sets {
            let of = |laws: &[ActuatorLaw<f64>]| alike(freedoms, |v| places(laws, |law| drives_only(law, v)), |k| Shape::of(&laws[k]));
            self.actuators.laws.extend(of(&all.laws));
            self.actuators.passive.extend(of(&all.passive));
            self.actuators.bounds.extend(alike(freedoms, |v| places(&all.bounds, |(k, _)| *k == v), |_| ()));
        }
        let activation = |k: usize| all.laws[..k].iter().filter(|law| law.activation.is_some()).count();
        for laws in &self.actuators.laws {
            align(&mut self.controls, laws, 1);
            if all.laws[laws[0]].activation.is_some() {
                align(&mut self.activations, &laws.iter().map(|&k| activation(k)).collect::<Vec<_>>(), 1);
            }
        }
    }

    /// The corresponding bodies.
    fn bodies(&self) -> Vec<Vec<BodyId>> {
        self.limbs.iter().flat_map(|l| (0..l.bodies).map(|k| l.aligned(k))).collect()
    }

    /// The indices that correspond to index `k` of an argument, and its lane; `None` outside limbs.
    pub(crate) fn lanes(&self, argument: Argument, k: usize) -> Option<(Vec<usize>, usize)> {
        let (indices, width) = match argument.dims() {
            [Dim::Nq] => (&self.q, 1),
            [Dim::Nq, Dim::Of(width)] => (&self.q, *width),
            [Dim::Nv] => (&self.v, 1),
            [Dim::Controls] => (&self.controls, 1),
            [Dim::Activations] => (&self.activations, 1),
            [Dim::Frames, Dim::Of(width)] => (&self.frames, *width),
            _ => return None,
        };
        let together = indices.get(&(k / width))?;
        let lane = together.iter().position(|i| *i == k / width)?;
        Some((together.iter().map(|i| i * width + k % width).collect(), lane))
    }

    /// The view with a symbol for each constant that differs from limb to limb.
    pub(crate) fn symbolic(&self, view: &View<f64>, constants: &mut Constants) -> View<Sym> {
        let model = &view.model;
        let View { model: symbolic, mut formulation } = view.cast::<Sym>();
        let symbolic = symbolic.changed(|parts| {
            for bodies in self.bodies() {
                let numbers: Vec<Vec<f64>> = bodies.iter().map(|&i| recorded(|f| drop(view.map_body(i, f)))).collect();
                for (lane, &i) in bodies.iter().enumerate() {
                    let symbols = constants.symbols(&numbers, lane);
                    view.map_body(i, |_| next(&symbols)).put(i, parts, &mut formulation);
                }
                let frames = frames_of(model, &bodies);
                for k in 0..frames[0].len() {
                    let numbers: Vec<Vec<f64>> = frames.iter().map(|f| recorded(|g| drop(model.frames()[f[k]].map(g)))).collect();
                    for (lane, f) in frames.iter().enumerate() {
                        let symbols = constants.symbols(&numbers, lane);
                        parts.frames[f[k]] = model.frames()[f[k]].map(|_| next(&symbols));
                    }
                }
            }
            let (all, symbolic) = (model.actuators(), &mut parts.actuators);
            constants.put(&self.actuators.laws, &all.laws, &mut symbolic.laws, |law, f| law.map(f));
            constants.put(&self.actuators.passive, &all.passive, &mut symbolic.passive, |law, f| law.map(f));
            constants.put(&self.actuators.bounds, &all.bounds, &mut symbolic.bounds, |(k, range), f| (*k, range.map(f)));
        });
        View { model: symbolic, formulation }
    }
}

/// Properties that corresponding actuators share; numbers may differ.
#[derive(PartialEq, Eq)]
struct Shape {
    freedoms: usize,
    is_bent: bool,
    has_no_torque: bool,
    has_bounds: (bool, bool),
    has_terms: bool,
    activation: Option<(Discriminant<Filter<f64>>, bool, bool)>,
}

impl Shape {
    fn of(law: &ActuatorLaw<f64>) -> Self {
        let drive = &law.drives[0];
        let activation = law.activation.as_ref().map(|own| (discriminant(&own.filter), own.range.is_some(), own.is_early));
        Self {
            freedoms: drive.gear.len(),
            is_bent: drive.higher.is_some(),
            has_no_torque: drive.has_no_torque,
            has_bounds: (law.control_range.is_some(), law.force_range.is_some()),
            has_terms: law.terms.is_some(),
            activation,
        }
    }
}

/// Whether an actuator drives the joint with this first degree of freedom, and nothing else.
fn drives_only(law: &ActuatorLaw<f64>, v: usize) -> bool {
    law.frames.is_none() && matches!(&law.drives[..], [Transmission { v: own, .. }] if *own == v)
}

/// The places of the items of which `is` holds.
fn places<T>(items: &[T], is: impl Fn(&T) -> bool) -> Vec<usize> {
    (0..items.len()).filter(|&k| is(&items[k])).collect()
}

/// The first, second, … place of each degree of freedom, together; none if they are not as many,
/// or not of one shape.
fn alike<T: PartialEq>(freedoms: &[usize], places: impl Fn(usize) -> Vec<usize>, shape: impl Fn(usize) -> T) -> Vec<Vec<usize>> {
    let lanes: Vec<Vec<usize>> = freedoms.iter().map(|&v| places(v)).collect();
    let first: Vec<T> = lanes[0].iter().map(|&k| shape(k)).collect();
    let are_alike = lanes.iter().all(|lane| lane.len() == first.len() && lane.iter().zip(&first).all(|(&k, first)| shape(k) == *first));
    if are_alike { (0..first.len()).map(|k| lanes.iter().map(|lane| lane[k]).collect()).collect() } else { Vec::new() }
}

/// The frames of each of these bodies; empty if their numbers differ: then each frame is computed
/// by itself.
fn frames_of(model: &Model<f64>, bodies: &[BodyId]) -> Vec<Vec<FrameId>> {
    let of = |&body: &BodyId| model.frames().ids().filter(|&k| model.frames()[k].body == body).collect::<Vec<_>>();
    let frames: Vec<Vec<FrameId>> = bodies.iter().map(of).collect();
    let alike = frames.iter().all(|f| f.len() == frames[0].len());
    if alike { frames } else { vec![Vec::new(); bodies.len()] }
}

fn align(indices: &mut Indices, starts: &[usize], n: usize) {
    for k in 0..n {
        let together: Vec<usize> = starts.iter().map(|s| s + k).collect();
        together.iter().for_each(|&i| drop(indices.insert(i, together.clone())));
    }
}

/// The numbers that `map` passes to its function.
fn recorded(map: impl FnOnce(&dyn Fn(f64) -> f64)) -> Vec<f64> {
    let numbers = RefCell::new(Vec::new());
    map(&|x| {
        numbers.borrow_mut().push(x);
        x
    });
    numbers.into_inner()
}

fn next(symbols: &RefCell<std::vec::IntoIter<Sym>>) -> Sym {
    symbols.borrow_mut().next().unwrap_or_else(|| Sym::from_f64(f64::NAN))
}

/// The constants that differ from limb to limb, each set of numbers once.
#[derive(Debug, Default)]
pub(crate) struct Constants {
    /// Index of the argument that represents them while tracing.
    pub(crate) argument: usize,
    numbers: Vec<Value>,
    places: HashMap<[u64; MOST], usize>,
}

impl Constants {
    pub(crate) fn new(argument: usize) -> Self {
        Self { argument, ..Self::default() }
    }

    /// The numbers and the lane behind element `index` of the argument.
    pub(crate) fn behind(&self, index: usize) -> (Value, usize) {
        (self.numbers[index / MOST], index % MOST)
    }

    /// Puts symbols in the place of the constants of the items that correspond.
    fn put<T, U>(&mut self, sets: &[Vec<usize>], items: &[T], symbolic: &mut [U], map: impl Fn(&T, &dyn Fn(f64) -> Sym) -> U) {
        for set in sets {
            let numbers: Vec<Vec<f64>> = set.iter().map(|&k| recorded(|f| drop(map(&items[k], &|x| Sym::from_f64(f(x)))))).collect();
            for (lane, &k) in set.iter().enumerate() {
                let symbols = self.symbols(&numbers, lane);
                symbolic[k] = map(&items[k], &|_| next(&symbols));
            }
        }
    }

    /// Symbols for the numbers of one lane, `numbers[lane]` all of them.
    fn symbols(&mut self, numbers: &[Vec<f64>], lane: usize) -> RefCell<std::vec::IntoIter<Sym>> {
        let symbol =
            |k: usize| self.symbol(std::array::from_fn(|l| numbers[if l < numbers.len() { l } else { 0 }][k]), lane, numbers.len());
        RefCell::new((0..numbers[lane].len()).map(symbol).collect::<Vec<_>>().into_iter())
    }

    /// The same number in all lanes is a number; opposite sets are one set and its negative.
    fn symbol(&mut self, x: Value, lane: usize, width: usize) -> Sym {
        if x[..width].iter().all(|y| *y == x[0]) {
            return Sym::from_f64(x[0]);
        }
        if x[..width].iter().find(|y| **y != 0.0).is_some_and(|y| *y < 0.0) {
            return -self.symbol(x.map(|y| -y), lane, width);
        }
        let next = self.numbers.len();
        let place = *self.places.entry(x.map(|y| (y + 0.0).to_bits())).or_insert(next);
        if place == next {
            self.numbers.push(x);
        }
        Sym::input(self.argument, place * MOST + lane)
    }
}
