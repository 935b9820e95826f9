//! Whole steps of time: from a state (q, v) and torques τ to the state after h seconds.
//!
//! Each method is written once over [`Scalar`]. With numbers it is a step of the library; with
//! symbols it is generated code, with batches and derivatives as any function. The torques are held
//! during the step. Effects of the scene act as in forward dynamics.
//!
//! [`steps`] is the table. Adding a method: its file here, its row in the table.

mod euler;
mod free;
mod rk4;
mod rollout;

use core::marker::PhantomData;

use crate::Scalar;
use crate::algorithm::registry::{Group, Inputs, Needs};
use crate::algorithm::{
    Argument, Dim, Function, FunctionId, Port, Variant, Workspace, always, articulated_body_with_wrenches, factorization,
    forward_dynamics_with_wrenches, nothing, untied,
};
use crate::model::Model;

pub use rollout::rollout;

/// The length of a step, s.
pub const H: Argument = Argument::new(&Port::new("h", &[], "s"));

const TAKES: &[Argument] = &[Argument::Q, Argument::V, Argument::Tau, H];

const GIVES: &[Port] =
    &[Port::configuration("q_next", "rad|m|unit quaternion, after the step"), Port::new("v_next", &[Dim::Nv], "rad/s|m/s, after the step")];

/// Forward dynamics with wrenches: one of its ways.
type Accelerate<S> = fn(&Model<S>, &mut Workspace<S>, &[S], &[S], &[S], &[S], &mut [S]);

/// What a step starts from.
struct Start<'a, S: 'static> {
    model: &'a Model<S>,
    q: &'a [S],
    v: &'a [S],
    tau: &'a [S],
    h: S,
    accelerate: Accelerate<S>,
}

impl<S: Scalar> Start<'_, S> {
    /// Accelerations in a state.
    fn acceleration(&self, ws: &mut Workspace<S>, q: &[S], v: &[S], out: &mut [S]) {
        (self.accelerate)(self.model, ws, q, v, self.tau, &[], out);
    }
}

/// A method: from where it starts to the next configuration and velocity.
type Method<S> = fn(&Start<'_, S>, &mut Workspace<S>, &mut [S], &mut [S]);

fn run<S: Scalar>(
    method: Method<S>,
    accelerate: Accelerate<S>,
    (model, ws): (&Model<S>, &mut Workspace<S>),
    inputs: &Inputs<'_, S>,
    out: &mut [S],
) {
    let [q, v, tau, h] = [Argument::Q, Argument::V, Argument::Tau, H].map(|argument| inputs.get(argument));
    let (q_next, v_next) = out.split_at_mut(model.nq);
    method(&Start { model, q, v, tau, h: h[0], accelerate }, ws, q_next, v_next);
}

macro_rules! steps {
    ($($name:ident: $method:path, [$($contains:ident),*], $summary:literal, $source:literal;)*) => {
        struct Steps<S>(PhantomData<S>);

        #[allow(non_upper_case_globals)]
        impl<S: Scalar> Steps<S> {
            $(const $name: Function<S> = Function {
                id: FunctionId::user,
                general: FunctionId::user,
                name: stringify!($name),
                summary: $summary,
                source: $source,
                takes: TAKES,
                gives: &[],
                outputs: GIVES,
                unit: "",
                group: Group::Steps,
                needs: Needs::MassMatrix,
                regrouped: true,
                contains: &[$(FunctionId::$contains),*],
                ways: &[
                    Variant {
                        name: "ABA",
                        applies: untied,
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

            const ROWS: &'static [Function<S>] = &[$(Self::$name),*];
        }
    };
}

steps! {
    step_semi_implicit_euler: euler::semi_implicit, [forward_dynamics_with_wrenches],
        "v + h a, then q with the new velocity; error of order 1",
        "Hairer, Lubich & Wanner, Geometric Numerical Integration, 2006, (I.1.9)";
    step_implicit_damping: euler::implicit_damping, [forward_dynamics_with_wrenches],
        "as step_semi_implicit_euler with (M + h D) a = τ − h(q, v), D the slopes of joint forces in the rates: MuJoCo's Euler",
        "Todorov, Erez & Tassa, IEEE/RSJ IROS 2012; MuJoCo documentation, Numerical integration";
    step_rk4: rk4::on_the_manifold,
        [forward_dynamics_with_wrenches, forward_dynamics_with_wrenches, forward_dynamics_with_wrenches, forward_dynamics_with_wrenches],
        "the classical method of four stages in step vectors of the manifold; error of order 4",
        "Hairer, Nørsett & Wanner 1993, Table II.1.2; Munthe-Kaas, BIT 38, 1998";
    step_rk4_mujoco: rk4::in_axes_of_the_parent,
        [forward_dynamics_with_wrenches, forward_dynamics_with_wrenches, forward_dynamics_with_wrenches, forward_dynamics_with_wrenches],
        "as step_rk4, with velocities of floating bases in axes of their parent: RK4 of MuJoCo 4; error of order 4",
        "MuJoCo documentation, Numerical integration; Munthe-Kaas, BIT 38, 1998";
}

/// All steps, as functions beside those of the table.
pub fn steps<S: Scalar>() -> &'static [Function<S>] {
    Steps::ROWS
}

/// The step called `name`.
pub fn step<S: Scalar>(name: &str) -> Option<&'static Function<S>> {
    steps().iter().find(|row| row.name == name)
}

/// The step that moves as an integrator of MuJoCo does, by its name in files.
pub fn step_of_mujoco(integrator: &str) -> Option<&'static str> {
    match integrator {
        "Euler" | "implicitfast" => Some("step_implicit_damping"),
        "RK4" => Some("step_rk4_mujoco"),
        _ => None,
    }
}
