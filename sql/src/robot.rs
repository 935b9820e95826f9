//! The robot whose functions a session gets.

use std::any::Any;
use std::fmt;
use std::path::Path;
use std::sync::Arc;

use articulated::algorithm::{Function, Needs, function, functions};
use articulated::{Base, Dynamics, FunctionError, FunctionId, LoadError, Model, Shape};
use datafusion::arrow::buffer::NullBuffer;
use datafusion::error::{DataFusionError, Result};
use datafusion::execution::FunctionRegistry;
use datafusion::logical_expr::ScalarUDF;
use datafusion::prelude::SessionContext;

use crate::batch::{Batch, Run, mismatches};
use crate::columns::Column;
use crate::function::{Names, RobotFunction};

/// A loaded or a generated robot.
pub(crate) trait Evaluate: Send + Sync {
    fn shape(&self) -> Shape;

    /// Why a function is not defined for the robot.
    fn refusal(&self, function: &'static Function<f64>) -> Option<String>;

    /// A name for each degree of freedom.
    fn joint_names(&self) -> Vec<String>;

    /// A name for each frame.
    fn frame_names(&self) -> Vec<String>;

    /// The function in each row; rows that are null stay as they are.
    fn rows(
        &self,
        function: &'static Function<f64>,
        columns: &[Column],
        nulls: Option<&NullBuffer>,
        out: &mut [f64],
    ) -> Result<(), FunctionError>;
}

impl<R: Dynamics + Send + Sync + 'static> Evaluate for R {
    fn shape(&self) -> Shape {
        Dynamics::shape(self)
    }

    fn refusal(&self, function: &'static Function<f64>) -> Option<String> {
        if let Some(model) = (self as &dyn Any).downcast_ref::<Model<f64>>() {
            return undefined(model, function);
        }
        // The generator has refused what is not defined.
        match self.check_function(&mut self.workspace(), function.id) {
            Err(FunctionError::NotGenerated { .. }) => {
                Some("found a robot that was generated without this function, expected its name in `functions`".into())
            }
            other => other.err().map(|error| error.to_string()),
        }
    }

    fn joint_names(&self) -> Vec<String> {
        let mut names: Vec<String> = (0..Dynamics::shape(self).nv).map(|k| format!("v[{k}]")).collect();
        for joint in (0..).map_while(|k| self.joint(k)) {
            for k in 0..joint.v.1 {
                let name = if joint.v.1 == 1 { joint.name.to_owned() } else { format!("{}[{k}]", joint.name) };
                if let Some(place) = names.get_mut(joint.v.0 + k) {
                    *place = name;
                }
            }
        }
        names
    }

    fn frame_names(&self) -> Vec<String> {
        let name = |k| self.frame_name(k).map_or_else(|| format!("frame[{k}]"), str::to_owned);
        (0..Dynamics::shape(self).frames).map(name).collect()
    }

    fn rows(
        &self,
        function: &'static Function<f64>,
        columns: &[Column],
        nulls: Option<&NullBuffer>,
        out: &mut [f64],
    ) -> Result<(), FunctionError> {
        let mut ws = self.workspace();
        let mut arguments: Vec<&[f64]> = Vec::with_capacity(columns.len());
        for (row, out) in out.chunks_exact_mut(function.len(Dynamics::shape(self))).enumerate() {
            if nulls.is_none_or(|nulls| nulls.is_valid(row)) {
                arguments.clear();
                arguments.extend(columns.iter().map(|column| column.row(row)));
                self.call(function.id, &mut ws, &arguments, out)?;
            }
        }
        Ok(())
    }
}

/// What a model lacks for a function.
fn undefined(model: &Model<f64>, function: &Function<f64>) -> Option<String> {
    if function.needs == Needs::Mass && model.moving_mass() == 0.0 {
        return Some("found no moving link with mass, expected a link with mass that moves".into());
    }
    if function.inverts_mass_matrix() {
        let mut massless: Vec<&str> = model.massless_joints().into_iter().map(|i| model.bodies()[i].name.as_str()).collect();
        // A joint of several degrees of freedom is several bodies, which follow one another.
        massless.dedup();
        if !massless.is_empty() {
            let found = format!("found no inertia of its own for joint {}", massless.join(", joint "));
            return Some(format!("{found}, expected a link behind it with an inertia: M is singular in every configuration"));
        }
    }
    if function.needs == Needs::FreeFrames {
        let bound = model.frames().iter().filter(|frame| model.freedoms_of(frame.body).len() < 6);
        let bound: Vec<&str> = bound.map(|frame| frame.name.as_str()).collect();
        if !bound.is_empty() {
            let found = format!("found fewer than six degrees of freedom for {}", bound.join(", "));
            return Some(format!("{found}, expected six for each frame: take operational_space_inertia_inverse, or `Model::with_frames`"));
        }
    }
    None
}

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
