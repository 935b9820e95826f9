
/// [sin x, cos x] of four angles in rad, any. Error at most 1 ulp where the target has fused multiply-add, the standard library's where it has not.
#[inline(always)]
pub fn four(a: f64, b: f64, c: f64, d: f64) -> [Lanes; 2] {
    #[cfg(all(target_arch = "x86_64", target_feature = "avx2", target_feature = "fma"))]
    // SAFETY: `x86::four` asks for a processor with AVX2 and FMA, and the line above says that this is compiled for one.
    return unsafe { x86::four([a, b, c, d]) };
    #[cfg(not(all(target_arch = "x86_64", target_feature = "avx2", target_feature = "fma")))]
    portable([a, b, c, d])
}

/// `lane`, four at a time in AVX2. Written out because the compiler's own vectorisation passes the angles through memory, which holds up the next
/// evaluation. What it brings: `articulated compare <robot>` with and without `--forbid-unsafe`.
#[cfg(all(target_arch = "x86_64", target_feature = "avx2", target_feature = "fma"))]
mod x86 {
    use ::core::arch::x86_64::*;

    use super::{C, HALF_PI, LIMIT, Lanes, ROUND, S, one_by_one};

    #[inline]
    #[target_feature(enable = "avx2,fma")]
    pub(super) fn four(x: Lanes) -> [Lanes; 2] {
        let angles = _mm256_set_pd(x[3], x[2], x[1], x[0]);
        let sizes = _mm256_andnot_pd(all(-0.0), angles);
        // NaN is not within.
        if _mm256_movemask_pd(_mm256_cmp_pd::<_CMP_LE_OQ>(sizes, all(LIMIT))) != 0b1111 {
            return one_by_one(x);
        }
        let [sin, cos] = sin_cos(angles);
        [array(sin), array(cos)]
    }

    #[inline]
    #[target_feature(enable = "avx2,fma")]
    fn all(x: f64) -> __m256d {
        _mm256_set1_pd(x)
    }

    #[inline]
    #[target_feature(enable = "avx2,fma")]
    fn array(x: __m256d) -> Lanes {
        let mut lanes = [0.0; 4];
        // SAFETY: the store writes four doubles, of any alignment, into an array of four doubles that is borrowed for it alone.
        unsafe { _mm256_storeu_pd(lanes.as_mut_ptr(), x) };
        lanes
    }

    #[inline]
    #[target_feature(enable = "avx2,fma")]
    fn fma(a: __m256d, b: __m256d, c: __m256d) -> __m256d {
        _mm256_fmadd_pd(a, b, c)
    }

    /// See `lane`, line by line.
    #[inline]
    #[target_feature(enable = "avx2,fma")]
    fn sin_cos(x: __m256d) -> [__m256d; 2] {
        let rounded = fma(x, all(::core::f64::consts::FRAC_2_PI), all(ROUND));
        let k = _mm256_sub_pd(rounded, all(ROUND));
        let r = _mm256_fnmadd_pd(k, all(HALF_PI[0]), x);
        let hi = _mm256_fnmadd_pd(k, all(HALF_PI[1]), r);
        let lost = _mm256_fnmadd_pd(k, all(HALF_PI[1]), _mm256_sub_pd(r, hi));
        let lo = _mm256_fnmadd_pd(k, all(HALF_PI[2]), lost);
        let z = _mm256_mul_pd(hi, hi);
        let zz = _mm256_mul_pd(z, z);
        let half = _mm256_mul_pd(all(0.5), z);
        let w = _mm256_sub_pd(all(1.0), half);
        let p = fma(zz, fma(zz, all(S[5]), fma(z, all(S[4]), all(S[3]))), fma(z, all(S[2]), all(S[1])));
        let tail = fma(_mm256_mul_pd(hi, z), fma(z, p, all(S[0])), _mm256_mul_pd(lo, w));
        let sin = _mm256_add_pd(hi, tail);
        let p = fma(zz, fma(zz, fma(z, all(C[5]), all(C[4])), fma(z, all(C[3]), all(C[2]))), fma(z, all(C[1]), all(C[0])));
        let lost = _mm256_sub_pd(_mm256_sub_pd(all(1.0), w), half);
        let cos = _mm256_add_pd(w, fma(zz, p, _mm256_sub_pd(lost, _mm256_mul_pd(hi, lo))));
        turn(_mm256_castpd_si256(rounded), sin, cos)
    }

    /// By the quadrant, the two lowest bits: exchange for an odd one, and signs.
    #[inline]
    #[target_feature(enable = "avx2,fma")]
    fn turn(quadrant: __m256i, sin: __m256d, cos: __m256d) -> [__m256d; 2] {
        let odd = _mm256_castsi256_pd(_mm256_slli_epi64::<63>(quadrant));
        let two = _mm256_set1_epi64x(2);
        let next = _mm256_add_epi64(quadrant, _mm256_set1_epi64x(1));
        let sin_sign = _mm256_castsi256_pd(_mm256_slli_epi64::<62>(_mm256_and_si256(quadrant, two)));
        let cos_sign = _mm256_castsi256_pd(_mm256_slli_epi64::<62>(_mm256_and_si256(next, two)));
        let (s, c) = (_mm256_blendv_pd(sin, cos, odd), _mm256_blendv_pd(cos, sin, odd));
        [_mm256_xor_pd(s, sin_sign), _mm256_xor_pd(c, cos_sign)]
    }
}
