//! The report about a motion, as data.

use articulated::simulate::{Balance, Counts, Settings};
use articulated_core::description::{Base, JointKind};
use articulated_core::effect::EffectId;
use articulated_motion::{Creep, Slide};
use serde::Serialize;

use super::constrained::Constrained;
use super::method::Method;
use super::motion::Motion;
use super::recording::{EventRecord, Recording};
use crate::effects::sorts;
use articulated_lab::json::Units;
use articulated_lab::session::{Session, joint_of};

#[derive(Clone, Debug, Serialize)]
pub(super) struct Summary {
    pub(super) scene: String,
    pub(super) robot: String,
    pub(super) base: &'static str,
    pub(super) degrees_of_freedom: usize,
    /// Names of the effects that are on.
    pub(super) effects: Vec<&'static str>,
    /// `generated` or `generic`.
    pub(super) code: &'static str,
    pub(super) integrator: Method,
    /// Whether the steps are those of a robot's file. A large imbalance of energy is then a
    /// warning, and the status stays `ok`.
    #[serde(skip)]
    pub(super) is_of_file: bool,
    /// How limits, dry friction and contacts of the file were kept, if it has them: then there is
    /// no balance of energy.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) constraints: Option<Constrained>,
    pub(super) start_s: f64,
    /// The time that was reached.
    pub(super) end_s: f64,
    /// The requested end time.
    pub(super) requested_end_s: f64,
    /// The time of the last record: energies and momentum at the end refer to it.
    pub(super) last_record_s: f64,
    pub(super) ended: String,
    /// `ok`; `out_of_tolerance`: it ended, but its balance of energy is not kept; `error`.
    pub(super) status: &'static str,
    pub(super) error: Option<String>,
    pub(super) energy: Energy,
    pub(super) momentum: Momentum,
    pub(super) counts: Done,
    /// Creep where smoothed friction should hold: the contact and the joint that crept furthest.
    pub(super) creep: Vec<Crept>,
    /// Links with contacts that move although friction would hold them.
    pub(super) slides: Vec<Slid>,
    pub(super) events: Vec<EventRecord>,
    /// Whether the ball of the scene's impact was reached and hit; `None` without a ball.
    pub(super) ball_reached: Option<bool>,
    /// Its speed along the normal after its event.
    pub(super) ball_speed_m_per_s: Option<f64>,
    pub(super) wall_s: f64,
    pub(super) simulated_s_per_wall_s: f64,
    /// Warnings about the robot, the initial state, the events, and the balance of energy.
    pub(super) warnings: Vec<String>,
    /// Written into the folder.
    pub(super) files: Vec<String>,
    /// The columns of the table among them, with their units.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(super) columns: Vec<Unit>,
    /// Pictures that are not written, since all their curves are zero throughout, or since only the
    /// ends are recorded.
    pub(super) pictures_left_out: Vec<&'static str>,
    /// Whether the page is not written either, since only the ends are recorded.
    pub(super) page_left_out: bool,
    pub(super) units: Units,
}

/// Units of numbers without their own.
const UNITS: Units = Units(&[
    ("integrator.atol", "rad, m, and those a second"),
    ("energy", "J; relative_imbalance a number"),
    ("momentum.start", "three of kg·m²/s, about the centre of mass, and three of kg·m/s"),
    ("momentum.end", "as at the start"),
    ("momentum.largest_change_angular", "kg·m²/s"),
    ("momentum.largest_change_linear", "kg·m/s"),
    ("events[].time", "s"),
]);

/// A column of the table of a motion.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Unit {
    pub(super) column: String,
    /// Empty for a number without one.
    pub(super) unit: String,
}

/// J.
#[derive(Clone, Debug, Default, Serialize)]
pub(super) struct Energy {
    pub(super) start: f64,
    pub(super) end: f64,
    pub(super) kinetic_start: f64,
    pub(super) kinetic_end: f64,
    pub(super) potential_start: f64,
    pub(super) potential_end: f64,
    pub(super) work: f64,
    pub(super) dissipated: f64,
    /// Energy from events that map the state, or from constraints; negative if they took energy.
    /// That of constraints is all that work and dissipation do not explain.
    pub(super) from_events: f64,
    /// Kinetic energy that the ball of the scene's impact got, if it was hit.
    pub(super) ball: Option<f64>,
    /// T + U − start − work − dissipated − from_events, the largest after any step.
    pub(super) largest_imbalance: f64,
    /// The largest of kinetic energy, work, dissipation and energy from events, after any step.
    pub(super) largest_moved: f64,
    /// The imbalance over that.
    pub(super) relative_imbalance: f64,
}

/// About the centre of mass, world axes: three of angular momentum, kg·m²/s, then three of linear
/// momentum, kg·m/s.
#[derive(Clone, Debug, Default, Serialize)]
pub(super) struct Momentum {
    pub(super) start: [f64; 6],
    pub(super) end: [f64; 6],
    /// Length of the largest change since the start.
    pub(super) largest_change_angular: f64,
    pub(super) largest_change_linear: f64,
}

/// A contact or a joint that crept while smoothed friction should have held it.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Crept {
    /// `contact` or `friction`.
    pub(super) effect: &'static str,
    /// The link or the joint.
    pub(super) on: String,
    pub(super) distance: f64,
    /// Unit of the distance: `m`, or `rad` for a joint that rotates.
    pub(super) unit: &'static str,
    /// How long it crept.
    pub(super) time_s: f64,
}

impl Crept {
    fn of(session: &Session, creep: &Creep) -> Self {
        // For a degree of freedom of a planar joint, such as `puck[2]`, the name of its joint is
        // before the bracket.
        let joint = |name: &str| session.description.joints.iter().find(|joint| joint.name == name).map(|joint| joint.kind);
        let name = creep.on.split_once('[').map_or(creep.on.as_str(), |(name, _)| name);
        let unit = match (creep.effect, joint(&creep.on).or_else(|| joint(name))) {
            (EffectId::contact, _) | (_, Some(JointKind::Prismatic)) => "m",
            (_, Some(JointKind::Planar | JointKind::Floating)) => "rad, m",
            _ => "rad",
        };
        Self { effect: creep.effect.row().name, on: creep.on.clone(), distance: creep.distance, unit, time_s: creep.time }
    }
}

/// A link with contacts that move although friction would hold them.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Slid {
    /// The link.
    pub(super) on: String,
    pub(super) distance_m: f64,
    pub(super) time_s: f64,
    /// The mean force across the normal over the largest that friction has.
    pub(super) part_of_friction: f64,
    /// A damping time with which the contacts rest.
    pub(super) damping_time_s: f64,
}

impl Slid {
    fn of(slide: &Slide) -> Self {
        let Slide { on, distance, time, part, damping_time, .. } = slide;
        Self { on: on.clone(), distance_m: *distance, time_s: *time, part_of_friction: *part, damping_time_s: *damping_time }
    }
}

#[derive(Clone, Debug, Serialize)]
pub(super) struct Done {
    pub(super) steps: u64,
    pub(super) rejected_steps: u64,
    /// Of forward dynamics.
    pub(super) evaluations: u64,
    /// Of its derivatives.
    pub(super) derivatives: u64,
    pub(super) smallest_step_s: Option<f64>,
    pub(super) largest_step_s: f64,
    /// Steps over a stiff layer, left out of the balance of energy.
    pub(super) steps_over_stiff_layers: u64,
    /// Where stiffness was noted.
    pub(super) stiff_at_s: Option<f64>,
    /// The joint with the error that limits most steps, if tolerances choose them.
    pub(super) limited_by: Option<String>,
    pub(super) records: usize,
}

impl Summary {
    pub(super) fn new(session: &Session, motion: &Motion, settings: &Settings, code: &'static str) -> Self {
        let r = &motion.recording;
        let (row, wall) = (settings.integrator.row(), motion.wall.as_secs_f64());
        let last_record = r.t.last().copied().unwrap_or(settings.start);
        Self {
            scene: session.name.clone(),
            robot: session.model.name().to_owned(),
            base: if floats(session) { "floating" } else { "fixed" },
            degrees_of_freedom: session.model.nv(),
            effects: sorts(&session.effects),
            code,
            integrator: motion.of_file.clone().unwrap_or(Method {
                name: row.name,
                order: row.order,
                step_s: settings.step,
                rtol: settings.rtol,
                atol: settings.atol,
            }),
            is_of_file: motion.of_file.is_some(),
            constraints: motion.constraints.clone(),
            start_s: settings.start,
            end_s: motion.reached,
            requested_end_s: settings.end,
            last_record_s: last_record,
            ended: motion.ending.to_string(),
            status: if motion.error.is_some() { "error" } else { "ok" },
            error: motion.error.clone(),
            energy: Energy::of(r, &motion.balance, motion.ball),
            momentum: Momentum::of(r),
            counts: Done::of(session, &motion.counts, r.len()),
            creep: motion.creep.iter().map(|creep| Crept::of(session, creep)).collect(),
            slides: motion.slides.iter().map(Slid::of).collect(),
            events: r.events.clone(),
            ball_reached: session.scene.impact.as_ref().map(|_| motion.ball.is_some()),
            ball_speed_m_per_s: r.events.iter().find_map(|e| e.ball_speed_m_per_s),
            wall_s: wall,
            simulated_s_per_wall_s: (motion.reached - settings.start) / wall.max(1e-9),
            warnings: session.robot_warnings.iter().chain(&motion.warnings).cloned().collect(),
            files: Vec::new(),
            columns: Vec::new(),
            pictures_left_out: Vec::new(),
            page_left_out: false,
            units: UNITS,
        }
        .with_balance(&session.scene.file)
    }

    fn with_balance(mut self, file: &str) -> Self {
        self.warnings.extend(self.out_of_balance().map(|warning| format!("{file}: {warning}")));
        if self.status == "ok" && !self.is_of_file && (!self.energy.is_kept() || self.counts.has_no_balance()) {
            self.status = "out_of_tolerance";
        }
        self
    }
}

/// Whether the base floats, by the scene or by the first joint of the robot's file.
fn floats(session: &Session) -> bool {
    let first = session.model.joints().first();
    session.base() == Base::Floating || first.is_some_and(|joint| joint.kind == JointKind::Floating)
}

impl Energy {
    fn of(r: &Recording, balance: &Balance, ball: Option<f64>) -> Self {
        let energy = r.energy();
        let at = |x: &[f64], last: bool| if last { x.last() } else { x.first() }.copied().unwrap_or(0.0);
        Self {
            start: at(&energy, false),
            end: at(&energy, true),
            kinetic_start: at(&r.kinetic, false),
            kinetic_end: at(&r.kinetic, true),
            potential_start: at(&r.potential, false),
            potential_end: at(&r.potential, true),
            work: at(&r.work, true),
            dissipated: at(&r.dissipated, true),
            from_events: at(&r.from_events, true),
            ball,
            largest_imbalance: balance.largest_imbalance,
            largest_moved: balance.largest_moved,
            relative_imbalance: balance.relative(),
        }
    }

    /// Whether the balance of energy is good enough to trust the motion.
    fn is_kept(&self) -> bool {
        self.relative_imbalance <= NOT_KEPT
    }
}

/// Tolerated error of the energy balance, relative to the largest energy moved.
const NOT_KEPT: f64 = 0.1;

/// Fixed steps with a larger imbalance should be shorter.
const LOOSE_STEPS: f64 = 0.01;

/// Steps by tolerance with a larger imbalance should have smaller tolerances.
const LOOSE: f64 = 1e-4;

impl Summary {
    /// A warning if the balance of energy is not kept, or only loosely for such steps.
    pub(super) fn out_of_balance(&self) -> Option<String> {
        let part = self.energy.relative_imbalance;
        if !part.is_finite() {
            return Some("energy is beyond the largest number: it says nothing of this motion".into());
        }
        if self.counts.has_no_balance() {
            return Some("all steps pass over a stiff layer: none is in the balance of energy; take shorter steps".into());
        }
        let lacks = format!("the balance of energy lacks {} of the largest energy moved", crate::table::number(part));
        if self.is_of_file {
            return (part > NOT_KEPT).then(|| format!("{lacks}: the steps of the file are long for this motion, whose error is as large"));
        }
        if !self.energy.is_kept() {
            return Some(format!("{lacks}: the steps are too long, and this motion is not that of the scene"));
        }
        if let Some(step) = self.integrator.step_s {
            return (part > LOOSE_STEPS)
                .then(|| format!("{lacks}, expected at most {LOOSE_STEPS}: take shorter steps, found step = {step:e} s"));
        }
        let loose = part > LOOSE;
        loose.then(|| {
            format!("{lacks}, expected at most {LOOSE:e}: take smaller tolerances (rtol, atol), found rtol = {:e}", self.integrator.rtol)
        })
    }
}

impl Momentum {
    fn of(r: &Recording) -> Self {
        let (Some(start), Some(end)) = (r.momentum.first(), r.momentum.last()) else { return Self::default() };
        let change = |part: usize| {
            let size = |p: &[f64; 6]| (0..3).map(|k| (p[part + k] - start[part + k]).powi(2)).sum::<f64>().sqrt();
            r.momentum.iter().map(size).fold(0.0, f64::max)
        };
        Self { start: *start, end: *end, largest_change_angular: change(0), largest_change_linear: change(3) }
    }
}

impl Done {
    /// Whether no step is in the balance of energy, although there are steps.
    fn has_no_balance(&self) -> bool {
        self.steps > 0 && self.steps_over_stiff_layers >= self.steps
    }

    fn of(session: &Session, c: &Counts, records: usize) -> Self {
        Self {
            steps: c.steps,
            rejected_steps: c.rejected,
            evaluations: c.evaluations,
            derivatives: c.derivatives,
            smallest_step_s: Some(c.smallest_step).filter(|s| s.is_finite()),
            largest_step_s: c.largest_step,
            steps_over_stiff_layers: c.layers,
            stiff_at_s: c.stiff_at,
            limited_by: c.limited_by.and_then(|index| joint_of(session, index)),
            records,
        }
    }
}
