//! The texts, compiled as they stand in generated code.

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
    for level in Level::all() {
        assert_eq!(level.to_string().parse(), Ok(level));
        assert!(!level.contract().is_empty());
    }
    assert_eq!(Level::all().len(), 13);
    assert_eq!("f64".parse(), Ok(Level::default()));
    for wrong in ["f16", "f64+fast", "f64+two", "double_double+correct", "", "f64+"] {
        assert!(wrong.parse::<Level>().is_err(), "{wrong}");
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
