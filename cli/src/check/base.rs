//! Base parameters: the inertial parameters that joint torques depend on, and their values after
//! model passes.

use articulated_codegen::model_pass::{View, drop_symmetric_rotation};
use articulated_core::algorithm::{BaseParameter, BodyParameters, Identifiability, base_parameters, identifiable_parameters};
use articulated_core::index::BodyId;
use articulated_core::model::Model;
use articulated_core::spatial::Placement;
use serde::Serialize;

/// Above this number of bodies the list is left out: it is unreadable, and its computation takes
/// cubic time.
const MANY: usize = 60;

/// The inertial parameters of the moving bodies after regrouping.
#[derive(Clone, Debug, Default, Serialize)]
pub(super) struct Base {
    /// Ten for each moving link.
    pub(super) parameters: usize,
    /// Whether joints of several stages (planar, universal) have intermediate bodies that are not
    /// links: parameters listed for these belong to the links beyond, and are not all independent.
    pub(super) stages: bool,
    /// How many are not zero by regrouping, and how many of those joint torques determine.
    pub(super) regrouped: usize,
    pub(super) identifiable: usize,
    /// Fixed and locked joints, whose links are part of the body they are fixed to.
    pub(super) merged_joints: usize,
    /// From the tips inward: torques determine each if the previous ones are known.
    pub(super) joints: Vec<BaseRow>,
}

#[derive(Clone, Debug, Serialize)]
pub(super) struct BaseRow {
    pub(super) joint: String,
    /// m, by which the frame of the joint was slid, in its axes (z along the joint).
    pub(super) slid: [f64; 3],
    /// rad, by which it was turned about the joint.
    pub(super) turned: f64,
    /// Whether the body is rotationally symmetric, so that no torque depends on the joint's angle.
    pub(super) round: bool,
    /// Remaining parameters of the body; the others are its parent's.
    pub(super) parameters: Vec<Parameter>,
}

/// A parameter about the slid frame, in axes of the joint.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Parameter {
    pub(super) name: &'static str,
    /// kg, kg·m or kg·m².
    pub(super) value: f64,
    pub(super) identifiable: Identifiable,
}

impl Parameter {
    fn of(found: &BaseParameter) -> Self {
        let identifiable = match found.identifiability {
            Identifiability::Alone => Identifiable::Alone,
            Identifiability::WithOthers => Identifiable::WithOthers,
            Identifiability::Never => Identifiable::Never,
        };
        Self { name: found.name, value: found.value, identifiable }
    }
}

/// Whether torques determine a parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Identifiable {
    Alone,
    /// Only a combination with parameters that come before it.
    WithOthers,
    Never,
}

impl Base {
    /// From a model as it was read; `None` for a model of very many bodies.
    pub(super) fn of(read: &Model<f64>) -> Option<Self> {
        if read.bodies().len() > MANY {
            return None;
        }
        let passed = View::new(read.clone()).passed().model;
        let without_frames = passed.clone().without_frames();
        let bare = drop_symmetric_rotation(View::new(without_frames));
        let round = |i: BodyId| !bare.rotates(i);
        let joints: Vec<BaseRow> = base_parameters(&passed).iter().map(|of| row(of, read, &passed, round(of.body))).collect();
        let (links, stages) = (read.links().count(), read.links().count() < joints.len());
        let all = || joints.iter().flat_map(|joint| &joint.parameters);
        let alone = || all().filter(|parameter| parameter.identifiable == Identifiable::Alone).count();
        let identifiable = if stages { identifiable_parameters(read) } else { alone() };
        Some(Self { parameters: 10 * links, stages, regrouped: all().count(), identifiable, merged_joints: 0, joints })
    }
}

fn row(of: &BodyParameters, read: &Model<f64>, passed: &Model<f64>, round: bool) -> BaseRow {
    let (i, body) = (of.body, &passed.bodies()[of.body]);
    let parameters = of.parameters.iter().map(Parameter::of).collect();
    let frame = read.frames().position(|f| f.body == i);
    // x_read,passed of the body's frame, from where it has a link.
    let moved = frame.map_or_else(Placement::identity, |k| {
        let (before, after) = (&read.frames()[k].placement, &passed.frames()[k].placement);
        let rotation = before.rotation * after.rotation.transpose();
        Placement { rotation, position: before.position - rotation * after.position }
    });
    let turned = moved.rotation.m21.atan2(moved.rotation.m11);
    BaseRow { joint: body.name.clone(), slid: tidy(moved.position.into()), turned: tidy([turned])[0], round, parameters }
}

/// Without rounding errors where frames stayed.
fn tidy<const N: usize>(x: [f64; N]) -> [f64; N] {
    x.map(|x| if x.abs() < 1e-14 { 0.0 } else { x })
}

#[cfg(test)]
mod tests {
    use articulated_core::description::Base as Stand;

    use super::*;
    use crate::robot::bundled_model;

    fn base(robot: &str) -> Base {
        Base::of(&bundled_model(robot)).unwrap()
    }

    /// 43: Gaz, Cognetti, Oliva, Robuffo Giordano & De Luca, IEEE RA-L 4, 2019. Of the first link
    /// only I_zz.
    #[test]
    fn of_the_panda_43_parameters_are_identifiable() {
        let panda = base("panda_like");
        assert_eq!([panda.parameters, panda.regrouped, panda.identifiable], [70, 49, 43]);
        let first = panda.joints.last().unwrap();
        let alone: Vec<&str> = first.parameters.iter().filter(|p| p.identifiable == Identifiable::Alone).map(|p| p.name).collect();
        assert_eq!((first.joint.as_str(), alone.as_slice()), ("joint_1", ["I_zz"].as_slice()));
        assert!(panda.joints.iter().any(|j| j.slid != [0.0; 3]));
    }

    #[test]
    fn the_last_link_of_an_arm_is_round_and_no_other() {
        let round: Vec<String> = base("ur5_like").joints.into_iter().filter(|j| j.round).map(|j| j.joint).collect();
        assert_eq!(round, ["wrist_3_joint"]);
    }

    /// For a floating base all parameters after regrouping are identifiable.
    #[test]
    fn a_floating_base_leaves_nothing_in_the_dark() {
        let quadruped = base("quadruped");
        assert_eq!([quadruped.parameters, quadruped.regrouped, quadruped.identifiable], [130, 10 + 12 * 7, 10 + 12 * 7]);
    }

    /// The axis of the second leans in the plane across the first, which is turned until that has a
    /// zero.
    #[test]
    fn a_joint_is_turned_by_the_angle_between_the_frames() {
        assert!(base("ur5_like").joints.iter().all(|joint| joint.turned == 0.0));
        let inertial = "<inertial><origin xyz='0.1 0.2 -0.1'/><mass value='1.5'/><inertia ixx='0.2' ixy='0.01' ixz='-0.02' iyy='0.3' iyz='0.03' izz='0.25'/></inertial>";
        let links = ["base", "a", "b"].map(|name| format!("<link name='{name}'>{inertial}</link>")).concat();
        let joints = [("first", "base", "a", "0 0 1"), ("second", "a", "b", "3 4 0")].map(|(name, parent, child, axis)| {
            format!("<joint name='{name}' type='continuous'><parent link='{parent}'/><child link='{child}'/><axis xyz='{axis}'/></joint>")
        });
        let urdf = format!("<robot name='r'>{links}{}</robot>", joints.concat());
        let turned = Base::of(&articulated::load_bytes("r.urdf", urdf.as_bytes(), Stand::Fixed).unwrap()).unwrap().joints[1].turned;
        let leaning = 4.0_f64.atan2(3.0);
        let expected = [leaning, leaning - std::f64::consts::FRAC_PI_2];
        assert!(expected.iter().any(|angle| (turned - angle).abs() < 1e-14), "{turned}");
    }
}
