//! Forward dynamics of any robot, generated or not, that reports whether it is reliable.

use alloc::string::ToString;
use alloc::vec;
use alloc::vec::Vec;
use core::fmt;

use super::pivots::PivotMonitor;
use super::{Factor, Singular};
use crate::Scalar;
use crate::algorithm::{FunctionError, Shape, check_length};
use crate::dynamics::Dynamics;

/// Room for checked forward dynamics of a robot of one size, by M = Lᵀ D L: made once, so that no
/// call allocates.
///
/// Works on everything that is [`Dynamics`] and has `bias_forces` and `mass_matrix`, and
/// `motor_torques` where it has motors: that is how a generated robot is checked.
#[derive(Clone, Debug)]
pub struct Solver<S = f64> {
    matrix: Vec<S>,
    /// The torques that joints get.
    input: Vec<S>,
    factor: Factor<S>,
    /// That of the last solution.
    backward_error: S,
    /// No acceleration.
    zeros: Vec<S>,
}

/// Errors of forward dynamics.
#[derive(Clone, Debug, PartialEq)]
pub enum Unsolved<S = f64> {
    /// A slice has the wrong length, or the robot lacks a function.
    Function(FunctionError),
    /// The mass matrix is singular to working precision.
    Singular(Singular<S>),
}

impl<S: Scalar> fmt::Display for Unsolved<S> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Function(error) => error.fmt(f),
            Self::Singular(error) => error.fmt(f),
        }
    }
}

impl<S: Scalar> core::error::Error for Unsolved<S> {}

impl<S: Scalar<Mask = bool>> Solver<S> {
    /// For robots of this shape.
    pub fn new(shape: Shape) -> Self {
        let zeros = |n| vec![S::zero(); n];
        Self {
            matrix: zeros(shape.nv * shape.nv),
            input: zeros(shape.nv),
            factor: Factor::new(shape.nv),
            backward_error: S::zero(),
            zeros: zeros(shape.nv),
        }
    }

    /// a = M(q)⁻¹·(τ − h(q, v)), τ after motors, refined ([`Factor::refine`]). Returns the smallest
    /// D/(Σ|terms|) of all pivots.
    ///
    /// q: `[nq]`; v, tau, out: `[nv]`. Calls the robot's `bias_forces`, `mass_matrix` and, if it
    /// has motors, `motor_torques`, then eliminates: n³/3 operations at most. The torques that the
    /// result needs are τ up to roundings of their terms, however far apart masses are.
    ///
    /// # Errors
    /// [`Unsolved`]; `out` is then meaningless.
    pub fn forward_dynamics<R: Dynamics<S>>(
        &mut self,
        robot: &R,
        ws: &mut R::Workspace,
        [q, v, tau]: [&[S]; 3],
        out: &mut [S],
    ) -> Result<S, Unsolved<S>> {
        self.solve(robot, ws, [q, v, tau], out, |ws, out| robot.bias_forces(ws, q, v, out))
    }

    /// As [`Solver::forward_dynamics`], with external wrenches on the frames: by the robot's
    /// `inverse_dynamics_with_wrenches` in place of its `bias_forces`.
    ///
    /// wrenches: `[frames][6]` N·m and N, in the reference that the robot takes them in.
    ///
    /// # Errors
    /// As [`Solver::forward_dynamics`].
    pub fn forward_dynamics_with_wrenches<R: Dynamics<S>>(
        &mut self,
        robot: &R,
        ws: &mut R::Workspace,
        [q, v, tau]: [&[S]; 3],
        wrenches: &[S],
        out: &mut [S],
    ) -> Result<S, Unsolved<S>> {
        let zeros = core::mem::take(&mut self.zeros);
        let bias = |ws: &mut _, out: &mut _| robot.inverse_dynamics_with_wrenches(ws, q, v, &zeros, wrenches, out);
        let left = self.solve(robot, ws, [q, v, tau], out, bias);
        self.zeros = zeros;
        left
    }

    /// M⁻¹(τ − h), h by `bias`.
    fn solve<R: Dynamics<S>>(
        &mut self,
        robot: &R,
        ws: &mut R::Workspace,
        [q, v, tau]: [&[S]; 3],
        out: &mut [S],
        bias: impl FnOnce(&mut R::Workspace, &mut [S]) -> Result<(), FunctionError>,
    ) -> Result<S, Unsolved<S>> {
        let n = self.factor.n;
        let asked = || {
            check_length("solver", n, robot.shape().nv)?;
            check_length("tau", tau.len(), n)?;
            self.input.copy_from_slice(tau);
            if robot.has_motors() {
                robot.motor_torques(ws, v, tau, &mut self.input)?;
            }
            bias(ws, out)?;
            robot.mass_matrix(ws, q, &mut self.matrix)
        };
        asked().map_err(Unsolved::Function)?;
        // Singular or not, all pivots are checked.
        let _ = self.factor.factor(&self.matrix);
        // b = τ − h
        out.iter_mut().zip(&mut self.input).for_each(|(b, tau)| {
            *b = *tau - *b;
            *tau = *b;
        });
        self.factor.solve(out);
        self.backward_error = self.factor.refine(&self.matrix, &self.input, out);
        let mut monitor = PivotMonitor::new();
        self.factor.pivots().iter().enumerate().rev().for_each(|(k, left)| monitor.see(k, *left));
        monitor.verdict(out, |k| robot.joint_of(k).unwrap_or_default().to_string()).map_err(Unsolved::Singular)
    }

    /// max_i |τ − h − M a|_i / (|M||a| + |τ − h|)_i of the last call, with M and h as they were
    /// computed: a few roundings, or M is nearly singular.
    pub fn backward_error(&self) -> S {
        self.backward_error
    }

    /// The factor of M of the last call, for other right-hand sides and for [`Factor::condition`].
    pub fn factor(&mut self) -> &mut Factor<S> {
        &mut self.factor
    }
}
