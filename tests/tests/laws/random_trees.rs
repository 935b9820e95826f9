//! The random trees themselves: they contain all intended cases, and the reader returns them
//! unchanged.

use articulated_core::description::{JointDynamics, JointKind};
use articulated_tests::case::{for_each_tree, read};
use articulated_tests::random_tree::{Flavour, random_tree};
use articulated_tests::urdf_text;

#[test]
fn a_description_written_as_a_urdf_is_read_as_it_was() {
    for_each_tree(100, Flavour::WRITTEN, |case, _| {
        let text = urdf_text(&case.description);
        let mut found = read(&text);
        // Axes of joints without one, and limits of joints without any, are not written.
        found.joints.iter_mut().for_each(|j| j.dynamics = JointDynamics::default());
        assert_eq!(found, case.description, "{text}");
    });
}

#[test]
fn every_kind_of_thing_occurs() {
    let trees: Vec<_> = (0..120).map(|seed| random_tree(seed, Flavour::ANY)).collect();
    let joints = || trees.iter().flat_map(|t| &t.joints);
    for &kind in JointKind::ALL {
        assert!(joints().any(|j| j.kind == kind && j.locked.is_none()), "{kind:?}");
        assert!(kind.is_fixed() || joints().any(|j| j.kind == kind && j.locked.is_some()), "{kind:?}, locked");
    }
    assert!(
        trees.iter().any(|t| t.joints.iter().any(|j| j.mimic.is_some_and(|m| t.joints[m.joint].locked.is_some()))),
        "who follows a locked joint"
    );
    assert!(joints().any(|j| j.mimic.is_some_and(|m| m.offset != 0.0)));
    assert!(
        trees.iter().any(|t| t.joints.iter().any(|j| j.mimic.is_some_and(|m| t.joints[m.joint].mimic.is_some()))),
        "a chain of followers"
    );
    assert!(trees.iter().any(|t| t.links.len() == 1) && trees.iter().any(|t| t.links.len() == 12));
    assert!(
        trees.iter().any(|t| t.joints.iter().enumerate().any(|(k, j)| t.joints.iter().take(k).any(|i| i.parent == j.child))),
        "a child listed before its parent"
    );
    assert!(trees.iter().flat_map(|t| &t.links).any(|l| l.inertial.is_none()));
}

#[test]
fn a_seed_is_a_tree() {
    assert_eq!(random_tree(7, Flavour::ANY), random_tree(7, Flavour::ANY));
    assert_ne!(random_tree(7, Flavour::ANY), random_tree(8, Flavour::ANY));
}
