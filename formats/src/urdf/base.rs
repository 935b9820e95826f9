//! Links that a fixed base holds: their mass has no effect on the dynamics.

use articulated_core::description::JointKind;
use articulated_core::diagnostic::Diagnostics;

use super::ast::Draft;
use super::tree::Tree;
use crate::reading::HELD;

const TAG: &str = "inertial";

/// Reports the mass of the root link and of the links fixed to it. This is common, so it is no
/// warning.
pub(crate) fn report(draft: &Draft, tree: &Tree, log: &mut Diagnostics) {
    for link in held(draft, tree).into_iter().filter(|link| has_mass(draft, *link)) {
        log.unused_at(draft.links[link].at, &draft.links[link].subject(), TAG.to_owned(), HELD);
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
