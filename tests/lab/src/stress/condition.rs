//! Condition numbers in the 2-norm.

use articulated_core::algorithm::checked::Factor;

/// √M_ii of a matrix, `[n · n]`.
pub(super) fn diagonal(m: &[f64]) -> Vec<f64> {
    let n = m.len().isqrt();
    (0..n).map(|k| m[k * (n + 1)].sqrt()).collect()
}

/// ‖x‖₂, without underflow of squares of small numbers.
pub(super) fn norm(x: &[f64]) -> f64 {
    let most = x.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    if most == 0.0 { 0.0 } else { most * x.iter().map(|x| (x / most) * (x / most)).sum::<f64>().sqrt() }
}

/// κ₂ of M_ik/(s_i s_k).
pub(super) fn condition(m: &[f64], s: &[f64]) -> f64 {
    sensitivity(m, m, s)
}

/// ‖M⁻¹‖₂ ‖T‖₂, both scaled by s_i s_k: the relative change of a solution for a relative change of
/// M's terms T. By power iteration, so it is a lower bound.
pub(super) fn sensitivity(m: &[f64], terms: &[f64], s: &[f64]) -> f64 {
    let n = s.len();
    let mut factor = Factor::<f64>::new(n);
    let _ = factor.factor(m);
    let times = |x: &mut [f64], of: &dyn Fn(f64, f64) -> f64| x.iter_mut().zip(s).for_each(|(x, s)| *x = of(*x, *s));
    let product = |x: &mut Vec<f64>| {
        times(x, &|x, s| x / s);
        *x = (0..n).map(|i| terms[i * n..][..n].iter().zip(x.iter()).map(|(m, x)| m * x).sum()).collect();
        times(x, &|x, s| x / s);
    };
    let inverse = |x: &mut Vec<f64>| {
        times(x, &|x, s| x * s);
        factor.solve(x);
        times(x, &|x, s| x * s);
    };
    largest(n, product) * largest(n, inverse)
}

/// The largest eigenvalue, from two starts.
fn largest(n: usize, apply: impl Fn(&mut Vec<f64>)) -> f64 {
    let alternate = |k: usize| if k.is_multiple_of(2) { 1.0 } else { -1.0 };
    let from = |sign: &dyn Fn(usize) -> f64| {
        let mut x: Vec<f64> = (0..n).map(|k| sign(k) * (1.0 + 0.3 * ((k * 7) % 5) as f64)).collect();
        let mut size = norm(&x);
        for _ in 0..40 {
            x.iter_mut().for_each(|x| *x /= size);
            apply(&mut x);
            size = norm(&x);
        }
        size
    };
    from(&|_| 1.0).max(from(&alternate))
}
