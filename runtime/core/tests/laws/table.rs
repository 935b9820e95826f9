//! Every function of the table, in each of its ways, is what the textbook says. What the textbook's functions are to each
//! other, and with that those of the library, is held in [`super::textbook`].

use articulated_core::Scalar;
use articulated_core::algorithm::{Argument, Function, FunctionId, Needs, Workspace, functions};
use articulated_core::model::Model;
use articulated_core::spatial::Reference;
use articulated_reference::Big;
use articulated_test_support::case::{Case, State, cast, for_each_tree};
use articulated_test_support::random_tree::Flavour;

/// What the library's constants allow, which are double precision however the rest is computed. Seen: 2·10⁻¹⁵.
const NEAR: f64 = 2e-14;

/// The same for what is solved with the mass matrix, whose condition number comes in. Seen: 9·10⁻¹⁵.
const SOLVED: f64 = 2e-13;

fn near(row: &Function<Big>) -> f64 {
    if row.inverts_mass_matrix() { SOLVED } else { NEAR }
}

const SMALL: Flavour = Flavour { links: 7, ..Flavour::REGULAR };

/// The largest difference, relative to the largest entry or to one.
fn difference(found: &[Big], expected: &[Big]) -> f64 {
    assert_eq!(found.len(), expected.len());
    let largest = expected.iter().map(|e| e.to_f64().abs()).fold(1.0, f64::max);
    let one = |(f, e): (&Big, &Big)| (*f - *e).to_f64().abs() / largest;
    found.iter().zip(expected).map(one).fold(0.0, |worst, d| if d <= worst { worst } else { d })
}

/// Each function that the model has, with its arguments.
fn each(case: &Case, model: &Model<Big>, state: &State, mut visit: impl FnMut(&'static Function<Big>, &[&[Big]])) {
    let arguments: Vec<(Argument, Vec<Big>)> = Argument::ALL.iter().map(|&a| (a, cast(state.argument(a)))).collect();
    let bound = case.model.frames().iter().any(|f| case.model.freedoms_of(f.body).len() < 6);
    let has = |f: &Function<Big>| match f.needs {
        Needs::FreeFrames => !bound,
        Needs::Mass => case.model.moving_mass() > 0.0,
        Needs::Nothing | Needs::MassMatrix => true,
    };
    for row in functions::<Big>().iter().filter(|f| has(f)) {
        let given = |a: &Argument| arguments.iter().find(|(b, _)| a == b).map(|(_, x)| x.as_slice());
        let given: Vec<&[Big]> = row.takes.iter().filter_map(given).collect();
        visit(row, &given);
    }
    assert_eq!(model.nv(), case.model.nv());
}

fn run(row: &Function<Big>, way: usize, model: &Model<Big>, given: &[&[Big]]) -> Vec<Big> {
    let mut out = vec![Big::from_f64(f64::NAN); row.len(model.shape())];
    row.call_by(&row.ways[way], model, &mut Workspace::new(model), given, &mut out).expect("arguments of the right lengths");
    out
}

#[test]
fn every_function_in_every_way_is_the_textbooks() {
    let seen = std::cell::RefCell::new(std::collections::BTreeSet::new());
    for reference in [Reference::Body, Reference::World, Reference::WorldAligned] {
        for_each_tree(8, SMALL, |case, random| {
            let state = case.state(random);
            Big::scope(|| {
                let model = case.model.clone().with_wrenches_in(reference).cast::<Big>();
                let book = case.textbook::<Big>().with_wrenches_in(reference);
                each(case, &model, &state, |row, given| {
                    let expected = book.call(row.name, given).expect("the textbook has every function").expect("as many numbers");
                    for (k, way) in row.ways.iter().enumerate().filter(|(_, way)| (way.applies)(&model)) {
                        let off = difference(&run(row, k, &model, given), &expected);
                        assert!(off <= near(row), "{} {}, wrenches in {reference:?}: off by {off:e}", row.name, way.name);
                        seen.borrow_mut().insert((row.name, k));
                    }
                });
            });
        });
    }
    // None was left out, but for what no such tree has.
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
        assert!(difference(&run(row, 0, &model, &[&q]), &expected) <= SOLVED);
    });
}
