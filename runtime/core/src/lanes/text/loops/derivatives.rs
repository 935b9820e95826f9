
macro_rules! derivatives {
    ($(#[$features:meta])?) => {
        vectors!($(#[$features])?);
        matrices!($(#[$features])?);
        sweeps!($(#[$features])?);
        rooted!($(#[$features])?);

        $(#[$features])?
        fn derivatives(q: &[f64; NQ], v: &[f64; NV], a: &[f64; NV], out: &mut [f64; 3 * MATRIX]) {
            derivatives_in(&mut Bodies::new(UNKNOWN), q, v, a, out);
        }

        $(#[$features])?
        #[inline]
        fn derivatives_in(bodies: &mut Bodies, q: &[f64; NQ], v: &[f64; NV], a: &[f64; NV], out: &mut [f64; 3 * MATRIX]) {
            let root = Root::new(q, v, a);
            inputs(bodies, &root, q, v, a);
            places(bodies);
            motion(bodies);
            sums(bodies);
            wrenches(bodies);
            out.fill(0.0);
            with_root(bodies, &root, out);
            pairs(bodies, out);
            root_alone(bodies, &root, out);
        }
    };
}

/// ∂τ/∂q, ∂τ/∂v and ∂τ/∂a.
pub(super) fn inverse_dynamics_derivatives(q: &[f64; NQ], v: &[f64; NV], a: &[f64; NV], out: &mut [[[f64; NV]; NV]; 3]) {
    if let ::core::option::Option::Some(out) = out.as_flattened_mut().as_flattened_mut().first_chunk_mut() {
        chosen(q, v, a, out);
    }
}

fn chosen(q: &[f64; NQ], v: &[f64; NV], a: &[f64; NV], out: &mut [f64; 3 * MATRIX]) {
    #[cfg(target_arch = "x86_64")]
    {
        use super::avx2_f64x4::*;
        derivatives!(#[target_feature(enable = "avx2,fma")]);
        #[cfg(all(target_feature = "avx512vl", target_feature = "avx512vbmi2"))]
        use wide::{all_pairs as pairs, mix, turn_each};
        #[cfg(not(all(target_feature = "avx512vl", target_feature = "avx512vbmi2")))]
        narrow!(#[target_feature(enable = "avx2,fma")]);
        #[cfg(all(target_arch = "x86_64", not(all(target_feature = "avx2", target_feature = "fma"))))]
        if ::std::is_x86_feature_detected!("avx2") && ::std::is_x86_feature_detected!("fma") {
            // SAFETY: the processor was just asked for both.
            return unsafe { derivatives(q, v, a, out) };
        }
        #[cfg(all(target_feature = "avx2", target_feature = "fma"))]
        // SAFETY: this is compiled for processors with both.
        return unsafe { derivatives(q, v, a, out) };
    }
    #[cfg(target_arch = "aarch64")]
    {
        use super::neon_f64x4::*;
        derivatives!(#[target_feature(enable = "neon")]);
        narrow!(#[target_feature(enable = "neon")]);
        // SAFETY: every 64-bit Arm processor has it.
        return unsafe { derivatives(q, v, a, out) };
    }
    #[cfg(not(any(target_arch = "aarch64", all(target_arch = "x86_64", target_feature = "avx2", target_feature = "fma"))))]
    {
        use super::portable_f64x4::*;
        derivatives!();
        narrow!();
        derivatives(q, v, a, out)
    }
}
