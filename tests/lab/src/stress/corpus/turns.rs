//! Angles, quaternions and placements of any size and in any number.

use std::f64::consts::PI;

use articulated_core::Scalar;
use articulated_core::algorithm::{FunctionId, Workspace, integrate};
use articulated_core::description::{Base, JointKind, LinkId, Origin};
use articulated_core::model::Model;
use articulated_core::monitor::{orthonormality, quaternion_norms};
use articulated_core::spatial::screw::{Quaternion, exp_rotation};
use articulated_core::spatial::{Matrix3, Placement, Vector3};
use articulated_reference::Big;

use super::Effort;
use crate::residual::worse;
use crate::states::SplitMix64;
use crate::stress::judge::{BACKWARD, Ends, Judge, State, call};
use crate::stress::robots::{Body, Builder, built, normalise, state, states};
use crate::stress::row::{Case, Row};

pub(super) const NAME: &str = "turns";

const U: f64 = f64::EPSILON / 2.0;

pub(super) fn rows(effort: Effort) -> Vec<Row> {
    let mut rows = large_angles();
    rows.extend(unnormalised());
    rows.extend(drift(effort));
    rows.extend(product(effort));
    rows.extend(far_away());
    rows
}

fn body() -> Option<Body> {
    Some(Body::of_radii(1.0, [0.1, -0.02, 0.05], [0.1, 0.12, 0.07]))
}

fn large_angles() -> Vec<Row> {
    let mut rows = Vec::new();
    let model =
        Builder::new("spinning").turn([0.0, 0.0, 1.0], [0.1, 0.0, 0.2], body()).turn([0.0, 1.0, 0.0], [0.3, 0.1, 0.0], body()).model();
    for exponent in [3, 5, 8, 15, 22] {
        let case = Case::new(NAME, format!("angles of 1e{exponent} rad"), "π has to be known to as many more digits as the angle has");
        let size = 10.0_f64.powi(exponent);
        let states = [state(vec![size, -0.7 * size], 2, 51, 1.0), state(vec![0.3 * size, 1.0], 2, 52, 1.0)];
        rows.extend(Judge::<f64>::new(&case, &model).all(&states, Ends::Solved, BACKWARD));
        if exponent <= 8 {
            rows.extend(Judge::<f32>::new(&case, &model).all(&states, Ends::Solved, BACKWARD));
        }
    }
    rows
}

fn free() -> Model<f64> {
    Builder::new("free")
        .link(None, JointKind::Floating, [0.0, 0.0, 1.0], Origin::default(), body())
        .turn([0.0, 1.0, 0.0], [0.3, 0.0, 0.0], body())
        .model()
}

/// The documented effect of quaternions with a norm other than one: the matrix has an error of
/// about 2ε, and a step normalises.
fn unnormalised() -> Vec<Row> {
    let case = Case::new(
        NAME,
        "quaternions of norm 1 + ε, ε = 1e-12 … 1e-3",
        "a rotation matrix made of one is none; functions take a norm of one for granted and say so",
    );
    let robot = free();
    let worst = [1e-12, 1e-9, 1e-6, 1e-3].map(|e| {
        let mut q = vec![0.1, 0.2, 0.3, 0.5, -0.1, 0.7, 0.4, 0.9];
        normalise(&mut q[3..7]);
        let unit = q.clone();
        q[3..7].iter_mut().for_each(|x| *x *= 1.0 + e);
        let place = |q: &Vec<f64>| call(FunctionId::placements, &robot, std::slice::from_ref(q));
        let off = place(&q).iter().zip(place(&unit)).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        let mut next = vec![0.0; robot.nq()];
        integrate(&robot, &mut Workspace::new(&robot), &q, &vec![0.0; robot.nv()], &mut next);
        let norm = quaternion_norms(&robot, &next).map(|(_, n)| n.abs()).fold(0.0, f64::max);
        let seen = quaternion_norms(&robot, &q).map(|(_, n)| (n - 2.0 * e).abs() / e).fold(0.0, f64::max);
        [off / e, norm / U, seen]
    });
    let most = |k: usize| worst.iter().map(|x| x[k]).fold(0.0, worse);
    vec![
        case.row("placements, error over ε", most(0), 4.0, "ε"),
        case.row("norm² − 1 after integrate", most(1), 4.0, "u"),
        case.row("quaternion_norms off from 2ε", most(2), 2e-3, "ε"),
    ]
}

/// Many small steps of one turn.
fn drift(effort: Effort) -> Vec<Row> {
    let steps: u32 = if effort == Effort::Full { 10_000_000 } else { 50_000 };
    let case = Case::new(NAME, format!("{steps} steps of 1e-3 rad"), "each step rounds, and what rounding does in one direction adds up");
    let robot = Builder::new("ball").link(None, JointKind::Spherical, [0.0, 0.0, 1.0], Origin::default(), body()).model();
    let mut ws = Workspace::new(&robot);
    let step = [0.48e-3, -0.6e-3, 0.64e-3];
    let (mut q, mut next) = (vec![0.0, 0.0, 0.0, 1.0], vec![0.0; 4]);
    let mut norm = 0.0_f64;
    for _ in 0..steps {
        integrate(&robot, &mut ws, &q, &step, &mut next);
        std::mem::swap(&mut q, &mut next);
        norm = norm.max((q.iter().map(|x| x * x).sum::<f64>() - 1.0).abs() / 2.0);
    }
    let angle = Big::scope(|| {
        // The same turn at once; q*⁻¹ q is the rest, and twice its vector the angle of it.
        let all = Vector3::from(step).map(|x| Big::from_f64(x) * Big::from_f64(f64::from(steps)));
        let rest = Quaternion::exp(all).conjugate().product(&Quaternion::from_array([q[0], q[1], q[2], q[3]].map(Big::from_f64)));
        2.0 * rest.vector.iter().map(|x| x.to_f64().powi(2)).sum::<f64>().sqrt()
    });
    vec![case.row("|norm − 1|, at most, f64", norm / U, 4.0, "u"), case.row("angle, f64", angle, 1e-10, "rad")]
}

/// 10 000 placements, one after the other.
fn product(effort: Effort) -> Vec<Row> {
    let n = if effort == Effort::Full { 10_000 } else { 2_000 };
    let case =
        Case::new(NAME, format!("a product of {n} placements"), "errors of each add up, and nothing makes the product a rotation again");
    let mut random = SplitMix64::new(55);
    let mut three = |most: f64| Vector3::from([(); 3].map(|()| random.uniform(-most, most)));
    let parts: Vec<Placement<f64>> = (0..n).map(|_| Placement { rotation: exp_rotation(three(PI)), position: three(0.1) }).collect();
    let found = parts.iter().fold(Placement::identity(), |x, p| x.compose(p));
    let (rotation, position) = Big::scope(|| {
        let precise = |p: &Placement<f64>| Placement { rotation: p.rotation.map(Big::from_f64), position: p.position.map(Big::from_f64) };
        let mut x = Placement::<Big>::identity();
        for p in &parts {
            x = x.compose(&precise(p));
        }
        let far = |e: &Matrix3<Big>, f: &Matrix3<f64>| e.iter().zip(f.iter()).map(|(e, f)| e.error_of(*f, U)).fold(0.0, worse);
        let position = x.position.iter().zip(found.position.iter()).map(|(e, f)| e.error_of(*f, U)).fold(0.0, worse);
        (far(&x.rotation, &found.rotation), position)
    });
    let n = n as f64;
    vec![
        case.row("RᵀR − 1 over 4Nu, f64", orthonormality(&found.rotation) / U / (4.0 * n), 1.0, ""),
        case.row("rotation over 4Nu, f64", rotation / (4.0 * n), 1.0, ""),
        case.row("position over 4Nu of the way, f64", position / (4.0 * n * 0.1 * n), 1.0, ""),
    ]
}

/// A floating base a thousand kilometres from the origin.
fn far_away() -> Vec<Row> {
    let case = Case::new(
        NAME,
        "a floating base 1e6 m from the origin",
        "what is computed about the origin loses six digits; joint torques have no business there",
    );
    let robot = {
        let arm = Builder::new("walker").turn([0.0, 1.0, 0.0], [0.3, 0.0, 0.0], body()).turn([0.0, 0.0, 1.0], [0.3, 0.1, 0.0], body());
        let mut description = arm.done();
        description.links[LinkId(0)].inertial = description.links[LinkId(1)].inertial;
        built(&description, Base::Floating)
    };
    let near: Vec<State> = states(&robot, 4, 56, 5.0);
    let far: Vec<State> = near.iter().map(moved).collect();
    let functions = [
        FunctionId::inverse_dynamics,
        FunctionId::mass_matrix,
        FunctionId::forward_dynamics,
        FunctionId::inverse_dynamics_derivatives,
        FunctionId::coriolis_matrix,
        FunctionId::kinetic_energy,
    ];
    let arguments = |f: FunctionId, s: &State| match f {
        FunctionId::mass_matrix => vec![s.q.clone()],
        FunctionId::coriolis_matrix | FunctionId::kinetic_energy => vec![s.q.clone(), s.v.clone()],
        FunctionId::forward_dynamics => vec![s.q.clone(), s.v.clone(), s.tau.clone()],
        _ => vec![s.q.clone(), s.v.clone(), s.a.clone()],
    };
    let change = |f: FunctionId| {
        let one = |(a, b): (&State, &State)| {
            let (x, y) = (call(f, &robot, &arguments(f, a)), call(f, &robot, &arguments(f, b)));
            let size = x.iter().map(|x| x.abs()).fold(0.0, f64::max);
            x.iter().zip(&y).map(|(x, y)| (x - y).abs() / (U * size)).fold(0.0, worse)
        };
        near.iter().zip(&far).map(one).fold(0.0, worse)
    };
    functions.into_iter().map(|f| case.row(format!("{}: change of the result, f64", f.name()), change(f), 8.0, "u")).collect()
}

fn moved(s: &State) -> State {
    let mut far = s.clone();
    far.q[..3].copy_from_slice(&[6e5, -8e5, 1e3]);
    far
}
