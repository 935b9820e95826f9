//! Every function of the table, in each of its ways, is what the textbook says. What the textbook's functions are to each
//! other, and with that those of the library, is held in [`super::textbook`].

use articulated_core::Scalar;
use articulated_core::algorithm::{Argument, Function, FunctionId, Needs, Workspace, functions};
use articulated_core::joint::{Angle, Joint};
use articulated_core::model::pass::model_passes;
use articulated_core::model::{Body, Model, Rates, Unturned};
use articulated_core::spatial::{Matrix3, Reference, SpatialInertia, Vector3, to_z_axis};
use articulated_reference::Big;
use articulated_test_support::case::{Case, State, cast, for_each_tree};
use articulated_test_support::random_tree::Flavour;
use num_traits::Zero;

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
    let bound = case.model.frames.iter().any(|f| case.model.freedoms_of(f.body).len() < 6);
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
    assert_eq!(model.nv, case.model.nv);
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
        let tip = [&case.model.frames.last().expect("it has links").name];
        let (model, book) =
            (case.model.clone().with_frames(&tip).expect("its own"), case.textbook::<Big>().with_frames(&tip).expect("its own"));
        let (model, q) = (model.cast::<Big>(), cast::<Big>(&state.q));
        let row = FunctionId::operational_space_inertia.row::<Big>();
        let expected = book.call(row.name, &[&q]).expect("the textbook has it").expect("as many numbers");
        assert!(difference(&run(row, 0, &model, &[&q]), &expected) <= SOLVED);
    });
}

#[test]
fn model_passes_change_no_function_that_allows_them() {
    for_each_tree(6, SMALL, |case, random| {
        let state = case.state(random);
        Big::scope(|| {
            // In many digits, so that passes that only nearly keep the physics show.
            let model = case.model.cast::<Big>();
            let passed = model_passes::<Big>().iter().fold(model.clone(), |m, (_, pass, _)| pass(m));
            each(case, &model, &state, |row, given| {
                if row.regrouped {
                    let off = difference(&run(row, 0, &passed, given), &run(row, 0, &model, given));
                    assert!(off <= near(row), "{}: off by {off:e}", row.name);
                }
            });
        });
    });
}

/// Holds what asks for torques alone, in all ways, on one model to what it is on another.
fn same_without_frames(case: &Case, state: &State, one: &Model<Big>, other: &Model<Big>) {
    each(case, other, state, |row, given| {
        if row.regrouped && !row.asks_for_frames() {
            for k in (0..row.ways.len()).filter(|&k| (row.ways[k].applies)(other)) {
                let off = difference(&run(row, k, one, given), &run(row, k, other, given));
                assert!(off <= near(row), "{} {}: off by {off:e}", row.name, row.ways[k].name);
            }
        }
    });
}

/// A robot's last bodies made round, and nobody asking for its frames: they stop turning, which changes nothing.
#[test]
fn round_bodies_need_not_turn() {
    let seen = std::cell::Cell::new(0);
    for_each_tree(12, SMALL, |case, random| {
        let state = case.state(random);
        let mut model = case.model.clone();
        let last = |model: &Model, i: usize| {
            model.outward().all(|k| model.bodies[k].parent != i) && model.bodies[i].joint.is_rotation_about_axis()
        };
        let round: Vec<usize> = model.outward().filter(|&i| last(&model, i)).collect();
        for &i in &round {
            let SpatialInertia { first, second, .. } = &mut model.bodies[i].inertia;
            (first.x, first.y) = (0.0, 0.0);
            *second = Matrix3::from_diagonal(&Vector3::new(second.m11, second.m11, second.m33));
        }
        model.frames.clear();
        seen.set(seen.get() + round.len());
        Big::scope(|| {
            let model = model.cast::<Big>();
            let passed = model_passes::<Big>().iter().fold(model.clone(), |m, (_, pass, _)| pass(m));
            let stopped: Vec<usize> = passed.outward().filter(|&i| passed.bodies[i].coordinates.turns.to_f64() == 0.0).collect();
            assert_eq!(stopped, round);
            same_without_frames(case, &state, &passed, &model);
        });
    });
    assert!(seen.get() > 10, "only {} round bodies", seen.get());
}

/// Rows of parallel joints, with other bodies before, between and behind them, in the axes in which they begin; and last bodies in those of their joints.
#[test]
fn constants_may_be_turned_instead_of_vectors() {
    let (seen, kinds) = (std::cell::Cell::new(0), std::cell::RefCell::new(Vec::new()));
    for_each_tree(16, Flavour { links: 9, ..SMALL }, |case, random| {
        let state = case.state(random);
        let mut model = case.model.clone();
        for i in model.outward() {
            let (body, parent) = (&model.bodies[i], &model.bodies[model.bodies[i].parent]);
            let revolute = body.joint.is_rotation_about_axis() && parent.joint.is_rotation_about_axis();
            // What a universal joint consists of has no mass between.
            if body.parent != 0 && revolute && parent.link.is_some() && random.below(3) > 0 {
                model.bodies[i].placement.rotation = Matrix3::identity();
                seen.set(seen.get() + 1);
            }
        }
        Big::scope(|| {
            let model = model.cast::<Big>();
            let passed = model_passes::<Big>().iter().fold(Model { frames: Vec::new(), ..model.clone() }, |m, (_, pass, _)| pass(m));
            for which in model.unturnable() {
                let [plain, passed] = [&model, &passed].map(|m| m.unturned(&cast::<Big>(&state.q), which));
                same_without_frames(case, &state, &plain, &model);
                same_without_frames(case, &state, &passed, &model);
                kinds.borrow_mut().push(which);
            }
        });
    });
    let of = |which| kinds.borrow().iter().filter(|k| **k == which).count();
    let counts = (seen.get(), of(Unturned::Parallel), of(Unturned::ParallelAndLast));
    assert!(counts.0 > 12 && counts.1 > 5 && counts.2 > 5, "only {counts:?}");
}

/// The second derivative of a joint's axis tells as much as ω̇: no function is another, with the diagonal of U by it or not, whatever kinds of joints stand before and behind.
#[test]
fn rates_may_be_found_by_the_axes_of_joints() {
    const AXES: [[f64; 3]; 6] = [[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, -1.0, 0.0], [-1.0, 0.0, 0.0]];
    let seen = std::cell::RefCell::new(Vec::new());
    for_each_tree(24, Flavour { links: 9, ..SMALL }, |case, random| {
        let state = case.state(random);
        Big::scope(|| {
            let mut model = case.model.cast::<Big>();
            // Mostly axes along axes, turned about themselves by any angle, and bodies with some of their products of inertia.
            for i in model.outward() {
                // What a universal joint consists of has no mass between: its axes stay as they are.
                if random.below(4) == 0 || model.bodies[model.bodies[i].parent].link.is_none() {
                    continue;
                }
                let body = &mut model.bodies[i];
                let (sin, cos) = Big::from_f64(random.below(3) as f64).sin_cos();
                body.placement.rotation = to_z_axis(AXES[random.below(6)]).map(Big::from_f64) * Angle { sin, cos }.rotation();
                for (row, column) in [(0, 1), (0, 2), (1, 2)].into_iter().filter(|_| random.below(2) == 0) {
                    (body.inertia.second[(row, column)], body.inertia.second[(column, row)]) = (Big::zero(), Big::zero());
                }
            }
            let by_axes = model.clone().with_rates_by_axes();
            seen.borrow_mut().extend(by_axes.bodies.iter().skip(1).map(|body| body.rates));
            each(case, &model, &state, |row, given| {
                let off = difference(&run(row, 0, &by_axes, given), &run(row, 0, &model, given));
                assert!(off <= near(row), "{}: off by {off:e}", row.name);
            });
        });
    });
    let counts =
        [Rates::Angular, Rates::Axis, Rates::AxisAndDiagonal].map(|rates| seen.borrow().iter().filter(|one| **one == rates).count());
    assert!(counts.iter().all(|count| *count > 20), "only {counts:?}");
}

/// A mass at a joint may be in the body on either side, and inverse dynamics have other inertias than mass matrices: no torque, energy or acceleration is another, in whatever unit and axes.
#[test]
fn mass_at_a_joint_may_be_lent() {
    let lent = std::cell::Cell::new(0);
    for_each_tree(24, Flavour { links: 9, ..SMALL }, |case, random| {
        let state = case.state(random);
        let mut model = case.model.clone();
        // Mostly a chain.
        for i in model.outward().filter(|_| random.below(4) > 0) {
            model.bodies[i].parent = i - 1;
        }
        Big::scope(|| {
            let model = model.cast::<Big>();
            let passed = model_passes::<Big>().iter().fold(Model { frames: Vec::new(), ..model.clone() }, |m, (_, pass, _)| pass(m));
            let lending = passed.lent(&model.carried());
            let has_some =
                |body: &&Body<Big>| body.joint.is_rotation_about_axis() && body.lent.as_ref().is_some_and(|i| i.mass.to_f64() != 0.0);
            lent.set(lent.get() + lending.bodies.iter().filter(has_some).count());
            same_without_frames(case, &state, &lending, &model);
            if passed.only_turns() {
                same_without_frames(case, &state, &lending.in_unit_of(Big::from_f64(0.3)), &model);
            }
            for which in lending.unturnable() {
                same_without_frames(case, &state, &lending.unturned(&cast::<Big>(&state.q), which), &model);
            }
        });
    });
    assert!(lent.get() > 10, "only {} bodies were lent something", lent.get());
}

/// Where all joints turn, no result has a length in it: it is the same in every unit, before model passes and after, with frames that do not turn too.
#[test]
fn lengths_may_be_in_any_unit() {
    let (seen, unturned) = (std::cell::Cell::new(0), std::cell::Cell::new(0));
    for_each_tree(16, Flavour { floating: false, ..SMALL }, |case, random| {
        let state = case.state(random);
        let mut model = case.model.clone();
        for body in &mut model.bodies {
            if body.joint.nv() == 1 && body.joint.moves_origin() {
                (body.joint, body.coordinates.pitch) = (Joint::Revolute, 0.0);
            }
        }
        if !model.only_turns() {
            return;
        }
        let units = model.units();
        Big::scope(|| {
            let model = model.cast::<Big>();
            let passed = model_passes::<Big>().iter().fold(Model { frames: Vec::new(), ..model.clone() }, |m, (_, pass, _)| pass(m));
            // Among levers, gravity, moments and masses, and one that is none of them.
            for metres in units.iter().step_by(1 + units.len() / 3).copied().chain([0.3]) {
                let [plain, passed] = [&model, &passed].map(|m| m.in_unit_of(Big::from_f64(metres)));
                same_without_frames(case, &state, &plain, &model);
                same_without_frames(case, &state, &passed, &model);
                for which in passed.unturnable() {
                    same_without_frames(case, &state, &passed.unturned(&cast::<Big>(&state.q), which), &model);
                    unturned.set(unturned.get() + 1);
                }
                seen.set(seen.get() + 1);
            }
        });
    });
    assert!(seen.get() > 30 && unturned.get() > 20, "only {} and {} unturned", seen.get(), unturned.get());
}

/// In a unit in which a constant is one, it is.
#[test]
fn units_are_where_a_constant_is_one() {
    let mut seen = 0;
    for robot in ["ur5_like", "panda_like", "double_pendulum"] {
        let model = Case::bundled(articulated_models::robot(robot).expect("bundled")).model;
        for metres in model.units() {
            let scaled = model.in_unit_of(metres);
            let constants = scaled.outward().map(|i| &scaled.bodies[i]).flat_map(|body| {
                let (p, h) = (body.placement.position, body.inertia.first);
                [p.x, p.y, p.z, h.x, h.y, h.z, body.inertia.mass]
            });
            let gravity = [scaled.gravity.x, scaled.gravity.y, scaled.gravity.z];
            assert!(constants.chain(gravity).any(|x| (x.abs() - 1.0).abs() < 1e-15), "{robot}: nothing is one in {metres} m");
            seen += 1;
        }
    }
    assert!(seen > 20, "{seen}");
}
