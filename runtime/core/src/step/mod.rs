//! Whole steps of time: from a state (q, v) and torques τ, or controls of actuators, to the state
//! after h seconds.
//!
//! Each method is written once over [`Scalar`]. With numbers it is a step of the library; with
//! symbols it is generated code, with batches and derivatives as any function. Torques and controls
//! are held during the step. Effects of the scene act as in forward dynamics.
//!
//! [`of_group`] has the tables. Adding a method: its file here, its row in one of them.

mod constrained;
mod euler;
mod free;
mod implicit_velocity;
mod lie_midpoint;
mod mujoco;
mod rk4;
mod rollout;

use alloc::vec;
use alloc::vec::Vec;
use core::cell::RefCell;
use core::marker::PhantomData;
use core::mem;

use crate::Scalar;
use crate::algorithm::registry::{Group, Inputs, Needs};
use crate::algorithm::{
    Argument, Dim, Function, FunctionId, Port, Variant, Workspace, always, articulated_body_with_wrenches, factorization,
    forward_dynamics_with_wrenches, nothing, untied,
};
use crate::model::Model;

pub use mujoco::{QPOS, QVEL};
pub use rollout::{State, rollout};

/// The length of a step, s.
pub const H: Argument = Argument::new(&Port::new("h", &[], "s"));
/// Activations of the actuators that have one.
pub const ACT: Argument = Argument::new(&Port::new("act", &[Dim::Activations], "activation of each actuator that has one"));
/// Controls of the actuators.
pub const CTRL: Argument = Argument::new(&Port::new("ctrl", &[Dim::Controls], "control of each actuator, in its own unit"));

/// The acceleration with which a search of the one with constraints begins: that of the last step,
/// or zeros. It does not change the result but for roundings.
pub const WARM: Argument =
    Argument::new(&Port::new("warm", &[Dim::Nv], "rad/s²|m/s², where the search begins: `warm_next` of the last step, or 0"));

/// An acceleration with constraints that was found.
pub const FOUND: Argument = Argument::new(&Port::new("found", &[Dim::Nv], "rad/s²|m/s², `warm_next` of a step from this state"));

/// Contacts that a caller found: 1 or 0, the distance, m, the point, m, and the normal, in axes of
/// the world, from the first shape of the pair to the second.
pub const CONTACTS: Argument = Argument::new(&Port::new(
    "contacts",
    &[Dim::Given, Dim::Of(crate::constraint::GIVEN)],
    "1 or 0, distance, point, m, and normal, from the first shape to the second: of each given contact",
));

const WITH_CONTACTS_TAKES: &[Argument] = &[Argument::Q, Argument::V, ACT, CTRL, CONTACTS, WARM, H];

const TAKES: &[Argument] = &[Argument::Q, Argument::V, Argument::Tau, H];
const GIVES: &[Port] = &[Q_NEXT, V_NEXT];
const ACTUATED_TAKES: &[Argument] = &[Argument::Q, Argument::V, ACT, CTRL, H];
const ACTUATED_GIVES: &[Port] = &[Q_NEXT, V_NEXT, Port::new("act_next", &[Dim::Activations], "activations after the step")];

const CONSTRAINED_TAKES: &[Argument] = &[Argument::Q, Argument::V, ACT, CTRL, WARM, H];
const CONSTRAINED_GIVES: &[Port] = &[
    Q_NEXT,
    V_NEXT,
    Port::new("act_next", &[Dim::Activations], "activations after the step"),
    Port::new("warm_next", &[Dim::Nv], "rad/s²|m/s², `warm` of the next step"),
];

const Q_NEXT: Port = Port::configuration("q_next", "rad|m|unit quaternion, after the step");
const V_NEXT: Port = Port::new("v_next", &[Dim::Nv], "rad/s|m/s, after the step");

/// Forward dynamics with wrenches: one of its ways.
type Accelerate<S> = fn(&Model<S>, &mut Workspace<S>, &[S], &[S], &[S], &[S], &mut [S]);

/// Initial state and inputs of a step.
struct Start<'a, S: 'static> {
    model: &'a Model<S>,
    q: &'a [S],
    v: &'a [S],
    /// Activations; empty without actuators.
    act: &'a [S],
    drive: Drive<'a, S>,
    h: S,
    accelerate: Accelerate<S>,
    /// With constraints: the last acceleration, with which the next search begins.
    warm: Option<RefCell<Vec<S>>>,
    /// Contacts that a caller found, or empty.
    given: &'a [S],
}

/// Inputs, constant during a step.
enum Drive<'a, S> {
    /// Torques.
    Torques(&'a [S]),
    /// Controls of the actuators.
    Controls(&'a [S]),
}

impl<S: Scalar> Start<'_, S> {
    /// Inputs of the gains of actuators at these activations; none with torques.
    fn inputs(&self, act: &[S]) -> Vec<S> {
        match self.drive {
            Drive::Torques(_) => Vec::new(),
            Drive::Controls(ctrl) => self.model.actuators.inputs(act, ctrl, Some(self.h)),
        }
    }

    /// Accelerations in a state: (M + h D) a = τ − h(q, v), with h D as the workspace has it.
    fn acceleration(&self, ws: &mut Workspace<S>, (q, v, act): (&[S], &[S], &[S]), out: &mut [S]) {
        let mut tau = match self.drive {
            Drive::Torques(tau) => tau.to_vec(),
            Drive::Controls(_) => {
                let (mut tau, inputs) = (vec![S::zero(); self.model.nv], self.inputs(act));
                add_torques(self.model, ws, &inputs, (q, v), &mut tau);
                tau
            }
        };
        if let Some(warm) = &self.warm {
            let diagonal = (mem::take(&mut ws.diagonal), mem::take(&mut ws.coupled));
            (self.accelerate)(self.model, ws, q, v, &tau, &[], out);
            let forces = constrained::acceleration(self.model, ws, (q, v, self.given), &mut warm.borrow_mut(), out);
            (ws.diagonal, ws.coupled) = diagonal;
            if ws.diagonal.iter().all(Option::is_none) && ws.coupled.is_empty() {
                return;
            }
            tau.iter_mut().zip(forces).for_each(|(tau, force)| *tau += force);
        }
        free::act_on_origins(self.model, ws, v, &mut tau);
        (self.accelerate)(self.model, ws, q, v, &tau, &[], out);
    }

    /// The activations at the end of the step, at these rates.
    fn advance_activations(&self, rates: &[S], end: &mut End<'_, S>) {
        end.act.copy_from_slice(&self.model.actuators.next_activations(self.act, rates, self.h));
    }

    /// Rates of the activations.
    fn activation_rates(&self, act: &[S]) -> Vec<S> {
        match self.drive {
            Drive::Torques(_) => Vec::new(),
            Drive::Controls(ctrl) => self.model.actuators.activation_rates(act, ctrl),
        }
    }
}

/// Final state of a step.
struct End<'a, S> {
    q: &'a mut [S],
    v: &'a mut [S],
    /// Activations; empty without actuators.
    act: &'a mut [S],
}

/// A method: from where it starts to where it ends.
type Method<S> = fn(&Start<'_, S>, &mut Workspace<S>, &mut End<'_, S>);

fn run<S: Scalar>(
    method: Method<S>,
    accelerate: Accelerate<S>,
    (model, ws): (&Model<S>, &mut Workspace<S>),
    inputs: &Inputs<'_, S>,
    out: &mut [S],
) {
    let [q, v, h] = [Argument::Q, Argument::V, H].map(|argument| inputs.get(argument));
    let (q_next, rest) = out.split_at_mut(model.nq);
    let (v_next, rest) = rest.split_at_mut(model.nv);
    let (act_next, warm_next) = rest.split_at_mut(inputs.get(ACT).len());
    // Functions with constraints have it.
    let warm = Some(inputs.get(WARM)).filter(|warm| !warm.is_empty()).map(|warm| RefCell::new(warm.to_vec()));
    // Torques are an argument, or the actuators have them.
    let (act, drive) = match inputs.get(Argument::Tau) {
        [] => (inputs.get(ACT), Drive::Controls(inputs.get(CTRL))),
        tau => (&[][..], Drive::Torques(tau)),
    };
    let mut end = End { q: q_next, v: v_next, act: act_next };
    let start = Start { model, q, v, act, drive, h: h[0], accelerate, warm, given: inputs.get(CONTACTS) };
    method(&start, ws, &mut end);
    if let Some(warm) = start.warm {
        warm_next.copy_from_slice(&warm.into_inner());
    }
}

macro_rules! steps {
    ($list:ident, $group:ident, $takes:ident, $gives:ident, [$($first:ident)*];
     $($name:ident: $method:path, $applies:path, [$($contains:ident),*], $summary:literal, $source:literal;)*) => {
        #[allow(non_upper_case_globals)]
        impl<S: Scalar> Steps<S> {
            $(const $name: Function<S> = Function {
                id: FunctionId::user,
                general: FunctionId::user,
                name: stringify!($name),
                summary: $summary,
                source: $source,
                takes: $takes,
                gives: &[],
                outputs: $gives,
                unit: "",
                group: Group::$group,
                needs: Needs::MassMatrix,
                // Passes of models move frames of bodies, and not the shapes in them.
                regrouped: !matches!(Group::$group, Group::Constraints | Group::GivenContacts),
                contains: &[$(FunctionId::$contains),*],
                ways: &[
                    Variant {
                        name: "ABA",
                        applies: $applies,
                        least: nothing,
                        run: &|model, ws, inputs, out| run($method, articulated_body_with_wrenches, (model, ws), inputs, out),
                    },
                    Variant {
                        name: "LTDL",
                        applies: always,
                        least: factorization,
                        run: &|model, ws, inputs, out| run($method, forward_dynamics_with_wrenches, (model, ws), inputs, out),
                    },
                ],
                unsolved: None,
            };)*

            const $list: &'static [Function<S>] = &[$(Self::$first,)* $(Self::$name),*];
        }
    };
}

struct Steps<S>(PhantomData<S>);

type Rows<S> = &'static [Function<S>];

steps! { ROWS, Steps, TAKES, GIVES, [];
    step_semi_implicit_euler: euler::semi_implicit, untied, [forward_dynamics_with_wrenches],
        "v + h a, then q with the new velocity; error of order 1",
        "Hairer, Lubich & Wanner, Geometric Numerical Integration, 2006, (I.1.9)";
    step_implicit_damping: euler::implicit_damping, untied, [forward_dynamics_with_wrenches],
        "as step_semi_implicit_euler with (M + h D) a = τ − h(q, v), D the slopes of joint forces in the rates: MuJoCo's Euler",
        "Todorov, Erez & Tassa, IEEE/RSJ IROS 2012; MuJoCo documentation, Numerical integration";
    step_implicit_velocity: implicit_velocity::implicit_velocity, solved_at_once, [forward_dynamics_with_wrenches],
        "as step_implicit_damping, D with the slopes of box_drag and ellipsoid_drag too, and gyroscopic forces of bodies that float alone: MuJoCo's implicitfast",
        "MuJoCo documentation, Numerical integration";
    step_lie_midpoint: lie_midpoint::lie_midpoint, untied, [forward_dynamics_with_wrenches, forward_dynamics_with_wrenches],
        "the implicit midpoint rule on the manifold: symmetric, keeps the momentum of a free body; error of order 2",
        "Simo & Wong, Int. J. Numer. Methods Eng. 31, 1991; Hairer, Lubich & Wanner 2006, §IV.8";
    step_rk4: rk4::on_the_manifold, untied,
        [forward_dynamics_with_wrenches, forward_dynamics_with_wrenches, forward_dynamics_with_wrenches, forward_dynamics_with_wrenches],
        "the classical method of four stages in step vectors of the manifold; error of order 4",
        "Hairer, Nørsett & Wanner 1993, Table II.1.2; Munthe-Kaas, BIT 38, 1998";
    step_rk4_mujoco: rk4::in_axes_of_the_parent, untied,
        [forward_dynamics_with_wrenches, forward_dynamics_with_wrenches, forward_dynamics_with_wrenches, forward_dynamics_with_wrenches],
        "as step_rk4, with velocities of floating bases in axes of their parent: RK4 of MuJoCo 4; error of order 4",
        "MuJoCo documentation, Numerical integration; Munthe-Kaas, BIT 38, 1998";
}

steps! { OF_ACTUATORS, Actuators, ACTUATED_TAKES, ACTUATED_GIVES, [actuator_torques];
    actuated_step_semi_implicit_euler: euler::semi_implicit, untied, [forward_dynamics_with_wrenches],
        "step_semi_implicit_euler with the forces of actuators, and of springs and dampers of tendons, at held controls",
        "MuJoCo documentation, Actuation model";
    actuated_step_implicit_damping: euler::implicit_damping, untied, [forward_dynamics_with_wrenches],
        "step_implicit_damping with actuators at held controls: MuJoCo's Euler",
        "MuJoCo documentation, Actuation model; Numerical integration";
    actuated_step_implicit_velocity: implicit_velocity::implicit_velocity, solved_at_once, [forward_dynamics_with_wrenches],
        "as actuated_step_implicit_damping, D with the slopes of actuators and tendons too: MuJoCo's implicitfast",
        "MuJoCo documentation, Actuation model; Numerical integration";
    actuated_step_lie_midpoint: lie_midpoint::lie_midpoint, untied, [forward_dynamics_with_wrenches, forward_dynamics_with_wrenches],
        "step_lie_midpoint with actuators at held controls",
        "MuJoCo documentation, Actuation model; Simo & Wong, Int. J. Numer. Methods Eng. 31, 1991";
    actuated_step_rk4: rk4::on_the_manifold, untied,
        [forward_dynamics_with_wrenches, forward_dynamics_with_wrenches, forward_dynamics_with_wrenches, forward_dynamics_with_wrenches],
        "step_rk4 with actuators at held controls",
        "MuJoCo documentation, Actuation model; Munthe-Kaas, BIT 38, 1998";
    actuated_step_rk4_mujoco: rk4::in_axes_of_the_parent, untied,
        [forward_dynamics_with_wrenches, forward_dynamics_with_wrenches, forward_dynamics_with_wrenches, forward_dynamics_with_wrenches],
        "step_rk4_mujoco with actuators at held controls: RK4 of MuJoCo 4",
        "MuJoCo documentation, Actuation model; Numerical integration";
}

steps! { OF_CONSTRAINTS, Constraints, CONSTRAINED_TAKES, CONSTRAINED_GIVES, [constrained_acceleration constrained_search constrained_error contact_forces];
    constrained_step_semi_implicit_euler: euler::semi_implicit, untied, [forward_dynamics_with_wrenches],
        "actuated_step_semi_implicit_euler with limits, dry friction and contacts",
        "MuJoCo documentation, Computation: constraint model";
    constrained_step_implicit_damping: euler::implicit_damping, untied, [forward_dynamics_with_wrenches],
        "actuated_step_implicit_damping with limits, dry friction and contacts: MuJoCo's Euler",
        "MuJoCo documentation, Computation: constraint model; Numerical integration";
    constrained_step_implicit_velocity: implicit_velocity::implicit_velocity, solved_at_once, [forward_dynamics_with_wrenches],
        "actuated_step_implicit_velocity with limits, dry friction and contacts: MuJoCo's implicitfast",
        "MuJoCo documentation, Computation: constraint model; Numerical integration";
    constrained_step_rk4_mujoco: rk4::in_axes_of_the_parent, untied,
        [forward_dynamics_with_wrenches, forward_dynamics_with_wrenches, forward_dynamics_with_wrenches, forward_dynamics_with_wrenches],
        "actuated_step_rk4_mujoco with limits, dry friction and contacts: RK4 of MuJoCo 4",
        "MuJoCo documentation, Computation: constraint model; Numerical integration";
}

steps! { OF_CALLERS, GivenContacts, WITH_CONTACTS_TAKES, CONSTRAINED_GIVES, [constrained_acceleration_with_contacts contact_forces_with_contacts];
    constrained_step_semi_implicit_euler_with_contacts: euler::semi_implicit, untied, [forward_dynamics_with_wrenches],
        "constrained_step_semi_implicit_euler with contacts that a caller finds",
        "MuJoCo documentation, Computation: constraint model";
    constrained_step_implicit_damping_with_contacts: euler::implicit_damping, untied, [forward_dynamics_with_wrenches],
        "constrained_step_implicit_damping with contacts that a caller finds",
        "MuJoCo documentation, Computation: constraint model; Numerical integration";
    constrained_step_implicit_velocity_with_contacts: implicit_velocity::implicit_velocity, solved_at_once, [forward_dynamics_with_wrenches],
        "constrained_step_implicit_velocity with contacts that a caller finds",
        "MuJoCo documentation, Computation: constraint model; Numerical integration";
}

/// Whether one branch at a time can be solved: no joint follows another, and D has no entries
/// between degrees of freedom.
fn solved_at_once<S: Scalar>(model: &Model<S>) -> bool {
    untied(model) && !implicit_velocity::has_coupled_rates(model)
}

#[allow(non_upper_case_globals)]
impl<S: Scalar> Steps<S> {
    const actuator_torques: Function<S> = Function {
        id: FunctionId::user,
        general: FunctionId::user,
        name: "actuator_torques",
        summary: "torques of the actuators at these controls, and of springs and dampers of tendons",
        source: "MuJoCo documentation, Actuation model",
        takes: &[Argument::Q, Argument::V, ACT, CTRL],
        gives: &[Dim::Nv],
        outputs: &[],
        unit: "N·m|N",
        group: Group::Actuators,
        needs: Needs::Nothing,
        regrouped: false,
        contains: &[],
        ways: &[Variant {
            name: "direct",
            applies: always,
            least: nothing,
            run: &|model, ws, inputs, out| torques(model, ws, inputs, out),
        }],
        unsolved: None,
    };
}

/// Activations are those at the state, also of actuators whose force has the next one in a step.
fn torques<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, inputs: &Inputs<'_, S>, out: &mut [S]) {
    let [q, v, act, ctrl] = [Argument::Q, Argument::V, ACT, CTRL].map(|argument| inputs.get(argument));
    out.fill(S::zero());
    add_torques(model, ws, &model.actuators.inputs(act, ctrl, None), (q, v), out);
}

/// Adds the torques of all actuators at these inputs.
fn add_torques<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, inputs: &[S], (q, v): (&[S], &[S]), out: &mut [S]) {
    let rows = model.actuators.frame_rows(model, ws, q);
    model.actuators.add_all_torques(inputs, &rows, (q, v), out);
}

/// All steps with torques, as functions beside those of the table.
pub fn steps<S: Scalar>() -> &'static [Function<S>] {
    Steps::ROWS
}

/// Functions of robots with actuators: their torques, and steps with them.
pub fn of_actuators<S: Scalar>() -> &'static [Function<S>] {
    Steps::OF_ACTUATORS
}

/// Functions of robots with constraints: accelerations, and steps.
pub fn of_constraints<S: Scalar>() -> &'static [Function<S>] {
    Steps::OF_CONSTRAINTS
}

/// The same with contacts that a caller finds.
pub fn of_given_contacts<S: Scalar>() -> &'static [Function<S>] {
    Steps::OF_CALLERS
}

/// States in MuJoCo's conventions, and back.
pub fn exchanges<S: Scalar>() -> &'static [Function<S>] {
    Steps::EXCHANGES
}

/// The functions of a group of [`Group::BESIDE`]; none of another group.
pub fn of_group<S: Scalar>(group: Group) -> &'static [Function<S>] {
    match group {
        Group::Steps => steps(),
        Group::Actuators => of_actuators(),
        Group::Constraints => of_constraints(),
        Group::GivenContacts => of_given_contacts(),
        Group::Mujoco => exchanges(),
        _ => &[],
    }
}

/// All functions beside those of the table.
pub fn beside_the_table<S: Scalar>() -> impl Iterator<Item = &'static Function<S>> + Clone {
    Group::BESIDE.into_iter().flat_map(of_group)
}

/// The function beside those of the table called `name`.
pub fn step<S: Scalar>(name: &str) -> Option<&'static Function<S>> {
    beside_the_table().find(|row| row.name == name)
}

/// The order of a step: its error after a fixed time falls as this power of h.
pub fn order<S: Scalar>(step: &Function<S>) -> u32 {
    // Methods of one acceleration have order 1, of two order 2, of four order 4.
    step.contains.len() as u32
}
