//! The reference itself: relations between its functions, in many digits. Each is computed by its
//! definition alone.

mod dynamics;
mod motion;
mod sums;

use articulated_core::Scalar;
use articulated_core::algorithm::textbook::Textbook;
use articulated_core::algorithm::{Argument, Needs, functions};
use articulated_core::spatial::Reference;
use articulated_reference::Big;
use articulated_test_support::case::{Case, State, cast};
use articulated_test_support::random::Random;
use articulated_test_support::random_tree::Flavour;
use num_traits::{One, Zero};

use crate::trees::for_each_tree;

/// Accuracy left by rounding: 96 digits, less the loss where matrices are nearly singular.
const EXACT: f64 = 1e-60;

/// A step for central differences, a power of two: their error is its square.
const STEP: f64 = 1.0 / (1_u128 << 66) as f64;

/// Accuracy left by differences.
const NEARLY: f64 = 1e-36;

const REFERENCES: [Reference; 3] = [Reference::Body, Reference::World, Reference::WorldAligned];

/// A robot in a state, in many digits; quaternions of a norm of one.
struct Scene {
    book: Textbook<Big>,
    arguments: Vec<(Argument, Vec<Big>)>,
    /// Lengths of q and v, number of frames.
    size: [usize; 3],
}

impl Scene {
    fn new(case: &Case, state: &State) -> Self {
        let mut arguments: Vec<(Argument, Vec<Big>)> = Argument::ALL.iter().map(|&a| (a, cast(state.argument(a)))).collect();
        for (name, x) in &mut arguments {
            if name.is_configuration() {
                normalise(case, x);
            }
        }
        let size = [case.model.nq(), case.model.nv(), case.model.frames().len()];
        Self { book: case.textbook(), arguments, size }
    }

    fn given(&self, argument: Argument) -> &[Big] {
        &self.arguments.iter().find(|(a, _)| *a == argument).expect("all are there").1
    }

    /// q, v, a, wrenches.
    fn motion(&self) -> [&[Big]; 4] {
        [Argument::Q, Argument::V, Argument::A, Argument::Wrenches].map(|a| self.given(a))
    }

    fn call(&self, name: &str, arguments: &[&[Big]]) -> Vec<Big> {
        call(&self.book, name, arguments)
    }

    /// q ⊕ h·direction.
    fn stepped(&self, h: f64, direction: &[Big]) -> Vec<Big> {
        self.book.integrate(self.given(Argument::Q), &times(h, direction))
    }

    /// d/dh of f(q ⊕ h·direction, h) at 0.
    fn slope(&self, direction: &[Big], f: impl Fn(&[Big], f64) -> Vec<Big>) -> Vec<Big> {
        let at = |h: f64| f(&self.stepped(h, direction), h);
        times(0.5 / STEP, &minus(&at(STEP), &at(-STEP)))
    }
}

fn call(book: &Textbook<Big>, name: &str, arguments: &[&[Big]]) -> Vec<Big> {
    book.call(name, arguments).unwrap_or_else(|| panic!("no {name}")).unwrap_or_else(|e| panic!("{name}: {e}"))
}

/// The name with its reference.
fn named(name: &str, reference: Reference) -> String {
    format!("{name}_{}", reference.name())
}

fn normalise(case: &Case, q: &mut [Big]) {
    for joint in case.model.joints() {
        let at = match joint.q.1 {
            4 => joint.q.0,
            7 => joint.q.0 + 3,
            _ => continue,
        };
        let norm = dot(&q[at..at + 4], &q[at..at + 4]).sqrt();
        q[at..at + 4].iter_mut().for_each(|c| *c = *c / norm);
    }
}

fn plus(a: &[Big], b: &[Big]) -> Vec<Big> {
    a.iter().zip(b).map(|(&a, &b)| a + b).collect()
}

fn minus(a: &[Big], b: &[Big]) -> Vec<Big> {
    a.iter().zip(b).map(|(&a, &b)| a - b).collect()
}

fn times(k: f64, a: &[Big]) -> Vec<Big> {
    a.iter().map(|&a| a * Big::from_f64(k)).collect()
}

fn dot(a: &[Big], b: &[Big]) -> Big {
    a.iter().zip(b).fold(Big::zero(), |sum, (&a, &b)| sum + a * b)
}

/// Matrix times vector; for zero columns, as many zeros as rows.
fn apply(matrix: &[Big], x: &[Big], rows: usize) -> Vec<Big> {
    (0..rows).map(|i| dot(&matrix[i * x.len()..][..x.len()], x)).collect()
}

fn transposed(matrix: &[Big], rows: usize, columns: usize) -> Vec<Big> {
    (0..rows * columns).map(|k| matrix[k % rows * columns + k / rows]).collect()
}

fn unit(n: usize, k: usize) -> Vec<Big> {
    (0..n).map(|i| if i == k { Big::one() } else { Big::zero() }).collect()
}

/// The same numbers, to `tolerance` of the largest of them or of one.
fn same(what: &str, found: &[Big], expected: &[Big], tolerance: f64) {
    assert_eq!(found.len(), expected.len(), "{what}");
    let largest = expected.iter().map(|e| e.to_f64().abs()).fold(1.0, f64::max);
    for (k, (&f, &e)) in found.iter().zip(expected).enumerate() {
        let error = (f - e).to_f64().abs();
        assert!(error <= tolerance * largest, "{what}, entry {k}: {} for {}, error {error:e}", f.to_f64(), e.to_f64());
    }
}

/// Also on trees where joints follow others by polynomials.
fn for_each_scene(count: u64, flavour: Flavour, law: impl Fn(&Case, &Scene)) {
    let law = |case: &Case, random: &mut Random| {
        let state = case.state(random);
        Big::scope(|| law(case, &Scene::new(case, &state)));
    };
    for_each_tree(count, flavour, law);
    for_each_tree(count, Flavour { bent: true, ..flavour }, law);
}

/// Small, since everything is tried.
const SMALL: Flavour = Flavour { links: 6, ..Flavour::ANY };

/// Small, with a mass matrix that can be inverted.
const REGULAR: Flavour = Flavour { links: 6, ..Flavour::REGULAR };

#[test]
fn every_function_of_the_table_is_answered() {
    for_each_scene(3, REGULAR, |case, scene| {
        for row in functions::<f64>().iter().filter(|f| f.needs != Needs::FreeFrames) {
            let given: Vec<&[Big]> = row.takes.iter().map(|&a| scene.given(a)).collect();
            assert_eq!(scene.call(row.name, &given).len(), row.len(case.model.shape()), "{}", row.name);
            assert!(scene.book.call(row.name, &given[1..]).is_some_and(|r| r.is_err()), "{}", row.name);
        }
        assert!(scene.book.call("no_such_function", &[]).is_none());
    });
}
