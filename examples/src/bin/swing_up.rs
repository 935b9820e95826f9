//! A cart swings its pole up: iterative LQR with exact A and B of a whole step.
//!
//! ```text
//! x' = f(x, u)    A = ∂f/∂x    B = ∂f/∂u        cost: Σ ½ w u² h + ½ xᵀ W x at the end
//! backward: Q_x = Aᵀ p, Q_u = w h u + Bᵀ p, Q_xx = Aᵀ P A, Q_ux = Bᵀ P A, Q_uu = w h + Bᵀ P B
//!           u → u + α k + K (x − x_old),  k = −Q_u/Q_uu,  K = −Q_ux/Q_uu
//! ```
//!
//! A and B are the Jacobian of the generated step of RK4, without differences of any kind. Source:
//! Tassa, Erez & Todorov, IEEE/RSJ IROS 2012.
//!
//! ```text
//! cargo run --release -p articulated-examples --bin swing_up
//! ```

use std::time::Instant;

use nalgebra::{Matrix4, RowVector4, Vector4};

articulated::robot! {
    /// Joints: `slide`, m, which is driven, and `pole`, rad, which is not. Upright is q = 0.
    pub mod cart {
        urdf = "../models/urdf/cart_pole.urdf",
        functions = ["step = step_rk4(h = 0.02)", "slope = jacobian(step_rk4(h = 0.02), q v tau)"],
    }
}

/// The length of a step, s, and the number of steps.
const STEP: f64 = 0.02;
const STEPS: usize = 100;
/// Weights of the force, and of the state at the end.
const OF_FORCE: f64 = 1e-3;
const AT_THE_END: Vector4<f64> = Vector4::new(200.0, 500.0, 20.0, 20.0);

type State = Vector4<f64>;

fn step(x: &State, force: f64) -> State {
    let cart::Step { q_next: q, v_next: v } = cart::step(&[x[0], x[1]], &[x[2], x[3]], &[force, 0.0]);
    Vector4::new(q[0], q[1], v[0], v[1])
}

fn linearized(x: &State, force: f64) -> (Matrix4<f64>, Vector4<f64>) {
    let slope = cart::slope(&[x[0], x[1]], &[x[2], x[3]], &[force, 0.0]);
    let blocks = [[slope.jac_q_next_q, slope.jac_q_next_v], [slope.jac_v_next_q, slope.jac_v_next_v]];
    let a = Matrix4::from_fn(|i, k| blocks[i / 2][k / 2][i % 2][k % 2]);
    let of_force = [slope.jac_q_next_tau, slope.jac_v_next_tau];
    (a, Vector4::from_fn(|i, _| of_force[i / 2][i % 2][cart::v_index::SLIDE]))
}

fn cost(states: &[State], forces: &[f64]) -> f64 {
    let end = states[STEPS];
    0.5 * OF_FORCE * STEP * forces.iter().map(|u| u * u).sum::<f64>() + 0.5 * end.component_mul(&AT_THE_END).dot(&end)
}

fn motion(start: State, mut force: impl FnMut(usize, &State) -> f64) -> (Vec<State>, Vec<f64>) {
    let (mut states, mut forces) = (vec![start], Vec::new());
    for k in 0..STEPS {
        let u = force(k, &states[k]);
        forces.push(u);
        states.push(step(&states[k], u));
    }
    (states, forces)
}

/// k and K of each step, and whether all Q_uu are positive.
fn backward(states: &[State], forces: &[f64], more: f64) -> Vec<(f64, RowVector4<f64>)> {
    let mut p = states[STEPS].component_mul(&AT_THE_END);
    let mut matrix = Matrix4::from_diagonal(&AT_THE_END);
    let mut gains = vec![(0.0, RowVector4::zeros()); STEPS];
    for k in (0..STEPS).rev() {
        let (a, b) = linearized(&states[k], forces[k]);
        let of_u = OF_FORCE * STEP * forces[k] + b.dot(&p);
        let of_uu = OF_FORCE * STEP + more + (b.transpose() * matrix * b)[0];
        let of_ux = b.transpose() * matrix * a;
        let (own, gain) = (-of_u / of_uu, -of_ux / of_uu);
        p = a.transpose() * p + of_ux.transpose() * own + gain.transpose() * (of_u + (of_uu - more) * own);
        matrix = a.transpose() * matrix * a + gain.transpose() * ((of_uu - more) * gain + of_ux) + of_ux.transpose() * gain;
        gains[k] = (own, gain);
    }
    gains
}

fn main() {
    // The pole hangs, and a small force moves the cart.
    let start = Vector4::new(0.0, std::f64::consts::PI, 0.0, 0.0);
    let (mut states, mut forces) = motion(start, |k, _| (k as f64 * 0.1).sin());
    let (mut more, mut spent, mut passes) = (1e-2, 0.0, 0);
    println!("iteration       cost   pole at the end, rad");
    for iteration in 0..200 {
        let before = cost(&states, &forces);
        if iteration % 20 == 0 {
            println!("{iteration:9} {before:10.4} {:12.6}", states[STEPS][1]);
        }
        let clock = Instant::now();
        let gains = backward(&states, &forces, more);
        (spent, passes) = (spent + clock.elapsed().as_secs_f64(), passes + 1);
        let tried = (0..10).map(|k| {
            let part = 0.5_f64.powi(k);
            motion(start, |k, x| forces[k] + part * gains[k].0 + (gains[k].1 * (x - states[k]))[0])
        });
        let Some((new_states, new_forces)) = tried.into_iter().find(|(states, forces)| cost(states, forces) < before) else {
            // No part of the step is better: a more cautious one.
            more *= 10.0;
            if more > 1e6 {
                break;
            }
            continue;
        };
        more = f64::max(more / 3.0, 1e-9);
        let gain = before - cost(&new_states, &new_forces);
        (states, forces) = (new_states, new_forces);
        if gain < 1e-10 * before {
            break;
        }
    }
    let largest = forces.iter().fold(0.0_f64, |most, u| most.max(u.abs()));
    println!("cost {:.4} with forces up to {largest:.1} N", cost(&states, &forces));
    println!("a backward pass of {STEPS} steps: {:.1} µs", spent / f64::from(passes) * 1e6);
    println!("distance from upright and rest after {:.0} s: {:.1e}", STEP * STEPS as f64, states[STEPS].norm());
}
