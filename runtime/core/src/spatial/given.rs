//! Quaternions that are given: written in a file, or made by a program.

use crate::Scalar;

/// The norm of a quaternion that is given may be off from one by so much, which is what four written digits leave. It is normalised then.
pub const NORM_TOLERANCE: f64 = 1e-3;

/// The norm of a quaternion that is given. Errors: the norm, where it is not one within [`NORM_TOLERANCE`].
pub fn given_norm(quaternion: &[f64]) -> Result<f64, f64> {
    let norm = Scalar::sqrt(quaternion.iter().map(|x| x * x).sum::<f64>());
    if Scalar::abs(norm - 1.0) <= NORM_TOLERANCE { Ok(norm) } else { Err(norm) }
}

/// Brings a quaternion that is given to a norm of one, and says what it was. Errors: as [`given_norm`]; it is left as it is.
pub fn normalise_given(quaternion: &mut [f64]) -> Result<f64, f64> {
    let norm = given_norm(quaternion)?;
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
            normalise_given(&mut quaternion).map(|norm| (norm, quaternion[3]))
        };
        assert_eq!([1.0005, 0.9995].map(given), [Ok((1.0005, 1.0)), Ok((0.9995, 1.0))]);
        assert_eq!([1.01, 0.99, 0.0].map(given), [Err(1.01), Err(0.99), Err(0.0)]);
        assert!(given(f64::NAN).is_err_and(f64::is_nan));
    }
}
