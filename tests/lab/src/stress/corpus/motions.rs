//! Motions: long runs, frequencies, and an inverted pendulum.

use articulated::simulate::{Integrator, IntegratorId, NoTorque, Output, Recording, Settings, Simulation, integrators};
use articulated_core::algorithm::FunctionId;
use articulated_core::algorithm::checked::Factor;
use articulated_core::description::{Base, JointKind, Origin};
use articulated_core::model::Model;

use super::Effort;
use crate::residual::worse;
use crate::states::SplitMix64;
use crate::stress::judge::call;
use crate::stress::robots::{Body, Builder, built, chain, normalise};
use crate::stress::row::{Case, Row};

pub(super) const NAME: &str = "motions";

pub(super) fn rows(effort: Effort) -> Vec<Row> {
    let mut rows = long(effort);
    rows.extend(kept(effort));
    rows.extend(frequency(effort));
    rows.extend(kapitza(effort));
    rows
}

/// Ten seconds without damping.
fn long(effort: Effort) -> Vec<Row> {
    let (end, robots): (f64, usize) = if effort == Effort::Full { (10.0, usize::MAX) } else { (2.0, 3) };
    let mut rows = Vec::new();
    for bundled in articulated_models::ROBOTS.iter().take(robots) {
        let case = Case::new(
            NAME,
            format!("{} moving freely for {end} s", bundled.name),
            "nothing takes energy away, and errors of it add up; motions are chaotic",
        );
        let options = articulated_formats::Options { base: bundled.base, ..articulated_formats::Options::default() };
        let Ok(reading) = articulated_formats::read(bundled.urdf.as_bytes(), &options) else { continue };
        let robot = built(&reading.description, bundled.base);
        for row in integrators().iter().filter(|row| row.adaptive) {
            rows.push(case.row(
                format!("{}, rtol 1e-9: change of T + U over the largest T", row.name),
                drift(&robot, row.id, end),
                1e-6,
                "",
            ));
        }
    }
    rows
}

fn drift(robot: &Model<f64>, integrator: IntegratorId, end: f64) -> f64 {
    let mut random = SplitMix64::new(91);
    let mut q: Vec<f64> = (0..robot.nq()).map(|_| random.uniform(-1.0, 1.0)).collect();
    crate::states::quaternions(robot).for_each(|(_, at)| normalise(&mut q[at..at + 4]));
    let v: Vec<f64> = (0..robot.nv()).map(|_| random.uniform(-1.0, 1.0)).collect();
    let settings = Settings { integrator, end, rtol: 1e-9, atol: 1e-9, output: Output::Every(0.1), ..Settings::default() };
    let motion = Simulation::new(robot, settings).and_then(|s| s.with_energy_balance().run(&q, &v, &mut NoTorque, &mut []));
    let Ok(motion) = motion else { return f64::NAN };
    unbalanced(&motion)
}

/// The largest change of T + U over the largest T.
fn unbalanced(motion: &Recording) -> f64 {
    let largest = motion.kinetic.iter().copied().fold(0.0, f64::max);
    (0..motion.len()).filter_map(|i| motion.imbalance(i)).map(f64::abs).fold(0.0, worse) / largest
}

/// The purpose of fixed steps: no drift in long runs.
fn kept(effort: Effort) -> Vec<Row> {
    let end = if effort == Effort::Full { 100.0 } else { 10.0 };
    let run = |robot: &Model<f64>, integrator, step, q: &[f64], v: &[f64]| {
        let settings = Settings { integrator, end, step: Some(step), output: Output::Steps, ..Settings::default() };
        Simulation::new(robot, settings).and_then(|s| s.with_energy_balance().run(q, v, &mut NoTorque, &mut []))
    };
    let case = Case::new(
        NAME,
        format!("a body that tumbles about its middle axis for {end} s"),
        "its turn is unstable: an error that favours one direction grows into another motion",
    );
    let body = Some(Body::of_radii(1.0, [0.0; 3], [0.1, 0.2, 0.3]));
    let robot =
        Builder::new("body").link(None, JointKind::Floating, [0.0, 0.0, 1.0], Origin::default(), body).model().with_gravity([0.0; 3]);
    let tumbling = run(&robot, IntegratorId::lie_midpoint, 0.01, &[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0], &[1e-3, 3.0, 0.0, 0.1, 0.0, 0.2]);
    let (energy, momentum) = tumbling.map_or((f64::NAN, f64::NAN), |m| (unbalanced(&m), turned(&robot, &m)));
    // Each step is solved down to a rounding or two, which add up as a walk does.
    let roundings = f64::EPSILON * (end / 0.01_f64).sqrt();
    let mut rows = vec![
        case.row("lie_midpoint, steps of 0.01 s: change of T over T, in roundings of a step times √steps", energy / roundings, 8.0, ""),
        case.row("the same, momentum in fixed axes", momentum / roundings, 8.0, ""),
    ];
    let case =
        Case::new(NAME, format!("a pendulum that swings by 1 rad for {end} s"), "what is lost in each swing adds up, whatever the order");
    let robot = Builder::new("pendulum").turn([0.0, 1.0, 0.0], [0.0; 3], Some(Body::of_radii(1.0, [0.0, 0.0, -1.0], [1e-3; 3]))).model();
    for (integrator, step) in [(IntegratorId::semi_implicit_euler, 1e-3), (IntegratorId::lie_midpoint, 0.01), (IntegratorId::rk4, 0.01)] {
        let motion = run(&robot, integrator, step, &[1.0], &[0.0]);
        let growth = motion.map_or(f64::NAN, |m| {
            let part = |from: usize, to: usize| {
                (m.len() * from / 4..m.len() * to / 4).filter_map(|i| m.imbalance(i)).map(f64::abs).fold(0.0, worse)
            };
            part(3, 4) / part(0, 1)
        });
        let name = format!("{integrator}, steps of {step} s: change of T + U in the last quarter over that in the first");
        // The Runge-Kutta method does drift: shown for comparison with the two that do not.
        rows.push(if integrator == IntegratorId::rk4 { case.shown(name, growth, "") } else { case.row(name, growth, 1.01, "") });
    }
    rows
}

/// The largest change of the momentum about and along fixed axes, over its size.
fn turned(robot: &Model<f64>, motion: &Recording) -> f64 {
    let at = |i: usize| call(FunctionId::centroidal_momentum, robot, &[motion.q_at(i).to_vec(), motion.v_at(i).to_vec()]);
    let first = at(0);
    let part = |x: &[f64], k: usize| x[k..k + 3].iter().zip(&first[k..k + 3]).map(|(x, y)| (x - y).powi(2)).sum::<f64>().sqrt();
    let size = |k: usize| first[k..k + 3].iter().map(|x| x * x).sum::<f64>().sqrt();
    (0..motion.len()).map(at).map(|x| worse(part(&x, 0) / size(0), part(&x, 3) / size(3))).fold(0.0, worse)
}

/// The first frequency of a hanging chain: j₀,₁/2·√(g/l), j₀,₁ the first zero of J₀; with N rods it
/// is a little higher.
fn frequency(effort: Effort) -> Vec<Row> {
    let lengths: &[usize] = if effort == Effort::Full { &[30, 60, 100, 200, 300] } else { &[30, 60] };
    let case = Case::new(
        NAME,
        "first frequency of a hanging chain of N rods",
        "of a mass matrix and a stiffness that both lose digits as N⁴ a small eigenvalue is asked for",
    );
    let limit = 2.404_825_557_695_773 / 2.0;
    let one = |&n: &usize| {
        let (n2, omega) = ((n * n) as f64, first_frequency(n) / ((9.81 / n as f64).sqrt() * limit));
        case.between(format!("N = {n}: (ω/ω_∞ − 1)·N² over 0.0307"), (omega - 1.0) * n2 / 0.0307, [0.98, 1.02], "")
    };
    lengths.iter().map(one).collect()
}

/// By inverse iteration: K⁻¹ M of the chain at rest, K from differences of no kind: ∂(static
/// torque)/∂q.
fn first_frequency(n: usize) -> f64 {
    let robot = built(&chain(n, 1.0), Base::Fixed).with_gravity([9.81, 0.0, 0.0]);
    let q = vec![0.0; n];
    let m = call(FunctionId::mass_matrix, &robot, std::slice::from_ref(&q));
    let k = call(FunctionId::static_torque_derivative, &robot, &[q, vec![0.0; 6 * robot.frames().len()]]);
    let mut factor = Factor::<f64>::new(n);
    if factor.factor(&k).is_err() {
        return f64::NAN;
    }
    let mut x = vec![1.0 / n as f64; n];
    let mut value = 0.0;
    for _ in 0..25 {
        let mut y: Vec<f64> = (0..n).map(|i| m[i * n..][..n].iter().zip(&x).map(|(m, x)| m * x).sum()).collect();
        let before: f64 = x.iter().zip(&y).map(|(x, y)| x * y).sum();
        factor.solve(&mut y);
        // xᵀMx over xᵀKx of the next x: Rayleigh's quotient of the last two.
        let my: f64 = (0..n).map(|i| y[i] * m[i * n..][..n].iter().zip(&x).map(|(m, x)| m * x).sum::<f64>()).sum();
        value = before / my;
        let size = y.iter().map(|y| y * y).sum::<f64>().sqrt();
        x = y.iter().map(|y| y / size).collect();
    }
    value.sqrt()
}

/// Kapitza's pendulum: a pendulum is stable upright on a pivot that shakes if (aω)² > 2gl.
fn kapitza(effort: Effort) -> Vec<Row> {
    let case = Case::new(
        NAME,
        "a pendulum upright on a shaking pivot, (aω)² against 2 g l",
        "an integrator that damps or drives makes the wrong side stable",
    );
    let body = |m: f64, c: f64| Some(Body::of_radii(m, [0.0, 0.0, c], [1e-3; 3]));
    let robot = Builder::new("kapitza")
        .link(None, JointKind::Prismatic, [0.0, 0.0, 1.0], Origin::default(), body(1e6, 0.0))
        .turn([0.0, 1.0, 0.0], [0.0; 3], body(1.0, 1.0))
        .model();
    let leans = |row: &Integrator, ratio: f64| {
        let (a, g) = (0.05, 9.81);
        let omega = (ratio * 2.0 * g).sqrt() / a;
        // The pivot, of 1e6 times the mass, follows a cos ωt.
        let mut shake = |t: f64, _: &[f64], _: &[f64], tau: &mut [f64]| tau[0] = (1e6 + 1.0) * (g - a * omega * omega * (omega * t).cos());
        // A period of the pivot is 0.06 s.
        let step = (!row.adaptive).then_some(1e-3);
        let settings =
            Settings { integrator: row.id, end: 4.0, step, rtol: 1e-7, atol: 1e-9, output: Output::Every(0.02), ..Settings::default() };
        let motion = Simulation::new(&robot, settings).and_then(|mut s| s.run(&[a, 0.05], &[0.0, 0.0], &mut shake, &mut []));
        motion.map_or(f64::NAN, |m| (0..m.len()).map(|i| m.q_at(i)[1].abs()).fold(0.0, f64::max))
    };
    let both = |row: &Integrator| {
        let name = |ratio: f64| format!("{}, {ratio} times the limit: largest lean", row.name);
        [case.row(name(1.2), leans(row, 1.2), 0.5, "rad"), case.between(name(0.8), leans(row, 0.8), [1.0, f64::MAX], "rad")]
    };
    // The others take a minute.
    let quick = [IntegratorId::dopri5, IntegratorId::semi_implicit_euler, IntegratorId::lie_midpoint];
    integrators().iter().filter(|row| effort == Effort::Full || quick.contains(&row.id)).flat_map(both).collect()
}
