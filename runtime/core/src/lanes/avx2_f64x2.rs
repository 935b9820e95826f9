// Two f64 in a register of SSE, in the encoding of AVX and with FMA.
pub(super) type Real = f64;
pub(super) const LANES: usize = 2;
pub(super) type V = ::core::arch::x86_64::__m128d;
pub(super) type M = ::core::arch::x86_64::__m128d;

macro_rules! functions {
    ($($item:item)*) => { $(#[inline] #[target_feature(enable = "avx2,fma")] $item)* };
}

use ::core::arch::x86_64::*;
pub(super) use ::core::arch::x86_64::{
    _mm_add_pd as add, _mm_div_pd as div, _mm_fmadd_pd as fmadd, _mm_fmsub_pd as fmsub, _mm_fnmadd_pd as fnmadd,
    _mm_fnmsub_pd as fnmsub, _mm_mul_pd as mul, _mm_set1_pd as k, _mm_sqrt_pd as sqrt, _mm_sub_pd as sub,
};

functions! {
    pub(super) fn neg(x: V) -> V {
        _mm_xor_pd(x, k(-0.0))
    }

    pub(super) fn positive(x: V) -> M {
        _mm_cmpgt_pd(x, k(0.0))
    }

    pub(super) fn select(m: M, a: V, b: V) -> V {
        _mm_blendv_pd(b, a, m)
    }

    pub(super) fn across(x: V) -> V {
        add(x, _mm_permute_pd::<0b01>(x))
    }

    fn within(x: V, limit: V) -> bool {
        _mm_movemask_pd(_mm_cmple_pd(_mm_andnot_pd(k(-0.0), x), limit)) == 0b11
    }

    fn turn(quadrant: V, sin: V, cos: V) -> (V, V) {
        let quadrant = _mm_castpd_si128(quadrant);
        let odd = _mm_castsi128_pd(_mm_slli_epi64::<63>(quadrant));
        let sin_sign = _mm_and_pd(_mm_castsi128_pd(_mm_slli_epi64::<62>(quadrant)), k(-0.0));
        let cos_sign = _mm_xor_pd(sin_sign, odd);
        (_mm_xor_pd(select(odd, cos, sin), sin_sign), _mm_xor_pd(select(odd, sin, cos), cos_sign))
    }
}
