//! The scale against which a rounding error is measured.

use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};

use articulated_core::Scalar;
use articulated_core::algorithm::{FunctionError, Workspace, function};
use articulated_core::dynamics::Dynamics;
use articulated_core::model::Model;
use num_traits::{One, Zero};

/// A value together with the sum of the magnitudes of the terms that it was summed from.
///
/// |x| where nothing cancels; more where terms cancel, by as much as rounding errors of the terms count more there. An
/// evaluation in floating point is off by about unit roundoff times this, whatever the order of its operations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Magnitude {
    /// The value, in double precision.
    pub value: f64,
    /// The sum of the magnitudes of its terms; never less than |value|, rounding apart.
    pub magnitude: f64,
    /// Whether the value was given and not computed.
    given: bool,
}

impl Magnitude {
    fn computed(value: f64, magnitude: f64) -> Self {
        Self { value, magnitude, given: false }
    }
}

impl Zero for Magnitude {
    fn zero() -> Self {
        Self::from_f64(0.0)
    }

    fn is_zero(&self) -> bool {
        self.value == 0.0 && self.magnitude == 0.0
    }
}

impl One for Magnitude {
    fn one() -> Self {
        Self::from_f64(1.0)
    }
}

impl Add for Magnitude {
    type Output = Self;

    // ‖a + b‖ = ‖a‖ + ‖b‖
    fn add(self, other: Self) -> Self {
        Self::computed(self.value + other.value, self.magnitude + other.magnitude)
    }
}

impl Sub for Magnitude {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Magnitude {
    type Output = Self;

    // ‖a b‖ = ‖a‖ ‖b‖
    fn mul(self, other: Self) -> Self {
        Self::computed(self.value * other.value, self.magnitude * other.magnitude)
    }
}

impl Div for Magnitude {
    type Output = Self;

    // ‖a / b‖ = ‖a‖ ‖b‖ / b²
    fn div(self, other: Self) -> Self {
        Self::computed(self.value / other.value, self.magnitude / other.value.abs() * (other.magnitude / other.value.abs()))
    }
}

impl Neg for Magnitude {
    type Output = Self;

    fn neg(self) -> Self {
        Self { value: -self.value, ..self }
    }
}

impl AddAssign for Magnitude {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl SubAssign for Magnitude {
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl MulAssign for Magnitude {
    fn mul_assign(&mut self, other: Self) {
        *self = *self * other;
    }
}

impl Scalar for Magnitude {
    type Mask = bool;

    fn from_f64(x: f64) -> Self {
        Self { value: x, magnitude: x.abs(), given: true }
    }

    // ‖sin x‖ = |sin x| + |cos x| ‖x‖ for a computed angle x, |sin x| for a given one
    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = self.value.sin_cos();
        let angle = if self.given { 0.0 } else { self.magnitude };
        (Self::computed(sin, sin.abs() + cos.abs() * angle), Self::computed(cos, cos.abs() + sin.abs() * angle))
    }

    // ‖√x‖ = ‖x‖ / √x
    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        Self::computed(root, if self.magnitude == 0.0 { 0.0 } else { self.magnitude / root })
    }

    // ‖atan2(y, x)‖ = |atan2(y, x)| + (|x| ‖y‖ + |y| ‖x‖) / (x² + y²)
    fn atan2(self, x: Self) -> Self {
        let (angle, r) = (self.value.atan2(x.value), self.value.hypot(x.value));
        let share = |along: f64, across: f64| if across == 0.0 { 0.0 } else { along.abs() / r * (across / r) };
        Self::computed(angle, angle.abs() + share(x.value, self.magnitude) + share(self.value, x.magnitude))
    }

    fn positive(self) -> bool {
        self.value > 0.0
    }

    fn select(mask: bool, a: Self, b: Self) -> Self {
        if mask { a } else { b }
    }
}

/// Unit roundoff of double precision, 2⁻⁵³.
pub const ROUNDOFF: f64 = f64::EPSILON / 2.0;

/// The scale of each number that a function gives: the algorithm of the registry, run with [`Magnitude`] on `model`, which has
/// to be as it was read, before model passes.
///
/// A function that solves with the mass matrix is measured by what rounding does to a backward stable solution instead: divisions would let the sum of
/// magnitudes grow without bound, and everything would pass.
pub fn scales(model: &Model<f64>, name: &str, arguments: &[&[f64]]) -> Result<Vec<f64>, FunctionError> {
    let row = function::<Magnitude>(name).ok_or(FunctionError::NotGenerated { function: "of this name" })?;
    if let (true, &[q, v, tau]) = (row.inverts_mass_matrix(), arguments) {
        return solution_scales(model, q, v, tau);
    }
    let model: Model<Magnitude> = model.cast();
    let arguments: Vec<Vec<Magnitude>> = arguments.iter().map(|x| x.iter().map(|x| Magnitude::from_f64(*x)).collect()).collect();
    let arguments: Vec<&[Magnitude]> = arguments.iter().map(Vec::as_slice).collect();
    let mut out = vec![Magnitude::zero(); row.gives.len(model.shape())];
    row.call(&model, &mut Workspace::new(&model), &arguments, &mut out)?;
    Ok(out.into_iter().map(|x| x.magnitude).collect())
}

/// |M⁻¹|·(‖ID(q, v, a)‖ + |τ|) at the solution a: the forward error that a backward error of one unit brings about.
fn solution_scales(model: &Model<f64>, q: &[f64], v: &[f64], tau: &[f64]) -> Result<Vec<f64>, FunctionError> {
    let n = model.nv;
    let mut ws = model.workspace();
    let mut a = vec![0.0; n];
    model.forward_dynamics(&mut ws, q, v, tau, &mut a)?;
    let needed = scales(model, "inverse_dynamics", &[q, v, &a])?;
    let backward: Vec<f64> = needed.iter().zip(tau).map(|(s, t)| s + t.abs()).collect();
    // Without gravity and at rest, the accelerations that unit torques cause are the columns of M⁻¹.
    let weightless = model.clone().with_gravity([0.0; 3]);
    let (rest, mut column, mut scale) = (vec![0.0; n], vec![0.0; n], vec![0.0; n]);
    for j in 0..n {
        let mut unit = rest.clone();
        unit[j] = 1.0;
        weightless.forward_dynamics(&mut ws, q, &rest, &unit, &mut column)?;
        scale.iter_mut().zip(&column).for_each(|(s, x)| *s += x.abs() * backward[j]);
    }
    Ok(scale)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(x: f64) -> Magnitude {
        Magnitude::from_f64(x)
    }

    #[test]
    fn cancellation_lowers_the_value_and_not_the_scale() {
        let x = of(3.0) * of(-2.0) + of(6.0);
        assert_eq!((x.value, x.magnitude), (0.0, 12.0));
        let y = of(1.0) / (of(3.0) - of(2.0));
        assert_eq!((y.value, y.magnitude), (1.0, 5.0));
    }

    #[test]
    fn a_solution_is_measured_by_the_inverse_of_the_mass_matrix() {
        let robot = articulated_models::robot("simple_pendulum").unwrap();
        let description = articulated_urdf::read(robot.urdf.as_bytes(), &articulated_urdf::Options::default()).unwrap().description;
        let model = Model::new(&description, robot.base).unwrap();
        // a = (τ − 9.81 sin q) / 1.001 with τ = 3, and ‖ID‖ ≥ |M a| + |g|
        let (q, tau) = (0.5_f64, 3.0_f64);
        let gravity = 9.81 * q.sin();
        let least = (tau + (tau - gravity).abs() + gravity) / 1.001;
        let scale = scales(&model, "forward_dynamics", &[&[q], &[0.0], &[tau]]).unwrap()[0];
        assert!(scale >= least * 0.999 && scale < 4.0 * least, "{scale} {least}");
    }

    #[test]
    fn the_sine_of_a_computed_angle_carries_the_error_of_the_angle() {
        assert_eq!(of(1000.0).sin_cos().1.magnitude, 1000.0_f64.cos().abs());
        assert!((of(500.0) + of(500.0)).sin_cos().1.magnitude > 800.0);
        assert_eq!((of(4.0).sqrt().value, of(4.0).sqrt().magnitude), (2.0, 2.0));
    }

    #[test]
    fn the_angle_of_a_point_carries_the_error_of_the_point() {
        let angle = of(1.0).atan2(of(1.0));
        assert!((angle.magnitude - (angle.value + 1.0)).abs() < 1e-15);
        // (1000 − 999, 0): the zero cannot tell, the one is off by 1999.
        assert!((of(0.0).atan2(of(1000.0) - of(999.0))).magnitude < 1e-15);
        assert!(((of(1000.0) - of(999.0)).atan2(of(1e3))).magnitude > 1.99);
        assert_eq!(of(0.0).atan2(of(0.0)).magnitude, 0.0);
    }
}
