//! The arguments and the result of each function, in numbers of one robot.

use articulated::Shape;
use articulated::algorithm::{Dim, Function, functions};
use numpy::npyffi::npy_intp;

/// The most arguments that a function takes.
pub(crate) const MOST_ARGUMENTS: usize = 8;

/// The size of an array of one state.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Size {
    /// The dimensions, as NumPy has them, and ones.
    pub(crate) dims: [npy_intp; 3],
    count: usize,
    /// How many numbers.
    pub(crate) len: usize,
}

impl Size {
    fn of(dims: &[Dim], shape: Shape) -> Self {
        let mut out = Self { dims: [1; 3], count: dims.len(), len: 1 };
        for (k, dim) in dims.iter().enumerate() {
            let n = dim.len(shape);
            out.dims[k] = n as npy_intp;
            out.len *= n;
        }
        out
    }

    /// The dimensions.
    pub(crate) fn dims(&self) -> &[npy_intp] {
        &self.dims[..self.count]
    }

    /// The same as lengths.
    pub(crate) fn lengths(&self) -> Vec<usize> {
        self.dims().iter().map(|n| *n as usize).collect()
    }
}

/// A function's arguments and its result.
#[derive(Clone)]
pub(crate) struct Signature {
    pub(crate) function: &'static Function<f64>,
    pub(crate) arguments: Vec<Size>,
    pub(crate) result: Size,
}

/// Of all functions of the table, for a robot of these sizes.
pub(crate) fn signatures(shape: Shape) -> Vec<Signature> {
    let one = |function: &'static Function<f64>| Signature {
        function,
        arguments: function.takes.iter().map(|argument| Size::of(argument.dims(), shape)).collect(),
        result: Size::of(function.gives, shape),
    };
    functions::<f64>().iter().map(one).collect()
}
