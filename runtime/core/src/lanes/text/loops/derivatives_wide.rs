
/// What differs between processors, in vectors of eight: for those with AVX-512 whose clock does not slow down for it (Ice Lake and Zen 4, and what came after), if the code is compiled for one.
#[cfg(all(target_arch = "x86_64", target_feature = "avx512vl", target_feature = "avx512vbmi2"))]
mod wide {
    use super::*;
    use ::core::arch::x86_64::{
        __m256d, _mm256_loadu_pd as load_four, _mm256_mask_storeu_pd as store_some, _mm512_add_pd as add, _mm512_broadcast_f64x4 as twice,
        _mm512_castpd256_pd512 as below, _mm512_castpd512_pd256 as lower, _mm512_extractf64x4_pd as upper, _mm512_fmadd_pd as fmadd,
        _mm512_fmsub_pd as fmsub, _mm512_fnmadd_pd as fnmadd, _mm512_loadu_pd as load_eight, _mm512_mask_set1_epi64 as spread_some,
        _mm512_mul_pd as mul, _mm512_permutex2var_pd as permute_two, _mm512_permutexvar_pd as permute, _mm512_set1_epi64 as spread,
        _mm512_set1_pd as k, _mm512_setr_epi64 as indices, _mm512_storeu_pd as store_eight, _mm512_sub_pd as sub,
        _mm512_unpackhi_pd as odd, _mm512_unpacklo_pd as even,
    };

    type V = ::core::arch::x86_64::__m512d;

    /// Two joints at a time, four lanes each.
    const OWN: usize = 2;

    vectors!(#[target_feature(enable = "avx512vl,avx2,fma")]);
    pairings!(#[target_feature(enable = "avx512vl,avx2,fma")]);

    /// Rows of joints with themselves and with those before them, and with those beyond them. Pairs of the same two follow one another, and what these bring along stays in registers.
    #[target_feature(enable = "avx512vl,avx2,fma")]
    #[inline(never)]
    fn pairs(bodies: &Bodies, out: &mut [f64; 3 * MATRIX]) {
        for some in BEFORE.chunk_by(same_two) {
            let own = acting(bodies, &some[0], &some[0].own);
            for pair in some {
                before(bodies, pair, &pair.own, own, out);
            }
        }
        for some in BEYOND.chunk_by(same_two) {
            let own = moving(bodies, &some[0], &some[0].own);
            for pair in some {
                beyond(bodies, pair, &pair.own, own, out);
            }
        }
    }

    #[inline]
    fn same_two(one: &Pair, other: &Pair) -> bool {
        (one.at, one.own[0].lane, one.own[1].lane) == (other.at, other.own[0].lane, other.own[1].lane)
    }

    /// Four numbers for both joints.
    #[target_feature(enable = "avx512vl,avx2,fma")]
    #[inline]
    fn load(from: &Four) -> V {
        // SAFETY: four numbers are read.
        twice(unsafe { load_four(from.as_ptr()) })
    }

    /// Each joint's number in its four lanes.
    #[target_feature(enable = "avx512vl,avx2,fma")]
    #[inline]
    fn each(x: &Held, own: &[Own; OWN]) -> V {
        let lanes = spread_some(spread(own[0].lane as i64), 0xf0, own[1].lane as i64);
        // SAFETY: four numbers are read.
        permute(lanes, below(unsafe { load_four(x.numbers().as_ptr()) }))
    }

    /// Two joints whose rows lie inside a matrix. To look at that before each store instead of once for three takes a twentieth of all.
    #[derive(::core::clone::Clone, ::core::marker::Copy)]
    struct Rows<'a>(&'a [Own; OWN]);

    #[inline]
    fn rows(own: &[Own; OWN]) -> Rows<'_> {
        let [one, other] = own;
        ::core::assert!(lies_in(MATRIX, one.place as usize, one.which) && lies_in(MATRIX, other.place as usize, other.which));
        Rows(own)
    }

    /// The joints' rows, into one of the matrices.
    #[target_feature(enable = "avx512vl,avx2,fma")]
    #[inline]
    fn put(x: V, Rows([one, other]): Rows<'_>, out: &mut [f64; 3 * MATRIX], matrix: usize) {
        let to = out[matrix * MATRIX..][..MATRIX].as_mut_ptr();
        // SAFETY: lanes that are not asked for are not written, wherever they are; those that are lie inside a matrix, and this is one.
        unsafe {
            store_some(to.wrapping_add(one.place as usize), one.which as u8, lower(x));
            store_some(to.wrapping_add(other.place as usize), other.which as u8, upper::<1>(x));
        }
    }

    #[target_feature(enable = "avx512vl,avx2,fma")]
    #[inline]
    fn mix_four(x: __m256d, which: u16, out: &mut [f64; 3 * MATRIX], place: usize) {
        ::core::assert!(lies_in(3 * MATRIX, place, which));
        // SAFETY: lanes that are not asked for are not written, wherever they are; those that are lie inside, as was just asserted.
        unsafe { store_some(out.as_mut_ptr().wrapping_add(place), which as u8, x) }
    }

    #[target_feature(enable = "avx512vl,avx2,fma")]
    #[inline]
    fn turn_pairs(tile: [&mut [Held]; 4]) {
        let [a, b, c, d] = tile.map(|x| x.as_chunks_mut::<2>().0);
        let (low, high) = (indices(0, 1, 8, 9, 4, 5, 12, 13), indices(2, 3, 10, 11, 6, 7, 14, 15));
        for (((a, b), c), d) in a.iter_mut().zip(b).zip(c).zip(d) {
            // SAFETY: eight numbers are read of each, and all have been written: see `numbers`.
            let x = unsafe { [&*a, &*b, &*c, &*d].map(|x| load_eight(x.as_ptr().cast())) };
            let (first, second) = ([even(x[0], x[1]), odd(x[0], x[1])], [even(x[2], x[3]), odd(x[2], x[3])]);
            // SAFETY: eight numbers are written of each.
            unsafe {
                store_eight(a.as_mut_ptr().cast(), permute_two(first[0], low, second[0]));
                store_eight(b.as_mut_ptr().cast(), permute_two(first[1], low, second[1]));
                store_eight(c.as_mut_ptr().cast(), permute_two(first[0], high, second[0]));
                store_eight(d.as_mut_ptr().cast(), permute_two(first[1], high, second[1]));
            }
        }
    }

    /// The lanes asked for, into the matrices.
    #[inline(always)]
    pub(super) fn mix(x: __m256d, which: u16, out: &mut [f64; 3 * MATRIX], place: usize) {
        // SAFETY: this is compiled for processors with all of it.
        unsafe { mix_four(x, which, out, place) }
    }

    /// The same numbers of four groups, turned; of each an even number.
    #[inline(always)]
    pub(super) fn turn_each(tile: [&mut [Held]; 4]) {
        // SAFETY: as above.
        unsafe { turn_pairs(tile) }
    }

    /// Rows of joints with themselves and with those before them, and with those beyond them.
    #[inline(always)]
    pub(super) fn all_pairs(bodies: &Bodies, out: &mut [f64; 3 * MATRIX]) {
        // SAFETY: as above.
        unsafe { pairs(bodies, out) }
    }
}
