//! The report about a robot, as data.

use articulated_core::description::{ById, Description, Joint, JointKind, Link, LinkId, Mimic};
use articulated_core::diagnostic::{Diagnostic as Finding, summary};
use articulated_core::eigen::eigenvalues;
use articulated_core::index::BodyId;
use articulated_core::model::{FLOATING_BASE, Model};
use articulated_formats::world::World;
use serde::Serialize;

use super::base::Base;
use crate::diagnostic::Diagnostic;
use crate::robot::Robot;
use articulated_lab::json::Units;

/// Beyond this number of bodies some questions are not answered: it is no robot, and the work is
/// quadratic.
const MANY: usize = 5000;

#[derive(Clone, Debug, Serialize)]
pub(super) struct Report {
    pub(super) file: String,
    /// The scene that it is of.
    pub(super) scene: Option<String>,
    pub(super) usable: bool,
    pub(super) robot: Option<String>,
    pub(super) base: &'static str,
    pub(super) gravity: [f64; 3],
    pub(super) errors: Vec<Diagnostic>,
    pub(super) warnings: Vec<Diagnostic>,
    /// The same as text: a line for each sort.
    #[serde(skip)]
    pub(super) warning_lines: Vec<String>,
    pub(super) unused: Vec<String>,
    pub(super) totals: Totals,
    pub(super) links: Vec<LinkRow>,
    pub(super) joints: Vec<JointRow>,
    /// Base parameters; `None` for a robot of very many bodies.
    pub(super) base_parameters: Option<Base>,
    /// The requested functions that can be generated.
    pub(super) functions: Vec<String>,
    pub(super) units: Units,
}

const UNITS: Units = Units(&[
    ("gravity", "m/s²"),
    ("totals.mass", "kg"),
    ("totals.moving_mass", "kg"),
    ("links[].mass", "kg"),
    ("links[].centre_of_mass", "m"),
    ("links[].principal_moments", "kg·m²"),
    ("joints[].lower", "rad or m"),
    ("joints[].upper", "rad or m"),
    ("joints[].velocity", "rad/s or m/s"),
    ("joints[].effort", "N·m or N"),
    ("joints[].locked", "rad or m"),
    ("joints[].carries", "kg"),
]);

#[derive(Clone, Copy, Debug, Default, Serialize)]
pub(super) struct Totals {
    pub(super) links: usize,
    /// Joints of the file, fixed ones too.
    pub(super) joints: usize,
    pub(super) coordinates: usize,
    pub(super) degrees_of_freedom: usize,
    /// kg, of all links.
    pub(super) mass: f64,
    /// kg, of all moving links.
    pub(super) moving_mass: f64,
}

/// A link of the file, which is also a frame.
#[derive(Clone, Debug, Serialize)]
pub(super) struct LinkRow {
    pub(super) link: String,
    /// The joint that it moves with; `None` for links fixed to the base.
    pub(super) moves_with: Option<String>,
    /// kg.
    pub(super) mass: f64,
    /// m, in the link's frame.
    pub(super) centre_of_mass: Option<[f64; 3]>,
    /// kg·m², about the centre of mass.
    pub(super) principal_moments: Option<[f64; 3]>,
}

#[derive(Clone, Debug, Serialize)]
pub(super) struct JointRow {
    pub(super) joint: String,
    pub(super) kind: &'static str,
    /// Links, or the intermediate links between several joints on a body.
    pub(super) parent: Option<String>,
    pub(super) child: Option<String>,
    /// First index and number in q, and in v.
    pub(super) q: Option<(usize, usize)>,
    pub(super) v: Option<(usize, usize)>,
    pub(super) lower: Option<f64>,
    pub(super) upper: Option<f64>,
    pub(super) velocity: Option<f64>,
    pub(super) effort: Option<f64>,
    pub(super) mimic: Option<MimicRow>,
    /// The coordinates at which it is locked.
    pub(super) locked: Option<Vec<f64>>,
    /// Mass that the joint moves, kg: all links behind it; zero if it is fixed or locked.
    pub(super) carries: f64,
}

/// own = Σ multiplier · leader's + offset; of one leader also powers 2 to 4.
#[derive(Clone, Debug, Serialize)]
pub(super) struct MimicRow {
    pub(super) leaders: Vec<LeaderRow>,
    pub(super) offset: f64,
}

/// A joint that another one follows.
#[derive(Clone, Debug, Serialize)]
pub(super) struct LeaderRow {
    pub(super) joint: String,
    pub(super) multiplier: f64,
    /// Coefficients of its powers 2, 3 and 4, where they are not all zero.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) higher: Option<[f64; 3]>,
}

impl MimicRow {
    fn of(joint: &Joint, description: &Description) -> Option<Self> {
        let leader =
            |m: &Mimic| LeaderRow { joint: description.joints[m.joint].name.clone(), multiplier: m.multiplier, higher: m.law().higher };
        let all = || joint.mimic.iter().chain(&joint.also);
        joint.mimic?;
        Some(Self { leaders: all().map(leader).collect(), offset: all().map(|m| m.offset).sum() })
    }
}

impl Report {
    pub(super) fn new(robot: &Robot) -> Self {
        Self {
            file: robot.file.clone(),
            scene: robot.scene.clone(),
            usable: false,
            robot: None,
            base: robot.base(),
            gravity: robot.options.robot.gravity_in(&World::default()),
            errors: Vec::new(),
            warnings: Vec::new(),
            warning_lines: Vec::new(),
            unused: Vec::new(),
            totals: Totals::default(),
            links: Vec::new(),
            joints: Vec::new(),
            base_parameters: None,
            functions: Vec::new(),
            units: UNITS,
        }
    }

    /// Adds warnings of the reader.
    pub(super) fn warn_of<'a>(&mut self, problems: impl Iterator<Item = &'a Finding> + Clone) {
        self.warning_lines.extend(summary(problems.clone()));
        self.warnings.extend(problems.map(Diagnostic::of));
    }

    /// Adds one warning.
    pub(super) fn warn(&mut self, warning: Diagnostic) {
        self.warning_lines.push(warning.message.clone());
        self.warnings.push(warning);
    }

    /// Fills in the contents of the robot, and warns of joints without an inertia of their own.
    pub(super) fn describe(&mut self, description: &Description, model: &Model<f64>) {
        self.robot = Some(description.name.clone());
        let bodies = model.bodies_of_links(description);
        let links = description.links.iter().zip(&bodies).filter(|(link, _)| !link.intermediate);
        self.links = links.map(|(link, body)| link_row(link, *body, model)).collect();
        self.joints = joint_rows(description, model, &bodies);
        self.totals = Totals {
            links: self.links.len(),
            joints: description.joints.len(),
            coordinates: model.nq(),
            degrees_of_freedom: model.nv(),
            mass: self.links.iter().fold(0.0, |sum, l| sum + l.mass),
            moving_mass: model.moving_mass(),
        };
        self.base_parameters = Base::of(model).map(|base| Base { merged_joints: merged(description, &bodies), ..base });
        self.warn_of_massless_joints(model);
    }

    fn warn_of_massless_joints(&mut self, model: &Model<f64>) {
        let file = self.file.clone();
        if model.bodies().len() > MANY {
            return self.warn(
                Diagnostic::from(format!(
                    "{file}: more than {MANY} bodies: whether every joint has an inertia of its own was not looked at"
                ))
                .into_warning(),
            );
        }
        for body in model.massless_joints() {
            let name = &model.bodies()[body].name;
            let message = format!(
                "{file}: joint {name:?} has no inertia of its own: nothing behind it resists its motion, or another joint moves the same mass in the same way, \
                 so the mass matrix is singular, and forward dynamics is undefined for this robot; expected an inertia behind it, an armature, or one \
                 joint fewer"
            );
            self.warn(Diagnostic::warning_of_joint(&file, name, None, message));
        }
    }
}

fn link_row(link: &Link, body: BodyId, model: &Model<f64>) -> LinkRow {
    LinkRow {
        link: link.name.clone(),
        moves_with: (!body.is_base()).then(|| model.bodies()[body].name.clone()),
        mass: link.inertial.map_or(0.0, |i| i.mass),
        centre_of_mass: link.inertial.map(|i| i.origin.xyz),
        principal_moments: link.inertial.map(|i| eigenvalues(i.inertia)),
    }
}

/// The floating base first, then the joints in the order of their coordinates, then joints without
/// coordinates of their own, in the order of the file.
fn joint_rows(description: &Description, model: &Model<f64>, bodies: &ById<LinkId, BodyId>) -> Vec<JointRow> {
    let carried = model.carried();
    let base = model.joints().iter().find(|j| j.name == FLOATING_BASE).map(|j| JointRow {
        joint: j.name.clone(),
        kind: JointKind::Floating.name(),
        parent: None,
        child: description.root().map(|r| description.links[r].name.clone()),
        q: Some(j.q),
        v: Some(j.v),
        lower: None,
        upper: None,
        velocity: None,
        effort: None,
        mimic: None,
        locked: None,
        carries: carried[BodyId::BASE],
    });
    let places: std::collections::BTreeMap<&str, _> = model.joints().iter().map(|j| (j.name.as_str(), (j.q, j.v))).collect();
    let rows = description.joints.iter().map(|joint| {
        let name = |link: LinkId| Some(description.links[link].name.clone());
        let place = places.get(joint.name.as_str()).filter(|_| joint.name != FLOATING_BASE);
        let body = bodies[joint.child];
        let limit = joint.limit;
        JointRow {
            joint: joint.name.clone(),
            kind: joint.kind.name(),
            parent: name(joint.parent),
            child: name(joint.child),
            q: place.map(|p| p.0),
            v: place.map(|p| p.1),
            lower: limit.map(|l| l.lower).filter(|x| x.is_finite()),
            upper: limit.map(|l| l.upper).filter(|x| x.is_finite()),
            velocity: limit.map(|l| l.velocity).filter(|x| x.is_finite()),
            effort: limit.map(|l| l.effort).filter(|x| x.is_finite()),
            mimic: MimicRow::of(joint, description),
            locked: joint.locked.clone(),
            carries: if body == bodies[joint.parent] { 0.0 } else { carried[body] },
        }
    });
    let mut all: Vec<JointRow> = base.into_iter().chain(rows).collect();
    all.sort_by_key(|row| row.q.map_or(usize::MAX, |(at, _)| at));
    all
}

/// Joints that join links of one body.
fn merged(description: &Description, bodies: &ById<LinkId, BodyId>) -> usize {
    description.joints.iter().filter(|j| bodies[j.child] == bodies[j.parent]).count()
}
