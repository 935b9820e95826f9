//! Any robot behind virtual calls, so that the integrators are compiled once, in this crate, and
//! not again for each robot in its user's crate.

use articulated_core::algorithm::{FunctionError, FunctionId, Shape};
use articulated_core::dynamics::Dynamics;
use articulated_core::model::JointRow;

/// A robot of any type.
#[derive(Clone, Copy)]
pub(crate) struct Erased<'r> {
    robot: &'r dyn Robot,
}

impl<'r> Erased<'r> {
    pub(crate) fn new<R: Dynamics<f64>>(robot: &'r R) -> Self {
        Self { robot }
    }
}

/// What a robot says of itself, and its functions with their memory.
trait Robot {
    fn bound(&self) -> Box<dyn Functions + '_>;
    fn shape(&self) -> Shape;
    fn name(&self) -> &str;
    fn joint(&self, index: usize) -> Option<JointRow<'_>>;
    fn frame_name(&self, frame: usize) -> Option<&str>;
    fn has_motors(&self) -> bool;
}

/// A robot's functions, with the memory that they need: one virtual call each.
pub(crate) trait Functions {
    fn call(&mut self, function: FunctionId, arguments: &[&[f64]], out: &mut [f64]) -> Result<(), FunctionError>;
}

/// A robot and the memory of its functions.
struct Bound<'r, R: Dynamics<f64>> {
    robot: &'r R,
    ws: R::Workspace,
}

impl<R: Dynamics<f64>> Functions for Bound<'_, R> {
    fn call(&mut self, function: FunctionId, arguments: &[&[f64]], out: &mut [f64]) -> Result<(), FunctionError> {
        self.robot.call(function, &mut self.ws, arguments, out)
    }
}

impl<R: Dynamics<f64>> Robot for R {
    fn bound(&self) -> Box<dyn Functions + '_> {
        Box::new(Bound { robot: self, ws: self.workspace() })
    }

    fn shape(&self) -> Shape {
        Dynamics::shape(self)
    }

    fn name(&self) -> &str {
        Dynamics::name(self)
    }

    fn joint(&self, index: usize) -> Option<JointRow<'_>> {
        Dynamics::joint(self, index)
    }

    fn frame_name(&self, frame: usize) -> Option<&str> {
        Dynamics::frame_name(self, frame)
    }

    fn has_motors(&self) -> bool {
        Dynamics::has_motors(self)
    }
}

impl<'r> Dynamics<f64> for Erased<'r> {
    type Workspace = Box<dyn Functions + 'r>;

    fn workspace(&self) -> Self::Workspace {
        self.robot.bound()
    }

    fn shape(&self) -> Shape {
        self.robot.shape()
    }

    fn name(&self) -> &str {
        self.robot.name()
    }

    fn joint(&self, index: usize) -> Option<JointRow<'_>> {
        self.robot.joint(index)
    }

    fn frame_name(&self, frame: usize) -> Option<&str> {
        self.robot.frame_name(frame)
    }

    fn has_motors(&self) -> bool {
        self.robot.has_motors()
    }

    fn call(&self, function: FunctionId, ws: &mut Self::Workspace, arguments: &[&[f64]], out: &mut [f64]) -> Result<(), FunctionError> {
        ws.call(function, arguments, out)
    }
}
