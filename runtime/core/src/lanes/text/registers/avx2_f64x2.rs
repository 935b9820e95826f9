// Two f64 in half a register of AVX.
pub(super) type Real = f64;
pub(super) const LANES: usize = 2;
pub(super) type V = ::core::arch::x86_64::__m128d;
pub(super) type M = ::core::arch::x86_64::__m128d;

macro_rules! lane_functions {
    ($($item:item)*) => { $(#[inline] #[target_feature(enable = "avx2,fma")] $item)* };
}

macro_rules! register_functions {
    ($($item:item)*) => { $(#[inline] #[target_feature(enable = "fma")] #[allow(improper_ctypes_definitions)] $item)* };
}

mod instruction {
    pub(super) use ::core::arch::x86_64::{
        _mm_add_pd as add, _mm_sub_pd as sub, _mm_mul_pd as mul, _mm_div_pd as div, _mm_xor_pd as xor, _mm_sqrt_pd as sqrt,
        _mm_fmadd_pd as fmadd, _mm_fmsub_pd as fmsub, _mm_fnmadd_pd as fnmadd, _mm_fnmsub_pd as fnmsub, _mm_set1_pd as k,
    };
}
use ::core::arch::x86_64::{
    _mm_and_pd as and, _mm_andnot_pd as and_not, _mm_blendv_pd as blend, _mm_cmp_pd as compare, _mm_movemask_pd as signs,
    _mm_slli_epi64 as shift, _mm_castpd_si128 as bits, _mm_castsi128_pd as real, _CMP_GT_OQ as GREATER,
    _CMP_LE_OQ as AT_MOST,
};

lane_functions! {
    pub(super) fn reduce_add(x: V) -> V {
        add(x, ::core::arch::x86_64::_mm_permute_pd::<0b01>(x))
    }
}
