//! Other libraries, behind the C interface of a peer, with their order of joints and of numbers.

use std::path::Path;

use articulated_core::algorithm::{Argument, Dim, Function, Shape};
use articulated_core::model::{JointInfo, Model};
use articulated_core::spatial::Reference;
use articulated_reference::scales;

use super::contender::Contender;
use super::manifest::{Code, Cost, Library};
use crate::error::Error;
use crate::native::{Native, NativePeer, PeerKernel};
use crate::robot::Robot;
use crate::states::quaternions;
use crate::table::counted;

/// The smallest scale of a difference, relative to the largest in the same result.
const FLOOR: f64 = 1e-3;

/// A robot open in a peer library.
pub(crate) struct Peer {
    pub(crate) name: String,
    /// The library's entry in the manifest.
    pub(crate) library: Library,
    /// Its code for this robot, if it is a generator's.
    code: Option<Code>,
    native: NativePeer,
    /// Our index of each number of the peer's q.
    q: Vec<usize>,
    /// Our index of each number of the peer's v, a and τ.
    v: Vec<usize>,
    /// Whether its joints are in the order of our links.
    links: bool,
}

/// The libraries that read this robot, from a file in `folder`; a note for each that does not.
pub(crate) fn open_all(
    libraries: Vec<Library>,
    robot: &Robot,
    model: &Model<f64>,
    folder: &Path,
    notes: &mut Vec<String>,
) -> Result<Vec<Peer>, Error> {
    let mut peers = Vec::new();
    if libraries.is_empty() {
        return Ok(peers);
    }
    let urdf = robot.file_in(folder).map_err(|e| Error::input([format!("{}: {e}", robot.file)]))?;
    for library in libraries {
        let label = library.name.clone().unwrap_or_else(|| library.path.display().to_string());
        match Peer::open(library, &urdf, robot, model) {
            Ok(peer) => peers.push(peer),
            Err(reason) => notes.push(format!("peer {label} is left out: {reason}")),
        }
    }
    Ok(peers)
}

impl Peer {
    /// Opens the robot in the library; the reason if their joints are not ours.
    pub(crate) fn open(library: Library, urdf: &Path, robot: &Robot, model: &Model<f64>) -> Result<Self, String> {
        let opened = Native::open(&library.path)?;
        let name = library.name.clone().or_else(|| opened.peer_name()).ok_or("it has no function peer_name")?;
        let native = NativePeer::open(&opened, urdf, robot.floating(), model.gravity().into())?;
        let (q, v) = orders(&native, model)?;
        let links = model.links().enumerate().all(|(k, i)| native.joint_name(k).is_some_and(|name| name == model.bodies()[i].name));
        let code = library.code(&robot.document, robot.floating()).cloned();
        Ok(Self { name, library, code, native, q, v, links })
    }

    /// The common name of its builds.
    pub(super) fn engine(&self) -> &str {
        self.library.engine.as_deref().unwrap_or(&self.name)
    }

    /// The cost of making the function's code, if it was generated.
    pub(super) fn cost(&self, function: &str) -> Option<&Cost> {
        self.code.as_ref()?.functions.get(function)
    }

    /// The peer's own function of this name, if it has it, means the same by it, and computes one
    /// state a call.
    pub(crate) fn contender(&self, function: &Function<f64>, model: &Model<f64>) -> Option<Contender<'static>> {
        let out = function.len(model.shape());
        self.library.lanes.is_none().then(|| Some(Contender::peer(self.kernel(function, model, 1)?, out)))?
    }

    /// The same for a peer that computes several states per call, and their number; for results
    /// that it writes out.
    pub(super) fn in_lanes(&self, function: &Function<f64>, model: &Model<f64>) -> Option<(PeerKernel, usize)> {
        let lanes = self.library.lanes?.get();
        let kernel = self.kernel(function, model, lanes)?;
        kernel.writes().then_some((kernel, lanes))
    }

    fn kernel(&self, function: &Function<f64>, model: &Model<f64>, states: usize) -> Option<PeerKernel> {
        let has = |dim: Dim| function.takes.iter().flat_map(|a| a.dims()).chain(function.gives).any(|d| *d == dim);
        let wrenches = !function.takes.contains(&Argument::Wrenches) || model.wrench_reference() == Reference::Body;
        let told = (!has(Dim::Frames) || self.has_frames(model)) && (!has(Dim::Links) || self.links);
        if !wrenches || !told {
            return None;
        }
        let lengths: Vec<usize> = function.takes.iter().map(|a| states * a.len(model.shape())).collect();
        self.native.kernel(function.name, &lengths, states * function.len(model.shape()), is_kept(function.gives))
    }

    /// Whether the peer's frames are the model's, in its order; they are made so if the peer lets
    /// them be chosen.
    fn has_frames(&self, model: &Model<f64>) -> bool {
        let names: Vec<&str> = model.frames().iter().map(|f| f.name.as_str()).collect();
        self.native.choose_frames(&names) || self.native.frames() == names
    }

    /// Our arguments in the peer's order.
    pub(crate) fn arguments(&self, function: &Function<f64>, model: &Model<f64>, ours: &[&[f64]]) -> Vec<Vec<f64>> {
        let reorder =
            |(argument, x): (&Argument, &&[f64])| (0..x.len()).map(|k| x[self.place(k, argument.dims(), model.shape())]).collect();
        function.takes.iter().zip(ours).map(reorder).collect()
    }

    /// The largest difference between the peer's results and ours, relative to the sum of the
    /// magnitudes of the terms; `None` if the peer does not return its results.
    pub(super) fn difference(
        &self,
        function: &'static Function<f64>,
        model: &Model<f64>,
        ours: &[Vec<&[f64]>],
        theirs: &[Vec<&[f64]>],
        peer: &Contender<'_>,
        generic: &Contender<'_>,
    ) -> Option<f64> {
        let told = |k: usize, a: &[f64]| {
            let b = peer.call(&theirs[k]);
            (a.is_empty() || !b.is_empty()).then(|| self.in_our_order(&b, a, function, model))
        };
        difference(function, model, ours, generic, told)
    }

    /// The peer's result in our layout. Quaternions of a configuration are rotations with either
    /// sign; they get the signs of ours.
    pub(crate) fn in_our_order(&self, theirs: &[f64], ours: &[f64], function: &Function<f64>, model: &Model<f64>) -> Vec<f64> {
        let mut result = vec![f64::NAN; ours.len()];
        for (k, x) in theirs.iter().enumerate() {
            result[self.place(k, function.gives, model.shape())] = *x;
        }
        if function.gives == [Dim::Nq] {
            for (_, at) in quaternions(model) {
                let along: f64 = (at..at + 4).map(|k| ours[k] * result[k]).sum();
                result[at..at + 4].iter_mut().for_each(|x| *x = if along < 0.0 { -*x } else { *x });
            }
        }
        result
    }

    /// Our index of number `k` of the peer's array of these dimensions.
    fn place(&self, k: usize, dims: &[Dim], shape: Shape) -> usize {
        let (mut rest, mut stride, mut at) = (k, 1, 0);
        for dim in dims.iter().rev() {
            let (n, index) = (dim.len(shape), rest % dim.len(shape));
            let ours = match dim {
                Dim::Nq => self.q[index],
                Dim::Nv => self.v[index],
                Dim::Frames | Dim::Links | Dim::Controls | Dim::Activations | Dim::Contacts | Dim::Given | Dim::Of(_) => index,
            };
            (rest, stride, at) = (rest / n, stride * n, at + stride * ours);
        }
        at
    }
}

/// The largest difference between the results of generic code and others in these states, relative
/// to the sum of the magnitudes of the terms. `other` gets the index of the state and the generic
/// result; `None` if it has no result.
pub(super) fn difference(
    function: &'static Function<f64>,
    model: &Model<f64>,
    states: &[Vec<&[f64]>],
    generic: &Contender<'_>,
    other: impl Fn(usize, &[f64]) -> Option<Vec<f64>>,
) -> Option<f64> {
    let mut worst = 0.0_f64;
    for (k, x) in states.iter().enumerate() {
        let a = generic.call(x);
        let b = other(k, &a)?;
        let scale = scales(model, function.name, x).ok()?;
        // Our zero and their rounding error count as equal.
        let floor = scale.iter().copied().fold(0.0, f64::max) * FLOOR;
        for (scale, (a, b)) in scale.iter().zip(a.iter().zip(b)) {
            let difference = (a - b).abs();
            let relative = if difference == 0.0 { 0.0 } else { difference / scale.max(floor) };
            worst = if worst.is_nan() || worst >= relative { worst } else { relative };
        }
    }
    Some(worst)
}

/// Whether a peer returns a result of these dimensions only on request: all except rows of numbers
/// and square matrices, which it writes out each time.
fn is_kept(gives: &[Dim]) -> bool {
    let row = gives.len() < 2 && !gives.contains(&Dim::Frames) && !gives.contains(&Dim::Links);
    !row && gives != [Dim::Nv, Dim::Nv]
}

/// Our indices of the peer's coordinates and rates.
pub(crate) fn orders(peer: &NativePeer, model: &Model<f64>) -> Result<(Vec<usize>, Vec<usize>), String> {
    let incomplete = "it does not tell its joints";
    let (nq, nv, joints) = (peer.number("nq"), peer.number("nv"), peer.number("joint_count"));
    let (nq, nv, joints) = (nq.ok_or(incomplete)?, nv.ok_or(incomplete)?, joints.ok_or(incomplete)?);
    if (nq, nv, joints) != (model.nq(), model.nv(), model.joints().len()) {
        let [theirs, ours] = [(joints, nq), (model.joints().len(), model.nq())]
            .map(|(joints, nq)| format!("{} with {}", counted(joints, "joint"), counted(nq, "coordinate")));
        return Err(format!("it has {theirs}, and here there are {ours} (peers take joints that follow others as free)"));
    }
    let (mut q, mut v) = (vec![usize::MAX; nq], vec![usize::MAX; nv]);
    for k in 0..joints {
        let name = peer.joint_name(k).ok_or(incomplete)?;
        let ours = model.joints().iter().find(|j| j.name == name).ok_or_else(|| format!("its joint {name:?} is not one here"))?;
        let number = |what: &str| peer.joint_number(what, k).ok_or(incomplete);
        let (iq, iv, sizes) = (number("iq")?, number("iv")?, (number("nq")?, number("nv")?));
        if sizes != (ours.q.1, ours.v.1) || iq + sizes.0 > nq || iv + sizes.1 > nv {
            return Err(format!("its joint {name:?} has {}, and here it has {}", counted(sizes.0, "coordinate"), ours.q.1));
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
