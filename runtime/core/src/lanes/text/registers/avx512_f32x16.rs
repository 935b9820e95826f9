// Sixteen f32 in a register of AVX-512.
pub(super) type Real = f32;
pub(super) const LANES: usize = 16;
pub(super) type V = ::core::arch::x86_64::__m512;
pub(super) type M = ::core::arch::x86_64::__mmask16;

macro_rules! lane_functions {
    ($($item:item)*) => { $(#[inline] #[target_feature(enable = "avx512f,avx512dq,avx2,fma")] $item)* };
}

macro_rules! register_functions {
    ($($item:item)*) => { $(#[inline] #[target_feature(enable = "avx512dq")] #[allow(improper_ctypes_definitions)] $item)* };
}

mod instruction {
    pub(super) use ::core::arch::x86_64::{
        _mm512_add_ps as add, _mm512_sub_ps as sub, _mm512_mul_ps as mul, _mm512_div_ps as div, _mm512_xor_ps as xor,
        _mm512_sqrt_ps as sqrt, _mm512_fmadd_ps as fmadd, _mm512_fmsub_ps as fmsub, _mm512_fnmadd_ps as fnmadd,
        _mm512_fnmsub_ps as fnmsub, _mm512_set1_ps as k,
    };
}
use ::core::arch::x86_64::{
    _mm512_abs_ps as abs, _mm512_and_ps as and, _mm512_mask_xor_ps as mask_xor, _mm512_mask_blend_ps as blend,
    _mm512_cmp_ps_mask as compare, _mm512_slli_epi32 as shift, _mm512_set1_epi32 as integer, _mm512_test_epi32_mask as test,
    _mm512_castps_si512 as bits, _mm512_castsi512_ps as real, _CMP_GT_OQ as GREATER, _CMP_NLE_UQ as NOT_AT_MOST,
};
