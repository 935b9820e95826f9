//! A generator of MJCF documents: the right tags and attributes, mostly in the right places. The
//! fuzz target `mjcf_grammar` is made of it, too.

const IN_BODIES: &[&str] = &[
    "body",
    "frame",
    "replicate",
    "joint",
    "geom",
    "site",
    "inertial",
    "freejoint",
    "attach",
    "include",
    "camera",
    "flexcomp",
    "composite",
    "plugin",
];
const FLAGS: &[&str] = &["gravity", "constraint", "equality", "frictionloss", "limit", "contact", "spring", "damper", "actuation"];
const IN_ROOT: &[&str] = &["compiler", "option", "default", "asset", "worldbody", "actuator", "keyframe", "equality", "tendon"];
const IN_DEFAULT: &[&str] = &["default", "joint", "geom", "site", "mesh", "motor", "position", "tendon", "equality"];
const IN_ACTUATOR: &[&str] = &["motor", "position", "velocity", "damper", "general", "intvelocity", "muscle", "pid"];
const IN_EQUALITY: &[&str] = &["joint", "tendon", "connect", "weld"];
/// Attributes of tags outside the bodies.
const BESIDE: &[&str] = &[
    "name",
    "class",
    "joint",
    "joint1",
    "joint2",
    "tendon",
    "tendon1",
    "tendon2",
    "body1",
    "site",
    "geom",
    "divisor",
    "coef",
    "polycoef",
    "active",
    "qpos",
    "qvel",
    "ctrl",
    "gear",
    "kp",
    "kv",
    "dampratio",
    "ctrlrange",
    "forcerange",
    "inheritrange",
    "gainprm",
    "biastype",
    "stiffness",
    "damping",
    "springlength",
    "armature",
    "group",
];
const IN_ASSET: &[&str] = &["mesh", "model", "texture", "hfield"];
const NAMES: &[&str] = &["a", "b", "c", "world", "main", ""];
const NUMBERS: &[&str] = &["0", "1", "-1", "0.5", "90", "1e-20", "1e300", "3.14159", "-0", "7", "x", "400000"];
const ATTRIBUTES: &[&str] = &[
    "name",
    "class",
    "childclass",
    "type",
    "pos",
    "quat",
    "axisangle",
    "xyaxes",
    "zaxis",
    "euler",
    "fromto",
    "size",
    "mass",
    "density",
    "mesh",
    "axis",
    "ref",
    "range",
    "limited",
    "armature",
    "damping",
    "stiffness",
    "springref",
    "diaginertia",
    "fullinertia",
    "count",
    "offset",
    "sep",
    "model",
    "body",
    "frame",
    "prefix",
    "file",
    "vertex",
    "face",
    "scale",
    "inertia",
    "group",
    "shellinertia",
    "angle",
    "eulerseq",
    "inertiafromgeom",
    "inertiagrouprange",
    "boundmass",
    "boundinertia",
    "balanceinertia",
    "settotalmass",
    "fitaabb",
    "gravity",
    "align",
    "alignfree",
    "conflict",
    "hfield",
    "springdamper",
    "springyield",
];
const WORDS: &[&str] = &[
    "hinge",
    "slide",
    "ball",
    "free",
    "box",
    "sphere",
    "capsule",
    "cylinder",
    "ellipsoid",
    "plane",
    "mesh",
    "sdf",
    "hfield",
    "true",
    "false",
    "auto",
    "radian",
    "degree",
    "xyz",
    "ZYx",
    "exact",
    "shell",
    "legacy",
    "convex",
    "disable",
    "enable",
    "merge",
];

struct Writer<'a> {
    bytes: &'a [u8],
    out: String,
}

impl Writer<'_> {
    fn next(&mut self) -> usize {
        let Some((first, rest)) = self.bytes.split_first() else { return 0 };
        self.bytes = rest;
        usize::from(*first)
    }

    fn one<'w>(&mut self, words: &'w [&'w str]) -> &'w str {
        words[self.next() % words.len()]
    }

    fn put(&mut self, words: &[&str]) {
        let word = self.one(words);
        self.out += word;
    }

    fn attributes(&mut self, names: &[&str]) {
        for _ in 0..self.next() % 6 {
            let name = self.one(names);
            let already = format!(" {name}=");
            let tag = self.out.rfind('<').unwrap_or_default();
            if self.out[tag..].contains(&already) {
                continue;
            }
            self.out += &already;
            self.out.push('"');
            match self.next() % 3 {
                0 => self.put(NAMES),
                1 => self.put(WORDS),
                _ => {
                    for _ in 0..self.next() % 13 {
                        self.put(NUMBERS);
                        self.out.push(' ');
                    }
                }
            }
            self.out.push('"');
        }
    }

    fn tags(&mut self, names: &[&str], attributes: &[&str], depth: usize) {
        while !self.bytes.is_empty() && !self.next().is_multiple_of(5) {
            let name = self.one(names);
            self.out += &format!("<{name}");
            self.attributes(attributes);
            self.out.push('>');
            if depth < 20 {
                match name {
                    "worldbody" | "body" | "frame" | "replicate" => self.tags(IN_BODIES, ATTRIBUTES, depth + 1),
                    "default" => self.tags(IN_DEFAULT, ATTRIBUTES, depth + 1),
                    "asset" => self.tags(IN_ASSET, ATTRIBUTES, depth + 1),
                    "actuator" => self.tags(IN_ACTUATOR, BESIDE, depth + 1),
                    "equality" if depth == 0 => self.tags(IN_EQUALITY, BESIDE, depth + 1),
                    "tendon" if depth == 0 => self.tags(&["fixed", "spatial"], BESIDE, depth + 1),
                    "fixed" => self.tags(&["joint"], BESIDE, depth + 1),
                    "spatial" => self.tags(&["site", "pulley", "geom"], BESIDE, depth + 1),
                    "option" => self.tags(&["flag"], FLAGS, depth + 1),
                    "keyframe" => self.tags(&["key"], BESIDE, depth + 1),
                    _ => {}
                }
            }
            self.out += &format!("</{name}>");
        }
    }
}

/// The document for these bytes.
pub(crate) fn document(bytes: &[u8]) -> String {
    let mut writer = Writer { bytes, out: "<mujoco>".to_owned() };
    while !writer.bytes.is_empty() {
        writer.tags(IN_ROOT, ATTRIBUTES, 0);
    }
    writer.out + "</mujoco>"
}
