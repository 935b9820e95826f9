
use ::core::arch::x86_64::{
    __m128 as Half, __m256 as Register, _mm256_castps128_ps256 as widened, _mm256_castps256_ps128 as lower, _mm256_extractf128_ps as upper,
    _mm256_insertf128_ps as with_upper, _mm256_permute2f128_ps as halves, _mm256_unpackhi_ps as high, _mm256_unpacklo_ps as low,
};

lane_functions! {
    fn low_pairs(a: Register, b: Register) -> Register {
        ::core::arch::x86_64::_mm256_shuffle_ps::<0b01_00_01_00>(a, b)
    }

    fn high_pairs(a: Register, b: Register) -> Register {
        ::core::arch::x86_64::_mm256_shuffle_ps::<0b11_10_11_10>(a, b)
    }

    // Rows and columns of eight times eight numbers exchanged.
    fn exchanged([a, b, c, d, e, f, g, h]: &[[Real; 8]; 8]) -> [[Real; 8]; 8] {
        let [a, b, c, d] = turned([register(*a), register(*b), register(*c), register(*d)]);
        let [e, f, g, h] = turned([register(*e), register(*f), register(*g), register(*h)]);
        [
            flat(halves::<0x20>(a, e)), flat(halves::<0x20>(b, f)), flat(halves::<0x20>(c, g)), flat(halves::<0x20>(d, h)),
            flat(halves::<0x31>(a, e)), flat(halves::<0x31>(b, f)), flat(halves::<0x31>(c, g)), flat(halves::<0x31>(d, h)),
        ]
    }
}
