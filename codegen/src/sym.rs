//! The symbolic scalar: a node of the graph that is being traced on this thread.
//!
//! Operations are calls, not inlined: algorithms would become several times as large, and as long
//! to compile, for nothing.

use std::cell::RefCell;
use std::fmt;
use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};

use articulated_core::Scalar;
use num_traits::{One, Zero};

use crate::graph::{Graph, NodeId, Op};

thread_local! {
    static GRAPH: RefCell<Graph> = RefCell::default();
}

/// A symbol. Its arithmetic adds nodes to the graph that is being traced on this thread.
#[derive(Clone, Copy, PartialEq)]
pub struct Sym(NodeId);

impl Sym {
    /// Element `index` of argument number `argument`.
    pub fn input(argument: usize, index: usize) -> Self {
        Self(with(|g| g.input(argument, index)))
    }
}

/// Runs `program` and returns the graph that it built, with what it returned as outputs.
///
/// Any function over [`Scalar`] can be traced:
///
/// ```
/// use articulated_codegen::core::Scalar;
/// use articulated_codegen::sym::{Sym, trace};
///
/// let graph = trace(|| {
///     let q = Sym::input(0, 0);
///     vec![q.sin_cos().0 * Sym::from_f64(9.81) + Sym::from_f64(0.0)]
/// });
/// // Adding zero costs nothing.
/// assert_eq!((graph.counts().multiplications(), graph.counts().additions()), (1, 0));
/// ```
pub fn trace(program: impl FnOnce() -> Vec<Sym>) -> Graph {
    let outer = GRAPH.take();
    let outputs = program();
    let mut graph = GRAPH.replace(outer);
    graph.outputs = outputs.into_iter().map(|s| s.0).collect();
    graph
}

fn with<T>(f: impl FnOnce(&mut Graph) -> T) -> T {
    GRAPH.with_borrow_mut(f)
}

fn apply(op: Op, operands: &[Sym]) -> Sym {
    let mut ids = [NodeId(0); 3];
    for (id, s) in ids.iter_mut().zip(operands) {
        *id = s.0;
    }
    Sym(with(|g| g.apply(op, &ids[..operands.len()])))
}

impl fmt::Debug for Sym {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "x{}", self.0.0)
    }
}

macro_rules! operator {
    ($op:ident, $trait:ident::$method:ident, $assign:ident::$assign_method:ident) => {
        impl $trait for Sym {
            type Output = Sym;
            #[inline(never)]
            fn $method(self, other: Sym) -> Sym {
                apply(Op::$op, &[self, other])
            }
        }
        impl $assign for Sym {
            #[inline(never)]
            fn $assign_method(&mut self, other: Sym) {
                *self = apply(Op::$op, &[*self, other]);
            }
        }
    };
}

operator!(Add, Add::add, AddAssign::add_assign);
operator!(Sub, Sub::sub, SubAssign::sub_assign);
operator!(Mul, Mul::mul, MulAssign::mul_assign);

impl Div for Sym {
    type Output = Sym;
    #[inline(never)]
    fn div(self, other: Sym) -> Sym {
        apply(Op::Div, &[self, other])
    }
}

impl Neg for Sym {
    type Output = Sym;
    #[inline(never)]
    fn neg(self) -> Sym {
        apply(Op::Neg, &[self])
    }
}

impl Zero for Sym {
    fn zero() -> Self {
        Self::from_f64(0.0)
    }
    fn is_zero(&self) -> bool {
        *self == Self::zero()
    }
}

impl One for Sym {
    fn one() -> Self {
        Self::from_f64(1.0)
    }
}

impl Scalar for Sym {
    const FOLDS: bool = true;

    type Mask = Sym;

    fn from_f64(x: f64) -> Self {
        Self(with(|g| g.constant(x)))
    }

    fn sin_cos(self) -> (Self, Self) {
        (apply(Op::Sin, &[self]), apply(Op::Cos, &[self]))
    }

    fn sqrt(self) -> Self {
        apply(Op::Sqrt, &[self])
    }

    fn atan2(self, x: Self) -> Self {
        apply(Op::Atan2, &[self, x])
    }

    fn positive(self) -> Sym {
        apply(Op::Positive, &[self])
    }

    fn select(mask: Sym, a: Self, b: Self) -> Self {
        apply(Op::Select, &[mask, a, b])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_traced_program_evaluates_to_what_it_says() {
        let program = || {
            let (x, y) = (Sym::input(0, 0), Sym::input(1, 0));
            let (s, c) = x.sin_cos();
            vec![s * s + c * c, Scalar::abs(y), (x / y).sqrt(), y.atan2(x), Sym::one().atan2(Sym::zero())]
        };
        let graph = trace(program);
        let out = graph.evaluate(|argument, _| if argument == 0 { -0.5 } else { -2.0 });
        assert!((out[0] - 1.0).abs() < 1e-15);
        assert_eq!(&out[1..], [2.0, 0.5, f64::atan2(-2.0, -0.5), std::f64::consts::FRAC_PI_2]);
    }
}
