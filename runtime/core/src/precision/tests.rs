//! The texts, compiled as in generated code.

use super::*;

macro_rules! compiled {
    ($($name:ident [$($file:literal)+])+) => {
        $(
            #[allow(dead_code, unreachable_pub, clippy::all, clippy::pedantic)]
            pub(super) mod $name {
                $(include!(concat!("text/", $file, ".rs"));)+
            }
        )+
    };
}

compiled! {
    double_double ["exact" "both" "double_double" "sines" "whole"]
    pair ["exact" "both" "pair" "pair_of_double"]
    pair_correct ["exact" "both" "pair" "pair_of_double" "sines" "whole" "correct"]
    pair_of_two ["exact" "both" "pair" "pair_of_two" "sines" "whole"]
    correct ["exact" "sines" "whole" "correct"]
}

#[test]
fn levels_are_read_as_they_are_written() {
    for level in Precision::all() {
        assert_eq!(level.to_string().parse(), Ok(level));
        assert!(!level.contract().is_empty());
    }
    assert_eq!(Precision::all().len(), 13);
    assert_eq!("f64".parse(), Ok(Precision::default()));
    for wrong in [
        "f16",
        "f64+fast",
        "f64+two",
        "double_double+correct",
        "",
        "f64+",
        "f64+fast_7+fast_10",
        "f64+correct+correct",
        "f64+no_fma+no_fma",
    ] {
        assert!(wrong.parse::<Precision>().is_err(), "{wrong}");
    }
}

#[test]
fn multiplication_loses_less_than_its_bound_without_the_instruction_too() {
    use double_double::{mul, sub};
    let (a, b) = ((1.0 / 3.0, 1.850_371_707_708_594e-17), (3.0, 0.0));
    for product in [mul::<true>(a, b), mul::<false>(a, b)] {
        let rest = sub::<true>(product, (1.0, 0.0));
        assert!(rest.0.abs() < 2e-32, "{rest:?}");
    }
}

#[test]
fn the_sines_of_whole_numbers_are_those_of_two_doubles() {
    let mut x = 1e-8_f64;
    while x < 1e300 {
        for x in [x, -x] {
            let (s, c) = correct::sin_cos_correct::<true>(x);
            assert_eq!((s, c), correct::sin_cos_correct::<false>(x), "{x:e}");
            assert_eq!((s, c), correct::sines_in_whole_numbers(x), "{x:e}");
        }
        x *= 1.37;
    }
    assert_eq!(correct::sin_cos_correct::<false>(-0.0).0.to_bits(), (-0.0_f64).to_bits());
    assert!(correct::sin_cos_correct::<false>(f64::INFINITY).0.is_nan());
    assert!(correct::sin_cos_correct::<false>(f64::NAN).1.is_nan());
    // 10²², a classic: −0.8522008497671888017727…
    assert_eq!(correct::sin_cos_correct::<false>(1e22).0, -0.852_200_849_767_188_8);
}

/// Pairs of all signs and sizes, each with a second part below half a unit of the first: multiples
/// of the golden section, modulo 1.
fn pairs() -> impl Iterator<Item = [(f64, f64); 2]> {
    let part = |k: f64| (0.618_033_988_749_895 * k) % 1.0 - 0.5;
    (1..400).map(move |k| {
        let at = |n: f64| {
            let high = part(n) * if k % 3 == 0 { 1e3 } else { 1.0 };
            (high, high * part(n + 0.5) * f64::EPSILON * 0.9)
        };
        [at(f64::from(k)), at(f64::from(7 * k) + 0.37)]
    })
}

/// How far two pairs are apart.
fn apart(a: (f64, f64), b: (f64, f64)) -> f64 {
    ((a.0 - b.0) + (a.1 - b.1)).abs()
}

#[test]
fn quotients_and_roots_of_two_doubles_are_undone_by_products() {
    use double_double::{add, div, mul, sqrt, sub};
    const U2: f64 = 1.3e-32;
    for [a, b] in pairs() {
        for sum in [add::<true>(a, b), add::<false>(a, b)] {
            assert!(apart(sub::<true>(sum, b), a) <= 8.0 * U2 * (a.0.abs() + b.0.abs()), "{a:?} {b:?}");
            // Exact in whole numbers, of which each has more than 53 bits.
            let whole = |x: (f64, f64)| (x.0 * 2f64.powi(100)) as i128 + (x.1 * 2f64.powi(100)) as i128;
            let off = (whole(sum) - whole(a) - whole(b)).unsigned_abs() as f64 * 2f64.powi(-100);
            assert!(off <= 4.0 * U2 * (a.0.abs() + b.0.abs()) + 4.0 * 2f64.powi(-100), "{a:?} {b:?} {off:e}");
        }
        for quotient in [div::<true>(a, b), div::<false>(a, b)] {
            assert!(apart(mul::<true>(quotient, b), a) <= 20.0 * U2 * a.0.abs(), "{a:?} {b:?}");
        }
        let square = mul::<true>(a, a);
        for root in [sqrt::<true>(square), sqrt::<false>(square)] {
            assert!(apart(root, if a.0 < 0.0 { (-a.0, -a.1) } else { a }) <= 16.0 * U2 * a.0.abs(), "{a:?}");
        }
    }
}

/// An angle is that of its cosine and sine, all the way round and whatever the length.
#[test]
fn angles_of_two_doubles_undo_sines() {
    use double_double::{atan2, mul, sin_cos};
    for [a, b] in pairs() {
        let angle = mul::<true>((a.0 % 0.5, a.1), (6.0, 0.0));
        let (s, c) = sin_cos::<true>(angle);
        for length in [(1.0, 0.0), (b.0.abs(), if b.0 < 0.0 { -b.1 } else { b.1 }), (1e-250, 0.0), (1e290, 0.0)] {
            let [y, x] = [s, c].map(|part| mul::<true>(part, length));
            for found in [atan2::<true>(y, x), atan2::<false>(y, x)] {
                assert!(apart(found, angle) <= 4e-30 * angle.0.abs().max(1e-3), "{angle:?} {length:?} {found:?}");
            }
        }
    }
}

/// The loss of the pair without normalisation is of second order: it agrees with the other.
#[test]
fn pairs_carry_what_was_lost_to_first_order() {
    for [a, b] in pairs() {
        let near = |found: (f64, f64), exact: (f64, f64)| {
            assert!(apart(found, exact) <= 2e-31 * exact.0.abs(), "{a:?} {b:?}: {found:?} {exact:?}");
        };
        near(pair::mul::<true>(a, b), double_double::mul::<true>(a, b));
        near(pair::mul::<false>(a, b), double_double::mul::<false>(a, b));
        near(pair::div::<true>(a, b), double_double::div::<true>(a, b));
        near(pair::div::<false>(a, b), double_double::div::<false>(a, b));
        let positive = if a.0 < 0.0 { (-a.0, -a.1) } else { a };
        near(pair::sqrt::<true>(positive), double_double::sqrt::<true>(positive));
        // The angle itself is the standard library's; the lost part rotates it, here enough to be
        // visible.
        let (y, x) = ((a.0, 1e-9), (b.0, -2e-9));
        let (angle, lost) = pair::atan2::<true>(y, x);
        let size = (a.0 * a.0 + b.0 * b.0).sqrt();
        let expected = (y.0 + y.1).atan2(x.0 + x.1);
        assert!(
            lost.abs() < 3e-9 / size && (angle + lost - expected).abs() <= 1e-15 + 1e-17 / (size * size),
            "{y:?} {x:?}: {angle} {lost} {expected}"
        );
    }
}
