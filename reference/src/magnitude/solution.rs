//! The scale of solutions with the mass matrix.
//!
//! A backward stable solution X of M X = R solves (M + δM) X = R + δR, with |δM| ≤ u ‖M‖ and |δR| ≤
//! u ‖R‖, u a few roundings and ‖·‖ the sums of magnitudes of M's and R's terms. So, to first
//! order,
//!
//! ```text
//! |δX| ≤ u |M⁻¹| (‖R‖ + ‖M‖ |X|)        Higham, Accuracy and Stability of Numerical Algorithms, 2002, §7.2
//! ```
//!
//! No magnitude goes through a division: the scale is the error of a good solution by the
//! conditioning of M, and no larger.

use articulated_core::algorithm::{Argument, Function, FunctionError, FunctionId, Workspace};
use articulated_core::model::Model;

use super::scales::{UNKNOWN, exact_magnitudes, magnitudes};
use super::{Magnitude, ROUNDOFF};

pub(super) fn scales(model: &Model<f64>, row: &Function<f64>, arguments: &[&[f64]]) -> Result<Vec<f64>, FunctionError> {
    let q = arguments.first().ok_or(FunctionError::Length { argument: "arguments", found: 0, expected: row.takes.len() })?;
    let state = State { model, mass: Mass::at(model, q)?, arguments };
    match row.general {
        FunctionId::forward_dynamics_with_wrenches => state.forward_dynamics(row),
        FunctionId::forward_dynamics_derivatives_with_wrenches => state.forward_slopes(row),
        FunctionId::solve_mass_matrix => Ok(state.mass.solution(&absolute(arguments[1]), &state.value(row)?)),
        FunctionId::mass_matrix_inverse => Ok(state.mass.inverse_scale()),
        FunctionId::operational_space_inertia_inverse => state.operational_space(None),
        FunctionId::operational_space_inertia => state.operational_space(Some(&state.value(row)?)),
        // Other functions that invert M have no scale yet.
        _ => Err(UNKNOWN),
    }
}

/// ‖M‖, M⁻¹ and |M⁻¹| in one configuration, `[n][n]`.
struct Mass {
    n: usize,
    terms: Vec<f64>,
    inverse: Vec<f64>,
    modulus: Vec<f64>,
}

impl Mass {
    fn at(model: &Model<f64>, q: &[f64]) -> Result<Self, FunctionError> {
        let terms = magnitudes(model, "mass_matrix", &exact_magnitudes(&[q]))?.iter().map(|x| x.magnitude).collect();
        let inverse = value(model, FunctionId::mass_matrix_inverse.row(), &[q])?;
        Ok(Self { n: model.nv(), terms, modulus: absolute(&inverse), inverse })
    }

    /// |M⁻¹| (‖R‖ + ‖M‖ |X|), for any number of columns.
    fn solution(&self, right: &[f64], x: &[f64]) -> Vec<f64> {
        let mut sum = product(&self.terms, &absolute(x), self.n, self.n);
        sum.iter_mut().zip(right).for_each(|(s, r)| *s += r);
        product(&self.modulus, &sum, self.n, self.n)
    }

    /// The scale of M⁻¹, the solution for R = 1.
    fn inverse_scale(&self) -> Vec<f64> {
        let one: Vec<f64> = (0..self.n * self.n).map(|k| f64::from(u8::from(k % (self.n + 1) == 0))).collect();
        self.solution(&one, &self.inverse)
    }
}

struct State<'a> {
    model: &'a Model<f64>,
    mass: Mass,
    arguments: &'a [&'a [f64]],
}

impl State<'_> {
    fn value(&self, row: &Function<f64>) -> Result<Vec<f64>, FunctionError> {
        value(self.model, row, self.arguments)
    }

    /// M a = τ − h.
    fn forward_dynamics(&self, row: &Function<f64>) -> Result<Vec<f64>, FunctionError> {
        let still = vec![0.0; self.model.nv()];
        let inverse = beside(row, FunctionId::inverse_dynamics_with_wrenches);
        let needed = magnitudes(self.model, inverse.name, &exact_magnitudes(&self.with(&still)))?;
        let right: Vec<f64> = needed.iter().zip(self.arguments[2]).map(|(h, tau)| h.magnitude + tau.abs()).collect();
        Ok(self.mass.solution(&right, &self.value(row)?))
    }

    /// M ∂a/∂x = −∂τ/∂x at a, which is itself off by its own scale; and M ∂a/∂τ = 1.
    fn forward_slopes(&self, row: &Function<f64>) -> Result<Vec<f64>, FunctionError> {
        let solved = beside(row, FunctionId::forward_dynamics_with_wrenches);
        let a = self.value(solved)?;
        let known: Vec<Magnitude> =
            a.iter().zip(self.forward_dynamics(solved)?).map(|(a, scale)| Magnitude::computed(*a, scale.max(a.abs()))).collect();
        let mut arguments = exact_magnitudes(&self.with(&a));
        arguments[2] = known;
        let name = beside(row, FunctionId::inverse_dynamics_derivatives_with_wrenches).name;
        let right: Vec<f64> = magnitudes(self.model, name, &arguments)?.iter().map(|x| x.magnitude).collect();
        let (size, slopes) = (self.mass.n * self.mass.n, self.value(row)?);
        let block = |k: usize| self.mass.solution(&right[k * size..][..size], &slopes[k * size..][..size]);
        Ok([block(0), block(1), self.mass.inverse_scale()].concat())
    }

    /// The arguments with a in the place of τ.
    fn with<'b>(&'b self, a: &'b [f64]) -> Vec<&'b [f64]> {
        let mut arguments = self.arguments.to_vec();
        arguments[2] = a;
        arguments
    }

    /// Λ⁻¹ = J X with M X = Jᵀ, and Λ, of each frame. Their errors by δM, δJ and the rounding ε of
    /// J X are, with Y = X Λ,
    ///
    /// ```text
    /// δΛ⁻¹ = −Xᵀ δM X + δJ X + Xᵀ δJᵀ + ε        δΛ = Yᵀ δM Y − Λ δJ Y − Yᵀ δJᵀ Λ − Λ ε Λ        |ε| ≤ u ‖J‖ |X|
    /// ```
    fn operational_space(&self, inertia: Option<&[f64]>) -> Result<Vec<f64>, FunctionError> {
        let (n, mut scale) = (self.mass.n, Vec::new());
        if n == 0 {
            return Ok(vec![0.0; 36 * self.model.frames().len()]);
        }
        let jacobians = magnitudes(self.model, "jacobians_world_aligned", &exact_magnitudes(&self.arguments[..1]))?;
        for (k, jacobian) in jacobians.chunks_exact(6 * n).enumerate() {
            let terms = vectors(&jacobian.iter().map(|x| x.magnitude).collect::<Vec<_>>(), n);
            let values: Vec<f64> = jacobian.iter().map(|x| x.value).collect();
            let x = product(&self.mass.inverse, &transposed(&values, n), n, n);
            // ‖J‖ |X|
            let rounding = product(&terms, &absolute(&x), 6, n);
            let (held, by_jacobian, rounding) = match inertia.map(|all| &all[36 * k..][..36]) {
                None => {
                    // δJ M⁻¹ δJᵀ is all there is where J has a row of zeros.
                    let second = product(&terms, &product(&self.mass.modulus, &transposed(&terms, n), n, n), 6, n);
                    let rounding: Vec<f64> = rounding.iter().zip(second).map(|(r, s)| r + ROUNDOFF * s).collect();
                    (absolute(&x), rounding.clone(), rounding)
                }
                Some(inertia) => {
                    let (y, inertia) = (absolute(&product(&x, inertia, n, 6)), absolute(inertia));
                    let through = |m: &[f64]| product(&inertia, m, 6, 6);
                    let (by_jacobian, twice) = (through(&product(&terms, &y, 6, n)), product(&through(&rounding), &inertia, 6, 6));
                    (y, by_jacobian, twice)
                }
            };
            let by_mass = product(&transposed(&held, 6), &product(&self.mass.terms, &held, n, n), 6, n);
            // Only one triangle is computed.
            let both = |m: &[f64], k: usize| m[k] + m[k % 6 * 6 + k / 6];
            scale.extend((0..36).map(|k| by_mass[k] + both(&by_jacobian, k) + both(&rounding, k) / 2.0));
        }
        Ok(scale)
    }
}

/// A function with the wrenches of another one, or without wrenches if that takes none.
fn beside(other: &Function<f64>, function: FunctionId) -> &'static Function<f64> {
    function.row().at_zero(|argument| argument == Argument::Wrenches && !other.takes.contains(&argument))
}

fn value(model: &Model<f64>, row: &Function<f64>, arguments: &[&[f64]]) -> Result<Vec<f64>, FunctionError> {
    let mut out = vec![0.0; row.len(model.shape())];
    row.call(model, &mut Workspace::new(model), arguments, &mut out)?;
    Ok(out)
}

fn absolute(x: &[f64]) -> Vec<f64> {
    x.iter().map(|x| x.abs()).collect()
}

/// Scales from magnitudes of a Jacobian, `[6][n]`: each column is two vectors, and computing them
/// in other axes rounds all entries of a vector relative to its largest.
fn vectors(magnitudes: &[f64], n: usize) -> Vec<f64> {
    let largest = |row: usize, column: usize| (0..3).map(|k| magnitudes[(row / 3 * 3 + k) * n + column]).fold(0.0, f64::max);
    (0..6 * n).map(|k| largest(k / n, k % n)).collect()
}

/// A·B of an `[rows][inner]` and an `[inner][any]` matrix.
fn product(a: &[f64], b: &[f64], rows: usize, inner: usize) -> Vec<f64> {
    let width = b.len() / inner.max(1);
    (0..rows * width).map(|k| (0..inner).map(|i| a[k / width * inner + i] * b[i * width + k % width]).sum()).collect()
}

/// The transpose of a matrix with rows of this width.
fn transposed(a: &[f64], width: usize) -> Vec<f64> {
    let rows = a.len() / width.max(1);
    (0..a.len()).map(|k| a[k % rows * width + k / rows]).collect()
}

#[cfg(test)]
mod tests {
    use articulated_core::algorithm::{FunctionId, functions};

    use crate::magnitude::{ROUNDOFF, scales};
    use crate::samples::{arguments, bundled};

    #[test]
    fn a_solution_is_measured_by_the_inverse_of_the_mass_matrix() {
        let model = bundled("simple_pendulum");
        // a = (τ − 9.81 sin q) / 1.001 with τ = 3: the terms are τ, g and M a
        let (q, tau) = (0.5_f64, 3.0_f64);
        let gravity = 9.81 * q.sin();
        let least = (tau + (tau - gravity).abs() + gravity) / 1.001;
        let scale = scales(&model, "forward_dynamics", &[&[q], &[0.0], &[tau]]).unwrap()[0];
        assert!(scale >= least * 0.999 && scale < 4.0 * least, "{scale} {least}");
    }

    /// Every solving function has a scale, at least its own size, and small enough that a wrong
    /// seventh digit does not pass.
    #[test]
    fn no_scale_lets_everything_pass() {
        for name in ["panda_like", "quadruped"] {
            let model = bundled(name);
            let tip = [model.frames().last().expect("a frame").name.clone()];
            let model = model.with_frames(&tip).unwrap();
            for f in functions::<f64>().iter().filter(|f| f.inverts_mass_matrix()) {
                for number in 0..8 {
                    let arguments = arguments(&model, f, number);
                    let arguments: Vec<&[f64]> = arguments.iter().map(Vec::as_slice).collect();
                    let (found, scale) = (super::value(&model, f, &arguments).unwrap(), scales(&model, f.name, &arguments).unwrap());
                    assert_eq!(found.len(), scale.len());
                    let largest = found.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
                    for (x, s) in found.iter().zip(&scale) {
                        assert!(x.abs() <= s * (1.0 + 1e-12), "{name} {}: {x} {s}", f.name);
                        assert!(64.0 * ROUNDOFF * s < 1e-7 * largest, "{name} {}: {x} {s} {largest}", f.name);
                    }
                }
            }
        }
    }

    #[test]
    fn the_scale_of_an_inverse_is_that_of_its_columns() {
        let model = bundled("panda_like");
        let q = [0.1, -0.4, 0.7, -1.9, 0.3, 1.2, -0.5];
        let all = scales(&model, FunctionId::mass_matrix_inverse.name(), &[&q]).unwrap();
        for j in 0..7 {
            let unit: Vec<f64> = (0..7).map(|i| f64::from(u8::from(i == j))).collect();
            let column = scales(&model, "solve_mass_matrix", &[&q, &unit]).unwrap();
            for (i, s) in column.iter().enumerate() {
                assert!((s - all[7 * i + j]).abs() < 1e-12 * s, "{i} {j}");
            }
        }
    }
}
