
lane_functions! {
    pub(super) fn put_fours(a: V, b: V, c: V, d: V, to: &mut [::core::mem::MaybeUninit<Real>], at: [usize; LANES]) {
        use ::core::arch::x86_64::{_mm256_permute2f128_pd as halves, _mm256_unpackhi_pd as odd, _mm256_unpacklo_pd as even};
        let (ab, cd) = (even(a, b), even(c, d));
        let (ab_odd, cd_odd) = (odd(a, b), odd(c, d));
        put(halves::<0x20>(ab, cd), to, at[0]);
        put(halves::<0x20>(ab_odd, cd_odd), to, at[1]);
        put(halves::<0x31>(ab, cd), to, at[2]);
        put(halves::<0x31>(ab_odd, cd_odd), to, at[3]);
    }

    pub(super) fn put_twos(a: V, b: V, to: &mut [::core::mem::MaybeUninit<Real>], at: [usize; LANES]) {
        use ::core::arch::x86_64::{_mm256_unpackhi_pd as odd, _mm256_unpacklo_pd as even};
        let (even, odd) = (array(even(a, b)), array(odd(a, b)));
        put_two([even[0], even[1]], to, at[0]);
        put_two([odd[0], odd[1]], to, at[1]);
        put_two([even[2], even[3]], to, at[2]);
        put_two([odd[2], odd[3]], to, at[3]);
    }

    pub(super) fn put_in_turn(a: V, b: V, c: V, to: &mut [::core::mem::MaybeUninit<Real>], at: usize) {
        use ::core::arch::x86_64::{
            _mm256_blend_pd as either, _mm256_permute2f128_pd as halves, _mm256_shuffle_pd as pairs, _mm256_unpackhi_pd as odd,
            _mm256_unpacklo_pd as even,
        };
        // a₀b₀a₂b₂, b₁c₁b₃c₃, c₀a₁c₂a₃
        let (ab, bc, ca) = (even(a, b), odd(b, c), pairs::<0b1010>(c, a));
        put(halves::<0x20>(ab, ca), to, at);
        put(either::<0b1100>(bc, ab), to, at + 4);
        put(halves::<0x31>(ca, bc), to, at + 8);
    }

    pub(super) fn every_third(x: &[Real; 12]) -> [V; 3] {
        use ::core::arch::x86_64::{_mm256_blend_pd as either, _mm256_permute2f128_pd as halves, _mm256_shuffle_pd as pairs};
        let [a, b, c] = [lanes([x[0], x[1], x[2], x[3]]), lanes([x[4], x[5], x[6], x[7]]), lanes([x[8], x[9], x[10], x[11]])];
        // 0 1 6 7, 2 3 8 9, 4 5 10 11
        let (ab, ac, bc) = (either::<0b1100>(a, b), halves::<0x21>(a, c), either::<0b1100>(b, c));
        [pairs::<0b1010>(ab, ac), pairs::<0b0101>(ab, bc), pairs::<0b1010>(ac, bc)]
    }

    // The sums of the lanes of each, added up as by `reduce_add`.
    pub(super) fn reduce_add_of_four(a: V, b: V, c: V, d: V) -> V {
        use ::core::arch::x86_64::{
            _mm256_blend_pd as either, _mm256_permute2f128_pd as halves, _mm256_unpackhi_pd as odd, _mm256_unpacklo_pd as even,
        };
        let (ab, cd) = (add(even(a, b), odd(a, b)), add(even(c, d), odd(c, d)));
        add(either::<0b1100>(ab, cd), halves::<0x21>(ab, cd))
    }

    // Those of two, twice.
    pub(super) fn reduce_add_of_two(a: V, b: V) -> V {
        use ::core::arch::x86_64::{_mm256_permute2f128_pd as halves, _mm256_unpackhi_pd as odd, _mm256_unpacklo_pd as even};
        let ab = add(even(a, b), odd(a, b));
        add(ab, halves::<1>(ab, ab))
    }
}
