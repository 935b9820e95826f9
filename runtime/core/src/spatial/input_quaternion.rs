//! Input quaternions, from a file or a program.

use crate::Scalar;

/// Largest accepted |norm − 1| of an input quaternion, which four written digits keep. Within it,
/// the quaternion is normalised.
pub const NORM_TOLERANCE: f64 = 1e-3;

/// The norm of an input quaternion. Errors: the norm, where it is not one within
/// [`NORM_TOLERANCE`].
pub fn input_norm(quaternion: &[f64]) -> Result<f64, f64> {
    let norm = Scalar::sqrt(quaternion.iter().map(|x| x * x).sum::<f64>());
    if Scalar::abs(norm - 1.0) <= NORM_TOLERANCE { Ok(norm) } else { Err(norm) }
}

/// Normalises an input quaternion and returns its former norm. Errors: as [`input_norm`]; the
/// quaternion is unchanged.
pub fn normalise_input(quaternion: &mut [f64]) -> Result<f64, f64> {
    let norm = input_norm(quaternion)?;
    quaternion.iter_mut().for_each(|x| *x /= norm);
    Ok(norm)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn four_digits_are_enough_and_three_are_not() {
        let given = |w: f64| {
            let mut quaternion = [0.0, 0.0, 0.0, w];
            normalise_input(&mut quaternion).map(|norm| (norm, quaternion[3]))
        };
        assert_eq!([1.0005, 0.9995].map(given), [Ok((1.0005, 1.0)), Ok((0.9995, 1.0))]);
        assert_eq!([1.01, 0.99, 0.0].map(given), [Err(1.01), Err(0.99), Err(0.0)]);
        assert!(given(f64::NAN).is_err_and(f64::is_nan));
    }
}
