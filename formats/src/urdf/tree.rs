//! Names become indices, and joints a tree. There is no recursion: chains may have any length.

use crate::xml::markup::hint;
use articulated_core::diagnostic::{At, Code, Diagnostics, Place, Subject, quote};
use std::collections::HashMap;

use articulated_core::listed;
use articulated_core::suggest::Suggester;

use super::ast::{Draft, DraftJoint, Reference};
use crate::cycles::{around, cycles};
use crate::xml::number::is_expression;

/// Which links each joint connects.
pub(crate) struct Tree {
    pub(crate) parent: Vec<usize>,
    pub(crate) child: Vec<usize>,
    pub(crate) root: usize,
}

/// The tree, if it is one; every reason why it is not, otherwise.
pub(crate) fn connect(draft: &Draft, log: &mut Diagnostics) -> Option<Tree> {
    let links = unique_names(draft.links.iter().map(|l| (l.name.as_deref(), l.at)), Subject::Link, log);
    unique_names(draft.joints.iter().map(|j| (j.name.as_deref(), j.at)), Subject::Joint, log);
    let mut ends = Ends::of(draft, &links, log);
    ends.complete &= links.len() == draft.links.len();
    let above = joints_above(draft, &ends, log);
    let cycles = report_rings(draft, &ends, &above, log);
    let root = root(draft, &ends, &above, cycles, log);
    Some(Tree { parent: all(&ends.parent)?, child: all(&ends.child)?, root: root? })
}

/// The line of a place in the file.
fn line(at: At) -> u32 {
    at.line().unwrap_or_default()
}

fn all(ends: &[Option<usize>]) -> Option<Vec<usize>> {
    ends.iter().copied().collect()
}

/// Index of each name; the first one of duplicates.
pub(crate) type Names<'a> = HashMap<&'a str, usize>;

fn unique_names<'a>(
    names: impl Iterator<Item = (Option<&'a str>, At)>,
    subject: fn(String) -> Subject,
    log: &mut Diagnostics,
) -> Names<'a> {
    let mut index = Names::new();
    let mut places = Vec::new();
    for (i, (name, at)) in names.enumerate() {
        places.push(at);
        let Some(name) = name else { continue };
        let first = *index.entry(name).or_insert(i);
        if first != i {
            let subject = subject(name.to_owned());
            let place = Place { at, subject: &subject, field: "name" };
            let found = format!("a duplicate: line {} already has the name {}", line(places[first]), quote(name));
            log.error(place, Code::DuplicateName, found, "a name of its own");
        }
    }
    index
}

/// The links of each joint, where they exist.
struct Ends {
    parent: Vec<Option<usize>>,
    child: Vec<Option<usize>>,
    /// Whether every name is that of one link.
    complete: bool,
}

impl Ends {
    fn of(draft: &Draft, links: &Names<'_>, log: &mut Diagnostics) -> Self {
        let mut look = LookUp { draft, links, suggester: Suggester::default() };
        let mut ends = Self { parent: Vec::new(), child: Vec::new(), complete: true };
        for joint in &draft.joints {
            ends.parent.push(look.up(joint, joint.parent.as_ref(), "parent", log));
            ends.child.push(look.up(joint, joint.child.as_ref(), "child", log));
        }
        ends.complete = ends.parent.iter().chain(&ends.child).all(Option::is_some);
        ends
    }
}

struct LookUp<'a> {
    draft: &'a Draft,
    links: &'a Names<'a>,
    suggester: Suggester,
}

impl LookUp<'_> {
    fn up(&mut self, joint: &DraftJoint, end: Option<&Reference>, field: &str, log: &mut Diagnostics) -> Option<usize> {
        let Reference { name, at } = end?;
        let index = self.links.get(name.as_str()).copied();
        if index.is_none() && !is_expression(name) {
            let names = self.draft.links.iter().filter_map(|l| l.name.as_deref());
            let hint = hint(self.suggester.nearest(name, names));
            let subject = joint.subject();
            let place = Place { at: *at, subject: &subject, field };
            let found = format!("{}, which is not a link of this file", quote(name));
            log.error(place, Code::UnknownLink, found, format!("the name of a link{hint}"));
        }
        index
    }
}

/// For each link, the joint that it hangs on; the first one of several.
fn joints_above(draft: &Draft, ends: &Ends, log: &mut Diagnostics) -> Vec<Option<usize>> {
    let mut above: Vec<Option<usize>> = vec![None; draft.links.len()];
    for (joint, child) in ends.child.iter().enumerate() {
        let Some(child) = *child else { continue };
        match above[child] {
            None => above[child] = Some(joint),
            Some(first) => report_two_parents(draft, child, first, joint, log),
        }
    }
    above
}

fn report_two_parents(draft: &Draft, link: usize, first: usize, second: usize, log: &mut Diagnostics) {
    let subject = draft.links[link].subject();
    let place = Place { at: draft.joints[second].at, subject: &subject, field: "parent" };
    let [first, second] = [first, second].map(|joint| draft.joints[joint].subject());
    let found = format!("a second parent: it is the child of {first} and of {second}");
    log.error(place, Code::TwoParents, found, "a link that hangs on one joint");
}

/// Returns how many rings there are.
fn report_rings(draft: &Draft, ends: &Ends, above: &[Option<usize>], log: &mut Diagnostics) -> usize {
    let parent = |link: usize| above[link].and_then(|joint| ends.parent[joint]);
    let cycles = cycles(above.len(), parent);
    for link in &cycles {
        let joints = around(*link, parent).filter_map(|link| Some(draft.joints[above[link]?].subject()));
        let subject = draft.links[*link].subject();
        let place = Place { at: draft.links[*link].at, subject: &subject, field: "parent" };
        log.error(place, Code::Ring, format!("a ring (loop) of {}", listed(joints)), "a tree with one root");
    }
    cycles.len()
}

/// The tags that look like joints and are not read: links that hang on them are roots.
fn passed_over(draft: &Draft) -> String {
    let tags = draft.passed_over.iter().map(|tag| {
        let name = if tag.name.is_empty() { String::new() } else { format!(" {}", quote(&tag.name)) };
        format!("<{}>{name} in line {}", tag.tag, line(tag.at))
    });
    match draft.passed_over.as_slice() {
        [] => String::new(),
        [_] => format!("; {} is not read: write it as <joint>", listed(tags)),
        _ => format!("; {} are not read: write them as <joint>", listed(tags)),
    }
}

fn root(draft: &Draft, ends: &Ends, above: &[Option<usize>], cycles: usize, log: &mut Diagnostics) -> Option<usize> {
    let roots: Vec<usize> = (0..above.len()).filter(|link| above[*link].is_none()).collect();
    // An unknown or ambiguous name leaves a link without a parent, which has been reported.
    if roots.len() > 1 && ends.complete && cycles == 0 {
        let names = listed(roots.iter().map(|root| draft.links[*root].subject()));
        let subject = draft.links[roots[1]].subject();
        let place = Place { at: draft.links[roots[1]].at, subject: &subject, field: "parent" };
        let found = format!("{} roots (links without a parent): {names}", roots.len());
        log.error(place, Code::SeveralRoots, found, format!("one root{}", passed_over(draft)));
    }
    roots.first().copied()
}
