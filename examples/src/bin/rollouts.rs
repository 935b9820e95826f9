//! Whole steps as generated code: many states in vectors, and the gradient of a motion.
//!
//! ```text
//! cargo run --release -p articulated-examples --bin rollouts
//! ```

use std::hint::black_box;
use std::time::Instant;

articulated::robot! {
    /// A seven-axis arm.
    pub mod arm {
        urdf = "../models/urdf/panda_like.urdf",
        functions = [
            gravity_torque,
            "step = step_semi_implicit_euler(h = 0.002)",
            "pull = vjp(step_semi_implicit_euler(h = 0.002), q v tau)",
        ],
        batch = [f64],
    }
}

type Vector = [f64; arm::NV];

const STEPS: usize = 250;
const STATES: usize = 2048;
const ROUNDS: u32 = 100;

/// The states before each step, and after the last.
fn motion(start: Vector, torques: &[Vector]) -> Vec<(Vector, Vector)> {
    let mut states = vec![(start, [0.0; arm::NV])];
    for tau in torques {
        let (q, v) = states[states.len() - 1];
        let arm::Step { q_next, v_next } = arm::step(&q, &v, tau);
        states.push((q_next, v_next));
    }
    states
}

/// ½|q − target|² + ½|v|² at the end, its gradient by all torques, and by the start.
fn slope(states: &[(Vector, Vector)], torques: &[Vector], target: &Vector) -> (f64, Vec<Vector>) {
    let (q, v) = states[STEPS];
    let mut by_q: Vector = std::array::from_fn(|k| q[k] - target[k]);
    let mut by_v = v;
    let cost = 0.5 * by_q.iter().chain(&by_v).map(|x| x * x).sum::<f64>();
    let mut by_tau = vec![[0.0; arm::NV]; STEPS];
    for k in (0..STEPS).rev() {
        let (q, v) = &states[k];
        let back = arm::pull(q, v, &torques[k], &by_q, &by_v);
        (by_q, by_v, by_tau[k]) = (back.grad_q, back.grad_v, back.grad_tau);
    }
    (cost, by_tau)
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // 2048 states by themselves and together; each has its own torques.
    let number = |i: usize, k: usize| (((i + 1) as f64 * (k + 2) as f64).sqrt().fract() - 0.5) * 2.0;
    let vectors = |of: usize| (0..STATES).map(|i| std::array::from_fn(|k| number(i, of + k))).collect::<Vec<Vector>>();
    let (starts, torques) = (vectors(0), vectors(arm::NV));
    let per_step = |start: Instant| start.elapsed().as_secs_f64() * 1e9 / (STATES * STEPS) as f64;

    let clock = Instant::now();
    let alone: Vec<Vector> = starts.iter().zip(&torques).map(|(q, tau)| motion(*q, &[*tau; STEPS])[STEPS].0).collect();
    println!("one state after the other: {:5.1} ns a step", per_step(clock));

    let (mut q, mut v) = (starts.clone(), vec![[0.0; arm::NV]; STATES]);
    let (mut q_next, mut v_next) = (q.clone(), v.clone());
    let clock = Instant::now();
    for _ in 0..STEPS {
        arm::batch_f64::step(&q, &v, &torques, &mut q_next, &mut v_next)?;
        std::mem::swap(&mut q, &mut q_next);
        std::mem::swap(&mut v, &mut v_next);
    }
    println!("all states in vectors:     {:5.1} ns a step", per_step(clock));
    let far = alone.iter().flatten().zip(q.iter().flatten()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    println!("largest difference: {far:.0e} rad");

    // How the distance to a target depends on each torque, beside a difference along all of them.
    let start = [0.3, -0.5, 0.2, -1.8, 0.1, 1.4, 0.7];
    let target = [0.8, 0.1, -0.3, -1.2, 0.4, 1.9, 0.2];
    let held = vec![arm::gravity_torque(&start); STEPS];
    let cost = |torques: &[Vector]| slope(&motion(start, torques), torques, &target);
    let clock = Instant::now();
    let mut by_tau = Vec::new();
    (0..ROUNDS).for_each(|_| by_tau = cost(&held).1);
    let gradient = clock.elapsed().as_secs_f64() / f64::from(ROUNDS);
    let clock = Instant::now();
    (0..ROUNDS).for_each(|_| drop(black_box(motion(black_box(start), &held))));
    let alone = clock.elapsed().as_secs_f64() / f64::from(ROUNDS);
    println!("a motion of {STEPS} steps {:.1} µs, with its gradient {:.1} µs", 1e6 * alone, 1e6 * gradient);
    let moved = |by: f64| -> Vec<Vector> { held.iter().zip(&torques).map(|(a, b)| std::array::from_fn(|k| a[k] + by * b[k])).collect() };
    let difference = (cost(&moved(1e-6)).0 - cost(&moved(-1e-6)).0) / 2e-6;
    let along: f64 = by_tau.iter().flatten().zip(torques.iter().flatten()).map(|(a, b)| a * b).sum();
    println!("along a direction: gradient {along:.6}, difference {difference:.6}");
    Ok(())
}
