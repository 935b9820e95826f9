//! Sines and cosines of the levels against 96 digits.

use articulated_core::Scalar;
use articulated_reference::Big;
use articulated_tests::random::Random;

macro_rules! texts {
    ($name:ident: $($file:literal)+) => {
        #[allow(dead_code, non_upper_case_globals, unreachable_pub, unused_imports, unused_macros, clippy::all, clippy::pedantic)]
        mod $name {
            $(include!(concat!("../../../runtime/core/src/", $file, ".rs"));)+
        }
    };
}

texts!(two: "precision/text/exact" "precision/text/both" "precision/text/pair" "precision/text/pair_of_two" "precision/text/sines" "precision/text/whole" "precision/text/correct");
texts!(fast_7: "lanes/text/portable/f64" "lanes/text/portable/4" "lanes/text/portable/common" "lanes/text/common" "lanes/text/sines/f64" "lanes/text/sines/f64_fast_7");
texts!(fast_10: "lanes/text/portable/f64" "lanes/text/portable/4" "lanes/text/portable/common" "lanes/text/common" "lanes/text/sines/f64" "lanes/text/sines/f64_fast_10");
texts!(ulp: "lanes/text/portable/f64" "lanes/text/portable/4" "lanes/text/portable/common" "lanes/text/common" "lanes/text/sines/f64" "lanes/text/sines/f64_fused" "lanes/text/sines/f64_split");

/// Doubles that lie nearest to a multiple of π/2: below 10⁵ (found by trying every multiple), of
/// all (6381956970095103·2⁷⁹⁷, Muller, Elementary Functions, 2016, 11.3), singles that do
/// ([`WORST_SINGLES`]), and others at the ends of ranges.
fn worst() -> Vec<f64> {
    let known = [45.553093477052, 91.106186954104, 182.212373908208, 364.424747816416, 728.849495632832, 1457.698991265664];
    let muller = 6381956970095103.0 * 2.0_f64.powi(797);
    let ends =
        [1e5, 1e6, 1e15, 1e22, f64::MAX, 5.319_372_648_326_541e255, 3.725_290_298_461_914e-9, 7.450_580_596_923_828e-9, 1e-300, 5e-324];
    let quarters = (1..40).map(|k| f64::from(k) * std::f64::consts::FRAC_PI_4);
    let all = known.into_iter().chain([muller]).chain(WORST_SINGLES.map(f64::from)).chain(ends).chain(quarters);
    all.flat_map(|x| [x.next_down(), x, x.next_up()]).filter(|x| x.is_finite()).flat_map(|x| [x, -x]).collect()
}

/// The `f32` that lie nearest to a multiple of π/2, by continued fractions: 16573937·2⁻¹⁶ of those
/// below 10⁵, 4.2·10⁻⁹ away; 16367173·2⁷² of all, 1.6·10⁻⁹ away.
const WORST_SINGLES: [f32; 2] = [16_573_937.0 / 65_536.0, 16_367_173.0 * (1_u128 << 72) as f32];

/// Angles of every size, most of them typical for joints.
fn angles(count: usize) -> Vec<f64> {
    let mut random = Random::new(11);
    let mut angles = worst();
    angles.extend((0..count).map(|k| match k % 4 {
        0 => random.within(-1000.0, 1000.0),
        1 => random.within(-300.0, 300.0).exp2() * random.within(1.0, 2.0),
        _ => random.within(-7.0, 7.0),
    }));
    angles
}

/// |found − exact| / |exact|, if the result is the sum of two doubles.
fn relative(exact: Big, found: (f64, f64)) -> f64 {
    let difference = Big::from_f64(found.0) + Big::from_f64(found.1) - exact;
    (difference / exact).to_f64().abs()
}

fn hold(count: usize) {
    for x in angles(count) {
        Big::scope(|| {
            let (sin, cos) = Big::from_f64(x).sin_cos();
            let nearest = (sin.to_f64(), cos.to_f64());
            assert_eq!(two::sin_cos_correct::<false>(x), nearest, "{x:e}");
            assert_eq!(two::sin_cos_correct::<true>(x), nearest, "{x:e}");
            let (s, c) = two::sines_of_two::<false>((x, 0.0));
            // If a double's remainder is subnormal, no more accuracy is possible.
            if x.abs() > 1e-200 {
                let most = 2.0_f64.powi(-100);
                assert!(relative(sin, s) <= most && relative(cos, c) <= most, "{x:e}: {:e} {:e}", relative(sin, s), relative(cos, c));
            }
            let fast = [fast_7::sin_cos([x, 0.1, 0.2, 0.3]), fast_10::sin_cos([x, 0.1, 0.2, 0.3])];
            for ((s, c), most) in fast.into_iter().zip([1e-7, 1e-10]) {
                let off = [(sin, s[0]), (cos, c[0])].map(|(e, f)| (Big::from_f64(f) - e).to_f64().abs());
                assert!(off[0] <= most && off[1] <= most, "{x:e}: {off:?}");
            }
        });
    }
}

#[test]
fn sines_are_as_exact_as_their_level_says() {
    hold(3_000);
}

#[test]
#[ignore = "a million angles in 96 digits: 80 s with optimisation"]
fn sines_are_as_exact_as_their_level_says_at_a_million_angles() {
    hold(1_000_000);
}

/// Sines of the level f32 (those of doubles, rounded) and the correctly rounded ones, of four
/// numbers by their bits, against the standard library's of doubles. Those have errors below 4 ulps
/// of doubles (known: 0.55), which decides the rounding in all but some hundred cases in total; 96
/// digits decide these. Returns their number.
fn singles(bits: [u32; 4]) -> usize {
    let x = bits.map(f32::from_bits);
    let (sines, cosines) = ulp::sin_cos(x.map(f64::from));
    let mut doubtful = 0;
    for (k, x) in x.into_iter().enumerate() {
        let (known, nearest) = (f64::from(x).sin_cos(), two::sin_cos_correct_f32::<false>(x));
        let both = [(known.0, nearest.0, sines[k] as f32), (known.1, nearest.1, cosines[k] as f32)];
        for (which, (known, nearest, rounded)) in both.into_iter().enumerate() {
            if x.is_nan() || x.is_infinite() {
                assert!(rounded.is_nan() && nearest.is_nan());
            } else if let Some(right) = decided(known) {
                assert!(nearest == right && rounded == right, "{x:e}: {nearest:e} {rounded:e}, expected {right:e}");
            } else {
                doubtful += 1;
                doubt(x, which == 0, nearest, rounded);
            }
        }
    }
    doubtful
}

/// The nearest `f32` to a number within 4 ulps of doubles of this one, if that decides it.
fn decided(known: f64) -> Option<f32> {
    let (low, high) = (known * (1.0 - 4.0 * f64::EPSILON), known * (1.0 + 4.0 * f64::EPSILON));
    (low as f32 == high as f32).then_some(high as f32)
}

fn doubt(x: f32, sine: bool, nearest: f32, rounded: f32) {
    Big::scope(|| {
        let (sin, cos) = Big::from_f64(f64::from(x)).sin_cos();
        let (exact, ulp) = (if sine { sin } else { cos }, f64::from(nearest.abs().next_up()) - f64::from(nearest.abs()));
        let off = |y: f32| (Big::from_f64(f64::from(y)) - exact).to_f64().abs() / ulp;
        assert!(off(nearest) <= 0.5, "{x:e}: {nearest:e} is off by {}", off(nearest));
        assert!(off(rounded) <= 0.5 + 1e-8, "{x:e}: {rounded:e} is off by {}", off(rounded));
    });
}

#[test]
fn every_so_many_single_angles_have_the_nearest_sines() {
    (0..=u32::MAX).step_by(40_009).chain(WORST_SINGLES.map(f32::to_bits)).for_each(|bits| {
        singles([bits, bits ^ 1, bits ^ 2, bits ^ (1 << 31)]);
    });
}

#[test]
#[ignore = "every f32 there is: a quarter of an hour with optimisation"]
fn all_single_angles_have_the_nearest_sines() {
    let doubtful: usize = (0..=u32::MAX / 4).map(|n| singles([4 * n, 4 * n + 1, 4 * n + 2, 4 * n + 3])).sum();
    assert!((1..10_000).contains(&doubtful), "{doubtful}");
    println!("{doubtful} were doubtful");
}
