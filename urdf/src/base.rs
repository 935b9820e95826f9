//! What a fixed base holds: mass there plays no part in the dynamics.

use articulated_core::description::JointKind;

use crate::draft::Draft;
use crate::log::{Log, Place};
use crate::problem::Kind;
use crate::tree::{List, Tree};

/// Reports the mass of the root link and of the links that are fixed to it.
pub(crate) fn report(draft: &Draft, tree: &Tree, log: &mut Log) {
    let held: Vec<usize> = held(draft, tree).into_iter().filter(|link| has_mass(draft, *link)).collect();
    let Some(first) = held.first() else { return };
    let mut names = List::default();
    for link in &held {
        let link = &draft.links[*link];
        names.push(&link.subject());
        let why = "the base is fixed, and this link with it";
        log.unused_at(Some(link.line), &link.subject(), "inertial".to_owned(), why);
    }
    let subject = draft.links[*first].subject();
    let place = Place { line: Some(draft.links[*first].line), subject: &subject, field: "inertial" };
    let found = format!("mass that a fixed base holds ({})", names.text());
    log.warning(&place, Kind::UnusedInertia, found, "none there: it plays no part in the dynamics");
}

fn has_mass(draft: &Draft, link: usize) -> bool {
    draft.links[link].inertial.is_some_and(|i| i.mass != 0.0 || i.inertia != [0.0; 6])
}

/// The root and all links that fixed joints tie to it, in the order of the walk.
fn held(draft: &Draft, tree: &Tree) -> Vec<usize> {
    let mut below = vec![Vec::new(); draft.links.len()];
    for (joint, _) in draft.joints.iter().enumerate().filter(|(_, j)| j.kind == Some(JointKind::Fixed)) {
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
