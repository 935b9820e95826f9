//! Times to make code: generation and compilation of several functions together, ours and the
//! peers'.

use std::time::Instant;

use serde::Serialize;

use super::peer::Peer;
use super::prepare::{Plan, Prepared};
use crate::compiled::Compiled;
use crate::error::Error;

#[derive(Clone, Debug, Serialize)]
pub(super) struct Making {
    /// The compared functions for which these generators have code.
    pub(super) functions: Vec<&'static str>,
    pub(super) generation_seconds: f64,
    /// `rustc` on one module to its object file, start included, as the peers' compilers are timed.
    pub(super) compilation_seconds: f64,
    pub(super) peers: Vec<PeerMaking>,
}

#[derive(Clone, Debug, Serialize)]
pub(super) struct PeerMaking {
    pub(super) peer: String,
    /// `None` for a library that serves any robot.
    pub(super) generation_seconds: Option<f64>,
    /// The sum over files of one function each; for a library that serves any robot, all of it.
    pub(super) compilation_seconds: f64,
    /// For both together; `None` for a library that serves any robot, since its other functions
    /// were compiled too.
    pub(super) peer_over_ours: Option<f64>,
}

impl Making {
    /// One for each set of functions of a generator among the peers. Ours are made again, without
    /// other load.
    pub(super) fn all(plan: &Plan, prepared: &[Prepared], peers: &[Peer]) -> Result<Vec<Self>, Error> {
        let mut sets: Vec<(Vec<&'static str>, Vec<PeerMaking>)> = Vec::new();
        for peer in peers {
            let names = prepared.iter().map(|r| r.function.name);
            let functions: Vec<&'static str> = names.filter(|name| peer.cost(name).is_some()).collect();
            if functions.is_empty() {
                continue;
            }
            let row = PeerMaking::generated(peer, &functions);
            match sets.iter_mut().find(|(known, _)| *known == functions) {
                Some((_, rows)) => rows.push(row),
                None => sets.push((functions, vec![row])),
            }
        }
        sets.into_iter().map(|(functions, rows)| Self::of(plan, functions, rows, peers)).collect()
    }

    fn of(plan: &Plan, functions: Vec<&'static str>, mut rows: Vec<PeerMaking>, peers: &[Peer]) -> Result<Self, Error> {
        let wanted: Vec<String> = functions.iter().map(|name| (*name).to_owned()).collect();
        let start = Instant::now();
        let generated = plan.robot.generate(&wanted)?;
        let generation_seconds = start.elapsed().as_secs_f64();
        let compilation_seconds = Compiled::object_time(&plan.rustc, &generated).map_err(|e| Error::tool(&e))?.as_secs_f64();
        for row in &mut rows {
            let theirs = row.generation_seconds.unwrap_or_default() + row.compilation_seconds;
            row.peer_over_ours = Some(theirs / (generation_seconds + compilation_seconds));
        }
        rows.extend(peers.iter().filter_map(PeerMaking::compiled));
        Ok(Self { functions, generation_seconds, compilation_seconds, peers: rows })
    }
}

impl PeerMaking {
    fn generated(peer: &Peer, functions: &[&str]) -> Self {
        let costs = || functions.iter().filter_map(|name| peer.cost(name));
        let generation_seconds = Some(costs().map(|c| c.generation_seconds).sum());
        let compilation_seconds = costs().map(|c| c.compilation_seconds).sum();
        Self { peer: peer.name.clone(), generation_seconds, compilation_seconds, peer_over_ours: None }
    }

    /// A library that is compiled once for all robots, if it was measured.
    fn compiled(peer: &Peer) -> Option<Self> {
        let compilation_seconds = peer.library.compilation_seconds?;
        Some(Self { peer: peer.name.clone(), generation_seconds: None, compilation_seconds, peer_over_ours: None })
    }
}
