//! Base parameters: the inertial parameters that joint torques depend on, and their identifiability
//! from torques.
//!
//! The structure is that of Khalil & Dombre, *Modeling, Identification and Control of Robots*,
//! 2002, §9.4; the independent parameters are those of the numeric rank of torques at random states
//! (Gautier, *J. Robotic Systems* 8, 1991, 485–506).

use alloc::vec;
use alloc::vec::Vec;

use super::{Workspace, inverse_dynamics_with_wrenches, random_configuration};
use crate::Scalar;
use crate::effect::Effects;
use crate::index::BodyId;
use crate::joint::Joint;
use crate::model::Model;
use crate::spatial::SpatialInertia;

/// Identifiability of an inertial parameter from joint torques, given those before it in the list.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Identifiability {
    /// Its value is identifiable.
    Alone,
    /// Only a combination of it with parameters before it is.
    WithOthers,
    /// Not identifiable: no torque depends on it.
    Never,
}

/// A parameter about the origin of a body's frame, in axes of that frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BaseParameter {
    /// `m`, `h_x`, `I_xx` and so on, or `I_xx−I_yy`.
    pub name: &'static str,
    /// kg, kg·m or kg·m².
    pub value: f64,
    /// One unit of it in terms of m, h and I_xx, I_xy, I_xz, I_yy, I_yz, I_zz
    /// ([`SpatialInertia::parameters`]).
    pub direction: [f64; 10],
    /// Its identifiability from torques.
    pub identifiability: Identifiability,
}

/// The parameters of one body.
#[derive(Clone, Debug, PartialEq)]
pub struct BodyParameters {
    /// Index of the body in the model.
    pub body: BodyId,
    /// The parameters that regrouping leaves in it.
    pub parameters: Vec<BaseParameter>,
}

/// The base parameters of a model that is regrouped ([`crate::model::regroup`]), body by body from
/// the tips inward.
///
/// A universal or planar joint is several bodies. Regrouping leaves parameters in each of them,
/// which are then not all independent. Work grows as the cube of the number of bodies. A parameter
/// counts as dependent if less than 10⁻⁷ of its torques is independent of those before it.
pub fn base_parameters(model: &Model<f64>) -> Vec<BodyParameters> {
    let mut found = ranks(&torque_columns(model, |i| left_by_regrouping(model.bodies[i].joint))).into_iter();
    let body = |i: BodyId| {
        let ten = model.bodies[i].inertia.parameters();
        let one = |(name, direction, value): &Direction| BaseParameter {
            name,
            value: value.iter().zip(&ten).map(|(share, x)| share * x).sum(),
            direction: *direction,
            identifiability: found.next().unwrap_or(Identifiability::Never),
        };
        BodyParameters { body: i, parameters: left_by_regrouping(model.bodies[i].joint).iter().map(one).collect() }
    };
    model.inward().map(body).collect()
}

/// How many combinations of the ten parameters of each moving link joint torques determine: the
/// rank of [`super::torque_regressor`].
pub fn identifiable_parameters(model: &Model<f64>) -> usize {
    let ten_of_link = |i: BodyId| if model.bodies[i].link.is_some() { ALL } else { &[] };
    let found = ranks(&torque_columns(model, ten_of_link));
    found.iter().filter(|one| **one == Identifiability::Alone).count()
}

/// A name, one unit of it in terms of the ten, and its value in terms of the ten. A revolute body
/// has Σ_zz = 0, which ties I_xx and I_yy to I_zz.
type Direction = (&'static str, [f64; 10], [f64; 10]);

const fn unit(k: usize) -> [f64; 10] {
    let mut ten = [0.0; 10];
    ten[k] = 1.0;
    ten
}

const fn plain(name: &'static str, k: usize) -> Direction {
    (name, unit(k), unit(k))
}

const REVOLUTE: &[Direction] = &[
    plain("h_x", 1),
    plain("h_y", 2),
    ("I_xx−I_yy", [0.0, 0.0, 0.0, 0.0, 0.5, 0.0, 0.0, -0.5, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, -1.0, 0.0, 0.0]),
    plain("I_xy", 5),
    plain("I_xz", 6),
    plain("I_yz", 8),
    ("I_zz", [0.0, 0.0, 0.0, 0.0, 0.5, 0.0, 0.0, 0.5, 0.0, 1.0], unit(9)),
];

const ALL: &[Direction] = &[
    plain("m", 0),
    plain("h_x", 1),
    plain("h_y", 2),
    plain("h_z", 3),
    plain("I_xx", 4),
    plain("I_xy", 5),
    plain("I_xz", 6),
    plain("I_yy", 7),
    plain("I_yz", 8),
    plain("I_zz", 9),
];

/// The parameters that regrouping leaves in the body of a joint.
fn left_by_regrouping(joint: Joint) -> &'static [Direction] {
    match joint {
        Joint::Revolute => REVOLUTE,
        Joint::Prismatic => &ALL[..4],
        Joint::Spherical => &ALL[1..],
        Joint::Helical | Joint::Floating => ALL,
    }
}

/// For each of these parameters of each body, from the tips inward, the torques of one unit of it
/// alone, over a number of states: `[parameters][states · nv]`.
fn torque_columns(model: &Model<f64>, parameters: impl Fn(BodyId) -> &'static [Direction]) -> Vec<Vec<f64>> {
    let mut weightless = model.clone();
    // Forces of springs, drag and rotors do not depend on the parameters.
    weightless.bodies.iter_mut().for_each(|b| (b.inertia, b.effects) = (SpatialInertia::zero(), Effects::default()));
    let mut ws = Workspace::new(model);
    let states = states(model, &mut ws, number_of_states(model, &parameters));
    let mut columns = Vec::new();
    for i in model.inward() {
        for (_, direction, _) in parameters(i) {
            weightless.bodies[i].inertia = SpatialInertia::from_parameters(*direction);
            let mut column = vec![0.0; states.len() * model.nv];
            for ([q, v, a], tau) in states.iter().zip(column.chunks_exact_mut(model.nv.max(1))) {
                inverse_dynamics_with_wrenches(&weightless, &mut ws, q, v, a, &[], tau);
            }
            columns.push(column);
        }
        weightless.bodies[i].inertia = SpatialInertia::zero();
    }
    columns
}

/// Number of states that distinguishes the parameters of all bodies on one coordinate, which may
/// appear in its torque alone.
fn number_of_states(model: &Model<f64>, parameters: &impl Fn(BodyId) -> &'static [Direction]) -> usize {
    let mut on_coordinate = vec![0; model.nv];
    model.outward().for_each(|i| on_coordinate[model.bodies[i].coordinates.v] += parameters(i).len());
    let all: usize = on_coordinate.iter().sum();
    on_coordinate.into_iter().max().unwrap_or(0).max(2 * all / model.nv.max(1)) + 2
}

/// Bound of the rates and accelerations of states.
const RATE: f64 = 2.0;

/// States at random, always the same: configurations within limits, rates and accelerations in ±2.
fn states(model: &Model<f64>, ws: &mut Workspace<f64>, count: usize) -> Vec<[Vec<f64>; 3]> {
    let mut random = splitmix64(1);
    let mut uniform = |n: usize| -> Vec<f64> { (0..n).map(|_| random()).collect() };
    let mut one = || {
        let mut q = vec![0.0; model.nq];
        random_configuration(model, ws, &uniform(model.nq), &mut q);
        let mut rates = || uniform(model.nv).iter().map(|x| RATE * (2.0 * x - 1.0)).collect();
        [q, rates(), rates()]
    };
    (0..count).map(|_| one()).collect()
}

/// Numbers in [0, 1): Steele, Lea & Flood, "Fast splittable pseudorandom number generators", OOPSLA
/// 2014.
fn splitmix64(mut seed: u64) -> impl FnMut() -> f64 {
    move || {
        seed = seed.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = seed;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// A column is dependent if less than this part of it is independent of others.
const DEPENDENT: f64 = 1e-7;

/// Which columns are independent of those before them: modified Gram–Schmidt on columns of unit
/// length.
fn ranks(columns: &[Vec<f64>]) -> Vec<Identifiability> {
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let norm = |a: &[f64]| Scalar::sqrt(dot(a, a));
    let largest = columns.iter().map(|c| norm(c)).fold(0.0, f64::max);
    let mut basis: Vec<Vec<f64>> = Vec::new();
    let mut one = |column: &Vec<f64>| {
        let length = norm(column);
        if length <= f64::EPSILON * largest {
            return Identifiability::Never;
        }
        let mut rest: Vec<f64> = column.iter().map(|x| x / length).collect();
        for b in &basis {
            let along = dot(&rest, b);
            rest.iter_mut().zip(b).for_each(|(x, b)| *x -= along * b);
        }
        let left = norm(&rest);
        if left <= DEPENDENT {
            return Identifiability::WithOthers;
        }
        rest.iter_mut().for_each(|x| *x /= left);
        basis.push(rest);
        Identifiability::Alone
    };
    columns.iter().map(&mut one).collect()
}
