//! Documents of the right tags, mostly in the right places, or any bytes that begin as a document:
//! each is a robot or a list of mistakes.
#![no_main]

use articulated_core::description::Base;
use articulated_core::model::Model;
use articulated_formats::sdf::Sdf;
use articulated_formats::{Formats, Options, read};
use libfuzzer_sys::fuzz_target;

const VERSIONS: &[&str] = &["1.4", "1.5", "1.6", "1.7", "1.8", "1.9", "1.10", "1.11", "1.12"];
const NAMES: &[&str] = &["a", "b", "c", "d", "a::b", "b::__model__", "world", "__model__", "__root__", ""];
const NUMBERS: &[&str] = &["0", "1", "-1", "0.5", "1.5707963267948966", "90", "1e-20", "1e300", "3.14159", "-0", "7", "x", "inf", "1e16"];
const TYPES: &[&str] = &["revolute", "continuous", "prismatic", "fixed", "ball", "universal", "revolute2", "screw", "gearbox", "planar"];
const IN_MODEL: &[&str] = &["link", "joint", "link", "joint", "frame", "model", "pose", "static", "include", "plugin"];
const IN_LINK: &[&str] = &["pose", "inertial", "collision", "visual", "gravity", "velocity_decay", "sensor"];
const IN_JOINT: &[&str] = &["pose", "axis", "axis2", "thread_pitch", "screw_thread_pitch", "physics"];
const IN_AXIS: &[&str] = &["xyz", "limit", "dynamics", "mimic", "use_parent_model_frame"];
const SHAPES: &[&str] = &["box", "sphere", "cylinder", "capsule", "mesh", "plane"];

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

    /// So many numbers, most often.
    fn numbers(&mut self, count: usize) {
        let count = if self.next() % 20 == 0 { self.next() % 8 } else { count };
        for _ in 0..count {
            let word = self.one(NUMBERS);
            self.out += word;
            self.out.push(' ');
        }
    }

    fn attribute(&mut self, name: &str, words: &[&str]) {
        let word = self.one(words);
        self.out += &format!(" {name}=\"{word}\"");
    }

    fn tag(&mut self, name: &str, depth: usize) {
        self.out += &format!("<{name}");
        match name {
            "model" | "link" | "joint" | "frame" => self.attribute("name", NAMES),
            _ => {}
        }
        match name {
            "joint" => self.attribute("type", TYPES),
            "frame" if self.next() % 2 == 0 => self.attribute("attached_to", NAMES),
            "model" if self.next() % 4 == 0 => self.attribute("placement_frame", NAMES),
            "model" if self.next() % 4 == 0 => self.attribute("canonical_link", NAMES),
            "pose" if self.next() % 2 == 0 => self.attribute("relative_to", NAMES),
            "pose" if self.next() % 4 == 0 => self.attribute("degrees", &["true", "false"]),
            "xyz" if self.next() % 3 == 0 => self.attribute("expressed_in", NAMES),
            "mimic" => self.attribute("joint", NAMES),
            "inertial" if self.next() % 20 == 0 => self.attribute("auto", &["true", "false"]),
            _ => {}
        }
        self.out.push('>');
        match name {
            "model" if depth < 30 => self.tags(IN_MODEL, depth + 1),
            "link" => self.tags(IN_LINK, depth + 1),
            "joint" => {
                for end in ["parent", "child"] {
                    let name = self.one(NAMES);
                    self.out += &format!("<{end}>{name}</{end}>");
                }
                self.tags(IN_JOINT, depth + 1);
            }
            "frame" => self.tags(&["pose"], depth + 1),
            "axis" | "axis2" => self.tags(IN_AXIS, depth + 1),
            "limit" => self.tags(&["lower", "upper", "effort", "velocity"], depth + 1),
            "dynamics" => self.tags(&["damping", "friction", "spring_stiffness", "spring_reference"], depth + 1),
            "mimic" => self.tags(&["multiplier", "offset", "reference"], depth + 1),
            "inertial" => self.tags(&["mass", "pose", "inertia", "density"], depth + 1),
            "inertia" => self.tags(&["ixx", "iyy", "izz", "ixy", "ixz", "iyz"], depth + 1),
            "collision" | "visual" => self.tags(&["pose", "geometry"], depth + 1),
            "geometry" => {
                let shape = self.one(SHAPES);
                self.tag(shape, depth + 1);
            }
            "box" | "sphere" | "cylinder" | "capsule" | "mesh" => self.tags(&["size", "radius", "length", "uri", "scale"], depth + 1),
            "velocity_decay" => self.tags(&["linear", "angular"], depth + 1),
            "physics" => self.out += "<simbody><must_be_loop_joint>1</must_be_loop_joint></simbody>",
            "include" => self.out += "<uri>model://a</uri>",
            "static" | "gravity" | "use_parent_model_frame" => {
                let word = self.one(&["true", "false", "1", "0"]);
                self.out += word;
            }
            "pose" => self.numbers(6),
            "xyz" | "size" | "scale" => self.numbers(3),
            _ => self.numbers(1),
        }
        self.out += &format!("</{name}>");
    }

    fn tags(&mut self, names: &[&str], depth: usize) {
        while !self.bytes.is_empty() && self.next() % 5 > 0 {
            let name = self.one(names);
            self.tag(name, depth);
        }
    }
}

fn run(text: &[u8]) {
    match read(text, &Options { formats: Formats(&[&Sdf]), ..Options::default() }) {
        Ok(reading) => drop(Model::<f64>::new(&reading.description, Base::Fixed)),
        Err(problems) => assert!(!problems.errors.is_empty()),
    }
}

fuzz_target!(|bytes: &[u8]| {
    if bytes.first() == Some(&b'<') {
        return run(bytes);
    }
    let mut writer = Writer { bytes, out: String::new() };
    let version = writer.one(VERSIONS);
    writer.out = format!("<sdf version=\"{version}\"><model name=\"m\">");
    while !writer.bytes.is_empty() {
        writer.tags(IN_MODEL, 0);
    }
    run((writer.out + "</model></sdf>").as_bytes());
});
