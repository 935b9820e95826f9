//! What a fixed base holds: mass there plays no part in the dynamics.

use articulated_core::description::JointKind;

use crate::draft::Draft;
use crate::log::Log;
use crate::problem::Subject;
use crate::tree::Tree;
use crate::{Reading, Unused};

const TAG: &str = "inertial";
const WHY: &str = "the base is fixed, and this link with it";

/// Reports the mass of the root link and of the links that are fixed to it. Any robot's base has some: that is nothing to be warned of.
pub(crate) fn report(draft: &Draft, tree: &Tree, log: &mut Log) {
    for link in held(draft, tree).into_iter().filter(|link| has_mass(draft, *link)) {
        log.unused_at(Some(draft.links[link].line), &draft.links[link].subject(), TAG.to_owned(), WHY);
    }
}

impl Reading {
    /// Takes back what was said of mass that the fixed base holds, of the links that an edit has let `go`.
    pub fn release(&mut self, go: impl Fn(&str) -> bool) {
        let of_held = |u: &Unused| u.tag == TAG && u.why == WHY;
        self.unused.retain(|u| !(of_held(u) && matches!(&u.subject, Subject::Link(name) if go(name))));
    }
}

fn has_mass(draft: &Draft, link: usize) -> bool {
    draft.links[link].inertial.is_some_and(|i| i.mass != 0.0 || i.inertia != [0.0; 6])
}

/// The root and all links that fixed joints tie to it, in the order of the walk.
fn held(draft: &Draft, tree: &Tree) -> Vec<usize> {
    let mut below = vec![Vec::new(); draft.links.len()];
    for (joint, _) in draft.joints.iter().enumerate().filter(|(_, j)| j.kind.is_some_and(JointKind::is_fixed)) {
        below[tree.parent[joint]].push(tree.child[joint]);
    }
    let mut held = vec![tree.root];
    let mut next = 0;
    while let Some(link) = held.get(next) {
        let children = std::mem::take(&mut below[*link]);
        held.extend(children);
        next += 1;
    }
    held
}
