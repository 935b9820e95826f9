//! Each integrator has its order, on plain coordinates and where some are quaternions.

use articulated::simulate::{IntegratorId, NoTorque, Output, Recording, Settings, Simulation, integrators};
use articulated::{Base, Dynamics};

use crate::robots::{apart, chain, model, satellite, slider, stepping, to};

/// Driven by torques that depend on time and state, so that every derivative counts.
fn driven<R: Dynamics<f64>>(robot: &R, settings: articulated::simulate::Settings, q: &[f64], v: &[f64]) -> Recording {
    let mut control = |t: f64, q: &[f64], v: &[f64], tau: &mut [f64]| {
        let last = q.len() - 1;
        for (i, tau) in tau.iter_mut().enumerate() {
            *tau = 0.02 * (3.0 * t + i as f64).sin() - 0.01 * v[i] + 0.01 * q[last];
        }
    };
    Simulation::new(robot, settings).unwrap().run(q, v, &mut control, &mut []).unwrap()
}

/// Steps of the coarsest run; each next one has 1.5 times as many.
fn coarsest(id: IntegratorId) -> u32 {
    match id {
        IntegratorId::semi_implicit_euler => 800,
        IntegratorId::rk4 => 40,
        IntegratorId::dopri5 => 90,
        IntegratorId::dop853 => 18,
        IntegratorId::rodas4 => 40,
        IntegratorId::lie_midpoint => 100,
    }
}

fn slopes<R: Dynamics<f64>>(robot: &R, q: &[f64], v: &[f64], end: f64, derivatives: bool) {
    let exact = driven(robot, to(IntegratorId::dop853, end, 1e-14), q, v);
    for row in integrators().iter().filter(|row| (row.id == IntegratorId::rodas4) == derivatives) {
        let points: Vec<(f64, f64)> = (0..4)
            .map(|k| {
                let steps = (f64::from(coarsest(row.id)) * 1.5_f64.powi(k)).round();
                let motion = driven(robot, stepping(row.id, end, end / steps), q, v);
                assert_eq!(motion.counts.steps, steps as u64);
                // An implicit step that is solved to rounding takes fewer rounds the shorter it is:
                // there the cost is the number of steps.
                let cost = if row.id == IntegratorId::lie_midpoint { motion.counts.steps } else { motion.counts.evaluations };
                ((cost as f64).ln(), apart(robot, &exact, &motion).ln())
            })
            .collect();
        let slope = fitted(&points);
        let errors: Vec<String> = points.iter().map(|p| format!("{:.1e}", p.1.exp())).collect();
        println!("{}: {slope:.2}, {}", row.name, errors.join(" "));
        assert!((slope + f64::from(row.order)).abs() < 0.2, "{}", row.name);
    }
}

/// Slope of the line nearest to the points.
fn fitted(points: &[(f64, f64)]) -> f64 {
    let n = points.len() as f64;
    let (x, y) = points.iter().fold((0.0, 0.0), |(x, y), p| (x + p.0 / n, y + p.1 / n));
    let (up, down) = points.iter().fold((0.0, 0.0), |(up, down), p| (up + (p.0 - x) * (p.1 - y), down + (p.0 - x) * (p.0 - x)));
    up / down
}

#[test]
fn errors_on_a_chain_fall_with_the_order() {
    slopes(&chain::Robot, &[0.4, -0.7, 0.5], &[1.0, 0.5, -1.5], 1.0, false);
    slopes(&chain::Robot, &[0.4, -0.7, 0.5], &[1.0, 0.5, -1.5], 1.0, true);
}

#[test]
fn errors_on_a_floating_robot_with_a_ball_joint_fall_with_the_order() {
    let q = [0.3, -0.2, 0.5, 0.5, -0.5, 0.5, 0.5, 0.7, 0.1, 0.7, -0.1, 0.7];
    let v = [1.8, -1.5, 2.0, 0.3, -0.2, 0.5, 0.4, 0.1, -0.1, 0.1];
    slopes(&satellite::Robot, &q, &v, 1.0, false);
    // Derivatives of ten degrees of freedom are long to compile.
    slopes(&model("satellite", Base::Floating), &q, &v, 1.0, true);
}

/// Their tables are written by hand, since they contain more.
#[test]
fn the_manuals_name_every_integrator_with_its_order() {
    for (file, text) in
        [("simulation.md", include_str!("../../../docs/simulation.md")), ("accuracy.md", include_str!("../../../docs/accuracy.md"))]
    {
        let rows = integrators().iter().map(|row| (row.name, row.order));
        let named = |name: &str, order: u32| text.lines().any(|line| line.starts_with(&format!("| `{name}` | {order}")));
        let missing: Vec<&str> = rows.filter(|(name, order)| !named(name, *order)).map(|(name, _)| name).collect();
        assert!(missing.is_empty(), "docs/{file}: {missing:?}");
    }
}

/// Hairer, Nørsett & Wanner 1993, §II.4, by hand, for an undriven body of 1 kg: with d_0 = |y|, d_1
/// = |f| in units of the tolerances h_0 = 0.01 d_0/d_1, and the step is (0.01/d_1)^(1/6), 100 h_0
/// at most; 1e-6 s at rest.
#[test]
fn a_first_step_is_estimated_by_the_rates() {
    let first = |(rtol, atol): (f64, f64), q: f64, v: f64| {
        let settings = Settings { rtol, atol, output: Output::Steps, ..to(IntegratorId::dopri5, 10.0, 1e-6) };
        Simulation::new(&slider(), settings).unwrap().run(&[q], &[v], &mut NoTorque, &mut []).unwrap().t[1]
    };
    let relative = first((1e-6, 0.0), 1.0, 1.0);
    assert!((relative / (0.01 / (1e6 * 0.5_f64.sqrt())).powf(1.0 / 6.0) - 1.0).abs() < 1e-12, "{relative} s");
    let absolute = first((0.0, 1.0), 0.0, 1e-3);
    assert!((absolute - 1.0).abs() < 1e-12, "{absolute} s");
    assert_eq!([first((1e-6, 1e-6), 0.0, 0.0), first((1e-6, 0.0), 0.0, 0.0)], [1e-6; 2]);
}
