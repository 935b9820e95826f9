// Four f64 in a register of AVX.
pub(super) type Real = f64;
pub(super) const LANES: usize = 4;
pub(super) type V = ::core::arch::x86_64::__m256d;
pub(super) type M = ::core::arch::x86_64::__m256d;

macro_rules! lane_functions {
    ($($item:item)*) => { $(#[inline] #[target_feature(enable = "avx2,fma")] $item)* };
}

macro_rules! four_functions {
    ($($item:item)*) => { $(#[inline] #[target_feature(enable = "avx2,fma")] $item)* };
}

macro_rules! register_functions {
    ($($item:item)*) => { $(#[inline] #[target_feature(enable = "fma")] #[allow(improper_ctypes_definitions)] $item)* };
}

mod instruction {
    pub(super) use ::core::arch::x86_64::{
        _mm256_add_pd as add, _mm256_sub_pd as sub, _mm256_mul_pd as mul, _mm256_div_pd as div, _mm256_xor_pd as xor,
        _mm256_sqrt_pd as sqrt, _mm256_fmadd_pd as fmadd, _mm256_fmsub_pd as fmsub, _mm256_fnmadd_pd as fnmadd,
        _mm256_fnmsub_pd as fnmsub, _mm256_set1_pd as k,
    };
}
use ::core::arch::x86_64::{
    _mm256_and_pd as and, _mm256_andnot_pd as and_not, _mm256_blendv_pd as blend, _mm256_cmp_pd as compare, _mm256_movemask_pd as signs,
    _mm256_slli_epi64 as shift, _mm256_castpd_si256 as bits, _mm256_castsi256_pd as real, _CMP_GT_OQ as GREATER,
    _CMP_LE_OQ as AT_MOST,
};

lane_functions! {
    pub(super) fn reduce_add(x: V) -> V {
        let pairs = add(x, ::core::arch::x86_64::_mm256_permute_pd::<0b0101>(x));
        add(pairs, ::core::arch::x86_64::_mm256_permute2f128_pd::<1>(pairs, pairs))
    }
}
