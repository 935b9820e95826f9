// Two f64 in a register of NEON.
pub(super) type Real = f64;
pub(super) const LANES: usize = 2;
pub(super) type V = ::core::arch::aarch64::float64x2_t;
pub(super) type M = ::core::arch::aarch64::uint64x2_t;

macro_rules! lane_functions {
    ($($item:item)*) => { $(#[inline] #[target_feature(enable = "neon")] $item)* };
}

pub(super) use ::core::arch::aarch64::{
    vaddq_f64 as add, vsubq_f64 as sub, vmulq_f64 as mul, vdivq_f64 as div, vnegq_f64 as neg, vsqrtq_f64 as sqrt, vdupq_n_f64 as k,
};
use ::core::arch::aarch64::{
    vbslq_f64 as choose, vcaleq_f64 as at_most, vcgtzq_f64 as greater_than_0, vfmaq_f64 as fma, vfmsq_f64 as fms, vandq_u64 as and,
    vdupq_n_u64 as integer, veorq_u64 as xor, vshlq_n_u64 as shift, vtstq_u64 as test, vreinterpretq_u64_f64 as bits,
    vreinterpretq_f64_u64 as real, vminvq_u32 as least,
};

lane_functions! {
    pub(super) fn reduce_add(x: V) -> V {
        ::core::arch::aarch64::vpaddq_f64(x, x)
    }

    fn all(m: M) -> bool {
        least(::core::arch::aarch64::vreinterpretq_u32_u64(m)) != 0
    }
}
