
use ::core::arch::x86_64::{__m128d as Register, _mm_unpackhi_pd as high, _mm_unpacklo_pd as low};
