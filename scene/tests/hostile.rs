//! Any bytes are a scene or an error, soon, and never a panic.

use std::fs;
use std::path::Path;

use articulated_core::description::{Base, Description, Inertial, Joint, JointKind, Link, LinkId};
use articulated_core::model::Model;
use articulated_formats::world::World;
use articulated_scene::{Bundled, Edited, Scene, open_in};

/// Numbers for the mutations: xorshift, after Marsaglia 2003.
struct Random(u64);

impl Random {
    fn below(&mut self, n: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        usize::try_from(self.0 % n.max(1) as u64).unwrap()
    }
}

/// Shipped scenes and the scenes of the macro's tests.
fn corpus() -> Vec<Vec<u8>> {
    let files = ["../models/scenes", "../tests/ui/scenes"].into_iter().flat_map(|folder| fs::read_dir(folder).unwrap());
    let mut files: Vec<_> = files.map(|file| file.unwrap().path()).collect();
    files.sort();
    assert!(files.len() >= 12);
    files.iter().map(|file| fs::read(file).unwrap()).collect()
}

/// A robot that a scene may name things of.
fn robot() -> Description {
    let body = Inertial { origin: Default::default(), mass: 1.0, inertia: [1.0, 0.0, 0.0, 1.0, 0.0, 1.0] };
    let link = |name: &str| Link { name: name.into(), inertial: Some(body), ..Link::default() };
    let joint =
        |name: &str, kind, parent, child| Joint { name: name.into(), kind, parent, child, axis: [0.0, 0.0, 1.0], ..Joint::default() };
    Description {
        name: "robot".into(),
        links: ["base", "tool", "club_head", "palm", "foot"].map(link).into(),
        joints: [
            joint("elbow", JointKind::Revolute, LinkId(0), LinkId(1)),
            joint("point", JointKind::Spherical, LinkId(1), LinkId(2)),
            joint("slide", JointKind::Prismatic, LinkId(2), LinkId(3)),
            joint("club_hosel", JointKind::Fixed, LinkId(3), LinkId(4)),
        ]
        .into(),
        ..Description::default()
    }
}

/// Robots that scenes name: names and documents.
fn robots() -> Vec<(String, String)> {
    let files = fs::read_dir("../models/urdf").unwrap().map(|file| file.unwrap().path());
    let urdfs = files.filter(|path| path.extension().is_some_and(|ending| ending == "urdf"));
    urdfs.map(|path| (path.file_stem().unwrap().to_str().unwrap().to_owned(), fs::read_to_string(&path).unwrap())).collect()
}

/// Reads a scene and edits its robot: a robot, or errors that are all reported.
fn settles(bytes: &[u8], bundled: &[Bundled<'_>]) -> bool {
    let Ok(scene) = Scene::read_bytes("s.toml", bytes) else { return false };
    let settled = open_in(scene, Path::new("nowhere"), bundled).and_then(|opened| opened.build());
    settled.map_err(|error| assert!(!error.to_string().is_empty())).is_ok()
}

/// Reads it, and if it reads, looks its names up.
fn try_out(bytes: &[u8], description: &Description, model: &Model<f64>) -> bool {
    let Ok(scene) =
        Scene::read_bytes("s.toml", bytes).map_err(|errors| assert!(!errors.errors.is_empty() && !errors.to_string().is_empty()))
    else {
        return false;
    };
    let robot = Edited { description, file: "r.urdf", base: Base::Fixed, unused: &[], world: &World::default(), shafts: &[] };
    let _ = scene.resolve(&robot).map(|resolved| assert_eq!(resolved.effects.len(), resolved.places.len()));
    let _ = scene.start(model);
    let _ = scene.controller(model, &mut |_| Ok(Box::new(&b"t,elbow\n0,1\n1,2\n"[..])));
    true
}

#[test]
fn mutations_of_scenes_are_scenes_or_errors() {
    let (corpus, description) = (corpus(), robot());
    let model = Model::new(&description, Base::Fixed).unwrap();
    let mut random = Random(0x9e37_79b9_7f4a_7c15);
    let words: [&[u8]; 16] = [
        b"nan",
        b"-inf",
        b"1e400",
        b"[",
        b"]",
        b"{",
        b"}",
        b"\"",
        b"=",
        b"\n[effects.damping]\n",
        b"'*'",
        b"\xff",
        b"1979-05-27",
        b".",
        b"-0.0",
        b"\"off\"",
    ];
    let robots = robots();
    let bundled: Vec<Bundled<'_>> = robots.iter().map(|(name, urdf)| Bundled { name, document: urdf, base: Base::Floating }).collect();
    let (mut read, mut settled) = (0, 0);
    for round in 0..1500 {
        let mut bytes = corpus[round % corpus.len()].clone();
        for _ in 0..1 + random.below(3) {
            let at = random.below(bytes.len());
            match random.below(5) {
                0 => bytes[at] = u8::try_from(random.below(256)).unwrap(),
                1 => drop(bytes.drain(at..(at + random.below(20)).min(bytes.len()))),
                2 => drop(bytes.splice(at..at, words[random.below(words.len())].iter().copied())),
                3 => bytes.truncate(at + 1),
                _ => {
                    // A line moves elsewhere.
                    let lines: Vec<&[u8]> = bytes.split(|b| *b == b'\n').collect();
                    let (from, to) = (random.below(lines.len()), random.below(lines.len()));
                    let mut moved = lines.clone();
                    moved.swap(from, to);
                    bytes = moved.join(&b'\n');
                }
            }
            if bytes.is_empty() {
                bytes.push(b'\n');
            }
        }
        read += usize::from(try_out(&bytes, &description, &model));
        settled += usize::from(settles(&bytes, &bundled));
    }
    // Some survive: names are looked up, and robots are built.
    assert!(read > 20 && settled > 20, "{read}, {settled}");
}

#[test]
fn what_is_deep_long_or_large_ends_soon() {
    let description = robot();
    let model = Model::new(&description, Base::Fixed).unwrap();
    let texts = [
        "[".repeat(100_000),
        "a = ".to_owned() + &"[".repeat(100_000),
        "a = ".to_owned() + &"{a=".repeat(100_000),
        "a.".repeat(100_000) + "a = 1",
        format!("[{}a]", "a.".repeat(100_000)),
        "\"".to_owned() + &"x".repeat(1_000_000),
        "=\n".repeat(50_000),
        (0..20_000).map(|i| format!("dampng_{i} = 1\n")).collect(),
        "[effects.damping]\n".to_owned() + &(0..20_000).map(|i| format!("elbow_{i} = 1\n")).collect::<String>(),
        "[control]\nkind='table'\ncolumns=['elbow']\nrows=[".to_owned()
            + &(0..20_000).map(|i| format!("[{i},1],")).collect::<String>()
            + "]",
        "a = 1".repeat(5_000_000),
    ];
    // Quadratic time would take hours here, and an infinite loop would not end.
    for text in &texts {
        try_out(text.as_bytes(), &description, &model);
    }
}
