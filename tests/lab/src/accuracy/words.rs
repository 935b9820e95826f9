//! Sentences about unexpected results.

use super::report::Point;

/// Notable results among the points of one function.
pub(super) fn surprises(points: &[Point]) -> Vec<String> {
    let Some(plain) = points.iter().find(|p| p.level == "f64") else { return Vec::new() };
    let seen = Seen { points, plain };
    let levels = [singles(&seen), doubled(&seen), compensated(&seen), fast(&seen, "f64+fast_7"), fast(&seen, "f64+fast_10")];
    let rest = [correct(&seen), without_fma(&seen), hardest(plain), bound_and_seen(plain)];
    levels.into_iter().chain(rest).flatten().chain(points.iter().filter_map(|p| far_off(p, plain))).collect()
}

/// The points of one function, and that of plain doubles.
struct Seen<'a> {
    points: &'a [Point],
    plain: &'a Point,
}

impl Seen<'_> {
    fn at(&self, level: &str) -> Option<&Point> {
        self.points.iter().find(|p| p.level == level)
    }

    /// Ratio of its time to that of plain doubles.
    fn times(&self, p: &Point) -> f64 {
        p.time.median / self.plain.time.median
    }
}

/// The largest rounding.
fn off(p: &Point) -> f64 {
    p.rounding.map_or(f64::NAN, |r| r.largest)
}

fn singles(seen: &Seen) -> Option<String> {
    let exact = seen.plain.relative.largest;
    let p = seen.at("f32").filter(|p| seen.times(p) > 0.7 && exact > 0.0)?;
    Some(format!(
        "f32 takes {:.2} times the time of f64 and is {:.0e} times less accurate: one call is a chain of operations that wait for each other, and they wait as long in either type. \
         Single precision pays where many states are computed at once.",
        seen.times(p),
        p.relative.largest / exact
    ))
}

fn doubled(seen: &Seen) -> Option<String> {
    let p = seen.at("double_double").filter(|p| off(p).is_finite() && seen.times(p) > 1.0)?;
    if p.relative.largest < 2.0 * off(p) {
        return Some(format!(
            "double_double takes {:.0} times as long and is off by {:.1e}, where f64 is off by {:.1e}: what is left is the rounding of the result.",
            seen.times(p),
            p.relative.largest,
            seen.plain.relative.largest
        ));
    }
    Some(format!(
        "double_double takes {:.0} times as long; what it computes is off by {:.1e} from its own formulas, but by {:.1e} from the numbers of the robot's file, where f64 is off by {:.1e}: \
         the constants of the model are doubles at every level, and that is what is left.",
        seen.times(p),
        off(p),
        p.relative.largest,
        seen.plain.relative.largest
    ))
}

fn compensated(seen: &Seen) -> Option<String> {
    let (p, two) = (seen.at("compensated")?, seen.at("compensated+two")?);
    (off(p) > 1.5 * off(two)).then(|| {
        format!(
            "Compensated sums bring rounding down from {:.1e} to {:.1e}; the rest is the sines, which are doubles: with sines of two doubles it is {:.1e}.",
            off(seen.plain),
            off(p),
            off(two)
        )
    })
}

fn fast(seen: &Seen, level: &str) -> Option<String> {
    let times = seen.at(level).map(|p| seen.times(p)).filter(|times| (0.85..=1.0).contains(times))?;
    Some(format!("Fast sines ({level}) save {:.0} % of the time: four sines at once cost little to begin with.", 100.0 * (1.0 - times)))
}

fn correct(seen: &Seen) -> Option<String> {
    let p = seen.at("f64+correct")?;
    Some(format!(
        "Sines to the nearest double take {:.2} times the time and change the largest error from {:.1e} to {:.1e}: the last half of an ulp of a sine is lost among the other roundings.",
        seen.times(p),
        seen.plain.relative.largest,
        p.relative.largest
    ))
}

fn without_fma(seen: &Seen) -> Option<String> {
    let p = seen.at("f64+no_fma")?;
    Some(format!("Without fused multiply-add, with the same bits on every machine: {:.2} times the time.", seen.times(p)))
}

fn hardest(plain: &Point) -> Option<String> {
    let (error, name) = plain.hard.filter(|(error, _)| *error > 8.0 * plain.relative.largest)?;
    let random = match plain.relative.largest {
        0.0 => "and none at random".to_owned(),
        worst => format!("{:.0} times the worst at random", error / worst),
    };
    Some(format!("The hardest state for f64 is \u{201c}{name}\u{201d}: {error:.1e}, {random}."))
}

/// A peer with a large error on a hard state.
fn far_off(p: &Point, plain: &Point) -> Option<String> {
    let (error, name) = p.hard.filter(|(error, _)| p.peer && *error > 1e-6 && *error > 1e3 * p.relative.largest)?;
    Some(format!(
        "{} is off by {error:.0e} of the terms at \u{201c}{name}\u{201d}; f64 here by {:.1e} in its hardest state.",
        p.level,
        plain.hard.map_or(f64::NAN, |h| h.0)
    ))
}

fn bound_and_seen(plain: &Point) -> Option<String> {
    against_the_bound(plain.bound?, plain.rounding?.largest)
}

/// Ratio of the guaranteed bound to the observed rounding error.
fn against_the_bound(bound: f64, seen: f64) -> Option<String> {
    let said = match seen {
        _ if bound == 0.0 => return None,
        0.0 => "where no rounding was seen".to_owned(),
        _ => format!("{:.0} times what was seen: roundings cancel more often than they add up", bound / seen),
    };
    Some(format!("The guaranteed bound of f64 is {bound:.1e}, {said}."))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_rounding_is_no_number_of_times() {
        assert_eq!(against_the_bound(0.0, 0.0), None);
        assert_eq!(against_the_bound(1e-15, 0.0).unwrap(), "The guaranteed bound of f64 is 1.0e-15, where no rounding was seen.");
        assert!(against_the_bound(1e-15, 1e-16).unwrap().contains("10 times what was seen"));
    }
}
