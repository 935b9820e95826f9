//! Stiff effects: implicit steps decay without a change of sign; explicit ones refuse, and report
//! their admissible step.

use articulated::effect::{Applied, EffectId};
use articulated::simulate::{Hold, IntegratorId, NoTorque, Output, Pd, Settings, SimulateError, Simulation, Stiffness, integrators};
use articulated::{Base, Model, Origin};

use crate::robots::{apart, free, one_joint, stepping, to};

fn with(effect: EffectId, parameters: Vec<f64>) -> Model<f64> {
    let applied = Applied { effect, on: "joint".into(), at: Origin::default(), parameters };
    one_joint("prismatic", 0.0).with_gravity([0.0; 3]).with_effects(&[applied]).unwrap()
}

/// Every explicit integrator.
fn explicit() -> impl Iterator<Item = IntegratorId> {
    integrators().iter().filter(|row| !row.implicit).map(|row| row.id)
}

/// The longest step that is stable, times the rate, of a decay and of an oscillation.
fn longest(explicit: IntegratorId) -> [f64; 2] {
    match explicit {
        IntegratorId::semi_implicit_euler => [2.0, 2.0],
        IntegratorId::rk4 => [2.785, 2.828],
        IntegratorId::dopri5 => [3.307, 0.997],
        IntegratorId::dop853 => [6.394, 5.96],
        IntegratorId::rodas4 | IntegratorId::lie_midpoint => [f64::INFINITY; 2],
    }
}

#[test]
fn implicit_steps_of_any_length_decay_without_a_change_of_sign() {
    for power in -4..=24 {
        let z = 10_f64.powf(f64::from(power) / 4.0);
        let h = 0.01;
        let robot = with(EffectId::damping, vec![z / h]);
        let settings = Settings { output: Output::Steps, ..stepping(IntegratorId::rodas4, 0.4, h) };
        let motion = free(&robot, &settings, &[0.0], &[1.0]).unwrap();
        for i in 1..motion.len() {
            assert!(
                motion.v[i] >= 0.0 && motion.v[i] <= (-0.9 * z.min(1.0)).exp() * motion.v[i - 1],
                "h·d/I = {z}: {:?}",
                &motion.v[i - 1..=i]
            );
        }
        // It slides v_0·I/d in all.
        let way = motion.q.last().unwrap() * z / h;
        assert!((way - (1.0 - (-40.0 * z).exp())).abs() < 1e-3, "h·d/I = {z}: {way}");
    }
}

/// A damper brings a joint to rest without subnormal numbers, or numbers whose squares are, in any
/// method: many processors are slow with them.
#[test]
fn a_damper_brings_a_joint_to_rest_without_subnormal_numbers() {
    let robot = with(EffectId::damping, vec![50.0]);
    for integrator in integrators() {
        let settings = Settings { integrator: integrator.id, end: 20.0, step: Some(5e-3), output: Output::Steps, ..Settings::default() };
        let motion = Simulation::new(&robot, settings).unwrap().run(&[0.0], &[1.0], &mut NoTorque, &mut []).unwrap();
        let rates: Vec<f64> = (0..motion.len()).map(|i| motion.v_at(i)[0]).collect();
        assert!(rates.iter().all(|v| *v == 0.0 || v.abs() >= 1e-140), "{}", integrator.name);
        assert!(rates.iter().any(|v| *v != 0.0 && v.abs() < 1e-130), "{}: passes small rates", integrator.name);
        assert_eq!(rates.last(), Some(&0.0), "{}", integrator.name);
    }
}

/// A velocity that damping has brought below the least normal number rests: each of a thousand
/// steps leaves some third of the velocity.
#[test]
fn a_motion_that_dies_away_goes_on_to_its_end() {
    let robot = with(EffectId::damping, vec![1000.0]);
    for integrator in [IntegratorId::lie_midpoint, IntegratorId::rodas4, IntegratorId::rk4] {
        let motion = free(&robot, &stepping(integrator, 1.0, 1e-3), &[0.0], &[1.0]).unwrap_or_else(|error| panic!("{integrator}: {error}"));
        // v + d/m x stays.
        assert!(motion.v.last().unwrap().abs() < 1e-300, "{integrator}: {motion:?}");
        assert!((motion.q.last().unwrap() - 1e-3).abs() < 1e-16, "{integrator}: {motion:?}");
    }
}

/// a = −d (v_0 + ½ h a) by substitution: each round leaves ½ h d of the change before, more than
/// there was beyond hd = 2, where in the end it overflows or does not.
#[test]
fn a_midpoint_that_substitution_does_not_find_is_told() {
    for (z, is_found) in [(1.5, true), (3.0, false), (1e3, false)] {
        let robot = with(EffectId::damping, vec![z / 0.01]);
        let found = free(&robot, &stepping(IntegratorId::lie_midpoint, 0.01, 0.01), &[0.0], &[1.0]);
        match found {
            Ok(motion) => assert!(is_found && (motion.v.last().unwrap() - (2.0 - z) / (2.0 + z)).abs() < 1e-14, "hd = {z}: {motion:?}"),
            Err(error) => assert!(!is_found && error == SimulateError::NoConvergence { t: 0.0, step: 0.01 }, "hd = {z}: {error}"),
        }
    }
}

#[test]
fn explicit_steps_beyond_stability_are_refused_with_the_one_that_is_not() {
    let rate = 1000.0;
    let cases = [(EffectId::damping, vec![rate]), (EffectId::spring, vec![rate * rate, 0.0])];
    for (k, (effect, parameters)) in cases.into_iter().enumerate() {
        let robot = with(effect, parameters);
        for integrator in explicit() {
            let limit = longest(integrator)[k];
            let error = free(&robot, &stepping(integrator, 1.0, 0.05), &[1e-3], &[0.1]).unwrap_err();
            let SimulateError::Unstable { admissible, rate: found, step, .. } = error else { panic!("{integrator}: {error}") };
            println!("{integrator}, {effect:?}: {:.3}/rate", admissible * rate);
            assert_eq!(step, 0.05);
            assert!((found / rate - 1.0).abs() < 0.02, "{integrator}: {found} 1/s");
            // Growth of less than 1e-5 a step counts as stable: an oscillation by dopri5, up to
            // 1.02.
            assert!((0.98..1.03).contains(&(admissible * rate / limit)), "{integrator}, {effect:?}: {admissible} s");
            let motion = free(&robot, &stepping(integrator, 20.0, 0.97 * admissible), &[1e-3], &[0.1]).unwrap();
            assert!((0..motion.len()).all(|i| motion.v[i].abs() <= 1.5), "{integrator}, {effect:?}: {motion:?}");
        }
    }
}

/// hλ = 2 e^(±2πi/3): in a step of rk4 1/√3 of it is left where the motion by itself would leave
/// 1/e.
#[test]
fn a_damped_oscillation_that_a_step_damps_less_is_not_refused() {
    let on = |effect, parameters| Applied { effect, on: "joint".into(), at: Origin::default(), parameters };
    let effects = [on(EffectId::spring, vec![1e6, 0.0]), on(EffectId::damping, vec![1e3])];
    let robot = one_joint("prismatic", 0.0).with_gravity([0.0; 3]).with_effects(&effects).unwrap();
    let motion = free(&robot, &stepping(IntegratorId::rk4, 0.2, 2e-3), &[1e-3], &[0.0]).unwrap();
    assert!(motion.q.last().unwrap().abs() < 1e-20, "{motion:?}");
}

/// The actual steps count, and not the requested ones: none is longer than from sample to sample,
/// or than the motion.
#[test]
fn steps_that_a_sample_or_the_end_cuts_short_are_not_refused() {
    let robot = with(EffectId::damping, vec![100.0]);
    for integrator in explicit() {
        assert!(free(&robot, &stepping(integrator, 0.01, 1.0), &[0.0], &[1.0]).is_ok(), "{integrator}");
        let mut hold = Hold::new(NoTorque, 0.01).unwrap();
        let mut simulation = Simulation::new(&robot, stepping(integrator, 1.0, 0.1)).unwrap();
        let motion = simulation.run(&[0.0], &[1.0], &mut hold, &mut []).unwrap();
        assert!(motion.v.last().unwrap().abs() < 1e-20, "{integrator}: {motion:?}");
        let mut slow = Hold::new(NoTorque, 0.07).unwrap();
        let error = simulation.run(&[0.0], &[1.0], &mut slow, &mut []).unwrap_err();
        let SimulateError::Unstable { step, .. } = error else { panic!("{integrator}: {error}") };
        assert!((step - 0.07).abs() < 1e-12, "{integrator}: {step}");
    }
}

#[test]
fn a_step_that_becomes_unstable_on_the_way_is_refused_there() {
    // Nothing is stiff before the limit is reached, at t = 0.5 s.
    let robot = with(EffectId::limit, vec![-10.0, 0.5, 1e6, 0.0]);
    for integrator in explicit() {
        let error = free(&robot, &stepping(integrator, 2.0, 0.01), &[0.0], &[1.0]).unwrap_err();
        let SimulateError::Unstable { t, admissible, rate, .. } = error else { panic!("{integrator}: {error}") };
        println!("{integrator}: {t} s, {admissible} s");
        assert!((0.48..0.53).contains(&t) && admissible < 0.0065 && (rate / 1000.0 - 1.0).abs() < 0.02, "{integrator}: {t} s, {rate} 1/s");
    }
}

/// An arm of two links falls against the stop of its shoulder: the first stage behind it is thrown
/// so far that later stages move at any rate. The stop's is √(k/m_eff).
#[test]
fn a_motion_that_is_thrown_within_a_step_is_refused_at_the_rate_of_what_throws_it() {
    let links = [("upper", 2.0, 0.25, 0.05), ("lower", 1.5, 0.2, 0.02)].map(|(name, mass, x, i)| {
        format!(
            "<link name='{name}'><inertial><origin xyz='{x} 0 0'/><mass value='{mass}'/>\
             <inertia ixx='0.001' ixy='0' ixz='0' iyy='{i}' iyz='0' izz='{i}'/></inertial></link>"
        )
    });
    let urdf = format!(
        "<robot name='arm'><link name='base'/>{}<joint name='shoulder' type='continuous'><parent link='base'/><child link='upper'/>\
         <axis xyz='0 -1 0'/></joint><joint name='elbow' type='continuous'><parent link='upper'/><child link='lower'/>\
         <origin xyz='0.5 0 0'/><axis xyz='0 -1 0'/></joint></robot>",
        links.concat()
    );
    let stop = Applied { effect: EffectId::limit, on: "shoulder".into(), at: Origin::default(), parameters: vec![-3.0, 3.0, 1e7, 0.0] };
    let robot = articulated::load_bytes("arm", urdf.as_bytes(), Base::Fixed).unwrap().with_effects(&[stop]).unwrap();
    for integrator in explicit() {
        for h in [0.02, 0.01, 0.005] {
            let error = free(&robot, &stepping(integrator, 1.0, h), &[0.0, 0.0], &[3.0, 0.0]).unwrap_err();
            let SimulateError::Unstable { t, admissible, rate, .. } = error else { panic!("{integrator}, {h} s: {error}") };
            println!("{integrator}, {h} s: {t} s, {rate} 1/s, {admissible} s");
            assert!((3e3..8e3).contains(&rate) && (1e-4..2e-3).contains(&admissible), "{integrator}, {h} s: {rate} 1/s, {admissible} s");
        }
    }
}

#[test]
fn steps_chosen_by_tolerance_say_that_stability_holds_them() {
    let robot = with(EffectId::damping, vec![1e5]);
    for integrator in explicit().filter(|id| id.row().adaptive) {
        let [limit, _] = longest(integrator);
        let settings = to(integrator, 2.0, 1e-6);
        let error = free(&robot, &settings, &[0.0], &[1.0]).unwrap_err();
        let SimulateError::Stiff { t, step, left, .. } = error else { panic!("{integrator}: {error}") };
        println!("{error}");
        assert!((step * 1e5 / limit - 1.0).abs() < 0.2 && (left * step / (2.0 - t) - 1.0).abs() < 0.01, "{integrator}: {error}");
        assert!(error.to_string().ends_with("Take rodas4, or go on with stiffness = \"note\" (Stiffness::Note in Rust)"), "{error}");
        let motion = free(&robot, &Settings { end: 0.1, stiffness: Stiffness::Note, ..settings }, &[0.0], &[1.0]).unwrap();
        assert!(motion.counts.stiff_at.is_some() && (motion.q.last().unwrap() - 1e-5).abs() < 1e-7);
    }
}

/// Held to steps of 3.3/λ or 6.4/λ: up to 20 000 of them are made and noted, more are refused.
#[test]
fn a_stiff_motion_that_is_soon_over_is_noted_and_made() {
    let robot = with(EffectId::damping, vec![1e5]);
    for (integrator, limit) in [(IntegratorId::dopri5, 3.307e-5), (IntegratorId::dop853, 6.37e-5)] {
        let run = |steps: f64| free(&robot, &to(integrator, steps * limit, 1e-6), &[0.0], &[1.0]);
        let motion = run(15e3).unwrap();
        println!("{integrator}: {:?}", motion.counts);
        assert!(motion.counts.stiff_at.is_some_and(|t| t > 0.0 && t < 2e3 * limit), "{integrator}: {:?}", motion.counts);
        assert!(motion.counts.steps > 12_000 && (motion.q.last().unwrap() - 1e-5).abs() < 1e-7, "{integrator}: {:?}", motion.counts);
        assert!(matches!(run(30e3), Err(SimulateError::Stiff { left, .. }) if left > 20e3 && left < 40e3), "{integrator}");
    }
}

/// A light wrist under the gains of its shoulder is stiff, but its motion is over before that
/// matters.
#[test]
fn an_arm_under_a_firm_controller_arrives() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../models/urdf/ur5_like.urdf");
    let robot = articulated::load(path, Base::Fixed).unwrap();
    let (zero, nv) = (vec![0.0; robot.nv()], robot.nv());
    let run = |integrator| {
        let mut pd = Pd::new(&robot, vec![0.5; nv], vec![30.0; nv], vec![3.0; nv]).unwrap();
        let settings = Settings { integrator, end: 2.0, output: Output::Ends, ..Settings::default() };
        Simulation::new(&robot, settings).unwrap().run(&zero, &zero, &mut pd, &mut []).unwrap()
    };
    let [explicit, implicit] = [run(IntegratorId::dopri5), run(IntegratorId::rodas4)];
    let far = apart(&robot, &explicit, &implicit);
    println!("{far:e}, {:?}", explicit.counts);
    assert!(explicit.counts.stiff_at.is_some() && explicit.counts.steps < 20_000 && far < 1e-6, "{far:e}, {:?}", explicit.counts);
}

/// A cheap start can become expensive: noted at first, refused when a stop is reached.
#[test]
fn a_motion_that_becomes_stiffer_is_refused_then() {
    let on = |effect, parameters| Applied { effect, on: "joint".into(), at: Origin::default(), parameters };
    let stop = on(EffectId::limit, vec![-10.0, 0.5, 1e7, 1e3]);
    let mut push = |t: f64, _: &[f64], v: &[f64], tau: &mut [f64]| tau[0] = if t < 6.0 { 2e3 * (0.08 - v[0]) } else { 1e3 };
    let robot = one_joint("prismatic", 0.0).with_gravity([0.0; 3]).with_effects(&[stop]).unwrap();
    let settings = Settings { output: Output::Every(0.5), ..to(IntegratorId::dopri5, 20.0, 1e-6) };
    let mut simulation = Simulation::new(&robot, settings).unwrap();
    let mut recording = simulation.recording();
    let error = simulation.run_into(&[0.0], &[0.0], &mut push, &mut [], &mut recording, &mut |_, _| true).unwrap_err();
    println!("{error}\n{:?}", recording.counts);
    let SimulateError::Stiff { t, .. } = error else { panic!("{error}") };
    assert!(t > 6.0 && recording.counts.stiff_at.is_some_and(|t| t < 5.0), "{error}: {:?}", recording.counts);
}

#[test]
fn a_body_comes_to_rest_on_a_limit_of_a_giganewton_a_metre() {
    let applied = Applied { effect: EffectId::limit, on: "joint".into(), at: Origin::default(), parameters: vec![0.0, 10.0, 1e9, 1e4] };
    let robot = one_joint("prismatic", 0.0).with_effects(&[applied]).unwrap();
    // Dropped from 1 mm, with a contact that dissipates: it ends in the force balance, 9.81 nm
    // below the limit.
    let settings = to(IntegratorId::rodas4, 1.0, 1e-4);
    let motion = free(&robot, &settings, &[1e-3], &[0.0]).unwrap();
    let (q, v) = (motion.q.last().unwrap(), motion.v.last().unwrap());
    println!("{q:e} m, {v:e} m/s, {} steps", motion.counts.steps);
    assert!((q + 9.81e-9).abs() < 1e-10 && v.abs() < 1e-9, "{q:e} m, {v:e} m/s");
}

#[test]
fn dry_friction_stops_a_body_and_does_not_turn_it_round() {
    let robot = with(EffectId::friction, vec![2.0, 1e-6]);
    let settings = Settings { output: Output::Steps, ..to(IntegratorId::rodas4, 2.0, 1e-6) };
    let motion = free(&robot, &settings, &[0.0], &[1.0]).unwrap();
    let (way, speed) = (motion.q.last().unwrap(), motion.v.last().unwrap());
    println!("{way} m, {speed:e} m/s, {:?}", motion.counts);
    assert!(motion.v.iter().all(|v| *v > -1e-7), "{:?}", motion.v);
    assert!((way - 0.25).abs() < 1e-5 && speed.abs() < 1e-7);
    let lost = motion.dissipated.last().unwrap();
    assert!((lost + 0.5).abs() < 1e-4, "{lost} J");
}

/// Where the force jumps the rate is μ/s, but wherever a step of 10 ms comes to rest it is small:
/// the motion would chatter, or stand still at a speed. A force that bends within a step is not its
/// tangent: three tenths of the longest step that is stable.
#[test]
fn steps_that_leap_over_dry_friction_are_refused() {
    let robot = with(EffectId::friction, vec![1.0, 1e-3]);
    for integrator in explicit() {
        let [limit, _] = longest(integrator);
        let mut h = 0.01;
        let motion = loop {
            match free(&robot, &stepping(integrator, 2.0, h), &[0.0], &[1.0]) {
                Ok(motion) => break motion,
                Err(SimulateError::Unstable { admissible, .. }) if admissible < h => h = 0.3 * admissible,
                Err(error) => panic!("{integrator}: {error}"),
            }
        };
        println!("{integrator}: {h} s, {:?}", motion.v.last());
        assert!(h < 1e-3 * limit && motion.v.last().unwrap().abs() < 1e-9, "{integrator}: {h} s");
        assert!(
            (motion.q.last().unwrap() - 0.5).abs() < 2.0 * h * h + 1e-5 + if integrator.row().order == 1 { h } else { 0.0 },
            "{integrator}"
        );
    }
}

/// |P(ix)| − 1 of dopri5 is 5e-4 at x = 1.25 and 1.6e-3 at x = 1.4, P its polynomial: a growth of a thousandth in a step is the bound.
#[test]
fn an_oscillation_may_grow_by_a_thousandth_in_a_step() {
    let robot = with(EffectId::spring, vec![1e6, 0.0]);
    let run = |x: f64| free(&robot, &stepping(IntegratorId::dopri5, 0.1, x / 1000.0), &[1e-3], &[0.0]);
    assert!(run(1.25).is_ok(), "{:?}", run(1.25));
    assert!(matches!(run(1.4), Err(SimulateError::Unstable { .. })), "{:?}", run(1.4));
}

/// Hairer & Wanner 1996, §IV.2: checked after a thousand steps, and reported after fifteen that
/// stability limits.
#[test]
fn stiffness_is_told_after_fifteen_steps_that_it_holds_back() {
    let robot = with(EffectId::damping, vec![1e5]);
    for integrator in explicit().filter(|id| id.row().adaptive) {
        let mut simulation = Simulation::new(&robot, to(integrator, 2.0, 1e-6)).unwrap();
        let mut recording = simulation.recording();
        let error = simulation.run_into(&[0.0], &[1.0], &mut NoTorque, &mut [], &mut recording, &mut |_, _| true).unwrap_err();
        println!("{integrator}: {}", recording.counts.steps);
        assert!(matches!(error, SimulateError::Stiff { .. }) && (1014..1050).contains(&recording.counts.steps), "{:?}", recording.counts);
    }
}
