//! The section `<actuator>`: forces with an affine law on joints, tendons and sites.
//!
//! All kinds share one default, as in MuJoCo: gear and bounds apply to any kind. The numbers of the
//! law (`kp`, `kv`) come from a default of the same kind or of `<general>`, of the nearest class
//! that has one.

use std::collections::BTreeMap;
use std::rc::Rc;

use articulated_core::actuator::{Activation, Filter};
use articulated_core::description::Description;
use articulated_core::diagnostic::{Code, Diagnostics, Subject};

use super::bodies::Kind;
use super::element::Element;
use super::reflected::{Drives, Inertia, Rotor, Unknown};
use super::scope::{References, Scope, Sort};
use super::settings::Settings;
use super::simulation::Simulation;
use super::tendons::{Course, Tendon};
use super::values::Values;
use crate::world::{Actuator, OnFrames, Site, Strand, World};

const KINDS: [&str; 13] = [
    "general",
    "motor",
    "position",
    "velocity",
    "intvelocity",
    "orientation",
    "pid",
    "damper",
    "cylinder",
    "muscle",
    "adhesion",
    "dcmotor",
    "plugin",
];

pub(crate) fn is_actuator(name: &str) -> bool {
    KINDS.contains(&name)
}

/// The control of an actuator of the file, in the order of MuJoCo's.
pub(crate) struct Control {
    /// The part of the tree that the actuator is of.
    pub(crate) part: usize,
    /// The index of the actuator, if it is read.
    pub(crate) actuator: Option<usize>,
    /// How many activations the file has for it: those of an actuator are with its first control.
    pub(crate) activations: usize,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Dynamics {
    None,
    Integrator,
    Filter,
    FilterExact,
    /// With another state, under its name in the file.
    Other(&'static str),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Gain {
    Fixed,
    Affine,
    Other(&'static str),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Bias {
    None,
    Affine,
    Other(&'static str),
}

const DYNAMICS: [(&str, Dynamics); 8] = [
    ("none", Dynamics::None),
    ("integrator", Dynamics::Integrator),
    ("filter", Dynamics::Filter),
    ("filterexact", Dynamics::FilterExact),
    ("pid", Dynamics::Other("pid")),
    ("dcmotor", Dynamics::Other("dcmotor")),
    ("muscle", Dynamics::Other("muscle")),
    ("user", Dynamics::Other("user")),
];
const GAINS: [(&str, Gain); 7] = [
    ("fixed", Gain::Fixed),
    ("affine", Gain::Affine),
    ("muscle", Gain::Other("muscle")),
    ("dcmotor", Gain::Other("dcmotor")),
    ("pid", Gain::Other("pid")),
    ("so3", Gain::Other("so3")),
    ("user", Gain::Other("user")),
];
const BIASES: [(&str, Bias); 6] = [
    ("none", Bias::None),
    ("affine", Bias::Affine),
    ("muscle", Bias::Other("muscle")),
    ("dcmotor", Bias::Other("dcmotor")),
    ("so3", Bias::Other("so3")),
    ("user", Bias::Other("user")),
];

/// The attributes for the target of an actuator.
const TARGETS: [(&str, Sort); 6] = [
    ("joint", Sort::Joint),
    ("jointinparent", Sort::Joint),
    ("tendon", Sort::Tendon),
    ("site", Sort::Site),
    ("cranksite", Sort::Site),
    ("body", Sort::Body),
];

/// The numbers of an actuator, or of a default.
#[derive(Clone, Debug)]
struct General {
    /// The kind of the last tag.
    kind: String,
    dynamics: Dynamics,
    gain: Gain,
    bias: Bias,
    gains: [f64; 10],
    biases: [f64; 10],
    /// Numbers of the dynamics; the first is a time constant, s.
    times: [f64; 10],
    /// Number of activations, if the file says it.
    activations: i64,
    activation_limited: Option<bool>,
    activation_range: [f64; 2],
    is_early: bool,
    gear: [f64; 6],
    control_limited: Option<bool>,
    force_limited: Option<bool>,
    control_range: [f64; 2],
    force_range: [f64; 2],
    inherit_range: f64,
    damping: [f64; 3],
    armature: f64,
    delay: f64,
    group: i64,
    /// Which controls it has.
    input: Option<String>,
    /// The kind of these numbers, if this kind is not read.
    foreign: Option<String>,
}

impl Default for General {
    fn default() -> Self {
        let mut gains = [0.0; 10];
        gains[0] = 1.0;
        Self {
            kind: "general".to_owned(),
            dynamics: Dynamics::None,
            gain: Gain::Fixed,
            bias: Bias::None,
            gains,
            biases: [0.0; 10],
            times: [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
            activations: -1,
            activation_limited: None,
            activation_range: [0.0; 2],
            is_early: false,
            gear: [1.0, 0.0, 0.0, 0.0, 0.0, 0.0],
            control_limited: None,
            force_limited: None,
            control_range: [0.0; 2],
            force_range: [0.0; 2],
            inherit_range: 0.0,
            damping: [0.0; 3],
            armature: 0.0,
            delay: 0.0,
            group: 0,
            input: None,
            foreign: None,
        }
    }
}

impl General {
    /// The defaults of a class and of the classes above, the farthest first.
    fn defaults(class: usize, settings: &Settings<'_>, log: &mut Diagnostics) -> Vec<Self> {
        // An error in a default is reported once, not for each class below.
        let mut own = log.apart();
        let mut above = vec![Self::default()];
        for tags in settings.classes.lineage(class) {
            let mut state = above.last().cloned().unwrap_or_default();
            tags.iter().filter(|tag| is_actuator(&tag.name)).for_each(|tag| state.apply(tag, &above, &mut own));
            above.push(state);
        }
        own.errors.retain(|error| !log.errors.contains(error));
        log.take(own);
        above
    }

    /// The numbers of the default class of a tag, then of the tag.
    fn of(element: &Element, above: &[Self], log: &mut Diagnostics) -> Self {
        let mut all = above.last().cloned().unwrap_or_default();
        all.apply(element, above, log);
        all
    }

    /// Applies a tag; `above`: the defaults of the classes above.
    fn apply(&mut self, element: &Element, above: &[Self], log: &mut Diagnostics) {
        let values = Values::alone(element, &Subject::Document);
        self.gear = values.at_most("gear", self.gear, log);
        self.damping = values.at_most("damping", self.damping, log);
        for (name, into) in [
            ("ctrllimited", &mut self.control_limited),
            ("forcelimited", &mut self.force_limited),
            ("actlimited", &mut self.activation_limited),
        ] {
            if values.has(name) {
                *into = values.yes_or_auto(name, log);
            }
        }
        for (name, into) in [("armature", &mut self.armature), ("delay", &mut self.delay)] {
            *into = values.number(name, log).unwrap_or(*into);
        }
        self.group = values.integer("group", log).unwrap_or(self.group);
        self.activations = values.integer("actdim", log).unwrap_or(self.activations);
        self.is_early = values.yes("actearly", log).unwrap_or(self.is_early);
        self.activation_range = values.exactly("actrange", log).unwrap_or(self.activation_range);
        self.force_range = values.exactly("forcerange", log).unwrap_or(self.force_range);
        self.control_range = values.exactly("ctrlrange", log).unwrap_or(self.control_range);
        let gain = self.gain;
        self.law_of(&values, above, log);
        if gain != self.gain {
            self.input = None;
        }
        self.input = values.text("input").map(str::to_owned).or(self.input.take());
        element.name.clone_into(&mut self.kind);
    }

    /// The initial numbers of a kind: those of the nearest default of this kind, or of `<general>`
    /// with a gain of this type.
    fn base(&self, kind: &str, above: &[Self]) -> Self {
        let gain = if kind == "damper" { Gain::Affine } else { Gain::Fixed };
        let fits = |own: &&Self| own.kind == kind || (own.kind == "general" && own.gain == gain);
        Some(self).filter(fits).or_else(|| above.iter().rev().find(fits)).cloned().unwrap_or_default()
    }

    /// The law of the force for a tag.
    fn law_of(&mut self, values: &Values<'_>, above: &[Self], log: &mut Diagnostics) {
        let kind = values.element.name.as_str();
        if kind == "general" {
            self.dynamics = of_word(values, "dyntype", &DYNAMICS, self.dynamics, log);
            self.gain = of_word(values, "gaintype", &GAINS, self.gain, log);
            self.bias = of_word(values, "biastype", &BIASES, self.bias, log);
            self.gains = values.at_most("gainprm", self.gains, log);
            self.biases = values.at_most("biasprm", self.biases, log);
            self.times = values.at_most("dynprm", self.times, log);
            self.inherit_range = values.number("inheritrange", log).unwrap_or(self.inherit_range);
            return;
        }
        let base = self.base(kind, above);
        let fixed = if base.gain == Gain::Fixed { base.gains[0] } else { 1.0 };
        (self.dynamics, self.gain, self.bias, self.foreign) = (Dynamics::None, Gain::Fixed, Bias::None, None);
        (self.gains, self.biases) = ([0.0; 10], [0.0; 10]);
        // A number of an unsupported kind, such as the area of a cylinder
        let foreign = base.foreign.clone();
        match kind {
            "motor" => self.gains[0] = 1.0,
            "position" | "intvelocity" => {
                self.servo(&base, fixed, values, log);
                self.foreign = foreign;
                if kind == "intvelocity" {
                    self.dynamics = Dynamics::Integrator;
                }
            }
            "velocity" => {
                self.foreign = foreign;
                let kv = values.number("kv", log).unwrap_or(fixed);
                (self.gains[0], self.biases[2], self.bias) = (kv, -kv, Bias::Affine);
            }
            "cylinder" => {
                let diameter = values.number("diameter", log).map(|diameter| core::f64::consts::FRAC_PI_4 * diameter * diameter);
                let area = diameter.or_else(|| values.number("area", log)).unwrap_or(fixed);
                let mut bias = [0.0; 3];
                bias.copy_from_slice(&base.biases[..3]);
                self.biases[..3].copy_from_slice(&values.at_most("bias", bias, log));
                self.times[0] = values.number("timeconst", log).unwrap_or(base.times[0]);
                (self.gains[0], self.bias, self.dynamics) = (area, Bias::Affine, Dynamics::Filter);
            }
            "damper" => {
                let kv = values.number("kv", log).unwrap_or(if base.gain == Gain::Affine { -base.gains[2] } else { 0.0 });
                (self.gains[2], self.gain, self.control_limited, self.foreign) = (-kv, Gain::Affine, Some(true), foreign);
                if kv < 0.0 {
                    values.error("kv", Code::Number, format!("{kv}"), "zero or more", log);
                }
                if self.control_range.iter().any(|bound| *bound < 0.0) {
                    let [lower, upper] = self.control_range;
                    values.error("ctrlrange", Code::Number, format!("{lower} and {upper}"), "bounds of a damper, zero or more", log);
                }
            }
            other => {
                self.foreign = Some(other.to_owned());
                self.gain = match other {
                    "orientation" => Gain::Other("so3"),
                    "pid" => Gain::Other("pid"),
                    "dcmotor" => Gain::Other("dcmotor"),
                    "muscle" => Gain::Other("muscle"),
                    _ => Gain::Fixed,
                };
            }
        }
    }

    fn servo(&mut self, base: &Self, kp: f64, values: &Values<'_>, log: &mut Diagnostics) {
        let kp = values.number("kp", log).unwrap_or(kp);
        let not_negative = |name: &str, log: &mut Diagnostics| {
            let number = values.number(name, log);
            if let Some(number) = number.filter(|number| *number < 0.0) {
                values.error(name, Code::Number, format!("{number}"), "zero or more", log);
            }
            number
        };
        let [kv, ratio, time] = ["kv", "dampratio", "timeconst"].map(|name| not_negative(name, log));
        let inherited = if base.gain == Gain::Fixed { base.biases[2] } else { 0.0 };
        let damping = match (kv, ratio) {
            (Some(_), Some(_)) => {
                values.error("dampratio", Code::Together, "both kv and dampratio", "one of them", log);
                0.0
            }
            (Some(kv), None) => -kv,
            // Above zero it is a ratio, until the inertia is known.
            (None, Some(ratio)) => ratio,
            (None, None) => inherited,
        };
        (self.gains[0], self.biases[1], self.biases[2], self.bias) = (kp, -kp, damping, Bias::Affine);
        let range: Option<[f64; 2]> = values.exactly("ctrlrange", &mut log.apart());
        let inherited = values.number("inheritrange", log);
        if range.is_some_and(|range| range != [0.0; 2]) && inherited.is_some_and(|part| part > 0.0) {
            values.error("inheritrange", Code::Together, "both ctrlrange and inheritrange", "one of them", log);
        }
        if range.is_none() && inherited.is_some_and(|part| part > 0.0) {
            self.control_range = [0.0; 2];
        }
        self.inherit_range = inherited.unwrap_or(if range.is_some() { 0.0 } else { base.inherit_range });
        self.dynamics = match time {
            Some(time) if time > 0.0 => {
                self.times[0] = time;
                Dynamics::FilterExact
            }
            None if base.dynamics == Dynamics::FilterExact => Dynamics::FilterExact,
            _ => Dynamics::None,
        };
    }

    /// How many activations the file has for it.
    fn activations(&self) -> usize {
        match self.dynamics {
            Dynamics::None => 0,
            _ if self.activations > 0 => self.activations as usize,
            Dynamics::Integrator if matches!(self.gain, Gain::Other("so3")) => 3,
            _ => 1,
        }
    }

    /// The activation, with bounds after a range that its target has.
    fn activation(&self, range: Option<[f64; 2]>) -> Option<Activation> {
        // MuJoCo's least time constant.
        let time = self.times[0].max(1e-15);
        let filter = match self.dynamics {
            Dynamics::None | Dynamics::Other(_) => return None,
            Dynamics::Integrator => Filter::Integrator,
            Dynamics::Filter => Filter::Euler(time),
            Dynamics::FilterExact => Filter::Exact(time),
        };
        Some(Activation { filter, range, is_early: self.is_early })
    }

    /// How many controls it has.
    fn controls(&self) -> usize {
        let tokens = self.input.as_deref().map(|input| input.split_ascii_whitespace().count());
        match self.gain {
            Gain::Other("so3") => 3 + usize::from(self.input.as_deref() == Some("quat")),
            Gain::Other("pid") => tokens.filter(|count| *count > 0).unwrap_or(2),
            Gain::Other("dcmotor") if self.input.as_deref() == Some("none") => 0,
            Gain::Other("dcmotor") => tokens.filter(|count| *count > 0).unwrap_or(1),
            _ => 1,
        }
    }

    /// Whether the control is a target length of the force.
    fn is_servo(&self) -> bool {
        (self.gain, self.bias) == (Gain::Fixed, Bias::Affine) && self.gains[0] == -self.biases[1]
    }

    /// The reason why it is not read, apart from its target.
    fn obstacle(&self, simulation: &Simulation<'_>) -> Option<String> {
        if let Some(kind) = &self.foreign {
            return Some(format!("an actuator of the kind <{kind}>"));
        }
        if simulation.flags().no_actuation {
            return Some("an actuator, where a flag of <option> turns actuators off".to_owned());
        }
        if simulation.disabled_groups.contains(&self.group) {
            return Some("an actuator of a group that <option> turns off".to_owned());
        }
        match (self.dynamics, self.gain, self.bias) {
            (Dynamics::Other(word), ..) => Some(format!("an actuator with a state (dyntype {word})")),
            (dynamics, ..) if dynamics != Dynamics::None && self.activations > 1 => {
                Some(format!("an actuator with {} activations", self.activations))
            }
            (_, Gain::Other(word), _) => Some(format!("an actuator with a gain that is not affine (gaintype {word})")),
            (.., Bias::Other(word)) => Some(format!("an actuator with a bias that is not affine (biastype {word})")),
            _ if self.delay > 0.0 => Some("an actuator with a delay".to_owned()),
            _ => None,
        }
    }

    /// The law of the force, without a damping ratio.
    fn law(&self) -> ([f64; 3], [f64; 3]) {
        let first = |all: &[f64; 10]| [all[0], all[1], all[2]];
        let gain = if self.gain == Gain::Affine { first(&self.gains) } else { [self.gains[0], 0.0, 0.0] };
        (gain, if self.bias == Bias::None { [0.0; 3] } else { first(&self.biases) })
    }

    /// The bounds of control, force and activation of an actuator with a target of this range.
    fn bounds(&self, element: &Element, settings: &Settings<'_>, target: Option<[f64; 2]>, log: &mut Diagnostics) -> [Option<[f64; 2]>; 3] {
        let (mut control, mut activation) = (self.control_range, self.activation_range);
        if self.is_servo() && self.inherit_range > 0.0 {
            match target {
                Some([lower, upper]) if lower != upper => {
                    let (middle, radius) = ((lower + upper) / 2.0, (upper - lower) / 2.0 * self.inherit_range);
                    let inherited = if self.dynamics == Dynamics::Integrator { &mut activation } else { &mut control };
                    *inherited = [middle - radius, middle + radius];
                }
                _ => {
                    let expected = "an actuator on a joint or a tendon that has a range";
                    element.error((&Subject::Document, "inheritrange"), Code::LimitMissing, "no range to inherit", expected, log);
                }
            }
        }
        let sides = [
            ("ctrllimited", "ctrlrange", self.control_limited, control),
            ("forcelimited", "forcerange", self.force_limited, self.force_range),
            ("actlimited", "actrange", self.activation_limited, activation),
        ];
        sides.map(|(flag, field, limited, range)| {
            let is_limited = match limited {
                Some(limited) => limited,
                None if !settings.compiler.auto_limits && range != [0.0; 2] => {
                    let expected = format!("{flag}, since <compiler autolimits=\"false\">");
                    element.error((&Subject::Document, field), Code::LimitIncomplete, "a range alone", expected, log);
                    false
                }
                None => range[0] < range[1],
            };
            if is_limited && range[0] >= range[1] {
                let found = format!("{} and {}", range[0], range[1]);
                element.error((&Subject::Document, field), Code::LimitOrder, found, "the lower bound, then a greater one", log);
            }
            is_limited.then_some(range)
        })
    }
}

fn of_word<T: Copy>(values: &Values<'_>, name: &str, words: &[(&str, T)], base: T, log: &mut Diagnostics) -> T {
    values.word(name, words, log).unwrap_or(base)
}

/// Target of an actuator.
struct Target {
    drives: Drives,
    /// The indices of the site and of its reference in the scope.
    site: Option<(usize, Option<usize>)>,
    /// The path that it pulls, and the length for a unit of each rate in the reference pose.
    path: Option<(Vec<Strand>, Drives)>,
    /// Of the coordinate or length, if it has one.
    range: Option<[f64; 2]>,
    is_ball: bool,
}

impl Target {
    /// Length for a unit of each rate in the reference pose; empty of a site.
    fn row(&self) -> &Drives {
        self.path.as_ref().map_or(&self.drives, |(_, row)| row)
    }

    /// The frames on which it acts, in place of joints.
    fn frames(&self, general: &General, links: &[String], scope: &Scope<'_>) -> Option<OnFrames> {
        let path = self.path.as_ref().map(|(strands, _)| OnFrames::Path(strands.clone()));
        path.or_else(|| self.site.map(|site| OnFrames::Site(Box::new(pushed(site, general, links, scope)))))
    }
}

/// Reads all actuators; returns the controls of the whole file, and the inertias of tendons and
/// actuators.
pub(crate) fn actuators(
    scope: &mut Scope<'_>,
    tendons: &[Tendon],
    simulation: &Simulation<'_>,
    (description, links): (&Description, &[String]),
    world: &mut World,
    log: &mut Diagnostics,
) -> (Vec<Control>, Vec<Rotor>) {
    let mut controls = Vec::new();
    let of_tendon = |tendon: &Tendon| Rotor { armature: tendon.armature, row: tendon.row(), of_joints: false };
    let mut rotors: Vec<Rotor> = tendons.iter().map(of_tendon).collect();
    // Actuators with a ratio of damping instead of a coefficient
    let mut ratios: Vec<(usize, &Element)> = Vec::new();
    let mut rows: Vec<Drives> = Vec::new();
    // Of each class of each document
    let mut defaults: BTreeMap<(*const Settings<'_>, usize), Vec<General>> = BTreeMap::new();
    let mut number = 0;
    for index in 0..scope.tree.parts.len() {
        if scope.is_full() {
            break;
        }
        let part = scope.part(index);
        for element in part.settings.actuators.iter().copied().filter(|element| is_actuator(&element.name)) {
            let references = references(element, log);
            let Some(found) = scope.resolve(index, element, &references, log) else { continue };
            let class = part.settings.classes.find(element, "class", log).unwrap_or(0);
            let of_class = defaults.entry((Rc::as_ptr(&part.settings), class));
            let mut general = General::of(element, of_class.or_insert_with(|| General::defaults(class, &part.settings, log)), log);
            let name = scope.full(index, element).unwrap_or_else(|| format!("actuator_{number}"));
            number += 1;
            let target_of = references.first().zip(found.first()).map(|((_, field, _), at)| (*field, *at));
            let mut target = match target_of {
                Some((field, at)) => target(field, at, &general, scope, tendons),
                None => Err("an actuator that acts on nothing"),
            };
            if let (Ok(Target { site: Some((_, reference)), .. }), true) = (&mut target, element.attribute("refsite").is_some()) {
                *reference = found.get(1).copied();
            }
            let obstacle = general.obstacle(simulation).or(target.as_ref().err().map(|why| (*why).to_owned()));
            if let Ok(target) = &target {
                if simulation.flags().no_damper {
                    general.damping = [0.0; 3];
                }
                passive(&name, element, &general, (target, links), scope, world, log);
                rotors.push(Rotor { armature: general.armature, row: Some(target.row().clone()), of_joints: target.path.is_none() });
            }
            let read = match (obstacle, target) {
                (None, Ok(target)) => {
                    let [control_range, force_range, activation_range] = general.bounds(element, &part.settings, target.range, log);
                    let (gain, bias) = general.law();
                    if target.is_ball && general.is_servo() {
                        let expected = "targets within half a turn of the length: this is as written, and MuJoCo takes the nearest of \
                                        the targets that whole turns make";
                        scope.warn(element, "", ("a servo of a ball joint", expected), log);
                    }
                    if general.gains[0] == -general.biases[1] && general.bias == Bias::Affine && bias[2] > 0.0 {
                        ratios.push((world.actuators.len(), element));
                    }
                    let names = target.drives.iter().map(|(joint, gear)| (scope.joints[*joint].name.to_owned(), gear.clone()));
                    world.actuators.push(Actuator {
                        name,
                        drives: names.collect(),
                        frames: target.frames(&general, links, scope),
                        gain,
                        bias,
                        terms: None,
                        control_range: control_range.filter(|_| !simulation.flags().no_clamp),
                        force_range,
                        activation: general.activation(activation_range),
                        place: scope.place(element),
                    });
                    rows.push(target.row().clone());
                    Some(world.actuators.len() - 1)
                }
                (why, _) => {
                    let why = why.unwrap_or_default();
                    lose(element, &why, scope, log);
                    None
                }
            };
            let activations = |k: usize| if k == 0 { general.activations() } else { 0 };
            controls.extend((0..general.controls()).map(|k| Control { part: index, actuator: read, activations: activations(k) }));
        }
    }
    let lost = damp(&ratios, (&rotors, &rows), scope, description, world, log);
    forget(&lost, &mut controls, world);
    (controls, rotors)
}

const LOST: &str = "a force that is affine in control, length and rate: this actuator gives no force";

fn lose(element: &Element, why: &str, scope: &mut Scope<'_>, log: &mut Diagnostics) {
    scope.unread(element, &format!("{why} is not read"), Some((why, LOST)), log);
}

/// References of an actuator: its target first.
fn references<'a>(element: &'a Element, log: &mut Diagnostics) -> References<'a> {
    let mut all: References<'_> = TARGETS.iter().filter_map(|(field, sort)| Some((*sort, *field, element.text(field)?))).collect();
    let expected = "one of joint, jointinparent, tendon, site, cranksite and body";
    match all.as_slice() {
        [] => element.error((&Subject::Document, "joint"), Code::MissingAttribute, "none", expected, log),
        [_] => {}
        [_, (_, field, _), ..] => element.error((&Subject::Document, field), Code::Together, "two things to act on", expected, log),
    }
    let others = ["refsite", "slidersite"];
    all.extend(others.iter().filter_map(|field| Some((Sort::Site, *field, element.text(field)?))));
    all
}

fn target(field: &str, index: usize, general: &General, scope: &Scope<'_>, tendons: &[Tendon]) -> Result<Target, &'static str> {
    let gear = general.gear[0];
    match field {
        "joint" | "jointinparent" => {
            let joint = scope.joints[index].joint;
            let is_ball = joint.kind == Kind::Ball;
            let gears = match joint.kind {
                Kind::Hinge | Kind::Slide => vec![gear],
                Kind::Ball if field == "joint" => general.gear[..3].to_vec(),
                Kind::Ball => return Err("an actuator of a ball joint in axes of the parent"),
                Kind::Free => return Err("an actuator of a free joint"),
            };
            let range = (!is_ball && field == "joint").then_some(joint.range);
            Ok(Target { drives: vec![(index, gears)], range, is_ball, site: None, path: None })
        }
        "tendon" => {
            let tendon = &tendons[index];
            let scale = |(joint, row): (usize, Vec<f64>)| (joint, row.iter().map(|x| gear * x).collect());
            let row: Drives = tendon.row().unwrap_or_default().into_iter().map(scale).collect();
            let (range, is_ball, site) = (Some(tendon.range), false, None);
            match &tendon.course {
                Course::Sum(_) => Ok(Target { drives: row, range, is_ball, site, path: None }),
                Course::Path(path) => {
                    let strand = |own: &Strand| Strand { factor: gear * own.factor, ..own.clone() };
                    let path = Some((path.strands.iter().map(strand).collect(), row));
                    Ok(Target { drives: Vec::new(), range, is_ball, site, path })
                }
                Course::Unread => Err("an actuator of a tendon around a geom"),
            }
        }
        "site" => Ok(Target { drives: Vec::new(), range: None, is_ball: false, site: Some((index, None)), path: None }),
        "cranksite" => Err("an actuator of a crank"),
        _ => Err("an actuator of the contacts of a body"),
    }
}

/// The frame of an actuator, and its reference, by the links of their bodies.
fn pushed((site, reference): (usize, Option<usize>), general: &General, links: &[String], scope: &Scope<'_>) -> Site {
    let frame = |index: usize| {
        let (site, body) = scope.sites[index];
        (links[body].clone(), site.pose.origin())
    };
    Site { at: frame(site), reference: reference.map(frame), gear: general.gear }
}

/// The one joint of one degree that is driven, and the gear.
pub(crate) fn on_one_joint(drives: &Drives, scope: &Scope<'_>) -> Option<(usize, f64)> {
    let [(joint, gear)] = drives.as_slice() else { return None };
    let is_scalar = matches!(scope.joints[*joint].joint.kind, Kind::Hinge | Kind::Slide);
    gear.first().filter(|_| is_scalar).map(|gear| (*joint, *gear))
}

/// The damping of an actuator acts without its control: −d gear² on its target.
fn passive(
    name: &str,
    element: &Element,
    general: &General,
    (target, links): (&Target, &[String]),
    scope: &mut Scope<'_>,
    world: &mut World,
    log: &mut Diagnostics,
) {
    let [damping, second, third] = general.damping;
    if general.armature != 0.0 && on_one_joint(&target.drives, scope).is_none() {
        let expected = "that of a hinge or a slide: this one is not read";
        scope.warn(element, "armature", ("armature of an actuator", expected), log);
    }
    let is_of_length = !target.is_ball && target.site.is_none();
    if [second, third] != [0.0; 2] || (damping != 0.0 && !is_of_length) {
        let expected = "one coefficient, of a hinge, a slide or a tendon: else it is not used";
        scope.warn(element, "damping", ("damping of an actuator", expected), log);
    }
    if damping != 0.0 && is_of_length {
        let names = target.drives.iter().map(|(joint, gear)| (scope.joints[*joint].name.to_owned(), gear.clone()));
        world.passive.push(Actuator {
            name: name.to_owned(),
            drives: names.collect(),
            frames: target.frames(general, links, scope),
            bias: [0.0, 0.0, -damping],
            place: scope.place(element),
            ..Actuator::default()
        });
    }
}

/// Turns damping ratios into coefficients: b₂ = −2 ζ √(kp m) with the mass m felt by the actuator
/// at the reference state. Returns those without such a mass.
fn damp(
    ratios: &[(usize, &Element)],
    (rotors, rows): (&[Rotor], &[Drives]),
    scope: &mut Scope<'_>,
    description: &Description,
    world: &mut World,
    log: &mut Diagnostics,
) -> Vec<usize> {
    let mut lost = Vec::new();
    if ratios.is_empty() {
        return lost;
    }
    let inertia = Inertia::at_reference(ratios.len(), description, scope, rotors, log);
    for (index, element) in ratios {
        let known = inertia.as_ref().map_err(|why| *why);
        let mass = known.and_then(|inertia| inertia.reflected(&rows[*index]).ok_or(Unknown::Singular));
        let actuator = &mut world.actuators[*index];
        match mass {
            Ok(mass) if actuator.gain[0] >= 0.0 => actuator.bias[2] = -2.0 * actuator.bias[2] * (actuator.gain[0] * mass).sqrt(),
            Ok(_) => {
                lose(element, "an actuator with a dampratio and kp below zero", scope, log);
                lost.push(*index);
            }
            // These errors are already reported.
            Err(Unknown::Mistakes) => {}
            Err(why) => {
                lose(element, &why.found("an actuator with a dampratio"), scope, log);
                lost.push(*index);
            }
        }
    }
    lost
}

/// Removes actuators.
fn forget(lost: &[usize], controls: &mut [Control], world: &mut World) {
    for index in lost.iter().rev() {
        world.actuators.remove(*index);
        for control in controls.iter_mut() {
            control.actuator = control.actuator.filter(|own| own != index).map(|own| if own > *index { own - 1 } else { own });
        }
    }
}
