//! Inverse dynamics of a million states, eight to a vector and on all cores.
//!
//! ```text
//! cargo run --release -p articulated-examples --bin batches
//! ```

use std::time::Instant;

articulated::robot! {
    /// A seven-axis arm.
    pub mod arm {
        urdf = "../models/urdf/panda_like.urdf",
        functions = [inverse_dynamics],
        batch = [f64],
    }
}

const STATES: usize = 1_000_000;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // Any states: a low-discrepancy sequence in ±1.
    let number = |i: usize, k: usize| (((i + 1) as f64 * (k + 2) as f64).sqrt().fract() - 0.5) * 2.0;
    let vectors = |of: usize| (0..STATES).map(|i| std::array::from_fn(|k| number(i, of + k))).collect::<Vec<[f64; arm::NV]>>();
    let (q, v, a) = (vectors(0), vectors(arm::NV), vectors(2 * arm::NV));
    let mut torques = vec![[0.0; arm::NV]; STATES];
    let per_state = |start: Instant| start.elapsed().as_secs_f64() * 1e9 / STATES as f64;

    let start = Instant::now();
    for i in 0..STATES {
        torques[i] = arm::inverse_dynamics(&q[i], &v[i], &a[i]);
    }
    println!("one call a state: {:6.1} ns a state", per_state(start));
    let single = torques.clone();

    let start = Instant::now();
    arm::batch_f64::inverse_dynamics(&q, &v, &a, &mut torques)?;
    println!("one call for all: {:6.1} ns a state", per_state(start));

    let start = Instant::now();
    let all = (&q[..], &v[..], &a[..], &mut torques[..]);
    articulated::in_threads(all, |(q, v, a, torques)| arm::batch_f64::inverse_dynamics(q, v, a, torques), |_| {})?;
    println!("on all cores:     {:6.1} ns a state", per_state(start));

    let differences = single.iter().flatten().zip(torques.iter().flatten()).map(|(x, y)| (x - y).abs());
    println!("largest difference: {:.1e} N·m", differences.fold(0.0, f64::max));
    Ok(())
}
