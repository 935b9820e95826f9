//! A sentence for what one would not have guessed.

use super::report::Point;

/// What the points of one function say that is worth knowing.
pub(super) fn surprises(points: &[Point]) -> Vec<String> {
    let at = |name: &str| points.iter().find(|p| p.level == name);
    let Some(plain) = at("f64") else { return Vec::new() };
    let times = |p: &Point| p.time.median / plain.time.median;
    let mut out = Vec::new();
    if let Some(p) = at("f32").filter(|p| times(p) > 0.7 && plain.relative.largest > 0.0) {
        out.push(format!(
            "f32 takes {:.2} times the time of f64 and is {:.0e} times less accurate: one call is a chain of operations that wait for each other, and they wait as long in either type. \
             Single precision pays where many states are computed at once.",
            times(p),
            p.relative.largest / plain.relative.largest
        ));
    }
    if let Some(p) = at("double_double") {
        let rounding = p.rounding.map_or(f64::NAN, |r| r.largest);
        out.push(format!(
            "double_double takes {:.0} times as long; what it computes is off by {rounding:.1e} from its own formulas, but by {:.1e} from the URDF's numbers, where f64 is off by {:.1e}: \
             the constants of the model are doubles at every level, and that is what is left.",
            times(p),
            p.relative.largest,
            plain.relative.largest
        ));
    }
    if let (Some(p), Some(two)) = (at("compensated"), at("compensated+two")) {
        let off = |p: &Point| p.rounding.map_or(f64::NAN, |r| r.largest);
        if off(p) > 1.5 * off(two) {
            out.push(format!(
                "Compensated sums bring rounding down from {:.1e} to {:.1e}; the rest is the sines, which are doubles: with sines of two doubles it is {:.1e}.",
                off(plain),
                off(p),
                off(two)
            ));
        }
    }
    for name in ["f64+fast_7", "f64+fast_10"] {
        if let Some(p) = at(name).filter(|p| (0.85..=1.0).contains(&times(p))) {
            out.push(format!(
                "Fast sines ({name}) save {:.0} % of the time: four sines at once cost little to begin with.",
                100.0 * (1.0 - times(p))
            ));
        }
    }
    if let Some(p) = at("f64+correct") {
        out.push(format!(
            "Sines to the nearest double take {:.2} times the time and change the largest error from {:.1e} to {:.1e}: the last half of an ulp of a sine is lost among the other roundings.",
            times(p),
            plain.relative.largest,
            p.relative.largest
        ));
    }
    if let Some(p) = at("f64+no_fma") {
        out.push(format!("Without fused multiply-add, with the same bits on every machine: {:.2} times the time.", times(p)));
    }
    if let Some((error, name)) = plain.hard.filter(|(error, _)| *error > 8.0 * plain.relative.largest) {
        let random = match plain.relative.largest {
            0.0 => "and none at random".to_owned(),
            worst => format!("{:.0} times the worst at random", error / worst),
        };
        out.push(format!("The hardest state for f64 is \u{201c}{name}\u{201d}: {error:.1e}, {random}."));
    }
    if let (Some(bound), Some(r)) = (plain.bound, plain.rounding) {
        out.extend(bound_and_seen(bound, r.largest));
    }
    let far = |p: &&Point| p.peer && p.hard.is_some_and(|(error, _)| error > 1e-6 && error > 1e3 * p.relative.largest);
    for p in points.iter().filter(far) {
        let (error, name) = p.hard.unwrap_or_default();
        out.push(format!(
            "{} is off by {error:.0e} of the terms at \u{201c}{name}\u{201d}; f64 here by {:.1e} in its hardest state.",
            p.level,
            plain.hard.map_or(f64::NAN, |h| h.0)
        ));
    }
    out
}

/// How far the guaranteed bound is from the rounding that was seen.
fn bound_and_seen(bound: f64, seen: f64) -> Option<String> {
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
        assert_eq!(bound_and_seen(0.0, 0.0), None);
        assert_eq!(bound_and_seen(1e-15, 0.0).unwrap(), "The guaranteed bound of f64 is 1.0e-15, where no rounding was seen.");
        assert!(bound_and_seen(1e-15, 1e-16).unwrap().contains("10 times what was seen"));
    }
}
