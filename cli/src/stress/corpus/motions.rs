//! Motions: stiff effects, long runs, frequencies, and a pendulum that stands on its head.

use articulated::simulate::{IntegratorId, NoTorque, Output, Recording, Settings, SimulateError, Simulation};
use articulated_core::algorithm::FunctionId;
use articulated_core::algorithm::checked::Factor;
use articulated_core::description::{Base, JointKind, Origin};
use articulated_core::effect::{Applied, EffectId};
use articulated_core::model::Model;

use super::Effort;
use crate::states::SplitMix64;
use crate::stress::judge::call;
use crate::stress::robots::{Body, Builder, built, chain, normalise};
use crate::stress::row::{Case, Row};

pub(super) const NAME: &str = "motions";

pub(super) fn rows(effort: Effort) -> Vec<Row> {
    let mut rows = damping();
    rows.extend(at_rest());
    rows.extend(long(effort));
    rows.extend(frequency(effort));
    rows.extend(kapitza());
    rows
}

/// A kilogram that slides upward, at rest at the height `q` of its centre.
fn slider(effect: EffectId, on_link: bool, parameters: Vec<f64>, weight: bool) -> Model<f64> {
    let body = Some(Body::of_radii(1.0, [0.0; 3], [0.1; 3]));
    let robot = Builder::new("slider").link(None, JointKind::Prismatic, [0.0, 0.0, 1.0], Origin::default(), body).model();
    let robot = if weight { robot } else { robot.with_gravity([0.0; 3]) };
    let on = if on_link { "link_1" } else { "joint_1" }.to_owned();
    robot.with_effects(&[Applied { effect, on, at: Origin::default(), parameters }]).expect("parameters that the effect takes")
}

fn run(robot: &Model<f64>, settings: Settings, q: f64, v: f64) -> Result<Recording, SimulateError> {
    Simulation::new(robot, settings)?.run(&[q], &[v], &mut NoTorque, &mut [])
}

fn implicit(end: f64, step: Option<f64>) -> Settings {
    let (integrator, output) = (IntegratorId::rodas4, Output::Steps);
    Settings { integrator, end, step, output, rtol: 1e-8, atol: 1e-12, ..Settings::default() }
}

/// How often a sequence changes its sign; what has died away has none.
fn flips(v: &[f64]) -> f64 {
    v.windows(2).filter(|w| w[0] * w[1] < 0.0 && w[1].abs() > 1e-12).count() as f64
}

/// v̇ = −d v, d·h from 0.1 to 1e6.
fn damping() -> Vec<Row> {
    let case = Case::new(
        NAME,
        "damping with h·d/m from 0.1 to 1e6",
        "an explicit step beyond 2…6 overshoots zero and grows; an implicit one has to decay as the motion does",
    );
    let h = 0.01;
    let (mut changes, mut end, mut refused) = (0.0, 0.0_f64, true);
    for power in 0..=14 {
        let z = 0.1 * 10.0_f64.powf(f64::from(power) / 2.0);
        let robot = slider(EffectId::damping, false, vec![z / h], false);
        match run(&robot, implicit(1.0, Some(h)), 0.0, 1.0) {
            Ok(motion) => {
                changes += flips(&motion.v);
                end = end.max((motion.q[motion.q.len() - 1] * z / h - 1.0).abs());
            }
            Err(_) => end = f64::NAN,
        }
        let explicit = run(&robot, Settings { integrator: IntegratorId::rk4, ..implicit(1.0, Some(h)) }, 0.0, 1.0);
        refused &= match explicit {
            // Runge and Kutta's method is stable up to 2.785.
            Err(SimulateError::Unstable { admissible, .. }) => z > 2.7 && (admissible * z / h / 2.785 - 1.0).abs() < 0.02,
            Ok(_) => z < 2.8,
            Err(_) => false,
        };
    }
    vec![
        case.row("rodas4: changes of sign of the velocity", changes, 0.0, ""),
        case.row("rodas4: way in all, over v₀·m/d, off from 1", end, 1e-3, ""),
        case.holds("rk4 refuses where it is unstable, with the step that it can take", refused),
    ]
}

/// Limits, friction and contact, where they come to rest.
fn at_rest() -> Vec<Row> {
    let mut rows = Vec::new();
    let stop = Case::new(NAME, "a weight on a joint limit of 1e9 N/m", "periods of a fifth of a millisecond in a motion of seconds");
    let robot = slider(EffectId::limit, false, vec![0.0, 1.0, 1e9, 1e4], true);
    match run(&robot, implicit(0.1, None), 1e-4, 0.0) {
        Ok(m) => {
            let depth = -m.q[m.q.len() - 1];
            rows.push(stop.row("rodas4: depth at rest over m g/k, off from 1", (depth * 1e9 / 9.81 - 1.0).abs(), 1e-3, ""));
        }
        Err(error) => rows.push(stop.holds(format!("rodas4: {error}"), false)),
    }

    let case = Case::new(NAME, "Coulomb friction that comes to rest", "the force jumps from one side to the other at v = 0");
    let robot = slider(EffectId::friction, false, vec![1.0, 1e-3], false);
    match run(&robot, implicit(2.0, None), 0.0, 1.0) {
        Ok(m) => {
            let last = m.q.len() - 1;
            rows.push(case.row("rodas4: changes of sign of the velocity", flips(&m.v), 0.0, ""));
            // It stops after 1 s and v²/(2μ/m) m, and a little for the smooth part of the law.
            rows.push(case.row("rodas4: way off from v²/(2μ)", (m.q[last] - 0.5).abs(), 1e-5, "m"));
            rows.push(case.row("rodas4: velocity at the end", m.v[last].abs(), 1e-9, "m/s"));
        }
        Err(error) => rows.push(case.holds(format!("rodas4: {error}"), false)),
    }

    let case = Case::new(NAME, "a ball that falls on the ground and lies there", "contact is nothing, then 1e6 N/m, then at rest");
    let robot = slider(EffectId::contact, true, vec![0.1, 1e6, 50.0, 0.5, 1e-2, 0.0, 0.0, 1.0, 0.0], true);
    let rest = 0.1 - 9.81e-6;
    let found = run(&robot, implicit(1.0, None), 0.11, 0.0).map_or(f64::NAN, |m| (m.q[m.q.len() - 1] - rest).abs());
    rows.push(case.row("rodas4: height at the end off from that at rest", found, 1e-4, "m"));
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
        let options = articulated_urdf::Options { base: bundled.base, ..articulated_urdf::Options::default() };
        let Ok(reading) = articulated_urdf::read(bundled.urdf.as_bytes(), &options) else { continue };
        let robot = built(&reading.description, bundled.base);
        rows.push(case.row("dop853, rtol 1e-9: change of T + U over the largest T", drift(&robot, end), 1e-6, ""));
    }
    rows
}

fn drift(robot: &Model<f64>, end: f64) -> f64 {
    let mut random = SplitMix64::new(91);
    let mut q: Vec<f64> = (0..robot.nq).map(|_| random.uniform(-1.0, 1.0)).collect();
    crate::states::quaternions(robot).for_each(|(_, at)| normalise(&mut q[at..at + 4]));
    let v: Vec<f64> = (0..robot.nv).map(|_| random.uniform(-1.0, 1.0)).collect();
    let settings =
        Settings { integrator: IntegratorId::dop853, end, rtol: 1e-9, atol: 1e-9, output: Output::Every(0.1), ..Settings::default() };
    let motion = Simulation::new(robot, settings).and_then(|mut s| s.run(&q, &v, &mut NoTorque, &mut []));
    let Ok(motion) = motion else { return f64::NAN };
    let largest = motion.kinetic.iter().copied().fold(0.0, f64::max);
    (0..motion.len()).filter_map(|i| motion.imbalance(i)).map(f64::abs).fold(0.0, f64::max) / largest
}

/// The first frequency of a chain that hangs: j₀,₁/2·√(g/l), j₀,₁ the first zero of J₀, and with N rods a little more.
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

/// By inverse iteration: K⁻¹ M of the chain at rest, K from differences of no kind: ∂(static torque)/∂q.
fn first_frequency(n: usize) -> f64 {
    let robot = built(&chain(n, 1.0), Base::Fixed).with_gravity([9.81, 0.0, 0.0]);
    let q = vec![0.0; n];
    let m = call(FunctionId::mass_matrix, &robot, std::slice::from_ref(&q));
    let k = call(FunctionId::static_torque_derivative, &robot, &[q, vec![0.0; 6 * robot.frames.len()]]);
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

/// Kapitza's pendulum: a pendulum stands upright on a pivot that shakes if (aω)² > 2gl.
fn kapitza() -> Vec<Row> {
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
    let leans = |ratio: f64| {
        let (a, g) = (0.05, 9.81);
        let omega = (ratio * 2.0 * g).sqrt() / a;
        // The pivot, of 1e6 times the mass, follows a cos ωt.
        let mut shake = |t: f64, _: &[f64], _: &[f64], tau: &mut [f64]| tau[0] = (1e6 + 1.0) * (g - a * omega * omega * (omega * t).cos());
        let settings = Settings { end: 4.0, rtol: 1e-7, atol: 1e-9, output: Output::Every(0.02), ..Settings::default() };
        let motion = Simulation::new(&robot, settings).and_then(|mut s| s.run(&[a, 0.05], &[0.0, 0.0], &mut shake, &mut []));
        motion.map_or(f64::NAN, |m| (0..m.len()).map(|i| m.q_at(i)[1].abs()).fold(0.0, f64::max))
    };
    vec![
        case.row("1.2 times the limit: largest lean", leans(1.2), 0.5, "rad"),
        case.between("0.8 times the limit: largest lean", leans(0.8), [1.0, f64::MAX], "rad"),
    ]
}
