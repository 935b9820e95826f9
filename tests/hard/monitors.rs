//! Monitors detect what they are made for.

use articulated_core::algorithm::{FunctionId, Workspace};
use articulated_core::description::Base;
use articulated_core::monitor::{pivot_cancellation, placement_orthonormality, quaternion_norms, scaled_condition, wrench_growth};
use articulated_lab::stress::robots::{Shape, built, chain, rods};
use articulated_tests::case::Case;

/// A straight row of N alike rods at rest, level: the base's joint bears N weights, N² times the
/// moment of half a rod.
#[test]
fn wrenches_grow_with_the_number_of_bodies_and_moments_with_its_square() {
    let n = 10;
    let model = built(&chain(n, 1.0), Base::Fixed);
    let zero = vec![0.0; n];
    let growth = wrench_growth(&model, &mut Workspace::new(&model), [&zero, &zero, &zero]);
    for (k, (moment, force)) in growth.iter().enumerate() {
        let beyond = (n - k) as f64;
        assert!((force - beyond).abs() < 1e-12 && (moment - beyond * beyond).abs() < 1e-10, "{k}: {moment} {force}");
    }
}

#[test]
fn a_straight_chain_is_seen_by_the_matrix_and_not_by_the_placements() {
    let condition = |n: usize| {
        let model = built(&chain(n, 1.0), Base::Fixed);
        scaled_condition(&model, &mut Workspace::new(&model), &Shape::Straight.angles(n))
    };
    assert!(condition(20) > 20.0 * condition(5));
    let model = built(&chain(50, 1.0), Base::Fixed);
    let case = Case { model, ..Case::new("chain", chain(50, 1.0), Base::Fixed) };
    let places = case.call::<f64>(FunctionId::placements.name(), &[&Shape::ZigZag.angles(50)]);
    let mut off = vec![0.0; case.model.frames().len()];
    placement_orthonormality(&places, &mut off);
    assert!(off.iter().all(|x| *x <= 4.0 * 51.0 * f64::EPSILON / 2.0) && off.iter().any(|x| *x > 0.0), "{off:?}");
}

#[test]
fn a_lost_pivot_is_seen_and_the_matrix_is_called_singular() {
    let model = built(&rods(), Base::Fixed);
    let mut left = [0.0; 3];
    pivot_cancellation(&model, &mut Workspace::new(&model), &[0.3, 0.0, 0.0], &mut left);
    assert!(left[0] < 1e-15 && left[1] > 0.01 && left[2] > 0.01, "{left:?}");
    assert_eq!(scaled_condition(&model, &mut Workspace::new(&model), &[0.3, 0.0, 0.0]), f64::INFINITY);
}

#[test]
fn a_quaternion_that_is_not_of_norm_one_is_seen() {
    let model = Case::bundled(articulated_models::robot("quadruped").unwrap()).model;
    let mut q = vec![0.0; model.nq()];
    q[6] = 1.001;
    let found: Vec<(usize, f64)> = quaternion_norms(&model, &q).collect();
    assert_eq!(found.len(), 1);
    assert!(found[0].0 == 3 && (found[0].1 - 0.002_001).abs() < 1e-12);
    // Too few numbers are no quaternion.
    assert_eq!(quaternion_norms(&model, &q[..5]).count(), 0);
}
