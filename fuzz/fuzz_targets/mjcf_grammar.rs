//! Documents of the right tags and attributes, mostly in the right places: each is a robot or a
//! list of mistakes.
#![no_main]

use articulated_core::description::Base;
use articulated_core::model::Model;
use articulated_formats::mjcf::Mjcf;
use articulated_formats::{Formats, Options, read};
use libfuzzer_sys::fuzz_target;

const IN_BODIES: &[&str] = &["body", "frame", "replicate", "joint", "geom", "site", "inertial", "freejoint", "attach", "include", "camera"];
const IN_ROOT: &[&str] = &["compiler", "option", "default", "asset", "worldbody", "actuator", "keyframe", "equality"];
const IN_DEFAULT: &[&str] = &["default", "joint", "geom", "site", "mesh", "motor"];
const IN_ASSET: &[&str] = &["mesh", "model", "texture", "hfield"];
const NAMES: &[&str] = &["a", "b", "c", "world", "main", ""];
const NUMBERS: &[&str] = &["0", "1", "-1", "0.5", "90", "1e-20", "1e300", "3.14159", "-0", "7", "x", "400000"];
const ATTRIBUTES: &[&str] = &[
    "name", "class", "childclass", "type", "pos", "quat", "axisangle", "xyaxes", "zaxis", "euler", "fromto", "size", "mass", "density",
    "mesh", "axis", "ref", "range", "limited", "armature", "damping", "stiffness", "springref", "diaginertia", "fullinertia", "count",
    "offset", "sep", "model", "body", "frame", "prefix", "file", "vertex", "face", "scale", "inertia", "group", "shellinertia", "angle",
    "eulerseq", "inertiafromgeom", "inertiagrouprange", "boundmass", "boundinertia", "balanceinertia", "settotalmass", "fitaabb", "gravity",
];
const WORDS: &[&str] = &[
    "hinge", "slide", "ball", "free", "box", "sphere", "capsule", "cylinder", "ellipsoid", "plane", "mesh", "sdf", "hfield", "true", "false",
    "auto", "radian", "degree", "xyz", "ZYx", "exact", "shell", "legacy", "convex",
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

    fn attributes(&mut self) {
        for _ in 0..self.next() % 6 {
            let name = self.one(ATTRIBUTES);
            let already = format!(" {name}=");
            let tag = self.out.rfind('<').unwrap_or_default();
            if self.out[tag..].contains(&already) {
                continue;
            }
            self.out += &already;
            self.out.push('"');
            match self.next() % 3 {
                0 => {
                    let word = self.one(NAMES);
                    self.out += word;
                }
                1 => {
                    let word = self.one(WORDS);
                    self.out += word;
                }
                _ => {
                    for _ in 0..self.next() % 13 {
                        let word = self.one(NUMBERS);
                        self.out += word;
                        self.out.push(' ');
                    }
                }
            }
            self.out.push('"');
        }
    }

    fn tags(&mut self, names: &[&str], depth: usize) {
        while !self.bytes.is_empty() && self.next() % 5 > 0 {
            let name = self.one(names);
            self.out += &format!("<{name}");
            self.attributes();
            self.out.push('>');
            if depth < 20 {
                match name {
                    "worldbody" | "body" | "frame" | "replicate" => self.tags(IN_BODIES, depth + 1),
                    "default" => self.tags(IN_DEFAULT, depth + 1),
                    "asset" => self.tags(IN_ASSET, depth + 1),
                    _ => {}
                }
            }
            self.out += &format!("</{name}>");
        }
    }
}

fuzz_target!(|bytes: &[u8]| {
    let mut writer = Writer { bytes, out: "<mujoco>".to_owned() };
    while !writer.bytes.is_empty() {
        writer.tags(IN_ROOT, 0);
    }
    let text = writer.out + "</mujoco>";
    match read(text.as_bytes(), &Options { formats: Formats(&[&Mjcf]), ..Options::default() }) {
        Ok(reading) => drop(Model::<f64>::new(&reading.description, Base::Fixed)),
        Err(problems) => assert!(!problems.errors.is_empty()),
    }
});
