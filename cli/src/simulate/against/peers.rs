//! Libraries that take steps of their own, behind the C interface of a peer.

use std::path::Path;

use articulated::simulate::Settings;
use articulated_core::description::Base;

use super::Runner;
use super::search::{self, Effort};
use crate::compare::manifest::{self, Library};
use crate::compare::peer::orders;
use crate::failure::Failure;
use crate::native::{Native, NativePeer};
use crate::simulate::stage::Stage;

/// A peer at the start of the motion.
pub(super) struct Peer {
    name: String,
    native: NativePeer,
    /// Our index of each of its coordinates and rates.
    orders: (Vec<usize>, Vec<usize>),
    start: (Vec<f64>, Vec<f64>),
    length: f64,
    steps: usize,
}

/// Those of the file that take steps and read the robot, and why others do not.
pub(super) fn open(
    stage: &Stage,
    file: &Path,
    folder: &Path,
    start: (&[f64], &[f64]),
    settings: &Settings,
) -> Result<(Vec<Peer>, Vec<String>), Failure> {
    let list = file.extension().is_some_and(|e| e == "json");
    let libraries = if list { manifest::read(file).map_err(|line| Failure::input([line]))? } else { vec![Library::at(file)] };
    let urdf = folder.join("robot.urdf");
    std::fs::write(&urdf, &stage.prepared.request.urdf).map_err(|e| Failure::tool(&e))?;
    let (mut peers, mut notes) = (Vec::new(), Vec::new());
    for library in libraries {
        match Peer::open(stage, &library, &urdf, start, settings) {
            Ok(Some(peer)) => peers.push(peer),
            Ok(None) => {}
            Err(reason) => {
                notes.push(format!("peer {} is left out: {reason}", library.name.unwrap_or_else(|| library.path.display().to_string())));
            }
        }
    }
    if peers.is_empty() {
        notes.push(format!("{}: found no peer that takes steps", file.display()));
    }
    Ok((peers, notes))
}

impl Peer {
    /// `None`: it is no engine of simulation.
    fn open(stage: &Stage, library: &Library, urdf: &Path, start: (&[f64], &[f64]), settings: &Settings) -> Result<Option<Self>, String> {
        let opened = Native::open(&library.path)?;
        let name = library.engine.clone().or_else(|| opened.peer_name()).ok_or("it has no function peer_name")?;
        let gravity = stage.prepared.request.options.gravity;
        if !opened.simulates() {
            return Ok(None);
        }
        let native = NativePeer::open(&opened, urdf, stage.base() == Base::Floating, gravity)?;
        let orders = orders(&native, &stage.model)?;
        let pick = |x: &[f64], order: &[usize]| order.iter().map(|&k| x[k]).collect::<Vec<f64>>();
        let start = (pick(start.0, &orders.0), pick(start.1, &orders.1));
        Ok(Some(Self { name, native, orders, start, length: settings.end - settings.start, steps: 0 }))
    }
}

impl Runner for Peer {
    fn name(&self) -> String {
        format!("{} RK4", self.name)
    }

    fn order(&self) -> u32 {
        4
    }

    fn own(&self) -> bool {
        false
    }

    fn effort(&self, level: usize) -> Option<Effort> {
        search::steps(level)
    }

    fn run(&mut self, effort: Effort) -> Option<Vec<f64>> {
        let Effort::Steps(steps) = effort else { return None };
        self.steps = steps;
        let (mut q, mut v) = self.start.clone();
        self.native.simulate(&mut q, &mut v, self.length / steps as f64, steps)?;
        let (nq, nv) = (q.len(), v.len());
        let mut out = vec![0.0; nq + nv];
        self.orders.0.iter().zip(&q).for_each(|(&k, x)| out[k] = *x);
        self.orders.1.iter().zip(&v).for_each(|(&k, x)| out[nq + k] = *x);
        Some(out)
    }

    fn spent(&self) -> (u64, u64) {
        (self.steps as u64, 4 * self.steps as u64)
    }
}
