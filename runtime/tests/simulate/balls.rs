//! Motions on ball joints with springs and limits.

use std::f64::consts::PI;

use articulated::effect::{Applied, EffectId};
use articulated::simulate::{Event, IntegratorId, NoTorque, Simulation};
use articulated::spatial::Vector3;
use articulated::spatial::screw::Quaternion;
use articulated::{Base, Model, load_bytes};

use crate::robots::{free, to};

/// A body of 2 kg on a ball joint, its centre `drop` below the joint; about the joint all its
/// moments of inertia are 0.25 kg·m² where that is 0.
fn ball(drop: f64, gravity: f64, effects: &[(EffectId, &[f64])]) -> Model<f64> {
    let text = format!(
        r#"<robot name="ball"><link name="root"/><joint name="b" type="spherical"><parent link="root"/><child link="u"/></joint>
        <link name="u"><inertial><mass value="2"/><origin xyz="0 0 -{drop}"/>
        <inertia ixx="0.25" ixy="0" ixz="0" iyy="0.25" iyz="0" izz="0.25"/></inertial></link></robot>"#
    );
    let on = |(effect, p): &(EffectId, &[f64])| Applied { effect: *effect, on: "b".into(), at: Default::default(), parameters: p.to_vec() };
    let effects: Vec<Applied> = effects.iter().map(on).collect();
    let model = load_bytes("ball", text.as_bytes(), Base::Fixed).unwrap_or_else(|e| panic!("{e}"));
    model.with_gravity([0.0, 0.0, gravity]).with_effects(&effects).unwrap_or_else(|e| panic!("{e}"))
}

fn turned(phi: Vector3<f64>) -> [f64; 4] {
    Quaternion::exp(phi).to_array()
}

/// Released at rest about any axis: φ = φ₀ cos(√(k/I) t).
#[test]
fn a_spring_on_a_ball_swings_about_a_fixed_axis() {
    let (rest, start) = (Vector3::new(0.4, 0.2, -0.9), Vector3::new(0.8, -0.5, 1.1));
    let spring = [&[9.0][..], &turned(rest)].concat();
    let model = ball(0.0, 0.0, &[(EffectId::spring, &spring)]);
    let q = Quaternion::exp(rest).product(&Quaternion::exp(start)).to_array();
    for (integrator, tolerance) in [(IntegratorId::dop853, 1e-13), (IntegratorId::rodas4, 1e-10)] {
        // √(k/I) = 6.
        let motion = free(&model, &to(integrator, 2.0, tolerance), &q, &[0.0; 3]).unwrap();
        let end = motion.q_at(motion.len() - 1).to_vec();
        let found = Quaternion::exp(rest).conjugate().product(&Quaternion::from_array(end.try_into().unwrap())).log();
        let far = (found - start * 12.0_f64.cos()).norm();
        println!("{integrator:?}: {far:e}");
        assert!(far < 2e4 * tolerance, "{integrator:?}: {far:e}");
    }
}

#[test]
fn a_ball_pendulum_with_a_spring_and_a_limit_keeps_its_energy() {
    let effects: [(EffectId, &[f64]); 2] = [(EffectId::spring, &[3.0, 0.1, 0.2, -0.3, 0.9]), (EffectId::limit, &[1.0, 200.0, 0.0])];
    let model = ball(0.3, -9.81, &effects);
    let q = turned(Vector3::new(0.9, 0.2, -0.3));
    for (integrator, tolerance, allowed) in [(IntegratorId::dop853, 1e-12, 1e-9), (IntegratorId::rodas4, 1e-9, 1e-6)] {
        let motion = free(&model, &to(integrator, 10.0, tolerance), &q, &[2.0, -3.0, 1.5]).unwrap();
        let lost = motion.imbalance(motion.len() - 1).unwrap();
        println!("{integrator:?}: {lost:e} J in {} steps", motion.counts.steps);
        assert!(lost.abs() < allowed, "{integrator:?}: {lost:e} J");
    }
}

/// Damping of a stop takes energy, and the balance includes it.
#[test]
fn what_a_damped_limit_takes_is_in_the_balance() {
    let model = ball(0.3, -9.81, &[(EffectId::limit, &[0.5, 200.0, 0.4])]);
    let motion = free(&model, &to(IntegratorId::dop853, 3.0, 1e-12), &turned(Vector3::new(0.3, 0.1, 0.0)), &[4.0, -1.0, 2.0]).unwrap();
    let last = motion.len() - 1;
    let lost = motion.imbalance(last).unwrap();
    println!("{lost:e} J");
    assert!(lost.abs() < 1e-8, "{lost:e} J");
}

/// It comes to the bound at u/ω, is in the stop for half a period, π √(I/k), and comes back as
/// fast.
#[test]
fn a_limit_on_a_ball_throws_it_back() {
    let (upper, rate) = (0.7, 2.0);
    let model = ball(0.0, 0.0, &[(EffectId::limit, &[upper, 400.0, 0.0])]);
    let axis = Vector3::new(0.6, 0.0, -0.8);
    let v: [f64; 3] = (axis * rate).into();
    let (there, back) = (upper / rate, upper / rate + PI * (0.25_f64 / 400.0).sqrt());
    let settings = to(IntegratorId::dop853, 1.0, 1e-12);
    let mut events = [Event::cone("cone", 0, upper)];
    let mut simulation = Simulation::new(&model, settings).unwrap();
    let motion = simulation.run(&[0.0, 0.0, 0.0, 1.0], &v, &mut NoTorque, &mut events).unwrap();
    assert!((motion.events[0].t - there).abs() < 1e-9 && motion.events.len() == 1, "{:?}", motion.events);
    let (q, found) = (motion.q_at(motion.len() - 1), motion.v_at(motion.len() - 1));
    let phi = Quaternion::from_array(q.try_into().unwrap()).log();
    let expected = axis * (upper - rate * (1.0 - back));
    assert!((phi - expected).norm() < 1e-8 && (Vector3::from_row_slice(found) + axis * rate).norm() < 1e-7, "{phi} {expected} {found:?}");
}
