//! Motions that are known.

use std::f64::consts::PI;

use articulated::simulate::{Action, Direction, Event, IntegratorId, NoTorque, Output, Simulation};

use crate::robots::{free, handle, one_joint, planar, stepping, to};

/// K(k), the complete elliptic integral of the first kind: π/(2·agm(1, k')).
fn complete_elliptic(k: f64) -> f64 {
    let (mut a, mut b) = (1.0, (1.0 - k * k).sqrt());
    for _ in 0..40 {
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
    }
    PI / (2.0 * a)
}

#[test]
fn a_pendulum_swings_with_the_period_of_the_elliptic_integral() {
    let robot = one_joint("continuous", 0.5).with_gravity([9.81, 0.0, 0.0]); // a physical pendulum: m l g/I = ½ g
    for start in [0.1, 1.0, 2.0, 3.0_f64] {
        let period = 4.0 / (0.5 * 9.81_f64).sqrt() * complete_elliptic((0.5 * start).sin());
        let back = Event::new("back", |_, _, v: &[f64]| v[0]).direction(Direction::Falling).action(Action::Stop);
        let mut simulation = Simulation::new(&robot, to(IntegratorId::dop853, 2.0 * period, 1e-13)).unwrap();
        let motion = simulation.run(&[start], &[0.0], &mut NoTorque, &mut [back]).unwrap();
        let found = motion.events[0].t;
        println!("{start} rad: {:e}, {:?}", found / period - 1.0, motion.counts);
        assert!((found / period - 1.0).abs() < 1e-10);
    }
}

#[test]
fn a_double_pendulum_keeps_its_energy() {
    let motion = free(&planar::Robot, &to(IntegratorId::dop853, 100.0, 1e-13), &[1.0, 0.5], &[0.0, 0.0]).unwrap();
    let lost = motion.imbalance(motion.len() - 1).unwrap();
    println!("{lost:e} J, {:?}", motion.counts);
    assert!(lost.abs() < 1e-10);
}

#[test]
fn a_box_that_tumbles_keeps_energy_and_momentum_to_rounding() {
    let mut settings = stepping(IntegratorId::lie_midpoint, 20.0, 0.01);
    settings.output = Output::Every(0.1);
    let motion = free(&handle::Robot, &settings, &[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0], &[0.1, 3.0, 0.2, 0.5, -0.2, 0.1]).unwrap();
    let (energy, momentum) = (motion.kinetic[0], motion.momentum_at(0).unwrap());
    for i in 0..motion.len() {
        let lost = (motion.kinetic[i] / energy - 1.0).abs();
        let turned = motion.momentum_at(i).unwrap().iter().zip(momentum).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
        let size = momentum.iter().map(|x| x * x).sum::<f64>().sqrt();
        assert!(lost < 1e-12 && turned / size < 1e-12, "{i}: {lost:e} {:e}", turned / size);
    }
    let last = motion.len() - 1;
    println!("{:e} {:?}", motion.kinetic[last] / energy - 1.0, motion.counts);
}
