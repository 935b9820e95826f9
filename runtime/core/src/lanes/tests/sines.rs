//! Sines and cosines of every set.

use super::*;

/// By every set that this processor has: whether it fuses, and sines and cosines.
fn all_f64(x: &[f64]) -> Vec<(bool, Vec<[f64; 2]>)> {
    let mut sets =
        vec![(super::FMA, portable_f64x2::sines(x)), (super::FMA, portable_f64x4::sines(x)), (super::FMA, portable_f64x8::sines(x))];
    #[cfg(target_arch = "x86_64")]
    sets.extend([
        (false, sse2_f64x2::sines(x)),
        (false, sse2_f64x4::sines(x)),
        (true, avx2_f64x2::sines(x)),
        (true, avx2_f64x4::sines(x)),
        (true, avx512_f64x8::sines(x)),
    ]);
    #[cfg(target_arch = "aarch64")]
    sets.extend([(true, neon_f64x2::sines(x)), (true, neon_f64x4::sines(x))]);
    sets.into_iter().filter_map(|(fused, sines)| Some((fused, sines?))).collect()
}

/// By every set that this processor has: whether it fuses, and sines and cosines.
fn all_f32(x: &[f32]) -> Vec<(bool, Vec<[f32; 2]>)> {
    let mut sets = vec![(super::FMA, portable_f32x8::sines(x)), (super::FMA, portable_f32x16::sines(x))];
    #[cfg(target_arch = "x86_64")]
    sets.extend([(false, sse2_f32x4::sines(x)), (true, avx2_f32x8::sines(x)), (true, avx512_f32x16::sines(x))]);
    #[cfg(target_arch = "aarch64")]
    sets.extend([(true, neon_f32x4::sines(x))]);
    sets.into_iter().filter_map(|(fused, sines)| Some((fused, sines?))).collect()
}

/// The doubles below 10⁵ that lie nearest to a multiple of π/2, found by trying every multiple in
/// 200-bit arithmetic.
const NEAREST: [f64; 6] = [45.553093477052, 91.106186954104, 182.212373908208, 364.424747816416, 728.849495632832, 1457.698991265664];

fn angles() -> Vec<f64> {
    let mut x = 1e-300;
    let mut points: Vec<f64> = NEAREST.to_vec();
    points.extend([0.0, 1e5, 1e5_f64.next_up(), 5e-324, f64::MAX]);
    while x < 1e300 {
        points.push(x);
        x *= 1.0 + 0.37 * ((points.len() % 7) as f64 / 7.0 + 0.01);
    }
    points.extend((1..50_000).map(|k| k as f64 * 0.999_983));
    let quarters = (1..63_000).step_by(7).map(|k| k as f64 * core::f64::consts::FRAC_PI_2);
    points.extend(quarters.flat_map(|x| [x.next_down(), x, x.next_up()]));
    points.into_iter().flat_map(|x| [x, -x]).collect()
}

/// Every 4 999th f32, ends of the range of polynomials and beyond.
fn single_angles() -> Vec<f32> {
    let most = 1e4_f32.to_bits();
    let points = (0..=most).step_by(4_999).chain([most, most + 1]).chain((most..f32::MAX.to_bits()).step_by(1_000_003));
    points.map(f32::from_bits).flat_map(|x| [x, -x]).collect()
}

/// Numbers between one and the other.
fn ulps(a: f64, b: f64) -> u64 {
    if a == b { 0 } else { a.to_bits().abs_diff(b.to_bits()) }
}

fn single_ulps(a: f32, b: f32) -> u32 {
    if a == b { 0 } else { a.to_bits().abs_diff(b.to_bits()) }
}

#[test]
fn sines_are_the_standard_library_s_to_an_ulp() {
    let x = angles();
    for (_, sines) in all_f64(&x) {
        for (x, [s, c]) in x.iter().zip(sines) {
            let (s0, c0) = x.sin_cos();
            assert!(ulps(s, s0) <= 1 && ulps(c, c0) <= 1, "{x:e}: {s:e} {s0:e} {c:e} {c0:e}");
        }
    }
}

/// A rounded f64 is the nearest f32, but for a case in 2²⁸.
#[test]
fn single_sines_are_the_rounded_ones_of_double_to_an_ulp() {
    let x = single_angles();
    for (_, sines) in all_f32(&x) {
        for (x, [s, c]) in x.iter().zip(sines) {
            let (s0, c0) = f64::from(*x).sin_cos();
            assert!(single_ulps(s, s0 as f32) <= 1 && single_ulps(c, c0 as f32) <= 1, "{x:e}: {s:e} {s0:e} {c:e} {c0:e}");
        }
    }
}

#[test]
fn sets_that_fuse_agree_to_the_bit() {
    let (x, y) = (angles(), single_angles());
    for fused in [true, false] {
        let sets: Vec<_> = all_f64(&x).into_iter().filter(|set| set.0 == fused).collect();
        assert!(
            sets.windows(2).all(|sets| sets[0].1.iter().flatten().zip(sets[1].1.iter().flatten()).all(|(a, b)| a.to_bits() == b.to_bits()))
        );
        let sets: Vec<_> = all_f32(&y).into_iter().filter(|set| set.0 == fused).collect();
        assert!(
            sets.windows(2).all(|sets| sets[0].1.iter().flatten().zip(sets[1].1.iter().flatten()).all(|(a, b)| a.to_bits() == b.to_bits()))
        );
    }
}

#[test]
fn what_has_no_sine_gives_nan() {
    for x in [f64::NAN, -f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        assert!(all_f64(&[x; 16]).iter().all(|(_, sines)| sines.iter().flatten().all(|y| y.is_nan())));
        assert!(all_f32(&[x as f32; 16]).iter().all(|(_, sines)| sines.iter().flatten().all(|y| y.is_nan())));
    }
}

/// An angle beyond the limit among others, in each lane.
#[test]
fn a_lane_s_sine_depends_on_no_other_lane() {
    let x: Vec<f64> = (0..16).map(|i| 0.3 * f64::from(i) - 2.0).collect();
    let y: Vec<f32> = x.iter().map(|x| *x as f32).collect();
    let (alone, single_alone) = (all_f64(&x), all_f32(&y));
    for at in 0..16 {
        for beyond in [2e5, -1e300, f64::NAN, f64::INFINITY] {
            let (mut x, mut y) = (x.clone(), y.clone());
            (x[at], y[at]) = (beyond, beyond as f32);
            let same = |i: usize, now: f64, alone: f64, of: f64| {
                if i == at { ulps(now, of) <= 1 || (now.is_nan() && of.is_nan()) } else { now == alone }
            };
            for ((_, now), (_, alone)) in all_f64(&x).iter().zip(&alone) {
                assert!((0..16).all(|i| same(i, now[i][0], alone[i][0], beyond.sin()) && same(i, now[i][1], alone[i][1], beyond.cos())));
            }
            for ((_, now), (_, alone)) in all_f32(&y).iter().zip(&single_alone) {
                let (sin, cos) = (beyond as f32).sin_cos();
                let of = [f64::from(sin), f64::from(cos)];
                assert!((0..16).all(|i| (0..2).all(|j| same(i, now[i][j].into(), alone[i][j].into(), of[j]))));
            }
        }
    }
}

#[test]
fn the_sine_of_no_angle_is_zero() {
    for (_, sines) in all_f64(&[0.0, -0.0, 0.0, -0.0]) {
        assert!(sines.iter().all(|[s, c]| s.to_bits() == 0 && *c == 1.0));
    }
    for (_, sines) in all_f32(&[0.0, -0.0, 0.0, -0.0]) {
        assert!(sines.iter().all(|[s, c]| s.to_bits() == 0 && *c == 1.0));
    }
}
