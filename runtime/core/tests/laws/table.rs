//! Every function of the table, in each of its ways, agrees with the textbook. Relations between
//! the textbook's functions, and so between those of the library, are checked in
//! [`super::textbook`].

use articulated_core::Scalar;
use articulated_core::algorithm::{Argument, Function, FunctionId, Workspace, functions};
use articulated_core::model::Model;
use articulated_core::spatial::Reference;
use articulated_reference::Big;
use articulated_test_support::case::{Case, cast};
use articulated_test_support::every_function::{difference, for_each_function, tolerance};
use articulated_test_support::random_tree::Flavour;

use crate::trees::for_each_tree;

const SMALL: Flavour = Flavour { links: 7, ..Flavour::REGULAR };

fn run(row: &Function<Big>, way: usize, model: &Model<Big>, given: &[&[Big]]) -> Vec<Big> {
    let mut out = vec![Big::from_f64(f64::NAN); row.len(model.shape())];
    row.call_by(&row.ways[way], model, &mut Workspace::new(model), given, &mut out).expect("arguments of the right lengths");
    out
}

#[test]
fn every_function_in_every_way_is_the_textbooks() {
    let seen = std::cell::RefCell::new(std::collections::BTreeSet::new());
    let references = [Reference::Body, Reference::World, Reference::WorldAligned];
    for (reference, bent) in references.into_iter().flat_map(|reference| [(reference, false), (reference, true)]) {
        for_each_tree(8, Flavour { bent, ..SMALL }, |case, random| {
            let state = case.state(random);
            Big::scope(|| {
                let model = case.model.clone().with_wrenches_in(reference).cast::<Big>();
                let book = case.textbook::<Big>().with_wrenches_in(reference);
                for_each_function(case, &model, &state, |row, given| {
                    // Other functions do not depend on the reference: once is enough.
                    if reference != Reference::Body && !row.takes.contains(&Argument::Wrenches) {
                        return;
                    }
                    let expected = book.call(row.name, given).expect("the textbook has every function").expect("as many numbers");
                    for (k, way) in row.ways.iter().enumerate().filter(|(_, way)| (way.applies)(&model)) {
                        let off = difference(&run(row, k, &model, given), &expected);
                        assert!(off <= tolerance(row), "{} {}, wrenches in {reference:?}: off by {off:e}", row.name, way.name);
                        seen.borrow_mut().insert((row.name, k));
                    }
                });
            });
        });
    }
    // All were tested, except those that such trees do not have.
    let all = functions::<Big>().iter().flat_map(|row| (0..row.ways.len()).map(|k| (row.name, k)));
    let missing: Vec<_> = all.filter(|f| !seen.borrow().contains(f)).collect();
    assert!(missing.iter().all(|(name, _)| *name == FunctionId::operational_space_inertia.name()), "not seen: {missing:?}");
}

#[test]
fn operational_space_inertia_of_a_free_robot_is_the_textbooks() {
    let robot = articulated_models::robot("quadruped").expect("it is bundled");
    let case = Case::bundled(robot);
    let state = case.state(&mut articulated_test_support::random::Random::new(5));
    Big::scope(|| {
        let tip = [&case.model.frames().last().expect("it has links").name];
        let (model, book) =
            (case.model.clone().with_frames(&tip).expect("its own"), case.textbook::<Big>().with_frames(&tip).expect("its own"));
        let (model, q) = (model.cast::<Big>(), cast::<Big>(&state.q));
        let row = FunctionId::operational_space_inertia.row::<Big>();
        let expected = book.call(row.name, &[&q]).expect("the textbook has it").expect("as many numbers");
        assert!(difference(&run(row, 0, &model, &[&q]), &expected) <= tolerance(row));
    });
}
