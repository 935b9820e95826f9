//! The medium around bodies, as it acts on the boxes of their inertias or on ellipsoids.
//!
//! On ellipsoids it acts as the effect `ellipsoid_drag` says. On boxes:
//!
//! ```text
//! sides of the box:   s_i² = 6 (I_j + I_k − I_i)/m,   d = (s₁ + s₂ + s₃)/3
//! drag:               c_i = ½ ρ s_j s_k,   C_i = ρ s_i (s_j⁴ + s_k⁴)/64
//! viscous:            b = 3 π d β,   B = π d³ β
//! ```
//!
//! Source: MuJoCo documentation, Fluid forces.

use core::f64::consts::PI;

use super::axes::{in_axes, principal};
use super::ellipsoid::virtual_masses;
use super::mass::Mass;
use crate::pose::{IDENTITY, Pose, Vector, conjugate, multiply, turned};

/// A medium, at rest or in motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Medium {
    /// ρ, kg/m³.
    pub(crate) density: f64,
    /// β, Pa·s.
    pub(crate) viscosity: f64,
    /// Its velocity, m/s.
    pub(crate) wind: Vector,
}

impl Medium {
    /// The frame and the parameters of the drag on the box of a body's inertia.
    pub(crate) fn drag(&self, body: &Mass) -> (Pose, Vec<f64>) {
        // `principal` has absolute thresholds: the inertia is scaled to one for small bodies.
        let size = body.inertia.iter().fold(0.0_f64, |most, x| most.max(x.abs())).max(f64::MIN_POSITIVE);
        let first = body.axes.unwrap_or(IDENTITY);
        let axes = multiply(first, principal(turned(conjugate(first), body.inertia.map(|x| x / size))).1);
        let [x, _, _, y, _, z] = in_axes(axes, body.inertia);
        let frame = body.pose.then(&Pose { rotation: axes, ..Pose::default() });
        let side = |own: f64, one: f64, other: f64| (6.0 * (one + other - own).max(LEAST) / body.mass).sqrt();
        let sides = [side(x, y, z), side(y, z, x), side(z, x, y)];
        let diameter = sides.iter().sum::<f64>() / 3.0;
        let around = |k: usize| (sides[k], sides[(k + 1) % 3], sides[(k + 2) % 3]);
        let along = [0, 1, 2].map(|k| 0.5 * self.density * around(k).1 * around(k).2);
        let about = [0, 1, 2].map(|k| {
            let (own, one, other) = around(k);
            self.density * own * (one.powi(4) + other.powi(4)) / 64.0
        });
        let viscous = [3.0 * PI * diameter * self.viscosity, PI * diameter.powi(3) * self.viscosity];
        (frame, [&along[..], &about, &viscous, &self.wind].concat())
    }

    /// The parameters of the drag on an ellipsoid with these semi-axes and coefficients.
    pub(crate) fn ellipsoid(&self, semi_axes: Vector, coefficients: [f64; 5]) -> Vec<f64> {
        let [mass, inertia] = virtual_masses(semi_axes);
        [&semi_axes[..], &[self.density, self.viscosity], &coefficients, &mass, &inertia, &self.wind].concat()
    }
}

/// MuJoCo's least number, kg·m².
const LEAST: f64 = 1e-15;
