//! A seven-axis arm reaches for a place: model predictive path integral control (MPPI) on rollouts
//! of a generated step, all samples in vectors.
//!
//! ```text
//! u_k → u_k + Σ_i w_i ε_ik,    w_i ∝ exp(−(cost_i − least)/λ),    ε_ik: normal
//! ```
//!
//! Source: Williams, Aldrich & Theodorou, J. Guidance, Control, and Dynamics 40, 2017.
//!
//! ```text
//! cargo run --release -p articulated-examples --bin reach
//! ```

use std::time::Instant;

articulated::robot! {
    pub mod arm {
        urdf = "../models/urdf/panda_like.urdf",
        frames = ["hand_tcp"],
        effects = { damping = 2.0 },
        functions = [placements, gravity_torque, "roll = step_implicit_damping(h = 0.01) + placements"],
        batch = [f64],
    }
}

type Vector = [f64; arm::NV];

/// Samples, steps of each, and cycles of the controller, each of 10 ms.
const SAMPLES: usize = 256;
const STEPS: usize = 25;
const CYCLES: usize = 200;
/// Standard deviation of the torques, N·m, and the temperature λ.
const SPREAD: Vector = [12.0, 12.0, 10.0, 10.0, 3.0, 3.0, 2.0];
const LAMBDA: f64 = 0.02;
const TARGET: [f64; 3] = [0.45, 0.35, 0.4];

/// Numbers that look random (Marsaglia, J. Statistical Software 8, 2003).
struct Random(u64);

impl Random {
    fn uniform(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Nearly normal: the sum of twelve.
    fn normal(&mut self) -> f64 {
        (0..12).map(|_| self.uniform()).sum::<f64>() - 6.0
    }
}

fn distance(placements: &[[f64; 12]; arm::FRAMES]) -> f64 {
    (0..3).map(|k| (placements[0][9 + k] - TARGET[k]).powi(2)).sum::<f64>().sqrt()
}

/// The cost of each sample: distance of the hand and speed of the joints, in all steps.
fn costs(start: &(Vector, Vector), torques: &[Vec<Vector>]) -> Result<Vec<f64>, arm::batch_f64::LengthError> {
    let (mut q, mut v) = (vec![start.0; SAMPLES], vec![start.1; SAMPLES]);
    let (mut q_next, mut v_next) = (q.clone(), v.clone());
    let mut hands = vec![[[0.0; 12]; arm::FRAMES]; SAMPLES];
    let mut costs = vec![0.0; SAMPLES];
    for torques in torques {
        arm::batch_f64::roll(&q, &v, torques, &mut q_next, &mut v_next, &mut hands)?;
        for ((cost, hand), v) in costs.iter_mut().zip(&hands).zip(&v) {
            *cost += (distance(hand) + 2e-3 * v.iter().map(|v| v * v).sum::<f64>()) / STEPS as f64;
        }
        std::mem::swap(&mut q, &mut q_next);
        std::mem::swap(&mut v, &mut v_next);
    }
    Ok(costs)
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut state = ([0.0, -0.5, 0.0, -2.0, 0.0, 1.6, 0.0], [0.0; arm::NV]);
    let mut random = Random(0x9e37_79b9_7f4a_7c15);
    // Torques beyond those of gravity.
    let mut plan = vec![[0.0; arm::NV]; STEPS];
    let mut spent = 0.0;
    println!("time, s   distance, m   speed, rad/s");
    for cycle in 0..CYCLES {
        let hold = arm::gravity_torque(&state.0);
        let noise: Vec<Vec<Vector>> =
            (0..STEPS).map(|_| (0..SAMPLES).map(|_| std::array::from_fn(|k| SPREAD[k] * random.normal())).collect()).collect();
        let clock = Instant::now();
        let sampled = |k: usize| noise[k].iter().map(|e| std::array::from_fn(|i| hold[i] + plan[k][i] + e[i])).collect();
        let costs = costs(&state, &(0..STEPS).map(sampled).collect::<Vec<Vec<Vector>>>())?;
        let least = costs.iter().copied().fold(f64::INFINITY, f64::min);
        let weights: Vec<f64> = costs.iter().map(|cost| ((least - cost) / LAMBDA).exp()).collect();
        let sum: f64 = weights.iter().sum();
        for (u, noise) in plan.iter_mut().zip(&noise) {
            for (weight, e) in weights.iter().zip(noise) {
                u.iter_mut().zip(e).for_each(|(u, e)| *u += weight / sum * e);
            }
        }
        spent += clock.elapsed().as_secs_f64();
        if cycle % 25 == 0 {
            let speed = state.1.iter().map(|v| v * v).sum::<f64>().sqrt();
            println!("{:7.2} {:13.4} {speed:14.3}", cycle as f64 * 0.01, distance(&arm::placements(&state.0)));
        }
        let tau = std::array::from_fn(|k| (hold[k] + plan[0][k]).clamp(-arm::TAU_LIMIT[k], arm::TAU_LIMIT[k]));
        let next = arm::roll(&state.0, &state.1, &tau);
        state = (next.q_next, next.v_next);
        plan.rotate_left(1);
        plan[STEPS - 1] = [0.0; arm::NV];
    }
    println!("{SAMPLES} rollouts of {STEPS} steps: {:.2} ms a cycle", spent / CYCLES as f64 * 1e3);
    println!("distance after {:.0} s: {:.4} m", CYCLES as f64 * 0.01, distance(&arm::placements(&state.0)));
    Ok(())
}
