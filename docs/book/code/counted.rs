//! A scalar that counts the operations that a function executes.

use std::cell::Cell;
use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};

use articulated::Scalar;
use num_traits::{One, Zero};

thread_local! {
    static OPERATIONS: Cell<u64> = const { Cell::new(0) };
}

/// An `f64` whose additions, multiplications, divisions, roots and sines are counted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Counted(pub f64);

/// Number of operations that `work` executes in this thread.
pub fn count(work: impl FnOnce()) -> u64 {
    let before = OPERATIONS.get();
    work();
    OPERATIONS.get() - before
}

fn counted(x: f64) -> Counted {
    OPERATIONS.set(OPERATIONS.get() + 1);
    Counted(x)
}

macro_rules! operation {
    ($($op:ident, $f:ident);+) => { $(
        impl $op for Counted {
            type Output = Self;
            fn $f(self, b: Self) -> Self {
                counted($op::$f(self.0, b.0))
            }
        }
    )+ };
}
operation!(Add, add; Sub, sub; Mul, mul; Div, div);

macro_rules! assignment {
    ($($op:ident, $f:ident, $by:ident);+) => { $(
        impl $op for Counted {
            fn $f(&mut self, b: Self) {
                *self = self.$by(b);
            }
        }
    )+ };
}
assignment!(AddAssign, add_assign, add; SubAssign, sub_assign, sub; MulAssign, mul_assign, mul);

impl Neg for Counted {
    type Output = Self;
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl Zero for Counted {
    fn zero() -> Self {
        Self(0.0)
    }
    fn is_zero(&self) -> bool {
        self.0 == 0.0
    }
}

impl One for Counted {
    fn one() -> Self {
        Self(1.0)
    }
}

impl Scalar for Counted {
    type Mask = bool;

    fn from_f64(x: f64) -> Self {
        Self(x)
    }
    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = self.0.sin_cos();
        (counted(sin), counted(cos))
    }
    fn sqrt(self) -> Self {
        counted(self.0.sqrt())
    }
    fn atan2(self, x: Self) -> Self {
        counted(self.0.atan2(x.0))
    }
    fn positive(self) -> bool {
        self.0 > 0.0
    }
    fn select(mask: bool, a: Self, b: Self) -> Self {
        if mask { a } else { b }
    }
}
