//! Effects of a scene as data.

use articulated_core::description::{JointKind, Quantity};
use articulated_core::effect::effects;
use articulated_scene::EffectCount;
use serde::Serialize;

use articulated_lab::json::Units;
use articulated_lab::session::Session;
use articulated_lab::timing::Summary;

#[derive(Clone, Debug, Serialize)]
pub(super) struct Report {
    pub(super) scene: String,
    pub(super) robot: String,
    pub(super) base: &'static str,
    /// In the world frame, m/s².
    pub(super) gravity: [f64; 3],
    pub(super) degrees_of_freedom: usize,
    pub(super) on: Vec<On>,
    /// On how many joints or links each effect is, and where its numbers come from.
    pub(super) counts: Vec<Count>,
    pub(super) off: Vec<Off>,
    /// Unused content of the robot's file.
    pub(super) ignored: Vec<Ignored>,
    /// How many limbs the generated code computes at once.
    pub(super) limbs: usize,
    /// The compiler of the timed code.
    pub(super) compiler: Option<String>,
    /// One for each function.
    pub(super) costs: Vec<Cost>,
    pub(super) units: Units,
}

/// Units of numbers without their own.
const UNITS: Units = Units(&[("gravity", "m/s²")]);

/// An effect on a joint or a link.
#[derive(Clone, Debug, Serialize)]
pub(super) struct On {
    pub(super) effect: &'static str,
    pub(super) law: &'static str,
    pub(super) on: String,
    pub(super) numbers: Vec<Number>,
    /// In the scene's file.
    pub(super) line: Option<u32>,
}

#[derive(Clone, Debug, Serialize)]
pub(super) struct Number {
    pub(super) name: &'static str,
    pub(super) values: Vec<f64>,
    pub(super) unit: &'static str,
    /// The tag of the robot's file that it is from.
    pub(super) from: Option<&'static str>,
}

/// On how many joints or links an effect is.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Count {
    pub(super) effect: &'static str,
    /// Number of joints or links that have it.
    pub(super) on: usize,
    /// Number of joints or links that move.
    pub(super) of: usize,
    /// Number of those with numbers from the robot's file, points from its collision geometry, or
    /// numbers from the scene.
    pub(super) from_file: usize,
    pub(super) from_collision: usize,
    pub(super) from_scene: usize,
    /// The same in words.
    #[serde(skip)]
    pub(super) text: String,
}

#[derive(Clone, Debug, Serialize)]
pub(super) struct Off {
    pub(super) effect: &'static str,
    pub(super) why: String,
}

/// Something of the robot's file.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Ignored {
    /// The link or joint.
    pub(super) of: String,
    pub(super) tag: String,
    pub(super) why: String,
    /// In the robot's file.
    pub(super) line: Option<u32>,
}

/// The cost of a function without effects, the addition of each effect alone, and of all together;
/// or the cost with all of them.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Cost {
    pub(super) function: String,
    /// Includes gravity, but no effects; `None` if the function is not defined without them.
    pub(super) without: Option<Counted>,
    /// For a function that is not defined without effects.
    pub(super) only_with: Option<OnlyWith>,
    pub(super) adds: Vec<Added>,
}

/// A function that is not defined without effects.
#[derive(Clone, Debug, Serialize)]
pub(super) struct OnlyWith {
    /// Why not.
    pub(super) why: String,
    /// With all effects.
    pub(super) cost: Counted,
}

/// Operations of generated code.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub(super) struct Operations {
    pub(super) multiplications: i64,
    pub(super) additions: i64,
    /// Divisions and roots.
    pub(super) divisions_and_roots: i64,
    /// A multiply-add counted once; signs, comparisons and selections too; no sines and cosines.
    pub(super) instructions: i64,
}

#[derive(Clone, Debug, Serialize)]
pub(super) struct Counted {
    pub(super) operations: Operations,
    pub(super) ns: Option<Summary>,
}

/// The addition of an effect.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Added {
    /// An effect's name, `gravity`, or `all together`.
    pub(super) what: String,
    /// On how many joints or places of links.
    pub(super) places: usize,
    pub(super) operations: Operations,
    /// Repetition by repetition, against the code without it.
    pub(super) ns: Option<Summary>,
}

impl Cost {
    /// Costs reported as totals, not as differences.
    pub(super) fn whole(&self) -> Option<&Counted> {
        self.without.as_ref().or(self.only_with.as_ref().map(|only| &only.cost))
    }
}

impl Report {
    pub(super) fn of(session: &Session) -> Self {
        let told = &session.report;
        let law = |name: &str| effects().iter().find(|e| e.name == name).map_or("", |e| e.what);
        let on = told.on.iter().map(|e| On {
            effect: e.effect.name(),
            law: law(e.effect.name()),
            on: e.on.clone(),
            numbers: e.numbers.iter().map(|n| number(n, kind(session, &e.on))).collect(),
            line: e.place.line(),
        });
        Self {
            scene: session.name.clone(),
            robot: session.model.name().to_owned(),
            base: if session.base() == articulated_core::description::Base::Floating { "floating" } else { "fixed" },
            gravity: session.model.gravity().into(),
            degrees_of_freedom: session.model.nv(),
            on: on.collect(),
            counts: told.counts().into_iter().map(count).collect(),
            off: told.off.iter().map(|e| Off { effect: e.effect, why: e.why.to_string() }).collect(),
            ignored: told
                .ignored
                .iter()
                .map(|u| Ignored { of: u.subject.to_string(), tag: u.tag.clone(), why: u.why.clone(), line: u.line })
                .collect(),
            limbs: 1,
            compiler: None,
            costs: Vec::new(),
            units: UNITS,
        }
    }
}

fn count(own: EffectCount) -> Count {
    let EffectCount { effect, on, of, from_file, from_collision, from_scene } = own;
    Count { effect: effect.name(), on, of, from_file, from_collision, from_scene, text: own.to_string() }
}

/// Units are those of a joint that turns or slides; both, as in the manual, for one that does both.
fn number(n: &articulated_scene::Number, kind: Option<JointKind>) -> Number {
    let (turning, sliding) = n.unit.split_once('|').unwrap_or((n.unit, n.unit));
    let has = |quantity| kind.is_some_and(|kind| kind.rates().contains(&quantity));
    let unit = match (has(Quantity::Angle), has(Quantity::Length)) {
        (true, true) => n.unit,
        (false, true) => sliding,
        _ => turning,
    };
    Number { name: n.name, values: n.values.clone(), unit, from: n.from }
}

fn kind(session: &Session, joint: &str) -> Option<JointKind> {
    session.description.joint(joint).map(|j| session.description.joints[j].kind)
}
