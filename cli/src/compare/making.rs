//! What it takes to make code: generation and compilation of several functions together, ours beside the generators' among the peers.

use std::time::Instant;

use serde::Serialize;

use super::peer::Peer;
use super::prepare::{Plan, Prepared};
use crate::compiled::Compiled;
use crate::failure::Failure;

#[derive(Clone, Debug, Serialize)]
pub(super) struct Making {
    /// Those of which all generators that know the robot have code.
    pub(super) functions: Vec<&'static str>,
    pub(super) generation_seconds: f64,
    /// `rustc` on one module, start and linking included.
    pub(super) compilation_seconds: f64,
    pub(super) peers: Vec<PeerMaking>,
}

#[derive(Clone, Debug, Serialize)]
pub(super) struct PeerMaking {
    pub(super) peer: String,
    pub(super) generation_seconds: f64,
    /// The sum over files of one function each.
    pub(super) compilation_seconds: f64,
    /// Of both together.
    pub(super) peer_over_ours: f64,
}

impl Making {
    /// Makes all of them again, with nothing else going on; `None` where no peer has generated code of any.
    pub(super) fn of(plan: &Plan, prepared: &[Prepared], peers: &[Peer]) -> Result<Option<Self>, Failure> {
        let generators: Vec<&Peer> = peers.iter().filter(|p| prepared.iter().any(|r| p.cost(r.function.name).is_some())).collect();
        let names = prepared.iter().map(|r| r.function.name);
        let functions: Vec<&'static str> = names.filter(|name| generators.iter().all(|p| p.cost(name).is_some())).collect();
        if generators.is_empty() || functions.is_empty() {
            return Ok(None);
        }
        let wanted: Vec<String> = functions.iter().map(|name| (*name).to_owned()).collect();
        let start = Instant::now();
        let generated = plan.robot.generate(&wanted)?;
        let generation_seconds = start.elapsed().as_secs_f64();
        let compilation_seconds = Compiled::build(&plan.rustc, &generated).map_err(|e| Failure::tool(&e))?.time.as_secs_f64();
        let ours = generation_seconds + compilation_seconds;
        let peers = generators.iter().map(|p| PeerMaking::of(p, &functions, ours)).collect();
        Ok(Some(Self { functions, generation_seconds, compilation_seconds, peers }))
    }
}

impl PeerMaking {
    fn of(peer: &Peer, functions: &[&str], ours: f64) -> Self {
        let costs = || functions.iter().filter_map(|name| peer.cost(name));
        let generation_seconds: f64 = costs().map(|c| c.generation_seconds).sum();
        let compilation_seconds: f64 = costs().map(|c| c.compilation_seconds).sum();
        let peer_over_ours = (generation_seconds + compilation_seconds) / ours;
        Self { peer: peer.name.clone(), generation_seconds, compilation_seconds, peer_over_ours }
    }
}
