//! Errors in units of the tolerances, and the steps that follow from them.

use super::system::System;
use super::{Control, Settings, SimulateError};

/// Tolerances of each of the 2·nv numbers of a step: atol_i + rtol·max(|x_i| before, |x_i| after).
#[derive(Clone, Debug)]
pub(crate) struct Norm {
    rtol: f64,
    atol: Vec<f64>,
    /// |x_i| at the start of the step.
    before: Vec<f64>,
}

impl Norm {
    pub(crate) fn new(settings: &Settings, nv: usize) -> Self {
        let each = &settings.atol_each;
        let atol = if each.is_empty() { vec![settings.atol; 2 * nv] } else { each.clone() };
        Self { rtol: settings.rtol, atol, before: vec![0.0; 2 * nv] }
    }

    /// A step begins at the origin of the system's chart, with the velocities of y.
    pub(crate) fn begin(&mut self, system: &System<'_>, y: &[f64]) {
        let nv = system.nv();
        system.manifold.magnitudes(&system.origin, &mut self.before[..nv]);
        self.before[nv..].iter_mut().zip(&y[nv..2 * nv]).for_each(|(m, v)| *m = v.abs());
    }

    /// The tolerance of number i of a step that ends with y.
    pub(crate) fn scale(&self, i: usize, y: &[f64]) -> f64 {
        let half = self.before.len() / 2;
        let after = if i < half { self.before[i] + y[i].abs() } else { y[i].abs() };
        // No number is known better than to rounding.
        (self.atol[i] + self.rtol * self.before[i].max(after)).max(f64::MIN_POSITIVE)
    }

    /// √(mean of (e_i/scale_i)²), and the number with the largest part.
    pub(crate) fn of(&self, error: impl Fn(usize) -> f64, y: &[f64]) -> Error {
        let n = self.before.len();
        let (mut sum, mut largest, mut index) = (0.0, 0.0, 0);
        for i in 0..n {
            let e = error(i) / self.scale(i, y);
            sum += e * e;
            if e.abs() > largest {
                (largest, index) = (e.abs(), i);
            }
        }
        Error { size: if n == 0 { 0.0 } else { (sum / n as f64).sqrt() }, index }
    }
}

/// Size of an error in units of the tolerances.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Error {
    /// At most 1 where it is tolerable.
    pub(crate) size: f64,
    /// The number with the largest part of it.
    pub(crate) index: usize,
}

/// How the next step follows from errors: h·0.9·e_nᵅ·e_{n−1}ᵝ, a PI controller (Gustafsson 1991;
/// Hairer & Wanner 1996, §IV.2).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Controller {
    alpha: f64,
    beta: f64,
    least: f64,
    most: f64,
    before: f64,
    rejected: bool,
}

impl Controller {
    /// For an error that falls with the power `order` of the step; `beta` is the weight of the
    /// error before; steps change by factors from `least` to `most`.
    pub(crate) fn new(order: f64, beta: f64, least: f64, most: f64) -> Self {
        Self { alpha: 1.0 / order - 0.75 * beta, beta, least, most, before: 1e-4, rejected: false }
    }

    /// The factor of the next step after one with this error; `None`: it is rejected, and the
    /// factor is that of [`Controller::again`].
    pub(crate) fn accept(&mut self, error: f64) -> Option<f64> {
        if error.is_nan() || error > 1.0 {
            self.rejected = true;
            return None;
        }
        let size = error.max(1e-10);
        let factor = (0.9 * self.before.powf(self.beta) / size.powf(self.alpha)).clamp(self.least, self.most);
        self.before = size.max(1e-4);
        let factor = if self.rejected { factor.min(1.0) } else { factor };
        self.rejected = false;
        Some(factor)
    }

    /// The factor of a step that is tried again.
    pub(crate) fn again(&self, error: f64) -> f64 {
        if error.is_finite() { (0.9 / error.powf(self.alpha)).clamp(self.least, 0.9) } else { 0.1 }
    }
}

/// A first step, s: Hairer, Nørsett & Wanner 1993, §II.4. `order` is that of the method, `room` two
/// vectors as long as y.
pub(crate) fn first_step(
    system: &mut System<'_>,
    control: &mut dyn Control,
    norm: &Norm,
    (t, y, f): (f64, &[f64], &[f64]),
    order: f64,
    room: [&mut [f64]; 2],
) -> Result<f64, SimulateError> {
    let [next, rate] = room;
    let size = norm.of(|i| norm.before[i], y).size;
    let slope = norm.of(|i| f[i], y).size;
    let h = if size < 1e-5 || slope < 1e-5 { 1e-6 } else { 0.01 * size / slope };
    for i in 0..y.len() {
        next[i] = y[i] + h * f[i];
    }
    system.rate(control, t + h, next, rate)?;
    let bend = norm.of(|i| rate[i] - f[i], y).size / h;
    let largest = slope.max(bend);
    let by_error = if largest.is_nan() || largest <= 1e-15 { (h * 1e-3).max(1e-6) } else { (0.01 / largest).powf(1.0 / (order + 1.0)) };
    Ok(by_error.min(100.0 * h))
}

/// Seconds that rounding of t amounts to.
pub(crate) fn rounding(t: f64) -> f64 {
    16.0 * f64::EPSILON * t.abs().max(1e-30)
}

#[cfg(test)]
mod tests {
    use super::{Controller, Norm};
    use crate::simulate::Settings;

    #[test]
    fn an_error_is_measured_by_the_tolerances_of_its_number() {
        let settings = Settings { rtol: 1e-3, atol_each: vec![1e-6, 1e-2], ..Settings::default() };
        let norm = Norm { before: vec![2.0, 5.0], ..Norm::new(&settings, 1) };
        // A step of q counts on top of where it began, a velocity as it is.
        for (y, scales) in [([-3.0, 7.0], [1e-6 + 5e-3, 1e-2 + 7e-3]), ([0.0, -1.0], [1e-6 + 2e-3, 1e-2 + 5e-3])] {
            for (i, scale) in scales.into_iter().enumerate() {
                assert!((norm.scale(i, &y) - scale).abs() < 1e-17);
            }
            let error = norm.of(|i| [3.0, 4.0][i] * scales[i], &y);
            assert!((error.size - 12.5_f64.sqrt()).abs() < 1e-14 && error.index == 1);
        }
    }

    #[test]
    fn a_step_grows_after_small_errors_and_not_after_a_rejection() {
        let mut controller = Controller::new(5.0, 0.0, 0.2, 10.0);
        assert!((controller.accept(0.9_f64.powi(5)).unwrap() - 1.0).abs() < 1e-14);
        assert_eq!(controller.accept(0.0), Some(10.0));
        assert_eq!(controller.accept(1.5), None);
        assert_eq!(controller.again(f64::NAN), 0.1);
        assert_eq!(controller.accept(1e-9), Some(1.0));
        assert_eq!(controller.accept(1e-9), Some(10.0));
    }

    /// h·0.9·e_n^−(1/k − ¾β)·e_{n−1}^β, Hairer & Wanner 1996, (IV.2.43).
    #[test]
    fn the_error_before_has_its_say() {
        let mut controller = Controller::new(5.0, 0.04, 1e-9, 1e9);
        controller.accept(0.5).unwrap();
        let factor = controller.accept(0.02).unwrap();
        assert!((factor - 0.9 * 0.02_f64.powf(-0.17) * 0.5_f64.powf(0.04)).abs() < 1e-14, "{factor}");
        assert!((controller.again(3.0) - 0.9 * 3.0_f64.powf(-0.17)).abs() < 1e-14);
    }
}
