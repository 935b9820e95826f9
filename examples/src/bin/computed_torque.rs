//! Computed torque at 1 kHz on a seven-axis arm.
//!
//! τ = M(q)·(a_d + k_d ė + k_p e) + h(q, v): inverse dynamics at the acceleration that brings the
//! error e = q_d − q to zero. The plant is the same arm with a tool that the controller does not
//! know.
//!
//! ```text
//! cargo run --release -p articulated-examples --bin computed_torque
//! ```

use std::time::{Duration, Instant};

use articulated::simulate::{Settings, Simulation};
use articulated::{Base, Model, Payload};

articulated::robot! {
    /// The arm as the controller knows it.
    pub mod arm {
        urdf = "../models/urdf/panda_like.urdf",
        functions = [inverse_dynamics],
    }
}

const URDF: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../models/urdf/panda_like.urdf");
/// The controller's period, s.
const PERIOD: f64 = 1e-3;
/// Proportional gain, 1/s², and derivative gain, 1/s: a double pole at −50 1/s.
const GAINS: (f64, f64) = (2500.0, 100.0);

/// The reference at time t, s: q_d, its rate and its acceleration.
fn reference(t: f64) -> [[f64; arm::NV]; 3] {
    let each = |k: usize| (1.0 + 0.3 * k as f64, 0.4, arm::NEUTRAL[k] + if k == 3 { -1.5 } else { 0.0 });
    let of = |f: fn(f64, f64, f64, f64) -> f64| {
        std::array::from_fn(|k| {
            let (frequency, amplitude, center) = each(k);
            f(t, frequency, amplitude, center)
        })
    };
    [
        of(|t, w, a, center| center + a * (1.0 - (w * t).cos())),
        of(|t, w, a, _| a * w * (w * t).sin()),
        of(|t, w, a, _| a * w * w * (w * t).cos()),
    ]
}

/// One call of the controller.
fn controller(t: f64, q: &[f64; arm::NQ], v: &[f64; arm::NV]) -> [f64; arm::NV] {
    let [q_d, v_d, a_d] = reference(t);
    let (kp, kd) = GAINS;
    let a = std::array::from_fn(|k| a_d[k] + kd * (v_d[k] - v[k]) + kp * (q_d[k] - q[k]));
    arm::inverse_dynamics(q, v, &a)
}

/// The arm with a tool of this mass, kg, at its flange.
fn plant(mass: f64) -> Result<Model, Box<dyn std::error::Error>> {
    let mut robot = articulated::describe(URDF)?;
    robot.attach(&Payload { link: "hand_tcp".into(), mass, center_of_mass: [0.0, 0.0, 0.05], ..Payload::default() })?;
    Ok(Model::new(&robot, Base::Fixed)?)
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    println!("tool kg   largest error after 1 s, mrad   controller, ns");
    for mass in [0.0, 0.5, 2.0] {
        let robot = plant(mass)?;
        let mut simulation = Simulation::new(&robot, Settings { end: 4.0, ..Settings::default() })?;
        let [mut q, mut v, _] = reference(0.0);
        let (mut worst, mut spent, mut calls) = (0.0_f64, Duration::ZERO, 0_u32);
        while f64::from(calls) * PERIOD < 4.0 {
            let t = f64::from(calls) * PERIOD;
            let start = Instant::now();
            let tau = controller(t, &q, &v);
            spent += start.elapsed();
            calls += 1;
            // The plant moves for one period under these torques.
            simulation.set_span(t, t + PERIOD)?;
            let mut hold = |_: f64, _: &[f64], _: &[f64], out: &mut [f64]| out.copy_from_slice(&tau);
            let motion = simulation.run(&q, &v, &mut hold, &mut [])?;
            let last = motion.len() - 1;
            (q, v) = (motion.q_at(last).try_into()?, motion.v_at(last).try_into()?);
            if t > 1.0 {
                let error = reference(t + PERIOD)[0].iter().zip(&q).map(|(d, q)| (d - q).abs()).fold(0.0, f64::max);
                worst = worst.max(error);
            }
        }
        println!("{mass:7.1}   {:30.3}   {:14}", 1e3 * worst, spent.as_nanos() / u128::from(calls));
    }
    Ok(())
}
