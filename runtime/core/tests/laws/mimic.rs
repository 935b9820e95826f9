//! Joints that follow others: q_full = G·q + c, so v_full = G·v and τ = Gᵀ·τ_full.

use articulated_core::description::Description;
use articulated_core::model::JointInfo;
use articulated_test_support::case::{Case, State, for_each_tree, inverse_dynamics, placements};
use articulated_test_support::measure::{distance, scale, torque_scale};
use articulated_test_support::random_tree::Flavour;

/// Errors allowed, in units of u times the magnitude of the terms.
const FEW: f64 = 16.0;

/// The joint at the end of the chain, with multiplier and offset of the whole.
fn leader(tree: &Description, joint: usize) -> (usize, f64, f64) {
    match &tree.joints[joint].mimic {
        None => (joint, 1.0, 0.0),
        Some(m) => {
            let (end, multiplier, offset) = leader(tree, m.joint);
            (end, m.multiplier * multiplier, m.multiplier * offset + m.offset)
        }
    }
}

/// For each joint of the free tree: its joint in the reduced one, multiplier and offset.
fn rows(reduced: &Case, free: &Case) -> Vec<(JointInfo, JointInfo, f64, f64)> {
    let find = |case: &Case, name: &str| case.model.joints().iter().find(|j| j.name == name).unwrap().clone();
    let row = |joint: &JointInfo| {
        let Some(index) = reduced.description.joint(&joint.name) else {
            return (joint.clone(), find(reduced, &joint.name), 1.0, 0.0);
        };
        let (end, multiplier, offset) = leader(&reduced.description, index);
        (joint.clone(), find(reduced, &reduced.description.joints[end].name), multiplier, offset)
    };
    free.model.joints().iter().map(row).collect()
}

#[test]
fn torque_on_a_leader_is_that_of_equal_power() {
    let mut met = std::cell::Cell::new(0);
    // Who follows a locked joint would be free without.
    for_each_tree(150, Flavour { locked: false, ..Flavour::ANY }, |case, random| {
        let mut tree = case.description.clone();
        tree.joints.iter_mut().for_each(|j| j.mimic = None);
        met.set(met.get() + usize::from(tree != case.description));
        let free = Case::new("", tree, case.base);
        let rows = rows(case, &free);
        let state = case.state(random);
        let (mut q, mut v, mut a) = (vec![], vec![], vec![]);
        for (own, lead, m, c) in &rows {
            q.extend((0..own.q.1).map(|k| m * state.q[lead.q.0 + k] + c));
            v.extend((0..own.v.1).map(|k| m * state.v[lead.v.0 + k]));
            a.extend((0..own.v.1).map(|k| m * state.a[lead.v.0 + k]));
        }
        // τ = Gᵀ τ_full
        let full = inverse_dynamics(&free.model, &q, &v, &a);
        let mut expected = vec![0.0; case.model.nv()];
        for (own, lead, m, _) in &rows {
            (0..own.v.1).for_each(|k| expected[lead.v.0 + k] += m * full[own.v.0 + k]);
        }
        let far = distance(&case.inverse_dynamics(&state), &expected, &torque_scale(case, &state));
        assert!(far <= FEW, "torques: {far} units of roundoff");
        let far = distance(&placements(&case.model, &state.q), &placements(&free.model, &q), &scale(case, "placements", &state));
        assert!(far <= FEW, "placements: {far} units of roundoff");
    });
    assert!(*met.get_mut() > 50, "only {} trees with followers", met.get());
}

/// Two joints of one axis that follow in opposite directions do not turn the tip.
#[test]
fn a_follower_that_turns_back_keeps_the_tip_level() {
    let robot = articulated_models::robot("double_pendulum").unwrap();
    let urdf = robot
        .urdf
        .replace("<child link=\"lower_rod\"/>", "<child link=\"lower_rod\"/><mimic joint=\"shoulder\" multiplier=\"-1\" offset=\"0\"/>");
    let case = Case::new("parallel", articulated_test_support::case::read(&urdf), robot.base);
    assert_eq!(case.model.nv(), 1);
    let state = State::new(vec![0.7], vec![1.1], vec![-0.4]);
    // The lower rod swings on a circle without turning: τ = (I1 + m1 l1²/4 + m2 l1²) a + (m1 l1/2 +
    // m2 l1) g sin q
    let expected = (0.083_433_333_333_3 + 0.25 + 0.5) * -0.4 + 9.81 * (0.5 + 0.5) * 0.7_f64.sin();
    assert!((case.inverse_dynamics(&state)[0] - expected).abs() < 1e-14);
    let placed = placements(&case.model, &state.q);
    assert!((placed[24] - 1.0).abs() < 1e-15 && placed[26].abs() < 1e-15);
}
