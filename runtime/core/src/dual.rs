//! Numbers with one derivative.

#[cfg(feature = "alloc")]
use alloc::vec::Vec;
use core::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};

use num_traits::{One, Zero};

use crate::Scalar;
#[cfg(feature = "alloc")]
use crate::region;

/// x + ε x', with ε² = 0: results computed with it have their exact derivatives (Clifford, *Proc.
/// London Math. Soc.* 4, 1871). Nested, it has the second derivative too.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dual<S> {
    /// x.
    pub value: S,
    /// x'.
    pub slope: S,
}

impl<S: Scalar> Dual<S> {
    /// x + ε x'.
    pub fn new(value: S, slope: S) -> Self {
        Self { value, slope }
    }

    /// A constant.
    pub fn constant(value: S) -> Self {
        Self { value, slope: S::zero() }
    }

    /// x + ε: the variable itself.
    pub fn variable(value: S) -> Self {
        Self { value, slope: S::one() }
    }
}

impl<S: Scalar> Zero for Dual<S> {
    fn zero() -> Self {
        Self::constant(S::zero())
    }

    fn is_zero(&self) -> bool {
        self.value.is_zero() && self.slope.is_zero()
    }
}

impl<S: Scalar> One for Dual<S> {
    fn one() -> Self {
        Self::constant(S::one())
    }
}

impl<S: Scalar> Add for Dual<S> {
    type Output = Self;

    fn add(self, b: Self) -> Self {
        Self { value: self.value + b.value, slope: self.slope + b.slope }
    }
}

impl<S: Scalar> Sub for Dual<S> {
    type Output = Self;

    fn sub(self, b: Self) -> Self {
        Self { value: self.value - b.value, slope: self.slope - b.slope }
    }
}

impl<S: Scalar> Neg for Dual<S> {
    type Output = Self;

    fn neg(self) -> Self {
        Self { value: -self.value, slope: -self.slope }
    }
}

impl<S: Scalar> Mul for Dual<S> {
    type Output = Self;

    // (ab)' = a'b + ab'
    fn mul(self, b: Self) -> Self {
        Self { value: self.value * b.value, slope: self.slope * b.value + self.value * b.slope }
    }
}

impl<S: Scalar> Div for Dual<S> {
    type Output = Self;

    // From a = c·b: c' = (a' − c b') / b
    fn div(self, b: Self) -> Self {
        let value = self.value / b.value;
        Self { value, slope: (self.slope - value * b.slope) / b.value }
    }
}

impl<S: Scalar> AddAssign for Dual<S> {
    fn add_assign(&mut self, b: Self) {
        *self = *self + b;
    }
}

impl<S: Scalar> SubAssign for Dual<S> {
    fn sub_assign(&mut self, b: Self) {
        *self = *self - b;
    }
}

impl<S: Scalar> MulAssign for Dual<S> {
    fn mul_assign(&mut self, b: Self) {
        *self = *self * b;
    }
}

impl<S: Scalar> Scalar for Dual<S> {
    type Mask = S::Mask;

    const BITS: u32 = S::BITS;

    fn from_f64(x: f64) -> Self {
        Self::constant(S::from_f64(x))
    }

    // s' = c x', c' = −s x'
    fn sin_cos(self) -> (Self, Self) {
        let (s, c) = self.value.sin_cos();
        (Self { value: s, slope: c * self.slope }, Self { value: c, slope: -(s * self.slope) })
    }

    // r' = x' / 2r
    fn sqrt(self) -> Self {
        let value = self.value.sqrt();
        Self { value, slope: self.slope / (value + value) }
    }

    // θ' = (x y' − y x') / (x² + y²)
    fn atan2(self, x: Self) -> Self {
        let square = x.value * x.value + self.value * self.value;
        Self { value: self.value.atan2(x.value), slope: (x.value * self.slope - self.value * x.slope) / square }
    }

    fn positive(self) -> S::Mask {
        self.value.positive()
    }

    fn select(mask: S::Mask, a: Self, b: Self) -> Self {
        Self { value: S::select(mask, a.value, b.value), slope: S::select(mask, a.slope, b.slope) }
    }

    fn orders() -> usize {
        S::orders() + 1
    }

    fn held(x: &mut [Self], value: impl FnOnce(&mut [Self])) {
        value(x);
        x.iter_mut().for_each(|x| *x = Self::constant(x.value));
    }

    // dx = −(∂r/∂x)⁻¹ ∂r/∂p dp
    #[cfg(feature = "alloc")]
    fn implicit<C>(
        context: &mut C,
        x: &mut [Self],
        value: impl FnOnce(&mut C, &mut [Self]),
        residual: impl FnOnce(&mut C, &[Self], &mut [Self]),
        solve: impl FnOnce(&mut C, &mut [Self]),
    ) {
        Self::held(x, |x| value(context, x));
        let mut slopes: Vec<Self> = region::zeros(x.len());
        residual(context, x, &mut slopes);
        slopes.iter_mut().for_each(|r| *r = Self::constant(r.slope));
        solve(context, &mut slopes);
        x.iter_mut().zip(slopes).for_each(|(x, own)| x.slope = -own.value);
    }

    // The values first, then the slopes at the fixed point.
    #[cfg(feature = "alloc")]
    fn repeat(most: usize, state: &mut [Self], mut body: impl FnMut(&mut [Self]) -> S::Mask) -> S::Mask {
        let mut values: Vec<S> = state.iter().map(|x| x.value).collect();
        let converged = S::repeat(most, &mut values, |values| {
            let mut held: Vec<Self> = values.iter().copied().map(Self::constant).collect();
            let ends = body(&mut held);
            values.iter_mut().zip(held).for_each(|(value, held)| *value = held.value);
            ends
        });
        let mut slopes = region::zeros(state.len());
        region::repeat_slopes(most, &mut slopes, |slopes| {
            let mut moved: Vec<Self> = values.iter().zip(slopes.iter()).map(|(value, slope)| Self::new(*value, *slope)).collect();
            let _ = body(&mut moved);
            slopes.iter_mut().zip(moved).for_each(|(slope, moved)| *slope = moved.slope);
        });
        state.iter_mut().zip(values.iter().zip(slopes)).for_each(|(x, (value, slope))| *x = Self::new(*value, slope));
        converged
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// f(t) with its first derivative by differences of fourth order, and nested with its second.
    fn near(f: impl Fn(Dual<Dual<f64>>) -> Dual<Dual<f64>>) {
        let (t, h) = (0.7, 1e-3);
        let at = |k: f64| f(Dual::constant(Dual::constant(t + k * h))).value.value;
        let first = (8.0 * (at(1.0) - at(-1.0)) - (at(2.0) - at(-2.0))) / (12.0 * h);
        let second = (16.0 * (at(1.0) + at(-1.0)) - (at(2.0) + at(-2.0)) - 30.0 * at(0.0)) / (12.0 * h * h);
        let exact = f(Dual::new(Dual::variable(t), Dual::one()));
        assert!((exact.value.slope - first).abs() < 1e-10 && (exact.slope.value - first).abs() < 1e-10, "{exact:?} {first}");
        assert!((exact.slope.slope - second).abs() < 1e-8, "{exact:?} {second}");
    }

    /// x² = p, from a value alone.
    #[test]
    fn the_slope_of_what_solves_an_equation_is_that_of_the_equation() {
        let p = Dual::new(2.0_f64, 3.0);
        let mut x = [Dual::constant(0.0)];
        let residual = |_: &mut (), x: &[Dual<f64>], r: &mut [Dual<f64>]| r[0] = x[0] * x[0] - p;
        let root = 2_f64.sqrt();
        let solve = |_: &mut (), b: &mut [Dual<f64>]| b[0] = b[0] / Dual::constant(2.0 * root);
        Dual::implicit(&mut (), &mut x, |_, x| x[0] = Dual::constant(root), residual, solve);
        assert!(x[0].value == root && (x[0].slope - 3.0 / (2.0 * root)).abs() < 1e-15, "{:?}", x[0]);
        Dual::held(&mut x, |x| x[0] = p);
        assert_eq!((x[0].value, x[0].slope), (2.0, 0.0));
    }

    #[test]
    fn slopes_are_those_of_differences() {
        near(|t| t * t * t - t);
        near(|t| t.sin_cos().0 / (t + Dual::one()));
        near(|t| (t * t).sin_cos().1 * t.sqrt());
        near(|t| Scalar::abs(-t));
        near(|t| (t * t).atan2(-t.sin_cos().1));
        near(|t| t.atan2(Dual::one() - t * t));
    }
}
