//! States in MuJoCo's conventions: q and v here, `qpos` and `qvel` there.
//!
//! ```text
//! free joint: qpos = (p, w, x, y, z),   qvel = (ṗ in axes of the parent, ω in axes of the body)
//! ball joint: qpos = (w, x, y, z),      qvel = ω in axes of the child
//! ```
//!
//! Here quaternions are (x, y, z, w), and the rates of a free joint its body twist (ω, v). All
//! other joints are the same. Joints that follow others, and locked ones, have no coordinates here.

use super::{Rows, Steps, free};
use crate::Scalar;
use crate::algorithm::manifold::Space;
use crate::algorithm::registry::{Group, Inputs, Needs};
use crate::algorithm::{Argument, Dim, Function, FunctionId, Port, Variant, always, nothing};
use crate::model::Model;

/// Positions in MuJoCo's conventions.
pub const QPOS: Argument = Argument::new(&QPOS_PORT);
/// Rates in MuJoCo's conventions.
pub const QVEL: Argument = Argument::new(&QVEL_PORT);

const QPOS_PORT: Port = Port::new("qpos", &[Dim::Nq], "rad|m|unit quaternion w x y z, MuJoCo's");
const QVEL_PORT: Port = Port::new("qvel", &[Dim::Nv], "rad/s|m/s, MuJoCo's");
const SOURCE: &str = "MuJoCo documentation, Computation: general framework; Programming: simulation";

#[allow(non_upper_case_globals)]
impl<S: Scalar> Steps<S> {
    const mujoco_state: Function<S> = Function {
        name: "mujoco_state",
        summary: "qpos and qvel of MuJoCo for a state: the order of quaternions, and the rates of free joints",
        takes: &[Argument::Q, Argument::V],
        outputs: &[QPOS_PORT, QVEL_PORT],
        ways: &[Variant { name: "direct", applies: always, least: nothing, run: &|model, _, inputs, out| to_mujoco(model, inputs, out) }],
        ..Self::EXCHANGE
    };
    const state_of_mujoco: Function<S> = Function {
        name: "state_of_mujoco",
        summary: "the state of qpos and qvel of MuJoCo; the inverse of mujoco_state",
        takes: &[QPOS, QVEL],
        outputs: &[Port::configuration("q", "rad|m|unit quaternion"), Port::new("v", &[Dim::Nv], "rad/s|m/s")],
        ways: &[Variant { name: "direct", applies: always, least: nothing, run: &|model, _, inputs, out| of_mujoco(model, inputs, out) }],
        ..Self::EXCHANGE
    };

    const EXCHANGE: Function<S> = Function {
        id: FunctionId::user,
        general: FunctionId::user,
        name: "",
        summary: "",
        source: SOURCE,
        takes: &[],
        gives: &[],
        outputs: &[],
        unit: "",
        group: Group::Mujoco,
        needs: Needs::Nothing,
        regrouped: false,
        contains: &[],
        ways: &[],
        unsolved: None,
    };

    pub(super) const EXCHANGES: Rows<S> = &[Self::mujoco_state, Self::state_of_mujoco];
}

/// For each joint with a quaternion, where that begins in q, and, of a free joint, its place in v.
fn quaternions<S: Scalar>(model: &Model<S>) -> impl Iterator<Item = (usize, Option<usize>)> + '_ {
    model.joints.iter().filter_map(|joint| match Space::of(joint.kind) {
        Space::Placements => Some((joint.q.0 + 3, Some(joint.v.0))),
        Space::Rotations => Some((joint.q.0, None)),
        Space::Numbers => None,
    })
}

fn to_mujoco<S: Scalar>(model: &Model<S>, inputs: &Inputs<'_, S>, out: &mut [S]) {
    let [q, v] = [Argument::Q, Argument::V].map(|argument| inputs.get(argument));
    let (qpos, qvel) = out.split_at_mut(model.nq);
    qpos.copy_from_slice(q);
    qvel.copy_from_slice(&free::to_parent(model, q, v));
    for (at, rates) in quaternions(model) {
        qpos[at..at + 4].rotate_right(1);
        rates.into_iter().for_each(|first| qvel[first..first + 6].rotate_left(3));
    }
}

fn of_mujoco<S: Scalar>(model: &Model<S>, inputs: &Inputs<'_, S>, out: &mut [S]) {
    let [qpos, qvel] = [QPOS, QVEL].map(|argument| inputs.get(argument));
    let (q, v) = out.split_at_mut(model.nq);
    let mut rates = qvel.to_vec();
    q.copy_from_slice(qpos);
    for (at, own) in quaternions(model) {
        q[at..at + 4].rotate_left(1);
        own.into_iter().for_each(|first| rates[first..first + 6].rotate_left(3));
    }
    v.copy_from_slice(&free::to_body(model, q, &rates));
}
