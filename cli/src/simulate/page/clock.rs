//! The clock of a page: its speed of playing, and the number of its decimal places.

use std::cmp::Ordering;

/// Playing time of a motion at the fastest and at the slowest speed, s.
const OFFERED: [f64; 2] = [1.0, 1000.0];

/// Intended playing time at first, s.
const SEEN: [f64; 2] = [5.0, 15.0];

/// For rounding.
const SLACK: f64 = 1e-9;

/// Playing speeds, seconds of the motion per second, for a motion of this length, s, starting with
/// the slowest: round numbers, and 1.
pub(super) fn speeds(length: f64) -> Vec<f64> {
    let [slowest, fastest] = [(1.0 - SLACK) * length / OFFERED[1], (1.0 + SLACK) * length / OFFERED[0]];
    let mut all = vec![1.0];
    // Motions beyond these bounds are not useful to watch.
    if slowest > 1e-300 && fastest < 1e300 {
        let powers = slowest.log10().floor() as i32..=fastest.log10().floor() as i32;
        all.extend(powers.flat_map(|power| [1, 2, 5].map(|m| format!("{m}e{power}").parse::<f64>().unwrap_or(1.0))));
        all.retain(|speed| *speed == 1.0 || (slowest..=fastest).contains(speed));
    }
    all.sort_by(f64::total_cmp);
    all.dedup();
    all
}

/// The speed nearest to 1 at which the motion plays for the intended time; else the one nearest to
/// that time.
pub(super) fn speed(length: f64, speeds: &[f64]) -> f64 {
    let off = |speed: f64| {
        let seen = length / speed;
        (SEEN[0] / seen).max(seen / SEEN[1]).max(1.0 + SLACK)
    };
    let from_one = |speed: f64| speed.ln().abs();
    let order = |a: &f64, b: &f64| (off(*a), from_one(*a)).partial_cmp(&(off(*b), from_one(*b))).unwrap_or(Ordering::Equal);
    speeds.iter().copied().min_by(order).unwrap_or(1.0)
}

/// Decimal places that distinguish times of output, plus one, limited by the precision of doubles
/// of this size.
pub(super) fn places(t: &[f64]) -> usize {
    let (Some(first), Some(last)) = (t.first(), t.last()) else { return 0 };
    let (step, size) = ((last - first) / (t.len() - 1).max(1) as f64, first.abs().max(last.abs()));
    if step > 0.0 && size.is_finite() {
        let there = 15.0 - size.log10().floor();
        // Far from zero a step is rounded.
        ((-step.log10() - 1e-3).ceil() + 1.0).min(there).clamp(0.0, 100.0) as usize
    } else {
        3
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_motion_is_seen_for_some_ten_seconds() {
        let cases = [(1e-9, 2e-10), (1e-3, 2e-4), (0.35, 0.05), (2.0, 0.2), (3.0, 0.5), (5.0, 1.0), (10.0, 1.0), (20.0, 2.0), (1e3, 100.0)];
        for (length, expected) in cases {
            assert_eq!(speed(length, &speeds(length)), expected, "{length} s");
        }
    }

    #[test]
    fn speeds_are_round_and_go_from_a_thousand_seconds_to_one() {
        assert_eq!(speeds(1e-3), [1e-6, 2e-6, 5e-6, 1e-5, 2e-5, 5e-5, 1e-4, 2e-4, 5e-4, 1e-3, 1.0]);
        assert_eq!(speeds(1e3), [1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1e3]);
        assert_eq!(speeds(3.0), [0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0]);
        for odd in [0.0, -1.0, f64::NAN, f64::INFINITY, f64::MAX, 5e-324] {
            assert_eq!((speeds(odd), speed(odd, &speeds(odd))), (vec![1.0], 1.0), "{odd} s");
        }
    }

    #[test]
    fn the_clock_shows_more_than_the_step_of_output_and_no_more_than_there_is() {
        let every = |start: f64, step: f64| [0.0, 1.0, 2.0].map(|k| start + k * step);
        for (start, step, expected) in [(0.0, 0.01, 3), (0.0, 1e-5, 6), (0.0, 10.0, 0), (-0.1, 0.02, 3), (1e9, 0.01, 3), (1e9, 1e-6, 6)] {
            assert_eq!(places(&every(start, step)), expected, "{start} s, every {step} s");
        }
        assert_eq!((places(&[]), places(&[1.0]), places(&[0.0, f64::INFINITY])), (0, 3, 3));
    }
}
