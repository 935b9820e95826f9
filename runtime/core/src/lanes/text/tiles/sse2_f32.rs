
use ::core::arch::x86_64::{__m128 as Register, _mm_movelh_ps as low_pairs, _mm_unpackhi_ps as high, _mm_unpacklo_ps as low};

lane_functions! {
    fn high_pairs(a: Register, b: Register) -> Register {
        ::core::arch::x86_64::_mm_movehl_ps(b, a)
    }
}
