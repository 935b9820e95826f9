//! Derivatives of inverse dynamics of a large tree, left loops: over its joints, four at a time, and over pairs of a joint with four others.
//!
//! Written out, those of a humanoid are more than a hundred kilobytes of instructions, and to fetch them takes longer than to execute them. The loops are core's text [`DERIVATIVES`]; here they get the
//! tree's tables. `tests/generated` holds the two together to the generic library.

use std::fmt::Write;

use articulated_core::joint::Joint;
use articulated_core::lanes::DERIVATIVES;
use articulated_core::model::{Body, Model};
use articulated_core::spatial::Matrix3;

use crate::joint_blocks::{Chunk, Groups, LANES, Pair, Path, ROOT};
use crate::target::rust::literal::literal;

/// The module of loops and their tables, and the function `inverse_dynamics_derivatives` in it.
pub(crate) fn module(out: &mut String, groups: &Groups, model: &Model<f64>) {
    let _ = writeln!(out, "/// Derivatives of inverse dynamics, four joints at a time; Singh, Russell & Wensing 2022.");
    let _ = writeln!(
        out,
        "#[allow(unsafe_code, unused_unsafe, unused_macros, dead_code, unused_results, clippy::all, clippy::pedantic)]\nmod derivatives {{\n#[allow(unused_imports)]\nuse ::core::iter::Iterator;\n\nuse super::{{NQ, NV}};\n"
    );
    let tables = Tables { groups, model };
    tables.constants(out);
    tables.tree(out);
    tables.pairs(out);
    let _ = writeln!(out, "\n{ORDER}\n{DERIVATIVES}}}\n");
}

/// What the proof of the loops' `unsafe` takes from the tables, for the compiler to check.
const ORDER: &str = "\
// Parents are in groups before their children, or are the root; paths begin and end at joints.
const _: () = {
    let mut group = 0;
    while group < GROUPS {
        let Group { behind, parents, .. } = &TREE[group];
        ::core::assert!(*behind == APART || *behind < group || *behind >= BLOCKS);
        let mut lane = 0;
        while lane < 4 {
            let parent = parents[lane] as usize / 4;
            ::core::assert!(parent < group || parent >= BLOCKS);
            lane += 1;
        }
        group += 1;
    }
    let mut path = 0;
    while path < STEPS {
        ::core::assert!((PATHS[path].first as usize) < 4 * GROUPS && (PATHS[path].on as usize) < 4 * GROUPS);
        path += 1;
    }
};
";

struct Tables<'a> {
    groups: &'a Groups,
    model: &'a Model<f64>,
}

impl Tables<'_> {
    fn constants(&self, out: &mut String) {
        let root = &self.model.bodies[ROOT].inertia;
        let slides = self.model.bodies.iter().any(|b| b.joint == Joint::Prismatic);
        let own: Vec<f64> = [root.mass].into_iter().chain(root.first.iter().copied()).chain(six(&root.second)).collect();
        let _ = writeln!(out, "/// Groups of four joints.\nconst GROUPS: usize = {};", self.groups.groups());
        let _ = writeln!(out, "/// Whether there are prismatic joints.\nconst SLIDES: bool = {slides};");
        let _ = writeln!(out, "/// Of all bodies together, kg.\nconst MASS: f64 = {};", literal(self.beyond(ROOT)));
        let gravity = self.model.bodies[ROOT].placement.rotation.transpose() * self.model.gravity;
        let _ =
            writeln!(out, "/// In the axes from which the root's turns, m/s².\nconst GRAVITY: [f64; 3] = {};", numbers(gravity.as_slice()));
        let _ = writeln!(out, "/// m, h and Σ (xx, yy, zz, xy, xz, yz) of the root body.\nconst ROOT: [f64; 10] = {};\n", numbers(&own));
    }

    /// The mass of a body and all beyond it.
    fn beyond(&self, body: usize) -> f64 {
        let bodies = &self.model.bodies;
        let children = (ROOT + 1..bodies.len()).filter(|&i| bodies[i].parent == body);
        bodies[body].inertia.mass + children.map(|i| self.beyond(i)).sum::<f64>()
    }

    fn tree(&self, out: &mut String) {
        let _ = writeln!(out, "static TREE: [Group; GROUPS] = [");
        for group in 0..self.groups.groups() {
            let parents: [usize; LANES] = std::array::from_fn(|lane| self.parent(group, lane));
            let beside = parents.iter().enumerate().all(|(lane, p)| p / LANES == parents[0] / LANES && p % LANES == lane);
            let behind = if beside { (parents[0] / LANES).to_string() } else { "APART".into() };
            let place = |of: fn(&Body<f64>) -> usize| -> [usize; LANES] { std::array::from_fn(|lane| of(self.stands_for(group, lane))) };
            let _ = writeln!(out, "    Group {{");
            let _ = writeln!(out, "        behind: {behind},\n        parents: {parents:?},");
            let _ = writeln!(out, "        q: {:?},\n        v: {:?},", place(|b| b.coordinates.q), place(|b| b.coordinates.v));
            self.fours(out, group, "slides", |_, b| vec![f64::from(b.joint == Joint::Prismatic)]);
            let first: Vec<usize> = self.groups.chunks(self.model).iter().map(Chunk::first).collect();
            self.fours(out, group, "follows", |i, _| vec![f64::from(u8::from(!first.contains(&i)))]);
            self.fours(out, group, "rotation", |_, b| b.placement.rotation.transpose().as_slice().to_vec());
            self.fours(out, group, "origin", |_, b| b.placement.position.as_slice().to_vec());
            self.fours(out, group, "mass", |_, b| vec![b.inertia.mass]);
            self.fours(out, group, "first", |_, b| b.inertia.first.as_slice().to_vec());
            self.fours(out, group, "second", |_, b| six(&b.inertia.second).to_vec());
            self.fours(out, group, "beyond", |i, _| vec![self.beyond(i)]);
            let _ = writeln!(out, "    }},");
        }
        let _ = writeln!(out, "];");
    }

    /// The slot of the parent, and of the root that in the same lane; where nothing stands, of whatever stands before it in its lane.
    fn parent(&self, group: usize, lane: usize) -> usize {
        let root = self.groups.slot[ROOT];
        match self.groups.body(group, lane).map(|body| self.groups.slot[self.model.bodies[body].parent]) {
            Some(slot) if slot == root => root + lane,
            Some(slot) => slot,
            None if group == 0 => root + lane,
            None => (group - 1) * LANES + lane,
        }
    }

    /// The joint whose coordinates a slot reads: its own; where none stands, the last before it in its lane, or one of its group, or any: what is no number goes no further than it would.
    fn stands_for(&self, group: usize, lane: usize) -> &Body<f64> {
        let above = (0..=group).rev().find_map(|group| self.groups.body(group, lane));
        let beside = || (0..LANES).find_map(|lane| self.groups.body(group, lane));
        &self.model.bodies[above.or_else(beside).unwrap_or(ROOT + 1)]
    }

    /// A field with numbers of the four bodies: lanes of nothing are zeros.
    fn fours(&self, out: &mut String, group: usize, name: &str, of: impl Fn(usize, &Body<f64>) -> Vec<f64>) {
        let lanes: [Vec<f64>; LANES] =
            std::array::from_fn(|lane| self.groups.body(group, lane).map_or_else(Vec::new, |i| of(i, &self.model.bodies[i])));
        // A group can stand empty between those before it and a chain that begins with a block.
        let length = of(ROOT, &self.model.bodies[ROOT]).len();
        let four = |k: usize| numbers(&lanes.each_ref().map(|lane| lane.get(k).copied().unwrap_or(0.0)));
        let rows: Vec<String> = (0..length).map(four).collect();
        let _ = match rows.as_slice() {
            [one] => writeln!(out, "        {name}: {one},"),
            _ => writeln!(out, "        {name}: [\n            {},\n        ],", rows.join(",\n            ")),
        };
    }

    fn pairs(&self, out: &mut String) {
        let chunk = |c: &Chunk| format!("Chunk {{ at: {}, which: {}, column: {} }}", c.at, bits(c.bodies.map(|b| b.is_some())), c.column);
        table(out, "CHUNKS", "Chunk", &self.groups.chunks(self.model).iter().map(chunk).collect::<Vec<_>>());
        let (pairs, paths) = self.groups.pairs(self.model);
        let slot = |body: usize| self.groups.slot[body];
        let path = |p: &Path| format!("Path {{ before: {}, first: {}, on: {} }}", p.before, slot(p.first), slot(p.on));
        let _ = writeln!(out, "/// Paths between chunks.\nconst STEPS: usize = {};", paths.len());
        table(out, "PATHS", "Path", &paths.iter().map(path).collect::<Vec<_>>());
        for (name, pairs) in ["BEFORE", "BEYOND"].into_iter().zip(pairs) {
            table(out, name, "Pair", &self.twos(&pairs));
        }
    }

    /// What joints of a block have to do with the same others, two by two; of the same two one after the other.
    fn twos(&self, pairs: &[Pair]) -> Vec<String> {
        let mut meetings: Vec<(_, Vec<&Pair>)> = Vec::new();
        for pair in pairs {
            let meeting = (self.groups.turned(pair.own).0, pair.path, pair.at);
            match meetings.iter_mut().find(|(other, _)| *other == meeting) {
                Some((_, own)) => own.push(pair),
                None => meetings.push((meeting, vec![pair])),
            }
        }
        let mut twos: Vec<_> = meetings.iter().flat_map(|(meeting, own)| own.chunks(2).map(move |two| (meeting, two))).collect();
        twos.sort_by_key(|(meeting, two)| (meeting.0, two.iter().map(|pair| self.groups.turned(pair.own).1).collect::<Vec<_>>()));
        let written = twos.into_iter().map(|((at, path, others), two)| {
            let second = two.get(1).map_or_else(|| "Own { lane: 0, which: 0, place: 0 }".into(), |pair| self.own(pair));
            format!("Pair {{ at: {at}, path: {path}, others: {others}, own: [{}, {second}] }}", self.own(two[0]))
        });
        written.collect()
    }

    fn own(&self, pair: &Pair) -> String {
        let place = self.model.bodies[pair.own].coordinates.v * self.model.nv + pair.column;
        format!("Own {{ lane: {}, which: {}, place: {place} }}", self.groups.turned(pair.own).1, bits(pair.which))
    }
}

/// A bit for each lane that is meant.
fn bits(which: [bool; LANES]) -> usize {
    which.into_iter().enumerate().map(|(lane, which)| usize::from(which) << lane).sum()
}

fn table(out: &mut String, name: &str, of: &str, rows: &[String]) {
    let lines: String = rows.iter().map(|row| format!("    {row},\n")).collect();
    let _ = writeln!(out, "static {name}: [{of}; {}] = [\n{lines}];", rows.len());
}

/// xx, yy, zz, xy, xz, yz.
fn six(m: &Matrix3<f64>) -> [f64; 6] {
    [m[(0, 0)], m[(1, 1)], m[(2, 2)], m[(0, 1)], m[(0, 2)], m[(1, 2)]]
}

fn numbers(x: &[f64]) -> String {
    let all: Vec<String> = x.iter().map(|x| literal(*x)).collect();
    format!("[{}]", all.join(", "))
}
