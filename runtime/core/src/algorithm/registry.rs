//! The one table of functions, from which the generator, the command line, the tests and the documentation all read.
//!
//! Adding a function: its algorithm in a file, its row here.

use core::fmt;
use core::marker::PhantomData;

use super::{Workspace, bias_forces, forward_dynamics, gravity_torque, inverse_dynamics, mass_matrix, placements};
use crate::Scalar;
use crate::model::Model;

/// The sizes that the shapes of arguments and results depend on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shape {
    /// Number of coordinates.
    pub nq: usize,
    /// Number of degrees of freedom.
    pub nv: usize,
    /// Number of frames.
    pub frames: usize,
}

impl<S> Model<S> {
    /// The model's sizes.
    pub fn shape(&self) -> Shape {
        Shape { nq: self.nq, nv: self.nv, frames: self.frames.len() }
    }
}

/// What a function takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Argument {
    /// q, `[nq]`: rad, m, or position and unit quaternion.
    Q,
    /// v, `[nv]`: rad/s, m/s, or body twist [ω; v].
    V,
    /// a = dv/dt, `[nv]`.
    A,
    /// τ, `[nv]`: N·m or N.
    Tau,
}

impl Argument {
    /// Its name in signatures and files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Q => "q",
            Self::V => "v",
            Self::A => "a",
            Self::Tau => "tau",
        }
    }

    /// How many numbers.
    pub fn len(self, shape: Shape) -> usize {
        match self {
            Self::Q => shape.nq,
            Self::V | Self::A | Self::Tau => shape.nv,
        }
    }

    /// Its shape and units, for documentation.
    pub fn doc(self) -> &'static str {
        match self {
            Self::Q => "`[NQ]` rad|m|unit quaternion",
            Self::V => "`[NV]` rad/s|m/s",
            Self::A => "`[NV]` rad/s²|m/s²",
            Self::Tau => "`[NV]` N·m|N",
        }
    }
}

/// What a function gives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ResultKind {
    /// Generalised forces, `[nv]`.
    Torque,
    /// For each frame, rotation row by row and position: `[frames][12]`.
    Placements,
    /// Generalised accelerations, `[nv]`.
    Acceleration,
    /// The mass matrix, `[nv][nv]`.
    MassMatrix,
}

impl ResultKind {
    /// How many numbers.
    pub fn len(self, shape: Shape) -> usize {
        match self {
            Self::Torque | Self::Acceleration => shape.nv,
            Self::Placements => 12 * shape.frames,
            Self::MassMatrix => shape.nv * shape.nv,
        }
    }

    /// Its shape and units, for documentation.
    pub fn doc(self) -> &'static str {
        match self {
            Self::Torque => "`[NV]` N·m|N",
            Self::Placements => "`[FRAMES][12]`: rotation row by row, then position in m, in the base frame",
            Self::Acceleration => "`[NV]` rad/s²|m/s²",
            Self::MassMatrix => "`[NV][NV]` kg·m²|kg·m|kg, symmetric",
        }
    }
}

/// An algorithm as the table holds it: arguments in the order of `takes`, lengths checked.
type Run<S> = fn(&Model<S>, &mut Workspace<S>, &[&[S]], &mut [S]);

/// One row: a function that any robot can have.
pub struct Function<S: 'static> {
    /// Its name everywhere: in Rust, in scenes, on the command line.
    pub name: &'static str,
    /// The equation and what it means.
    pub summary: &'static str,
    /// The algorithm and its source.
    pub source: &'static str,
    /// What it takes, in order.
    pub takes: &'static [Argument],
    /// What it gives.
    pub gives: ResultKind,
    run: Run<S>,
}

/// Why a function could not be called.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FunctionError {
    /// A slice has another length than the model says.
    Length {
        /// The argument's name.
        argument: &'static str,
        /// The length found.
        found: usize,
        /// The length expected.
        expected: usize,
    },
    /// The robot was generated without this function.
    NotGenerated {
        /// The function's name.
        function: &'static str,
    },
}

impl fmt::Display for FunctionError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Length { argument, found, expected } => write!(f, "{argument}: found {found} numbers, expected {expected}"),
            Self::NotGenerated { function } => write!(f, "this robot was generated without {function}: add it to `functions`"),
        }
    }
}

impl core::error::Error for FunctionError {}

impl<S: Scalar> Function<S> {
    /// Whether the function divides by the mass matrix, so that a joint that moves no mass makes it undefined.
    pub fn inverts_mass_matrix(&self) -> bool {
        self.gives == ResultKind::Acceleration
    }

    /// Evaluates the function; `arguments` in the order of `takes`, `out` as `gives` says.
    pub fn call(&self, model: &Model<S>, ws: &mut Workspace<S>, arguments: &[&[S]], out: &mut [S]) -> Result<(), FunctionError> {
        let shape = model.shape();
        check_length("arguments", arguments.len(), self.takes.len())?;
        for (argument, given) in self.takes.iter().zip(arguments) {
            check_length(argument.name(), given.len(), argument.len(shape))?;
        }
        check_length("out", out.len(), self.gives.len(shape))?;
        (self.run)(model, ws, arguments, out);
        Ok(())
    }
}

/// The length of an argument, or the error that names it.
pub fn check_length(argument: &'static str, found: usize, expected: usize) -> Result<(), FunctionError> {
    if found == expected { Ok(()) } else { Err(FunctionError::Length { argument, found, expected }) }
}

/// A slice as an array of exactly `N` numbers, or the error that names it.
pub fn exactly<'a, const N: usize, S>(argument: &'static str, slice: &'a [S]) -> Result<&'a [S; N], FunctionError> {
    slice.try_into().map_err(|_| FunctionError::Length { argument, found: slice.len(), expected: N })
}

struct Table<S>(PhantomData<S>);

impl<S: Scalar> Table<S> {
    const ROWS: &'static [Function<S>] = &[
        Function {
            name: "placements",
            summary: "placements of all links in the base frame",
            source: "forward kinematics; Featherstone 2008, §4.4",
            takes: &[Argument::Q],
            gives: ResultKind::Placements,
            run: |m, ws, x, out| placements(m, ws, x[0], out),
        },
        Function {
            name: "inverse_dynamics",
            summary: "τ = M(q)·a + h(q, v), gravity included",
            source: "RNEA; Featherstone 2008, Table 5.1",
            takes: &[Argument::Q, Argument::V, Argument::A],
            gives: ResultKind::Torque,
            run: |m, ws, x, out| inverse_dynamics(m, ws, x[0], x[1], x[2], out),
        },
        Function {
            name: "bias_forces",
            summary: "h(q, v) = τ at a = 0: Coriolis, centrifugal and gravity forces",
            source: "RNEA; Featherstone 2008, Table 5.1",
            takes: &[Argument::Q, Argument::V],
            gives: ResultKind::Torque,
            run: |m, ws, x, out| bias_forces(m, ws, x[0], x[1], out),
        },
        Function {
            name: "gravity_torque",
            summary: "g(q) = τ at v = a = 0: what holds the robot still",
            source: "RNEA; Featherstone 2008, Table 5.1",
            takes: &[Argument::Q],
            gives: ResultKind::Torque,
            run: |m, ws, x, out| gravity_torque(m, ws, x[0], out),
        },
        Function {
            name: "mass_matrix",
            summary: "M(q)",
            source: "CRBA; Featherstone 2008, Table 6.2",
            takes: &[Argument::Q],
            gives: ResultKind::MassMatrix,
            run: |m, ws, x, out| mass_matrix(m, ws, x[0], out),
        },
        Function {
            name: "forward_dynamics",
            summary: "a = M(q)⁻¹·(τ − h(q, v))",
            source: "RNEA, CRBA and M = Lᵀ D L; Featherstone 2008, §6.5",
            takes: &[Argument::Q, Argument::V, Argument::Tau],
            gives: ResultKind::Acceleration,
            run: |m, ws, x, out| forward_dynamics(m, ws, x[0], x[1], x[2], out),
        },
    ];
}

/// All functions, in the order in which they are listed to people.
pub fn functions<S: Scalar>() -> &'static [Function<S>] {
    Table::<S>::ROWS
}

/// The function called `name`.
pub fn function<S: Scalar>(name: &str) -> Option<&'static Function<S>> {
    functions::<S>().iter().find(|f| f.name == name)
}
