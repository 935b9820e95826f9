//! Model passes keep the physics: every function that allows them is the same on a view after them,
//! in 96 digits where it matters.

use articulated_codegen::model_pass::{FoldedRotations, ModelPass, View, model_passes, no_joint_moves_origin};
use articulated_core::Scalar;
use articulated_core::algorithm::{AngularKinematics, Function, function, functions};
use articulated_core::description::{self, Base, Description, Inertial, JointKind, Link, LinkId, Origin};
use articulated_core::effect::{Applied, EffectId};
use articulated_core::index::{BodyId, ById};
use articulated_core::joint::{Angle, Joint};
use articulated_core::model::{Body, Model};
use articulated_core::monitor::orthonormality;
use articulated_core::spatial::{Matrix3, SpatialInertia, Vector3, to_z_axis};
use articulated_reference::Big;
use articulated_test_support::case::{Case, State, cast, for_each_bundled, for_each_tree, placements};
use articulated_test_support::every_function::{difference, for_each_function, tolerance};
use articulated_test_support::measure::{U, distance, scale, torque_scale};
use articulated_test_support::random::Random;
use articulated_test_support::random_effects::random_effects;
use articulated_test_support::random_tree::Flavour;
use num_traits::Zero;

/// Errors allowed, in units of u times the magnitude of the terms.
const FEW: f64 = 16.0;

const SMALL: Flavour = Flavour { links: 7, ..Flavour::REGULAR };

/// A view without frames.
fn bare<S: Scalar>(model: &Model<S>) -> View<S> {
    View::new(model.clone().without_frames())
}

/// One function of the table, by the first way that applies.
fn call(view: &View<f64>, name: &str, arguments: &[&[f64]]) -> Vec<f64> {
    let function = function::<f64>(name).expect("in the table");
    let mut out = vec![0.0; function.len(view.model.shape())];
    function.call(&view.model, &mut view.workspace(), arguments, &mut out).expect("lengths as the table says");
    out
}

fn run(row: &Function<Big>, way: usize, view: &View<Big>, given: &[&[Big]]) -> Vec<Big> {
    let mut out = vec![Big::from_f64(f64::NAN); row.len(view.model.shape())];
    view.call_by(row, &row.ways[way], given, &mut out).expect("arguments of the right lengths");
    out
}

#[test]
fn model_passes_change_no_function_that_allows_them() {
    for_each_tree(6, SMALL, |case, random| {
        let state = case.state(random);
        Big::scope(|| {
            // In many digits, so that passes that only nearly keep the physics show.
            let model = case.model.cast::<Big>();
            let passed = View::new(model.clone()).passed();
            for_each_function(case, &model, &state, |row, given| {
                if row.regrouped {
                    let off = difference(&run(row, 0, &passed, given), &run(row, 0, &View::new(model.clone()), given));
                    assert!(off <= tolerance(row), "{}: off by {off:e}", row.name);
                }
            });
        });
    });
}

/// Compares the functions that need torques only, in all ways, on a view and on a model.
fn same_without_frames(case: &Case, state: &State, one: &View<Big>, other: &Model<Big>) {
    let plain = View::new(other.clone());
    for_each_function(case, other, state, |row, given| {
        if row.regrouped && !row.asks_for_frames() {
            for k in (0..row.ways.len()).filter(|&k| (row.ways[k].applies)(other)) {
                let off = difference(&run(row, k, one, given), &run(row, k, &plain, given));
                assert!(off <= tolerance(row), "{} {}: off by {off:e}", row.name, row.ways[k].name);
            }
        }
    });
}

/// The last bodies of a robot are axisymmetric and no frame is requested: their frames stop
/// rotating, and no result changes.
#[test]
fn round_bodies_need_not_turn() {
    let seen = std::cell::Cell::new(0);
    for_each_tree(12, SMALL, |case, random| {
        let state = case.state(random);
        let model = case.model.clone();
        let last = |model: &Model, i: BodyId| {
            model.outward().all(|k| model.bodies()[k].parent != i) && model.bodies()[i].joint.is_rotation_about_axis()
        };
        let round: Vec<BodyId> = model.outward().filter(|&i| last(&model, i)).collect();
        let model = model.without_frames().changed(|parts| {
            for &i in &round {
                let SpatialInertia { first, second, .. } = &mut parts.bodies[i].inertia;
                (first.x, first.y) = (0.0, 0.0);
                *second = Matrix3::from_diagonal(&Vector3::new(second.m11, second.m11, second.m33));
            }
        });
        seen.set(seen.get() + round.len());
        Big::scope(|| {
            let model = model.cast::<Big>();
            let passed = View::new(model.clone()).passed();
            let stopped: Vec<BodyId> = model.outward().filter(|&i| !passed.rotates(i)).collect();
            assert_eq!(stopped, round);
            same_without_frames(case, &state, &passed, &model);
        });
    });
    assert!(seen.get() > 10, "only {} round bodies", seen.get());
}

/// Rows of parallel joints, with other bodies before, between and behind them, in the axes in which
/// they begin; and last bodies in those of their joints.
#[test]
fn constants_may_be_turned_instead_of_vectors() {
    let (seen, kinds) = (std::cell::Cell::new(0), std::cell::RefCell::new(Vec::new()));
    for_each_tree(16, Flavour { links: 9, ..SMALL }, |case, random| {
        let state = case.state(random);
        let model = case.model.clone().changed(|parts| {
            for i in parts.bodies.ids().skip(1) {
                let (body, parent) = (&parts.bodies[i], &parts.bodies[parts.bodies[i].parent]);
                let revolute = body.joint.is_rotation_about_axis() && parent.joint.is_rotation_about_axis();
                // The parts of a universal joint have no mass between them.
                if !body.parent.is_base() && revolute && parent.link.is_some() && random.below(3) > 0 {
                    parts.bodies[i].placement.rotation = Matrix3::identity();
                    seen.set(seen.get() + 1);
                }
            }
        });
        Big::scope(|| {
            let model = model.cast::<Big>();
            let passed = bare(&model).passed();
            let plain = View::new(model.clone());
            for which in plain.foldable_rotations() {
                let [plain, passed] = [&plain, &passed].map(|view| view.fold_rotations_into_constants(&cast::<Big>(&state.q), which));
                same_without_frames(case, &state, &plain, &model);
                same_without_frames(case, &state, &passed, &model);
                kinds.borrow_mut().push(which);
            }
        });
    });
    let of = |which| kinds.borrow().iter().filter(|k| **k == which).count();
    let counts = (seen.get(), of(FoldedRotations::Parallel), of(FoldedRotations::ParallelAndLast));
    assert!(counts.0 > 12 && counts.1 > 5 && counts.2 > 5, "only {counts:?}");
}

/// The second derivative of a joint's axis can replace ω̇: no function changes, with the diagonal
/// of U by it or not, for all kinds of joints before and after.
#[test]
fn rates_may_be_found_by_the_axes_of_joints() {
    const AXES: [[f64; 3]; 6] = [[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, -1.0, 0.0], [-1.0, 0.0, 0.0]];
    let seen = std::cell::RefCell::new(Vec::new());
    for_each_tree(24, Flavour { links: 9, ..SMALL }, |case, random| {
        let state = case.state(random);
        Big::scope(|| {
            // Mostly axes along axes, turned about themselves by any angle, and bodies with some of
            // their products of inertia.
            let model = case.model.cast::<Big>().changed(|parts| {
                for i in parts.bodies.ids().skip(1) {
                    // The parts of a universal joint have no mass between them: its axes stay as
                    // they are.
                    if random.below(4) == 0 || parts.bodies[parts.bodies[i].parent].link.is_none() {
                        continue;
                    }
                    let body = &mut parts.bodies[i];
                    let (sin, cos) = Big::from_f64(random.below(3) as f64).sin_cos();
                    body.placement.rotation = to_z_axis(AXES[random.below(6)]).map(Big::from_f64) * Angle { sin, cos }.rotation();
                    for (row, column) in [(0, 1), (0, 2), (1, 2)].into_iter().filter(|_| random.below(2) == 0) {
                        (body.inertia.second[(row, column)], body.inertia.second[(column, row)]) = (Big::zero(), Big::zero());
                    }
                }
            });
            let plain = View::new(model.clone());
            let by_axes = plain.clone().with_axis_accelerations();
            seen.borrow_mut().extend(by_axes.formulation.kinematics.iter().skip(1).copied());
            for_each_function(case, &model, &state, |row, given| {
                let off = difference(&run(row, 0, &by_axes, given), &run(row, 0, &plain, given));
                assert!(off <= tolerance(row), "{}: off by {off:e}", row.name);
            });
        });
    });
    use AngularKinematics::{AngularAcceleration, AxisAcceleration, AxisAccelerationAndDiagonal};
    let count = |kinematics| seen.borrow().iter().filter(|one| **one == kinematics).count();
    let counts = [AngularAcceleration, AxisAcceleration, AxisAccelerationAndDiagonal].map(count);
    assert!(counts.iter().all(|count| *count > 20), "only {counts:?}");
}

/// A mass at a joint may be in the body on either side, and inverse dynamics may have other
/// inertias than mass matrices: torques, energies and accelerations are the same, in any unit and
/// axes.
#[test]
fn mass_at_a_joint_may_be_shifted() {
    let lent = std::cell::Cell::new(0);
    for_each_tree(24, Flavour { links: 9, ..SMALL }, |case, random| {
        let state = case.state(random);
        // Mostly a chain.
        let model = case.model.clone().changed(|parts| {
            for i in parts.bodies.ids().skip(1).filter(|_| random.below(4) > 0) {
                parts.bodies[i].parent = BodyId(i.0 - 1);
            }
        });
        Big::scope(|| {
            let model = model.cast::<Big>();
            let passed = bare(&model).passed();
            let shifted = passed.clone().with_shifted_masses(&model.carried());
            let has_some =
                |(body, inertia): &(&Body<Big>, &SpatialInertia<Big>)| body.joint.is_rotation_about_axis() && inertia.mass.to_f64() != 0.0;
            let bodies = shifted.model.bodies().iter().zip(&shifted.formulation.torque_inertias);
            lent.set(lent.get() + bodies.filter(has_some).count());
            same_without_frames(case, &state, &shifted, &model);
            if no_joint_moves_origin(&passed.model) {
                same_without_frames(case, &state, &shifted.in_unit_of(Big::from_f64(0.3)), &model);
            }
            for which in shifted.foldable_rotations() {
                same_without_frames(case, &state, &shifted.fold_rotations_into_constants(&cast::<Big>(&state.q), which), &model);
            }
        });
    });
    assert!(lent.get() > 10, "only {} bodies were given mass", lent.get());
}

/// Where all joints turn, no result has a length in it: it is the same in every unit, before model
/// passes and after, with frames that do not turn too.
#[test]
fn lengths_may_be_in_any_unit() {
    let (seen, unturned) = (std::cell::Cell::new(0), std::cell::Cell::new(0));
    for_each_tree(16, Flavour { floating: false, ..SMALL }, |case, random| {
        let state = case.state(random);
        let model = case.model.clone().changed(|parts| {
            for body in &mut parts.bodies {
                if body.joint.nv() == 1 && body.joint.moves_origin() {
                    (body.joint, body.coordinates.pitch) = (Joint::Revolute, 0.0);
                }
            }
        });
        if !no_joint_moves_origin(&model) {
            return;
        }
        let units = View::new(model.clone()).units();
        Big::scope(|| {
            let model = model.cast::<Big>();
            let passed = bare(&model).passed();
            // Among levers, gravity, moments and masses, and one unit that is not among them.
            for metres in units.iter().step_by(1 + units.len() / 3).copied().chain([0.3]) {
                let [plain, passed] = [&View::new(model.clone()), &passed].map(|view| view.in_unit_of(Big::from_f64(metres)));
                same_without_frames(case, &state, &plain, &model);
                same_without_frames(case, &state, &passed, &model);
                for which in passed.foldable_rotations() {
                    same_without_frames(case, &state, &passed.fold_rotations_into_constants(&cast::<Big>(&state.q), which), &model);
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
        let view = View::new(Case::bundled(articulated_models::robot(robot).expect("bundled")).model);
        for metres in view.units() {
            let scaled = view.in_unit_of(metres).model;
            let constants = scaled.outward().map(|i| &scaled.bodies()[i]).flat_map(|body| {
                let (p, h) = (body.placement.position, body.inertia.first);
                [p.x, p.y, p.z, h.x, h.y, h.z, body.inertia.mass]
            });
            let gravity = [scaled.gravity().x, scaled.gravity().y, scaled.gravity().z];
            assert!(constants.chain(gravity).any(|x| (x.abs() - 1.0).abs() < 1e-15), "{robot}: nothing is one in {metres} m");
            seen += 1;
        }
    }
    assert!(seen > 20, "{seen}");
}

fn passes_keep_the_physics(case: &Case, random: &mut Random) {
    let state = case.state(random);
    let torques = torque_scale(case, &state);
    for (name, pass, _) in model_passes::<f64>() {
        let passed = pass(View::new(case.model.clone()));
        let far = distance(&call(&passed, "inverse_dynamics", &[&state.q, &state.v, &state.a]), &case.inverse_dynamics(&state), &torques);
        assert!(far <= FEW, "{name}: {far} units of roundoff");
        let far =
            distance(&call(&passed, "placements", &[&state.q]), &placements(&case.model, &state.q), &scale(case, "placements", &state));
        assert!(far <= FEW, "{name}: placements: {far} units of roundoff");
    }
}

#[test]
fn model_passes_leave_torques_and_placements_as_they_are() {
    for_each_tree(150, Flavour::ANY, passes_keep_the_physics);
    for_each_bundled(passes_keep_the_physics);
}

/// A column that is too long by ε makes every lever that it turns too long, and moments of inertia
/// by 2ε: those of several bodies add up.
#[test]
fn rotations_of_models_are_rotations_to_rounding_before_and_after_passes() {
    for_each_tree(150, Flavour::WRITTEN, |case, _| {
        let mut view = View::new(case.model.clone());
        for (name, pass, _) in [("none", (|view| view) as ModelPass<f64>, "")].iter().chain(model_passes::<f64>()) {
            view = pass(view);
            for (body, rotation) in view.model.bodies().iter().zip(&view.formulation.rotations) {
                let [fixed, from] = [body.placement.rotation, rotation.offset.rotation()];
                let off = [fixed, from].map(|r| Big::scope(|| orthonormality(&r.map(Big::from_f64)).to_f64() / U));
                assert!(off.iter().all(|off| *off <= 3.0), "{}: {} after {name}: {off:?} units of roundoff", case.name, body.name);
            }
        }
    });
}

/// Base parameters: numbers that a joint cannot feel are zero.
#[test]
fn regrouped_bodies_keep_only_what_their_joint_feels() {
    for_each_tree(40, Flavour::ANY, |case, _| {
        let passed = View::new(case.model.clone()).passed();
        for body in passed.model.bodies().iter().skip(1) {
            let i = &body.inertia;
            match body.joint {
                Joint::Revolute => assert_eq!([i.mass, i.first.z, i.second.m33], [0.0; 3], "{}", body.name),
                Joint::Prismatic => assert_eq!(i.second.amax(), 0.0, "{}", body.name),
                Joint::Helical | Joint::Spherical | Joint::Floating => {}
            }
        }
    });
}

/// The axes of a shoulder of three joints meet: slid there, its joints have no offsets, and no
/// force must be shifted.
#[test]
fn frames_slide_to_where_axes_meet() {
    let case = Case::bundled(articulated_models::robot("panda_like").expect("it is bundled"));
    let slid = View::new(case.model.clone()).passed().model;
    let offset = |model: &articulated_core::model::Model, i: BodyId| model.bodies()[i].placement.position.amax();
    assert_eq!([2, 3].map(|i| offset(&slid, BodyId(i))), [0.0; 2]);
    assert!(offset(&case.model, BodyId(3)) > 0.3);
}

/// Mass is shifted where it takes numbers away, and never more than twice what a joint carries.
#[test]
fn mass_is_shifted_where_that_is_worth_it() {
    for (robot, joints) in [("ur5_like", 1), ("panda_like", 2), ("quadruped", 8)] {
        let model = Case::bundled(articulated_models::robot(robot).expect("it is bundled")).model;
        let carried = model.carried();
        assert!((carried[BodyId::BASE] - model.bodies().iter().map(|b| b.inertia.mass).sum::<f64>()).abs() < 1e-12);
        let passed = View::new(model.clone()).passed();
        let masses = |carried: &ById<BodyId, f64>| -> Vec<(f64, f64)> {
            let shifted = passed.clone().with_shifted_masses(carried);
            let bodies = shifted.model.bodies().iter().zip(&shifted.formulation.torque_inertias).zip(carried);
            bodies.filter(|((body, _), _)| !body.parent.is_base()).map(|((_, inertia), carried)| (inertia.mass, *carried)).collect()
        };
        let shifted = masses(&carried);
        assert_eq!(shifted.iter().filter(|(mass, _)| *mass != 0.0).count(), joints, "{robot}: {shifted:?}");
        assert!(shifted.iter().all(|(mass, carried)| mass.abs() <= 2.0 * carried), "{robot}: {shifted:?}");
        let of_next_to_nothing = masses(&carried.iter().map(|mass| 0.1 * mass).collect());
        assert!(of_next_to_nothing.iter().all(|(mass, _)| *mass == 0.0), "{robot}: {of_next_to_nothing:?}");
    }
}

/// A shoulder as files have it, its axis y and its frame pitched by nearly a right angle: the pitch
/// is counted with the joint's angle, and no rotation is left but a change of axes.
#[test]
fn angles_about_a_joints_own_axis_are_counted_with_its_own() {
    let fixed = |x: f64| x == 0.0 || x.abs() == 1.0;
    for_each_tree(40, Flavour::ANY, |case, _| {
        let passed = View::new(case.model.clone()).passed();
        for body in passed.model.bodies().iter().skip(1).filter(|b| !b.parent.is_base() && b.joint.is_rotation_about_axis()) {
            let turn = &body.placement.rotation;
            let along_a_coordinate_axis = turn.column(2).iter().all(|x| fixed(*x));
            assert!(!along_a_coordinate_axis || turn.iter().all(|x| fixed(*x)), "{}: {turn}", body.name);
        }
    });
}

#[test]
fn passes_keep_what_joints_feel() {
    for_each_tree(40, Flavour::REGULAR, |case, random| {
        let applied = random_effects(random, &case.model, |_| true);
        let plain = View::new(case.model.clone().with_effects(&applied).expect("effects that can be had"));
        let State { q, v, a, tau, .. } = case.state(random);
        let passed = plain.clone().passed();
        for function in functions::<f64>().iter().filter(|f| f.regrouped) {
            let arguments: &[&[f64]] = match function.name {
                "inverse_dynamics" | "inverse_dynamics_derivatives" => &[&q, &v, &a],
                "forward_dynamics" | "forward_dynamics_derivatives" => &[&q, &v, &tau],
                "mass_matrix" | "gravity_torque" => &[&q],
                "kinetic_energy" | "bias_forces" => &[&q, &v],
                _ => continue,
            };
            let [found, expected] = [&passed, &plain].map(|view| call(view, function.name, arguments));
            let scale = expected.iter().fold(1.0, |m: f64, x| m.max(x.abs()));
            assert!(
                found.iter().zip(&expected).all(|(a, b)| (a - b).abs() <= 1e-9 * scale),
                "{}: {found:?}, expected {expected:?}",
                function.name
            );
        }
    });
}

/// A wheel's frame need not turn with it, since it is the same from all sides; with a float on its
/// rim it is not.
#[test]
fn a_round_wheel_turns_the_float_on_its_rim() {
    let link = |name: &str, inertial: Option<Inertial>| Link { name: name.into(), inertial, ..Link::default() };
    let round = Inertial { origin: Origin::default(), mass: 2.0, inertia: [0.3, 0.0, 0.0, 0.3, 0.0, 0.3] };
    let joint = description::Joint {
        name: "axle".into(),
        kind: JointKind::Continuous,
        parent: LinkId(0),
        child: LinkId(1),
        axis: [0.0, 1.0, 0.0],
        ..description::Joint::default()
    };
    let description = Description {
        name: "wheel".into(),
        links: [link("base", None), link("wheel", Some(round))].into(),
        joints: [joint].into(),
        frames: Vec::new(),
    };
    let wheel = Model::new(&description, Base::Fixed).expect("a wheel").with_gravity([0.0, 0.0, -9.81]);
    // Without the frames of links, which are not needed here.
    assert!(!bare(&wheel).passed().rotates(BodyId(1)));
    let (volume, density, rim) = (0.002, 1000.0, 0.5);
    let at = Origin { xyz: [rim, 0.0, 0.0], ..Origin::default() };
    let float = Applied { effect: EffectId::buoyancy, on: "wheel".into(), at, parameters: vec![volume, density] };
    let floating = wheel.with_effects(&[float]).expect("a float");
    for q in [0.0, 0.7, 2.0, -1.1_f64] {
        // The lift is at (cos q, 0, −sin q) · rim.
        let needed = rim * q.cos() * density * volume * 9.81;
        for view in [View::new(floating.clone()), bare(&floating).passed()] {
            let found = call(&view, "inverse_dynamics", &[&[q], &[0.0], &[0.0]])[0];
            assert!((found - needed).abs() <= 1e-13 * (1.0 + needed.abs()), "{found} instead of {needed}");
        }
    }
}
