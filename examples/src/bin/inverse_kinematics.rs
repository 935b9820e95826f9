//! Inverse kinematics as a generated iteration: one call, and a million places in vectors, each of
//! which takes the turns that it needs.
//!
//! ```text
//! cargo run --release -p articulated-examples --bin inverse_kinematics
//! ```

use std::time::Instant;

#[allow(dead_code, unreachable_pub)] // What a module of a robot has, and this program does not use.
mod arm {
    include!(concat!(env!("OUT_DIR"), "/reach.rs"));
}

const PLACES: usize = 100_000;

/// Where the hand is, m.
fn hand(q: &[f64; arm::NQ]) -> [f64; 3] {
    let [pose] = arm::placements(q);
    [pose[9], pose[10], pose[11]]
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let start = [0.3, -0.5, 0.2, -1.8, 0.1, 1.4, 0.7];
    let home = hand(&start);
    // Places in a cube of 0.4 m around the hand: a low-discrepancy sequence.
    let number = |i: usize, k: usize| ((i + 1) as f64 * [0.819_172_5, 0.671_043_6, 0.549_700_5][k]).fract() - 0.5;
    let places: Vec<[f64; 3]> = (0..PLACES).map(|i| std::array::from_fn(|k| home[k] + 0.4 * number(i, k))).collect();
    let per_place = |start: Instant| start.elapsed().as_secs_f64() * 1e6 / PLACES as f64;

    let clock = Instant::now();
    let one_by_one: Vec<arm::Reach> = places.iter().map(|place| arm::reach(&start, place)).collect();
    println!("one call a place: {:5.2} µs", per_place(clock));
    let reached = one_by_one.iter().filter(|answer| answer.missed == 0.0).count();
    let misses = one_by_one.iter().zip(&places).filter(|(answer, _)| answer.missed == 0.0).map(|(answer, place)| {
        let there = hand(&answer.found);
        (0..3).map(|k| (there[k] - place[k]).powi(2)).sum::<f64>().sqrt()
    });
    println!("{reached} of {PLACES} places reached, the farthest within {:.0e} m", misses.fold(0.0, f64::max));

    let (starts, mut found, mut missed) = (vec![start; PLACES], vec![start; PLACES], vec![0.0; PLACES]);
    let clock = Instant::now();
    arm::batch_f64::reach(&starts, &places, &mut found, &mut missed)?;
    println!("one call for all: {:5.2} µs a place", per_place(clock));
    let apart = one_by_one.iter().zip(&found).flat_map(|(a, b)| a.found.into_iter().zip(*b)).map(|(a, b)| (a - b).abs());
    println!("largest difference of coordinates: {:.0e} rad", apart.fold(0.0, f64::max));

    // ∂q/∂place: how the joints follow a place that moves. Its product with J is the unit matrix.
    let slope = arm::follow(&start, &places[0]);
    let step = 1e-5;
    let [near, far] = [-step, step].map(|step| hand(&std::array::from_fn(|j| one_by_one[0].found[j] + step * slope.jac_found_place[j][2])));
    println!("a place that moves by 1 along z moves the hand by {:.6}", (far[2] - near[2]) / (2.0 * step));
    Ok(())
}
