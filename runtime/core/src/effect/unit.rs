//! Directions that are given by vectors of any length, and quaternions of any norm.

/// The normalised vector; none for a vector of zeros, or with a number that is not finite.
///
/// It is first divided by its largest number: squares, and the length itself, may be beyond the
/// range of numbers.
pub fn unit(mut vector: [f64; 3]) -> Option<[f64; 3]> {
    normalise(&mut vector).then_some(vector)
}

/// As [`unit`], in place and for any count of numbers; false if it has no direction, and is then
/// unchanged.
pub(super) fn normalise(vector: &mut [f64]) -> bool {
    let largest = vector.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    if largest == 0.0 || !vector.iter().all(|x| x.is_finite()) {
        return false;
    }
    vector.iter_mut().for_each(|x| *x /= largest);
    let length = libm::sqrt(vector.iter().map(|x| x * x).sum());
    vector.iter_mut().for_each(|x| *x /= length);
    true
}

#[cfg(test)]
mod tests {
    use super::unit;

    #[test]
    fn the_shortest_and_the_longest_vectors_have_a_direction() {
        let half = 0.5_f64.sqrt();
        for length in [5e-324, 1e-310, 1e-200, 1.0, 1e200, f64::MAX] {
            assert_eq!(unit([0.0, 0.0, -length]), Some([0.0, 0.0, -1.0]), "{length}");
            let [x, y, z] = unit([length, -length, 0.0]).unwrap();
            assert!((x - half).abs() < 1e-15 && (y + half).abs() < 1e-15 && z == 0.0, "{length}");
        }
    }

    #[test]
    fn what_points_nowhere_has_none() {
        for vector in [[0.0; 3], [1.0, f64::NAN, 0.0], [f64::INFINITY, 1.0, 0.0]] {
            assert_eq!(unit(vector), None);
        }
    }
}
