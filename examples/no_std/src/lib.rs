//! A controller for a processor without an operating system: no `std`, no heap, no `unsafe`.
//!
//! ```text
//! cargo test -p articulated-example-no-std
//! ```

#![no_std]
#![forbid(unsafe_code)]

/// The arm, written by `build.rs`.
pub mod arm {
    include!(concat!(env!("OUT_DIR"), "/arm.rs"));
}

/// Gains of a joint, N·m/rad and N·m·s/rad.
const GAINS: (f64, f64) = (40.0, 4.0);

/// Torques that hold the arm at `target`, rad: gravity compensation and a spring and damper in each
/// joint.
#[must_use]
pub fn hold(target: &[f64; arm::NQ], q: &[f64; arm::NQ], v: &[f64; arm::NV]) -> [f64; arm::NV] {
    let (stiffness, damping) = GAINS;
    let mut tau = arm::hold(q);
    for k in 0..arm::NV {
        tau[k] += stiffness * (target[k] - q[k]) - damping * v[k];
    }
    tau
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn at_the_target_only_gravity_is_held() {
        let q = [0.1, -1.0, 1.2, 0.3, -0.4, 0.0];
        let still = [0.0; arm::NV];
        assert_eq!(hold(&q, &q, &still), arm::hold(&q));
        // With sines and cosines from elsewhere, a table or a resolver, the processor computes
        // none.
        let sines = q.map(|angle| [libm::sin(angle), libm::cos(angle)]);
        let torques = arm::quick(&q, &still, &still, &sines);
        assert!(torques.iter().zip(arm::hold(&q)).all(|(a, b)| (a - b).abs() < 1e-12));
    }
}
