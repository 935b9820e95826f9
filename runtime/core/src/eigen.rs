//! Eigenvalues of a symmetric 3×3 matrix, by Jacobi's rotations: the principal moments of a
//! rotational inertia.

/// Eigenvalues in rising order of the symmetric matrix xx, xy, xz, yy, yz, zz. Backward error of
/// some 1e-15 of the largest entry, whatever the scale of the entries, which have to be finite.
/// Golub & Van Loan, *Matrix Computations*, §8.5.
pub fn eigenvalues(m: [f64; 6]) -> [f64; 3] {
    let scale = m.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    if scale == 0.0 {
        return [0.0; 3];
    }
    let [xx, xy, xz, yy, yz, zz] = m.map(|x| x / scale);
    let mut a = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
    // Convergence is quadratic: five sweeps are more than enough.
    for _ in 0..8 {
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            rotate(&mut a, p, q);
        }
    }
    let mut values = [a[0][0] * scale, a[1][1] * scale, a[2][2] * scale];
    values.sort_unstable_by(f64::total_cmp);
    values
}

/// Makes the entry (p, q) zero: a ← JᵀaJ.
fn rotate(a: &mut [[f64; 3]; 3], p: usize, q: usize) {
    if a[p][q] == 0.0 {
        return;
    }
    // t = tan θ, the smaller root of t² + 2τt − 1 = 0
    let tau = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
    let t = 1.0_f64.copysign(tau) / (tau.abs() + libm::hypot(tau, 1.0));
    let c = 1.0 / libm::hypot(t, 1.0);
    let s = t * c;
    let r = 3 - p - q;
    let apq = a[p][q];
    a[p][p] -= t * apq;
    a[q][q] += t * apq;
    (a[p][q], a[q][p]) = (0.0, 0.0);
    let (arp, arq) = (a[r][p], a[r][q]);
    a[r][p] = c * arp - s * arq;
    a[r][q] = s * arp + c * arq;
    (a[p][r], a[q][r]) = (a[r][p], a[r][q]);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// |λ³ − tr λ² + minors λ − det| for each eigenvalue, relative to the largest.
    fn residual(m: [f64; 6]) -> f64 {
        let [xx, xy, xz, yy, yz, zz] = m;
        let trace = xx + yy + zz;
        let minors = xx * yy - xy * xy + xx * zz - xz * xz + yy * zz - yz * yz;
        let det = xx * (yy * zz - yz * yz) - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz);
        let values = eigenvalues(m);
        let size = values.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        let worst = values.map(|l| (((l - trace) * l + minors) * l - det).abs() / (size * size * size));
        worst.into_iter().fold(0.0, f64::max)
    }

    #[test]
    fn eigenvalues_are_roots_of_the_characteristic_polynomial() {
        let mut seed = 7_u64;
        let mut next = || {
            seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (seed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
        };
        for _ in 0..1000 {
            let m = [(); 6].map(|()| next());
            assert!(residual(m) < 1e-13, "{m:?}");
        }
    }

    #[test]
    fn known_matrices() {
        assert_eq!(eigenvalues([3.0, 0.0, 0.0, 1.0, 0.0, 2.0]), [1.0, 2.0, 3.0]);
        assert_eq!(eigenvalues([0.0; 6]), [0.0; 3]);
        // all ones: 0, 0, 3
        let [a, b, c] = eigenvalues([1e-20; 6]);
        assert!(a.abs() < 1e-35 && b.abs() < 1e-35 && (c - 3e-20).abs() < 1e-35);
        let huge = eigenvalues([1e300, 1e300, 0.0, 1e300, 0.0, 1e300]);
        assert!(huge.iter().all(|x| x.is_finite()));
    }
}
