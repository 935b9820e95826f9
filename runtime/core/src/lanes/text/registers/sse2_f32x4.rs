// Four f32 in a register of SSE2.
pub(super) type Real = f32;
pub(super) const LANES: usize = 4;
pub(super) type V = ::core::arch::x86_64::__m128;
pub(super) type M = ::core::arch::x86_64::__m128;

macro_rules! lane_functions {
    ($($item:item)*) => { $(#[inline] #[target_feature(enable = "sse2,fxsr")] $item)* };
}

macro_rules! register_functions {
    ($($item:item)*) => { $(#[inline] #[target_feature(enable = "sse2")] #[allow(improper_ctypes_definitions)] $item)* };
}

mod instruction {
    pub(super) use ::core::arch::x86_64::{
        _mm_add_ps as add, _mm_sub_ps as sub, _mm_mul_ps as mul, _mm_div_ps as div, _mm_xor_ps as xor, _mm_sqrt_ps as sqrt,
        _mm_set1_ps as k,
    };
}
use ::core::arch::x86_64::{
    _mm_and_ps as and, _mm_andnot_ps as and_not, _mm_cmpgt_ps as greater, _mm_cmple_ps as at_most, _mm_movemask_ps as signs,
    _mm_or_ps as or, _mm_slli_epi32 as shift, _mm_castps_si128 as bits, _mm_castsi128_ps as real,
};

lane_functions! {
    // All bits of a lane as its lowest.
    fn lowest(x: V) -> M {
        real(::core::arch::x86_64::_mm_srai_epi32::<31>(shift::<31>(bits(x))))
    }

    // See `split`.
    fn reduce(x: V) -> (V, V, V) {
        use ::core::arch::x86_64::*;
        let (n, hi, lo) = reduce_half(x);
        let (m, hj, lp) = reduce_half(_mm_movehl_ps(x, x));
        (_mm_shuffle_ps::<0b10_00_10_00>(n, m), _mm_movelh_ps(hi, hj), _mm_movelh_ps(lo, lp))
    }

    // The two lower lanes.
    fn reduce_half(x: V) -> (V, V, V) {
        use ::core::arch::x86_64::*;
        let (x, round) = (_mm_cvtps_pd(x), _mm_set1_pd(REDUCTION_ROUND));
        let rounded = _mm_add_pd(_mm_mul_pd(x, _mm_set1_pd(::core::f64::consts::FRAC_2_PI)), round);
        let n = _mm_sub_pd(rounded, round);
        let r = _mm_sub_pd(x, _mm_mul_pd(n, _mm_set1_pd(REDUCTION[0])));
        let r = _mm_sub_pd(r, _mm_mul_pd(n, _mm_set1_pd(REDUCTION[1])));
        let hi = _mm_cvtpd_ps(r);
        (_mm_castpd_ps(rounded), hi, _mm_cvtpd_ps(_mm_sub_pd(r, _mm_cvtps_pd(hi))))
    }
}
