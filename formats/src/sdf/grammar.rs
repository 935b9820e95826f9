//! The tags and attributes of the format: which are used, and why others are not.
//!
//! One pass over the document reports unused and unknown content. It does not look inside tags that
//! are unused as a whole.

use articulated_core::diagnostic::{Code, Diagnostics, Subject, quote};
use articulated_core::suggest::Suggester;

use super::names::ROOT;
use super::values::text;
use crate::xml::tree::{Attribute, Element};

/// Names between blanks.
type Names = &'static str;

/// A tag that is used.
struct Row {
    /// The names of tags with this content.
    names: Names,
    /// The names of the tags that it may be in; empty: any.
    within: Names,
    attributes: Names,
    /// The tags in it that are used.
    tags: Names,
    /// Tags and attributes in it that are not used, each with the reason.
    unused: &'static [(Names, &'static str)],
}

const APPEARANCE: &str = "appearance plays no part in the dynamics";
const CONTACT: &str = "contact parameters are given by the scene";
const COLLISION: &str = "no effect of a scene takes it (`contact` with `from = \"collision\"` does)";
const SIMULATOR: &str = "settings of a simulator";
const PLUGIN: &str = "plugins of a simulator are not read";
const SENSOR: &str = "sensors play no part in the dynamics";
const WORLD: &str = "of the world, models alone are read";
const LABEL: &str = "a label that nothing refers to";
/// Tags of forces at joints, with the names by which effects take their numbers.
const FORCES: [(&str, &str); 4] = [
    ("damping", "dynamics damping"),
    ("friction", "dynamics friction"),
    ("spring_stiffness", "joint stiffness"),
    ("spring_reference", "joint springref"),
];

pub(crate) const DYNAMICS: &str = "kept for scenes that turn on such forces; no part of the rigid-body dynamics";
const STOP: &str = "the stops of joints are given by the scene";
pub(crate) const AUTO: &str = "densities count where inertias are computed of shapes: `auto` of <inertial>";
const MESHES: &str = "parameters for meshes, of which no inertia is computed";
const MEDIUM: &str = "forces of the medium are given by the scene";
const FOREIGN: &str = "an extension of another program";

/// All tags that are used. A tag with two rows uses the first one whose parent matches.
const ROWS: &[Row] = &[
    Row { names: ROOT, within: "", attributes: "version", tags: "model world include", unused: &[("actor light", WORLD)] },
    Row {
        names: "world",
        within: ROOT,
        attributes: "name",
        tags: "model include frame joint gravity",
        unused: &[
            ("light scene actor road population state gui audio atmosphere magnetic_field spherical_coordinates", WORLD),
            ("wind", MEDIUM),
            ("physics", SIMULATOR),
            ("plugin", PLUGIN),
        ],
    },
    Row {
        names: "model",
        within: "",
        attributes: "name canonical_link placement_frame",
        tags: "static pose link joint frame model include",
        unused: &[
            ("self_collide allow_auto_disable namespace", SIMULATOR),
            ("enable_wind", MEDIUM),
            ("gripper", "settings of a controller"),
            ("plugin", PLUGIN),
        ],
    },
    Row {
        names: "include",
        within: "",
        attributes: "merge",
        tags: "uri name pose static placement_frame sdf",
        unused: &[("namespace", LABEL), ("plugin", PLUGIN)],
    },
    Row { names: "frame", within: "", attributes: "name attached_to", tags: "pose", unused: &[] },
    Row { names: "pose", within: "", attributes: "relative_to frame degrees rotation_format", tags: "", unused: &[] },
    Row {
        names: "link",
        within: "",
        attributes: "name",
        tags: "pose inertial collision visual gravity kinematic velocity_decay",
        unused: &[
            ("sensor", SENSOR),
            ("projector audio_sink audio_source light particle_emitter", APPEARANCE),
            ("battery self_collide must_be_base_link", SIMULATOR),
            ("enable_wind", MEDIUM),
        ],
    },
    Row { names: "velocity_decay", within: "", attributes: "", tags: "linear angular", unused: &[] },
    Row {
        names: "inertial",
        within: "",
        attributes: "auto",
        tags: "mass pose inertia fluid_added_mass density",
        unused: &[("auto_inertia_params", MESHES)],
    },
    Row { names: "inertia", within: "", attributes: "", tags: "ixx ixy ixz iyy iyz izz", unused: &[] },
    Row {
        names: "collision",
        within: "",
        attributes: "",
        tags: "pose geometry density",
        unused: &[("name", ""), ("laser_retro", SENSOR), ("max_contacts surface", CONTACT), ("auto_inertia_params", MESHES)],
    },
    Row {
        names: "visual",
        within: "",
        attributes: "",
        tags: "pose geometry material",
        unused: &[("name", ""), ("cast_shadows laser_retro transparency visibility_flags meta plugin", APPEARANCE)],
    },
    Row {
        names: "material",
        within: "",
        attributes: "",
        tags: "diffuse",
        unused: &[("script shader lighting ambient specular shininess emissive double_sided render_order pbr", APPEARANCE)],
    },
    Row {
        names: "geometry",
        within: "",
        attributes: "",
        tags: "box sphere cylinder capsule mesh ellipsoid plane cone heightmap image polyline empty drake:capsule drake:ellipsoid",
        unused: &[],
    },
    Row { names: "box", within: "geometry", attributes: "", tags: "size", unused: &[] },
    Row { names: "sphere", within: "geometry", attributes: "", tags: "radius", unused: &[] },
    Row { names: "cylinder capsule drake:capsule", within: "geometry", attributes: "", tags: "radius length", unused: &[] },
    Row {
        names: "mesh",
        within: "geometry",
        attributes: "",
        tags: "uri scale",
        unused: &[("submesh convex_decomposition optimization", "the mesh is not opened")],
    },
    Row {
        names: "joint",
        within: "",
        attributes: "name type",
        tags: "parent child pose axis axis2 thread_pitch screw_thread_pitch physics drake:rotor_inertia drake:gear_ratio",
        unused: &[("gearbox_ratio gearbox_reference_body", "it belongs to joints of the type gearbox"), ("sensor", SENSOR)],
    },
    Row { names: "physics", within: "joint", attributes: "", tags: "simbody", unused: &[("ode provide_feedback", SIMULATOR)] },
    Row { names: "simbody", within: "physics", attributes: "", tags: "must_be_loop_joint", unused: &[] },
    Row {
        names: "axis axis2",
        within: "joint",
        attributes: "",
        tags: "xyz use_parent_model_frame dynamics limit mimic",
        unused: &[("initial_position", "initial states are given by the scene")],
    },
    Row { names: "xyz", within: "axis axis2", attributes: "expressed_in", tags: "", unused: &[] },
    Row { names: "dynamics", within: "", attributes: "", tags: "damping friction spring_reference spring_stiffness", unused: &[] },
    Row { names: "limit", within: "", attributes: "", tags: "lower upper effort velocity", unused: &[("stiffness dissipation", STOP)] },
    Row { names: "mimic", within: "", attributes: "joint axis", tags: "multiplier offset reference", unused: &[] },
];

fn has(names: Names, name: &str) -> bool {
    names.split_ascii_whitespace().any(|own| own == name)
}

fn row_of(name: &str, within: &str) -> Option<&'static Row> {
    ROWS.iter().find(|row| has(row.names, name) && (row.within.is_empty() || has(row.within, within)))
}

fn reason(row: &Row, name: &str) -> Option<&'static str> {
    row.unused.iter().find(|(names, _)| has(names, name)).map(|(_, why)| *why)
}

/// Reports all unused and all unknown content.
pub(crate) fn check(root: &Element, log: &mut Diagnostics) {
    let mut suggester = Suggester::default();
    let mut next = vec![(root, "", Subject::Document)];
    while let Some((element, within, above)) = next.pop() {
        let Some(row) = row_of(&element.name, within).or_else(|| row_of(&element.name.to_ascii_lowercase(), within)) else { continue };
        let subject = match subject(element) {
            Subject::Document => above,
            own => own,
        };
        attributes(element, row, &subject, &mut suggester, log);
        if row.names == "dynamics" {
            for (child, (_, tag)) in
                element.children.iter().filter_map(|child| Some((child, FORCES.iter().find(|(name, _)| child.is(name))?)))
            {
                child.unused_part(&subject, (None, (*tag).to_owned()), DYNAMICS, log);
            }
        }
        if row.names == "collision" {
            element.unused(&subject, None, COLLISION, log);
        }
        if row.names == "visual" {
            element.unused(&subject, None, APPEARANCE, log);
        }
        for child in element.children.iter().rev().filter(|child| has(row.tags, &child.name)) {
            next.push((child, element.name.as_str(), subject.clone()));
        }
        for child in element.children.iter().filter(|child| !has(row.tags, &child.name)) {
            tag(child, element, row, &subject, &mut suggester, log);
        }
    }
}

/// Reports a tag that is not used.
fn tag(child: &Element, element: &Element, row: &Row, subject: &Subject, suggester: &mut Suggester, log: &mut Diagnostics) {
    if let Some(why) = reason(row, &child.name) {
        warn_of_coupling(child, subject, log);
        return child.unused(subject, None, why, log);
    }
    if element.is("mimic") {
        return law(child, None, subject, log);
    }
    if child.name.contains(':') {
        // Joints that Drake adds to the format.
        if child.name == "drake:joint" || child.name == "drake:mimic" {
            let expected = "<joint> and <mimic> of the format; ignored, so that the model is another one than there";
            child.warning((subject, &child.name), Code::LostDynamics, format!("<{}>", child.name), expected, log);
        }
        return child.unused(subject, None, FOREIGN, log);
    }
    let known = row.tags.split_ascii_whitespace().chain(row.unused.iter().flat_map(|(names, _)| names.split_ascii_whitespace()));
    let (code, expected) = expected(&child.name, known, suggester, "tag", &element.name);
    child.warning((subject, &child.name), code, format!("the tag <{}>", child.name), expected, log);
    child.unused(subject, None, "not known", log);
}

/// Reports an unknown attribute or tag of `<mimic>`: it may define another law.
fn law(element: &Element, attribute: Option<&Attribute>, subject: &Subject, log: &mut Diagnostics) {
    let found = match attribute {
        Some(own) => format!("the attribute {} = {} of <mimic>", own.name, quote(&own.value)),
        None => format!("the tag <{}> inside <mimic>", element.name),
    };
    let expected = "joint, axis, multiplier, offset and reference: q = multiplier · (q of the joint - reference) + offset is the one law \
                    that is read; remove what does not change it";
    let field = attribute.map_or(element.name.as_str(), |own| own.name.as_str());
    element.error((subject, field), Code::Unknown, found, expected, log);
}

/// Warns of a plugin that lets joints follow others.
fn warn_of_coupling(plugin: &Element, subject: &Subject, log: &mut Diagnostics) {
    let says = |name: &str| plugin.text(name).is_some_and(|text| text.to_ascii_lowercase().contains("mimic"));
    if plugin.is("plugin") && (says("filename") || says("name")) {
        let found = format!("a coupling of joints by the plugin {}", quote(plugin.text("name").unwrap_or_default()));
        let expected = "<mimic> inside <axis>: it is not read, and the joint moves by itself";
        plugin.warning((subject, "plugin"), Code::LostDynamics, found, expected, log);
    }
}

fn expected<'a>(
    name: &str,
    known: impl Iterator<Item = &'a str> + Clone,
    suggester: &mut Suggester,
    what: &str,
    within: &str,
) -> (Code, String) {
    match suggester.nearest(name, known.clone()) {
        Some(near) => (Code::Misspelt, format!("a {what} of <{within}>: {near}, perhaps; ignored")),
        None => (Code::Unknown, format!("a {what} of <{within}>: {}; ignored", known.collect::<Vec<_>>().join(", "))),
    }
}

fn attributes(element: &Element, row: &Row, subject: &Subject, suggester: &mut Suggester, log: &mut Diagnostics) {
    for attribute in &element.attributes {
        let name = attribute.name.as_str();
        // Declarations of prefixes do not concern the robot.
        if has(row.attributes, name) || name.starts_with("xmlns") {
            continue;
        }
        match reason(row, name) {
            // The name of an unused tag is not listed again.
            Some("") => {}
            Some(why) => element.unused(subject, Some(attribute), why, log),
            None if element.is("mimic") => law(element, Some(attribute), subject, log),
            None if name.contains(':') => element.unused(subject, Some(attribute), FOREIGN, log),
            None => {
                let (code, expected) = expected(name, row.attributes.split_ascii_whitespace(), suggester, "attribute", &element.name);
                element.warning((subject, name), code, format!("the attribute {}", quote(name)), expected, log);
                element.unused(subject, Some(attribute), "not known", log);
            }
        }
    }
    if !row.tags.is_empty() && !text(element).is_empty() {
        let shown: String = text(element).chars().take(40).collect();
        element.unused(subject, None, &format!("text between tags says nothing of a robot: {}", quote(&shown)), log);
    }
}

/// The subject of messages about a tag.
pub(crate) fn subject(element: &Element) -> Subject {
    let name = || element.text("name").map(|name| name.chars().take(256).collect::<String>());
    match element.name.as_str() {
        "link" => name().map_or(Subject::Document, Subject::Link),
        "joint" => name().map_or(Subject::Document, Subject::Joint),
        _ => Subject::Document,
    }
}
