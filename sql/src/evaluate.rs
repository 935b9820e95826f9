//! Loaded and generated robots, as functions call them: row by row.

use std::any::Any;

use articulated::algorithm::{Function, Needs};
use articulated::{Dynamics, FunctionError, Model, Shape};
use datafusion::arrow::buffer::NullBuffer;

use crate::columns::Column;

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
