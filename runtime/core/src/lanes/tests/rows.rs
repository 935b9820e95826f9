//! Vectors of four f64 written and read number by number.

use core::mem::MaybeUninit;

use super::available;
use crate::lanes::Set;

/// The value of a test at places where nothing is written.
const NOTHING: f64 = -1.0;

/// Results of some stores, in memory for 24 numbers.
#[allow(unsafe_code)]
fn room(write: impl FnOnce(&mut [MaybeUninit<f64>])) -> Vec<f64> {
    let mut room = [MaybeUninit::new(NOTHING); 24];
    write(&mut room);
    // SAFETY: all of it held numbers before.
    room.iter().map(|x| unsafe { x.assume_init() }).collect()
}

/// Numbers at their places, and nothing elsewhere.
fn at(places: &[(usize, &[f64])]) -> Vec<f64> {
    let mut room = vec![NOTHING; 24];
    places.iter().for_each(|(at, numbers)| room[*at..at + numbers.len()].copy_from_slice(numbers));
    room
}

macro_rules! rows {
    ($module:ident, $set:ident $(, #[$attribute:meta])?) => {
        #[allow(unsafe_code, unused_unsafe)]
        {
            use super::super::$module as set;
            $(#[$attribute])?
            fn rows() {
                let lanes = |first: f64| core::array::from_fn(|lane| first + lane as f64);
                let [a, b, c, d]: [[f64; 4]; 4] = [lanes(10.0), lanes(20.0), lanes(30.0), lanes(40.0)];
                let [va, vb, vc, vd] = [set::lanes(a), set::lanes(b), set::lanes(c), set::lanes(d)];
                assert_eq!(room(|to| set::put_one(a[2], to, 5)), at(&[(5, &[12.0])]));
                assert_eq!(room(|to| set::put_two([a[2], b[0]], to, 5)), at(&[(5, &[12.0, 20.0])]));
                assert_eq!(room(|to| set::put(va, to, 20)), at(&[(20, &a)]));
                let row = |lane: usize| [a[lane], b[lane], c[lane], d[lane]];
                let fours = [(20, &row(0)[..]), (0, &row(1)), (5, &row(2)), (13, &row(3))];
                assert_eq!(room(|to| set::put_fours(va, vb, vc, vd, to, fours.map(|(at, _)| at))), at(&fours));
                let twos = fours.map(|(at, row)| (at, &row[..2]));
                assert_eq!(room(|to| set::put_twos(va, vb, to, twos.map(|(at, _)| at))), at(&twos));
                let turns: Vec<f64> = (0..4).flat_map(|lane| [a[lane], b[lane], c[lane]]).collect();
                assert_eq!(room(|to| set::put_in_turn(va, vb, vc, to, 7)), at(&[(7, &turns)]));
                let turns: [f64; 12] = turns.try_into().unwrap_or_default();
                assert_eq!(set::every_third(&turns).map(|x| set::array(x)), [a, b, c]);
                // Numbers that are not whole, whose sums depend on the order.
                let [a, b, c, d] = [a, b, c, d].map(|x| x.map(|x| 1.0 / x));
                let [va, vb, vc, vd] = [set::lanes(a), set::lanes(b), set::lanes(c), set::lanes(d)];
                let [x, y, z, w] = [va, vb, vc, vd].map(|x| set::array(set::reduce_add(x))[0]);
                assert_eq!(set::array(set::reduce_add_of_four(va, vb, vc, vd)), [x, y, z, w]);
                assert_eq!(set::array(set::reduce_add_of_two(va, vb)), [x, y, x, y]);
            }
            if available(Set::$set) {
                // SAFETY: the processor has the features, as the line above found.
                unsafe { rows() }
            }
        }
    };
}

#[test]
fn each_lane_s_numbers_stand_where_they_were_put() {
    rows!(portable_f64x4, Portable);
    #[cfg(target_arch = "x86_64")]
    {
        rows!(sse2_f64x4, Sse2, #[target_feature(enable = "sse2,fxsr")]);
        rows!(avx2_f64x4, Avx2, #[target_feature(enable = "avx2,fma")]);
    }
    #[cfg(target_arch = "aarch64")]
    rows!(neon_f64x4, Neon, #[target_feature(enable = "neon")]);
}
