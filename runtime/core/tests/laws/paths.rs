//! Paths over points of bodies: spatial tendons.

use articulated_core::actuator::{SiteFrame, Strand, path_at};
use articulated_core::algorithm::Workspace;
use articulated_core::description::Base;
use articulated_core::index::BodyId;
use articulated_core::spatial::Placement;
use articulated_test_support::case::{Case, for_each_tree};
use articulated_test_support::random::Random;
use articulated_test_support::random_tree::{Flavour, random_tree};

/// Two strands over random points of random bodies, the base among them.
fn path(case: &Case, random: &mut Random) -> Vec<Strand> {
    let mut point = || SiteFrame {
        body: BodyId(random.below(case.model.bodies().len())),
        placement: Placement { position: random.three(1.0).into(), ..Placement::identity() },
    };
    [1.0, 0.4].map(|factor| Strand { points: (0..4).map(|_| point()).collect(), factor }).into()
}

/// ∂l/∂q is the change of the length along each degree of freedom.
#[test]
fn the_row_of_a_path_is_the_derivative_of_its_length() {
    for_each_tree(20, Flavour::WRITTEN, |case, random| {
        let (model, path) = (&case.model, path(case, random));
        let state = case.state(random);
        let (_, row) = path_at(model, &mut Workspace::new(model), &state.q, &path);
        for k in 0..model.nv() {
            let length = |h: f64| {
                let mut step = vec![0.0; model.nv()];
                step[k] = h;
                path_at(model, &mut Workspace::new(model), &case.call("integrate", &[&state.q, &step]), &path).0
            };
            let slope = (length(1e-6) - length(-1e-6)) / 2e-6;
            let entry: f64 = row.iter().filter(|(own, _)| *own == k).map(|(_, entry)| *entry).sum();
            assert!((entry - slope).abs() < 1e-8 * (1.0 + slope.abs()), "{}, {k}: {entry} and {slope}", case.name);
        }
    });
}

/// Points in one place have no direction: their length is zero, and entries are finite.
#[test]
fn points_in_one_place_have_a_length_of_zero() {
    let case = Case::new("tree", random_tree(3, Flavour::WRITTEN), Base::Floating);
    let q = case.model.neutral();
    let same = |body| SiteFrame { body, placement: Placement::identity() };
    let path = [Strand { points: vec![same(BodyId(1)), same(BodyId(1))], factor: 1.0 }];
    assert_eq!(path_at(&case.model, &mut Workspace::new(&case.model), &q, &path), (0.0, Vec::new()));
}
