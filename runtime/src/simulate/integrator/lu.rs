//! Small dense systems of equations: elimination with row exchanges, in room made once.

/// A factorised matrix, `[n][n]`.
#[derive(Clone, Debug)]
pub(super) struct Lu {
    n: usize,
    pub(super) matrix: Vec<f64>,
    rows: Vec<usize>,
}

impl Lu {
    pub(super) fn new(n: usize) -> Self {
        Self { n, matrix: vec![0.0; n * n], rows: vec![0; n] }
    }

    /// Factorises `matrix` in place; false if it is singular or not finite. Golub & Van Loan 2013,
    /// Algorithm 3.4.1.
    pub(super) fn factorize(&mut self) -> bool {
        let (n, m) = (self.n, &mut self.matrix);
        for k in 0..n {
            let size = |i: usize, m: &[f64]| m[i * n + k].abs();
            let pivot = (k..n).fold(k, |best, i| if size(i, m) > size(best, m) { i } else { best });
            let p = m[pivot * n + k];
            if p == 0.0 || !p.is_finite() {
                return false;
            }
            self.rows[k] = pivot;
            if pivot != k {
                (0..n).for_each(|j| m.swap(k * n + j, pivot * n + j));
            }
            for i in k + 1..n {
                let factor = m[i * n + k] / p;
                m[i * n + k] = factor;
                for j in k + 1..n {
                    m[i * n + j] -= factor * m[k * n + j];
                }
            }
        }
        true
    }

    /// x ← matrix⁻¹ x, `[n]`.
    pub(super) fn solve(&self, x: &mut [f64]) {
        let (n, m) = (self.n, &self.matrix);
        for k in 0..n {
            x.swap(k, self.rows[k]);
        }
        for i in 0..n {
            x[i] -= (0..i).map(|j| m[i * n + j] * x[j]).sum::<f64>();
        }
        for i in (0..n).rev() {
            x[i] = (x[i] - (i + 1..n).map(|j| m[i * n + j] * x[j]).sum::<f64>()) / m[i * n + i];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Lu;

    #[test]
    fn a_solution_solves_and_a_singular_matrix_is_seen() {
        let matrix = vec![0.0, 2.0, 1.0, 1.0, -1.0, 3.0, 4.0, 0.5, -2.0];
        let mut lu = Lu { matrix: matrix.clone(), ..Lu::new(3) };
        assert!(lu.factorize());
        let expected = [1.0, -2.0, 0.5];
        let mut x: Vec<f64> = (0..3).map(|i| (0..3).map(|j| matrix[3 * i + j] * expected[j]).sum()).collect();
        lu.solve(&mut x);
        for (x, e) in x.iter().zip(expected) {
            assert!((x - e).abs() < 1e-15);
        }
        let mut singular = Lu { matrix: vec![1.0, 2.0, 2.0, 4.0], ..Lu::new(2) };
        assert!(!singular.factorize());
    }
}
