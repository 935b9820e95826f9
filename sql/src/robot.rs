//! The robot whose functions a session gets.

use std::fmt;
use std::path::Path;
use std::sync::Arc;

use articulated::algorithm::{function, functions};
use articulated::{Base, Dynamics, FunctionId, LoadError};
use datafusion::error::{DataFusionError, Result};
use datafusion::execution::FunctionRegistry;
use datafusion::logical_expr::ScalarUDF;
use datafusion::prelude::SessionContext;

use crate::batch::{Batch, Run, mismatches};
use crate::evaluate::Evaluate;
use crate::function::{Names, RobotFunction};

/// A robot and the functions that a session gets of it.
///
/// ```
/// use articulated::Base;
/// use articulated_datafusion::Robot;
/// use datafusion::prelude::SessionContext;
///
/// # fn run() -> Result<(), Box<dyn std::error::Error>> {
/// # const ARM: &str = "../models/urdf/panda_like.urdf";
/// let context = SessionContext::new();
/// Robot::load(ARM, Base::Fixed)?.register(&context)?; // mass_matrix(q)
/// Robot::load(ARM, Base::Fixed)?.prefixed("left")?.register(&context)?; // left_mass_matrix(q)
/// # Ok(()) }
/// # run().unwrap();
/// ```
#[derive(Clone)]
pub struct Robot {
    robot: Arc<dyn Evaluate>,
    prefix: String,
    batches: Vec<(FunctionId, Arc<Run>)>,
}

impl fmt::Debug for Robot {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Robot").field("prefix", &self.prefix).finish_non_exhaustive()
    }
}

fn misconfigured(text: String) -> DataFusionError {
    DataFusionError::Configuration(text)
}

impl Robot {
    /// A loaded robot (`Model<f64>`) or a generated one (`arm::Robot`).
    pub fn new(robot: impl Dynamics + Send + Sync + 'static) -> Self {
        Self { robot: Arc::new(robot), prefix: String::new(), batches: Vec::new() }
    }

    /// The robot of a file, with standard gravity: [`articulated::load`].
    ///
    /// # Errors
    /// All mistakes of the file.
    pub fn load(path: impl AsRef<Path>, base: Base) -> Result<Self, LoadError> {
        articulated::load(path, base).map(Self::new)
    }

    /// Names with a prefix: `left_mass_matrix` for "left". For a session with several robots.
    ///
    /// # Errors
    /// A prefix that SQL would read only in quotation marks.
    pub fn prefixed(mut self, prefix: &str) -> Result<Self> {
        let is_plain = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
        if !prefix.starts_with(|c: char| c.is_ascii_lowercase() || c == '_') || !prefix.chars().all(is_plain) {
            let expected = "lower-case letters, digits and underscores, and no digit first";
            return Err(misconfigured(format!("prefix: found {prefix:?}, expected {expected}")));
        }
        prefix.clone_into(&mut self.prefix);
        Ok(self)
    }

    /// Computes a function by a function of many states, such as those of a generated module's
    /// `batch_f64`. Rows are evaluated in vectors then, and arguments are not copied.
    ///
    /// The caller makes sure that both are the same robot: only sizes are compared.
    ///
    /// ```
    /// use articulated_datafusion::Robot;
    ///
    /// articulated::robot! {
    ///     pub mod arm {
    ///         urdf = "../models/urdf/panda_like.urdf",
    ///         functions = [inverse_dynamics],
    ///         batch = [f64],
    ///     }
    /// }
    ///
    /// let batch = arm::batch_f64::inverse_dynamics;
    /// let robot = Robot::new(arm::Robot).with_batch("inverse_dynamics", batch)?;
    /// # Ok::<(), datafusion::error::DataFusionError>(())
    /// ```
    ///
    /// # Errors
    /// No function of this name, and arguments or results of other sizes than the robot's; all of
    /// them.
    pub fn with_batch<Kind, B: Batch<Kind>>(mut self, name: &str, batch: B) -> Result<Self> {
        let row = function::<f64>(name).ok_or_else(|| {
            let names: Vec<&str> = functions::<f64>().iter().map(|function| function.name).collect();
            misconfigured(format!("with_batch: found the name {name:?}, expected one of {}", names.join(", ")))
        })?;
        let wrong = mismatches(row, self.robot.shape(), &B::lens());
        if !wrong.is_empty() {
            return Err(misconfigured(wrong.iter().map(|wrong| format!("with_batch: {name}: {wrong}")).collect::<Vec<_>>().join("\n")));
        }
        self.batches.retain(|(id, _)| *id != row.id);
        self.batches.push((row.id, Arc::new(move |arguments: &[&[f64]], out: &mut [f64]| batch.run(arguments, out))));
        Ok(self)
    }

    fn named(&self, name: &str) -> String {
        if self.prefix.is_empty() { name.into() } else { format!("{}_{name}", self.prefix) }
    }

    /// The functions: all of the table, `joint_names` and `frame_names`. A function that the robot
    /// does not have is among them, and says so where a query uses it.
    ///
    /// For registries of other kinds than [`SessionContext`], as an executor of a cluster has one.
    pub fn functions(&self) -> Vec<ScalarUDF> {
        let of_table = functions::<f64>().iter().map(|function| {
            let batch = self.batches.iter().find(|(id, _)| *id == function.id).map(|(_, run)| Arc::clone(run));
            ScalarUDF::from(RobotFunction::new(self.named(function.name), &self.robot, function, batch))
        });
        let joints = (self.named("joint_names"), self.robot.joint_names(), "The joint of each degree of freedom, in the order of v.");
        let frames = (self.named("frame_names"), self.robot.frame_names(), "The name of each frame.");
        let of_names = [joints, frames].map(|(name, names, text)| ScalarUDF::from(Names::new(name, names, text)));
        of_table.chain(of_names).collect()
    }

    /// Registers all functions of the robot.
    ///
    /// # Errors
    /// A robot without degrees of freedom, and names that the session has already: then nothing is
    /// registered.
    pub fn register(&self, context: &SessionContext) -> Result<()> {
        if self.robot.shape().nv == 0 {
            return Err(misconfigured("robot: found no degree of freedom, expected a joint that moves or a floating base".into()));
        }
        let functions = self.functions();
        let taken: Vec<&str> = functions.iter().map(ScalarUDF::name).filter(|name| context.udf(name).is_ok()).collect();
        if !taken.is_empty() {
            let expected = "names that the session does not have: give this robot a prefix by `prefixed`";
            return Err(misconfigured(format!("register: found functions {} in the session, expected {expected}", taken.join(", "))));
        }
        functions.into_iter().for_each(|function| context.register_udf(function));
        Ok(())
    }
}
