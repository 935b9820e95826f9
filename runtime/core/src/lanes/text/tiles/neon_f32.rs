
use ::core::arch::aarch64::{float32x4_t as Register, vzip1q_f32 as low, vzip2q_f32 as high};

lane_functions! {
    fn low_pairs(a: Register, b: Register) -> Register {
        use ::core::arch::aarch64::*;
        vcombine_f32(vget_low_f32(a), vget_low_f32(b))
    }

    fn high_pairs(a: Register, b: Register) -> Register {
        use ::core::arch::aarch64::*;
        vcombine_f32(vget_high_f32(a), vget_high_f32(b))
    }
}
