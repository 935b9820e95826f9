// Four f64 in a register of AVX, with FMA.
pub(super) type Real = f64;
pub(super) const LANES: usize = 4;
pub(super) type V = ::core::arch::x86_64::__m256d;
pub(super) type M = ::core::arch::x86_64::__m256d;

macro_rules! functions {
    ($($item:item)*) => { $(#[inline] #[target_feature(enable = "avx2,fma")] $item)* };
}

use ::core::arch::x86_64::*;
pub(super) use ::core::arch::x86_64::{
    _mm256_add_pd as add, _mm256_div_pd as div, _mm256_fmadd_pd as fmadd, _mm256_fmsub_pd as fmsub, _mm256_fnmadd_pd as fnmadd,
    _mm256_fnmsub_pd as fnmsub, _mm256_mul_pd as mul, _mm256_set1_pd as k, _mm256_sqrt_pd as sqrt, _mm256_sub_pd as sub,
};

functions! {
    pub(super) fn neg(x: V) -> V {
        _mm256_xor_pd(x, k(-0.0))
    }

    pub(super) fn positive(x: V) -> M {
        _mm256_cmp_pd::<_CMP_GT_OQ>(x, k(0.0))
    }

    pub(super) fn select(m: M, a: V, b: V) -> V {
        _mm256_blendv_pd(b, a, m)
    }

    pub(super) fn across(x: V) -> V {
        let pairs = add(x, _mm256_permute_pd::<0b0101>(x));
        add(pairs, _mm256_permute2f128_pd::<1>(pairs, pairs))
    }

    fn within(x: V, limit: V) -> bool {
        _mm256_movemask_pd(_mm256_cmp_pd::<_CMP_LE_OQ>(_mm256_andnot_pd(k(-0.0), x), limit)) == 0b1111
    }

    fn turn(quadrant: V, sin: V, cos: V) -> (V, V) {
        let quadrant = _mm256_castpd_si256(quadrant);
        let odd = _mm256_castsi256_pd(_mm256_slli_epi64::<63>(quadrant));
        let sin_sign = _mm256_and_pd(_mm256_castsi256_pd(_mm256_slli_epi64::<62>(quadrant)), k(-0.0));
        let cos_sign = _mm256_xor_pd(sin_sign, odd);
        (_mm256_xor_pd(select(odd, cos, sin), sin_sign), _mm256_xor_pd(select(odd, sin, cos), cos_sign))
    }
}
