//! Libraries that make steps of their own, as further curves: MuJoCo's Euler, implicitfast and RK4.

use std::path::Path;

use super::subject::Subject;
use crate::against::peers::{Peer, open};
use crate::against::unknown_to_peers;
use crate::compare::manifest::Library;
use crate::error::Error;
use crate::session::Session;

/// Available peers, and why others are missing.
pub(super) struct Peers {
    pub(super) peers: Vec<Peer>,
    pub(super) notes: Vec<String>,
}

impl Peers {
    /// The peers of the libraries that make steps, at the start of the motion.
    pub(super) fn open(session: &Session, subject: &Subject, libraries: &[Library], folder: &Path) -> Result<Self, Error> {
        let without = |note: String| Ok(Self { peers: Vec::new(), notes: vec![note] });
        if libraries.is_empty() {
            return without(
                "no peers: --peers-manifest names what tests/peers/build.py made, and MuJoCo's integrators come beside these".into(),
            );
        }
        let unknown = unknown_to_peers(session);
        if !unknown.is_empty() {
            return without(format!("no peers: they know the robot's file and its gravity only, and the scene has {}", unknown.join(", ")));
        }
        let (peers, notes) = open(session, libraries, folder, (&subject.q, &subject.v), subject.seconds)?;
        Ok(Self { peers, notes })
    }

    /// How many curves they have.
    pub(super) fn count(&self) -> usize {
        self.peers.iter().map(|p| p.methods().len()).sum()
    }
}
