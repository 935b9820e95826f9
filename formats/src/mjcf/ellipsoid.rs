//! Virtual masses of ellipsoids: the fluid that moves with them, over its density.
//!
//! ```text
//! κ_i = ∫ s_i s_j s_k / √((s_i² + λ)³ (s_j² + λ) (s_k² + λ)) dλ, λ from 0 to ∞
//! m_i = V κ_i/(2 − κ_i)
//! J_i = V/5 (s_j² − s_k²)² (κ_k − κ_j) / (2 (s_j² − s_k²) + (s_j² + s_k²)(κ_j − κ_k))
//! ```
//!
//! Sources: Lamb, Hydrodynamics, 1932, §114, §115; MuJoCo documentation, Fluid forces, Ellipsoid
//! model.

use core::f64::consts::PI;

use crate::pose::Vector;

/// m_i, m³, and J_i, m⁵, of the ellipsoid with these semi-axes, m.
pub(crate) fn virtual_masses(semi_axes: Vector) -> [Vector; 2] {
    let around = |k: usize| [k, (k + 1) % 3, (k + 2) % 3];
    let kappa = [0, 1, 2].map(|k| kappa(around(k).map(|i| semi_axes[i])));
    let volume = 4.0 / 3.0 * PI * semi_axes.iter().product::<f64>();
    let mass = kappa.map(|own| volume * own / (2.0 - own).max(LEAST));
    let inertia = [0, 1, 2].map(|k| {
        let [_, i, j] = around(k);
        let [one, other] = [i, j].map(|i| semi_axes[i] * semi_axes[i]);
        let divisor = 2.0 * (one - other) + (one + other) * (kappa[i] - kappa[j]);
        volume / 5.0 * (one - other).powi(2) * (kappa[j] - kappa[i]).abs() / divisor.abs().max(LEAST)
    });
    [mass, inertia]
}

/// MuJoCo's least divisor.
const LEAST: f64 = 1e-14;

/// Nodes below ½ and weights of Kronrod's 15 points on [0, 1], with the digits that MuJoCo has.
const POINTS: [[f64; 2]; 7] = [
    [0.004_272_31, 0.011_467_66],
    [0.025_446_04, 0.031_546_05],
    [0.067_567_79, 0.052_395_01],
    [0.129_234_41, 0.070_326_63],
    [0.206_956_38, 0.084_502_36],
    [0.297_077_42, 0.095_175_29],
    [0.396_107_52, 0.102_216_47],
];

/// The weight at ½.
const MIDDLE: f64 = 0.104_741_07;

/// κ along the first of these semi-axes, by λ = c x³/(1 − x)² with c of the size of the ellipsoid.
fn kappa([own, one, other]: Vector) -> f64 {
    let scale = (own * own * own * one * other).powf(0.4);
    let at = |[x, weight]: [f64; 2]| {
        let rest = 1.0 - x;
        let lambda = scale * (x * x * x / (rest * rest));
        let slope = x * x * (3.0 - x) / (rest * rest * rest);
        let [a, b, c] = [own, one, other].map(|s| 1.0 + lambda / (s * s));
        scale * slope * weight / (a * (a * b * c).sqrt())
    };
    let pairs: f64 = POINTS.iter().map(|&[x, weight]| at([x, weight]) + at([1.0 - x, weight])).sum();
    (pairs + at([0.5, MIDDLE])) / (own * own)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn assert_near(found: f64, expected: f64, tolerance: f64) {
        assert!((found - expected).abs() <= tolerance * expected.abs(), "{found} {expected}");
    }

    #[test]
    fn a_sphere_moves_half_of_the_fluid_that_it_displaces() {
        for radius in [1e-3, 0.2, 30.0_f64] {
            let [mass, inertia] = virtual_masses([radius; 3]);
            mass.iter().for_each(|own| assert_near(*own, 2.0 / 3.0 * PI * radius.powi(3), 1e-6));
            assert_eq!(inertia, [0.0; 3]);
        }
    }

    /// Lamb, §114: of the semi-axes a > b = b with e² = 1 − b²/a² in closed form.
    #[test]
    fn a_prolate_spheroid_has_the_masses_of_lamb() {
        let [a, b] = [0.5_f64, 0.2];
        let e = (1.0 - (b / a).powi(2)).sqrt();
        let log = ((1.0 + e) / (1.0 - e)).ln();
        let alpha = 2.0 * (1.0 - e * e) / e.powi(3) * (0.5 * log - e);
        let beta = 1.0 / (e * e) - (1.0 - e * e) / (2.0 * e.powi(3)) * log;
        let volume = 4.0 / 3.0 * PI * a * b * b;
        let [mass, inertia] = virtual_masses([b, a, b]);
        let across = volume * beta / (2.0 - beta);
        [across, volume * alpha / (2.0 - alpha), across].iter().zip(mass).for_each(|(expected, found)| assert_near(found, *expected, 1e-4));
        let difference = a * a - b * b;
        let turned = volume / 5.0 * difference * difference * (beta - alpha) / (2.0 * difference + (a * a + b * b) * (alpha - beta));
        assert_near(inertia[0], turned, 1e-4);
        assert_eq!(inertia[1], 0.0);
    }
}
