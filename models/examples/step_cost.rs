//! Cost of a simulation step compared with a loop written by hand over the same generated
//! functions.
//!
//! ```text
//! CARGO_PROFILE_RELEASE_LTO=false cargo run --release --target-dir target/user \
//!     -p articulated-models --example step_cost
//! ```
//!
//! The variable builds it as a crate of a user is built: the profile of this repository has
//! `lto = "off"`.
//!
//! Each row times four loops in turn, over the same robot, control and steps: `by hand` calls the
//! generated functions directly, `step` is [`Simulation::step`], `run` is [`Simulation::run_into`]
//! that records its ends, and `with energies` is the same with [`Simulation::with_energy_balance`].
//! Figures are medians over rounds, in ns a step. The last line is the cost of subnormal numbers in
//! a function of one state.

use std::hint::black_box;
use std::time::Instant;

use articulated::Dynamics;
use articulated::simulate::{Control, IntegratorId, Output, Settings, Simulation, Stiffness};

articulated::robot! {
    /// A seven-axis arm.
    pub mod arm {
        urdf = "urdf/panda_like.urdf",
        functions = [forward_dynamics],
    }
}

articulated::robot! {
    /// A floating quadruped in the air.
    pub mod flying {
        urdf = "urdf/quadruped.urdf",
        base = floating,
        functions = [forward_dynamics, integrate],
    }
}

articulated::robot! {
    /// A floating quadruped on the ground: springs and dampers in its joints, contact at four feet.
    pub mod standing {
        urdf = "urdf/quadruped.urdf",
        scene = "scenes/quadruped_drop.toml",
        functions = [forward_dynamics, integrate, kinetic_energy, potential_energy, dissipation],
    }
}

const STEP: f64 = 2e-5;
const STEPS: usize = 1000;
const ROUNDS: usize = 41;

/// A light damper on every joint: a control of negligible cost.
struct Damper;

impl Control for Damper {
    fn torques(&mut self, _: f64, _: &[f64], v: &[f64], tau: &mut [f64]) {
        damp(v, tau);
    }
}

fn damp(v: &[f64], tau: &mut [f64]) {
    tau.iter_mut().zip(v).for_each(|(tau, v)| *tau = -0.1 * v);
}

/// The two integrators, written by hand for one generated module.
macro_rules! by_hand {
    ($robot:ident, $flat:expr) => {
        |integrator: IntegratorId, q0: &[f64], v0: &[f64]| {
            use $robot::{NQ, NV};
            let place = |q: &[f64; NQ], u: &[f64; NV]| -> [f64; NQ] { $flat(q, u) };
            let (mut q, mut v): ([f64; NQ], [f64; NV]) = (q0.try_into().unwrap(), v0.try_into().unwrap());
            let acceleration = |q: &[f64; NQ], v: &[f64; NV]| {
                let mut tau = [0.0; NV];
                damp(v, &mut tau);
                $robot::forward_dynamics(q, v, &tau)
            };
            let add = |x: &[f64; NV], by: f64, y: &[f64; NV]| -> [f64; NV] { std::array::from_fn(|i| x[i] + by * y[i]) };
            for _ in 0..STEPS {
                if integrator == IntegratorId::semi_implicit_euler {
                    v = add(&v, STEP, &acceleration(&q, &v));
                    q = place(&q, &v.map(|v| STEP * v));
                } else {
                    // The classical Runge-Kutta method; u̇ = v to first order in u, which is less
                    // work than the exact chart of the library.
                    let (v1, a1) = (v, acceleration(&q, &v));
                    let v2 = add(&v, 0.5 * STEP, &a1);
                    let a2 = acceleration(&place(&q, &v1.map(|v| 0.5 * STEP * v)), &v2);
                    let v3 = add(&v, 0.5 * STEP, &a2);
                    let a3 = acceleration(&place(&q, &v2.map(|v| 0.5 * STEP * v)), &v3);
                    let v4 = add(&v, STEP, &a3);
                    let a4 = acceleration(&place(&q, &v3.map(|v| STEP * v)), &v4);
                    let mean = |a: &[f64; NV], b: &[f64; NV], c: &[f64; NV], d: &[f64; NV]| -> [f64; NV] {
                        std::array::from_fn(|i| (a[i] + 2.0 * (b[i] + c[i]) + d[i]) * STEP / 6.0)
                    };
                    q = place(&q, &mean(&v1, &v2, &v3, &v4));
                    v = add(&v, 1.0, &mean(&a1, &a2, &a3, &a4));
                }
            }
            black_box((&q, &v));
        }
    };
}

/// Time of `work` divided by the number of steps, ns.
fn time(mut work: impl FnMut()) -> f64 {
    let clock = Instant::now();
    work();
    clock.elapsed().as_secs_f64() * 1e9 / STEPS as f64
}

fn median(mut times: Vec<f64>) -> f64 {
    times.sort_unstable_by(f64::total_cmp);
    times[times.len() / 2]
}

/// One row of the table.
fn row<R: Dynamics<f64>>(name: &str, robot: &R, integrator: IntegratorId, q: &[f64], hand: impl Fn(IntegratorId, &[f64], &[f64])) {
    let v = vec![0.1; robot.shape().nv];
    let end = STEP * STEPS as f64;
    let settings =
        Settings { integrator, end, step: Some(STEP), output: Output::Ends, stiffness: Stiffness::Ignore, ..Settings::default() };
    let checked = Settings { stiffness: Stiffness::Refuse, ..settings.clone() };
    let new = |settings: &Settings| Simulation::new(robot, settings.clone()).expect("the settings fit the robot");
    let (mut stepped, mut run, mut looking, mut energies) =
        (new(&settings), new(&settings), new(&checked), new(&checked).with_energy_balance());
    let mut recording = run.recording();
    let mut times: [Vec<f64>; 5] = Default::default();
    for _ in 0..ROUNDS {
        times[0].push(time(|| hand(integrator, q, &v)));
        times[1].push(time(|| {
            stepped.start(q, &v).expect("the state fits the robot");
            while stepped.step(&mut Damper).expect("the motion is plain") {}
        }));
        for (simulation, times) in [&mut run, &mut looking, &mut energies].into_iter().zip(&mut times[2..]) {
            times.push(time(|| {
                simulation.run_into(q, &v, &mut Damper, &mut [], &mut recording, &mut |_, _| true).expect("the motion is plain");
            }));
        }
    }
    let [hand, step, run, looking, energies] = times.map(median);
    println!(
        "{name:<28} {:<20} {hand:>8.0} {step:>8.0} {run:>8.0} {looking:>8.0} {energies:>10.0} {:>10.2}",
        integrator.to_string(),
        step / hand
    );
}

fn main() {
    println!("ns a step of {STEP} s; medians over {ROUNDS} rounds of {STEPS} steps");
    println!(
        "{:<28} {:<20} {:>8} {:>8} {:>8} {:>8} {:>10} {:>10}",
        "robot", "integrator", "by hand", "step", "run", "+ stable", "+ energies", "step/hand"
    );
    let plain = |q: &[f64; arm::NQ], u: &[f64; arm::NV]| -> [f64; arm::NQ] { std::array::from_fn(|i| q[i] + u[i]) };
    let mut q = [0.3; flying::NQ];
    q[2] = 0.78;
    q[3..7].copy_from_slice(&[0.0, 0.0, 0.0, 1.0]);
    for integrator in [IntegratorId::semi_implicit_euler, IntegratorId::rk4] {
        row("arm, 7 joints", &arm::Robot, integrator, &[0.3; arm::NQ], by_hand!(arm, plain));
        row("quadruped in the air", &flying::Robot, integrator, &q, by_hand!(flying, flying::integrate));
        row("quadruped with contact", &standing::Robot, integrator, &q, by_hand!(standing, standing::integrate));
    }
    println!("forward dynamics of the arm, ns a call: rates of 0.1: {:.0}, of 1e-160: {:.0}", call_cost(0.1), call_cost(1e-160));
}

/// ns a call of the arm's forward dynamics at these rates, rad/s: products of two rates below
/// 1e-154 are subnormal. The least of the rounds.
fn call_cost(rate: f64) -> f64 {
    let round = |_| {
        let start = Instant::now();
        for _ in 0..STEPS {
            black_box(arm::forward_dynamics(black_box(&[0.3; arm::NQ]), black_box(&[rate; arm::NV]), &[0.0; arm::NV]));
        }
        start.elapsed().as_nanos() as f64 / STEPS as f64
    };
    (0..ROUNDS).map(round).fold(f64::INFINITY, f64::min)
}
