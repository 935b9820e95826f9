//! One interface to a robot's dynamics, whether it was generated or loaded at run time.

use alloc::vec;
use alloc::vec::Vec;

use crate::Scalar;
use crate::algorithm::argument::{dims, documentation};
use crate::algorithm::table::for_each_function;
use crate::algorithm::{Argument, FunctionError, FunctionId, Shape, Workspace};
use crate::index::FrameId;
use crate::model::{JointInfo, JointRow, Model};

macro_rules! methods {
    ($($name:ident($($argument:ident),*) $(= $general:ident)?
        $(-> [$($dim:ident $(($n:literal))?),*] $unit:literal, $group:ident, $needs:ident, $regrouped:literal)?,
        $summary:literal $(, $source:literal)? $(, by $ways:tt)? $(, columns $unsolved:ident)?;)*) => {
        /// The result of a function, with its unit; for a preset, that of its row.
        macro_rules! gives {
            $(($name) => { $(gives!($general))? $(concat!("`", dims!($($dim $(($n))?),*), "` ", $unit))? };)*
        }

        /// A robot's dynamics. Code written over this trait runs on generated robots and on a
        /// [`Model`] alike.
        ///
        /// Every function of the table is a method. Its documentation has arguments and results;
        /// more is at the function of the same name in [`crate::algorithm`]. Results are written
        /// row by row. A slice of the wrong length is an error, and so is a function that a robot
        /// was generated without. Nothing panics.
        ///
        /// ```
        /// use articulated_core::algorithm::FunctionError;
        /// use articulated_core::dynamics::Dynamics;
        ///
        /// /// Torques that hold any robot at q, N·m or N.
        /// fn holding<R: Dynamics>(robot: &R, q: &[f64]) -> Result<Vec<f64>, FunctionError> {
        ///     let mut ws = robot.workspace(); // once, outside of loops
        ///     let mut tau = vec![0.0; robot.shape().nv];
        ///     robot.gravity_torque(&mut ws, q, &mut tau)?;
        ///     Ok(tau)
        /// }
        /// ```
        pub trait Dynamics<S: Scalar = f64> {
            /// Memory that an evaluation needs; `()` for generated robots.
            type Workspace;

            /// A workspace, to be made once.
            fn workspace(&self) -> Self::Workspace;

            /// Numbers of coordinates, degrees of freedom, frames and moving links.
            fn shape(&self) -> Shape;

            /// The robot's name.
            fn name(&self) -> &str;

            /// The joints in the order of their coordinates, a floating base's own first; `None`
            /// beyond the last, and if the robot does not know it.
            fn joint(&self, index: usize) -> Option<JointRow<'_>> {
                let _ = index;
                None
            }

            /// The name of a frame, if the robot knows it.
            fn frame_name(&self, frame: usize) -> Option<&str> {
                let _ = frame;
                None
            }

            /// Whether there are motors between the input torques of forward dynamics and the
            /// joints: then `motor_torques` computes their output.
            fn has_motors(&self) -> bool {
                false
            }

            /// The joint that a degree of freedom belongs to, if the robot knows it.
            fn joint_of(&self, freedom: usize) -> Option<&str> {
                let mut joints = (0..).map_while(|k| self.joint(k));
                joints.find(|j| (j.v.0..j.v.0 + j.v.1).contains(&freedom)).map(|j| j.name)
            }

            /// The joint of this name.
            fn joint_named(&self, name: &str) -> Option<JointRow<'_>> {
                (0..).map_while(|k| self.joint(k)).find(|j| j.name == name)
            }

            /// The index of the frame of this name, among those in results of functions of frames.
            fn frame_named(&self, name: &str) -> Option<usize> {
                (0..self.shape().frames).find(|k| self.frame_name(*k) == Some(name))
            }

            /// Any function by its number; `arguments` in its order.
            fn call(&self, function: FunctionId, ws: &mut Self::Workspace, arguments: &[&[S]], out: &mut [S]) -> Result<(), FunctionError>;

            /// Checks that the robot has the function, by a call at a dummy state.
            fn check_function(&self, ws: &mut Self::Workspace, function: FunctionId) -> Result<(), FunctionError> {
                let (row, shape) = (function.row::<S>(), self.shape());
                let half = |argument: &Argument| vec![S::from_f64(0.5); argument.len(shape)];
                let arguments: Vec<Vec<S>> = row.takes.iter().map(half).collect();
                let arguments: Vec<&[S]> = arguments.iter().map(Vec::as_slice).collect();
                self.call(function, ws, &arguments, &mut vec![S::zero(); row.len(shape)])
            }

            $(
                #[doc = concat!($summary, ".\n\n", $("* ", documentation!($argument), "\n",)* "* out: ", gives!($name), ".")]
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

    fn joint(&self, index: usize) -> Option<JointRow<'_>> {
        self.joints.get(index).map(JointInfo::row)
    }

    fn frame_name(&self, frame: usize) -> Option<&str> {
        self.frames.get(FrameId(frame)).map(|f| f.name.as_str())
    }

    fn has_motors(&self) -> bool {
        Model::has_motors(self)
    }

    #[inline]
    fn call(&self, function: FunctionId, ws: &mut Workspace<S>, arguments: &[&[S]], out: &mut [S]) -> Result<(), FunctionError> {
        function.row().call(self, ws, arguments, out)
    }
}
