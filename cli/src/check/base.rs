//! Base parameters: what joints can feel of the inertial parameters, and what model passes made of them.

use articulated_core::algorithm::{Argument, Workspace, inverse_dynamics};
use articulated_core::effect::Effects;
use articulated_core::joint::Joint;
use articulated_core::model::Model;
use articulated_core::model::pass::{model_passes, still};
use articulated_core::spatial::{Placement, SpatialInertia};
use serde::Serialize;

use crate::states::{State, random};

/// Beyond this many bodies nobody reads the list, and finding what can be identified takes the cube of them.
const MANY: usize = 60;

/// A column that others leave less than this of depends on them.
const DEPENDS: f64 = 1e-7;

/// The inertial parameters of the moving bodies after regrouping.
#[derive(Clone, Debug, Default, Serialize)]
pub(super) struct Base {
    /// Ten for each moving link.
    pub(super) parameters: usize,
    /// Whether joints of several stages (planar, universal) have bodies between that are no links: what is listed of these is of the links beyond, and not all independent.
    pub(super) stages: bool,
    /// How many are not zero by regrouping, and how many of those joint torques determine.
    pub(super) regrouped: usize,
    pub(super) identifiable: usize,
    /// Fixed and locked joints, whose links are part of the body they are fixed to.
    pub(super) merged_joints: usize,
    /// From the tips inward: each is determined by torques when those before it are known.
    pub(super) joints: Vec<BaseRow>,
}

#[derive(Clone, Debug, Serialize)]
pub(super) struct BaseRow {
    pub(super) joint: String,
    /// m, by which the frame of the joint was slid, in its axes (z along the joint).
    pub(super) slid: [f64; 3],
    /// rad, by which it was turned about the joint.
    pub(super) turned: f64,
    /// Whether the body is the same from all sides, so that no torque depends on the joint's angle.
    pub(super) round: bool,
    /// What is left to the body; the rest is its parent's.
    pub(super) parameters: Vec<Parameter>,
}

/// A parameter about the slid frame, in axes of the joint.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Parameter {
    pub(super) name: &'static str,
    /// kg, kg·m or kg·m².
    pub(super) value: f64,
    pub(super) felt: Felt,
}

/// What torques tell of a parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Felt {
    Alone,
    /// Only a combination with parameters that come before it.
    WithOthers,
    Never,
}

/// m, h, and I_xx, I_xy, I_xz, I_yy, I_yz, I_zz, as [`SpatialInertia::parameters`] has them.
type Ten = [f64; 10];

/// A name and what one unit of it is in the ten; a revolute body has Σ_zz = 0, which ties I_xx and I_yy to I_zz.
type Unit = (&'static str, Ten);

const fn unit(k: usize) -> Ten {
    let mut ten = [0.0; 10];
    ten[k] = 1.0;
    ten
}

const REVOLUTE: &[Unit] = &[
    ("h_x", unit(1)),
    ("h_y", unit(2)),
    ("I_xx−I_yy", [0.0, 0.0, 0.0, 0.0, 0.5, 0.0, 0.0, -0.5, 0.0, 0.0]),
    ("I_xy", unit(5)),
    ("I_xz", unit(6)),
    ("I_yz", unit(8)),
    ("I_zz", [0.0, 0.0, 0.0, 0.0, 0.5, 0.0, 0.0, 0.5, 0.0, 1.0]),
];
const ALL: &[Unit] = &[
    ("m", unit(0)),
    ("h_x", unit(1)),
    ("h_y", unit(2)),
    ("h_z", unit(3)),
    ("I_xx", unit(4)),
    ("I_xy", unit(5)),
    ("I_xz", unit(6)),
    ("I_yy", unit(7)),
    ("I_yz", unit(8)),
    ("I_zz", unit(9)),
];

/// What regrouping leaves to a body.
fn units(joint: Joint) -> &'static [Unit] {
    match joint {
        Joint::Revolute => REVOLUTE,
        Joint::Prismatic => &ALL[..4],
        Joint::Spherical => &ALL[1..],
        Joint::Helical | Joint::Floating => ALL,
    }
}

impl Base {
    /// Of a model as it was read; nothing for a model of very many bodies.
    pub(super) fn of(read: &Model<f64>) -> Option<Self> {
        if read.bodies.len() > MANY {
            return None;
        }
        let passed = model_passes::<f64>().iter().fold(read.clone(), |model, (_, pass, _)| pass(model));
        let without_frames = Model { frames: Vec::new(), ..passed.clone() };
        let stilled = still(without_frames);
        let round = |i: usize| stilled.bodies[i].coordinates.turns == 0.0;
        let mut joints: Vec<BaseRow> = passed.inward().map(|i| row(i, read, &passed, round(i))).collect();
        let columns = columns(&passed);
        let felt = felt(&columns);
        joints.iter_mut().flat_map(|j| &mut j.parameters).zip(&felt).for_each(|(p, felt)| p.felt = *felt);
        let alone = |felt: &[Felt]| felt.iter().filter(|f| **f == Felt::Alone).count();
        let (links, stages) = (read.links().count(), read.links().count() < joints.len());
        Some(Self {
            parameters: 10 * links,
            stages,
            regrouped: felt.len(),
            identifiable: if stages { alone(&self::felt(&columns_of(read, |i| ten_of_link(read, i)))) } else { alone(&felt) },
            merged_joints: 0,
            joints,
        })
    }
}

fn row(i: usize, read: &Model<f64>, passed: &Model<f64>, round: bool) -> BaseRow {
    let body = &passed.bodies[i];
    let ten = body.inertia.parameters();
    let value = |(name, _): &Unit| match *name {
        "I_xx−I_yy" => ten[4] - ten[7],
        name => ALL.iter().position(|(other, _)| *other == name).map_or(0.0, |k| ten[k]),
    };
    let parameters = units(body.joint).iter().map(|u| Parameter { name: u.0, value: value(u), felt: Felt::Never }).collect();
    let frame = read.frames.iter().position(|f| f.body == i);
    // x_read,passed of the body's frame, from where it has a link.
    let moved = frame.map_or_else(Placement::identity, |k| {
        let (before, after) = (&read.frames[k].placement, &passed.frames[k].placement);
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

/// All ten of a link, none of a stage between.
fn ten_of_link(model: &Model<f64>, i: usize) -> &'static [Unit] {
    if model.bodies[i].link.is_some() { ALL } else { &[] }
}

/// For each parameter that regrouping leaves, the torques of one unit of it alone, over a number of states.
fn columns(model: &Model<f64>) -> Vec<Vec<f64>> {
    columns_of(model, |i| units(model.bodies[i].joint))
}

/// So many states that the parameters of the bodies on one coordinate, which may be seen in its torque alone, can be told apart.
fn states_for(model: &Model<f64>, units: &impl Fn(usize) -> &'static [Unit]) -> usize {
    let mut on_coordinate = vec![0; model.nv];
    model.outward().for_each(|i| on_coordinate[model.bodies[i].coordinates.v] += units(i).len());
    let all: usize = on_coordinate.iter().sum();
    on_coordinate.into_iter().max().unwrap_or(0).max(2 * all / model.nv.max(1)) + 2
}

/// The same for these parameters of each body.
fn columns_of(model: &Model<f64>, units: impl Fn(usize) -> &'static [Unit]) -> Vec<Vec<f64>> {
    let mut weightless = model.clone();
    // What springs, drag and rotors do is not theirs.
    weightless.bodies.iter_mut().for_each(|b| (b.inertia, b.effects) = (SpatialInertia::zero(), Effects::default()));
    let states = random(model, states_for(model, &units), 1);
    let mut ws = Workspace::new(model);
    let mut columns = Vec::new();
    for i in model.inward() {
        for (_, unit) in units(i) {
            weightless.bodies[i].inertia = SpatialInertia::from_parameters(*unit);
            columns.push(states.iter().flat_map(|state| torques(&weightless, &mut ws, state)).collect());
        }
        weightless.bodies[i].inertia = SpatialInertia::zero();
    }
    columns
}

fn torques(model: &Model<f64>, ws: &mut Workspace<f64>, state: &State) -> Vec<f64> {
    let [q, v, a] = [Argument::Q, Argument::V, Argument::A].map(|x| state.get(x).unwrap_or_default());
    let mut tau = vec![0.0; model.nv];
    inverse_dynamics(model, ws, q, v, a, &mut tau);
    tau
}

/// Which columns are independent of those before them (modified Gram–Schmidt, each column of unit length).
fn felt(columns: &[Vec<f64>]) -> Vec<Felt> {
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let largest = columns.iter().map(|c| dot(c, c).sqrt()).fold(0.0, f64::max);
    let mut basis: Vec<Vec<f64>> = Vec::new();
    let mut one = |column: &Vec<f64>| {
        let length = dot(column, column).sqrt();
        if length <= f64::EPSILON * largest {
            return Felt::Never;
        }
        let mut rest: Vec<f64> = column.iter().map(|x| x / length).collect();
        for b in &basis {
            let along = dot(&rest, b);
            rest.iter_mut().zip(b).for_each(|(x, b)| *x -= along * b);
        }
        let left = dot(&rest, &rest).sqrt();
        if left <= DEPENDS {
            return Felt::WithOthers;
        }
        rest.iter_mut().for_each(|x| *x /= left);
        basis.push(rest);
        Felt::Alone
    };
    columns.iter().map(&mut one).collect()
}

#[cfg(test)]
mod tests {
    use articulated_core::description::Base as Stand;

    use super::*;
    use crate::robot::bundled_model;

    fn base(robot: &str) -> Base {
        Base::of(&bundled_model(robot)).unwrap()
    }

    /// 43: Gaz, Cognetti, Oliva, Robuffo Giordano & De Luca, IEEE RA-L 4, 2019. Of the first link only I_zz.
    #[test]
    fn of_the_panda_43_parameters_are_identifiable() {
        let panda = base("panda_like");
        assert_eq!([panda.parameters, panda.regrouped, panda.identifiable], [70, 49, 43]);
        let first = panda.joints.last().unwrap();
        let alone: Vec<&str> = first.parameters.iter().filter(|p| p.felt == Felt::Alone).map(|p| p.name).collect();
        assert_eq!((first.joint.as_str(), alone.as_slice()), ("joint_1", ["I_zz"].as_slice()));
        assert!(panda.joints.iter().any(|j| j.slid != [0.0; 3]));
    }

    /// As many as the torque regressor has independent columns: with joints of several stages, and with many bodies on one coordinate.
    #[test]
    fn as_many_are_identifiable_as_the_regressor_has_ranks() {
        let inertial = "<inertial><origin xyz='0.1 0.2 -0.1'/><mass value='1.5'/><inertia ixx='0.2' ixy='0.01' ixz='-0.02' iyy='0.3' iyz='0.03' izz='0.25'/></inertial>";
        let link = |k: usize| format!("<link name='l{k}'>{inertial}</link>");
        let joint = |k: usize, kind: &str, rest: &str| {
            format!(
                "<joint name='j{k}' type='{kind}'><parent link='l{}'/><child link='l{k}'/><origin xyz='0.3 -0.1 0.2' rpy='0.4 -0.7 1.1'/>{rest}</joint>",
                k - 1
            )
        };
        let two = "<axis xyz='1 0 0'/><axis2 xyz='0 1 0'/>";
        let follows = "<axis xyz='0 1 2'/><mimic joint='j1' multiplier='-1.9' offset='0.2'/>";
        for (joints, base, identifiable) in [
            (vec![joint(1, "universal", two)], Stand::Fixed, 9),
            (vec![joint(1, "planar", "<axis xyz='0 0 1'/>")], Stand::Fixed, 4),
            (vec![joint(1, "planar", "<axis xyz='1 2 0'/>")], Stand::Floating, 19),
            (
                vec![joint(1, "continuous", "<axis xyz='0 0 1'/>"), joint(2, "continuous", follows), joint(3, "floating", "")],
                Stand::Fixed,
                19,
            ),
        ] {
            let links: String = (0..=joints.len()).map(link).collect();
            let urdf = format!("<robot name='r'>{links}{}</robot>", joints.concat());
            let model = articulated::load_bytes("r.urdf", urdf.as_bytes(), base).unwrap();
            let mut ws = Workspace::new(&model);
            let width = 10 * model.links().count();
            let mut columns = vec![Vec::new(); width];
            for state in random(&model, 80, 3) {
                let [q, v, a] = [Argument::Q, Argument::V, Argument::A].map(|x| state.get(x).unwrap());
                let mut y = vec![0.0; model.nv * width];
                articulated_core::algorithm::torque_regressor(&model, &mut ws, q, v, a, &mut y);
                y.chunks(width).for_each(|row| columns.iter_mut().zip(row).for_each(|(column, x)| column.push(*x)));
            }
            let rank = felt(&columns).iter().filter(|f| **f == Felt::Alone).count();
            assert_eq!((self::Base::of(&model).unwrap().identifiable, rank), (identifiable, identifiable), "{urdf}");
        }
    }

    #[test]
    fn the_last_link_of_an_arm_is_round_and_no_other() {
        let round: Vec<String> = base("ur5_like").joints.into_iter().filter(|j| j.round).map(|j| j.joint).collect();
        assert_eq!(round, ["wrist_3_joint"]);
    }

    /// A floating base feels everything that regrouping leaves.
    #[test]
    fn a_floating_base_leaves_nothing_in_the_dark() {
        let quadruped = base("quadruped");
        assert_eq!([quadruped.parameters, quadruped.regrouped, quadruped.identifiable], [130, 10 + 12 * 7, 10 + 12 * 7]);
    }

    /// The regrouped values are those that torques show: what the passes left gives the same torques as what was read.
    #[test]
    fn torques_are_linear_in_the_values_that_are_listed() {
        let read = bundled_model("ur5_like");
        let passed = model_passes::<f64>().iter().fold(read.clone(), |model, (_, pass, _)| pass(model));
        let values: Vec<f64> = Base::of(&read).unwrap().joints.iter().flat_map(|j| &j.parameters).map(|p| p.value).collect();
        let columns = columns(&passed);
        let states = random(&passed, 2, 1);
        for (s, state) in states.iter().enumerate() {
            let expected = torques(&read, &mut Workspace::new(&read), state);
            for (l, tau) in expected.iter().enumerate() {
                let sum: f64 = columns.iter().zip(&values).map(|(c, x)| c[s * read.nv + l] * x).sum();
                assert!((sum - tau).abs() < 1e-12 * (1.0 + tau.abs()), "{sum} {tau}");
            }
        }
    }

    /// The axis of the second leans in the plane across the first, which is turned until that has a zero.
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
