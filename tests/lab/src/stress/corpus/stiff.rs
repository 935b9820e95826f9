//! Stiff effects: implicit integrators decay like the motion, explicit ones refuse and report their
//! stable step.

use articulated::simulate::{IntegratorId, NoTorque, Output, Recording, Settings, SimulateError, Simulation, integrators};
use articulated_core::description::{JointKind, Origin};
use articulated_core::effect::{Applied, EffectId};
use articulated_core::model::Model;

use super::Effort;
use crate::residual::worse;
use crate::stress::robots::{Body, Builder};
use crate::stress::row::{Case, Row};

pub(super) const NAME: &str = "stiff";

pub(super) fn rows(_: Effort) -> Vec<Row> {
    let mut rows = damping();
    rows.extend(limit());
    rows.extend(friction());
    rows.extend(contact());
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

/// A slider, its start, and its expected end.
struct Motion {
    robot: Model<f64>,
    q: f64,
    v: f64,
    end: f64,
    /// Place at the end, m.
    rest: f64,
    /// Tolerated distance from it, m.
    near: f64,
}

impl Motion {
    /// `step`: `None` for steps chosen by tolerances.
    fn run(&self, integrator: IntegratorId, step: Option<f64>) -> Result<Recording, SimulateError> {
        let settings = Settings { integrator, end: self.end, step, output: Output::Steps, rtol: 1e-8, atol: 1e-12, ..Settings::default() };
        Simulation::new(&self.robot, settings)?.run(&[self.q], &[self.v], &mut NoTorque, &mut [])
    }

    /// Distance of a motion's end from its rest, m.
    fn off(&self, motion: &Recording) -> f64 {
        (motion.q[motion.q.len() - 1] - self.rest).abs()
    }

    /// rodas4, which is L-stable: no change of sign, and the right limit.
    fn decays(&self, case: &Case, step: Option<f64>, most: f64) -> Vec<Row> {
        let name = step.map_or("rodas4".to_owned(), |h| format!("rodas4, steps of {h} s"));
        match self.run(IntegratorId::rodas4, step) {
            Ok(motion) => vec![
                case.row(format!("{name}: changes of sign of the velocity"), flips(&motion.v), most, ""),
                case.row(format!("{name}: place at the end off from that at rest"), self.off(&motion), self.near, "m"),
            ],
            Err(error) => vec![case.holds(format!("{name}: {error}"), false)],
        }
    }

    /// Every explicit integrator refuses these steps and reports its stable step; with three tenths
    /// of that, since a force that bends within a step differs from its tangent, it comes to rest
    /// in the right place.
    fn refused(&self, case: &Case, step: f64) -> Vec<Row> {
        explicit()
            .map(|integrator| {
                let (mut h, mut found) = (step, Vec::new());
                let off = loop {
                    match self.run(integrator, Some(h)) {
                        Ok(motion) => break self.off(&motion),
                        // On its way it may get stiffer than at the refusal.
                        Err(SimulateError::Unstable { admissible, .. }) if admissible < h && found.len() < 3 => {
                            found.push(admissible);
                            h = 0.3 * admissible;
                        }
                        Err(_) => break f64::NAN,
                    }
                };
                let off = if found.is_empty() { f64::NAN } else { off };
                let name = format!(
                    "{integrator} refuses steps of {step} s; with 0.3 of those that it says are stable: place at the end off from that at rest"
                );
                // Of order 1 in a motion of one second.
            let near = if integrator.row().order == 1 { self.near.max(h * self.v) } else { self.near };
            case.row(name, off, near, "m")
            })
            .collect()
    }
}

fn explicit() -> impl Iterator<Item = IntegratorId> {
    integrators().iter().filter(|row| !row.implicit).map(|row| row.id)
}

/// Number of sign changes of a sequence, without those of numbers that have decayed.
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
    // It slides v₀·m/d in all.
    let motions: Vec<(f64, Motion)> = (0..=14)
        .map(|power| {
            let z = 0.1 * 10.0_f64.powf(f64::from(power) / 2.0);
            let robot = slider(EffectId::damping, false, vec![z / h], false);
            (z, Motion { robot, q: 0.0, v: 1.0, end: 1.0, rest: h / z, near: 1e-3 * h / z })
        })
        .collect();
    let (mut changes, mut off) = (0.0, 0.0_f64);
    for (z, motion) in &motions {
        match motion.run(IntegratorId::rodas4, Some(h)) {
            Ok(m) => (changes, off) = (changes + flips(&m.v), worse(motion.off(&m) * z / h, off)),
            Err(_) => off = f64::NAN,
        }
    }
    let mut rows = vec![
        case.row("rodas4: changes of sign of the velocity", changes, 0.0, ""),
        case.row("rodas4: way in all, over v₀·m/d, off from 1", off, 1e-3, ""),
    ];
    for integrator in explicit() {
        let right = motions.iter().all(|(z, motion)| refuses_beyond(integrator, *z, h, motion));
        rows.push(case.holds(format!("{integrator} refuses where it is unstable, with the step that it can take"), right));
    }
    // Its equations are solved by iteration, which converges up to h·d/m = 2, and up to 1.6 within
    // its rounds; up to there the midpoint rule has no change of sign.
    let midpoint = |(z, motion): &(f64, Motion)| match motion.run(IntegratorId::lie_midpoint, Some(h)) {
        Ok(m) => flips(&m.v) == 0.0 && motion.off(&m) * z / h < 1e-3,
        Err(SimulateError::NoConvergence { .. }) => *z > 1.6,
        Err(_) => false,
    };
    rows.push(
        case.holds("lie_midpoint decays without change of sign, or says that it cannot solve its equations", motions.iter().all(midpoint)),
    );
    rows
}

/// Whether a step of h·d/m = z is refused exactly if it is unstable, with the longest stable step.
fn refuses_beyond(integrator: IntegratorId, z: f64, h: f64, motion: &Motion) -> bool {
    // The largest z with |R(−z)| ≤ 1.
    let limit = match integrator {
        IntegratorId::semi_implicit_euler => 2.0,
        IntegratorId::rk4 => 2.785,
        IntegratorId::dopri5 => 3.307,
        IntegratorId::dop853 => 6.394,
        IntegratorId::rodas4 | IntegratorId::lie_midpoint => f64::INFINITY,
    };
    match motion.run(integrator, Some(h)) {
        Err(SimulateError::Unstable { admissible, .. }) => z > 0.98 * limit && (admissible * z / h / limit - 1.0).abs() < 0.02,
        Ok(_) => z < 1.02 * limit,
        Err(_) => false,
    }
}

/// Of 1e9 N/m, fallen on and lain on.
fn limit() -> Vec<Row> {
    let case = Case::new(NAME, "a weight on a joint limit of 1e9 N/m", "periods of a fifth of a millisecond in a motion of seconds");
    let rest = -9.81e-9;
    let robot = slider(EffectId::limit, false, vec![0.0, 1.0, 1e9, 1e4], true);
    let falls = Motion { robot: robot.clone(), q: 1e-4, v: 0.0, end: 0.1, rest, near: 1e-11 };
    let mut rows: Vec<Row> = falls.decays(&case, None, 0.0).split_off(1);
    let case = Case::new(
        NAME,
        "a weight let go in a joint limit of 1e9 N/m",
        "a step of a millisecond is five periods of the spring, and a hundred of its damping",
    );
    let lies = Motion { robot, q: -2e-8, v: 0.0, end: 0.02, rest, near: 1e-11 };
    rows.extend(lies.decays(&case, Some(1e-3), 0.0));
    rows.extend(lies.refused(&case, 1e-3));
    rows
}

fn friction() -> Vec<Row> {
    let case = Case::new(NAME, "Coulomb friction that comes to rest", "the force jumps from one side to the other at v = 0");
    // It stops after 1 s and v²/(2μ/m) m, and a little for the smooth part of the law.
    let robot = slider(EffectId::friction, false, vec![1.0, 1e-3], false);
    let motion = Motion { robot, q: 0.0, v: 1.0, end: 2.0, rest: 0.5, near: 1e-5 };
    let mut rows = motion.decays(&case, None, 0.0);
    let speed = motion.run(IntegratorId::rodas4, None).map_or(f64::NAN, |m| m.v[m.v.len() - 1].abs());
    rows.push(case.row("rodas4: velocity at the end", speed, 1e-9, "m/s"));
    // The step that ends the slide takes the force from before it, overshoots once into where the
    // law is smooth, and decays.
    rows.extend(motion.decays(&case, Some(0.01), 1.0));
    let back = motion.run(IntegratorId::rodas4, Some(0.01)).map_or(f64::NAN, |m| -m.v.iter().copied().fold(0.0, f64::min));
    rows.push(case.row("rodas4, steps of 0.01 s: velocity backward, of that below which the law is smooth", back / 1e-3, 1.0, ""));
    rows.extend(motion.refused(&case, 0.01));
    rows
}

fn contact() -> Vec<Row> {
    let rest = 0.1 - 9.81e-6;
    let ground = |damping: f64| slider(EffectId::contact, true, vec![0.1, 1e6, damping, 0.5, 1e-2, 0.0, 0.0, 1.0, 0.0, 0.0], true);
    let case = Case::new(NAME, "a ball that falls on the ground and lies there", "contact is nothing, then 1e6 N/m, then at rest");
    let falls = Motion { robot: ground(50.0), q: 0.11, v: 0.0, end: 1.0, rest, near: 1e-4 };
    let mut rows = falls.decays(&case, None, 0.0).split_off(1);
    let case = Case::new(
        NAME,
        "a ball pressed into the ground and let go",
        "ten milliseconds are a period and a half of a contact of 1e6 N/m, and fifty of its damping",
    );
    let lies = Motion { robot: ground(500.0), q: 0.1 - 2e-5, v: 0.0, end: 0.2, rest, near: 1e-9 };
    rows.extend(lies.decays(&case, Some(0.01), 0.0));
    rows.extend(lies.refused(&case, 0.01));
    rows
}
