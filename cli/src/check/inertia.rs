//! Principal moments.

/// The eigenvalues of a symmetric matrix (xx, xy, xz, yy, yz, zz), smallest first. Jacobi rotations, a fixed number of them: whatever the
/// numbers are, it ends.
pub(super) fn principal_moments([xx, xy, xz, yy, yz, zz]: [f64; 6]) -> [f64; 3] {
    let largest = [xx, xy, xz, yy, yz, zz].iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    if largest == 0.0 || !largest.is_finite() {
        return [xx, yy, zz];
    }
    let mut a = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]].map(|row| row.map(|x| x / largest));
    for _ in 0..12 {
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            rotate(&mut a, p, q);
        }
    }
    let mut moments = [a[0][0], a[1][1], a[2][2]].map(|x| x * largest);
    moments.sort_by(f64::total_cmp);
    moments
}

/// Turns in the plane (p, q) so that a_pq vanishes.
fn rotate(a: &mut [[f64; 3]; 3], p: usize, q: usize) {
    if a[p][q] == 0.0 {
        return;
    }
    let half = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
    // t = tan θ, the smaller root of t² + 2 half t − 1 = 0
    let t = if half.is_infinite() { 0.0 } else { 1.0_f64.copysign(half) / (half.abs() + half.hypot(1.0)) };
    let c = 1.0 / t.hypot(1.0);
    let s = t * c;
    let apq = a[p][q];
    a[p][p] -= t * apq;
    a[q][q] += t * apq;
    (a[p][q], a[q][p]) = (0.0, 0.0);
    let r = 3 - p - q;
    let (arp, arq) = (a[r][p], a[r][q]);
    (a[r][p], a[r][q]) = (c * arp - s * arq, s * arp + c * arq);
    (a[p][r], a[q][r]) = (a[r][p], a[r][q]);
}

#[cfg(test)]
mod tests {
    use super::principal_moments;

    #[test]
    fn moments_of_a_turned_body() {
        // diag(1, 2, 4) turned by 45° about z
        let moments = principal_moments([1.5, 0.5, 0.0, 1.5, 0.0, 4.0]);
        for (m, expected) in moments.iter().zip([1.0, 2.0, 4.0]) {
            assert!((m - expected).abs() < 1e-14, "{moments:?}");
        }
        let full = principal_moments([3.0, 1.0, -0.5, 2.0, 0.25, 4.0]);
        assert!((full.iter().sum::<f64>() - 9.0).abs() < 1e-13);
        assert!((full.iter().product::<f64>() - (3.0 * (8.0 - 0.0625) - (4.0 + 0.125) - 0.5 * (0.25 + 1.0))).abs() < 1e-12);
    }

    #[test]
    fn any_numbers_are_done_with() {
        for x in [0.0, f64::MAX, f64::MIN_POSITIVE, f64::NAN, f64::INFINITY] {
            let _ = principal_moments([x, 1.0, x, 0.0, 1e-300, x]);
        }
    }
}
