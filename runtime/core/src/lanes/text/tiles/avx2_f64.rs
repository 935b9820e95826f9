
use ::core::arch::x86_64::{
    __m128d as Half, __m256d as Register, _mm256_castpd128_pd256 as widened, _mm256_castpd256_pd128 as lower, _mm256_extractf128_pd as upper,
    _mm256_insertf128_pd as with_upper, _mm256_permute2f128_pd as halves, _mm256_unpackhi_pd as high, _mm256_unpacklo_pd as low,
};

lane_functions! {
    // Rows and columns of four times four numbers exchanged.
    fn exchanged([a, b, c, d]: &[[Real; 4]; 4]) -> [[Real; 4]; 4] {
        let (a, b, c, d) = (register(*a), register(*b), register(*c), register(*d));
        let (ab, cd, ef, gh) = (low(a, b), low(c, d), high(a, b), high(c, d));
        [flat(halves::<0x20>(ab, cd)), flat(halves::<0x20>(ef, gh)), flat(halves::<0x31>(ab, cd)), flat(halves::<0x31>(ef, gh))]
    }
}
