//! Base parameters: as many as the rank of the regressor of torques, and values that give the
//! robot's torques.

use articulated_core::algorithm::{Identifiability, Workspace, base_parameters, identifiable_parameters, torque_regressor};
use articulated_core::description::Base;
use articulated_core::effect::Effects;
use articulated_core::model::{Model, regroup};
use articulated_core::spatial::SpatialInertia;
use articulated_test_support::case::{Case, for_each_bundled, inverse_dynamics, read};
use articulated_test_support::random::Random;
use nalgebra::DMatrix;

/// The numeric rank of regressors at random states, one below the other, columns of unit length.
fn rank(case: &Case, random: &mut Random) -> usize {
    let model = &case.model;
    let width = 10 * model.links().count();
    let states = 3 * width / model.nv().max(1) + 20;
    let mut rows = Vec::new();
    for _ in 0..states {
        let state = case.state(random);
        let mut y = vec![0.0; model.nv() * width];
        torque_regressor(model, &mut Workspace::new(model), &state.q, &state.v, &state.a, &mut y);
        rows.extend(y);
    }
    let mut stacked = DMatrix::from_row_slice(states * model.nv(), width, &rows);
    stacked.column_iter_mut().filter(|c| c.norm() > 1e-12).for_each(|mut c| {
        c.normalize_mut();
    });
    let square = stacked.transpose() * stacked;
    // Singular values squared: dependent ones leave 10⁻¹⁵, others more than 10⁻⁹.
    square.symmetric_eigenvalues().iter().filter(|x| **x > 1e-12).count()
}

fn alone(model: &Model) -> usize {
    let found = base_parameters(&regroup(model.clone()));
    found.iter().flat_map(|body| &body.parameters).filter(|p| p.identifiability == Identifiability::Alone).count()
}

#[test]
fn as_many_parameters_of_bundled_robots_are_identifiable_as_the_regressor_has_ranks() {
    for_each_bundled(|case, random| {
        if case.model.nv() > 20 {
            return;
        }
        let expected = rank(case, random);
        assert_eq!([identifiable_parameters(&case.model), alone(&case.model)], [expected; 2], "{}", case.name);
    });
}

/// Joints of several stages, and many bodies on one coordinate.
#[test]
fn as_many_are_identifiable_as_the_regressor_has_ranks_whatever_the_joints() {
    let inertial = "<inertial><origin xyz='0.1 0.2 -0.1'/><mass value='1.5'/>\
                    <inertia ixx='0.2' ixy='0.01' ixz='-0.02' iyy='0.3' iyz='0.03' izz='0.25'/></inertial>";
    let link = |k: usize| format!("<link name='l{k}'>{inertial}</link>");
    let joint = |k: usize, kind: &str, rest: &str| {
        format!(
            "<joint name='j{k}' type='{kind}'><parent link='l{}'/><child link='l{k}'/>\
             <origin xyz='0.3 -0.1 0.2' rpy='0.4 -0.7 1.1'/>{rest}</joint>",
            k - 1
        )
    };
    let two = "<axis xyz='1 0 0'/><axis2 xyz='0 1 0'/>";
    let follows = "<axis xyz='0 1 2'/><mimic joint='j1' multiplier='-1.9' offset='0.2'/>";
    let followers = vec![joint(1, "continuous", "<axis xyz='0 0 1'/>"), joint(2, "continuous", follows), joint(3, "floating", "")];
    for (joints, base, identifiable) in [
        (vec![joint(1, "universal", two)], Base::Fixed, 9),
        (vec![joint(1, "planar", "<axis xyz='0 0 1'/>")], Base::Fixed, 4),
        (vec![joint(1, "planar", "<axis xyz='1 2 0'/>")], Base::Floating, 19),
        (vec![joint(1, "spherical", "")], Base::Fixed, 9),
        (followers, Base::Fixed, 19),
    ] {
        let links: String = (0..=joints.len()).map(link).collect();
        let urdf = format!("<robot name='r'>{links}{}</robot>", joints.concat());
        let case = Case::new("r", read(&urdf), base);
        let found = [identifiable_parameters(&case.model), rank(&case, &mut Random::new(7))];
        assert_eq!(found, [identifiable; 2], "{urdf}");
    }
}

/// Torques are linear in the values that are listed, and those of the robot.
#[test]
fn bodies_of_the_listed_values_have_the_torques_of_the_robot() {
    for_each_bundled(|case, random| {
        let model = regroup(case.model.clone());
        let listed = base_parameters(&model);
        let model = model.changed(|parts| {
            for body in listed {
                let ten: [f64; 10] = std::array::from_fn(|k| body.parameters.iter().map(|p| p.value * p.direction[k]).sum());
                parts.bodies[body.body].inertia = SpatialInertia::from_parameters(ten);
                parts.bodies[body.body].effects = Effects::default();
            }
        });
        let state = case.state(random);
        let [found, expected] = [&model, &case.model].map(|model| inverse_dynamics(model, &state.q, &state.v, &state.a));
        let largest = expected.iter().fold(1.0, |most: f64, x| most.max(x.abs()));
        assert!(found.iter().zip(&expected).all(|(a, b)| (a - b).abs() < 1e-12 * largest), "{}: {found:?} {expected:?}", case.name);
    });
}
