// Four f32 in a register of NEON.
pub(super) type Real = f32;
pub(super) const LANES: usize = 4;
pub(super) type V = ::core::arch::aarch64::float32x4_t;
pub(super) type M = ::core::arch::aarch64::uint32x4_t;

macro_rules! lane_functions {
    ($($item:item)*) => { $(#[inline] #[target_feature(enable = "neon")] $item)* };
}

pub(super) use ::core::arch::aarch64::{
    vaddq_f32 as add, vsubq_f32 as sub, vmulq_f32 as mul, vdivq_f32 as div, vnegq_f32 as neg, vsqrtq_f32 as sqrt,
};
use ::core::arch::aarch64::{
    vbslq_f32 as choose, vcaleq_f32 as at_most, vcgtzq_f32 as greater_than_0, vfmaq_f32 as fma, vfmsq_f32 as fms, vandq_u32 as and,
    vdupq_n_u32 as integer, veorq_u32 as xor, vshlq_n_u32 as shift, vtstq_u32 as test, vreinterpretq_u32_f32 as bits,
    vreinterpretq_f32_u32 as real, vminvq_u32 as least,
};

lane_functions! {
    pub(super) fn k(x: f64) -> V {
        ::core::arch::aarch64::vdupq_n_f32(x as f32)
    }
}

lane_functions! {
    fn all(m: M) -> bool {
        least(m) != 0
    }
}
