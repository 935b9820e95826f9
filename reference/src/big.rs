//! Reference values: a scalar of 320 bits, some 96 decimal digits.
//!
//! Operations are calls, not inlined: algorithms would become several times as large, and take as
//! much longer to compile, without benefit.

use std::cell::RefCell;
use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};

use articulated_core::Scalar;
use articulated_core::region::repeat_known;
use astro_float_num::{BigFloat, Consts, RoundingMode, Sign};
use num_traits::{One, Zero};

/// Bits of every number.
pub const BITS: usize = 320;

const ROUNDING: RoundingMode = RoundingMode::ToEven;

/// A number of [`BITS`] bits. It is a handle into an arena of the thread, so that it can be copied
/// as an algorithm's scalar must be; every result takes room there until the [`Big::scope`] around
/// it ends.
#[derive(Clone, Copy, Debug)]
pub struct Big(u32);

struct Arena {
    numbers: Vec<BigFloat>,
    constants: Option<Consts>,
}

const ZERO: Big = Big(0);
const ONE: Big = Big(1);

thread_local! {
    static ARENA: RefCell<Arena> = RefCell::new(Arena {
        numbers: vec![BigFloat::from_f64(0.0, BITS), BigFloat::from_f64(1.0, BITS)],
        constants: Consts::new().ok(),
    });
}

fn with<T>(f: impl FnOnce(&mut Arena) -> T) -> T {
    ARENA.with_borrow_mut(f)
}

fn keep(arena: &mut Arena, number: BigFloat) -> Big {
    if number.is_zero() {
        return ZERO;
    }
    arena.numbers.push(number);
    Big(u32::try_from(arena.numbers.len() - 1).expect("fewer than 2³² numbers in one scope"))
}

impl Big {
    /// Runs `work` and then frees all numbers that it made: they must not be used afterwards.
    pub fn scope<T>(work: impl FnOnce() -> T) -> T {
        let before = with(|arena| arena.numbers.len());
        let result = work();
        with(|arena| arena.numbers.truncate(before));
        result
    }

    /// The number nearest to a decimal.
    pub fn parse(decimal: &str) -> Self {
        with(|arena| {
            let Arena { numbers: _, constants } = arena;
            let parsed = constants.as_mut().map(|c| BigFloat::parse(decimal, astro_float_num::Radix::Dec, BITS, ROUNDING, c));
            keep(arena, parsed.unwrap_or_else(|| BigFloat::nan(None)))
        })
    }

    /// The nearest double.
    pub fn to_f64(self) -> f64 {
        with(|arena| nearest(&arena.numbers[self.0 as usize]))
    }

    /// |`found` − self| / `scale`; 0 where both difference and scale are 0, infinite where only the scale is. Not a number for such input.
    pub fn error_of(self, found: f64, scale: f64) -> f64 {
        let difference = (Self::from_f64(found) - self).to_f64().abs();
        if difference == 0.0 { 0.0 } else { difference / scale }
    }

    fn one_of(self, f: impl FnOnce(&BigFloat) -> BigFloat) -> Self {
        with(|arena| {
            let result = f(&arena.numbers[self.0 as usize]);
            keep(arena, result)
        })
    }

    fn two_of(self, other: Self, f: impl FnOnce(&BigFloat, &BigFloat) -> BigFloat) -> Self {
        with(|arena| {
            let result = f(&arena.numbers[self.0 as usize], &arena.numbers[other.0 as usize]);
            keep(arena, result)
        })
    }

    fn with_constants(self, f: impl FnOnce(&BigFloat, &mut Consts) -> BigFloat) -> Self {
        with(|arena| {
            let Arena { numbers, constants } = arena;
            let result = constants.as_mut().map(|c| f(&numbers[self.0 as usize], c));
            keep(arena, result.unwrap_or_else(|| BigFloat::nan(None)))
        })
    }
}

/// The number that a double is. Subnormal doubles go through the normal range.
fn exactly(x: f64) -> BigFloat {
    let lifted = |lift: f64| BigFloat::from_f64(x * lift, BITS).div(&BigFloat::from_f64(lift, BITS), BITS, ROUNDING);
    if x.is_subnormal() { lifted(2.0_f64.powi(200)) } else { BigFloat::from_f64(x, BITS) }
}

/// Rounds once, save for results below the normal range.
fn nearest(number: &BigFloat) -> f64 {
    if number.is_nan() {
        return f64::NAN;
    }
    let sign = if number.is_negative() { -1.0 } else { 1.0 };
    if number.is_inf() {
        return sign * f64::INFINITY;
    }
    let Some((words, _, sign_of, exponent, _)) = number.as_raw_parts() else { return f64::NAN };
    debug_assert_eq!(sign_of == Sign::Neg, sign < 0.0);
    // The value is 0.m · 2^e. Of m the top 64 bits count, and whether anything is below them.
    let bytes: Vec<u8> = words.iter().rev().flat_map(|w| w.to_be_bytes()).collect();
    let (top, rest) = bytes.split_at(bytes.len().min(8));
    let mut head = [0; 8];
    head[..top.len()].copy_from_slice(top);
    let sticky = u64::from(rest.iter().any(|b| *b != 0));
    sign * scaled((u64::from_be_bytes(head) | sticky) as f64, exponent - 64)
}

/// x · 2^e, in steps that do not overflow on the way.
fn scaled(mut x: f64, mut e: i32) -> f64 {
    while e != 0 && x != 0.0 && x.is_finite() {
        let step = e.clamp(-1000, 1000);
        x *= 2.0_f64.powi(step);
        e -= step;
    }
    x
}

/// π.
fn half_turn() -> Big {
    ZERO.with_constants(|_, c| c.pi(BITS, ROUNDING))
}

impl PartialEq for Big {
    fn eq(&self, other: &Self) -> bool {
        with(|arena| arena.numbers[self.0 as usize].cmp(&arena.numbers[other.0 as usize]) == Some(0))
    }
}

impl Zero for Big {
    fn zero() -> Self {
        ZERO
    }

    fn is_zero(&self) -> bool {
        self.0 == ZERO.0
    }
}

impl One for Big {
    fn one() -> Self {
        ONE
    }
}

impl Add for Big {
    type Output = Self;

    #[inline(never)]
    fn add(self, other: Self) -> Self {
        match (self.is_zero(), other.is_zero()) {
            (true, _) => other,
            (_, true) => self,
            _ => self.two_of(other, |a, b| a.add(b, BITS, ROUNDING)),
        }
    }
}

impl Sub for Big {
    type Output = Self;

    #[inline(never)]
    fn sub(self, other: Self) -> Self {
        if other.is_zero() { self } else { self.two_of(other, |a, b| a.sub(b, BITS, ROUNDING)) }
    }
}

impl Mul for Big {
    type Output = Self;

    #[inline(never)]
    fn mul(self, other: Self) -> Self {
        match (self.0, other.0) {
            (1, _) => other,
            (_, 1) => self,
            _ => self.two_of(other, |a, b| a.mul(b, BITS, ROUNDING)),
        }
    }
}

impl Div for Big {
    type Output = Self;

    #[inline(never)]
    fn div(self, other: Self) -> Self {
        self.two_of(other, |a, b| a.div(b, BITS, ROUNDING))
    }
}

impl Neg for Big {
    type Output = Self;

    #[inline(never)]
    fn neg(self) -> Self {
        self.one_of(BigFloat::neg)
    }
}

impl AddAssign for Big {
    #[inline(never)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl SubAssign for Big {
    #[inline(never)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl MulAssign for Big {
    #[inline(never)]
    fn mul_assign(&mut self, other: Self) {
        *self = *self * other;
    }
}

impl Scalar for Big {
    type Mask = bool;

    const BITS: u32 = BITS as u32;

    #[inline(never)]
    fn from_f64(x: f64) -> Self {
        match x {
            1.0 => ONE,
            _ => with(|arena| keep(arena, exactly(x))),
        }
    }

    #[inline(never)]
    fn sin_cos(self) -> (Self, Self) {
        if self.is_zero() {
            return (ZERO, ONE);
        }
        (self.with_constants(|x, c| x.sin(BITS, ROUNDING, c)), self.with_constants(|x, c| x.cos(BITS, ROUNDING, c)))
    }

    #[inline(never)]
    fn sqrt(self) -> Self {
        self.one_of(|x| x.sqrt(BITS, ROUNDING))
    }

    // atan y/x for x > 0, half a turn further for x < 0; no zero here has a sign.
    #[inline(never)]
    fn atan2(self, x: Self) -> Self {
        let minus = |mask: bool, a: Self| if mask { -a } else { a };
        let below = (-self).positive();
        if x.is_zero() {
            return if self.is_zero() { ZERO } else { minus(below, half_turn() / Self::from_f64(2.0)) };
        }
        let within = if self.is_zero() { ZERO } else { (self / x).with_constants(|t, c| t.atan(BITS, ROUNDING, c)) };
        if x.positive() { within } else { within + minus(below, half_turn()) }
    }

    fn positive(self) -> bool {
        with(|arena| {
            let x = &arena.numbers[self.0 as usize];
            x.is_positive() && !x.is_zero() && !x.is_nan()
        })
    }

    fn select(mask: bool, a: Self, b: Self) -> Self {
        if mask { a } else { b }
    }

    fn repeat(most: usize, state: &mut [Self], body: impl FnMut(&mut [Self]) -> bool) -> bool {
        repeat_known(most, state, body)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(found: Big, digits: &str, error: f64) {
        let expected = Big::parse(digits);
        let difference = ((found - expected) / expected).to_f64().abs();
        assert!(difference < error, "{digits}: {difference:e}");
    }

    #[test]
    fn sine_and_cosine_are_on_the_circle() {
        for k in -40..=40 {
            Big::scope(|| {
                let (s, c) = (Big::from_f64(f64::from(k)) / Big::from_f64(7.0)).sin_cos();
                assert!((s * s + c * c - Big::one()).to_f64().abs() < 1e-70);
            });
        }
    }

    #[test]
    fn sixty_digits_of_known_numbers() {
        close(Big::one().sin_cos().0, "0.841470984807896506652502321630298999622563060798371065672752", 1e-59);
        close(Big::from_f64(2.0).sqrt(), "1.41421356237309504880168872420969807856967187537694807317667974", 1e-60);
        close(Big::from_f64(1e22).sin_cos().0, "-0.852200849767188801772705893753029368261762150410043656256509", 1e-59);
    }

    #[test]
    fn an_arctangent_gives_the_angle_back_in_every_quadrant() {
        for k in -31..=31 {
            Big::scope(|| {
                let angle = Big::from_f64(f64::from(k)) / Big::from_f64(10.0);
                let (s, c) = angle.sin_cos();
                let far = Big::from_f64(1e30);
                assert!((s.atan2(c) - angle).to_f64().abs() < 1e-94, "{k}");
                assert!(((s * far).atan2(c * far) - angle).to_f64().abs() < 1e-94, "{k}");
            });
        }
        let pi = "3.14159265358979323846264338327950288419716939937510582097494459230781640628620899862803482534211706798";
        let of = |y: f64, x: f64| Big::from_f64(y).atan2(Big::from_f64(x));
        close(of(0.0, -3.0), pi, 1e-95);
        close(of(2.0, 0.0) + of(2.0, 0.0), pi, 1e-95);
        close(-of(-1e-40, -1.0) + of(1e-40, 1.0), pi, 1e-95);
        close(of(-1e-30, 1.0), "-9.99999999999999999999999999999999999999999999999999999999999666e-31", 1e-16);
        assert!(of(0.0, 0.0).is_zero() && of(0.0, 7.0).is_zero());
        assert_eq!(of(-5.0, 0.0).to_f64(), -std::f64::consts::FRAC_PI_2);
    }

    #[test]
    fn doubles_come_back_to_the_bit() {
        for x in [0.0, 1.0, -1.0, 0.1, -3e-310, f64::MIN_POSITIVE, f64::MAX, -1e22, 5e-324] {
            assert_eq!(Big::from_f64(x).to_f64(), x);
        }
        assert!(Big::from_f64(f64::NAN).to_f64().is_nan());
        assert_eq!(Big::from_f64(f64::NEG_INFINITY).to_f64(), f64::NEG_INFINITY);
    }

    #[test]
    fn a_double_is_the_nearest_one() {
        let ulp = f64::EPSILON;
        let tiny = Big::from_f64(1e-60);
        let half = Big::from_f64(ulp / 2.0);
        assert_eq!((Big::one() + half).to_f64(), 1.0);
        assert_eq!((Big::one() + half + tiny).to_f64(), 1.0 + ulp);
        assert_eq!((Big::one() + half - tiny).to_f64(), 1.0);
    }

    #[test]
    fn a_scope_gives_its_room_back() {
        let count = || with(|a| a.numbers.len());
        let before = count();
        let x = Big::scope(|| (Big::from_f64(2.0) * Big::from_f64(3.0)).to_f64());
        assert_eq!((x, count()), (6.0, before));
    }
}
