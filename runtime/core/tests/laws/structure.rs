//! Parts of every equation of motion M(q)·a + h(q, v) = τ.

use articulated_core::description::{Base, Description, Inertial, Joint, JointKind, Link, LinkId, Origin};
use articulated_core::index::BodyId;
use articulated_core::model::Model;
use articulated_test_support::case::{Case, State, for_each_bundled, inverse_dynamics, mass_matrix, read};
use articulated_test_support::measure::{arguments, distance, error, plus, scale, torque_scale};
use articulated_test_support::random::Random;
use articulated_test_support::random_tree::Flavour;

use crate::trees::for_each_tree;

/// Errors allowed, in units of u times the magnitude of the terms.
const FEW: f64 = 16.0;

/// a·x + b·y.
fn sum(a: f64, x: &[f64], b: f64, y: &[f64]) -> Vec<f64> {
    x.iter().zip(y).map(|(x, y)| a * x + b * y).collect()
}

#[test]
fn torque_is_linear_in_acceleration() {
    for_each_tree(60, Flavour::ANY, |case, random| {
        let State { q, v, a, .. } = case.state(random);
        let b = case.state(random).a;
        let zero = vec![0.0; a.len()];
        let tau = |a: &[f64]| inverse_dynamics(&case.model, &q, &v, a);
        let scale = |a: &[f64]| torque_scale(case, &State::new(q.clone(), v.clone(), a.to_vec()));
        // τ(a + b) + h = τ(a) + τ(b)
        let left = sum(1.0, &tau(&sum(1.0, &a, 1.0, &b)), 1.0, &tau(&zero));
        let right = sum(1.0, &tau(&a), 1.0, &tau(&b));
        let far = distance(&left, &right, &plus(&scale(&a), &scale(&b)));
        assert!(far <= FEW, "{far} units of roundoff");
    });
}

#[test]
fn velocity_forces_grow_with_the_square_of_the_rates() {
    for_each_tree(60, Flavour::ANY, |case, random| {
        let State { q, v, a, .. } = case.state(random);
        let zero = vec![0.0; a.len()];
        let bias = |factor: f64| inverse_dynamics(&case.model, &q, &sum(factor, &v, 0.0, &v), &zero);
        // h(3v) − g = 9 (h(v) − g)
        let left = sum(1.0, &bias(3.0), 8.0, &bias(0.0));
        let right = sum(9.0, &bias(1.0), 0.0, &zero);
        let scale = torque_scale(case, &State::new(q.clone(), sum(3.0, &v, 0.0, &v), zero.clone()));
        let far = distance(&left, &right, &sum(2.0, &scale, 8.0, &scale));
        assert!(far <= FEW, "{far} units of roundoff");
    });
}

fn positive_definite(case: &Case, random: &mut Random) {
    let m = mass_matrix(&case.model, &case.state(random).q);
    let size = m.amax();
    assert!((&m - m.transpose()).amax() <= 1e-13 * size, "not symmetric: {m}");
    assert!(m.is_empty() || m.clone().cholesky().is_some(), "not positive definite: {m}");
}

#[test]
fn mass_matrix_is_symmetric_and_positive_definite() {
    for_each_tree(100, Flavour::REGULAR, positive_definite);
    for_each_bundled(positive_definite);
}

fn composite_bodies(case: &Case, random: &mut Random) {
    let (state, n) = (case.state(random), case.model.nv());
    let found = case.call::<f64>("mass_matrix", &[&state.q]);
    let columns = mass_matrix(&case.model, &state.q);
    let expected: Vec<f64> = (0..n * n).map(|k| columns[(k / n, k % n)]).collect();
    let far = distance(&found, &expected, &scale(case, "mass_matrix", &state));
    assert!(far <= FEW, "{far} units of roundoff");
    assert!((0..n * n).all(|k| found[k] == found[k % n * n + k / n]), "not symmetric to the bit");
}

#[test]
fn composite_bodies_give_the_matrix_of_n_recursions() {
    for_each_tree(100, Flavour::ANY, composite_bodies);
    for_each_bundled(composite_bodies);
}

/// Backward error: the accelerations belong to torques that are off by less than 64 roundings.
fn forward_inverts_inverse(case: &Case, random: &mut Random) {
    let state = case.state(random);
    let found = case.call::<f64>("forward_dynamics", &[&state.q, &state.v, &state.tau]);
    let far = error(case, "forward_dynamics", &state, &found);
    assert!(far <= 64.0, "{far} units of roundoff");
}

#[test]
fn forward_dynamics_inverts_inverse_dynamics() {
    for_each_tree(100, Flavour::REGULAR, forward_inverts_inverse);
    for_each_bundled(forward_inverts_inverse);
}

/// Of M scaled to a diagonal of ones; zero where an element of the diagonal is.
fn smallest_scaled_eigenvalue(m: &nalgebra::DMatrix<f64>) -> f64 {
    let size: Vec<f64> = m.diagonal().iter().map(|x| x.max(0.0).sqrt()).collect();
    if size.is_empty() {
        return 1.0;
    }
    if size.iter().any(|s| *s <= 1e-14 * m.amax().sqrt()) {
        return 0.0;
    }
    let scaled = nalgebra::DMatrix::from_fn(m.nrows(), m.ncols(), |i, k| m[(i, k)] / size[i] / size[k]);
    scaled.symmetric_eigenvalues().iter().copied().fold(1.0, f64::min)
}

#[test]
fn joints_that_move_no_mass_are_found() {
    for_each_tree(150, Flavour::ANY, |case, random| {
        let found = case.model.massless_joints();
        let m = mass_matrix(&case.model, &case.state(random).q);
        // A zero row, or one that depends on others: either way M is singular. If no such joint is
        // found, M is regular.
        let left = smallest_scaled_eigenvalue(&m);
        assert!(found.is_empty() || left <= 1e-12, "joints {found:?} do move mass: {left:e}");
        assert!(!found.is_empty() || left > 1e-12, "M is singular, {left:e}, and no joint is found");
        for k in 0..case.model.nv() {
            let alone = case.model.joints().iter().find(|j| j.v == (k, 1));
            if let Some(joint) = alone.filter(|_| m.row(k).amax() == 0.0) {
                let names: Vec<&str> = found.iter().map(|&b| case.model.bodies()[b].name.as_str()).collect();
                assert!(names.contains(&joint.name.as_str()), "{} moves nothing and is not among {names:?}", joint.name);
            }
        }
    });
}

/// Two joints without mass of their own carry one that moves none, or one that only repeats
/// another: only those are named, not the joints that carry them.
#[test]
fn joints_that_carry_a_massless_one_are_not_blamed() {
    let body = |at: &str| {
        format!(
            "<inertial><origin xyz='{at}'/><mass value='2'/><inertia ixx='0.1' ixy='0' ixz='0' iyy='0.2' iyz='0' izz='0.15'/></inertial>"
        )
    };
    let joint = |name: &str, parent: &str, child: &str, at: &str, axis: &str| {
        format!(
            "<joint name='{name}' type='continuous'><parent link='{parent}'/><child link='{child}'/><origin xyz='{at}'/><axis xyz='{axis}'/></joint>"
        )
    };
    let arm = joint("one", "base", "bare", "0 0 0", "0 0 1")
        + &joint("two", "bare", "empty", "0.5 0 0", "0 1 0")
        + &joint("three", "empty", "tip", "0.5 0 0", "1 0 0");
    let model = |more: &str| {
        let links = format!("<link name='base'/><link name='bare'/><link name='empty'/><link name='tip'>{}</link>", body("0.2 0.1 0"));
        Case::new("r", read(&format!("<robot name='r'>{links}{arm}{more}</robot>")), Base::Fixed).model
    };
    assert!(model("").massless_joints().is_empty());
    let camera = joint("pan", "tip", "camera", "0 0 0.1", "0 1 0") + "<link name='camera'/>";
    assert_eq!(model(&camera).massless_joints(), [BodyId(4)]);
    // About one axis with the one before, without mass between: the inner of the two is named.
    let twice = joint("roll", "tip", "gap", "0 0 0.1", "0 1 0") + &joint("again", "gap", "tool", "0 0.1 0", "0 1 0");
    let twice = twice + &format!("<link name='gap'/><link name='tool'>{}</link>", body("0 0 0.3"));
    assert_eq!(model(&twice).massless_joints(), [BodyId(4)]);
    assert_eq!(model(&(camera.replace("'camera'", "'lens'") + &twice)).massless_joints(), [BodyId(4), BodyId(5)]);
}

/// A joint that follows another backwards leaves its body where it was: no joint moves that body's
/// mass.
#[test]
fn a_follower_that_undoes_its_leader_moves_no_mass() {
    for (kind, multiplier) in [("prismatic", -1.0), ("revolute", -1.0), ("prismatic", -0.5), ("revolute", 1.0)] {
        let joint = |name: &str, parent: &str, child: &str, mimic: &str| {
            format!(
                "<joint name='{name}' type='{kind}'><parent link='{parent}'/><child link='{child}'/><axis xyz='0 1 0'/>{mimic}
                <limit lower='-3' upper='3' effort='1' velocity='1'/></joint>"
            )
        };
        let mimic = format!("<mimic joint='first' multiplier='{multiplier}' offset='0.1'/>");
        let joints = joint("first", "base", "middle", "") + &joint("second", "middle", "tip", &mimic);
        let body = "<inertial><origin xyz='0 0 0'/><mass value='1'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial>";
        let urdf = format!("<robot name='r'><link name='base'/><link name='middle'/><link name='tip'>{body}</link>{joints}</robot>");
        let model = Case::new("r", read(&urdf), Base::Fixed).model;
        let undone = multiplier == -1.0;
        assert_eq!(model.massless_joints(), if undone { vec![BodyId(1)] } else { vec![] }, "{kind} {multiplier}");
    }
}

/// A rod that hangs in a ball joint and points along one of its axes does not feel that turn,
/// though it feels the other two.
#[test]
fn a_rod_in_a_ball_joint_can_turn_about_itself() {
    for (axis, inertia) in [(0, [0.0, 0.0, 0.0, 1.0, 0.0, 1.0]), (1, [1.0, 0.0, 0.0, 0.0, 0.0, 1.0]), (2, [1.0, 0.0, 0.0, 1.0, 0.0, 0.0])] {
        let link = |name: &str, inertial| Link { name: name.into(), inertial, ..Link::default() };
        let rod = |inertia| Some(Inertial { origin: Origin::default(), mass: 1.0, inertia });
        let ball = |inertia| {
            let joint = Joint { name: "ball".into(), kind: JointKind::Spherical, parent: LinkId(0), child: LinkId(1), ..Joint::default() };
            let robot = Description {
                name: "rod".into(),
                links: [link("base", None), link("rod", rod(inertia))].into(),
                joints: [joint].into(),
                frames: Vec::new(),
            };
            Model::new(&robot, Base::Fixed).unwrap()
        };
        let model = ball(inertia);
        assert_eq!(mass_matrix(&model, &[0.1, 0.7, -0.1, 0.7]).row(axis).amax(), 0.0);
        assert_eq!(model.massless_joints(), [BodyId(1)]);
        assert!(ball([1.0, 0.0, 0.0, 1.0, 0.0, 1.0]).massless_joints().is_empty());
        // No body has this inertia, but its resistance is not zero.
        assert!(ball([-1e-3, 0.0, 0.0, 1.0, 0.0, 1.0]).massless_joints().is_empty());
    }
}

#[test]
fn joints_are_ordered_depth_first_as_the_file_lists_them() {
    for_each_tree(100, Flavour::ANY, |case, _| {
        let names: Vec<&str> = case.model.joints().iter().map(|j| j.name.as_str()).collect();
        let floating = usize::from(case.base == Base::Floating);
        assert_eq!(names[floating..], case.motions().joint_names());
        let (mut q, mut v) = (0, 0);
        for joint in case.model.joints() {
            assert_eq!((joint.q.0, joint.v.0), (q, v), "{}", joint.name);
            (q, v) = (q + joint.q.1, v + joint.v.1);
        }
        assert_eq!((q, v), (case.model.nq(), case.model.nv()));
        let links: Vec<&str> = case.description.links.iter().map(|l| l.name.as_str()).collect();
        let frames: Vec<&str> = case.model.frames().iter().map(|f| f.name.as_str()).collect();
        assert_eq!(frames, links);
    });
}

/// Only places depend on the position of a robot, and no digit is lost far away.
#[test]
fn a_robot_far_from_the_origin_is_none_the_worse() {
    const FAR: [[f64; 3]; 2] = [[1e6, -3e5, 0.1], [3e11, 1e12, -2e12]];
    const NAMES: [&str; 12] = [
        "inverse_dynamics",
        "mass_matrix",
        "forward_dynamics",
        "coriolis_matrix",
        "inverse_dynamics_derivatives",
        "jacobians_body",
        "jacobians_world_aligned",
        "center_of_mass_velocity",
        "center_of_mass_acceleration",
        "centroidal_momentum",
        "centroidal_momentum_matrix",
        "centroidal_momentum_rate",
    ];
    for_each_bundled(|case, random| {
        let state = case.state(random);
        for at in FAR.into_iter().filter(|_| case.base == Base::Floating) {
            let mut far = state.clone();
            far.q[..3].copy_from_slice(&at);
            for name in NAMES {
                let [here, there] = [&state, &far].map(|s| case.call::<f64>(name, &arguments(name, s)));
                assert_eq!(here, there, "{name}");
            }
        }
    });
}
