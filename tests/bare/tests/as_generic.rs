//! Results of a crate without `std`, against the generic library.

use articulated::{Base, Dynamics, Model};
use articulated_tests_bare::{arm, arm_of_pairs, arm_of_singles, walker};

fn model(robot: &str, base: Base) -> Model<f64> {
    articulated::load(format!("{}/../../models/urdf/{robot}.urdf", env!("CARGO_MANIFEST_DIR")), base).expect("a robot")
}

/// Largest difference, over the largest number of either.
fn distance(a: &[f64], b: &[f64]) -> f64 {
    let size = a.iter().chain(b).fold(0.0, |m: f64, x| m.max(x.abs()));
    a.iter().zip(b).fold(0.0, |m: f64, (x, y)| m.max((x - y).abs())) / size
}

/// Angles near and far, the last ones beyond the range of the polynomials; rates and accelerations.
fn states() -> [([f64; 6], [f64; 6], [f64; 6]); 3] {
    let of = |scale: f64, k: f64| core::array::from_fn(|i| scale * (i as f64 - 2.3 + k));
    [1.0, 1e3, 1e7].map(|scale| (of(scale, 0.0), of(0.7, 1.0), of(0.4, -1.5)))
}

#[test]
fn an_arm_in_all_its_numbers() {
    let model = model("ur5_like", Base::Fixed);
    let mut ws = model.workspace();
    for (q, v, a) in states() {
        let (mut tau, mut back) = ([0.0; 6], [0.0; 6]);
        model.inverse_dynamics(&mut ws, &q, &v, &a, &mut tau).unwrap();
        model.forward_dynamics(&mut ws, &q, &v, &tau, &mut back).unwrap();
        assert!(distance(&arm::inverse_dynamics(&q, &v, &a), &tau) < 1e-14);
        assert!(distance(&arm::forward_dynamics(&q, &v, &tau), &back) < 1e-12);
        assert!(distance(&arm_of_pairs::inverse_dynamics(&q, &v, &a), &tau) < 1e-14);
        let mut many = [[0.0; 6]; 9];
        arm::batch_f64::inverse_dynamics(&[q; 9], &[v; 9], &[a; 9], &mut many).unwrap();
        assert!(many.iter().all(|tau_of_many| distance(tau_of_many, &tau) < 1e-14));
        if q[0].abs() < 10.0 {
            let single = |x: [f64; 6]| x.map(|x| x as f32);
            let of_singles = arm_of_singles::inverse_dynamics(&single(q), &single(v), &single(a));
            assert!(distance(&of_singles.map(f64::from), &tau) < 1e-5);
        }
    }
}

#[test]
fn a_walker_and_its_way() {
    let model = model("quadruped", Base::Floating);
    let mut ws = model.workspace();
    let mut q = [0.0; walker::NQ];
    (q[3], q[6]) = (0.6, 0.8);
    let step: [f64; walker::NV] = core::array::from_fn(|i| 0.1 * (i as f64) - 0.6);
    let (mut next, mut tau) = ([0.0; walker::NQ], [0.0; walker::NV]);
    model.integrate(&mut ws, &q, &step, &mut next).unwrap();
    model.inverse_dynamics(&mut ws, &next, &step, &step, &mut tau).unwrap();
    assert!(distance(&walker::integrate(&q, &step), &next) < 1e-15);
    assert!(distance(&walker::difference(&q, &next), &step) < 1e-14);
    assert!(distance(&walker::inverse_dynamics(&next, &step, &step), &tau) < 1e-14);
}
