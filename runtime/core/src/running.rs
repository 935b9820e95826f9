//! A scalar that carries a bound on its rounding error: the largest error of an evaluation,
//! operation by operation.
//!
//! Running error analysis (Wilkinson 1986; Higham, Accuracy and Stability of Numerical Algorithms,
//! 2002, 3.3) on midpoints and radii, so that it holds for one state and for a box of states alike.
//! All here is in f64 and rounded upward by a few units more than it can lose.
//!
//! Operations are calls, not inlined: algorithms would become several times as large, and as long
//! to compile, for nothing.

use core::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};

use num_traits::{One, Zero};

use crate::Scalar;
use crate::scalar::two_to;

/// A number x with |x − value| ≤ radius. An evaluation in which each operation is off by at most
/// 2^−`BITS` of its result is off from x by at most `error`. Sines: off by 2^(2−`BITS`) of their
/// value if `SINES` is 0, by 10^−`SINES` and a rounding otherwise.
///
/// Underflow counts as an error of 10⁻³⁰⁰ an operation (of 10⁻⁴⁴ for single precision).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Running<const BITS: u32, const SINES: u32> {
    /// The midpoint.
    pub value: f64,
    /// How far the exact number is from it at most.
    pub radius: f64,
    /// How far the evaluated number is from the exact one at most.
    pub error: f64,
}

/// A test, and whether its outcome is certain.
#[derive(Clone, Copy, Debug)]
pub struct Outcome {
    holds: bool,
    certain: bool,
}

/// A little more than a sum of a few products has lost.
fn up(x: f64) -> f64 {
    x * (1.0 + 64.0 * f64::EPSILON)
}

impl<const BITS: u32, const SINES: u32> Running<BITS, SINES> {
    const TINY: f64 = if BITS < 53 { 1e-44 } else { 1e-300 };

    /// An exact input within `radius` of `value`.
    pub fn within(value: f64, radius: f64) -> Self {
        Self { value, radius, error: 0.0 }
    }

    /// The error after the result is rounded to `bits` bits.
    pub fn rounded_to(self, bits: u32) -> f64 {
        up(self.error + two_to(-(bits as i32)) * (self.most() + self.error))
    }

    /// |x| at most.
    fn most(self) -> f64 {
        self.value.abs() + self.radius
    }

    /// The result of an operation: value and radius, and the error that those of its operands
    /// cause.
    fn of(value: f64, radius: f64, error: f64) -> Self {
        let radius = up(radius + f64::EPSILON * value.abs());
        // Zero times an unknown number.
        if radius.is_nan() {
            return Self::unknown();
        }
        let error = if error.is_nan() { f64::INFINITY } else { error };
        let most = value.abs() + radius + error;
        Self { value, radius, error: up(error + two_to(-(BITS as i32)) * most + Self::TINY) }
    }

    /// An unknown number.
    fn unknown() -> Self {
        Self { value: 0.0, radius: f64::INFINITY, error: f64::INFINITY }
    }

    /// One of a sine and a cosine.
    fn wave(self, value: f64) -> Self {
        let (value, radius) = if self.radius < 1.0 { (value, self.radius) } else { (0.0, 1.0) };
        let error = self.error.min(2.0);
        let most = (value.abs() + radius + error).min(1.0);
        let own =
            if SINES == 0 { 4.0 * two_to(-(BITS as i32)) * most } else { libm::pow(10.0, -f64::from(SINES)) + two_to(-(BITS as i32)) };
        Self { value, radius: up(radius + 2.0 * f64::EPSILON), error: up(error + own + Self::TINY) }
    }
}

impl<const BITS: u32, const SINES: u32> Zero for Running<BITS, SINES> {
    fn zero() -> Self {
        Self::within(0.0, 0.0)
    }

    fn is_zero(&self) -> bool {
        *self == Self::zero()
    }
}

impl<const BITS: u32, const SINES: u32> One for Running<BITS, SINES> {
    fn one() -> Self {
        Self::within(1.0, 0.0)
    }
}

impl<const BITS: u32, const SINES: u32> Add for Running<BITS, SINES> {
    type Output = Self;

    #[inline(never)]
    fn add(self, b: Self) -> Self {
        if self.is_zero() {
            return b;
        }
        if b.is_zero() {
            return self;
        }
        Self::of(self.value + b.value, self.radius + b.radius, self.error + b.error)
    }
}

impl<const BITS: u32, const SINES: u32> Sub for Running<BITS, SINES> {
    type Output = Self;

    #[inline(never)]
    fn sub(self, b: Self) -> Self {
        self + -b
    }
}

impl<const BITS: u32, const SINES: u32> Mul for Running<BITS, SINES> {
    type Output = Self;

    #[inline(never)]
    fn mul(self, b: Self) -> Self {
        if self.is_zero() || b.is_zero() {
            return Self::zero();
        }
        let radius = self.value.abs() * b.radius + b.value.abs() * self.radius + self.radius * b.radius;
        let error = self.most() * b.error + b.most() * self.error + self.error * b.error;
        Self::of(self.value * b.value, radius, error)
    }
}

impl<const BITS: u32, const SINES: u32> Div for Running<BITS, SINES> {
    type Output = Self;

    #[inline(never)]
    fn div(self, b: Self) -> Self {
        let least = (b.value.abs() - b.radius) * (1.0 - 64.0 * f64::EPSILON);
        let apart = least > b.error * (1.0 + 64.0 * f64::EPSILON);
        if !apart {
            return Self::unknown();
        }
        let value = self.value / b.value;
        let radius = (self.radius + value.abs() * b.radius) / least;
        let error = (self.error + (value.abs() + radius) * (1.0 + 64.0 * f64::EPSILON) * b.error) / (least - b.error);
        Self::of(value, radius, error)
    }
}

impl<const BITS: u32, const SINES: u32> Neg for Running<BITS, SINES> {
    type Output = Self;

    #[inline(never)]
    fn neg(self) -> Self {
        Self { value: -self.value, ..self }
    }
}

impl<const BITS: u32, const SINES: u32> AddAssign for Running<BITS, SINES> {
    #[inline(never)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<const BITS: u32, const SINES: u32> SubAssign for Running<BITS, SINES> {
    #[inline(never)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl<const BITS: u32, const SINES: u32> MulAssign for Running<BITS, SINES> {
    #[inline(never)]
    fn mul_assign(&mut self, other: Self) {
        *self = *self * other;
    }
}

impl<const BITS: u32, const SINES: u32> Scalar for Running<BITS, SINES> {
    type Mask = Outcome;

    /// A constant: fewer bits than 53 round it.
    #[inline(never)]
    fn from_f64(x: f64) -> Self {
        Self { value: x, radius: 0.0, error: if BITS < 53 { up(two_to(-(BITS as i32)) * x.abs()) } else { 0.0 } }
    }

    #[inline(never)]
    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = Scalar::sin_cos(self.value);
        (self.wave(sin), self.wave(cos))
    }

    // |√x − √y| = |x − y| / (√x + √y) ≤ √|x − y|
    #[inline(never)]
    fn sqrt(self) -> Self {
        let least = self.value - self.radius;
        let change = |by: f64, least: f64| {
            let coarse = Scalar::sqrt(by);
            if least > 0.0 { coarse.min(by / Scalar::sqrt(least)) } else { coarse }
        };
        Self::of(Scalar::sqrt(self.value.max(0.0)), change(self.radius, self.value.max(0.0)), change(self.error, least))
    }

    // The angle under which a change is seen from the origin.
    #[inline(never)]
    fn atan2(self, x: Self) -> Self {
        let (by, off) = (self.radius + x.radius, self.error + x.error);
        let size = libm::hypot(self.value, x.value);
        let near_the_cut = x.value - x.radius - x.error <= 0.0 && self.value.abs() <= self.radius + self.error;
        let apart = size > 2.0 * (by + off);
        if near_the_cut && (by > 0.0 || off > 0.0) || !apart {
            return if by + off == 0.0 { Self::of(Scalar::atan2(self.value, x.value), 0.0, 0.0) } else { Self::unknown() };
        }
        Self::of(Scalar::atan2(self.value, x.value), 2.0 * by / size, 4.0 * off / size)
    }

    fn positive(self) -> Outcome {
        Outcome { holds: self.value > 0.0, certain: self.value.abs() > self.radius + self.error || self.is_zero() }
    }

    fn select(mask: Outcome, a: Self, b: Self) -> Self {
        let (one, other) = if mask.holds { (a, b) } else { (b, a) };
        if mask.certain {
            return one;
        }
        // Either may be right, and either may be taken.
        let apart = (one.value - other.value).abs();
        let radius = up(one.radius.max(apart + other.radius));
        Self { value: one.value, radius, error: up(one.error.max(other.error) + 2.0 * radius) }
    }

    /// Where it is uncertain whether a turn is the last, the errors of the state are unbounded.
    #[cfg(feature = "alloc")]
    fn repeat(most: usize, state: &mut [Self], mut body: impl FnMut(&mut [Self]) -> Outcome) -> Outcome {
        let mut certain = true;
        let holds = (0..most).any(|_| {
            let ends = body(state);
            certain &= ends.certain;
            ends.holds
        });
        if !certain {
            state.iter_mut().for_each(|x| (x.radius, x.error) = (f64::INFINITY, f64::INFINITY));
        }
        Outcome { holds, certain }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    type Single = Running<24, 0>;

    #[test]
    fn bounds_hold_for_single_precision() {
        let mut x = 0.3_f32;
        for k in 0..2000 {
            x = (x * 3.7 * (1.0 - x)).clamp(0.01, 0.99);
            let y = 1.0 + x * k as f32 * 0.01;
            let (a, b) = (Single::within(f64::from(x), 0.0), Single::within(f64::from(y), 0.0));
            let found = [(x * y - x / y) - x * x, x.sin() * y.sqrt() - y.cos(), (x - y) * (x + y)];
            let bound = [(a * b - a / b) - a * a, Scalar::sin_cos(a).0 * b.sqrt() - Scalar::sin_cos(b).1, (a - b) * (a + b)];
            for (found, bound) in found.iter().zip(bound) {
                let error = (f64::from(*found) - bound.value).abs();
                assert!(error <= bound.error + bound.radius, "{error:e} {bound:?}");
                assert!(bound.error < 1e-4 && bound.radius < 1e-12);
            }
        }
    }

    /// Multiples of the golden section, from 0 to 1.
    fn numbers() -> impl Iterator<Item = f64> {
        (1..).map(|k| (0.618_033_988_749_895 * f64::from(k)) % 1.0)
    }

    /// f on a box of states, in single precision: every state in the box has its result within the
    /// radius, and its evaluation within the error of that. `f` of the bounds, of `f64` and of
    /// `f32`. Returns the largest parts of radius and error that were needed.
    fn hold(
        (midpoints, radii): ([f64; 2], [f64; 2]),
        f: impl Fn(Single, Single) -> Single,
        exact: impl Fn(f64, f64) -> f64,
        found: impl Fn(f32, f32) -> f32,
    ) -> (f64, f64) {
        let bound = f(Single::within(midpoints[0], radii[0]), Single::within(midpoints[1], radii[1]));
        let mut random = numbers();
        let (mut far, mut off) = (0.0_f64, 0.0_f64);
        for _ in 0..3000 {
            // Both ends among them; numbers that are of single precision.
            let part = |u: Option<f64>| ((u.unwrap_or(0.0) - 0.5) * 2.4).clamp(-1.0, 1.0);
            let [x, y] = [0, 1].map(|k| (midpoints[k] + part(random.next()) * radii[k]) as f32);
            if [x, y].iter().zip(midpoints.iter().zip(radii)).any(|(x, (m, r))| (f64::from(*x) - m).abs() > r) {
                continue;
            }
            let (e, a) = (exact(f64::from(x), f64::from(y)), f64::from(found(x, y)));
            assert!((e - bound.value).abs() <= bound.radius * (1.0 + 1e-12), "{x} {y}: {e} {bound:?}");
            assert!((a - e).abs() <= bound.error, "{x} {y}: {a} {e} {bound:?}");
            (far, off) = (far.max((e - bound.value).abs() / bound.radius), off.max((a - e).abs() / bound.error));
        }
        (far, off)
    }

    /// One more operation after one with an error.
    #[test]
    fn bounds_of_every_operation_hold_on_boxes() {
        let third = |x: Single| x * Single::from_f64(0.1);
        let near = |x: f64| x * 0.1;
        let off = |x: f32| x * 0.1_f32;
        for r in [0.0, 1e-6, 0.04, 0.3] {
            let wide = ([0.75, 0.625], [r, 0.5 * r]);
            let tight = |(far, off): (f64, f64)| assert!(r < 0.01 || far > 0.01 && off > 0.02, "{r}: {far} {off}");
            tight(hold(wide, |x, y| third(x) * y, |x, y| near(x) * y, |x, y| off(x) * y));
            tight(hold(wide, |x, y| third(x) / y, |x, y| near(x) / y, |x, y| off(x) / y));
            tight(hold(wide, |x, y| x / third(y), |x, y| x / near(y), |x, y| x / off(y)));
            tight(hold(wide, |x, y| third(x) - y, |x, y| near(x) - y, |x, y| off(x) - y));
            tight(hold(wide, |x, y| third(x).sqrt() + y, |x, y| near(x).sqrt() + y, |x, y| off(x).sqrt() + y));
            tight(hold(wide, |x, y| third(x).atan2(y), |x, y| near(x).atan2(y), |x, y| off(x).atan2(y)));
            tight(hold(wide, |x, y| y.atan2(third(x) - y), |x, y| y.atan2(near(x) - y), |x, y| y.atan2(off(x) - y)));
            tight(hold(wide, |x, _| third(x).atan2(Single::from_f64(0.5)), |x, _| near(x).atan2(0.5), |x, _| off(x).atan2(0.5)));
            tight(hold(wide, |x, y| Scalar::sin_cos(third(x)).0 + y, |x, y| near(x).sin() + y, |x, y| off(x).sin() + y));
            tight(hold(wide, |x, y| Scalar::sin_cos(third(x) + y).1, |x, y| (near(x) + y).cos(), |x, y| (off(x) + y).cos()));
        }
    }

    /// The worst that operands can be: anywhere in their radii, and evaluated with all of their
    /// errors, to either side.
    #[test]
    fn errors_and_radii_of_operands_are_carried_in_full() {
        type Wide = Running<53, 0>;
        let ends = [-1.0, 0.0, 1.0];
        let all = |f: &dyn Fn(Wide, Wide) -> Wide, exact: &dyn Fn(f64, f64) -> f64, [x, y]: [Wide; 2]| {
            let bound = f(x, y);
            let (mut far, mut off) = (0.0_f64, 0.0_f64);
            for [a, b, c, d] in ends
                .iter()
                .flat_map(|a| ends.map(|b| [*a, b]))
                .flat_map(|[a, b]| ends.iter().flat_map(move |c| ends.map(|d| [a, b, *c, d])))
            {
                let (u, v) = (x.value + a * x.radius, y.value + b * y.radius);
                let (e, found) = (exact(u, v), exact(u + c * x.error, v + d * y.error));
                (far, off) = (far.max((e - bound.value).abs()), off.max((found - e).abs()));
            }
            let slack = 1e-14 * (1.0 + bound.value.abs());
            assert!(far <= bound.radius + slack && off <= bound.error + slack, "{far} {off} {bound:?}");
            // And not much more than in full.
            assert!(bound.radius <= 8.0 * far + slack && bound.error <= 8.0 * off + slack, "{far} {off} {bound:?}");
        };
        for (r, e) in [(0.0, 0.25), (0.25, 0.0), (0.125, 0.125), (0.3, 0.1)] {
            let of = |value: f64| Wide { value, radius: r, error: e };
            for pair in [[of(1.0), of(-0.75)], [of(-2.0), of(3.0)], [of(0.75), of(0.75)]] {
                all(&|x, y| x * y, &|x, y| x * y, pair);
                all(&|x, y| x / y, &|x, y| x / y, pair);
                all(&|x, y| x - y, &|x, y| x - y, pair);
                all(&|x, _| Scalar::abs(x).sqrt(), &|x, _| x.abs().sqrt(), pair);
                all(&|x, _| x.atan2(Wide::within(2.0, 0.0)), &|x, _| x.atan2(2.0), pair);
            }
        }
        // A divisor that may be evaluated to zero.
        assert_eq!((Wide::one() / Wide { value: 0.5, radius: 0.25, error: 0.25 }).error, f64::INFINITY);
        // Numbers without an exact representation are uncertain: a third in double precision, a
        // tenth in single.
        let third = Wide::one() / Wide::within(3.0, 0.0);
        assert!(third.radius >= 1.86e-17 && third.radius < 1e-15, "{third:?}");
        assert!((0.1 - f64::from(0.1_f32)).abs() <= Single::from_f64(0.1).error && Single::from_f64(0.1).error < 1e-8);
        hold(([0.0, 0.0], [0.5, 0.0]), |x, _| Scalar::sin_cos(x).0, |x, _| x.sin(), |x, _| x.sin());
    }

    /// Choices that differ here and there, and choices that are equal either way.
    #[test]
    fn a_choice_that_is_not_certain_allows_for_both() {
        let ramp = |x: Single, y: Single| Single::select((x - y).positive(), x - y, Single::zero());
        let step = |x: Single, y: Single| Single::select((x - y).positive(), x, -y);
        for (x, r) in [(0.5, 0.0), (0.5, 0.1), (0.55, 0.1), (0.45, 0.1), (0.9, 0.1), (0.1, 0.1)] {
            hold(([x, 0.5], [r, r]), ramp, |x, y| (x - y).max(0.0), |x, y| (x - y).max(0.0));
            hold(([x, 0.5], [r, r]), step, |x, y| if x > y { x } else { -y }, |x, y| if x > y { x } else { -y });
        }
        // Where rounding alone may change the choice, the result may be off by the jump; elsewhere,
        // it is off by nothing.
        let tenth = |x: f64| Single::within(x, 0.0) * Single::from_f64(0.1);
        let jump = |x: f64| Single::select((tenth(x) - Single::within(0.05, 0.0)).positive(), Single::one(), Single::zero());
        assert!(jump(0.5).error >= 1.0 && jump(0.5001).error < 1e-6, "{:?} {:?}", jump(0.5), jump(0.5001));
        // From one side of the cut of the angle to the other.
        assert!(Single::within(0.0, 0.1).atan2(Single::within(-1.0, 0.0)).radius >= core::f64::consts::PI);
    }

    #[test]
    fn sines_of_fewer_digits_and_results_of_fewer_bits_are_allowed_for() {
        let x = Running::<53, 7>::within(0.7, 0.0);
        let error = Scalar::sin_cos(x).0.error;
        assert!((1e-7..1.001e-7).contains(&error), "{error:e}");
        let double = Running::<53, 0>::within(1.0, 0.0) / Running::within(3.0, 0.0);
        let rounded = f64::from((1.0_f64 / 3.0) as f32);
        assert!((rounded - 1.0 / 3.0).abs() <= double.rounded_to(24) && double.rounded_to(24) < 2.1e-8, "{:e}", double.rounded_to(24));
        assert!((double.rounded_to(53) - double.error) <= 4e-17);
    }

    #[test]
    fn what_is_done_with_the_unknown_is_infinitely_wide_and_never_no_number() {
        type Double = Running<53, 0>;
        let unknown = Double::one() / Double::within(0.0, 0.1);
        let [symmetric, huge, whole] = [Double::within(0.0, 0.5), Double::within(f64::INFINITY, 0.0), Double::within(2.0, 0.0)];
        for x in [symmetric, huge, whole, unknown, Double { error: f64::INFINITY, ..whole }, Double { radius: f64::INFINITY, ..whole }] {
            let results =
                [unknown * x, x * unknown, huge * x, x - unknown, huge - x, x / huge, unknown / x, x.atan2(unknown), unknown.sqrt()];
            for (k, result) in results.into_iter().chain([results[0] * x, results[0] - results[1]]).enumerate() {
                assert!(!result.radius.is_nan() && !result.error.is_nan() && !result.rounded_to(24).is_nan(), "{k}: {x:?} {result:?}");
            }
        }
        let product = unknown * symmetric;
        assert_eq!((product.radius, product.error), (f64::INFINITY, f64::INFINITY));
    }

    #[test]
    fn a_box_holds_what_is_in_it() {
        let of = |x: f64, r: f64| Running::<53, 0>::within(x, r);
        let whole = of(1.0, 0.25) * of(-2.0, 0.5) + of(0.5, 0.1) / of(3.0, 0.2);
        for (a, b, c, d) in [(0.75, -2.5, 0.6, 2.8), (1.25, -2.5, 0.4, 3.2), (1.25, -1.5, 0.6, 2.8)] {
            let one: f64 = a * b + c / d;
            assert!((one - whole.value).abs() <= whole.radius, "{one} {whole:?}");
        }
        assert_eq!((of(1.0, 0.0) / of(0.0, 0.1)).error, f64::INFINITY);
        assert!((1.0..1.0 + 1e-12).contains(&Scalar::sin_cos(of(3.0, 100.0)).0.radius));
    }

    /// The change that an error makes is largest where the root is steepest.
    #[test]
    fn the_error_of_a_root_is_that_at_the_least_number_of_its_radius() {
        let root = Running::<53, 0> { value: 1.0, radius: 0.9, error: 1e-10 }.sqrt();
        let steepest = 1e-10 / (2.0 * libm::sqrt(0.1));
        assert!(root.error >= steepest && root.error < 3.0 * steepest, "{root:?}");
    }

    /// For two numbers anywhere from −1 to 1, the wrong one may be taken.
    #[test]
    fn a_choice_that_is_not_certain_is_off_by_as_much_as_both_can_be_apart() {
        let wide = Running::<53, 0>::within(0.0, 1.0);
        let chosen = Running::select(wide.positive(), wide, wide);
        assert!((1.0..1.001).contains(&chosen.radius) && (2.0..2.001).contains(&chosen.error), "{chosen:?}");
    }
}
