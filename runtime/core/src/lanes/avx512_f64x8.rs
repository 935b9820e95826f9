// Eight f64 in a register of AVX-512.
pub(super) type Real = f64;
pub(super) const LANES: usize = 8;
pub(super) type V = ::core::arch::x86_64::__m512d;
pub(super) type M = ::core::arch::x86_64::__mmask8;

macro_rules! functions {
    ($($item:item)*) => { $(#[inline] #[target_feature(enable = "avx512f,avx512dq,avx2,fma")] $item)* };
}

use ::core::arch::x86_64::*;
pub(super) use ::core::arch::x86_64::{
    _mm512_add_pd as add, _mm512_div_pd as div, _mm512_fmadd_pd as fmadd, _mm512_fmsub_pd as fmsub, _mm512_fnmadd_pd as fnmadd,
    _mm512_fnmsub_pd as fnmsub, _mm512_mul_pd as mul, _mm512_set1_pd as k, _mm512_sqrt_pd as sqrt, _mm512_sub_pd as sub,
};

functions! {
    pub(super) fn neg(x: V) -> V {
        _mm512_xor_pd(x, k(-0.0))
    }

    pub(super) fn positive(x: V) -> M {
        _mm512_cmp_pd_mask::<_CMP_GT_OQ>(x, k(0.0))
    }

    pub(super) fn select(m: M, a: V, b: V) -> V {
        _mm512_mask_blend_pd(m, b, a)
    }

    fn within(x: V, limit: V) -> bool {
        _mm512_cmp_pd_mask::<_CMP_NLE_UQ>(_mm512_abs_pd(x), limit) == 0
    }

    fn turn(quadrant: V, sin: V, cos: V) -> (V, V) {
        let quadrant = _mm512_castpd_si512(quadrant);
        let odd = _mm512_test_epi64_mask(quadrant, _mm512_set1_epi64(1));
        let sign = _mm512_and_pd(_mm512_castsi512_pd(_mm512_slli_epi64::<62>(quadrant)), k(-0.0));
        let (s, c) = (select(odd, cos, sin), _mm512_mask_xor_pd(cos, odd, sin, k(-0.0)));
        (_mm512_xor_pd(s, sign), _mm512_xor_pd(c, sign))
    }
}
