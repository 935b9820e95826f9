//! A crate without the prelude, that has other things under the names that generated code needs.
#![no_implicit_prelude]
#![deny(warnings, missing_docs, unreachable_pub, unused, unused_results)]

mod core {}
mod std {}
mod articulated {}

::articulated::robot! {
    /// The arm.
    pub mod arm {
        urdf = "urdf/arm.urdf",
        base = floating,
        functions = [placements, inverse_dynamics, bias_forces, gravity_torque],
        batch = [f64],
    }
}

::articulated::robot! {
    mod alone {
        urdf = "urdf/arm.urdf",
        standalone = true,
    }
}

fn main() {
    use ::articulated::Dynamics;
    let mut frames = [0.0; 12 * arm::FRAMES];
    let mut q = [0.0; arm::NQ];
    q[6] = 1.0;
    ::std::assert!(arm::Robot.placements(&mut (), &q, &mut frames).is_ok());
    ::std::assert_eq!(frames[12..24], arm::placements(&q)[1]);
    let _ = alone::placements(&[0.0; alone::NQ]);
}
