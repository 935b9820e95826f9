//! Robots in many digits.

use articulated_core::Scalar;
use articulated_core::algorithm::textbook::Textbook;
use articulated_core::algorithm::{FunctionId, Workspace, articulated_body};
use articulated_core::description::{Base, Description};
use articulated_core::model::{Model, ModelError};

use crate::big::Big;

/// A robot whose functions are computed with [`Big`]; create and use it in a [`Big::scope`].
pub struct Exact(Form);

enum Form {
    Textbook(Box<Textbook<Big>>),
    Library(Box<Model<Big>>),
}

impl Exact {
    /// The textbook's form on the numbers of the description, with a frame for each link; gravity
    /// in the world frame, m/s². Effects are not included. Errors: those of [`Model::new`].
    pub fn textbook(description: &Description, base: Base, gravity: [f64; 3]) -> Result<Self, ModelError> {
        Ok(Self(Form::Textbook(Box::new(Textbook::new(description, base, gravity)?))))
    }

    /// The generic library on the numbers of the model, with its frames and its effects.
    pub fn library(model: &Model<f64>) -> Self {
        Self(Form::Library(Box::new(model.cast())))
    }

    /// With the frames of the model, in its order, and its reference of wrenches; `None` if a link
    /// is missing.
    #[must_use]
    pub fn with_frames_of(self, model: &Model<f64>) -> Option<Self> {
        let names: Vec<&str> = model.frames().iter().map(|f| f.name.as_str()).collect();
        let form = match self.0 {
            Form::Textbook(book) => Form::Textbook(Box::new(book.with_frames(&names).ok()?.with_wrenches_in(model.wrench_reference()))),
            Form::Library(own) => Form::Library(Box::new(own.with_frames(&names).ok()?.with_wrenches_in(model.wrench_reference()))),
        };
        Some(Self(form))
    }

    /// The result of a function, its arguments in the table's order; `None` if it is not available,
    /// or the arguments have wrong lengths.
    pub fn call(&self, function: FunctionId, arguments: &[&[Big]]) -> Option<Vec<Big>> {
        let model = match &self.0 {
            Form::Textbook(textbook) => return textbook.call(function.name(), arguments)?.ok(),
            Form::Library(model) => model,
        };
        let row = function.row::<Big>();
        let mut out = vec![Big::from_f64(0.0); row.len(model.shape())];
        row.call(model, &mut Workspace::new(model), arguments, &mut out).ok()?;
        Some(out)
    }

    /// Accelerations by the articulated-body algorithm, where the robot has it: no joint follows
    /// another. Arguments of the robot's lengths.
    pub fn articulated_body(&self, [q, v, tau]: [&[Big]; 3]) -> Option<Vec<Big>> {
        let Form::Library(model) = &self.0 else { return None };
        if model.bodies().iter().any(|body| body.coordinates.mimic.is_some()) {
            return None;
        }
        let mut a = vec![Big::from_f64(0.0); model.nv()];
        articulated_body(model, &mut Workspace::new(model), q, v, tau, &mut a);
        Some(a)
    }
}
