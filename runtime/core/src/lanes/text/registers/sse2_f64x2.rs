// Two f64 in a register of SSE2.
pub(super) type Real = f64;
pub(super) const LANES: usize = 2;
pub(super) type V = ::core::arch::x86_64::__m128d;
pub(super) type M = ::core::arch::x86_64::__m128d;

macro_rules! lane_functions {
    ($($item:item)*) => { $(#[inline] #[target_feature(enable = "sse2,fxsr")] $item)* };
}

macro_rules! register_functions {
    ($($item:item)*) => { $(#[inline] #[target_feature(enable = "sse2")] #[allow(improper_ctypes_definitions)] $item)* };
}

mod instruction {
    pub(super) use ::core::arch::x86_64::{
        _mm_add_pd as add, _mm_sub_pd as sub, _mm_mul_pd as mul, _mm_div_pd as div, _mm_xor_pd as xor, _mm_sqrt_pd as sqrt,
        _mm_set1_pd as k,
    };
}
use ::core::arch::x86_64::{
    _mm_and_pd as and, _mm_andnot_pd as and_not, _mm_cmpgt_pd as greater, _mm_cmple_pd as at_most, _mm_movemask_pd as signs,
    _mm_or_pd as or, _mm_slli_epi64 as shift, _mm_castpd_si128 as bits, _mm_castsi128_pd as real,
};

lane_functions! {
    pub(super) fn reduce_add(x: V) -> V {
        add(x, ::core::arch::x86_64::_mm_shuffle_pd::<0b01>(x, x))
    }

    // All bits of a lane as its lowest.
    fn lowest(x: V) -> M {
        use ::core::arch::x86_64::*;
        real(_mm_shuffle_epi32::<0b10_10_00_00>(_mm_srai_epi32::<31>(_mm_slli_epi32::<31>(bits(x)))))
    }
}
