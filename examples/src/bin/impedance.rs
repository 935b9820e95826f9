//! A controller of one's own, generated whole, beside the same law written by hand on generated
//! functions.
//!
//! ```text
//! cargo run --release -p articulated-examples --bin impedance
//! ```

use std::hint::black_box;
use std::time::Instant;

#[path = "../laws/impedance.rs"]
mod impedance;

#[allow(dead_code, unreachable_pub)] // What a module of a robot has, and this program does not use.
mod arm {
    include!(concat!(env!("OUT_DIR"), "/arm.rs"));
}

type Place = [f64; 3];

/// The law on generated functions, which share no work.
fn by_hand(q: &[f64; arm::NQ], v: &[f64; arm::NV], target: &Place, gains: &[f64; 2]) -> [f64; arm::NV] {
    let ([pose], [twist]) = (arm::placements(q), arm::twists_world_aligned(q, v));
    let force: Place = std::array::from_fn(|k| gains[0] * (target[k] - pose[9 + k]) - gains[1] * twist[3 + k]);
    let pulled = |k: usize| -(0..3).map(|i| pose[3 * i + k] * force[i]).sum::<f64>();
    arm::static_torque(q, &[[0.0, 0.0, 0.0, pulled(0), pulled(1), pulled(2)]])
}

/// The median time of a call, ns, in rounds of a thousand.
fn time(mut call: impl FnMut() -> [f64; arm::NV]) -> f64 {
    let mut round = || {
        let start = Instant::now();
        for _ in 0..1000 {
            black_box(call());
        }
        start.elapsed().as_secs_f64() * 1e6
    };
    let mut rounds: Vec<f64> = (0..101).map(|_| round()).collect();
    rounds.sort_by(f64::total_cmp);
    rounds[50]
}

/// The number of instructions that a function's documentation gives.
fn instructions(function: &str) -> u32 {
    let source = include_str!(concat!(env!("OUT_DIR"), "/arm.rs"));
    let (before, _) = source.split_once(&format!("\npub fn {function}(")).expect("it is generated");
    let (_, counts) = before.rsplit_once(" in ").expect("its documentation has counts");
    counts.split(' ').next().and_then(|word| word.parse().ok()).expect("a number")
}

fn main() {
    let (q, v) = ([0.3, -0.5, 0.2, -1.8, 0.1, 1.4, 0.7], [0.1, -0.2, 0.3, 0.2, -0.1, 0.4, 0.5]);
    let (target, gains) = ([0.4, 0.1, 0.5], [800.0, 40.0]);
    let (whole, parts) = (arm::impedance(&q, &v, &target, &gains), by_hand(&q, &v, &target, &gains));
    let far = whole.iter().zip(&parts).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    println!("torque {whole:.2?} N·m, largest difference {far:.1e}");
    let own = instructions("impedance");
    let separate: u32 = ["placements", "twists_world_aligned", "static_torque"].into_iter().map(instructions).sum();
    println!("instructions: whole {own}, three functions {separate} and what is between them");
    let (one, other) = (time(|| arm::impedance(black_box(&q), &v, &target, &gains)), time(|| by_hand(black_box(&q), &v, &target, &gains)));
    println!("time of a call: whole {one:.1} ns, by hand {other:.1} ns");
    // ∂τ/∂q: how stiff the hand feels.
    println!("stiffness of the first joint {:.1} N·m/rad", -arm::stiffness(&q, &v, &target, &gains)[0][0]);
}
