//! The interface: wrong input is an error, and nothing panics.

use articulated::{Dynamics, FunctionError, Shape};
use articulated_core::algorithm::{Workspace, functions};
use articulated_core::description::{Base, Description, Inertial, Joint, JointKind, Link, Mimic, Origin};
use articulated_core::model::{Model, ModelError};
use articulated_tests::case::{Case, for_each_tree, inverse_dynamics, placements};
use articulated_tests::measure::arguments;
use articulated_tests::random_tree::Flavour;

articulated::robot! {
    /// A robot with one function only.
    pub(crate) mod pendulum {
        urdf = "../models/urdf/double_pendulum.urdf",
        functions = [inverse_dynamics],
    }
}

/// Lengths of the arguments and results of the trait's functions.
#[derive(Clone, Copy)]
struct Lengths {
    q: usize,
    /// Of v, a and τ as arguments: v, then the other.
    given: [usize; 2],
    /// Of results: torques or accelerations, frames, entries of the mass matrix.
    results: [usize; 3],
}

impl Lengths {
    fn of(shape: Shape) -> Self {
        let Shape { nq, nv, frames } = shape;
        Self { q: nq, given: [nv; 2], results: [nv, frames, nv * nv] }
    }
}

/// The names of the trait's functions, and what they say to these lengths.
fn answers<D: Dynamics>(robot: &D, n: Lengths) -> [(&'static str, Result<(), FunctionError>); 6] {
    let ws = &mut robot.workspace();
    let zeros = |n: usize| vec![0.0; n];
    let (q, v, a) = (zeros(n.q), zeros(n.given[0]), zeros(n.given[1]));
    let [mut out, mut matrix] = [zeros(n.results[0]), zeros(n.results[2])];
    let mut frames = vec![[0.0; 12]; n.results[1]];
    [
        ("inverse_dynamics", robot.inverse_dynamics(ws, &q, &v, &a, &mut out)),
        ("placements", robot.placements(ws, &q, &mut frames)),
        ("bias_forces", robot.bias_forces(ws, &q, &v, &mut out)),
        ("gravity_torque", robot.gravity_torque(ws, &q, &mut out)),
        ("mass_matrix", robot.mass_matrix(ws, &q, &mut matrix)),
        ("forward_dynamics", robot.forward_dynamics(ws, &q, &v, &a, &mut out)),
    ]
}

/// Each function says the length that is wrong, if it has that argument, and is content otherwise.
fn one_wrong<D: Dynamics>(robot: &D, lengths: Lengths, wrong: usize, takes: &[&str]) {
    for (name, answer) in answers(robot, lengths) {
        match answer {
            Err(FunctionError::Length { found, .. }) if takes.contains(&name) => assert_eq!(found, wrong, "{name}"),
            other => assert!(other.is_ok() && !takes.contains(&name), "{name}: {other:?}"),
        }
    }
}

#[test]
fn each_wrong_length_is_an_error_that_names_it() {
    let model = Case::bundled(articulated_models::robot("panda_like").unwrap()).model;
    let right = Lengths::of(model.shape());
    one_wrong(&model, right, 0, &[]);
    let all: Vec<&str> = answers(&model, right).iter().map(|(name, _)| *name).collect();
    let known: Vec<&str> = functions::<f64>().iter().map(|f| f.name).collect();
    assert!(known.iter().all(|f| all.contains(f)), "the trait lacks one of {known:?}");
    for off in [-1_isize, 1, 30] {
        let wrong = |n: usize| n.checked_add_signed(off).unwrap();
        let but = |change: &dyn Fn(&mut Lengths)| {
            let mut lengths = right;
            change(&mut lengths);
            lengths
        };
        let with_v = ["inverse_dynamics", "bias_forces", "forward_dynamics"];
        one_wrong(&model, but(&|n| n.q = wrong(right.q)), wrong(right.q), &all);
        one_wrong(&model, but(&|n| n.given[0] = wrong(7)), wrong(7), &with_v);
        one_wrong(&model, but(&|n| n.given[1] = wrong(7)), wrong(7), &["inverse_dynamics", "forward_dynamics"]);
        one_wrong(
            &model,
            but(&|n| n.results[0] = wrong(7)),
            wrong(7),
            &["inverse_dynamics", "bias_forces", "gravity_torque", "forward_dynamics"],
        );
        one_wrong(&model, but(&|n| n.results[1] = wrong(right.results[1])), wrong(right.results[1]), &["placements"]);
        one_wrong(&model, but(&|n| n.results[2] = wrong(49)), wrong(49), &["mass_matrix"]);
    }
    let no_q = answers(&model, Lengths { q: 0, ..right });
    assert_eq!(no_q[0].1, Err(FunctionError::Length { argument: "q", found: 0, expected: 7 }));
}

#[test]
fn a_generated_robot_says_the_same_and_what_it_lacks() {
    let right = Lengths::of(pendulum::Robot.shape());
    let good = answers(&pendulum::Robot, right);
    assert_eq!(good[0], ("inverse_dynamics", Ok(())));
    for (name, answer) in &good[1..] {
        assert_eq!(*answer, Err(FunctionError::NotGenerated { function: name }));
    }
    let said = |lengths: Lengths| answers(&pendulum::Robot, lengths)[0].1;
    let wrong = |argument, found| Err(FunctionError::Length { argument, found, expected: 2 });
    assert_eq!(said(Lengths { q: 3, ..right }), wrong("q", 3));
    assert_eq!(said(Lengths { given: [1, 2], ..right }), wrong("v", 1));
    assert_eq!(said(Lengths { given: [2, 0], ..right }), wrong("a", 0));
    assert_eq!(said(Lengths { results: [5, 3, 4], ..right }), wrong("tau", 5));
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

/// Neither values that are no numbers nor huge ones stop the generic library.
#[test]
fn no_value_makes_an_algorithm_panic() {
    for_each_tree(10, Flavour::ANY, |case, _| {
        for x in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e308, -1e-308, 5e-324, -0.0] {
            let (q, v) = (vec![x; case.model.nq], vec![x; case.model.nv]);
            inverse_dynamics(&case.model, &q, &v, &v);
            placements(&case.model, &q);
        }
    });
}

fn link(name: &str) -> Link {
    Link { name: name.into(), inertial: None }
}

fn joint(name: &str, kind: JointKind, parent: usize, child: usize) -> Joint {
    let (origin, axis) = (Origin::default(), [1.0, 0.0, 0.0]);
    Joint { name: name.into(), kind, parent, child, origin, axis, mimic: None, ..Joint::default() }
}

fn tree(links: usize, joints: Vec<Joint>) -> Description {
    Description { name: "odd".into(), links: (0..links).map(|k| link(&format!("l{k}"))).collect(), joints }
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
fn a_lock_has_as_many_coordinates_as_the_joint_all_finite() {
    use JointKind::{Fixed, Planar, Revolute, Spherical};
    let locked = |kind: JointKind, at: &[f64]| {
        let joint = Joint { locked: Some(at.to_vec()), ..joint("a", kind, 0, 1) };
        Model::new(&tree(2, vec![joint]), Base::Fixed)
    };
    for (kind, at) in [(Revolute, &[0.0, 0.0][..]), (Revolute, &[]), (Planar, &[0.1]), (Spherical, &[0.0; 3]), (Revolute, &[f64::NAN])] {
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
        first.mimic = Some(Mimic { joint: leader, multiplier: 1.0, offset: 0.0 });
        Model::new(&tree(3, vec![first, other]), Base::Fixed)
    };
    let bad = |m: Result<Model, ModelError>| matches!(m, Err(ModelError::BadMimic { joint }) if joint == "a");
    assert!(bad(following(0, joint("b", Continuous, 1, 2))), "itself");
    assert!(bad(following(1, joint("b", Fixed, 1, 2))), "a fixed joint");
    assert!(bad(following(1, joint("b", Floating, 1, 2))), "a floating joint");
    assert!(bad(following(7, joint("b", Continuous, 1, 2))), "nobody");
    let mut ring = joint("b", Continuous, 1, 2);
    ring.mimic = Some(Mimic { joint: 0, multiplier: 1.0, offset: 0.0 });
    assert!(matches!(following(1, ring), Err(ModelError::BadMimic { .. })), "each other");
    assert!(following(1, joint("b", Continuous, 1, 2)).is_ok());
}

/// A link alone has no coordinates on a fixed base, and six on a floating one.
#[test]
fn a_single_link_goes_through_everything() {
    let body = Inertial { origin: Origin::default(), mass: 2.0, inertia: [0.1, 0.0, 0.0, 0.1, 0.0, 0.1] };
    let one = Description { name: "stone".into(), links: vec![Link { name: "stone".into(), inertial: Some(body) }], joints: vec![] };
    let fixed = Case::new("stone", one.clone(), Base::Fixed);
    assert_eq!((fixed.model.nq, fixed.model.nv, fixed.model.frames.len()), (0, 0, 1));
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
    assert_eq!(model.massless_joints(), Vec::<usize>::new());
}
