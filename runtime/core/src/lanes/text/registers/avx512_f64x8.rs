// Eight f64 in a register of AVX-512.
pub(super) type Real = f64;
pub(super) const LANES: usize = 8;
pub(super) type V = ::core::arch::x86_64::__m512d;
pub(super) type M = ::core::arch::x86_64::__mmask8;

macro_rules! lane_functions {
    ($($item:item)*) => { $(#[inline] #[target_feature(enable = "avx512f,avx512dq,avx2,fma")] $item)* };
}

macro_rules! register_functions {
    ($($item:item)*) => { $(#[inline] #[target_feature(enable = "avx512dq")] #[allow(improper_ctypes_definitions)] $item)* };
}

mod instruction {
    pub(super) use ::core::arch::x86_64::{
        _mm512_add_pd as add, _mm512_sub_pd as sub, _mm512_mul_pd as mul, _mm512_div_pd as div, _mm512_xor_pd as xor,
        _mm512_sqrt_pd as sqrt, _mm512_fmadd_pd as fmadd, _mm512_fmsub_pd as fmsub, _mm512_fnmadd_pd as fnmadd,
        _mm512_fnmsub_pd as fnmsub, _mm512_set1_pd as k,
    };
}
use ::core::arch::x86_64::{
    _mm512_abs_pd as abs, _mm512_and_pd as and, _mm512_mask_xor_pd as mask_xor, _mm512_mask_blend_pd as blend,
    _mm512_cmp_pd_mask as compare, _mm512_slli_epi64 as shift, _mm512_set1_epi64 as integer, _mm512_test_epi64_mask as test,
    _mm512_castpd_si512 as bits, _mm512_castsi512_pd as real, _CMP_GT_OQ as GREATER, _CMP_NLE_UQ as NOT_AT_MOST,
};
