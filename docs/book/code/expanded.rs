//! A scalar that is a sum of products of sines, cosines and rates, all of them multiplied out.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};
use std::rc::Rc;

use articulated::{Base, Scalar};
use num_traits::{One, Zero};

use crate::{Robot, read};

/// Exponents of a product, four bits each: of the sines of the angles 0 to 9, then of their
/// cosines, then of the rates 0 to 9.
type Monomial = u128;

/// The coefficient of each product. None is zero.
type Terms = BTreeMap<Monomial, f64>;

const ANGLES: usize = 10;
const COSINES: usize = 4 * ANGLES;
const RATES: usize = 8 * ANGLES;
/// Set in a product that has the square of a sine: exponents of sines are at most 2 before
/// reduction.
const SQUARED_SINES: Monomial = 0x22_2222_2222;

thread_local! {
    static SUMS: RefCell<Vec<Rc<Terms>>> = const { RefCell::new(Vec::new()) };
}

/// A number, an angle, or an expanded sum. sin² is written as 1 − cos², so that equal functions
/// have equal terms, whatever way they were computed.
///
/// Only what the recursions do is defined: sums, products, quotients by numbers, sines of angles,
/// roots of numbers. Everything else panics. Sums are kept until their thread ends.
#[derive(Clone, Copy, Debug)]
pub struct Expanded(Kind);

#[derive(Clone, Copy, Debug)]
enum Kind {
    Number(f64),
    Angle(usize),
    /// Place in `SUMS`.
    Sum(usize),
}

impl Expanded {
    /// The angle of joint `k`, 0 to 9. Only its sine and cosine can be computed with.
    pub fn angle(k: usize) -> Self {
        assert!(k < ANGLES, "angles are numbered 0 to 9, not {k}");
        Self(Kind::Angle(k))
    }

    /// The rate of joint `k`, 0 to 9.
    pub fn rate(k: usize) -> Self {
        assert!(k < ANGLES, "rates are numbered 0 to 9, not {k}");
        Self::of(BTreeMap::from([(1 << (RATES + 4 * k), 1.0)]))
    }

    /// Number of terms of the sum.
    pub fn terms(self) -> usize {
        self.all().len()
    }

    /// Its value at angles, rad, and rates.
    pub fn value(self, q: &[f64], v: &[f64]) -> f64 {
        let power = |monomial: Monomial, at: usize, base: f64| base.powi(((monomial >> at) & 15) as i32);
        let evaluated = |monomial: Monomial| {
            let turned: f64 =
                (0..q.len()).map(|k| power(monomial, 4 * k, q[k].sin()) * power(monomial, COSINES + 4 * k, q[k].cos())).product();
            turned * (0..v.len()).map(|k| power(monomial, RATES + 4 * k, v[k])).product::<f64>()
        };
        self.all().iter().map(|(&monomial, coefficient)| coefficient * evaluated(monomial)).sum()
    }

    fn of(mut terms: Terms) -> Self {
        terms.retain(|_, coefficient| *coefficient != 0.0);
        match terms.first_key_value() {
            None => Self(Kind::Number(0.0)),
            Some((&0, &number)) if terms.len() == 1 => Self(Kind::Number(number)),
            _ => SUMS.with_borrow_mut(|sums| {
                sums.push(Rc::new(terms));
                Self(Kind::Sum(sums.len() - 1))
            }),
        }
    }

    fn all(self) -> Rc<Terms> {
        match self.0 {
            Kind::Number(0.0) => Rc::default(),
            Kind::Number(number) => Rc::new(BTreeMap::from([(0, number)])),
            Kind::Angle(k) => panic!("the angle {k} itself is in a sum"),
            Kind::Sum(at) => SUMS.with_borrow(|sums| Rc::clone(&sums[at])),
        }
    }

    fn number(self) -> f64 {
        match self.0 {
            Kind::Number(number) => number,
            _ => panic!("a number is needed, not {self:?}"),
        }
    }
}

/// All products of a term of `left` and one of `right`.
fn product(left: &Terms, right: &Terms) -> Terms {
    let mut terms = Terms::new();
    for (m, x) in left {
        for (n, y) in right {
            // Exponents add: none exceeds 15 in the recursions of ten joints.
            add_product(&mut terms, m + n, x * y);
        }
    }
    terms
}

/// Adds one product, with sin² = 1 − cos².
fn add_product(terms: &mut Terms, monomial: Monomial, coefficient: f64) {
    let squared = monomial & SQUARED_SINES;
    if squared == 0 {
        *terms.entry(monomial).or_insert(0.0) += coefficient;
        return;
    }
    let square = 1 << squared.trailing_zeros();
    let without = monomial - square;
    add_product(terms, without, coefficient);
    add_product(terms, without + (square << COSINES), -coefficient);
}

impl Add for Expanded {
    type Output = Self;
    fn add(self, b: Self) -> Self {
        match (self.0, b.0) {
            (Kind::Number(x), Kind::Number(y)) => Self(Kind::Number(x + y)),
            (Kind::Number(0.0), _) => b,
            (_, Kind::Number(0.0)) => self,
            _ => {
                let mut terms = (*self.all()).clone();
                b.all().iter().for_each(|(&monomial, coefficient)| *terms.entry(monomial).or_insert(0.0) += coefficient);
                Self::of(terms)
            }
        }
    }
}

impl Mul for Expanded {
    type Output = Self;
    fn mul(self, b: Self) -> Self {
        match (self.0, b.0) {
            (Kind::Number(x), Kind::Number(y)) => Self(Kind::Number(x * y)),
            (Kind::Number(0.0), _) | (_, Kind::Number(0.0)) => Self::zero(),
            (Kind::Number(1.0), _) => b,
            (_, Kind::Number(1.0)) => self,
            _ => Self::of(product(&self.all(), &b.all())),
        }
    }
}

impl Neg for Expanded {
    type Output = Self;
    fn neg(self) -> Self {
        self * Self(Kind::Number(-1.0))
    }
}

impl Sub for Expanded {
    type Output = Self;
    fn sub(self, b: Self) -> Self {
        self + -b
    }
}

impl Div for Expanded {
    type Output = Self;
    fn div(self, b: Self) -> Self {
        self * Self(Kind::Number(1.0 / b.number()))
    }
}

impl PartialEq for Expanded {
    fn eq(&self, b: &Self) -> bool {
        self.all() == b.all()
    }
}

macro_rules! assignment {
    ($($op:ident, $f:ident, $by:ident);+) => { $(
        impl $op for Expanded {
            fn $f(&mut self, b: Self) {
                *self = self.$by(b);
            }
        }
    )+ };
}
assignment!(AddAssign, add_assign, add; SubAssign, sub_assign, sub; MulAssign, mul_assign, mul);

impl Zero for Expanded {
    fn zero() -> Self {
        Self(Kind::Number(0.0))
    }
    fn is_zero(&self) -> bool {
        matches!(self.0, Kind::Number(0.0))
    }
}

impl One for Expanded {
    fn one() -> Self {
        Self(Kind::Number(1.0))
    }
}

impl Scalar for Expanded {
    type Mask = bool;

    fn from_f64(x: f64) -> Self {
        Self(Kind::Number(x))
    }
    fn sin_cos(self) -> (Self, Self) {
        match self.0 {
            Kind::Number(x) => (Self(Kind::Number(x.sin())), Self(Kind::Number(x.cos()))),
            Kind::Angle(k) => [4 * k, COSINES + 4 * k].map(|at| Self::of(BTreeMap::from([(1 << at, 1.0)]))).into(),
            Kind::Sum(_) => panic!("the sine of a sum"),
        }
    }
    fn sqrt(self) -> Self {
        Self(Kind::Number(self.number().sqrt()))
    }
    fn atan2(self, x: Self) -> Self {
        Self(Kind::Number(self.number().atan2(x.number())))
    }
    fn positive(self) -> bool {
        self.number() > 0.0
    }
    fn select(mask: bool, a: Self, b: Self) -> Self {
        if mask { a } else { b }
    }
}

/// A serial arm of `joints` links, each 1 m along x, on axes y and z in turn. All numbers are
/// whole numbers over a power of two, so sums of their products are exact in `f64`.
pub fn unit_links(joints: usize) -> Robot {
    let mut text = String::from("<robot name=\"unit_links\"><link name=\"l0\"/>");
    for k in 1..=joints {
        let (axis, along, below) = (["0 0 1", "0 1 0"][k % 2], usize::from(k > 1), k - 1);
        text += &format!(
            "<link name=\"l{k}\"><inertial><origin xyz=\"0.5 0.25 0.125\"/><mass value=\"2\"/>\
             <inertia ixx=\"1\" ixy=\"-0.25\" ixz=\"0.25\" iyy=\"1.5\" iyz=\"0.125\" izz=\"1.25\"/></inertial></link>\
             <joint name=\"j{k}\" type=\"continuous\"><parent link=\"l{below}\"/><child link=\"l{k}\"/>\
             <origin xyz=\"{along} 0 0\"/><axis xyz=\"{axis}\"/></joint>"
        );
    }
    read("unit_links.urdf", &(text + "</robot>"), Base::Fixed)
}
