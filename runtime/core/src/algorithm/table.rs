//! The one table of functions, from which the generator, the command line, the tests and the
//! documentation all read.
//!
//! Adding a function: its algorithm in a file, its row here. A row is
//!
//! ```text
//! name(arguments) -> [dimensions] "units", group, needs, regrouped?, "what it is", "algorithm and source";
//! ```
//!
//! with `by` and a list of ways if there are several (name, condition, lower bound of the cost,
//! algorithm, and its axes if not the usual), and `columns` if it has a part before M X = B is
//! solved.
//!
//! A preset is a row at zeros. It takes everything but its name, its arguments and its summary from
//! the row. An argument of the row that it does not list is zero: the algorithm gets an empty slice
//! for it, and leaves out what it can.
//!
//! ```text
//! name(arguments) = row, "what it is";
//! ```

use core::marker::PhantomData;

use super::argument::{argument, dims, documentation, place};
use super::registry::Inputs;
use super::workspace::near_the_middle;
#[allow(clippy::wildcard_imports)]
// Why: the rows name every algorithm.
use super::*;
use crate::Scalar;
use crate::model::Model;

/// Hands all rows to the macro `$then`.
macro_rules! for_each_function {
    ($then:ident) => {
        $then! {
            placements(q) -> [Frames, Of(12)] "rotation row by row, then position in m, in the world frame", Kinematics, Nothing, false,
                "placements of all frames in the world frame", "forward kinematics; Featherstone 2008, §4.4";
            twists_body(q, v) -> [Frames, Of(6)] "[ω; v], rad/s and m/s", Kinematics, Nothing, false,
                "twists of all frames, in their own axes about their own origins", "outward sweep; Lynch & Park 2017, §8.3";
            twists_world(q, v) -> [Frames, Of(6)] "[ω; v], rad/s and m/s", Kinematics, Nothing, false,
                "twists of all frames, in world axes about the world frame's origin", "outward sweep; Lynch & Park 2017, §8.3";
            twists_world_aligned(q, v) -> [Frames, Of(6)] "[ω; ṗ], rad/s and m/s", Kinematics, Nothing, false,
                "twists of all frames, in world axes about their own origins", "outward sweep; Lynch & Park 2017, §8.3";
            accelerations_body(q, v, a) -> [Frames, Of(6)] "rad/s² and m/s²", Kinematics, Nothing, false,
                "time derivatives of twists_body: spatial accelerations in body axes, gravity not added",
                "outward sweep; Featherstone 2008, §2.11";
            accelerations_world(q, v, a) -> [Frames, Of(6)] "rad/s² and m/s²", Kinematics, Nothing, false,
                "time derivatives of twists_world: spatial accelerations in world axes, gravity not added",
                "outward sweep; Featherstone 2008, §2.11";
            accelerations_world_aligned(q, v, a) -> [Frames, Of(6)] "[ω̇; p̈], rad/s² and m/s²", Kinematics, Nothing, false,
                "time derivatives of twists_world_aligned: the true accelerations of the origins, gravity not added",
                "outward sweep; Featherstone 2008, §2.11";
            jacobians_body(q) -> [Frames, Of(6), Nv] "rows [ω; v]", Kinematics, Nothing, false,
                "Jacobians of all frames: twists_body = J v", "columns Ad S; Lynch & Park 2017, §5.1";
            jacobians_world(q) -> [Frames, Of(6), Nv] "rows [ω; v]", Kinematics, Nothing, false,
                "Jacobians of all frames: twists_world = J v", "columns Ad S; Lynch & Park 2017, §5.1";
            jacobians_world_aligned(q) -> [Frames, Of(6), Nv] "rows [ω; ṗ]", Kinematics, Nothing, false,
                "Jacobians of all frames: twists_world_aligned = J v", "columns Ad S; Lynch & Park 2017, §5.1";
            jacobian_rates_body(q, v) -> [Frames, Of(6), Nv] "1/s and m/s", Kinematics, Nothing, false,
                "dJ/dt of jacobians_body", "columns ad V S; Featherstone 2008, §2.9";
            jacobian_rates_world(q, v) -> [Frames, Of(6), Nv] "1/s and m/s", Kinematics, Nothing, false,
                "dJ/dt of jacobians_world", "columns ad V S; Featherstone 2008, §2.9";
            jacobian_rates_world_aligned(q, v) -> [Frames, Of(6), Nv] "1/s and m/s", Kinematics, Nothing, false,
                "dJ/dt of jacobians_world_aligned", "columns ad V S; Featherstone 2008, §2.9";
            bias_accelerations_body(q, v) = accelerations_body, "dJ/dt·v of jacobians_body: accelerations at a = 0";
            bias_accelerations_world(q, v) = accelerations_world, "dJ/dt·v of jacobians_world: accelerations at a = 0";
            bias_accelerations_world_aligned(q, v) = accelerations_world_aligned,
                "dJ/dt·v of jacobians_world_aligned: accelerations at a = 0";
            placement_derivatives(q) -> [Frames, Of(12), Nv] "of rotation row by row, then position; 1 and m a unit step", Derivatives, Nothing, false,
                "∂(placements)/∂q in the tangent space", "columns [s]×R and s × p; Lynch & Park 2017, §5.1";
            inverse_dynamics(q, v, a) = inverse_dynamics_with_wrenches, "τ = M(q)·a + h(q, v), gravity included";
            inverse_dynamics_with_wrenches(q, v, a, wrenches) -> [Nv] "N·m|N", Dynamics, Nothing, true,
                "τ = M(q)·a + h(q, v) − Σ Jᵀw, with external wrenches w on the frames", "RNEA; Featherstone 2008, Table 5.1";
            joint_wrenches(q, v, a) -> [Links, Of(6)] "[m; f], N·m and N, in axes of the link about its origin", Dynamics, Nothing, false,
                "the wrench that each joint passes to its child link", "RNEA; Featherstone 2008, Table 5.1";
            bias_forces(q, v) = inverse_dynamics_with_wrenches, "h(q, v) = τ at a = 0: Coriolis, centrifugal and gravity forces";
            gravity_torque(q) = inverse_dynamics_with_wrenches, "g(q) = τ at v = a = 0: what holds the robot still";
            static_torque(q, wrenches) = inverse_dynamics_with_wrenches,
                "g(q) − Σ Jᵀw: what holds the robot still under external wrenches w on the frames";
            mass_matrix(q) -> [Nv, Nv] "kg·m²|kg·m|kg, symmetric", Dynamics, Nothing, true,
                "M(q)", "CRBA; Featherstone 2008, Table 6.2";
            coriolis_matrix(q, v) -> [Nv, Nv] "N·m·s|N·s|N·s/m", Dynamics, Nothing, true,
                "C(q, v) of the links alone, with C v + g = h without effects, and Ṁ − 2C skew: that of the Christoffel symbols",
                "Echeandia & Wensing, J. Comput. Nonlinear Dyn. 16, 2021",
                by ["", always, nothing, coriolis_matrix; "the axes of the first body", near_the_middle, nothing, coriolis_matrix in axes_of_first_bodies];
            forward_dynamics(q, v, tau) = forward_dynamics_with_wrenches, "a = M(q)⁻¹·(τ − h(q, v))";
            forward_dynamics_with_wrenches(q, v, tau, wrenches) -> [Nv] "rad/s²|m/s²", Dynamics, MassMatrix, true,
                "a = M(q)⁻¹·(τ + Σ Jᵀw − h(q, v)), with external wrenches w on the frames",
                "ABA, or RNEA, CRBA and M = Lᵀ D L; Featherstone 2008, Table 7.1 and §6.5",
                by ["ABA", untied, nothing, articulated_body_with_wrenches; "LTDL", always, factorization, forward_dynamics_with_wrenches];
            mass_matrix_inverse(q) -> [Nv, Nv] "1/(kg·m²)|…, symmetric", Dynamics, MassMatrix, true,
                "M(q)⁻¹", "M = Lᵀ D L; Featherstone 2008, §6.5";
            solve_mass_matrix(q, tau) -> [Nv] "rad/s²|m/s²", Dynamics, MassMatrix, true,
                "M(q)⁻¹·τ, without M⁻¹", "ABA at rest, or M = Lᵀ D L; Featherstone 2008, Table 7.1 and §6.5",
                by ["ABA", untied, nothing, solve_by_articulated_body; "LTDL", always, factorization, solve_mass_matrix];
            kinetic_energy(q, v) -> [] "J", Momentum, Nothing, true,
                "T = ½ Σ Vᵀ G V = ½ vᵀ M v of the moving links", "RNEA at rest; Featherstone 2008, §2.12 and Table 5.1";
            potential_energy(q) -> [] "J, zero at the world frame's origin", Momentum, Nothing, false,
                "U = −Σ m gᵀc of the moving links", "outward sweep; Featherstone 2008, §2.12";
            center_of_mass(q) -> [Of(3)] "m, world axes", Momentum, Mass, false,
                "centre of mass of the moving links", "outward sweep";
            center_of_mass_velocity(q, v) -> [Of(3)] "m/s, world axes", Momentum, Mass, false,
                "velocity of the centre of mass of the moving links", "outward sweep";
            center_of_mass_acceleration(q, v, a) -> [Of(3)] "m/s², world axes", Momentum, Mass, false,
                "acceleration of the centre of mass of the moving links, gravity not added", "outward sweep";
            center_of_mass_jacobian(q) -> [Of(3), Nv] "m|1, world axes", Momentum, Mass, false,
                "J with center_of_mass_velocity = J v", "composite masses; Orin, Goswami & Lee, Auton. Robots 35, 2013";
            centroidal_momentum(q, v) -> [Of(6)] "[k; l], N·m·s and N·s, world axes", Momentum, Mass, false,
                "momentum of the moving links about their centre of mass", "Orin, Goswami & Lee, Auton. Robots 35, 2013";
            centroidal_momentum_matrix(q) -> [Of(6), Nv] "world axes", Momentum, Mass, false,
                "A with centroidal_momentum = A v", "composite inertias; Orin, Goswami & Lee, Auton. Robots 35, 2013";
            centroidal_momentum_rate(q, v, a) -> [Of(6)] "[k̇; l̇], N·m and N, world axes", Momentum, Mass, false,
                "d/dt of centroidal_momentum = A a + Ȧ v", "Newton and Euler; Orin, Goswami & Lee, Auton. Robots 35, 2013";
            inverse_dynamics_derivatives(q, v, a) = inverse_dynamics_derivatives_with_wrenches,
                "first derivatives of inverse_dynamics; q in the tangent space";
            inverse_dynamics_derivatives_with_wrenches(q, v, a, wrenches) -> [Of(3), Nv, Nv]
                "∂τ/∂q, ∂τ/∂v, ∂τ/∂a = M; rows τ", Derivatives, Nothing, true,
                "first derivatives of inverse_dynamics_with_wrenches; q in the tangent space, wrenches constant in their reference",
                "Singh, Russell & Wensing, IEEE RA-L 7, 2022; Carpentier & Mansard, RSS 2018",
                by ["", always, nothing, inverse_dynamics_derivatives_with_wrenches; "the axes of the first body", near_the_middle, nothing, inverse_dynamics_derivatives_with_wrenches in axes_of_first_bodies];
            forward_dynamics_derivatives(q, v, tau) = forward_dynamics_derivatives_with_wrenches,
                "first derivatives of forward_dynamics; q in the tangent space";
            forward_dynamics_derivatives_with_wrenches(q, v, tau, wrenches) -> [Of(3), Nv, Nv]
                "∂a/∂q, ∂a/∂v, ∂a/∂τ = M⁻¹; rows a", Derivatives, MassMatrix, true,
                "first derivatives of forward_dynamics_with_wrenches; q in the tangent space, wrenches constant in their reference",
                "−M⁻¹ ∂(inverse dynamics); Carpentier & Mansard, RSS 2018",
                by ["", always, nothing, forward_dynamics_derivatives_with_wrenches; "the axes of the first body", near_the_middle, nothing, forward_dynamics_derivatives_with_wrenches in axes_of_first_bodies], columns unsolved_derivatives;
            static_torque_derivative(q, wrenches) -> [Nv, Nv] "N·m|N per unit step, rows τ", Derivatives, Nothing, true,
                "∂(static_torque)/∂q in the tangent space, wrenches constant in their reference",
                "Singh, Russell & Wensing, IEEE RA-L 7, 2022",
                by ["", always, nothing, static_torque_derivative; "the axes of the first body", near_the_middle, nothing, static_torque_derivative in axes_of_first_bodies];
            torque_regressor(q, v, a) -> [Nv, Links, Of(10)] "per m, m c, I_xx I_xy I_xz I_yy I_yz I_zz about the link's origin",
                Regressors, Nothing, false,
                "Y with inverse_dynamics = Y π without effects, π the inertial parameters of the moving links in their axes",
                "virtual power; Atkeson, An & Hollerbach, Int. J. Robot. Res. 5, 1986";
            joint_regressor(v, a) -> [Nv, Of(3)] "per N·m·s/rad|N·s/m, N·m|N, kg·m²|kg",
                Regressors, Nothing, false,
                "torques of each degree of freedom per unit of its damping, dry friction and armature: v, v/√(v² + s²), a; s is the speed of friction, or 1e-5",
                "linear in the parameters; Khalil & Dombre, Modeling, Identification and Control of Robots, 2002";
            kinetic_energy_regressor(q, v) -> [Links, Of(10)] "per m, m c, I_xx I_xy I_xz I_yy I_yz I_zz about the link's origin",
                Regressors, Nothing, false,
                "y with kinetic_energy = yᵀπ without effects", "Gautier & Khalil, IEEE ICRA 1988";
            potential_energy_regressor(q) -> [Links, Of(10)] "per m, m c, I_xx I_xy I_xz I_yy I_yz I_zz about the link's origin",
                Regressors, Nothing, false,
                "y with potential_energy = yᵀπ without effects", "Gautier & Khalil, IEEE ICRA 1988";
            operational_space_inertia(q) -> [Frames, Of(6), Of(6)] "kg·m²|kg·m|kg, symmetric", OperationalSpace, FreeFrames, true,
                "Λ = (J M⁻¹ Jᵀ)⁻¹ of each frame by itself, J that of jacobians_world_aligned",
                "M = Lᵀ D L; Khatib, IEEE J. Robot. Autom. 3, 1987";
            operational_space_inertia_inverse(q) -> [Frames, Of(6), Of(6)] "1/(kg·m²)|…, symmetric", OperationalSpace, MassMatrix, true,
                "Λ⁻¹ = J M⁻¹ Jᵀ of each frame by itself, J that of jacobians_world_aligned",
                "M = Lᵀ D L; Khatib, IEEE J. Robot. Autom. 3, 1987";
            effect_forces(q, v) -> [Nv] "N·m|N", Effects, Nothing, false,
                "generalised forces of all effects but gravity, inertia and motors; zero without a scene",
                "each effect's law";
            dissipation(q, v) -> [] "W", Effects, Nothing, false,
                "power of the effects that are not conservative: d(T + U)/dt = vᵀτ + this", "each effect's law";
            motor_torques(v, tau) -> [Nv] "N·m|N", Effects, Nothing, false,
                "the torques that motors deliver when commanded tau; forward dynamics applies this itself", "each motor's law";
            integrate(q, step) -> [Nq] "rad|m|unit quaternion", Configurations, Nothing, false,
                "q ⊕ step: along the step for a unit of time, on the manifold", "exponential of SE(3); Lynch & Park 2017, §3.3";
            difference(q, target) -> [Nv] "rad|m", Configurations, Nothing, false,
                "target ⊖ q: the step with q ⊕ step = target", "logarithm of SE(3); Lynch & Park 2017, §3.3";
            integrate_derivatives(step) -> [Of(2), Nv, Nv] "1|m, rows: the step where it ends", Configurations, Nothing, false,
                "∂(q ⊕ step)/∂q, ∂(q ⊕ step)/∂step, the same for every q; q in the tangent space",
                "Ad and J_r of SE(3); Barfoot 2017, §7.1.5";
            difference_derivatives(q, target) -> [Of(2), Nv, Nv] "1|m, rows the difference", Configurations, Nothing, false,
                "∂(target ⊖ q)/∂q, ∂(target ⊖ q)/∂target; both in the tangent space",
                "J_l⁻¹ and J_r⁻¹ of SE(3); Barfoot 2017, §7.1.5";
            random_configuration(uniform) -> [Nq] "rad|m|unit quaternion", Configurations, Nothing, false,
                "a configuration at random within limits, ±π rad and ±1 m where there are none, rotations uniform",
                "Shoemake, Graphics Gems III, 1992";
        }
    };
}

pub(crate) use for_each_function;

macro_rules! ways {
    ($name:ident, $arguments:tt) => {
        &[ways!(one "", always, nothing, $name, $arguments)]
    };
    ($name:ident, $arguments:tt, [$($way:literal, $applies:ident, $least:ident, $run:ident $(in $axes:ident)?);+]) => {
        &[$(ways!(one $way, $applies, $least, $run, $arguments $(, in $axes)?)),+]
    };
    (one $way:literal, $applies:ident, $least:ident, $run:ident, $arguments:tt $(, in $axes:ident)?) => {
        Variant { name: $way, applies: $applies, least: $least, run: ways!(run $run, $arguments $(, in $axes)?) }
    };
    (run $run:ident, ($($argument:ident),*)) => {
        &|model, ws, inputs, out| $run(model, ws, $(inputs.known[place!($argument)],)* out)
    };
    (run $run:ident, ($($argument:ident),*), in $axes:ident) => {
        &|model, ws, inputs, out| ws.$axes(|ws| $run(model, ws, $(inputs.known[place!($argument)],)* out))
    };
}

macro_rules! unsolved {
    ($arguments:tt) => {
        None
    };
    ($arguments:tt, $run:ident) => {
        Some(ways!(one "columns in a loop", without_motors, nothing, $run, $arguments))
    };
}

/// A row or a preset of one.
macro_rules! entry {
    ($name:ident, ($($argument:ident),*), $summary:literal, = $general:ident) => {
        Function {
            id: FunctionId::$name,
            name: stringify!($name),
            summary: $summary,
            takes: &[$(argument!($argument)),*],
            ..Self::$general
        }
    };
    ($name:ident, ($($argument:ident),*), $summary:literal,
        -> [$($dim:ident $(($n:literal))?),*] $unit:literal, $group:ident, $needs:ident, $regrouped:literal,
        $source:literal $(, by $ways:tt)? $(, columns $unsolved:ident)?) => {
        Function {
            id: FunctionId::$name,
            general: FunctionId::$name,
            name: stringify!($name),
            summary: $summary,
            source: $source,
            takes: &[$(argument!($argument)),*],
            gives: &[$(Dim::$dim $(($n))?),*],
            outputs: &[],
            unit: $unit,
            group: Group::$group,
            needs: Needs::$needs,
            regrouped: $regrouped,
            ways: ways!($name, ($($argument),*) $(, $ways)?),
            contains: &[],
            unsolved: unsolved!(($($argument),*) $(, $unsolved)?),
        }
    };
}

/// The algorithm of a row by its inputs.
macro_rules! by_inputs {
    ($name:ident, $arguments:tt, = $general:ident) => {};
    ($name:ident, ($($argument:ident),*), -> $row:ident) => {
        #[inline]
        pub(super) fn $name<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, inputs: &Inputs<'_, S>, out: &mut [S]) {
            super::super::$name(model, ws, $(inputs.known[place!($argument)],)* out);
        }
    };
}

/// A preset as a function.
macro_rules! preset {
    ($name:ident, $arguments:tt, $summary:literal, -> $row:ident) => {};
    ($name:ident, ($($argument:ident),*), $summary:literal, = $general:ident) => {
        #[doc = concat!($summary, ".\n\n[`", stringify!($general), "`] with zeros for what is not taken.\n\n", $("* ", documentation!($argument), "\n",)*)]
        ///
        /// # Panics
        /// If a slice is shorter than stated; [`Function::call`] and [`crate::dynamics::Dynamics`]
        /// check and return an error.
        #[inline]
        pub fn $name<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, $($argument: &[S],)* out: &mut [S]) {
            let inputs = Inputs::new([$((place!($argument), $argument)),*]);
            by_inputs::$general(model, ws, &inputs, out);
        }
    };
}

macro_rules! rows {
    ($($name:ident $arguments:tt $(= $general:ident)?
        $(-> $dims:tt $unit:literal, $group:ident, $needs:ident, $regrouped:literal)?,
        $summary:literal $(, $source:literal)? $(, by $ways:tt)? $(, columns $unsolved:ident)?;)*) => {
        /// The functions by number: each variant is called as its function is.
        #[allow(non_camel_case_types)]
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub enum FunctionId {
            $(#[doc = $summary] $name,)*
            /// A function of a user, which has no row here.
            user,
        }

        impl FunctionId {
            /// The function's name.
            pub fn name(self) -> &'static str {
                match self {
                    $(Self::$name => stringify!($name),)*
                    Self::user => "user",
                }
            }
        }

        #[allow(non_upper_case_globals)]
        impl<S: Scalar> Table<S> {
            $(const $name: Function<S> = entry!($name, $arguments, $summary, $(= $general)?
                $(-> $dims $unit, $group, $needs, $regrouped,)? $($source)? $(, by $ways)? $(, columns $unsolved)?);)*

            const NO_ROW: &'static Function<S> = &Function {
                id: FunctionId::user,
                general: FunctionId::user,
                name: "user",
                summary: "a user's function",
                source: "a user's function",
                takes: &[],
                gives: &[],
                outputs: &[],
                unit: "",
                group: Group::User,
                needs: Needs::Nothing,
                regrouped: false,
                ways: &[],
                contains: &[],
                unsolved: None,
            };

            const ROWS: &'static [Function<S>] = &[$(Self::$name),*];
        }

        // Why: of the rows only those that have presets are called.
        #[allow(dead_code)]
        mod by_inputs {
            use super::*;

            $(by_inputs!($name, $arguments, $(= $general)? $(-> $needs)?);)*
        }

        /// The presets of the table.
        pub(super) mod presets {
            use super::*;

            $(preset!($name, $arguments, $summary, $(= $general)? $(-> $needs)?);)*
        }
    };
}

struct Table<S>(PhantomData<S>);

for_each_function!(rows);

pub(crate) fn always<S>(_: &Model<S>) -> bool {
    true
}

pub(crate) fn nothing<S>(_: &Model<S>) -> u64 {
    0
}

/// Multiplications of M = Lᵀ D L.
pub(crate) fn factorization<S: Scalar>(model: &Model<S>) -> u64 {
    super::ltdl::multiplications(&super::workspace::parent_dof(model))
}

/// Whether no joint follows another: a follower ties branches together, and no recursion along one
/// branch can invert M.
pub(crate) fn untied<S: Scalar>(model: &Model<S>) -> bool {
    !model.has_followers()
}

/// All functions, in the order of printed lists.
pub fn functions<S: Scalar>() -> &'static [Function<S>] {
    Table::<S>::ROWS
}

/// The function called `name`.
pub fn function<S: Scalar>(name: &str) -> Option<&'static Function<S>> {
    functions::<S>().iter().find(|f| f.name == name)
}

impl FunctionId {
    /// Its row. Of a user's function one that takes and gives nothing, and has no way to run.
    pub fn row<S: Scalar>(self) -> &'static Function<S> {
        Table::<S>::ROWS.get(self as usize).unwrap_or(Table::<S>::NO_ROW)
    }
}
