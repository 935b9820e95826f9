//! A robot under test, its states, and loops over many of them.

use articulated_core::algorithm::{Argument, Function, Shape, Workspace, function};
use articulated_core::description::{Base, Description};
use articulated_core::joint::Joint;
use articulated_core::model::{GRAVITY, Model};
use articulated_core::{Scalar, algorithm::textbook::Textbook};

use crate::random::Random;
use crate::random_tree::{Flavour, random_tree};
use crate::virtual_power::Motions;

/// A robot with its base and gravity.
#[derive(Clone, Debug)]
pub struct Case {
    /// Its name in messages.
    pub name: String,
    /// As the file has it.
    pub description: Description,
    /// Fixed or floating.
    pub base: Base,
    /// Gravity in the world frame, m/s².
    pub gravity: [f64; 3],
    /// The generic model, before model passes.
    pub model: Model<f64>,
}

/// One motion.
#[derive(Clone, Debug)]
pub struct State {
    /// `[nq]`.
    pub q: Vec<f64>,
    /// `[nv]`.
    pub v: Vec<f64>,
    /// `[nv]`.
    pub a: Vec<f64>,
    /// Torques, `[nv]`; independent of q, v and a.
    pub tau: Vec<f64>,
    /// Wrenches on the frames, `[frames][6]`.
    pub wrenches: Vec<f64>,
    /// A step from q, `[nv]`.
    pub step: Vec<f64>,
    /// Another configuration, `[nq]`.
    pub target: Vec<f64>,
    /// Numbers in 0 to 1, `[nq]`.
    pub uniform: Vec<f64>,
}

impl State {
    /// A motion, with torques of zero, no step, and wrenches for no frame.
    pub fn new(q: Vec<f64>, v: Vec<f64>, a: Vec<f64>) -> Self {
        let (zero, target, uniform) = (vec![0.0; v.len()], q.clone(), vec![0.5; q.len()]);
        Self { q, v, a, tau: zero.clone(), wrenches: vec![], step: zero, target, uniform }
    }

    /// Every argument as `value(argument, length)` gives it.
    pub fn of(shape: Shape, value: impl Fn(Argument, usize) -> Vec<f64>) -> Self {
        let of = |argument: Argument| value(argument, argument.len(shape));
        Self {
            q: of(Argument::Q),
            v: of(Argument::V),
            a: of(Argument::A),
            tau: of(Argument::Tau),
            wrenches: of(Argument::Wrenches),
            step: of(Argument::Step),
            target: of(Argument::Target),
            uniform: of(Argument::Uniform),
        }
    }

    /// The vector of an argument.
    pub fn argument(&self, argument: Argument) -> &[f64] {
        match argument {
            Argument::Q => &self.q,
            Argument::V => &self.v,
            Argument::A => &self.a,
            Argument::Tau => &self.tau,
            Argument::Wrenches => &self.wrenches,
            Argument::Step => &self.step,
            Argument::Target => &self.target,
            Argument::Uniform => &self.uniform,
            _ => &[],
        }
    }

    /// q, v, a in another scalar.
    pub fn cast<S: Scalar>(&self) -> [Vec<S>; 3] {
        [&self.q, &self.v, &self.a].map(|x| cast(x))
    }
}

/// Numbers in another scalar.
pub fn cast<S: Scalar>(x: &[f64]) -> Vec<S> {
    x.iter().map(|&c| S::from_f64(c)).collect()
}

impl Case {
    /// From a valid description, with standard gravity.
    pub fn new(name: impl Into<String>, description: Description, base: Base) -> Self {
        let model = Model::new(&description, base).expect("a tree of known joints");
        Self { name: name.into(), description, base, gravity: GRAVITY, model }
    }

    /// Under another gravity, m/s².
    #[must_use]
    pub fn with_gravity(mut self, gravity: [f64; 3]) -> Self {
        self.model = self.model.with_gravity(gravity);
        Self { gravity, ..self }
    }

    /// A bundled robot, with the base it is meant to have.
    pub fn bundled(robot: &articulated_models::Bundled) -> Self {
        Self::new(robot.name, read(robot.urdf), robot.base)
    }

    /// The textbook form in any scalar.
    pub fn textbook<S: Scalar>(&self) -> Textbook<S> {
        Textbook::new(&self.description, self.base, self.gravity).expect("it is a model")
    }

    /// The robot as placements in motion.
    pub fn motions(&self) -> Motions<'_> {
        Motions::new(&self.description, self.base, self.gravity)
    }

    /// A state at random: angles in ±π, lengths in ±1 m, rates and accelerations in ±2, torques and
    /// wrenches in ±20, steps in ±1.
    pub fn state(&self, random: &mut Random) -> State {
        let (nq, nv) = (self.model.nq(), self.model.nv());
        let (q, v, a) = (self.configuration(random), random.vector(nv, -2.0, 2.0), random.vector(nv, -2.0, 2.0));
        let tau = random.vector(nv, -20.0, 20.0);
        let wrenches = random.vector(6 * self.model.frames().len(), -20.0, 20.0);
        let (step, target) = (random.vector(nv, -1.0, 1.0), self.configuration(random));
        State { q, v, a, tau, wrenches, step, target, uniform: random.vector(nq, 0.0, 1.0) }
    }

    fn configuration(&self, random: &mut Random) -> Vec<f64> {
        let mut q = random.vector(self.model.nq(), -std::f64::consts::PI, std::f64::consts::PI);
        for body in self.model.bodies().iter().skip(1).filter(|b| b.coordinates.mimic.is_none()) {
            let at = body.coordinates.q;
            match body.joint {
                Joint::Revolute | Joint::Helical => {}
                Joint::Prismatic => q[at] /= std::f64::consts::PI,
                Joint::Spherical => q[at..at + 4].copy_from_slice(&random.unit::<4>()),
                Joint::Floating => q[at + 3..at + 7].copy_from_slice(&random.unit::<4>()),
            }
        }
        q
    }

    /// τ of the generic library.
    pub fn inverse_dynamics(&self, state: &State) -> Vec<f64> {
        inverse_dynamics(&self.model, &state.q, &state.v, &state.a)
    }

    /// A function of the registry on the generic library.
    pub fn call<S: Scalar>(&self, name: &str, arguments: &[&[S]]) -> Vec<S> {
        let model = self.model.cast::<S>();
        let row: &Function<S> = function(name).expect("a function of the registry");
        let mut out = vec![S::zero(); row.len(model.shape())];
        row.call(&model, &mut Workspace::new(&model), arguments, &mut out).expect("arguments of the right lengths");
        out
    }
}

/// τ of the generic library, for any model.
pub fn inverse_dynamics<S: Scalar>(model: &Model<S>, q: &[S], v: &[S], a: &[S]) -> Vec<S> {
    let mut tau = vec![S::zero(); model.nv()];
    articulated_core::algorithm::inverse_dynamics(model, &mut Workspace::new(model), q, v, a, &mut tau);
    tau
}

/// Placements of the generic library, for any model.
pub fn placements<S: Scalar>(model: &Model<S>, q: &[S]) -> Vec<S> {
    let mut out = vec![S::zero(); 12 * model.frames().len()];
    articulated_core::algorithm::placements(model, &mut Workspace::new(model), q, &mut out);
    out
}

/// The mass matrix, column by column from inverse dynamics without gravity and rates.
pub fn mass_matrix(model: &Model<f64>, q: &[f64]) -> nalgebra::DMatrix<f64> {
    let still = model.clone().with_gravity([0.0; 3]);
    let zero = vec![0.0; model.nv()];
    let column = |k: usize| nalgebra::DVector::from_vec(inverse_dynamics(&still, q, &zero, &crate::measure::unit(model.nv(), k)));
    let columns: Vec<_> = (0..model.nv()).map(column).collect();
    if columns.is_empty() { nalgebra::DMatrix::zeros(0, 0) } else { nalgebra::DMatrix::from_columns(&columns) }
}

/// The description in a URDF that is known to be right.
pub fn read(urdf: &str) -> Description {
    articulated_formats::read(urdf.as_bytes(), &articulated_formats::Options::default()).expect("a sound URDF").description
}

/// Names the tree when the test fails.
struct Announce<'a>(&'a str);

impl Drop for Announce<'_> {
    fn drop(&mut self) {
        if std::thread::panicking() {
            eprintln!("on {}", self.0);
        }
    }
}

/// Runs a law on trees at random, each on a fixed and on a floating base. If it fails, the seed is
/// printed.
pub fn for_each_tree(count: u64, flavour: Flavour, law: impl Fn(&Case, &mut Random)) {
    for seed in 0..count {
        for base in [Base::Fixed, Base::Floating] {
            let name = format!("random_tree({seed}, {flavour:?}), base {base:?}");
            let _announce = Announce(&name);
            law(&Case::new(name.clone(), random_tree(seed, flavour), base), &mut Random::new(seed));
        }
    }
}

/// Runs a law on all bundled robots.
pub fn for_each_bundled(law: impl Fn(&Case, &mut Random)) {
    for robot in articulated_models::ROBOTS {
        let _announce = Announce(robot.name);
        law(&Case::bundled(robot), &mut Random::new(1));
    }
}
