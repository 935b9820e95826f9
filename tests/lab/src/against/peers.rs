//! Libraries that make steps of their own, behind the C interface of a peer.

use std::path::Path;

use articulated_core::description::Base;

use super::Runner;
use super::search::{self, Effort};
use crate::compare::manifest::Library;
use crate::compare::peer::orders;
use crate::error::Error;
use crate::native::{Native, NativePeer, Stepping};
use crate::session::Session;

/// A peer at the start of the motion.
pub(crate) struct Peer {
    engine: String,
    native: NativePeer,
    /// Our index of each of its coordinates and rates.
    orders: (Vec<usize>, Vec<usize>),
    start: (Vec<f64>, Vec<f64>),
    length: f64,
    /// By which it makes steps.
    method: Stepping,
    steps: usize,
}

/// The peers of the libraries that make steps and read the robot, and the reasons why others do
/// not. They start at (q, v), in our order, and simulate for `seconds`.
pub(crate) fn open(
    session: &Session,
    libraries: &[Library],
    folder: &Path,
    start: (&[f64], &[f64]),
    seconds: f64,
) -> Result<(Vec<Peer>, Vec<String>), Error> {
    let urdf = folder.join("robot.urdf");
    std::fs::write(&urdf, &session.request.document).map_err(|e| Error::tool(&e))?;
    let (mut peers, mut notes) = (Vec::new(), Vec::new());
    for library in libraries {
        match Peer::open(session, library, &urdf, start, seconds) {
            Ok(Some(peer)) => peers.push(peer),
            Ok(None) => {}
            Err(reason) => {
                let name = library.name.clone().unwrap_or_else(|| library.path.display().to_string());
                notes.push(format!("peer {name} is left out: {reason}"));
            }
        }
    }
    if peers.is_empty() {
        notes.push("there is no peer that makes steps: see tests/peers for MuJoCo's".to_owned());
    }
    Ok((peers, notes))
}

impl Peer {
    /// `None`: it is not a simulation engine.
    fn open(session: &Session, library: &Library, urdf: &Path, start: (&[f64], &[f64]), seconds: f64) -> Result<Option<Self>, String> {
        let opened = Native::open(&library.path)?;
        let engine = library.engine.clone().or_else(|| opened.peer_name()).ok_or("it has no function peer_name")?;
        let gravity = session.model.gravity().into();
        if !opened.simulates() {
            return Ok(None);
        }
        let native = NativePeer::open(&opened, urdf, session.base() == Base::Floating, gravity)?;
        let method = native.methods().into_iter().next().ok_or("it names no method")?;
        let orders = orders(&native, &session.model)?;
        let pick = |x: &[f64], order: &[usize]| order.iter().map(|&k| x[k]).collect::<Vec<f64>>();
        let start = (pick(start.0, &orders.0), pick(start.1, &orders.1));
        Ok(Some(Self { engine, native, orders, start, length: seconds, method, steps: 0 }))
    }

    /// The name of its engine.
    pub(crate) fn engine(&self) -> &str {
        &self.engine
    }

    /// By which it can make steps.
    pub(crate) fn methods(&self) -> Vec<Stepping> {
        self.native.methods()
    }

    /// Runs to the end in this number of equal steps; q and v there in our order, or `None` if it
    /// diverged.
    pub(crate) fn go(&self, method: &Stepping, steps: usize) -> Option<(Vec<f64>, Vec<f64>)> {
        let (mut q, mut v) = self.start.clone();
        self.native.simulate(method, &mut q, &mut v, self.length / steps as f64, steps)?;
        let ours = |x: &[f64], order: &[usize]| {
            let mut out = vec![0.0; x.len()];
            order.iter().zip(x).for_each(|(&k, x)| out[k] = *x);
            out
        };
        Some((ours(&q, &self.orders.0), ours(&v, &self.orders.1)))
    }
}

impl Runner for Peer {
    fn name(&self) -> String {
        format!("{} {}", self.engine, self.method.name)
    }

    fn order(&self) -> u32 {
        self.method.order
    }

    fn is_ours(&self) -> bool {
        false
    }

    fn effort(&self, level: usize) -> Option<Effort> {
        search::steps(level)
    }

    fn run(&mut self, effort: Effort) -> Option<Vec<f64>> {
        let Effort::Steps(steps) = effort else { return None };
        self.steps = steps;
        let (q, v) = self.go(&self.method, steps)?;
        Some([q, v].concat())
    }

    fn spent(&self) -> (u64, u64) {
        (self.steps as u64, u64::from(self.method.evaluations) * self.steps as u64)
    }
}
