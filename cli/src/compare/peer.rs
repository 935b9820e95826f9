//! Other libraries, behind the C interface of a peer, with their order of joints and of numbers.

use std::path::{Path, PathBuf};

use articulated_core::algorithm::{Argument, Function, ResultKind};
use articulated_core::model::{JointInfo, Model};
use serde_json::Value;

use super::contender::Contender;
use crate::magnitude::scales;
use crate::native::{Native, NativePeer};
use crate::robot::Robot;

/// A robot open in a peer library.
pub(super) struct Peer {
    pub(super) name: String,
    native: NativePeer,
    /// Our index of each number of the peer's q.
    q: Vec<usize>,
    /// Our index of each number of the peer's v, a and τ.
    v: Vec<usize>,
}

impl Peer {
    /// Opens the robot in the library; the reason if their joints are not ours.
    pub(super) fn open(name: Option<String>, library: &Path, urdf: &Path, robot: &Robot, model: &Model<f64>) -> Result<Self, String> {
        let library = Native::open(library)?;
        let name = name.or_else(|| library.peer_name()).ok_or("it has no function peer_name")?;
        let native = NativePeer::open(&library, urdf, robot.floating(), robot.options.gravity)?;
        let (q, v) = orders(&native, model)?;
        Ok(Self { name, native, q, v })
    }

    /// The peer's own function of this name, if it has it and its result can be told apart.
    pub(super) fn contender(&self, function: &Function<f64>, model: &Model<f64>) -> Option<Contender<'static>> {
        let shape = model.shape();
        let lengths: Vec<usize> = function.takes.iter().map(|a| a.len(shape)).collect();
        if lengths.iter().zip(function.takes).any(|(n, a)| *n != self.order(*a).len()) {
            return None;
        }
        let out = match function.gives {
            ResultKind::Placements => 0,
            other if [model.nv, model.nv * model.nv].contains(&other.len(shape)) => other.len(shape),
            _ => return None,
        };
        Some(Contender::peer(self.native.kernel(function.name, &lengths, out)?, out))
    }

    /// Our arguments in the peer's order.
    pub(super) fn arguments(&self, function: &Function<f64>, ours: &[&[f64]]) -> Vec<Vec<f64>> {
        let reorder = |(argument, x): (&Argument, &&[f64])| self.order(*argument).iter().map(|&k| x[k]).collect();
        function.takes.iter().zip(ours).map(reorder).collect()
    }

    /// The largest difference between the peer's results and ours, relative to the sum of the magnitudes of the terms; `None` where the peer
    /// keeps its results to itself.
    pub(super) fn difference(
        &self,
        function: &'static Function<f64>,
        model: &Model<f64>,
        ours: &[Vec<&[f64]>],
        theirs: &[Vec<&[f64]>],
        peer: &Contender<'_>,
        generic: &Contender<'_>,
    ) -> Option<f64> {
        let mut worst = 0.0_f64;
        for (x, y) in ours.iter().zip(theirs) {
            let (a, b) = (generic.call(x), peer.call(y));
            if b.is_empty() && !a.is_empty() {
                return None;
            }
            let scale = scales(model, function.name, x).ok()?;
            for (k, b) in b.iter().enumerate() {
                let at = self.place(k, a.len());
                let difference = (a[at] - b).abs();
                let relative = if difference == 0.0 { 0.0 } else { difference / scale[at] };
                worst = if worst.is_nan() || worst >= relative { worst } else { relative };
            }
        }
        Some(worst)
    }

    /// Our index of number `k` of the peer's result, a vector or a square matrix.
    fn place(&self, k: usize, length: usize) -> usize {
        let n = self.v.len();
        if length == n { self.v[k] } else { self.v[k / n] * n + self.v[k % n] }
    }

    fn order(&self, argument: Argument) -> &[usize] {
        if argument == Argument::Q { &self.q } else { &self.v }
    }
}

/// Our indices of the peer's coordinates and rates.
fn orders(peer: &NativePeer, model: &Model<f64>) -> Result<(Vec<usize>, Vec<usize>), String> {
    let incomplete = "it does not tell its joints";
    let (nq, nv, joints) = (peer.number("nq"), peer.number("nv"), peer.number("joint_count"));
    let (nq, nv, joints) = (nq.ok_or(incomplete)?, nv.ok_or(incomplete)?, joints.ok_or(incomplete)?);
    if (nq, nv, joints) != (model.nq, model.nv, model.joints.len()) {
        let ours = format!("{} with {} coordinates", model.joints.len(), model.nq);
        return Err(format!(
            "it has {joints} joints with {nq} coordinates, and here there are {ours} (peers take joints that follow others as free)"
        ));
    }
    let (mut q, mut v) = (vec![usize::MAX; nq], vec![usize::MAX; nv]);
    for k in 0..joints {
        let name = peer.joint_name(k).ok_or(incomplete)?;
        let ours = model.joints.iter().find(|j| j.name == name).ok_or_else(|| format!("its joint {name:?} is not one here"))?;
        let number = |what: &str| peer.joint_number(what, k).ok_or(incomplete);
        let (iq, iv, sizes) = (number("iq")?, number("iv")?, (number("nq")?, number("nv")?));
        if sizes != (ours.q.1, ours.v.1) || iq + sizes.0 > nq || iv + sizes.1 > nv {
            return Err(format!("its joint {name:?} has {} coordinates, and here it has {}", sizes.0, ours.q.1));
        }
        (0..sizes.0).for_each(|i| q[iq + i] = ours.q.0 + i);
        (0..sizes.1).for_each(|i| v[iv + i] = ours.v.0 + rate(ours, i));
    }
    if q.contains(&usize::MAX) || v.contains(&usize::MAX) { Err("its joints overlap".into()) } else { Ok((q, v)) }
}

/// A peer's free joint moves by [linear; angular], ours by [angular; linear].
fn rate(joint: &JointInfo, k: usize) -> usize {
    if joint.v.1 == 6 { (k + 3) % 6 } else { k }
}

/// (name, path) of the libraries in a manifest: a list of objects with `name` and `path`.
pub(super) fn manifest(file: &Path) -> Result<Vec<(Option<String>, PathBuf)>, String> {
    let text = std::fs::read_to_string(file).map_err(|e| format!("{}: {e}", file.display()))?;
    let value: Value = serde_json::from_str(&text).map_err(|e| format!("{}: {e}", file.display()))?;
    let list = value.as_array().or_else(|| value.get("peers")?.as_array());
    let list = list.ok_or_else(|| format!("{}: found no list of peers", file.display()))?;
    let one = |entry: &Value| {
        let text = |key: &str| entry.get(key)?.as_str().map(str::to_owned);
        text("path").map(|path| (text("name"), PathBuf::from(path)))
    };
    list.iter().map(|e| one(e).ok_or_else(|| format!("{}: found a peer without a path", file.display()))).collect()
}
