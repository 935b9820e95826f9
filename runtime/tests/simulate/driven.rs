//! Controllers of a robot, and the balance of energy.

use std::cell::RefCell;

use articulated::effect::{Applied, EffectId};
use articulated::simulate::{
    Action, Constant, Control, Event, Hold, IntegratorId, NoTorque, Output, Pd, Settings, SimulateError, Simulation, TorqueTable,
    integrators,
};
use articulated::{Base, Dynamics, Origin};

use crate::robots::{apart, chain, free, handle, model, one_joint, satellite, slider, stepping, to};

/// q̈ = u between samples: the sums are exact, and the samples come at their times.
#[test]
fn a_sampled_controller_is_asked_at_its_times_and_held_between() {
    for id in [IntegratorId::dopri5, IntegratorId::rodas4, IntegratorId::rk4] {
        let times = RefCell::new(Vec::new());
        let law = |t: f64, q: &[f64], v: &[f64]| -2.0 * q[0] - v[0] + t;
        let control = |t: f64, q: &[f64], v: &[f64], tau: &mut [f64]| {
            times.borrow_mut().push(t);
            tau[0] = law(t, q, v);
        };
        let settings = if id == IntegratorId::rk4 { stepping(id, 1.0, 0.03) } else { to(id, 1.0, 1e-6) };
        let mut hold = Hold::new(control, 0.1).unwrap();
        let motion = Simulation::new(&slider(), settings).unwrap().run(&[1.0], &[0.0], &mut hold, &mut []).unwrap();
        let (mut q, mut v) = (1.0, 0.0);
        for k in 0..10 {
            let u = law(0.1 * f64::from(k), &[q], &[v]);
            q += 0.1 * v + 0.005 * u;
            v += 0.1 * u;
        }
        let times = times.into_inner();
        assert_eq!(times.len(), 10, "{id}: {times:?}");
        assert!(times.iter().enumerate().all(|(k, t)| (t - 0.1 * k as f64).abs() < 1e-15), "{id}: {times:?}");
        assert!((motion.q[1] - q).abs() < 1e-13 && (motion.v[1] - v).abs() < 1e-13, "{id}: {} {q}", motion.q[1]);
    }
    assert!([0.0, -1.0, f64::NAN, f64::INFINITY].iter().all(|period| Hold::new(NoTorque, *period).is_err()));
}

/// A table that is sampled; it counts how often.
struct Sampled(TorqueTable, usize);

impl Control for Sampled {
    fn torques(&mut self, t: f64, q: &[f64], v: &[f64], tau: &mut [f64]) {
        self.1 += 1;
        self.0.torques(t, q, v, tau);
    }

    fn period(&self) -> Option<f64> {
        Some(0.1)
    }

    fn next_kink(&self, t: f64) -> f64 {
        self.0.next_kink(t)
    }
}

/// Rows between two samples have no effect on a sampled controller: they neither call it nor
/// replace a sample.
#[test]
fn a_sampled_table_is_asked_at_samples_alone() {
    let rows = ([0.0, 0.3, 0.5, 0.55, 0.8], [0.0, 1.0, 2.0, 0.0, 0.2]);
    let table = || TorqueTable::new(rows.0.to_vec(), &rows.1, 1).unwrap();
    let (mut q, mut v) = (0.3, -0.2);
    for k in 0..10 {
        let mut u = [0.0];
        table().torques(0.1 * f64::from(k), &[q], &[v], &mut u);
        q += 0.1 * v + 0.005 * u[0];
        v += 0.1 * u[0];
    }
    for id in [IntegratorId::dopri5, IntegratorId::rodas4, IntegratorId::rk4] {
        let settings = if id == IntegratorId::rk4 { stepping(id, 1.0, 0.03) } else { to(id, 1.0, 1e-6) };
        let mut sampled = Sampled(table(), 0);
        let motion = Simulation::new(&slider(), settings).unwrap().run(&[0.3], &[-0.2], &mut sampled, &mut []).unwrap();
        assert_eq!(sampled.1, 10, "{id}");
        assert!((motion.q[1] - q).abs() < 1e-13 && (motion.v[1] - v).abs() < 1e-13, "{id}: {} {q}", motion.q[1]);
    }
}

/// A tent of force: steps end at its top, so that a curve of third degree is exact.
#[test]
fn a_table_is_followed_through_its_kinks() {
    for id in [IntegratorId::dopri5, IntegratorId::rodas4, IntegratorId::rk4] {
        let settings = if id == IntegratorId::rk4 { stepping(id, 2.0, 0.3) } else { to(id, 2.0, 1e-3) };
        let mut table = TorqueTable::new(vec![0.0, 0.7, 1.4], &[0.0, 1.0, 0.0], 1).unwrap();
        let motion = Simulation::new(&slider(), settings).unwrap().with_energy_balance().run(&[0.0], &[0.0], &mut table, &mut []).unwrap();
        // ∫ = 0.7, the centre at 0.7. Derivatives in time are differences where steps are linearly
        // implicit.
        let bound = if id == IntegratorId::rodas4 { 1e-9 } else { 1e-14 };
        assert!((motion.v[1] - 0.7).abs() < bound && (motion.q[1] - 0.7 * 1.3).abs() < bound, "{id}: {} {}", motion.v[1], motion.q[1]);
        assert!((motion.work[1] - 0.5 * 0.49).abs() < bound, "{id}: {}", motion.work[1]);
    }
}

/// 1 N up to 0.7 s, −2 N from there on.
struct Jump;

impl Control for Jump {
    fn torques(&mut self, t: f64, _: &[f64], _: &[f64], tau: &mut [f64]) {
        tau[0] = if t < 0.7 { 1.0 } else { -2.0 };
    }

    fn next_kink(&self, t: f64) -> f64 {
        if t < 0.7 { 0.7 } else { f64::INFINITY }
    }
}

/// Steps end at the jump, and no stage of the step before it sees torques after it: parabolas are
/// exact.
#[test]
fn a_step_that_ends_at_a_jump_is_made_with_the_torques_before_it() {
    for id in [IntegratorId::dopri5, IntegratorId::dop853, IntegratorId::rodas4, IntegratorId::rk4, IntegratorId::lie_midpoint] {
        let settings = if id.row().adaptive { to(id, 1.0, 1e-3) } else { stepping(id, 1.0, 0.3) };
        let motion = Simulation::new(&slider(), settings).unwrap().with_energy_balance().run(&[0.0], &[0.0], &mut Jump, &mut []).unwrap();
        let (v, q) = (0.7 - 2.0 * 0.3, 0.5 * 0.49 + 0.7 * 0.3 - 0.09);
        assert!((motion.v[1] - v).abs() < 1e-14 && (motion.q[1] - q).abs() < 1e-14, "{id}: {} {}", motion.v[1], motion.q[1]);
        assert!((motion.work[1] - (0.5 * 0.49 - 2.0 * (q - 0.5 * 0.49))).abs() < 1e-13, "{id}: {}", motion.work[1]);
    }
}

/// The same far from the zero of time as near it, and steps by tolerance are no shorter there.
#[test]
fn a_jump_late_in_time_is_a_jump() {
    struct Late;
    impl Control for Late {
        fn torques(&mut self, t: f64, _: &[f64], _: &[f64], tau: &mut [f64]) {
            tau[0] = if t < 1e6 + 0.5 { 0.0 } else { 200.0 };
        }
        fn next_kink(&self, t: f64) -> f64 {
            if t < 1e6 + 0.5 { 1e6 + 0.5 } else { f64::INFINITY }
        }
    }
    for adaptive in [false, true] {
        let settings = if adaptive { to(IntegratorId::rodas4, 1e6 + 1.0, 1e-6) } else { stepping(IntegratorId::rodas4, 1e6 + 1.0, 0.01) };
        let settings = Settings { start: 1e6, max_step: 0.01, ..settings };
        let motion = Simulation::new(&slider(), settings).unwrap().run(&[0.0], &[0.0], &mut Late, &mut []).unwrap();
        assert!((motion.v[1] - 100.0).abs() < 1e-7, "{}", motion.v[1]);
        assert!(motion.counts.steps < 150, "{}", motion.counts.steps);
    }
}

#[test]
fn a_controller_brings_a_robot_to_its_target_whatever_integrates_it() {
    let (q, v) = ([0.4, -0.7, 0.5], [0.0; 3]);
    let run = |id| {
        let mut pd = Pd::new(&chain::Robot, vec![1.0, 0.5, -0.5], vec![300.0; 3], vec![20.0, 20.0, 10.0]).unwrap();
        Simulation::new(&chain::Robot, to(id, 0.5, 1e-9)).unwrap().run(&q, &v, &mut pd, &mut []).unwrap()
    };
    let [a, b, c] = [IntegratorId::dop853, IntegratorId::dopri5, IntegratorId::rodas4].map(run);
    let far = [apart(&chain::Robot, &a, &b), apart(&chain::Robot, &a, &c)];
    println!("{far:?}; steps {} {} {}", a.counts.steps, b.counts.steps, c.counts.steps);
    assert!(far.iter().all(|far| *far < 1e-7) && (a.q_at(1)[0] - 1.0).abs() < 0.1);
    // A rotation vector where there is a quaternion.
    let half = vec![0.0, 0.0, 0.0, 0.5, 0.5, 0.5, 0.5];
    let mut gentle = Pd::new(&handle::Robot, half.clone(), vec![30.0; 6], vec![25.0; 6]).unwrap();
    let start = [0.3, 0.1, 0.0, 0.0, 0.0, 0.0, 1.0];
    let motion =
        Simulation::new(&handle::Robot, to(IntegratorId::dopri5, 20.0, 1e-6)).unwrap().run(&start, &[0.0; 6], &mut gentle, &mut []);
    let motion = motion.unwrap();
    assert!(motion.q_at(1).iter().zip(&half).all(|(q, h)| (q - h).abs() < 1e-4), "{:?}", motion.q_at(1));
}

/// T + U − (T + U)_0 = work + dissipated, with friction, damping, a spring and a motor between
/// command and joint.
#[test]
fn energy_is_accounted_for() {
    let on = |effect, on: &str, parameters| Applied { effect, on: on.into(), at: Origin::default(), parameters };
    let effects = [
        on(EffectId::damping, "a", vec![0.3]),
        on(EffectId::friction, "b", vec![0.2, 0.1]),
        on(EffectId::spring, "c", vec![2.0, 0.1]),
        on(EffectId::motor, "a", vec![2.0, 20.0, 1.0, 0.8, 0.1]),
    ];
    let robot = model("chain", Base::Fixed).with_effects(&effects).unwrap();
    for (id, step) in
        [(IntegratorId::dopri5, None), (IntegratorId::dop853, None), (IntegratorId::rodas4, None), (IntegratorId::rk4, Some(2e-3))]
    {
        let settings = Settings { step, output: Output::Every(0.1), ..to(id, 0.5, 1e-8) };
        let mut control = |t: f64, _: &[f64], v: &[f64], tau: &mut [f64]| {
            tau[0] = 1.2 * (4.0 * t).sin();
            tau[2] = -0.1 * v[2];
        };
        let motion = Simulation::new(&robot, settings)
            .unwrap()
            .with_energy_balance()
            .run(&[0.4, -0.7, 0.5], &[1.0, 0.5, -1.5], &mut control, &mut [])
            .unwrap();
        let worst = (0..motion.len()).map(|i| motion.imbalance(i).unwrap().abs()).fold(0.0, f64::max);
        let (work, lost) = (motion.work.last().unwrap(), motion.dissipated.last().unwrap());
        println!("{id}: {worst:e} J of {work} J and {lost} J");
        assert!(worst < 3e-7 && *lost < -0.05 && work.abs() > 0.01, "{id}: {worst:e} J");
    }
}

/// The same motion, written out and in loops.
#[test]
fn generated_and_generic_robots_move_alike() {
    fn compare<R: Dynamics<f64>>(robot: &R, name: &str, base: Base, q: &[f64], v: &[f64]) {
        let generic = model(name, base);
        for settings in
            [stepping(IntegratorId::rk4, 0.3, 0.01), to(IntegratorId::dopri5, 0.3, 1e-8), stepping(IntegratorId::lie_midpoint, 0.3, 0.01)]
        {
            let [a, b] = [free(robot, &settings, q, v).unwrap(), free(&generic, &settings, q, v).unwrap()];
            let far = apart(&generic, &a, &b);
            println!("{name}, {}: {far:e}", settings.integrator);
            assert!(far < 1e-12 && a.counts.steps == b.counts.steps, "{name}, {}: {far:e}", settings.integrator);
        }
    }
    compare(&chain::Robot, "chain", Base::Fixed, &[0.4, -0.7, 0.5], &[1.0, 0.5, -1.5]);
    let q = [0.3, -0.2, 0.5, 0.5, -0.5, 0.5, 0.5, 0.7, 0.1, 0.7, -0.1, 0.7];
    compare(&satellite::Robot, "satellite", Base::Floating, &q, &[1.8, -1.5, 2.0, 0.3, -0.2, 0.5, 0.4, 0.1, -0.1, 0.1]);
}

/// Outputs are on the curve, as good as the steps.
#[test]
fn outputs_between_steps_are_as_good_as_steps() {
    let (q, v) = ([0.4, -0.7, 0.5], [1.0, 0.5, -1.5]);
    let fine = free(&chain::Robot, &Settings { output: Output::Every(0.013), ..to(IntegratorId::dop853, 1.0, 1e-14) }, &q, &v).unwrap();
    for (id, bound) in [(IntegratorId::dopri5, 1e-6), (IntegratorId::dop853, 1e-6), (IntegratorId::rodas4, 1e-5)] {
        let settings = Settings { output: Output::Every(0.013), ..to(id, 1.0, 1e-8) };
        let motion = Simulation::new(&chain::Robot, settings).unwrap().run(&q, &v, &mut Constant::new(vec![0.0; 3]), &mut []).unwrap();
        assert_eq!(motion.t, fine.t);
        let far = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        let (q, v) = (far(&motion.q, &fine.q), far(&motion.v, &fine.v));
        println!("{id}: {q:e} {v:e}, {} steps", motion.counts.steps);
        assert!(q.max(v) < bound && motion.counts.steps < 400, "{id}: {q:e} {v:e}");
    }
}

/// A force that grows with time: velocities are parabolas, which the curve of a step follows from
/// its slopes at both ends.
#[test]
fn curves_know_the_time_of_their_slopes() {
    let mut growing = |t: f64, _: &[f64], _: &[f64], tau: &mut [f64]| tau[0] = 6.0 * t;
    for id in [IntegratorId::lie_midpoint, IntegratorId::rk4, IntegratorId::dopri5, IntegratorId::dop853] {
        let settings = Settings { output: Output::Every(0.07), ..stepping(id, 1.0, 0.2) };
        let motion = Simulation::new(&slider(), settings).unwrap().run(&[0.0], &[0.0], &mut growing, &mut []).unwrap();
        let wrong = motion.t.iter().zip(&motion.v).map(|(t, v)| (v - 3.0 * t * t).abs()).fold(0.0, f64::max);
        assert!(wrong < 1e-14, "{id}: {wrong:e}");
    }
}

/// Of a force of fifth degree the way is of seventh, as the curve is.
#[test]
fn the_curve_of_dop853_is_of_order_seven() {
    let mut growing = |t: f64, _: &[f64], _: &[f64], tau: &mut [f64]| tau[0] = t.powi(5);
    let settings = Settings { output: Output::Every(0.1), ..stepping(IntegratorId::dop853, 1.0, 1.0) };
    let motion = Simulation::new(&slider(), settings).unwrap().run(&[0.0], &[0.0], &mut growing, &mut []).unwrap();
    assert_eq!((motion.counts.steps, motion.len()), (1, 11));
    for (k, t) in motion.t.iter().enumerate() {
        let (q, v) = (motion.q[k] - t.powi(7) / 42.0, motion.v[k] - t.powi(6) / 6.0);
        assert!(q.abs() < 1e-14 && v.abs() < 1e-14, "{t}: {q:e} {v:e}");
    }
}

/// Records are at the requested times: none twice, none left out, whatever the rounding of the
/// times.
#[test]
fn outputs_come_at_their_times() {
    let robot = slider();
    let times = |settings: Settings| {
        let motion = free(&robot, &settings, &[0.0], &[1.0]).unwrap();
        assert!(motion.q.iter().zip(&motion.t).all(|(q, t)| (q - (t - settings.start)).abs() < 1e-14), "{motion:?}");
        motion.t
    };
    for k in 1..60 {
        let settings = Settings { start: 0.5, end: 1.2, output: Output::Every(0.7 / f64::from(k)), ..to(IntegratorId::dopri5, 1.2, 1e-9) };
        let found = times(settings);
        let expected = (0..=k).map(|i| 0.5 + 0.7 * f64::from(i) / f64::from(k));
        assert_eq!(found.len(), k as usize + 1, "{k}: {found:?}");
        assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-15 * 8.0), "{k}: {found:?}");
    }
    let asked = vec![0.0, 0.25, 1.0];
    assert_eq!(times(Settings { output: Output::At(asked.clone()), ..to(IntegratorId::dopri5, 1.0, 1e-9) }), asked);
    assert_eq!(times(to(IntegratorId::dopri5, 1.0, 1e-9)), [0.0, 1.0]);
}

/// The first step is the requested one, none is longer than allowed, and if one shorter than
/// allowed is needed, that is an error.
#[test]
fn steps_keep_the_bounds_that_they_are_given() {
    let (q, v) = ([0.4, -0.7, 0.5], [1.0, 0.5, -1.5]);
    for id in [IntegratorId::dopri5, IntegratorId::dop853, IntegratorId::rodas4] {
        let bounded = Settings { first_step: Some(1e-4), max_step: 3e-3, output: Output::Steps, ..to(id, 0.2, 1e-3) };
        let motion = free(&model("chain", Base::Fixed), &bounded, &q, &v).unwrap();
        assert!((motion.t[1] - 1e-4).abs() < 1e-16, "{id}: {}", motion.t[1]);
        assert!(
            motion.t.windows(2).all(|w| w[1] - w[0] <= 3e-3 * (1.0 + 1e-12)) && motion.counts.largest_step > 2.9e-3,
            "{id}: {:?}",
            motion.counts
        );
        // A jump that the control does not announce.
        let mut jump = |t: f64, _: &[f64], _: &[f64], tau: &mut [f64]| tau[0] = if t < 0.05 { 0.0 } else { 1e3 };
        let run = |min_step, jump: &mut dyn Control| {
            let settings = Settings { min_step, ..to(id, 0.2, 1e-9) };
            Simulation::new(&slider(), settings).unwrap().run(&[0.0], &[0.0], jump, &mut []).map(|_| ())
        };
        let Err(SimulateError::StepTooSmall { t, step, joint, .. }) = run(1e-3, &mut jump) else { panic!("{id}") };
        assert!(t <= 0.05 && t > 0.04 && step < 1e-3 && joint.as_deref() == Some("joint"), "{id}: {t} {step} {joint:?}");
        assert_eq!(run(0.0, &mut jump), Ok(()), "{id}");
    }
}

/// An end that is a rounding after a step or a record is not a separate one.
#[test]
fn what_rounding_leaves_before_the_end_is_no_step_and_no_record() {
    let settings = Settings { output: Output::Every(0.1), ..stepping(IntegratorId::rk4, 0.3 + 1e-11, 0.1) };
    let motion = free(&slider(), &settings, &[0.0], &[1.0]).unwrap();
    assert_eq!((motion.counts.steps, motion.t.len(), motion.t[3]), (3, 4, 0.3 + 1e-11), "{:?}", motion.t);
    let later = free(&slider(), &Settings { end: 0.3 + 1e-9, ..settings }, &[0.0], &[1.0]).unwrap();
    assert_eq!((later.counts.steps, later.t.len()), (4, 5), "{:?}", later.t);
}

/// Kinks at 0.5 s and a moment later.
struct Kinks;

impl Control for Kinks {
    fn torques(&mut self, _: f64, _: &[f64], _: &[f64], tau: &mut [f64]) {
        tau[0] = 1.0;
    }

    fn next_kink(&self, t: f64) -> f64 {
        [0.5, 0.5001].into_iter().find(|kink| *kink > t).unwrap_or(f64::INFINITY)
    }
}

/// Steps that could be longer than half of the rest are halves, and a step that is longer than its
/// stretch does not affect the next.
#[test]
fn steps_are_alike_where_stretches_are_not_whole_multiples_of_them() {
    for id in [IntegratorId::dopri5, IntegratorId::dop853, IntegratorId::rodas4] {
        let settings = Settings { first_step: Some(0.1), max_step: 0.1, ..to(id, 0.6, 1e-6) };
        let mut held = Hold::new(NoTorque, 0.12).unwrap();
        let counts = Simulation::new(&slider(), settings).unwrap().run(&[0.0], &[1.0], &mut held, &mut []).unwrap().counts;
        assert!(counts.steps == 10 && counts.smallest_step > 0.5 * counts.largest_step, "{id}: {counts:?}");
        let settings = Settings { first_step: Some(0.25), max_step: 0.25, ..to(id, 1.5001, 1e-3) };
        let counts = Simulation::new(&slider(), settings).unwrap().run(&[0.0], &[0.0], &mut Kinks, &mut []).unwrap().counts;
        assert!(counts.steps == 7 && counts.smallest_step < 2e-4, "{id}: {counts:?}");
    }
}

/// From rest, where the state has no size of its own: a hundred of the trial steps of 1 µs.
#[test]
fn a_first_step_is_no_longer_than_a_hundred_trials() {
    for id in [IntegratorId::dopri5, IntegratorId::dop853] {
        let settings = Settings { output: Output::Steps, ..to(id, 1.0, 1e-6) };
        let motion = Simulation::new(&slider(), settings).unwrap().run(&[0.0], &[0.0], &mut Constant::new(vec![1.0]), &mut []).unwrap();
        assert!((motion.t[1] - 1e-4).abs() < 1e-16, "{id}: {}", motion.t[1]);
    }
}

/// Nothing of one motion remains in the next: neither held torques, nor derivatives, nor records.
#[test]
fn a_motion_is_the_same_whatever_the_simulation_did_before() {
    let robot = model("chain", Base::Fixed);
    let mut crossing = [Event::new("zero", |_, q: &[f64], _: &[f64]| q[0])];
    for row in integrators() {
        for steps in [1.0, 40.0] {
            let settings = Settings { output: Output::Every(0.02), first_step: Some(0.04 / steps), ..stepping(row.id, 0.04, 0.04 / steps) };
            let mut simulation = Simulation::new(&robot, settings.clone()).unwrap();
            let mut pulled = Hold::new(|_: f64, _: &[f64], _: &[f64], tau: &mut [f64]| tau.fill(3.0), 0.01).unwrap();
            let mut recording = simulation.recording();
            simulation
                .run_into(&[-0.03, 0.7, 1.5], &[2.0, -3.0, 1.0], &mut pulled, &mut crossing, &mut recording, &mut |_, _| true)
                .unwrap();
            assert_eq!(recording.events.len(), 1, "{}", row.name);
            simulation.run(&[0.4, 1.0, -1.5], &[1.0, 0.0, 0.0], &mut NoTorque, &mut []).unwrap();
            let (q, v) = ([0.4, -0.7, 0.5], [1.0, 0.5, -1.5]);
            simulation.run_into(&q, &v, &mut NoTorque, &mut crossing, &mut recording, &mut |_, _| true).unwrap();
            let alone = Simulation::new(&robot, settings).unwrap().run(&q, &v, &mut NoTorque, &mut crossing).unwrap();
            assert_eq!(recording, alone, "{}", row.name);
        }
    }
}

/// The torque array is zero at each call, also at each sample: additions do not accumulate.
#[test]
fn torques_that_are_added_do_not_add_up() {
    let settings = Settings { output: Output::Every(0.25), ..stepping(IntegratorId::rk4, 1.0, 0.05) };
    let mut add = Hold::new(|_: f64, _: &[f64], _: &[f64], tau: &mut [f64]| tau[0] += 1.0, 0.25).unwrap();
    let motion = Simulation::new(&slider(), settings).unwrap().run(&[0.0], &[0.0], &mut add, &mut []).unwrap();
    assert_eq!(motion.tau, [1.0; 5]);
    assert!((motion.v[4] - 1.0).abs() < 1e-14, "{:?}", motion.v);
}

/// The rounds of an implicit step begin at the acceleration of the step before, and at zero at the
/// start of a motion.
#[test]
fn rounds_are_as_many_as_without_a_motion_before() {
    let robot = slider();
    let mut simulation = Simulation::new(&robot, stepping(IntegratorId::lie_midpoint, 1.0, 0.1)).unwrap();
    let mut rounds = |torque: f64| simulation.run(&[0.0], &[1.0], &mut Constant::new(vec![torque]), &mut []).unwrap().counts.iterations;
    // Where it is the same all the way one round is enough to see that.
    assert_eq!([3.0, 0.0, 3.0].map(&mut rounds), [11, 10, 11]);
}

/// τ = k_p·(target − q) + k_d·(rate − v): once under way, a body that is to follow a rate lags by
/// the torque of its own acceleration and friction, which is zero here.
#[test]
fn a_controller_with_rates_holds_them() {
    let robot = slider();
    let mut pd = Pd::new(&robot, vec![0.0], vec![0.0], vec![5.0]).unwrap().with_rates(&[0.7]).unwrap();
    let motion = Simulation::new(&robot, to(IntegratorId::dop853, 2.0, 1e-12)).unwrap().run(&[0.0], &[-0.2], &mut pd, &mut []).unwrap();
    // v̇ = k_d (v_0 − v)
    assert!((motion.v[1] - (0.7 - 0.9 * (-10.0_f64).exp())).abs() < 1e-11, "{}", motion.v[1]);
    let pd = |gain: f64, rates: &[f64]| Pd::new(&robot, vec![0.0], vec![gain], vec![5.0]).and_then(|pd| pd.with_rates(rates));
    for (gain, rates) in [(1.0, &[0.7, 0.1][..]), (1.0, &[]), (1.0, &[f64::NAN]), (f64::INFINITY, &[0.7])] {
        assert!(matches!(pd(gain, rates), Err(SimulateError::State(wrong)) if wrong.len() == 1), "{gain} {rates:?}");
    }
}

/// Stretch by stretch it is the same motion.
#[test]
fn a_motion_can_be_taken_up_where_it_was_left() {
    let mut simulation = Simulation::new(&chain::Robot, stepping(IntegratorId::rk4, 0.1, 1e-3)).unwrap();
    let (mut q, mut v) = (vec![0.4, -0.7, 0.5], vec![1.0, 0.5, -1.5]);
    for k in 0..5 {
        simulation.set_span(0.1 * f64::from(k), 0.1 * f64::from(k + 1)).unwrap();
        let motion = simulation.run(&q, &v, &mut NoTorque, &mut []).unwrap();
        (q, v) = (motion.q_at(1).to_vec(), motion.v_at(1).to_vec());
    }
    let whole = free(&chain::Robot, &stepping(IntegratorId::rk4, 0.5, 1e-3), &[0.4, -0.7, 0.5], &[1.0, 0.5, -1.5]).unwrap();
    assert!(whole.q_at(1).iter().zip(&q).chain(whole.v_at(1).iter().zip(&v)).all(|(a, b)| (a - b).abs() < 1e-13));
    assert!(matches!(simulation.set_span(1.0, 1.0), Err(SimulateError::Settings(_))) && simulation.settings().end == 0.5);
}

/// A control that is a value of a type, behind the trait.
#[test]
fn any_control_will_do() {
    let controls: [Box<dyn Control>; 3] =
        [Box::new(NoTorque), Box::new(Constant::new(vec![0.0])), Box::new(Hold::new(NoTorque, 0.25).unwrap())];
    for mut control in controls {
        let motion =
            Simulation::new(&slider(), to(IntegratorId::dopri5, 1.0, 1e-9)).unwrap().run(&[0.0], &[2.0], &mut *control, &mut []).unwrap();
        assert!((motion.q[1] - 2.0).abs() < 1e-14);
    }
}

/// Whatever its joints are: mimicking ones, planar ones, limbs on a floating base.
#[test]
fn every_bundled_robot_keeps_its_energy() {
    let names =
        ["simple_pendulum", "double_pendulum", "cart_pole", "ur5_like", "panda_like", "gripper_arm", "quadruped", "golfer", "humanoid"];
    for name in names {
        let base = if ["quadruped", "humanoid"].contains(&name) { Base::Floating } else { Base::Fixed };
        let path = format!("{}/../models/urdf/{name}.urdf", env!("CARGO_MANIFEST_DIR"));
        let robot = articulated::load(path, base).unwrap();
        let shape = robot.shape();
        let (mut ws, mut q) = (robot.workspace(), vec![0.0; shape.nq]);
        let numbers = |n: usize| (0..n).map(|i| (0.37 + 0.618 * i as f64).fract()).collect::<Vec<f64>>();
        robot.random_configuration(&mut ws, &numbers(shape.nq), &mut q).unwrap();
        let v: Vec<f64> = numbers(shape.nv).iter().map(|x| 2.0 * x - 1.0).collect();
        let motion = free(&robot, &to(IntegratorId::dop853, 0.2, 1e-10), &q, &v).unwrap();
        let lost = motion.imbalance(1).unwrap() / motion.energy(0).unwrap().abs().max(1.0);
        println!("{name}: {lost:e}, {} steps", motion.counts.steps);
        assert!(lost.abs() < 1e-9, "{name}: {lost:e}");
    }
}

/// A servo of 1e7 N·m/rad moves far more energy between two records than remains at any of them:
/// the balance is that of all steps, whatever is recorded.
#[test]
fn the_balance_of_energy_does_not_depend_on_what_is_recorded() {
    let robot = one_joint("continuous", 0.3);
    let balance = |output: Output, requested: bool| {
        let mut pd = Pd::new(&robot, vec![0.4], vec![1e7], vec![2e3]).unwrap();
        let settings = Settings { integrator: IntegratorId::rodas4, end: 1.0, output, ..Settings::default() };
        let simulation = Simulation::new(&robot, settings).unwrap();
        let mut simulation = if requested { simulation.with_energy_balance() } else { simulation };
        simulation.run(&[0.0], &[0.0], &mut pd, &mut []).unwrap().balance
    };
    let all = [Output::Ends, Output::Every(0.01), Output::Every(0.0005), Output::Steps].map(|output| balance(output, true).unwrap());
    assert!(all.iter().all(|b| *b == all[0]), "{all:?}");
    // A spring of ½ kp 0.4² = 8e5 J moves it.
    println!("{:?}, {:e}", all[0], all[0].relative());
    assert!(all[0].largest_moved > 1e5 && all[0].relative() < 1e-4, "{:?}", all[0]);
    assert_eq!(balance(Output::Ends, false), None);
}

/// For a body that is thrown up and falls on a map that stops it: T, work and energy from events
/// are known at the end, and the balance is zero.
#[test]
fn the_balance_of_energy_counts_what_events_bring() {
    let robot = one_joint("prismatic", 0.0);
    let stop = Event::new("stop", |t, _: &[f64], _: &[f64]| t - 0.5).action(Action::Map(Box::new(|_, _, v| {
        v[0] = 0.0;
        Ok(None)
    })));
    let mut simulation = Simulation::new(&robot, to(IntegratorId::dopri5, 0.5, 1e-9)).unwrap().with_energy_balance();
    let mut push = |_: f64, _: &[f64], _: &[f64], tau: &mut [f64]| tau[0] = 9.81 + 2.0;
    let motion = simulation.run(&[0.0], &[0.0], &mut push, &mut [stop]).unwrap();
    // 11.81 N over ½ 2 0.5² m.
    let balance = motion.balance.unwrap();
    assert!((balance.largest_moved - 11.81 * 0.25).abs() < 1e-8 && balance.largest_imbalance < 1e-8, "{balance:?}");
}
