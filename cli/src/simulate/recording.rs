//! A motion for its outputs: numbers at times, with their names and units.

use articulated_core::description::{JointKind, Quantity};
use articulated_core::model::{FLOATING_BASE, JointInfo, Model};
use articulated_motion::{EventKind, Occurrence};
use serde::Serialize;

/// A coordinate or a rate: its joint and its unit.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Named {
    /// The joint's name, with the index of the coordinate if the joint has several: `elbow`,
    /// `base[3]`.
    pub(crate) name: String,
    /// For people: `elbow`, `base y`.
    pub(crate) label: String,
    /// `rad`, `m`, … ; empty for a number without one.
    pub(crate) unit: &'static str,
    /// Whether it is of the floating base.
    pub(crate) base: bool,
}

/// The record of an event.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct EventRecord {
    /// s.
    pub(crate) time: f64,
    /// Description.
    pub(crate) what: String,
    /// The same as data.
    #[serde(flatten)]
    pub(crate) about: Option<About>,
    /// For the ball's event, its speed along the normal afterwards, m/s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) ball_speed_m_per_s: Option<f64>,
}

/// Data of an event.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct About {
    /// `lower_limit`, `upper_limit`, `contact`, `stick_slip`, `ball`.
    pub(crate) kind: &'static str,
    /// The joint or the link.
    pub(crate) on: String,
    /// Whether it begins or ends.
    pub(crate) begins: bool,
    /// Index among the link's contacts, from 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) contact: Option<usize>,
}

impl From<Occurrence> for EventRecord {
    fn from(h: Occurrence) -> Self {
        let about = h.about.map(|a| {
            let contact = if let EventKind::Contact { number, .. } = a.kind { Some(number) } else { None };
            About { kind: a.kind.name(), on: a.on, begins: a.begins, contact }
        });
        Self { time: h.t, what: h.what, about, ball_speed_m_per_s: h.ball_speed }
    }
}

/// A motion at the times of its output. Vectors of vectors are concatenated, one for each time.
#[derive(Clone, Debug, Default)]
pub(crate) struct Recording {
    /// The coordinates.
    pub(crate) q_names: Vec<Named>,
    /// The rates.
    pub(crate) v_names: Vec<Named>,
    /// The torques that act on the rates.
    pub(crate) tau_names: Vec<Named>,
    /// s.
    pub(crate) t: Vec<f64>,
    /// `[times][nq]`.
    pub(crate) q: Vec<f64>,
    /// `[times][nv]`.
    pub(crate) v: Vec<f64>,
    /// Commanded motor torques, `[times][nv]`.
    pub(crate) tau: Vec<f64>,
    /// J.
    pub(crate) kinetic: Vec<f64>,
    /// J.
    pub(crate) potential: Vec<f64>,
    /// Of motors and wrenches since the start, J.
    pub(crate) work: Vec<f64>,
    /// By friction, damping and drag since the start, J: negative, since they take energy.
    pub(crate) dissipated: Vec<f64>,
    /// By events that map the state since the start, J: negative if they take energy, as a blow
    /// does.
    pub(crate) from_events: Vec<f64>,
    /// Angular momentum about the centre of mass, then linear momentum, in axes of the world frame:
    /// kg·m²/s, kg·m/s.
    pub(crate) momentum: Vec<[f64; 6]>,
    /// Points and forces of contacts of a motion with constraints, m and N, for each time.
    pub(crate) contacts: Vec<Vec<[[f64; 3]; 2]>>,
    /// In the order of their times.
    pub(crate) events: Vec<EventRecord>,
}

impl Recording {
    /// Names and units for a robot, and no times yet.
    pub(crate) fn of(model: &Model<f64>) -> Self {
        let mut out = Self::default();
        for JointInfo { name, kind, .. } in model.joints() {
            let parts = Parts::of(*kind);
            out.q_names.extend(named(name, parts.coordinates, kind.coordinates(), ["rad", "m"]));
            out.v_names.extend(named(name, parts.rates, kind.rates(), ["rad/s", "m/s"]));
            out.tau_names.extend(named(name, parts.torques, kind.rates(), ["N·m", "N"]));
        }
        out
    }

    /// Number of times.
    pub(crate) fn len(&self) -> usize {
        self.t.len()
    }

    /// T + U at each time, J.
    pub(crate) fn energy(&self) -> Vec<f64> {
        self.kinetic.iter().zip(&self.potential).map(|(t, u)| t + u).collect()
    }

    /// The error of the energy balance at each time, J: (T + U) − (T + U)₀ − work − dissipated −
    /// energy from events.
    pub(crate) fn imbalance(&self) -> Vec<f64> {
        let energy = self.energy();
        let start = energy.first().copied().unwrap_or(0.0);
        (0..energy.len()).map(|k| energy[k] - start - self.work[k] - self.dissipated[k] - self.from_events[k]).collect()
    }

    /// The k-th number of a row of `names` at each time.
    pub(crate) fn series(&self, names: &[Named], rows: &[f64], k: usize) -> Vec<f64> {
        rows.chunks_exact(names.len().max(1)).map(|row| row[k]).collect()
    }
}

/// Names of the coordinates, the rates and the torques of a joint with several of them.
struct Parts {
    coordinates: &'static [&'static str],
    rates: &'static [&'static str],
    torques: &'static [&'static str],
}

impl Parts {
    fn of(kind: JointKind) -> Self {
        let alike = |names| Self { coordinates: names, rates: names, torques: names };
        match kind {
            JointKind::Fixed => alike(&[]),
            JointKind::Revolute | JointKind::Continuous | JointKind::Prismatic | JointKind::Helical => alike(&[""]),
            JointKind::Universal => alike(&["first", "second"]),
            JointKind::Planar => alike(&["x", "y", "θ"]),
            JointKind::Spherical => {
                Self { coordinates: &["qx", "qy", "qz", "qw"], rates: &["ωx", "ωy", "ωz"], torques: &["mx", "my", "mz"] }
            }
            JointKind::Floating => Self {
                coordinates: &["x", "y", "z", "qx", "qy", "qz", "qw"],
                rates: &["ωx", "ωy", "ωz", "vx", "vy", "vz"],
                torques: &["mx", "my", "mz", "fx", "fy", "fz"],
            },
        }
    }
}

/// Numbers of a joint, by name and quantity; `units`: of an angle and of a length.
fn named(joint: &str, parts: &[&str], of: &[Quantity], units: [&'static str; 2]) -> Vec<Named> {
    let single = of.len() == 1;
    let name = |k: usize| if single { joint.to_owned() } else { format!("{joint}[{k}]") };
    let base = joint == FLOATING_BASE;
    let shown = if base { "base" } else { joint };
    let label = |part: &str| if single { shown.to_owned() } else { format!("{shown} {part}") };
    let unit = |of: Quantity| match of {
        Quantity::Angle => units[0],
        Quantity::Length => units[1],
        Quantity::Quaternion => "",
    };
    of.iter().zip(parts).enumerate().map(|(k, (of, part))| Named { name: name(k), label: label(part), unit: unit(*of), base }).collect()
}

/// A motion to test outputs with: a quadruped that falls and turns, without physics.
#[cfg(test)]
pub(crate) fn example(model: &Model<f64>, times: usize) -> Recording {
    let mut r = Recording::of(model);
    for k in 0..times {
        let t = k as f64 * 0.01;
        r.t.push(t);
        for (i, name) in r.q_names.iter().enumerate() {
            r.q.push(if name.unit.is_empty() { 0.5 } else { (t * (1.0 + i as f64)).sin() });
        }
        r.v.extend((0..r.v_names.len()).map(|i| (t * (1.0 + i as f64)).cos()));
        r.tau.extend((0..r.v_names.len()).map(|i| 1e-3 * i as f64));
        r.kinetic.push(t * t);
        r.potential.push(10.0 - t * t);
        r.work.push(t);
        r.dissipated.push(-t + 1e-12 * (40.0 * t).sin());
        r.from_events.push(0.0);
        r.momentum.push([t; 6]);
    }
    r.events = vec![EventRecord { time: 0.035, what: "left_foot touches the ground".into(), about: None, ball_speed_m_per_s: None }];
    r
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::robot::bundled_model;

    #[test]
    fn coordinates_and_rates_have_names_and_units() {
        let r = Recording::of(&bundled_model("quadruped"));
        assert_eq!((r.q_names.len(), r.v_names.len(), r.tau_names.len()), (19, 18, 18));
        let units = |names: &[Named]| names[..7].iter().map(|n| n.unit).collect::<Vec<_>>().join(" ");
        assert_eq!(units(&r.q_names), "m m m    ");
        assert_eq!(units(&r.v_names), "rad/s rad/s rad/s m/s m/s m/s rad/s");
        assert_eq!(units(&r.tau_names), "N·m N·m N·m N N N N·m");
        let cart = Recording::of(&bundled_model("cart_pole"));
        assert_eq!(cart.q_names[0].unit, "m");
        assert_eq!(cart.tau_names[0].unit, "N");
        assert_eq!((r.v_names[1].label.as_str(), r.v_names[1].base), ("base ωy", true));
    }

    #[test]
    fn the_imbalance_is_what_neither_work_nor_loss_nor_events_explain() {
        let r = Recording {
            kinetic: vec![1.0, 4.0],
            potential: vec![2.0, 1.0],
            work: vec![0.0, 3.0],
            dissipated: vec![0.0, -0.5],
            from_events: vec![0.0, -0.25],
            ..Recording::default()
        };
        assert_eq!(r.imbalance(), [0.0, -0.25]);
    }
}
