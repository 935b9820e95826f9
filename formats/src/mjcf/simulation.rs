//! The sections `<option>` of a document and of the models that it attaches.

use std::collections::{BTreeMap, BTreeSet};

use articulated_core::constraint::Cone;
use articulated_core::diagnostic::{Code, Diagnostics, Subject, quote};

use super::documents::Documents;
use super::element::Element;
use super::medium::Medium;
use super::values::Values;
use crate::world::Stepping;

/// The time step of a file without one, s.
const MUJOCO_STEP: f64 = 0.002;

/// Parts of the simulation that a flag turns off.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Flags {
    pub(crate) no_gravity: bool,
    pub(crate) no_actuation: bool,
    /// Controls go beyond their bounds.
    pub(crate) no_clamp: bool,
    pub(crate) no_equality: bool,
    /// Dry friction of joints and tendons.
    pub(crate) no_friction: bool,
    /// Limits of joints and tendons.
    pub(crate) no_limit: bool,
    pub(crate) no_contact: bool,
    pub(crate) no_spring: bool,
    pub(crate) no_damper: bool,
    /// Shapes of a body and of its parent touch.
    pub(crate) parents_touch: bool,
    /// Time constants may be shorter than two steps.
    pub(crate) any_time_constant: bool,
}

impl Flags {
    /// Without springs and dampers MuJoCo computes no passive force, so also none of the medium or
    /// `gravcomp`.
    pub(crate) fn no_passive_force(self) -> bool {
        self.no_spring && self.no_damper
    }
}

/// Rules for all bodies, from the main file.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rules {
    pub(crate) flags: Flags,
    /// Whether shapes are fitted to the corners of meshes, rather than to their inertia.
    pub(crate) fit_corners: bool,
}

/// The flags that are read, each with the effect if it is disabled; empty: that is reported
/// elsewhere.
const FLAGS: [(&str, &str); 13] = [
    ("gravity", ""),
    ("filterparent", ""),
    ("refsafe", ""),
    ("actuation", ""),
    ("clampctrl", ""),
    ("eulerdamp", ""),
    ("equality", ""),
    ("constraint", "it turns limits, dry friction, contact and equations off, as in MuJoCo: those of this file do nothing"),
    ("frictionloss", "it turns dry friction off, as in MuJoCo: that of this file does nothing"),
    ("limit", "it turns limits off, as in MuJoCo: those of this file do nothing"),
    ("contact", "it turns contact off, as in MuJoCo: no geom of this file makes contact"),
    ("spring", "it turns springs off, as in MuJoCo: those of this file do nothing"),
    ("damper", "it turns dampers off, as in MuJoCo: those of this file do nothing"),
];

/// Changes by an attached model to the options of the document that attaches it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Conflict {
    /// No change.
    #[default]
    Warning,
    /// Missing options; the smaller step and all flags that disable.
    Merge,
    /// No change, and two different values are an error.
    Error,
}

/// The settings of `<option>`.
#[derive(Clone, Debug, Default)]
pub(crate) struct Simulation<'a> {
    /// m/s².
    pub(crate) gravity: Option<[f64; 3]>,
    /// s.
    pub(crate) step: Option<f64>,
    pub(crate) integrator: Option<String>,
    /// kg/m³ and Pa·s.
    density: Option<f64>,
    viscosity: Option<f64>,
    /// m/s.
    wind: Option<[f64; 3]>,
    /// The medium, if there is one.
    pub(crate) medium: Option<Medium>,
    /// The cone of friction, `impratio`, and the solver with its steps after the last one.
    pub(crate) cone: Option<Cone>,
    pub(crate) impedance_ratio: Option<f64>,
    pub(crate) solver: Option<&'static str>,
    pub(crate) noslip: i64,
    /// Flags that change the law of constraints, and are not read.
    pub(crate) constraint_flags: BTreeSet<&'static str>,
    /// Groups of actuators without force.
    pub(crate) disabled_groups: BTreeSet<i64>,
    /// Flags as the file has them: whether each is disabled.
    flags: BTreeMap<&'static str, bool>,
    /// The tags of options and flags, by their names.
    places: BTreeMap<&'static str, &'a Element>,
}

impl<'a> Simulation<'a> {
    /// For the main document, with the changes by attached models.
    pub(crate) fn of(documents: &'a Documents, log: &mut Diagnostics) -> Self {
        let mut all = Self::with_attached(0, documents, &mut BTreeSet::new(), log);
        for (flag, why) in FLAGS.iter().filter(|(flag, why)| !why.is_empty() && all.is_off(flag)) {
            if let Some(place) = all.places.get(flag) {
                place.unused(&Subject::Document, place.attribute(flag), why, log);
            }
        }
        let wind = all.wind.unwrap_or_default();
        let medium = Medium { density: all.density.unwrap_or(0.0), viscosity: all.viscosity.unwrap_or(0.0), wind };
        all.medium = Some(medium).filter(|medium| medium.density > 0.0 || medium.viscosity > 0.0);
        all
    }

    fn is_off(&self, flag: &str) -> bool {
        self.flags.get(flag) == Some(&true)
    }

    pub(crate) fn flags(&self) -> Flags {
        let no_constraint = self.is_off("constraint");
        Flags {
            no_gravity: self.is_off("gravity"),
            no_actuation: self.is_off("actuation"),
            no_clamp: self.is_off("clampctrl"),
            no_equality: no_constraint || self.is_off("equality"),
            no_friction: no_constraint || self.is_off("frictionloss"),
            no_limit: no_constraint || self.is_off("limit"),
            no_contact: no_constraint || self.is_off("contact"),
            no_spring: self.is_off("spring"),
            no_damper: self.is_off("damper"),
            parents_touch: self.is_off("filterparent"),
            any_time_constant: self.is_off("refsafe"),
        }
    }

    /// Gravity with its flag, m/s².
    pub(crate) fn gravity(&self) -> Option<[f64; 3]> {
        if self.is_off("gravity") { Some([0.0; 3]) } else { self.gravity }
    }

    /// How MuJoCo steps the motion.
    pub(crate) fn stepping(&self) -> Stepping {
        Stepping {
            integrator: self.integrator.clone().unwrap_or_else(|| "Euler".to_owned()),
            step: self.step.unwrap_or(MUJOCO_STEP),
            is_explicit_in_damping: self.is_off("eulerdamp"),
        }
    }

    /// For a document alone.
    fn alone(root: &'a Element, log: &mut Diagnostics) -> Self {
        let mut all = Self::default();
        for section in root.all("option") {
            let values = Values::alone(section, &Subject::Document);
            all.gravity = values.exactly("gravity", log).or(all.gravity);
            if let Some(step) = values.number("timestep", log) {
                if step <= 0.0 {
                    values.error("timestep", Code::Number, format!("{step}"), "a time step above zero, s", log);
                }
                all.step = Some(step);
            }
            let words = ["Euler", "RK4", "implicit", "implicitfast", "discrete"].map(|word| (word, word));
            all.integrator = values.word("integrator", &words, log).map(str::to_owned).or(all.integrator);
            all.cone = values.word("cone", &[("pyramidal", Cone::Pyramid), ("elliptic", Cone::Ellipse)], log).or(all.cone);
            all.impedance_ratio = values.number("impratio", log).or(all.impedance_ratio);
            all.solver = values.word("solver", &["PGS", "CG", "Newton"].map(|word| (word, word)), log).or(all.solver);
            all.noslip = values.integer("noslip_iterations", log).unwrap_or(all.noslip);
            all.density = values.number("density", log).or(all.density);
            all.viscosity = values.number("viscosity", log).or(all.viscosity);
            all.wind = values.exactly("wind", log).or(all.wind);
            all.disabled_groups.extend(values.list("actuatorgroupdisable", log).unwrap_or_default().iter().map(|group| *group as i64));
            for name in ["gravity", "timestep", "integrator", "density", "viscosity", "wind", "actuatorgroupdisable"] {
                if section.attribute(name).is_some() {
                    all.places.insert(name, section);
                }
            }
            for flag in section.all("flag") {
                let values = Values::alone(flag, &Subject::Document);
                all.constraint_flags.extend(["override", "diagexact"].into_iter().filter(|name| values.text(name) == Some("enable")));
                for (name, _) in FLAGS {
                    if let Some(disabled) = values.word(name, &[("disable", true), ("enable", false)], log) {
                        all.flags.insert(name, disabled);
                        // The gravity of the section is another value.
                        all.places.insert(if name == "gravity" { "gravity flag" } else { name }, flag);
                    }
                }
            }
        }
        all
    }

    /// For a document and its attached ones, one after the other. `above`: the documents that
    /// attach it.
    fn with_attached(document: usize, documents: &'a Documents, above: &mut BTreeSet<usize>, log: &mut Diagnostics) -> Self {
        let root = documents.root(document);
        let mut all = Self::alone(root, log);
        let policy = conflict(root, log);
        above.insert(document);
        let mut known = BTreeSet::new();
        for attach in attached(root) {
            let Some(other) = attach.text("model").and_then(|name| documents.model(document, name)) else { continue };
            if above.contains(&other) {
                continue;
            }
            if !known.insert(other) {
                continue;
            }
            // Errors in unused numbers do not count.
            let mut own = log.apart();
            let model = Self::with_attached(other, documents, above, &mut own);
            if policy == Conflict::Merge {
                log.take(own);
            }
            all.merge(&model, policy, attach, log);
        }
        above.remove(&document);
        all
    }

    /// Applies the options of an attached model, as far as the policy permits.
    fn merge(&mut self, other: &Self, policy: Conflict, attach: &Element, log: &mut Diagnostics) {
        let mut merge = Merge { policy, attach, log };
        let texts = |number: Option<f64>| number.map(|number| number.to_string());
        let vector = |all: Option<[f64; 3]>| all.map(|all| all.map(|number| number.to_string()).join(" "));
        if merge.takes("gravity", vector(self.gravity), vector(other.gravity), other) {
            self.take("gravity", other);
            self.gravity = other.gravity;
        }
        if merge.takes("integrator", self.integrator.clone(), other.integrator.clone(), other) {
            self.take("integrator", other);
            self.integrator.clone_from(&other.integrator);
        }
        if merge.takes("density", texts(self.density), texts(other.density), other) {
            self.take("density", other);
            self.density = other.density;
        }
        if merge.takes("wind", vector(self.wind), vector(other.wind), other) {
            self.take("wind", other);
            self.wind = other.wind;
        }
        if merge.takes("viscosity", texts(self.viscosity), texts(other.viscosity), other) {
            self.take("viscosity", other);
            self.viscosity = other.viscosity;
        }
        match (self.step, other.step) {
            // Of two steps the smaller one
            (Some(own), Some(step)) if policy == Conflict::Merge => self.step = Some(own.min(step)),
            (own, step) => {
                if merge.takes("timestep", texts(own), texts(step), other) {
                    self.step = step;
                }
            }
        }
        for (flag, disabled) in &other.flags {
            let own = self.flags.get(flag).copied();
            match policy {
                Conflict::Merge if *disabled && own != Some(true) => {
                    self.flags.insert(*flag, true);
                    self.take(flag, other);
                }
                Conflict::Merge => {}
                Conflict::Error if own.is_some_and(|own| own != *disabled) => merge.refuse(flag, "another value of the flag"),
                _ if own.unwrap_or_default() != *disabled => merge.keep(flag, other),
                _ => {}
            }
        }
        let groups: Vec<i64> = other.disabled_groups.difference(&self.disabled_groups).copied().collect();
        match policy {
            Conflict::Merge => self.disabled_groups.extend(groups),
            _ if !groups.is_empty() => merge.keep("actuatorgroupdisable", other),
            _ => {}
        }
    }

    fn take(&mut self, name: &'static str, other: &Self) {
        if let Some(place) = other.places.get(name) {
            self.places.insert(name, place);
        }
    }
}

/// The options of one attached model, compared with those of the document that attaches it.
struct Merge<'a, 'l> {
    policy: Conflict,
    attach: &'a Element,
    log: &'l mut Diagnostics,
}

impl Merge<'_, '_> {
    /// Whether the document takes a value of the model. Two values are an error or a warning.
    fn takes(&mut self, name: &'static str, own: Option<String>, value: Option<String>, other: &Simulation<'_>) -> bool {
        match (own, value) {
            (_, None) => false,
            (Some(own), Some(value)) if own == value => false,
            (None, Some(_)) if self.policy == Conflict::Merge => true,
            (Some(own), Some(value)) if self.policy != Conflict::Warning => {
                self.refuse(name, &format!("the {name} {value} beside {own}"));
                false
            }
            _ => {
                self.keep(name, other);
                false
            }
        }
    }

    fn refuse(&mut self, name: &str, found: &str) {
        let found = format!("{found} in the attached model {}", quote(self.attach.text("model").unwrap_or_default()));
        let word = if self.policy == Conflict::Merge { "merge" } else { "error" };
        let expected = format!("one value of {name}, since <compiler conflict=\"{word}\">");
        self.attach.error((&Subject::Document, "model"), Code::Together, found, expected, self.log);
    }

    /// Warns that a value of the model is not used.
    fn keep(&mut self, name: &str, other: &Simulation<'_>) {
        let found = format!("the {name} of the attached model {}", quote(self.attach.text("model").unwrap_or_default()));
        let expected = "that of the file that attaches it, which holds: <compiler conflict=\"merge\"> takes it from the model";
        let place = other.places.get(name).copied().unwrap_or(self.attach);
        place.warning((&Subject::Document, name), Code::LostDynamics, found, expected, self.log);
    }
}

/// The policy of a document; the last one counts.
fn conflict(root: &Element, log: &mut Diagnostics) -> Conflict {
    let words = [("warning", Conflict::Warning), ("merge", Conflict::Merge), ("error", Conflict::Error)];
    let of = |section: &Element, log: &mut Diagnostics| Values::alone(section, &Subject::Document).word("conflict", &words, log);
    root.all("compiler").fold(Conflict::default(), |before, section| of(section, log).unwrap_or(before))
}

/// The tags that attach models, in the order of the document.
fn attached(root: &Element) -> Vec<&Element> {
    let mut found = Vec::new();
    let mut next: Vec<&Element> = root.all("worldbody").collect();
    next.reverse();
    while let Some(element) = next.pop() {
        if element.is("attach") {
            found.push(element);
        }
        next.extend(element.children.iter().rev());
    }
    found
}
