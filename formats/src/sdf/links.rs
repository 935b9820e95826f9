//! Links and their masses.

use articulated_core::description::{Inertial, PrincipalMoments};
use articulated_core::diagnostic::{Code, Diagnostics, Subject, quote};

use super::grammar::{AUTO, subject};
use super::names::relative_to;
use super::values::{self, flag, number, only, yes};
use crate::Options;
use crate::mass::beyond_any_mass;
use crate::pose::Pose;
use crate::urdf::ALLOW_UNPHYSICAL_INERTIA;
use crate::xml::tree::Element;

pub(crate) struct Link<'a> {
    pub(crate) element: &'a Element,
    pub(crate) node: usize,
    pub(crate) scope: usize,
    pub(crate) inertial: Option<Inertial>,
    /// Whether it belongs to a static model.
    pub(crate) is_static: bool,
}

/// Default of a link without `<inertial>`, `<mass>` or `<inertia>`, kg and kg·m².
const DEFAULT: f64 = 1.0;

/// The mass properties of a link; `None` for zero, and if they are invalid.
pub(crate) fn inertial(link: &Element, is_static: bool, options: &Options, log: &mut Diagnostics) -> Option<Inertial> {
    let about = &subject(link);
    lost(link, about, log);
    let of_default = |element: &Element, name: &str, what: &str, log: &mut Diagnostics| {
        // The mass of a link that does not move has no effect.
        if is_static {
            return;
        }
        let expected = format!("<{name}> inside <{}>: the format's default is used, {what}", element.name);
        element.warning((about, name), Code::MissingTag, "none", expected, log);
    };
    let Some(tag) = only(link, "inertial", about, log) else {
        of_default(link, "inertial", "1 kg and moments of inertia of 1 kg·m²", log);
        return Some(Inertial { origin: Pose::default().origin(), mass: DEFAULT, inertia: [DEFAULT, 0.0, 0.0, DEFAULT, 0.0, DEFAULT] });
    };
    medium(tag, about, log);
    if flag(tag, "auto", about, log) {
        // Computed when the poses of shapes are known.
        return None;
    }
    let shapes = link.children.iter().filter(|child| child.is("collision"));
    for density in shapes.chain([tag]).flat_map(|within| within.all("density")) {
        density.unused(about, None, AUTO, log);
    }
    let pose = only(tag, "pose", about, log);
    if let Some(reference) = pose.and_then(|pose| relative_to(pose, 0)) {
        let expected = "no frame: the pose of an inertia is in the frame of its link";
        reference.element.error((about, reference.field), Code::Unsupported, quote(reference.name), expected, log);
    }
    let pose = pose.map(|pose| values::pose(pose, options.snap_angles, about, log)).unwrap_or_default();
    if !tag.children.iter().any(|child| child.is("mass")) {
        of_default(tag, "mass", "1 kg", log);
    }
    let mass = number(tag, "mass", about, log).unwrap_or(DEFAULT);
    let inertia = match only(tag, "inertia", about, log) {
        Some(moments) => ["ixx", "ixy", "ixz", "iyy", "iyz", "izz"].map(|name| {
            let is_product = matches!(name, "ixy" | "ixz" | "iyz");
            if !is_product && !moments.children.iter().any(|child| child.is(name)) {
                of_default(moments, name, "1 kg·m²", log);
            }
            number(moments, name, about, log).unwrap_or(if is_product { 0.0 } else { DEFAULT })
        }),
        None => {
            of_default(tag, "inertia", "moments of inertia of 1 kg·m²", log);
            [DEFAULT, 0.0, 0.0, DEFAULT, 0.0, DEFAULT]
        }
    };
    if !tag.file.converted {
        check(tag, mass, inertia, options, about, log);
    }
    (mass != 0.0 || inertia != [0.0; 6]).then_some(Inertial { origin: pose.origin(), mass, inertia })
}

/// Reports the added mass of a medium.
fn medium(inertial: &Element, about: &Subject, log: &mut Diagnostics) {
    if let Some(added) = only(inertial, "fluid_added_mass", about, log) {
        let expected = "no added mass: the dynamics are those without the medium";
        added.warning((about, "fluid_added_mass"), Code::LostDynamics, "the mass of a medium", expected, log);
    }
}

fn check(tag: &Element, mass: f64, inertia: [f64; 6], options: &Options, about: &Subject, log: &mut Diagnostics) {
    const EXPECTED: &str = "an inertia that is positive semi-definite";
    if mass < 0.0 {
        tag.error((about, "mass"), Code::NegativeMass, format!("a negative mass, {mass} kg"), "a mass of zero or more", log);
    }
    if let Some((found, expected)) = beyond_any_mass(mass) {
        tag.warning((about, "mass"), Code::Units, found, expected, log);
    }
    if mass == 0.0 && inertia != [0.0; 6] {
        let found = "a mass of zero with a rotational inertia that is not";
        tag.warning((about, "inertial"), Code::InertiaWithoutMass, found, "both or neither; used as written", log);
    }
    let moments = PrincipalMoments::of(inertia);
    if moments.are_negative() {
        let found = moments.to_string();
        if options.allow_unphysical_inertia {
            let expected = format!("{EXPECTED}; used as written");
            tag.warning((about, "inertia"), Code::InertiaNotPositive, found, expected, log);
        } else {
            let expected = format!("{EXPECTED}; {ALLOW_UNPHYSICAL_INERTIA} accepts it as written");
            tag.error((about, "inertia"), Code::InertiaNotPositive, found, expected, log);
        }
    } else if moments.miss_triangle() {
        let expected = format!("{}; used as written", PrincipalMoments::TRIANGLE);
        tag.warning((about, "inertia"), Code::InertiaTriangle, moments.to_string(), expected, log);
    }
}

/// Reports unread content that changes the motion of a link.
fn lost(link: &Element, about: &Subject, log: &mut Diagnostics) {
    let warn = |name: &str, found: &str, expected: &str, log: &mut Diagnostics| {
        let element = link.children.iter().find(|child| child.is(name)).unwrap_or(link);
        element.warning((about, name), Code::LostDynamics, found, expected, log);
    };
    if yes(link, "gravity", about, log) == Some(false) {
        warn("gravity", "a link without weight", "gravity on all links", log);
    }
    if yes(link, "kinematic", about, log) == Some(true) {
        warn("kinematic", "a link that forces do not move", "links that forces move", log);
    }
    if let Some(decay) = only(link, "velocity_decay", about, log) {
        let rates = ["linear", "angular"].map(|name| number(decay, name, about, log).unwrap_or(0.0));
        if rates != [0.0; 2] {
            warn("velocity_decay", "damping of the motion of a link", "effects of the scene, as `drag`", log);
        }
    }
}
