//! One interface to a robot's dynamics, whether it was generated or loaded at run time.

use crate::Scalar;
use crate::algorithm::{self, FunctionError, Shape, Workspace};
use crate::model::Model;

/// A robot's dynamics. Code written over this trait runs on generated robots and on a [`Model`] alike.
///
/// Shapes, units and frames of each method are those of the function with the same name in [`crate::algorithm`]. A slice of the
/// wrong length is an error, and so is a function that a robot was generated without; nothing panics.
pub trait Dynamics<S: Scalar = f64> {
    /// What an evaluation needs room for; `()` for generated robots.
    type Workspace;

    /// A workspace, to be made once.
    fn workspace(&self) -> Self::Workspace;

    /// Numbers of coordinates, degrees of freedom and frames.
    fn shape(&self) -> Shape;

    /// The robot's name.
    fn name(&self) -> &str;

    /// Placements of all frames in the base frame. q: `[nq]`; out: `[frames]` of (rotation row by row, position in m).
    fn placements(&self, _ws: &mut Self::Workspace, _q: &[S], _out: &mut [[S; 12]]) -> Result<(), FunctionError> {
        Err(FunctionError::NotGenerated { function: "placements" })
    }

    /// τ = M(q)·a + h(q, v). q: `[nq]`; v, a, tau: `[nv]`.
    fn inverse_dynamics(&self, _ws: &mut Self::Workspace, _q: &[S], _v: &[S], _a: &[S], _tau: &mut [S]) -> Result<(), FunctionError> {
        Err(FunctionError::NotGenerated { function: "inverse_dynamics" })
    }

    /// h(q, v). q: `[nq]`; v, out: `[nv]`.
    fn bias_forces(&self, _ws: &mut Self::Workspace, _q: &[S], _v: &[S], _out: &mut [S]) -> Result<(), FunctionError> {
        Err(FunctionError::NotGenerated { function: "bias_forces" })
    }

    /// g(q). q: `[nq]`; out: `[nv]`.
    fn gravity_torque(&self, _ws: &mut Self::Workspace, _q: &[S], _out: &mut [S]) -> Result<(), FunctionError> {
        Err(FunctionError::NotGenerated { function: "gravity_torque" })
    }

    /// M(q). q: `[nq]`; out: `[nv · nv]`, row by row.
    fn mass_matrix(&self, _ws: &mut Self::Workspace, _q: &[S], _out: &mut [S]) -> Result<(), FunctionError> {
        Err(FunctionError::NotGenerated { function: "mass_matrix" })
    }

    /// a = M(q)⁻¹·(τ − h(q, v)). q: `[nq]`; v, tau, out: `[nv]`.
    fn forward_dynamics(&self, _ws: &mut Self::Workspace, _q: &[S], _v: &[S], _tau: &[S], _out: &mut [S]) -> Result<(), FunctionError> {
        Err(FunctionError::NotGenerated { function: "forward_dynamics" })
    }
}

impl<S: Scalar> Dynamics<S> for Model<S> {
    type Workspace = Workspace<S>;

    fn workspace(&self) -> Workspace<S> {
        Workspace::new(self)
    }

    fn shape(&self) -> Shape {
        Model::shape(self)
    }

    fn name(&self) -> &str {
        &self.name
    }

    fn placements(&self, ws: &mut Workspace<S>, q: &[S], out: &mut [[S; 12]]) -> Result<(), FunctionError> {
        check(&[("q", q.len(), self.nq), ("out", out.len(), self.frames.len())])?;
        algorithm::placements(self, ws, q, out.as_flattened_mut());
        Ok(())
    }

    fn inverse_dynamics(&self, ws: &mut Workspace<S>, q: &[S], v: &[S], a: &[S], tau: &mut [S]) -> Result<(), FunctionError> {
        check(&[("q", q.len(), self.nq), ("v", v.len(), self.nv), ("a", a.len(), self.nv), ("tau", tau.len(), self.nv)])?;
        algorithm::inverse_dynamics(self, ws, q, v, a, tau);
        Ok(())
    }

    fn bias_forces(&self, ws: &mut Workspace<S>, q: &[S], v: &[S], out: &mut [S]) -> Result<(), FunctionError> {
        check(&[("q", q.len(), self.nq), ("v", v.len(), self.nv), ("out", out.len(), self.nv)])?;
        algorithm::bias_forces(self, ws, q, v, out);
        Ok(())
    }

    fn gravity_torque(&self, ws: &mut Workspace<S>, q: &[S], out: &mut [S]) -> Result<(), FunctionError> {
        check(&[("q", q.len(), self.nq), ("out", out.len(), self.nv)])?;
        algorithm::gravity_torque(self, ws, q, out);
        Ok(())
    }

    fn mass_matrix(&self, ws: &mut Workspace<S>, q: &[S], out: &mut [S]) -> Result<(), FunctionError> {
        check(&[("q", q.len(), self.nq), ("out", out.len(), self.nv * self.nv)])?;
        algorithm::mass_matrix(self, ws, q, out);
        Ok(())
    }

    fn forward_dynamics(&self, ws: &mut Workspace<S>, q: &[S], v: &[S], tau: &[S], out: &mut [S]) -> Result<(), FunctionError> {
        check(&[("q", q.len(), self.nq), ("v", v.len(), self.nv), ("tau", tau.len(), self.nv), ("out", out.len(), self.nv)])?;
        algorithm::forward_dynamics(self, ws, q, v, tau, out);
        Ok(())
    }
}

fn check(lengths: &[(&'static str, usize, usize)]) -> Result<(), FunctionError> {
    lengths.iter().try_for_each(|&(name, found, expected)| algorithm::check_length(name, found, expected))
}
