//! Different descriptions of the same physics.

use articulated_core::algorithm::{Dim, Needs, functions};
use articulated_core::description::{Base, Description, Frame, Inertial, Joint, JointId, JointKind, Link, LinkId, Origin, Rotation};
use articulated_core::spatial::from_quaternion;
use articulated_test_support::case::{Case, State, inverse_dynamics};
use articulated_test_support::measure::{distance, torque_scale};
use articulated_test_support::random_tree::{Flavour, random_tree};
use articulated_test_support::regressors::broken_laws;
use articulated_test_support::{random::Random, rigid};
use nalgebra::Vector3;

use crate::trees::for_each_tree;

/// Errors allowed, in units of u times the magnitude of the terms.
const FEW: f64 = 16.0;

/// The same tree with every link behind a fixed joint made part of the link that it is fixed to.
fn lumped(tree: &Description) -> Description {
    let mut out = tree.clone();
    while let Some(fixed) = out.joints.iter().position(|j| j.kind.is_fixed()) {
        let Joint { parent, child, origin, .. } = out.joints[JointId(fixed)].clone();
        let carried = out.links[child].inertial.map(|body| rigid::carried(&origin, &body));
        out.links[parent].inertial = both(out.links[parent].inertial, carried);
        for joint in out.joints.iter_mut().filter(|j| j.parent == child) {
            joint.parent = parent;
            joint.origin = rigid::compose(&origin, &joint.origin);
        }
        remove_joint(&mut out, fixed);
        remove_link(&mut out, child.0);
    }
    out
}

fn both(a: Option<Inertial>, b: Option<Inertial>) -> Option<Inertial> {
    match (a, b) {
        (Some(a), Some(b)) => Some(rigid::together(&a, &b)),
        (one, other) => one.or(other),
    }
}

fn remove_joint(tree: &mut Description, gone: usize) {
    tree.joints.remove(JointId(gone));
    for mimic in tree.joints.iter_mut().filter_map(|j| j.mimic.as_mut()) {
        mimic.joint.0 -= usize::from(mimic.joint > JointId(gone));
    }
}

fn remove_link(tree: &mut Description, gone: usize) {
    tree.links.remove(LinkId(gone));
    for joint in &mut tree.joints {
        joint.parent.0 -= usize::from(joint.parent > LinkId(gone));
        joint.child.0 -= usize::from(joint.child > LinkId(gone));
    }
}

#[test]
fn links_on_fixed_joints_are_one_body() {
    for_each_tree(120, Flavour::ANY, |case, random| {
        let state = case.state(random);
        let lump = Case::new("", lumped(&case.description), case.base);
        let order = permutation(&case.model, &lump.model);
        let moved = |x: &[f64], of: fn(&articulated_core::model::JointInfo) -> (usize, usize)| {
            order.iter().flat_map(|&(from, _)| x[of(&case.model.joints()[from]).0..][..of(&case.model.joints()[from]).1].to_vec()).collect()
        };
        let (q, v, a): (Vec<f64>, Vec<f64>, Vec<f64>) = (moved(&state.q, |j| j.q), moved(&state.v, |j| j.v), moved(&state.a, |j| j.v));
        let expected: Vec<f64> = moved(&case.inverse_dynamics(&state), |j| j.v);
        let scale: Vec<f64> = moved(&torque_scale(case, &state), |j| j.v);
        let found = inverse_dynamics(&lump.model, &q, &v, &a);
        let far = distance(&found, &expected, &scale);
        assert!(far <= FEW, "{far} units of roundoff");
    });
}

/// Lumping may change the order in which the file's joints are met: where each joint of `new` is in
/// `old`.
fn permutation(old: &articulated_core::model::Model, new: &articulated_core::model::Model) -> Vec<(usize, usize)> {
    let place = |name: &str| old.joints().iter().position(|j| j.name == name).unwrap();
    new.joints().iter().enumerate().map(|(k, j)| (place(&j.name), k)).collect()
}

#[test]
fn only_the_direction_of_an_axis_counts() {
    for_each_tree(60, Flavour::ANY, |case, random| {
        let state = case.state(random);
        let tau = case.inverse_dynamics(&state);
        for (factor, tolerance) in [(8.0, 0.0), (1e-3, FEW), (7e80, FEW)] {
            let mut longer = case.description.clone();
            longer.joints.iter_mut().for_each(|j| j.axis = j.axis.map(|x| x * factor));
            let found = Case::new("", longer, case.base).inverse_dynamics(&state);
            let far = distance(&found, &tau, &torque_scale(case, &state));
            assert!(far <= tolerance, "times {factor}: {far} units of roundoff");
        }
    });
}

#[test]
fn a_reversed_axis_reverses_coordinate_rate_and_torque() {
    // A locked joint's coordinate is in the description, and a plane's directions have a rule of
    // their own.
    for_each_tree(60, Flavour { mimic: false, every_kind: false, locked: false, ..Flavour::ANY }, |case, random| {
        let state = case.state(random);
        let mut reversed = case.description.clone();
        reversed.joints.iter_mut().for_each(|j| j.axis = j.axis.map(|x| 0.0 - x));
        let single =
            |k: usize, of: fn(&articulated_core::model::JointInfo) -> (usize, usize)| case.model.joints().iter().any(|j| of(j) == (k, 1));
        let flip = |x: &[f64], of| x.iter().enumerate().map(|(k, x)| if single(k, of) { -x } else { *x }).collect::<Vec<f64>>();
        let other = State::new(flip(&state.q, |j| j.q), flip(&state.v, |j| j.v), flip(&state.a, |j| j.v));
        let found = Case::new("", reversed, case.base).inverse_dynamics(&other);
        let far = distance(&flip(&found, |j| j.v), &case.inverse_dynamics(&state), &torque_scale(case, &state));
        assert!(far <= FEW, "{far} units of roundoff");
    });
}

/// Rᵀ x, for the base's quaternion.
fn in_base_axes(q: &[f64], x: [f64; 3]) -> Vector3<f64> {
    from_quaternion([q[3], q[4], q[5], q[6]]).transpose() * Vector3::from(x)
}

#[test]
fn gravity_is_an_acceleration_of_a_floating_base_upward() {
    for seed in 0..60 {
        let gravity = Random::new(seed).three(10.0);
        let case = Case::new(format!("seed {seed}"), random_tree(seed, Flavour::ANY), Base::Floating).with_gravity(gravity);
        let mut state = case.state(&mut Random::new(seed));
        let (expected, scale) = (case.inverse_dynamics(&state), torque_scale(&case, &state));
        let up = in_base_axes(&state.q, gravity.map(|x| -x));
        (0..3).for_each(|k| state.a[3 + k] += up[k]);
        let found = case.clone().with_gravity([0.0; 3]).inverse_dynamics(&state);
        let far = distance(&found, &expected, &scale);
        assert!(far <= FEW, "seed {seed}: {far} units of roundoff");
    }
}

/// A fixed base is a floating one that is held: at the identity, at rest, with the same torques in
/// the joints.
#[test]
fn a_floating_base_at_rest_is_a_fixed_base() {
    for seed in 0..60 {
        let tree = random_tree(seed, Flavour::ANY);
        let fixed = Case::new("", tree.clone(), Base::Fixed);
        let floating = Case::new("", tree, Base::Floating);
        let state = fixed.state(&mut Random::new(seed));
        let before = |head: &[f64], x: &[f64]| [head, x].concat();
        let rest = [0.0; 6];
        let held = State::new(before(&[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0], &state.q), before(&rest, &state.v), before(&rest, &state.a));
        let far = distance(&floating.inverse_dynamics(&held)[6..], &fixed.inverse_dynamics(&state), &torque_scale(&fixed, &state));
        assert!(far <= FEW, "seed {seed}: {far} units of roundoff");
    }
}

#[test]
fn where_a_floating_base_is_and_how_it_heads_does_not_matter() {
    for_each_tree(60, Flavour::ANY, |case, random| {
        if case.base == Base::Fixed {
            return;
        }
        let state = case.state(random);
        let mut other = state.clone();
        other.q[..3].copy_from_slice(&[3.0, -5.0, 0.7]);
        // A turn about gravity: z(φ)·q
        let (s, c) = 0.4_f64.sin_cos();
        let [x, y, z, w] = [state.q[3], state.q[4], state.q[5], state.q[6]];
        other.q[3..7].copy_from_slice(&[c * x - s * y, c * y + s * x, c * z + s * w, c * w - s * z]);
        let far = distance(&case.inverse_dynamics(&other), &case.inverse_dynamics(&state), &torque_scale(case, &state));
        assert!(far <= FEW, "{far} units of roundoff");
    });
}

#[test]
fn opposite_quaternions_are_the_same_pose() {
    for_each_tree(20, Flavour::ANY, |case, random| {
        let state = case.state(random);
        let mut other = state.clone();
        for joint in case.model.joints().iter().filter(|j| j.q.1 == 7) {
            other.q[joint.q.0 + 3..joint.q.0 + 7].iter_mut().for_each(|x| *x = -*x);
        }
        assert_eq!(case.inverse_dynamics(&other), case.inverse_dynamics(&state));
    });
}

#[test]
fn half_turns_of_a_floating_base_are_as_good_as_any() {
    for_each_tree(20, Flavour::ANY, |case, random| {
        if case.base == Base::Fixed {
            return;
        }
        let mut state = case.state(random);
        for axis in 0..4 {
            (0..4).for_each(|k| state.q[3 + k] = if k == axis { 1.0 } else { 0.0 });
            let expected = case.motions().inverse_dynamics(&state.q, &state.v, &state.a);
            let far = distance(&case.inverse_dynamics(&state), &expected, &torque_scale(case, &state));
            assert!(far <= FEW, "quaternion {axis}: {far} units of roundoff");
        }
    });
}

/// The same tree with each universal joint as two joints in sequence on one body, rotations in
/// another form, and a frame that is no link in place of the last link.
fn in_sequence(tree: &Description) -> Description {
    let mut out = tree.clone();
    for k in 0..tree.joints.len() {
        let joint = &mut out.joints[JointId(k)];
        let matrix = joint.origin.rotation.matrix::<f64>();
        joint.origin.rotation = Rotation::Matrix([0, 1, 2].map(|i| [0, 1, 2].map(|j| matrix[(i, j)])));
        if joint.kind != JointKind::Universal {
            continue;
        }
        let first =
            Joint { name: format!("{}_1", joint.name), kind: JointKind::Continuous, child: LinkId(out.links.len()), ..joint.clone() };
        let second = Joint {
            name: format!("{}_2", joint.name),
            parent: LinkId(out.links.len()),
            origin: Origin::default(),
            axis: joint.second_axis,
            locked: joint.locked.as_ref().map(|at| vec![at[1]]),
            kind: JointKind::Continuous,
            ..joint.clone()
        };
        out.links.push(Link { name: first.name.clone(), intermediate: true, ..Link::default() });
        out.joints[JointId(k)] = Joint { locked: first.locked.as_ref().map(|at| vec![at[0]]), ..first };
        out.joints.push(second);
    }
    out
}

/// Joints in sequence on a body are one joint of several degrees of freedom, for every function.
#[test]
fn a_universal_joint_is_two_joints_in_sequence() {
    let split = std::cell::Cell::new(0);
    for_each_tree(60, Flavour { mimic: false, ..Flavour::ANY }, |case, random| {
        let state = case.state(random);
        let mut tree = case.description.clone();
        let mut sequence = in_sequence(&tree);
        split.set(split.get() + sequence.joints.len() - tree.joints.len());
        // A link without mass behind a fixed joint is the same as a frame.
        let (link, origin) = (tree.links.len() - 1, Origin::new([0.1, -0.2, 0.3], [0.4, 1.2, -0.7]));
        let (name, child) = (String::from("site"), tree.links.len());
        tree.joints.push(Joint { name: name.clone(), parent: LinkId(link), child: LinkId(child), origin, ..Joint::default() });
        tree.links.push(Link { name: name.clone(), ..Link::default() });
        sequence.frames.push(Frame { name, link: LinkId(link), origin });
        let [one, other] = [tree, sequence].map(|tree| Case::new("", tree, case.base));
        let names = |case: &Case| case.model.frames().iter().map(|frame| frame.name.clone()).collect::<Vec<_>>();
        assert_eq!(names(&one), names(&other));
        let wrenches = vec![0.3; 6 * one.model.frames().len()];
        let state = State { wrenches, ..state };
        let massless = !one.model.massless_joints().is_empty();
        for row in functions::<f64>().iter().filter(|row| row.needs == Needs::Nothing || row.needs == Needs::MassMatrix && !massless) {
            let given: Vec<&[f64]> = row.takes.iter().map(|argument| state.argument(*argument)).collect();
            let (expected, found) = (one.call::<f64>(row.name, &given), other.call::<f64>(row.name, &given));
            let book = other.textbook::<f64>().call(row.name, &given).unwrap().unwrap();
            let largest = expected.iter().fold(1.0, |most: f64, x| most.max(x.abs()));
            for (k, x) in expected.iter().enumerate() {
                let near = |y: f64| (x - y).abs() <= 1e-9 * largest || x.is_nan() && y.is_nan();
                assert!(near(found[k]) && near(book[k]), "{} [{k}]: {x} {} {}", row.name, found[k], book[k]);
            }
        }
    });
    assert!(split.get() > 5, "only {}", split.get());
}

/// One free body obeys Newton and Euler about its centre of mass.
#[test]
fn a_free_body_obeys_newton_and_euler() {
    let inertial = Inertial {
        mass: 2.0,
        inertia: [0.03, 0.0, 0.0, 0.04, 0.0, 0.05],
        ..Inertial { origin: Default::default(), mass: 0.0, inertia: [0.0; 6] }
    };
    let tree = Description {
        name: "body".into(),
        links: [Link { name: "body".into(), inertial: Some(inertial), ..Link::default() }].into(),
        joints: [].into(),
        frames: Vec::new(),
    };
    let case = Case::new("body", tree, Base::Floating);
    let state = case.state(&mut Random::new(5));
    let three = |x: &[f64], at: usize| Vector3::new(x[at], x[at + 1], x[at + 2]);
    let (w, v, dw, dv) = (three(&state.v, 0), three(&state.v, 3), three(&state.a, 0), three(&state.a, 3));
    let i = nalgebra::Matrix3::from_diagonal(&Vector3::new(0.03, 0.04, 0.05));
    let moment = i * dw + w.cross(&(i * w));
    let force = (dv + w.cross(&v) - in_base_axes(&state.q, case.gravity)) * 2.0;
    let expected: Vec<f64> = moment.iter().chain(force.iter()).copied().collect();
    let far = distance(&case.inverse_dynamics(&state), &expected, &torque_scale(&case, &state));
    assert!(far <= FEW, "{far} units of roundoff");
}

/// τ = Y π, T = y_T π and U = y_U π with the parameters of the links, on trees of any kind.
#[test]
fn regressors_times_the_parameters_of_links_are_torques_and_energies() {
    for_each_tree(30, Flavour::ANY, |case, random| {
        let broken = broken_laws(&case.description, &case.model, &case.state(random));
        assert!(broken.is_empty(), "{}", broken.join("\n"));
    });
}

/// The same tree with joints beside the origins of their links: between a joint and its link is an
/// intermediate link, to which the link is fixed.
fn beside(tree: &Description, random: &mut Random) -> Description {
    let mut out = tree.clone();
    for k in 0..tree.joints.len() {
        if out.joints[JointId(k)].kind.is_fixed() || random.below(3) == 0 {
            continue;
        }
        let (between, child) = (out.links.len(), out.joints[JointId(k)].child);
        out.links.push(Link { name: format!("between_{k}"), intermediate: true, ..Link::default() });
        out.joints[JointId(k)].child = LinkId(between);
        let origin = Origin::new(random.three(1.0), random.three(1.0));
        out.joints.push(Joint { name: format!("fixed_{k}"), parent: LinkId(between), child, origin, ..Joint::default() });
    }
    out
}

/// Results for each link are about the origin of the link and in its axes wherever its joint is,
/// and no link is left out.
#[test]
fn a_joint_may_lie_beside_the_origin_of_its_link() {
    let links = std::cell::Cell::new(0);
    for_each_tree(40, Flavour::ANY, |case, random| {
        let case = Case::new(case.name.clone(), beside(&case.description, random), case.base);
        let state = case.state(random);
        let broken = broken_laws(&case.description, &case.model, &state);
        assert!(broken.is_empty(), "{}", broken.join("\n"));
        let with_mass = case.model.bodies().iter().skip(1).enumerate().filter(|(_, body)| body.inertia.mass != 0.0);
        assert!(with_mass.clone().all(|(_, body)| body.link.is_some()));
        links.set(links.get() + with_mass.count());
        for row in functions::<f64>().iter().filter(|row| row.gives.contains(&Dim::Links)) {
            let given: Vec<&[f64]> = row.takes.iter().map(|argument| state.argument(*argument)).collect();
            let (found, expected) = (case.call::<f64>(row.name, &given), case.textbook::<f64>().call(row.name, &given).unwrap().unwrap());
            let largest = expected.iter().fold(1.0, |most: f64, x| most.max(x.abs()));
            assert_eq!(found.len(), expected.len(), "{}", row.name);
            for (k, (found, expected)) in found.iter().zip(&expected).enumerate() {
                assert!((found - expected).abs() <= 1e-11 * largest, "{} [{k}]: {found}, expected {expected}", row.name);
            }
        }
    });
    // A quarter of the trees has 86.
    assert!(links.get() > 70, "only {}", links.get());
}
