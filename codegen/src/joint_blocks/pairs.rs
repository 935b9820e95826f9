//! What joints have to do with one another, a joint with those of a chunk.

use articulated_core::lanes::DERIVATIVES_COST;
use articulated_core::model::Model;

use super::{Groups, LANES, ROOT};
use crate::graph::{Counts, Op};

/// Joints of a block, once groups are turned, that follow one another, as their columns do.
pub(crate) struct Chunk {
    pub(crate) at: usize,
    /// That of lane 0.
    pub(crate) column: usize,
    pub(crate) bodies: [Option<usize>; LANES],
}

/// What one joint has to do with some of a chunk.
pub(crate) struct Pair {
    pub(crate) own: usize,
    pub(crate) at: usize,
    pub(crate) column: usize,
    pub(crate) which: [bool; LANES],
    /// The path between their chunks, counted from 1; 0 where there is but one.
    pub(crate) path: usize,
}

/// From the first joint of a chunk to the first of another beyond it.
pub(crate) struct Path {
    from: usize,
    to: usize,
    /// The path to the chunk that the other stands on, counted from 1; 0 if that is where this one begins.
    pub(crate) before: usize,
    /// The first joint's body, and the one that it stands on.
    pub(crate) first: usize,
    pub(crate) on: usize,
}

impl Chunk {
    /// The first joint's body.
    pub(crate) fn first(&self) -> usize {
        self.bodies.iter().flatten().copied().min().unwrap_or(ROOT)
    }
}

/// The chunk in which a body's joint stands.
fn chunk_of(chunks: &[Chunk], body: usize) -> usize {
    chunks.iter().position(|chunk| chunk.bodies.contains(&Some(body))).unwrap_or(0)
}

/// Whether a body is on the way from another to the base, or is that other.
fn is_before(model: &Model<f64>, body: usize, other: usize) -> bool {
    other == body || other > body && is_before(model, body, model.bodies[other].parent)
}

impl Groups {
    /// Joints of a block that follow one another, as their columns do.
    pub(crate) fn chunks(&self, model: &Model<f64>) -> Vec<Chunk> {
        let mut chunks: Vec<Chunk> = Vec::new();
        for at in 0..self.groups().next_multiple_of(LANES) {
            let block = self.block(at);
            for (lane, body) in block.into_iter().enumerate() {
                let Some(body) = body else { continue };
                // Of what stands in the first lane; joints stand behind the root's six columns.
                let column = model.bodies[body].coordinates.v - lane;
                let on = lane.checked_sub(1).and_then(|before| block[before]);
                match chunks.last_mut() {
                    Some(chunk) if on == Some(model.bodies[body].parent) && chunk.column == column => chunk.bodies[lane] = Some(body),
                    _ => chunks.push(Chunk { at, column, bodies: std::array::from_fn(|k| (k == lane).then_some(body)) }),
                }
            }
        }
        chunks.sort_by_key(Chunk::first);
        chunks
    }

    /// What each joint has to do with others: itself and those before it, and those beyond it; and the paths between their chunks.
    pub(crate) fn pairs(&self, model: &Model<f64>) -> ([Vec<Pair>; 2], Vec<Path>) {
        let (chunks, paths) = (self.chunks(model), self.paths(model));
        let path = |before: usize, beyond: usize| paths.iter().position(|p| (p.from, p.to) == (before, beyond)).map_or(0, |k| k + 1);
        let mut pairs = [Vec::new(), Vec::new()];
        for own in ROOT + 1..model.bodies.len() {
            let of_own = chunk_of(&chunks, own);
            for (at, chunk) in chunks.iter().enumerate() {
                let before = chunk.bodies.map(|o| o.is_some_and(|o| is_before(model, o, own)));
                let beyond = chunk.bodies.map(|o| o.is_some_and(|o| o != own && is_before(model, own, o)));
                for (pairs, (which, path)) in pairs.iter_mut().zip([(before, path(at, of_own)), (beyond, path(of_own, at))]) {
                    pairs.extend(which.contains(&true).then_some(Pair { own, at: chunk.at, column: chunk.column, which, path }));
                }
            }
        }
        (pairs, paths)
    }

    /// From each chunk to those beyond it.
    fn paths(&self, model: &Model<f64>) -> Vec<Path> {
        let chunks = self.chunks(model);
        let mut paths: Vec<Path> = Vec::new();
        // A chunk stands before those that stand on it.
        for (to, chunk) in chunks.iter().enumerate() {
            let (first, on) = (chunk.first(), model.bodies[chunk.first()].parent);
            if on == ROOT {
                continue;
            }
            let through = chunk_of(&chunks, on);
            let further = (1..).zip(&paths).filter(|(_, p)| p.to == through);
            let further: Vec<Path> = further.map(|(before, p)| Path { from: p.from, to, before, first, on }).collect();
            paths.push(Path { from: through, to, before: 0, first, on });
            paths.extend(further);
        }
        paths
    }

    /// What the loops cost.
    pub(crate) fn counts(&self, model: &Model<f64>) -> Counts {
        let [before, beyond] = self.pairs(model).0.map(|pairs| pairs.len() as u64);
        let cost = DERIVATIVES_COST.of(self.groups() as u64, self.chunks(model).len() as u64, before, beyond);
        let [.., sines] = cost;
        let mut counts = Counts::default();
        for (op, n) in [Op::Add, Op::Mul, Op::MulAdd, Op::Neg].into_iter().zip(cost).chain([(Op::Sin, sines), (Op::Cos, sines)]) {
            counts.add(op, n);
        }
        counts
    }
}
