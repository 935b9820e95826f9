//! The tags and attributes of the format: which are used, and why others are not.
//!
//! One pass over the document reports unused and unknown content. It does not look inside tags that
//! are unused as a whole.

use articulated_core::diagnostic::{Code, Diagnostics, Subject, quote};
use articulated_core::suggest::Suggester;

use super::element::Element;

/// Names between blanks.
type Names = &'static str;

/// A tag that is used.
struct Row {
    name: &'static str,
    /// The names of the tags that it may be in; empty: any.
    within: Names,
    attributes: Names,
    /// Attributes that are not used, each with the reason.
    unused_attributes: &'static [(Names, &'static str)],
    /// The tags in it that have rows of their own.
    tags: Names,
    /// Tags in it that are not used, each with the reason.
    unused_tags: &'static [(Names, &'static str)],
}

const APPEARANCE: &str = "appearance plays no part in the dynamics";
const CONTACT: &str = "used by functions of the group `constraints` alone";
const NO_CONTACT: &str = "not computed: contacts are without it";
const SOLVER: &str = "settings of MuJoCo's solver";
const SIMULATOR: &str = "settings of the simulator";
const USER: &str = "numbers of the user";
const DEFORMABLE: &str = "deformable bodies are not read: the dynamics are those without them";
const PLUGIN: &str = "plugins of MuJoCo are not read";
const ACTUATOR: &str = "controls are given by the scene";
const UNREAD_ACTUATOR: &str = "actuators of this kind are not read";
const HEIGHTS: &str = "contact with height fields is not computed: they give mass alone";

const BODY_TAGS: Names = "body frame replicate attach inertial joint freejoint geom site";
const BODY_UNUSED_TAGS: &[(Names, &str)] =
    &[("camera", "cameras play no part in the dynamics"), ("light", APPEARANCE), ("plugin", PLUGIN), ("composite flexcomp", DEFORMABLE)];

const UNUSED_OF_TENDONS: &[(Names, &str)] =
    &[("group material rgba width", APPEARANCE), ("margin solreflimit solimplimit solreffriction solimpfriction", SOLVER), ("user", USER)];

/// The attributes of all actuators, and those of a kind.
macro_rules! of_actuators {
    ($own:literal) => {
        concat!(
            "name class group forcelimited ctrlrange forcerange gear damping armature delay nsample interp lengthrange cranklength joint ",
            "jointinparent tendon site refsite cranksite slidersite ",
            $own
        )
    };
}

/// All tags that are used. A tag with two rows uses the first one whose parent matches.
const ROWS: &[Row] = &[
    Row {
        name: "mujoco",
        within: "",
        attributes: "model",
        unused_attributes: &[],
        tags: "compiler option default asset worldbody keyframe actuator tendon equality contact",
        unused_tags: &[
            ("visual", APPEARANCE),
            ("statistic size", SIMULATOR),
            ("custom", USER),
            ("sensor", "sensors play no part in the dynamics"),
            ("extension", PLUGIN),
            ("deformable", DEFORMABLE),
        ],
    },
    Row {
        name: "compiler",
        within: "mujoco",
        attributes: "autolimits boundmass boundinertia settotalmass balanceinertia coordinate angle eulerseq meshdir assetdir \
                     inertiafromgeom inertiagrouprange fitaabb strippath alignfree conflict",
        unused_attributes: &[
            ("texturedir", APPEARANCE),
            ("discardvisual", "appearance and collision geometry are read as written"),
            ("fusestatic", "links without joints stay links: the dynamics are the same"),
            ("usethread saveinertial", SIMULATOR),
        ],
        tags: "",
        unused_tags: &[("lengthrange", SIMULATOR)],
    },
    Row {
        name: "option",
        within: "mujoco",
        attributes: "gravity timestep integrator actuatorgroupdisable wind density viscosity",
        unused_attributes: &[
            ("magnetic", "sensors play no part in the dynamics"),
            ("o_margin o_solref o_solimp o_friction", NO_CONTACT),
            ("impratio cone solver noslip_iterations", CONTACT),
            (
                "tolerance ls_tolerance noslip_tolerance ccd_tolerance sleep_tolerance jacobian iterations ls_iterations ccd_iterations \
                 sdf_iterations sdf_initpoints",
                SOLVER,
            ),
        ],
        tags: "flag",
        unused_tags: &[],
    },
    Row {
        name: "flag",
        within: "option",
        attributes: "gravity constraint equality frictionloss limit contact spring damper clampctrl actuation eulerdamp",
        unused_attributes: &[
            ("filterparent refsafe", CONTACT),
            (
                "warmstart sensor midphase autoreset nativeccd \
             island multiccd override energy fwdinv invdiscrete sleep diagexact ipc speculative",
                "what acts on the robot is given by the scene",
            ),
        ],
        tags: "",
        unused_tags: &[],
    },
    Row {
        name: "default",
        within: "mujoco default",
        attributes: "class",
        unused_attributes: &[],
        tags: "default mesh joint geom site equality tendon general motor position velocity intvelocity damper cylinder pair",
        unused_tags: &[
            ("material camera light texture", APPEARANCE),
            ("intvelocity orientation pid cylinder muscle adhesion dcmotor", UNREAD_ACTUATOR),
        ],
    },
    Row {
        name: "asset",
        within: "mujoco",
        attributes: "",
        unused_attributes: &[],
        tags: "mesh model hfield",
        unused_tags: &[("texture material skin", APPEARANCE)],
    },
    Row {
        name: "hfield",
        within: "asset",
        attributes: "name file size",
        unused_attributes: &[("content_type nrow ncol elevation", HEIGHTS)],
        tags: "",
        unused_tags: &[],
    },
    Row {
        name: "mesh",
        within: "asset default",
        attributes: "name class content_type file vertex face refpos refquat scale inertia builtin params",
        unused_attributes: &[("normal texcoord smoothnormal material", APPEARANCE), ("maxhullvert", "contact with meshes is not computed")],
        tags: "",
        unused_tags: &[("plugin", PLUGIN)],
    },
    Row { name: "model", within: "asset", attributes: "name file content_type", unused_attributes: &[], tags: "", unused_tags: &[] },
    Row { name: "worldbody", within: "mujoco", attributes: "", unused_attributes: &[], tags: BODY_TAGS, unused_tags: BODY_UNUSED_TAGS },
    Row {
        name: "body",
        within: BODIES,
        attributes: "name childclass pos quat axisangle xyaxes zaxis euler mocap gravcomp",
        unused_attributes: &[("sleep simple", SIMULATOR), ("user", USER)],
        tags: BODY_TAGS,
        unused_tags: BODY_UNUSED_TAGS,
    },
    Row {
        name: "frame",
        within: BODIES,
        attributes: "name childclass pos quat axisangle xyaxes zaxis euler",
        unused_attributes: &[],
        tags: BODY_TAGS,
        unused_tags: BODY_UNUSED_TAGS,
    },
    Row {
        name: "replicate",
        within: BODIES,
        attributes: "count offset euler sep childclass",
        unused_attributes: &[],
        tags: BODY_TAGS,
        unused_tags: BODY_UNUSED_TAGS,
    },
    Row { name: "attach", within: BODIES, attributes: "model body frame prefix", unused_attributes: &[], tags: "", unused_tags: &[] },
    Row {
        name: "inertial",
        within: BODIES,
        attributes: "pos quat mass diaginertia axisangle xyaxes zaxis euler fullinertia",
        unused_attributes: &[],
        tags: "",
        unused_tags: &[],
    },
    Row {
        name: "joint",
        within: IN_BODIES,
        attributes: "name class type pos axis springdamper limited actuatorfrclimited stiffness range actuatorfrcrange ref springref armature \
                     damping frictionloss springyield",
        unused_attributes: &[
            ("group", APPEARANCE),
            ("solreflimit solimplimit solreffriction solimpfriction margin", CONTACT),
            ("actuatorgravcomp", ACTUATOR),
            ("user", USER),
        ],
        tags: "",
        unused_tags: &[],
    },
    Row {
        name: "freejoint",
        within: BODIES,
        attributes: "name align",
        unused_attributes: &[("group", APPEARANCE)],
        tags: "",
        unused_tags: &[],
    },
    Row {
        name: "geom",
        within: IN_BODIES,
        attributes: "name class type contype conaffinity group size mass density shellinertia fromto pos quat axisangle xyaxes zaxis euler \
                     mesh hfield fitscale rgba fluidshape fluidcoef",
        unused_attributes: &[
            ("condim priority friction solmix solref solimp margin gap", CONTACT),
            ("surfacevel adhesion", NO_CONTACT),
            ("material", APPEARANCE),
            ("user", USER),
        ],
        tags: "",
        unused_tags: &[("plugin", PLUGIN)],
    },
    Row {
        name: "site",
        within: IN_BODIES,
        attributes: "name class pos quat axisangle xyaxes zaxis euler fromto",
        unused_attributes: &[("type group material size rgba", APPEARANCE), ("user", USER)],
        tags: "",
        unused_tags: &[],
    },
    Row { name: "keyframe", within: "mujoco", attributes: "", unused_attributes: &[], tags: "key", unused_tags: &[] },
    Row {
        name: "key",
        within: "keyframe",
        attributes: "name qpos qvel ctrl act mpos mquat plastic",
        unused_attributes: &[("time", "a simulation starts at 0 s")],
        tags: "",
        unused_tags: &[],
    },
    Row { name: "tendon", within: "mujoco", attributes: "", unused_attributes: &[], tags: "spatial fixed", unused_tags: &[] },
    Row {
        name: "fixed",
        within: "tendon",
        attributes: "name class limited range actuatorfrclimited actuatorfrcrange frictionloss springlength springyield stiffness damping \
                     armature",
        unused_attributes: UNUSED_OF_TENDONS,
        tags: "joint",
        unused_tags: &[],
    },
    Row { name: "joint", within: "fixed", attributes: "joint coef", unused_attributes: &[], tags: "", unused_tags: &[] },
    Row {
        name: "spatial",
        within: "tendon",
        attributes: "name class limited range actuatorfrclimited actuatorfrcrange frictionloss springlength springyield stiffness damping \
                     armature",
        unused_attributes: UNUSED_OF_TENDONS,
        tags: "site geom pulley",
        unused_tags: &[],
    },
    Row { name: "site", within: "spatial", attributes: "site", unused_attributes: &[], tags: "", unused_tags: &[] },
    Row { name: "geom", within: "spatial", attributes: "geom sidesite", unused_attributes: &[], tags: "", unused_tags: &[] },
    Row { name: "pulley", within: "spatial", attributes: "divisor", unused_attributes: &[], tags: "", unused_tags: &[] },
    Row {
        name: "tendon",
        within: "default",
        attributes: "limited range actuatorfrclimited actuatorfrcrange frictionloss springlength springyield stiffness damping armature",
        unused_attributes: UNUSED_OF_TENDONS,
        tags: "",
        unused_tags: &[],
    },
    Row { name: "contact", within: "mujoco", attributes: "", unused_attributes: &[], tags: "pair exclude", unused_tags: &[] },
    Row {
        name: "pair",
        within: "contact default",
        attributes: "name class geom1 geom2 condim friction solref solreffriction solimp gap margin",
        unused_attributes: &[("adhesion", NO_CONTACT)],
        tags: "",
        unused_tags: &[],
    },
    Row { name: "exclude", within: "contact", attributes: "name body1 body2", unused_attributes: &[], tags: "", unused_tags: &[] },
    Row {
        name: "equality",
        within: "mujoco",
        attributes: "",
        unused_attributes: &[],
        tags: "connect weld joint tendon flex flexvert flexstrain",
        unused_tags: &[],
    },
    Row {
        name: "equality",
        within: "default",
        attributes: "active",
        unused_attributes: &[("solref solimp", SOLVER)],
        tags: "",
        unused_tags: &[],
    },
    Row {
        name: "connect",
        within: "equality",
        attributes: "name class active body1 body2 anchor site1 site2",
        unused_attributes: &[("solref solimp", SOLVER)],
        tags: "",
        unused_tags: &[],
    },
    Row {
        name: "weld",
        within: "equality",
        attributes: "name class active body1 body2 anchor relpose torquescale site1 site2",
        unused_attributes: &[("solref solimp", SOLVER)],
        tags: "",
        unused_tags: &[],
    },
    Row {
        name: "joint",
        within: "equality",
        attributes: "name class active joint1 joint2 polycoef",
        unused_attributes: &[("solref solimp", SOLVER)],
        tags: "",
        unused_tags: &[],
    },
    Row {
        name: "tendon",
        within: "equality",
        attributes: "name class active tendon1 tendon2 polycoef",
        unused_attributes: &[("solref solimp", SOLVER)],
        tags: "",
        unused_tags: &[],
    },
    Row {
        name: "actuator",
        within: "mujoco",
        attributes: "",
        unused_attributes: &[],
        tags: "general motor position velocity intvelocity orientation pid damper cylinder muscle adhesion dcmotor plugin",
        unused_tags: &[],
    },
    Row {
        name: "general",
        within: "actuator default",
        attributes: of_actuators!(
            "actdim actearly actlimited actrange dyntype dynprm gaintype gainprm biastype biasprm inheritrange input velrange ffrange body ctrllimited"
        ),
        unused_attributes: &[("user", USER)],
        tags: "",
        unused_tags: &[],
    },
    Row {
        name: "motor",
        within: "actuator default",
        attributes: of_actuators!("ctrllimited"),
        unused_attributes: &[("user", USER)],
        tags: "",
        unused_tags: &[],
    },
    Row {
        name: "position",
        within: "actuator default",
        attributes: of_actuators!("ctrllimited kp kv dampratio timeconst inheritrange"),
        unused_attributes: &[("user", USER)],
        tags: "",
        unused_tags: &[],
    },
    Row {
        name: "intvelocity",
        within: "actuator default",
        attributes: of_actuators!("ctrllimited actlimited actrange actearly kp kv dampratio timeconst inheritrange"),
        unused_attributes: &[("user", USER)],
        tags: "",
        unused_tags: &[],
    },
    Row {
        name: "cylinder",
        within: "actuator default",
        attributes: of_actuators!("ctrllimited actlimited actrange actearly timeconst area diameter bias"),
        unused_attributes: &[("user", USER)],
        tags: "",
        unused_tags: &[],
    },
    Row {
        name: "velocity",
        within: "actuator default",
        attributes: of_actuators!("ctrllimited kv"),
        unused_attributes: &[("user", USER)],
        tags: "",
        unused_tags: &[],
    },
    Row {
        name: "damper",
        within: "actuator default",
        attributes: of_actuators!("kv"),
        unused_attributes: &[("user", USER)],
        tags: "",
        unused_tags: &[],
    },
];

const BODIES: Names = "worldbody body frame replicate";
const IN_BODIES: Names = "worldbody body frame replicate default";

fn has(names: Names, name: &str) -> bool {
    names.split_ascii_whitespace().any(|own| own == name)
}

fn reason(rows: &'static [(Names, &'static str)], name: &str) -> Option<&'static str> {
    rows.iter().find(|(names, _)| has(names, name)).map(|(_, why)| *why)
}

fn row_of(name: &str, within: &str) -> Option<&'static Row> {
    ROWS.iter().find(|row| row.name == name && (row.within.is_empty() || has(row.within, within)))
}

/// Reports all unused and all unknown content.
pub(crate) fn check(root: &Element, log: &mut Diagnostics) {
    let mut suggester = Suggester::default();
    let mut next = vec![(root, "")];
    while let Some((element, within)) = next.pop() {
        let Some(row) = row_of(&element.name.to_ascii_lowercase(), within) else { continue };
        let subject = subject(element);
        attributes(element, row, &subject, &mut suggester, log);
        for child in element.children.iter().rev() {
            if has(row.tags, &child.name) {
                next.push((child, row.name));
            }
        }
        for child in element.children.iter().filter(|child| !has(row.tags, &child.name)) {
            // MuJoCo accepts these and does not read them.
            if row.name == "mujoco" && ["body", "frame", "replicate"].contains(&child.name.as_str()) {
                let found = format!("<{}> outside of <worldbody>", child.name);
                child.warning((&subject, ""), Code::Misplaced, found, "it inside <worldbody>, where alone it counts; ignored", log);
                child.unused(&subject, None, "in no place where it counts", log);
                continue;
            }
            match reason(row.unused_tags, &child.name) {
                // Each of the tags in a section, or the section if it has no tags.
                Some(why) if row.name == "mujoco" && !child.children.is_empty() => {
                    child.children.iter().for_each(|inner| inner.unused(&subject, None, why, log));
                }
                Some(why) => child.unused(&subject, None, why, log),
                None => {
                    let known =
                        row.tags.split_ascii_whitespace().chain(row.unused_tags.iter().flat_map(|(tags, _)| tags.split_ascii_whitespace()));
                    let expected = expected(&child.name, known, &mut suggester, "tag", &element.name);
                    child.error((&subject, ""), Code::Unknown, format!("the tag <{}>", child.name), expected, log);
                }
            }
        }
    }
}

fn expected<'a>(name: &str, known: impl Iterator<Item = &'a str> + Clone, suggester: &mut Suggester, what: &str, within: &str) -> String {
    match suggester.nearest(name, known.clone()) {
        Some(near) => format!("a {what} of <{within}>: {near}, perhaps"),
        None => format!("a {what} of <{within}>: {}", known.collect::<Vec<_>>().join(", ")),
    }
}

fn attributes(element: &Element, row: &Row, subject: &Subject, suggester: &mut Suggester, log: &mut Diagnostics) {
    for attribute in &element.attributes {
        let name = attribute.name.as_str();
        if has(row.attributes, name) {
            continue;
        }
        if name.starts_with("xmlns") || name.contains(':') {
            continue;
        }
        match reason(row.unused_attributes, name) {
            Some(why) => element.unused(subject, Some(attribute), why, log),
            None => {
                let all = row.unused_attributes.iter().flat_map(|(names, _)| names.split_ascii_whitespace());
                let known = row.attributes.split_ascii_whitespace().chain(all);
                let expected = expected(name, known, suggester, "attribute", row.name);
                element.error((subject, name), Code::Unknown, format!("the attribute {}", quote(name)), expected, log);
            }
        }
    }
}

/// The subject of messages about a tag.
pub(crate) fn subject(element: &Element) -> Subject {
    let name = || element.text("name").map(|name| name.chars().take(256).collect::<String>());
    match element.name.as_str() {
        "body" => name().map_or(Subject::Document, Subject::Link),
        "joint" | "freejoint" => name().map_or(Subject::Document, Subject::Joint),
        _ => Subject::Document,
    }
}
