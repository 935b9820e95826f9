// Eight f32 in a register of AVX.
pub(super) type Real = f32;
pub(super) const LANES: usize = 8;
pub(super) type V = ::core::arch::x86_64::__m256;
pub(super) type M = ::core::arch::x86_64::__m256;

macro_rules! lane_functions {
    ($($item:item)*) => { $(#[inline] #[target_feature(enable = "avx2,fma")] $item)* };
}

macro_rules! register_functions {
    ($($item:item)*) => { $(#[inline] #[target_feature(enable = "fma")] #[allow(improper_ctypes_definitions)] $item)* };
}

mod instruction {
    pub(super) use ::core::arch::x86_64::{
        _mm256_add_ps as add, _mm256_sub_ps as sub, _mm256_mul_ps as mul, _mm256_div_ps as div, _mm256_xor_ps as xor,
        _mm256_sqrt_ps as sqrt, _mm256_fmadd_ps as fmadd, _mm256_fmsub_ps as fmsub, _mm256_fnmadd_ps as fnmadd,
        _mm256_fnmsub_ps as fnmsub, _mm256_set1_ps as k,
    };
}
use ::core::arch::x86_64::{
    _mm256_and_ps as and, _mm256_andnot_ps as and_not, _mm256_blendv_ps as blend, _mm256_cmp_ps as compare, _mm256_movemask_ps as signs,
    _mm256_slli_epi32 as shift, _mm256_castps_si256 as bits, _mm256_castsi256_ps as real, _CMP_GT_OQ as GREATER,
    _CMP_LE_OQ as AT_MOST,
};
