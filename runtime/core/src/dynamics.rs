//! One interface to a robot's dynamics, whether it was generated or loaded at run time.

use crate::Scalar;
use crate::algorithm::table::for_each_function;
use crate::algorithm::{FunctionError, FunctionId, Shape, Workspace};
use crate::model::Model;

macro_rules! methods {
    ($($name:ident($($argument:ident),*) -> [$($dim:ident $(($n:literal))?),*] $unit:literal, $needs:ident, $regrouped:literal,
        $summary:literal, $source:literal $(, by $ways:tt)? $(, columns $unsolved:ident)?;)*) => {
        /// A robot's dynamics. Code written over this trait runs on generated robots and on a [`Model`] alike.
        ///
        /// Every function of the table is a method; shapes, units and frames are those of the function with the same name in
        /// [`crate::algorithm`], results are written row by row. A slice of the wrong length is an error, and so is a function that
        /// a robot was generated without; nothing panics.
        pub trait Dynamics<S: Scalar = f64> {
            /// What an evaluation needs room for; `()` for generated robots.
            type Workspace;

            /// A workspace, to be made once.
            fn workspace(&self) -> Self::Workspace;

            /// Numbers of coordinates, degrees of freedom, frames and moving links.
            fn shape(&self) -> Shape;

            /// The robot's name.
            fn name(&self) -> &str;

            /// The joint that a degree of freedom belongs to, where the robot can tell.
            fn joint_of(&self, freedom: usize) -> Option<&str> {
                let _ = freedom;
                None
            }

            /// Any function by its number; `arguments` in its order.
            fn call(&self, function: FunctionId, ws: &mut Self::Workspace, arguments: &[&[S]], out: &mut [S]) -> Result<(), FunctionError>;

            $(
                #[doc = concat!($summary, ".\n\nout: `[", stringify!($($dim $(($n))?),*), "]`, ", $unit, ".")]
                #[inline]
                fn $name(&self, ws: &mut Self::Workspace, $($argument: &[S],)* out: &mut [S]) -> Result<(), FunctionError> {
                    self.call(FunctionId::$name, ws, &[$($argument),*], out)
                }
            )*
        }
    };
}

for_each_function!(methods);

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

    fn joint_of(&self, freedom: usize) -> Option<&str> {
        (freedom < self.nv).then(|| Model::joint_of(self, freedom))
    }

    #[inline]
    fn call(&self, function: FunctionId, ws: &mut Workspace<S>, arguments: &[&[S]], out: &mut [S]) -> Result<(), FunctionError> {
        function.row().call(self, ws, arguments, out)
    }
}
