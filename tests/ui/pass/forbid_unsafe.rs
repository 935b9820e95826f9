//! A crate that forbids `unsafe` requests code without it.
#![forbid(unsafe_code)]

articulated::robot! {
    mod arm {
        urdf = "urdf/three.urdf",
        forbid_unsafe = true,
    }
}

fn main() {
    let q = [0.1; arm::NQ];
    assert!(arm::inverse_dynamics(&q, &[0.0; arm::NV], &[0.0; arm::NV]).iter().all(|t| t.is_finite()));
}
