//! The section `<tendon>`: sums of coordinates and paths over sites, with springs and dampers on
//! them.

use articulated_core::actuator::Terms;
use articulated_core::description::Description;
use articulated_core::diagnostic::{Code, Diagnostics, Subject};

use super::bodies::Kind;
use super::contact::SoftJoint;
use super::element::Element;
use super::paths::{Path, Places};
use super::reflected::Drives;
use super::scope::{References, Scope, Sort};
use super::settings::Settings;
use super::simulation::Flags;
use super::values::Values;
use crate::world::{Actuator, OnFrames, TouchingLength};

/// A tendon of one copy of a tag.
pub(crate) struct Tendon {
    pub(crate) name: String,
    pub(crate) course: Course,
    /// Bound or not, m.
    pub(crate) range: [f64; 2],
    pub(crate) armature: f64,
    /// Whether its range is a limit.
    pub(crate) is_limited: bool,
    /// How limits and dry friction give way.
    pub(crate) soft: SoftJoint,
}

/// What the length of a tendon is.
pub(crate) enum Course {
    /// A sum of coordinates: joints by index, each once, with the lengths for a unit of their
    /// coordinates.
    Sum(Vec<(usize, f64)>),
    /// That of a path.
    Path(Path),
    /// It is not read: it goes around a geom.
    Unread,
}

impl Tendon {
    /// The joints of a fixed tendon; none of a spatial one.
    pub(crate) fn terms(&self) -> &[(usize, f64)] {
        if let Course::Sum(terms) = &self.course { terms } else { &[] }
    }

    /// Length for a unit of each rate in the reference pose, if it is known.
    pub(crate) fn row(&self) -> Option<Drives> {
        match &self.course {
            Course::Sum(terms) => Some(terms.iter().map(|(joint, factor)| (*joint, vec![*factor])).collect()),
            Course::Path(path) => Some(path.row.clone()),
            Course::Unread => None,
        }
    }

    /// Its length, and that in the reference pose. `None`: it is not read.
    pub(crate) fn length(&self, scope: &Scope<'_>) -> Option<(TouchingLength, f64)> {
        match &self.course {
            Course::Sum(terms) => Some(length_of(terms, scope)),
            Course::Path(path) => Some((TouchingLength::Path(path.strands.clone()), path.at_reference)),
            Course::Unread => None,
        }
    }

    /// What constrains it.
    pub(crate) fn constraint(&self) -> Option<&'static str> {
        match (self.is_limited, self.soft.loss != 0.0) {
            (true, _) => Some("limits"),
            (false, true) => Some("dry friction"),
            (false, false) => None,
        }
    }
}

/// The length that is a sum of coordinates, and the one in the reference pose.
pub(crate) fn length_of(terms: &[(usize, f64)], scope: &Scope<'_>) -> (TouchingLength, f64) {
    let named = terms.iter().map(|(joint, factor)| (scope.joints[*joint].name.to_owned(), *factor)).collect();
    (TouchingLength::Sum(named), terms.iter().map(|(joint, factor)| factor * scope.joints[*joint].joint.reference).sum())
}

const LIMITED: &str = "functions with constraints: its limits do not bound other motions";

/// All tendons. Their springs and dampers become `passive`.
pub(crate) fn tendons(
    scope: &mut Scope<'_>,
    flags: Flags,
    (description, links): (&Description, &[String]),
    passive: &mut Vec<Actuator>,
    log: &mut Diagnostics,
) -> Vec<Tendon> {
    let (mut all, mut places) = (Vec::new(), Places::new(description, links));
    for index in 0..scope.tree.parts.len() {
        if scope.is_full() {
            break;
        }
        let part = scope.part(index);
        for element in part.settings.tendons.iter().copied() {
            let references = references(element, log);
            let Some(found) = scope.resolve(index, element, &references, log) else { continue };
            let class = part.settings.classes.find(element, "class", log).unwrap_or(0);
            let values = Values::new(element, part.settings.classes.tags(class, "tendon"), &Subject::Document);
            let own = Own::of(&values, &part.settings, log).with(flags);
            let full = scope.full(index, element);
            scope.add(Sort::Tendon, element, full.as_ref(), (all.len(), index));
            let name = full.unwrap_or_else(|| format!("tendon_{}", all.len()));
            let tendon = Tendon {
                name,
                course: match element.is("fixed") {
                    true => Course::Sum(own.terms(scope, &found, log)),
                    false => places.path(element, &found, scope, log).map_or(Course::Unread, Course::Path),
                },
                range: own.range,
                armature: own.armature,
                is_limited: own.is_limited,
                soft: SoftJoint::of(&values, flags, log),
            };
            own.force(&tendon, scope, passive, log);
            all.push(tendon);
        }
    }
    all
}

/// Elements of a tendon.
fn references<'a>(element: &'a Element, log: &mut Diagnostics) -> References<'a> {
    let mut all = Vec::new();
    for inner in &element.children {
        let (sort, field) = match (element.is("fixed"), inner.name.as_str()) {
            (true, "joint") => (Sort::Joint, "joint"),
            (false, "site") => (Sort::Site, "site"),
            _ => continue,
        };
        match inner.text(field) {
            Some(name) => all.push((sort, field, name)),
            None => inner.error((&Subject::Document, field), Code::MissingAttribute, "none", format!("the name of a {field}"), log),
        }
    }
    if element.is("fixed") && element.children.is_empty() {
        element.error((&Subject::Document, ""), Code::MissingAttribute, "no <joint>", "the joints of the tendon", log);
    }
    all
}

/// The numbers of a tag.
struct Own<'a> {
    element: &'a Element,
    stiffness: f64,
    damping: f64,
    /// Rest lengths of the spring, without force between them; `None`: the length with the joints
    /// at rest.
    rest: Option<[f64; 2]>,
    range: [f64; 2],
    is_limited: bool,
    is_force_limited: bool,
    armature: f64,
    friction: f64,
    yields: bool,
    /// The coefficients of higher degree.
    higher_stiffness: [f64; 2],
    higher_damping: [f64; 2],
}

impl<'a> Own<'a> {
    fn of(values: &Values<'a>, settings: &Settings<'_>, log: &mut Diagnostics) -> Self {
        let [stiffness, k2, k3] = values.at_most("stiffness", [0.0; 3], log);
        let [damping, d2, d3] = values.at_most("damping", [0.0; 3], log);
        let lengths = values.list("springlength", log).unwrap_or_else(|| vec![-1.0]);
        let rest = match lengths.as_slice() {
            [length] => [*length; 2],
            [lower, upper] => [*lower, *upper],
            other => {
                values.error("springlength", Code::WrongCount, format!("{} numbers", other.len()), "one or two lengths", log);
                [-1.0; 2]
            }
        };
        if rest[0] > rest[1] {
            values.error("springlength", Code::LimitOrder, format!("{} and {}", rest[0], rest[1]), "the shorter length first", log);
        }
        let range = |name: &str, log: &mut Diagnostics| values.exactly::<2>(name, log).unwrap_or_default();
        let (length, force) = (range("range", log), range("actuatorfrcrange", log));
        let bound = |flag: &str, range: [f64; 2], log: &mut Diagnostics| {
            let auto = settings.compiler.auto_limits && range[0] < range[1];
            values.yes_or_auto(flag, log).unwrap_or(auto)
        };
        let number = |name: &str, log: &mut Diagnostics| values.number(name, log).unwrap_or(0.0);
        Self {
            element: values.element,
            stiffness,
            damping,
            rest: (rest != [-1.0; 2]).then_some(rest),
            range: length,
            is_limited: bound("limited", length, log),
            is_force_limited: bound("actuatorfrclimited", force, log),
            armature: number("armature", log),
            friction: number("frictionloss", log),
            yields: number("springyield", log) > 0.0,
            higher_stiffness: [k2, k3],
            higher_damping: [d2, d3],
        }
    }

    /// Without the forces that the flags turn off.
    fn with(mut self, flags: Flags) -> Self {
        if flags.no_spring {
            (self.stiffness, self.higher_stiffness, self.yields) = (0.0, [0.0; 2], false);
        }
        if flags.no_damper {
            (self.damping, self.higher_damping) = (0.0, [0.0; 2]);
        }
        if flags.no_friction {
            self.friction = 0.0;
        }
        self.is_limited &= !flags.no_limit;
        self
    }

    fn has_higher_terms(&self) -> bool {
        self.higher_stiffness != [0.0; 2] || self.higher_damping != [0.0; 2]
    }

    /// The joints of these indices with their factors.
    fn terms(&self, scope: &Scope<'_>, found: &[usize], log: &mut Diagnostics) -> Vec<(usize, f64)> {
        let mut terms: Vec<(usize, f64)> = Vec::new();
        let with_names = self.element.all("joint").filter(|inner| inner.attribute("joint").is_some());
        for (inner, joint) in with_names.zip(found) {
            let mut error = |field: &str, code: Code, found: &str, expected: &str| {
                inner.error((&Subject::Document, field), code, found, expected, log);
            };
            if !matches!(scope.joints[*joint].joint.kind, Kind::Hinge | Kind::Slide) {
                error("joint", Code::Unsupported, "a joint of several coordinates", "a hinge or a slide");
            }
            if terms.iter().any(|(known, _)| known == joint) {
                error("joint", Code::DuplicateName, "the same joint again", "each joint once");
            }
            if inner.attribute("coef").is_none() {
                error("coef", Code::MissingAttribute, "none", "the length for a unit of the joint");
            }
            terms.push((*joint, Values::alone(inner, &Subject::Document).number("coef", log).unwrap_or(0.0)));
        }
        terms
    }

    /// f = −k (l − l₀) − d l̇. A spring between two lengths l₁ < l₂ is two: one pulls where l > l₂,
    /// one pushes where l < l₁. Terms of higher degree are a force of their own.
    fn force(&self, tendon: &Tendon, scope: &mut Scope<'_>, passive: &mut Vec<Actuator>, log: &mut Diagnostics) {
        let element = self.element;
        let has_force = [self.stiffness, self.damping, self.friction, self.armature] != [0.0; 4] || self.has_higher_terms();
        if matches!(tendon.course, Course::Unread) {
            let lost = ("a tendon around a geom with forces", "tendons of straight lines: the motion is that without it");
            let why = "the length of a tendon around a geom is not computed";
            scope.unread(element, why, (has_force || self.is_limited).then_some(lost), log);
            return;
        }
        let losses = [
            (self.is_limited, "range", ("limits of a tendon", LIMITED)),
            (self.is_force_limited, "actuatorfrcrange", ("limits of the forces on a tendon", "those of its actuators and joints")),
            (self.friction != 0.0, "frictionloss", ("friction of a tendon", "functions with constraints: it acts in these alone")),
            (self.armature != 0.0, "armature", ("armature of a tendon", "armature of the joints: that of tendons is not read")),
            (self.yields, "springyield", ("a spring that yields", "a spring that does not: it is elastic")),
        ];
        for (_, field, lost) in losses.iter().filter(|(is_lost, ..)| *is_lost) {
            scope.warn(element, field, *lost, log);
        }
        let at_rest = match &tendon.course {
            Course::Path(path) => path.at_rest,
            _ => tendon.terms().iter().map(|(joint, factor)| factor * scope.joints[*joint].joint.rest).sum(),
        };
        let (stiffness, [lower, upper]) = (self.stiffness, self.rest.unwrap_or([at_rest; 2]));
        let drives: Vec<_> = tendon.terms().iter().map(|(joint, factor)| (scope.joints[*joint].name.to_owned(), vec![*factor])).collect();
        let frames = if let Course::Path(path) = &tendon.course { Some(OnFrames::Path(path.strands.clone())) } else { None };
        let place = scope.place(element);
        let mut push = |bias: [f64; 3], force_range: Option<[f64; 2]>, terms: Option<Terms>| {
            if bias != [0.0; 3] || terms.is_some() {
                let (name, drives, frames) = (tendon.name.clone(), drives.clone(), frames.clone());
                passive.push(Actuator { name, drives, frames, bias, terms, force_range, place, ..Actuator::default() });
            }
        };
        if stiffness == 0.0 || lower == upper {
            push([stiffness * lower, -stiffness, -self.damping], None, None);
        } else {
            push([0.0, 0.0, -self.damping], None, None);
            let (mut below, mut above) = ([0.0, f64::INFINITY], [f64::NEG_INFINITY, 0.0]);
            if stiffness < 0.0 {
                std::mem::swap(&mut below, &mut above);
            }
            push([stiffness * lower, -stiffness, 0.0], Some(below), None);
            push([stiffness * upper, -stiffness, 0.0], Some(above), None);
        }
        if self.has_higher_terms() {
            let (stiffness, damping) = (self.higher_stiffness, self.higher_damping);
            push([0.0; 3], None, Some(Terms { rest: [lower, upper], stiffness, damping }));
        }
    }
}
