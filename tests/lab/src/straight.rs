//! A robot by its generated code, compiled and loaded, as anything that has dynamics.

use articulated::simulate::{Counts, Settings};
use articulated::{Dynamics, FunctionError, FunctionId, Shape, check_count, check_length};
use articulated_codegen::Generated;
use articulated_core::algorithm::functions;
use articulated_motion::{InitialState, MotionErrors, Outcome};

use crate::compiled::{CompileError, Compiled, Rustc};
use crate::native::Kernel;
use crate::session::{Code, Session};

/// Generated code of some functions of a robot.
pub struct Straight {
    name: String,
    has_motors: bool,
    shape: Shape,
    kernels: Vec<Option<Kernel>>,
    // Last, so that the library is closed after its functions.
    _compiled: Compiled,
}

impl Straight {
    /// Compiles and loads.
    pub fn build(rustc: &Rustc, generated: &Generated) -> Result<Self, CompileError> {
        let compiled = Compiled::build(rustc, generated)?;
        let kernels = functions::<f64>().iter().map(|f| compiled.kernel(f.name).cloned()).collect();
        let (name, has_motors, shape) = (generated.model.name().to_owned(), generated.model.has_motors(), compiled.shape());
        Ok(Self { name, has_motors, shape, kernels, _compiled: compiled })
    }
}

impl Dynamics<f64> for Straight {
    type Workspace = ();

    fn workspace(&self) {}

    fn shape(&self) -> Shape {
        self.shape
    }

    fn name(&self) -> &str {
        &self.name
    }

    fn has_motors(&self) -> bool {
        self.has_motors
    }

    #[inline]
    fn call(&self, function: FunctionId, (): &mut (), arguments: &[&[f64]], out: &mut [f64]) -> Result<(), FunctionError> {
        let row = function.row::<f64>();
        let kernel = self.kernels[function as usize].as_ref().ok_or(FunctionError::NotGenerated { function: row.name })?;
        if !kernel.fits(arguments, out) {
            check_count(row.name, arguments.len(), row.takes.len())?;
            for (argument, given) in row.takes.iter().zip(arguments) {
                check_length(argument.name(), given.len(), argument.len(self.shape))?;
            }
            check_length("out", out.len(), row.len(self.shape))?;
        }
        kernel.call(arguments, out);
        Ok(())
    }
}

/// Generated code for the motion of a scene, with the names of its frames.
pub struct StraightMotion {
    /// The code.
    pub robot: Straight,
    /// The frames.
    pub frames: Vec<String>,
}

impl Code for StraightMotion {
    fn run(
        &self,
        session: &Session,
        initial: &InitialState,
        settings: &Settings,
        look: &mut dyn FnMut(f64, &Counts) -> bool,
    ) -> Result<(Outcome, Vec<String>), MotionErrors> {
        session.run_by(initial, (&self.robot, &self.frames), settings, look)
    }
}
