//! The interface: wrong input is an error, and there is no panic.

use articulated::{Dynamics, FunctionError};
use articulated_core::algorithm::checked::checked_forward_dynamics;
use articulated_core::algorithm::{Function, Workspace, functions};
use articulated_core::description::{Base, Description, EditError, Inertial, Joint, JointId, JointKind, Link, LinkId, Mimic, Origin};
use articulated_core::model::{Model, ModelError};
use articulated_tests::case::{Case, State, for_each_tree, inverse_dynamics, placements};
use articulated_tests::measure::arguments;
use articulated_tests::random_tree::Flavour;

articulated::robot! {
    /// A robot with one function only.
    pub(crate) mod pendulum {
        urdf = "../models/urdf/double_pendulum.urdf",
        functions = [inverse_dynamics],
    }
}

/// The answer of a function of the trait if arguments and result are longer than required by these
/// numbers.
fn answer<D: Dynamics>(robot: &D, row: &Function<f64>, longer: &[isize]) -> Result<(), FunctionError> {
    let shape = robot.shape();
    let lengths = row.takes.iter().map(|a| a.len(shape)).chain([row.len(shape)]);
    let mut vectors: Vec<Vec<f64>> = lengths.zip(longer).map(|(n, more)| vec![0.0; n.saturating_add_signed(*more)]).collect();
    let mut out = vectors.pop().expect("the result");
    let given: Vec<&[f64]> = vectors.iter().map(Vec::as_slice).collect();
    robot.call(row.id, &mut robot.workspace(), &given, &mut out)
}

/// An argument or a result of a wrong length is an error that names it.
fn each_length_counts<D: Dynamics>(robot: &D, row: &Function<f64>) {
    let n = row.takes.len() + 1;
    assert_eq!(answer(robot, row, &vec![0; n]), Ok(()), "{}", row.name);
    for (k, more) in (0..n).flat_map(|k| [-1, 1, 30].map(|more| (k, more))) {
        let mut longer = vec![0; n];
        longer[k] = more;
        let (name, expected) = match row.takes.get(k) {
            Some(argument) => (argument.name(), argument.len(robot.shape())),
            None => ("out", row.len(robot.shape())),
        };
        let error = FunctionError::Length { argument: name, found: expected.saturating_add_signed(more), expected };
        assert_eq!(answer(robot, row, &longer), Err(error), "{}", row.name);
    }
}

#[test]
fn each_wrong_length_is_an_error_that_names_it() {
    let model = Case::bundled(articulated_models::robot("panda_like").unwrap()).model;
    functions::<f64>().iter().for_each(|row| each_length_counts(&model, row));
}

#[test]
fn a_generated_robot_says_the_same_and_what_it_lacks() {
    for row in functions::<f64>() {
        if row.name == "inverse_dynamics" {
            each_length_counts(&pendulum::Robot, row);
        } else {
            let lacks = Err(FunctionError::NotGenerated { function: row.name });
            assert_eq!(answer(&pendulum::Robot, row, &vec![0; row.takes.len() + 1]), lacks);
        }
    }
}

#[test]
fn a_workspace_of_another_robot_is_an_error() {
    let model = |name| Case::bundled(articulated_models::robot(name).unwrap()).model;
    let (arm, pendulum) = (model("panda_like"), model("double_pendulum"));
    let mut out = [0.0; 7];
    assert_eq!(arm.gravity_torque(&mut pendulum.workspace(), &[0.0; 7], &mut out), Err(FunctionError::Workspace));
}

/// So is one with the same number of bodies: on other joints, in another tree, with other frames,
/// of a joint that follows another.
#[test]
fn a_workspace_of_another_robot_of_that_size_is_an_error() {
    use JointKind::{Continuous, Planar, Prismatic, Universal};
    let model = |links, joints| Model::new(&tree(links, joints), Base::Fixed).unwrap();
    let two = |second: Joint| model(3, vec![joint("a", Continuous, 0, 1), second]);
    let (chain, branches) = (two(joint("b", Continuous, 1, 2)), two(joint("b", Continuous, 0, 2)));
    let leader = Mimic::linear(JointId(0), 2.0, 0.0);
    let follower = two(Joint { mimic: Some(leader), ..joint("b", Continuous, 1, 2) });
    let (planar, three) = (model(2, vec![joint("a", Planar, 0, 1)]), {
        let joints = (0..3).map(|k| joint(["a", "b", "c"][k], Continuous, k, k + 1));
        model(4, joints.collect())
    });
    let floating = Model::new(&tree(1, vec![]), Base::Floating).unwrap();
    let pendulum = model(2, vec![joint("a", Continuous, 0, 1)]);
    let universal = model(2, vec![joint("a", Universal, 0, 1)]);
    let fewer = chain.clone().with_frames(&["l2"]).unwrap();
    let others = [
        (&chain, &branches),
        (&chain, &follower),
        (&follower, &pendulum),
        (&planar, &three),
        (&floating, &pendulum),
        (&chain, &fewer),
        (&chain, &universal),
    ];
    for (a, b) in others.into_iter().flat_map(|(a, b)| [(a, b), (b, a)]) {
        let (q, mut out) = (vec![0.0; a.nq()], vec![0.0; a.nv() * a.nv()]);
        assert_eq!(a.mass_matrix(&mut b.workspace(), &q, &mut out), Err(FunctionError::Workspace), "{a:?} {b:?}");
        assert_eq!(a.mass_matrix(&mut a.workspace(), &q, &mut out), Ok(()));
    }
    // The kind of a joint with the same number of coordinates does not matter to the workspace.
    let slide = two(joint("b", Prismatic, 1, 2));
    assert_eq!(slide.mass_matrix(&mut chain.workspace(), &[0.0; 2], &mut [0.0; 4]), Ok(()));
}

/// One program over the trait, on a generated robot and on its model.
#[test]
fn generated_and_generic_robots_are_the_same_to_code_over_the_trait() {
    let case = Case::bundled(articulated_models::robot("double_pendulum").unwrap());
    assert_eq!(Dynamics::shape(&case.model), pendulum::Robot.shape());
    assert_eq!(Dynamics::name(&case.model), pendulum::Robot.name());
    let (q, v, a) = ([0.3, -1.2], [0.4, 2.0], [-1.0, 0.1]);
    let mut generated = [0.0; 2];
    pendulum::Robot.inverse_dynamics(&mut (), &q, &v, &a, &mut generated).unwrap();
    for (g, m) in generated.iter().zip(inverse_dynamics(&case.model, &q, &v, &a)) {
        assert!((g - m).abs() < 1e-14, "{generated:?}");
    }
}

#[test]
fn a_wrong_number_of_arguments_is_an_error() {
    for_each_tree(5, Flavour::ANY, |case, random| {
        let state = case.state(random);
        let ws = &mut Workspace::new(&case.model);
        for row in functions::<f64>() {
            let (given, mut out) = (arguments(row.name, &state), vec![0.0; row.len(case.model.shape())]);
            assert_eq!(row.call(&case.model, ws, &given, &mut out), Ok(()));
            assert!(row.call(&case.model, ws, &given[1..], &mut out).is_err());
            assert!(row.call(&case.model, ws, &given, &mut [out, vec![0.0]].concat()).is_err());
        }
    });
}

/// Neither NaN nor infinite nor huge values stop the generic library.
#[test]
fn no_value_makes_an_algorithm_panic() {
    for_each_tree(10, Flavour::ANY, |case, _| {
        for x in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e308, -1e-308, 5e-324, -0.0] {
            let state = State::of(case.model.shape(), |_, n| vec![x; n]);
            let ws = &mut case.model.workspace();
            for row in functions::<f64>() {
                let mut out = vec![0.0; row.len(case.model.shape())];
                assert_eq!(row.call(&case.model, ws, &arguments(row.name, &state), &mut out), Ok(()), "{}", row.name);
            }
            let _ = checked_forward_dynamics(&case.model, ws, &state.q, &state.v, &state.tau, &mut vec![0.0; case.model.nv()]);
        }
    });
}

fn link(name: &str) -> Link {
    Link { name: name.into(), ..Link::default() }
}

fn joint(name: &str, kind: JointKind, parent: usize, child: usize) -> Joint {
    let (origin, axis) = (Origin::default(), [1.0, 0.0, 0.0]);
    Joint { name: name.into(), kind, parent: LinkId(parent), child: LinkId(child), origin, axis, mimic: None, ..Joint::default() }
}

fn tree(links: usize, joints: Vec<Joint>) -> Description {
    Description {
        name: "odd".into(),
        links: (0..links).map(|k| link(&format!("l{k}"))).collect(),
        joints: joints.into(),
        frames: Vec::new(),
    }
}

#[test]
fn what_is_not_a_tree_is_an_error() {
    use JointKind::Continuous;
    let not_a_tree = |d: &Description| matches!(Model::new(d, Base::Fixed), Err(ModelError::NotATree { .. }));
    assert!(not_a_tree(&tree(0, vec![])), "no link");
    assert!(not_a_tree(&tree(2, vec![])), "two roots");
    assert!(not_a_tree(&tree(2, vec![joint("a", Continuous, 0, 1), joint("b", Continuous, 1, 0)])), "a ring");
    assert!(not_a_tree(&tree(3, vec![joint("a", Continuous, 1, 2), joint("b", Continuous, 2, 1)])), "a ring beside a root");
    assert!(not_a_tree(&tree(2, vec![joint("a", Continuous, 0, 1), joint("b", Continuous, 0, 1)])), "two ways");
    assert!(not_a_tree(&tree(1, vec![joint("a", Continuous, 0, 0)])), "a link on itself");
    assert!(not_a_tree(&tree(1, vec![joint("a", Continuous, 0, 9)])), "a link that is not there");
}

#[test]
fn a_joint_is_not_called_as_that_of_a_floating_base() {
    let named = tree(2, vec![joint("__floating_base__", JointKind::Continuous, 0, 1)]);
    // Also with a fixed base: they would be indistinguishable in a report or a file of states.
    for base in [Base::Floating, Base::Fixed] {
        assert!(matches!(Model::new(&named, base), Err(ModelError::NamedAsBase)));
    }
}

#[test]
fn a_frame_that_is_not_there_is_named_with_the_nearest() {
    let arm = Case::bundled(articulated_models::robot("panda_like").unwrap()).model;
    let error = arm.clone().with_frames(&["hand_tpc"]).unwrap_err();
    assert_eq!(error, EditError::UnknownLink { name: "hand_tpc".into(), nearest: Some("hand_tcp".into()) });
    assert_eq!(arm.with_frames(&["hand_tcp", "hand_tcp"]).unwrap().frames().len(), 2);
}

/// Λ of a frame that fewer than six degrees of freedom move is not a matrix, and is not returned as
/// one.
#[test]
fn inertia_in_all_directions_is_no_number_where_a_frame_cannot_move_in_all() {
    let arm = Case::bundled(articulated_models::robot("ur5_like").unwrap()).model;
    let mut out = vec![0.0; 36 * arm.frames().len()];
    arm.operational_space_inertia(&mut arm.workspace(), &[0.1, -0.9, 1.2, 0.4, 0.5, 0.6], &mut out).unwrap();
    for (frame, lambda) in arm.frames().iter().zip(out.chunks_exact(36)) {
        let moved = !frame.body.is_base() && arm.freedoms_of(frame.body).len() == 6;
        assert!(lambda.iter().all(|x| x.is_finite() == moved && x.is_nan() != moved), "{}: {lambda:?}", frame.name);
    }
}

/// Six joints, one a follower, have five degrees of freedom.
#[test]
fn inertia_in_all_directions_is_no_number_where_joints_follow_others() {
    let chain = |follows: bool| {
        let of = |k: usize| {
            let axis = [[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]][k % 3];
            let mimic = (follows && k == 3).then_some(Mimic::linear(JointId(0), 0.7, 0.1));
            let origin = Origin::at([0.1, 0.2, 0.3]);
            Joint { axis, mimic, origin, ..joint(&format!("j{k}"), JointKind::Revolute, k, k + 1) }
        };
        let mut robot = tree(7, (0..6).map(of).collect());
        robot
            .links
            .iter_mut()
            .for_each(|l| l.inertial = Some(Inertial { origin: Origin::default(), mass: 1.0, inertia: [0.1, 0.0, 0.0, 0.1, 0.0, 0.1] }));
        Model::new(&robot, Base::Fixed).unwrap().with_frames(&["l6"]).unwrap()
    };
    for follows in [false, true] {
        let (model, mut out) = (chain(follows), vec![0.0; 36]);
        model.operational_space_inertia(&mut model.workspace(), &[0.3, 0.4, 0.2, 0.5, 0.1, 0.6][..model.nq()], &mut out).unwrap();
        assert!(out.iter().all(|x| x.is_nan() == follows), "{follows}: {out:?}");
    }
}

#[test]
fn a_lock_has_as_many_coordinates_as_the_joint_all_finite() {
    use JointKind::{Fixed, Planar, Revolute, Spherical};
    let locked = |kind: JointKind, at: &[f64]| {
        let joint = Joint { locked: Some(at.to_vec()), ..joint("a", kind, 0, 1) };
        Model::new(&tree(2, vec![joint]), Base::Fixed)
    };
    let numbers = [&[0.0, 0.0][..], &[], &[f64::NAN], &[f64::INFINITY], &[f64::NEG_INFINITY]].map(|at| (Revolute, at));
    for (kind, at) in numbers.into_iter().chain([(Planar, &[0.1][..]), (Spherical, &[0.0; 3])]) {
        let found = locked(kind, at);
        let message = found.as_ref().map_or_else(ToString::to_string, |_| String::new());
        assert!(message.contains("\"a\"") && message.contains(kind.name()), "{message}");
        assert!(matches!(found, Err(ModelError::BadLock { joint, .. }) if joint == "a"));
    }
    assert!(locked(Fixed, &[]).is_ok() && locked(Revolute, &[0.3]).is_ok());
}

#[test]
fn who_follows_nobody_with_one_coordinate_is_an_error() {
    use JointKind::{Continuous, Fixed, Floating};
    let following = |leader: usize, other: Joint| {
        let mut first = joint("a", Continuous, 0, 1);
        first.mimic = Some(Mimic::linear(JointId(leader), 1.0, 0.0));
        Model::new(&tree(3, vec![first, other]), Base::Fixed)
    };
    let bad = |m: Result<Model, ModelError>| matches!(m, Err(ModelError::BadMimic { joint }) if joint == "a");
    assert!(bad(following(0, joint("b", Continuous, 1, 2))), "itself");
    assert!(bad(following(1, joint("b", Fixed, 1, 2))), "a fixed joint");
    assert!(bad(following(1, joint("b", Floating, 1, 2))), "a floating joint");
    assert!(bad(following(7, joint("b", Continuous, 1, 2))), "nobody");
    let mut ring = joint("b", Continuous, 1, 2);
    ring.mimic = Some(Mimic::linear(JointId(0), 1.0, 0.0));
    assert!(matches!(following(1, ring), Err(ModelError::BadMimic { .. })), "each other");
    assert!(following(1, joint("b", Continuous, 1, 2)).is_ok());
}

#[test]
fn what_overflows_is_an_error_that_names_it() {
    let far = |mass: f64, x: f64, at: f64| {
        let origin = Origin { xyz: [x, 0.0, 0.0], ..Origin::default() };
        let mut description = tree(2, vec![joint("a", JointKind::Continuous, 0, 1)]);
        description.links[LinkId(1)].inertial = Some(Inertial { origin, mass, inertia: [0.1, 0.0, 0.0, 0.1, 0.0, 0.1] });
        description.joints[JointId(0)].origin.xyz = [at, 0.0, 0.0];
        Model::new(&description, Base::Fixed)
    };
    for (mass, x) in [(1.0, 1e155), (1e300, 1e10), (1e308, 9.0)] {
        let message = far(mass, x, 0.0).map_or_else(|e| e.to_string(), |_| String::new());
        assert!(message.contains("joint \"a\"") && message.contains("overflow"), "{message}");
    }
    assert!(far(1e300, 1.0, 1e300).is_ok());
}

/// Each is finite, and the joint that follows the follower has the product of the two.
#[test]
fn multipliers_that_overflow_are_an_error_that_names_the_joint() {
    let chain = |multiplier: f64, offset: f64, locked: Option<Vec<f64>>| {
        let mut joints: Vec<Joint> = ["a", "b", "c"].iter().enumerate().map(|(k, n)| joint(n, JointKind::Continuous, k, k + 1)).collect();
        joints.iter_mut().skip(1).enumerate().for_each(|(k, j)| j.mimic = Some(Mimic::linear(JointId(k), multiplier, offset)));
        joints[0].locked = locked;
        Model::new(&tree(4, joints), Base::Fixed)
    };
    let message = |m: Result<Model, ModelError>| m.map_or_else(|e| e.to_string(), |_| String::new());
    for (multiplier, offset) in [(1e200, 0.0), (1e200, 1e200)] {
        let found = message(chain(multiplier, offset, None));
        assert!(found.contains("joint \"c\"") && !found.contains("joint \"b\"") && found.contains("overflow"), "{found}");
    }
    let found = message(chain(1e200, 0.0, Some(vec![1.0])));
    assert!(found.contains("link \"l3\"") && !found.contains("link \"l2\"") && found.contains("overflow"), "{found}");
    assert!(chain(1e100, 1e100, None).is_ok() && chain(1e100, 0.0, Some(vec![1.0])).is_ok());
}

/// A link alone has no coordinates on a fixed base, and six on a floating one.
#[test]
fn a_single_link_goes_through_everything() {
    let body = Inertial { origin: Origin::default(), mass: 2.0, inertia: [0.1, 0.0, 0.0, 0.1, 0.0, 0.1] };
    let one = Description {
        name: "stone".into(),
        links: [Link { name: "stone".into(), inertial: Some(body), ..Link::default() }].into(),
        joints: Vec::new().into(),
        frames: vec![],
    };
    let fixed = Case::new("stone", one.clone(), Base::Fixed);
    assert_eq!((fixed.model.nq(), fixed.model.nv(), fixed.model.frames().len()), (0, 0, 1));
    assert_eq!(inverse_dynamics(&fixed.model, &[], &[], &[]), Vec::<f64>::new());
    assert_eq!(placements(&fixed.model, &[]), [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]);
    let floating = Case::new("stone", one, Base::Floating);
    let q = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0];
    assert_eq!(inverse_dynamics(&floating.model, &q, &[0.0; 6], &[0.0; 6]), [0.0, 0.0, 0.0, 0.0, 0.0, 2.0 * 9.81]);
}

/// Depth costs no stack: a chain of 1000 joints is a model.
#[test]
fn a_chain_may_be_long() {
    let n = 1000;
    let body = Inertial { origin: Origin::default(), mass: 0.1, inertia: [1e-3, 0.0, 0.0, 1e-3, 0.0, 1e-3] };
    let mut chain = tree(n + 1, (0..n).map(|k| joint(&format!("j{k}"), JointKind::Continuous, k, k + 1)).collect());
    chain.links.iter_mut().for_each(|l| l.inertial = Some(body));
    chain.joints.iter_mut().for_each(|j| j.origin.xyz = [0.0, 0.0, -0.01]);
    let model = Model::new(&chain, Base::Fixed).unwrap();
    let zero = vec![0.0; n];
    assert!(inverse_dynamics(&model, &zero, &zero, &zero).iter().all(|t| t.abs() < 1e-12), "it hangs straight down");
    assert!((placements(&model, &zero)[12 * n + 11] + 10.0).abs() < 1e-12);
    assert!(model.massless_joints().is_empty());
}
