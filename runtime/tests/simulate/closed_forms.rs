//! Motions that are known.

use std::f64::consts::PI;

use articulated::simulate::{Action, Direction, Event, IntegratorId, NoTorque, Output, Settings, Simulation};
use articulated::spatial::screw::{Quaternion, exp_rotation};
use articulated::spatial::{Matrix3, Vector3, from_quaternion};
use articulated::{Base, Dynamics, load_bytes};

use crate::robots::{free, handle, one_joint, planar, stepping, to, top};

/// K(k), the complete elliptic integral of the first kind: π/(2·agm(1, k')).
fn complete_elliptic(k: f64) -> f64 {
    let (mut a, mut b) = (1.0, (1.0 - k * k).sqrt());
    for _ in 0..40 {
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
    }
    PI / (2.0 * a)
}

/// sn, cn and dn of u at modulus k: descending Landen transformation, Abramowitz & Stegun 16.4.
fn jacobi(u: f64, k: f64) -> (f64, f64, f64) {
    let (mut a, mut b, mut c) = (1.0, (1.0 - k * k).sqrt(), Vec::new());
    for _ in 0..30 {
        c.push((0.5 * (a - b), 0.5 * (a + b)));
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
    }
    let mut phi = 2_f64.powi(30) * a * u;
    for (c, a) in c.iter().rev() {
        phi = 0.5 * (phi + (c / a * phi.sin()).asin());
    }
    (phi.sin(), phi.cos(), (1.0 - (k * phi.sin()).powi(2)).sqrt())
}

#[test]
fn a_pendulum_swings_with_the_period_of_the_elliptic_integral() {
    // m l g/I = ½ g.
    let robot = one_joint("continuous", 0.5).with_gravity([9.81, 0.0, 0.0]);
    for start in [0.1, 1.0, 2.0, 3.0_f64] {
        let period = 4.0 / (0.5 * 9.81_f64).sqrt() * complete_elliptic((0.5 * start).sin());
        let back = Event::new("back", |_, _, v: &[f64]| v[0]).direction(Direction::Falling).action(Action::Stop);
        let mut simulation = Simulation::new(&robot, to(IntegratorId::dop853, 2.0 * period, 1e-13)).unwrap();
        let motion = simulation.run(&[start], &[0.0], &mut NoTorque, &mut [back]).unwrap();
        let error = motion.events[0].t / period - 1.0;
        println!("{start} rad: {error:e}");
        assert!(error.abs() < 1e-11, "{start} rad: {error:e}");
    }
}

#[test]
fn a_double_pendulum_keeps_its_energy() {
    let motion = free(&planar::Robot, &to(IntegratorId::dop853, 100.0, 1e-13), &[1.0, 0.5], &[0.0, 0.0]).unwrap();
    let lost = motion.imbalance(motion.len() - 1).unwrap();
    println!("{lost:e} J, {} steps", motion.counts.steps);
    assert!(lost.abs() < 1e-10);
}

const HANDLE: [f64; 3] = [1.0, 2.0, 2.7];

/// The angular velocity of a free body that is (x, 0, z) at t = 0, with M² > 2E·I_2: Landau &
/// Lifshitz, Mechanics, §37.
fn euler(t: f64, x: f64, z: f64) -> ([f64; 3], f64) {
    let [a, b, c] = HANDLE;
    let (twice, square) = (a * x * x + c * z * z, a * a * x * x + c * c * z * z);
    assert!(square > twice * b);
    let k = ((b - a) * (twice * c - square) / ((c - b) * (square - twice * a))).sqrt();
    let rate = ((c - b) * (square - twice * a) / (a * b * c)).sqrt();
    let (sn, cn, dn) = jacobi(rate * t, k);
    let y = ((twice * c - square) / (b * (c - b))).sqrt();
    ([x * cn, y * sn, z * dn], 2.0 * complete_elliptic(k) / rate)
}

#[test]
fn a_handle_flips_a_hundred_times_as_elliptic_functions_say() {
    let (x, z) = (2.0, 1.46);
    let (_, flip) = euler(0.0, x, z);
    let outputs: Vec<f64> = (0..=100).map(|k| (f64::from(k) + 0.25) * flip).collect();
    let end = outputs[100];
    let settings = Settings { output: Output::At(outputs), ..to(IntegratorId::dop853, end, 1e-14) };
    let motion = free(&handle::Robot, &settings, &[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0], &[x, 0.0, z, 0.0, 0.0, 0.0]).unwrap();
    let (first, mut turns) = (motion.momentum_at(0).unwrap(), 0);
    for i in 1..motion.len() {
        let exact = euler(motion.t[i], x, z).0;
        let wrong = (0..3).map(|k| (motion.v_at(i)[k] - exact[k]).abs()).fold(0.0, f64::max);
        let moved = motion.momentum_at(i).unwrap().iter().zip(first).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(wrong < 1e-9 && moved < 1e-11, "flip {i}: {wrong:e} rad/s, {moved:e} N·m·s");
        turns += usize::from(i > 1 && motion.v_at(i)[1] * motion.v_at(i - 1)[1] < 0.0);
    }
    println!("{} steps, {turns} flips", motion.counts.steps);
    assert!(turns >= 99);
}

fn rotation(q: &[f64]) -> Matrix3<f64> {
    from_quaternion([q[0], q[1], q[2], q[3]])
}

#[test]
fn a_free_top_precesses_about_its_momentum() {
    let text = r#"<robot name="top"><link name="top"><inertial><mass value="1"/><inertia ixx="1.3" ixy="0" ixz="0" iyy="1.3" iyz="0" izz="2"/></inertial></link></robot>"#;
    let robot = load_bytes("top", text.as_bytes(), Base::Floating).unwrap().with_gravity([0.0; 3]);
    let (across, along, omega) = (1.3, 2.0, Vector3::new(0.4, -0.3, 2.0));
    let start = Quaternion::exp(Vector3::new(0.3, 0.5, -0.2)).to_array();
    let mut q = [0.0; 7];
    q[3..].copy_from_slice(&start);
    for integrator in [IntegratorId::dop853, IntegratorId::rodas4, IntegratorId::dopri5] {
        let tolerance = if integrator == IntegratorId::rodas4 { 1e-8 } else { 1e-12 };
        let motion = free(&robot, &to(integrator, 10.0, tolerance), &q, &[omega.x, omega.y, omega.z, 0.0, 0.0, 0.0]).unwrap();
        let last = motion.len() - 1;
        let r0 = rotation(&start);
        // ω = L/I_1 + (1 − I_3/I_1) ω_3 e_3: a turn about L in fixed axes and one about e_3 in
        // those of the body.
        let momentum = r0 * Vector3::new(across * omega.x, across * omega.y, along * omega.z);
        let exact =
            exp_rotation(momentum * (10.0 / across)) * r0 * exp_rotation(Vector3::new(0.0, 0.0, (1.0 - along / across) * omega.z * 10.0));
        let wrong = (rotation(&motion.q_at(last)[3..]) - exact).amax();
        println!("{integrator}: {wrong:e}, {} steps", motion.counts.steps);
        assert!(wrong < 300.0 * tolerance, "{integrator}: {wrong:e}");
    }
}

#[test]
fn a_spinning_top_precesses_steadily() {
    let (mass, length, across, along) = (0.5, 0.3, 0.002 + 0.5 * 0.09, 0.005);
    let (theta, spin) = (0.6_f64, 150.0_f64);
    // I_1 Ω² cos θ − I_3 ω_3 Ω + m g l = 0: the slow one.
    let (a, b, c) = (across * theta.cos(), along * spin, mass * 9.81 * length);
    let rate = 2.0 * c / (b + (b * b - 4.0 * a * c).sqrt());
    let q = Quaternion::exp(Vector3::new(theta, 0.0, 0.0)).to_array();
    let omega = rotation(&q).transpose() * Vector3::new(0.0, 0.0, rate);
    let v = [omega.x, omega.y, spin];
    let settings = Settings { output: Output::Every(0.05), ..to(IntegratorId::dop853, 2.0, 1e-13) };
    let motion = free(&top::Robot, &settings, &q, &v).unwrap();
    for i in 0..motion.len() {
        let axis = rotation(motion.q_at(i)).column(2).into_owned();
        let turned = rate * motion.t[i];
        let exact = Vector3::new(theta.sin() * turned.sin(), -theta.sin() * turned.cos(), theta.cos());
        assert!((axis - exact).amax() < 1e-10, "{}: {:e}", motion.t[i], (axis - exact).amax());
    }
    println!("{rate} rad/s, {} steps", motion.counts.steps);
}

#[test]
fn a_box_that_tumbles_keeps_energy_and_momentum_to_rounding() {
    let settings = Settings { output: Output::Every(0.1), ..stepping(IntegratorId::lie_midpoint, 20.0, 0.01) };
    let motion = free(&handle::Robot, &settings, &[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0], &[0.1, 3.0, 0.2, 0.5, -0.2, 0.1]).unwrap();
    let (energy, momentum) = (motion.kinetic[0], motion.momentum_at(0).unwrap());
    let norm = |x: &[f64]| x.iter().map(|x| x * x).sum::<f64>().sqrt();
    for i in 0..motion.len() {
        let lost = (motion.kinetic[i] / energy - 1.0).abs();
        let moved: Vec<f64> = motion.momentum_at(i).unwrap().iter().zip(momentum).map(|(a, b)| a - b).collect();
        assert!(lost < 1e-13 && norm(&moved) < 1e-13 * norm(momentum), "{i}: {lost:e} {:e}", norm(&moved) / norm(momentum));
        // The norm of a quaternion is one to 4u.
        let size = norm(&motion.q_at(i)[3..]);
        assert!((size - 1.0).abs() <= 2.0 * f64::EPSILON, "{size}");
    }
}

/// About a frame that is not at the centre, too.
#[test]
fn a_box_about_any_frame_keeps_them_as_well() {
    let text = r#"<robot name="box"><link name="box"><inertial><origin xyz="0.3 -0.2 0.1"/><mass value="2"/>
        <inertia ixx="1" ixy="0.1" ixz="0" iyy="1.5" iyz="0" izz="0.8"/></inertial></link></robot>"#;
    let robot = load_bytes("box", text.as_bytes(), Base::Floating).unwrap().with_gravity([0.0; 3]);
    let settings = stepping(IntegratorId::lie_midpoint, 4.0, 0.02);
    let motion = free(&robot, &settings, &[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0], &[0.5, 3.0, -0.7, 0.5, -0.2, 0.1]).unwrap();
    let (last, norm) = (motion.len() - 1, |x: &[f64]| x.iter().map(|x| x * x).sum::<f64>().sqrt());
    let moved: Vec<f64> = motion.momentum_at(last).unwrap().iter().zip(motion.momentum_at(0).unwrap()).map(|(a, b)| a - b).collect();
    assert!((motion.kinetic[last] / motion.kinetic[0] - 1.0).abs() < 1e-13 && norm(&moved) < 1e-12);
    // Angular momentum about the origin too: the centre moves along a straight line.
    let centre = |i: usize| {
        let mut c = [0.0; 3];
        robot.center_of_mass(&mut robot.workspace(), motion.q_at(i), &mut c).unwrap();
        Vector3::from(c)
    };
    let (way, momentum) = (centre(last) - centre(0), motion.momentum_at(0).unwrap());
    let aside = way.cross(&Vector3::new(momentum[3], momentum[4], momentum[5])).norm();
    println!("{aside:e} of {}", way.norm());
    assert!(way.norm() > 1.0 && aside < 1e-12);
}
