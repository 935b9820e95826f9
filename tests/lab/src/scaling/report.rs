//! The results of a measurement, as data.

use std::borrow::Cow;

use serde::Serialize;

use crate::json::Units;
use crate::timing::Summary;

/// Of all numbers that have one.
pub(super) const UNITS: Units = Units(&[
    ("points[].generated_hot", "ns per call"),
    ("points[].generic_hot", "ns per call"),
    ("points[].generated_cold", "ns per call"),
    ("points[].generic_cold", "ns per call"),
    ("points[].difference", "the largest number of the result"),
    ("crossovers[].hot", "joints"),
    ("crossovers[].cold", "joints"),
    ("growth[].time", "times that of a joint of the shortest chain"),
    ("growth[].generation", "times that of a joint of the shortest chain"),
    ("growth[].compilation", "times that of a joint of the shortest chain"),
]);

/// One function on one chain.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Point {
    pub(super) function: &'static str,
    pub(super) joints: usize,
    /// The form that the generator chose by count, if it had a choice.
    pub(super) ways: Vec<Cow<'static, str>>,
    pub(super) instructions: u64,
    pub(super) source_bytes: usize,
    pub(super) code_bytes: Option<u64>,
    /// From the URDF's text to the source.
    pub(super) generation_seconds: f64,
    /// `rustc`, start and linking included.
    pub(super) compilation_seconds: f64,
    /// Difference of generated and generic results, relative to the largest one.
    pub(super) difference: f64,
    /// ns per call, these four.
    pub(super) generated_hot: Summary,
    pub(super) generic_hot: Summary,
    pub(super) generated_cold: Summary,
    pub(super) generic_cold: Summary,
}

/// From how many joints on generic code is faster.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(super) struct Crossover {
    pub(super) function: &'static str,
    /// `None`: at no measured length.
    pub(super) hot: Option<f64>,
    pub(super) cold: Option<f64>,
    /// The longest chain that was measured.
    pub(super) up_to: usize,
}

/// Growth of the costs per joint from the shortest chain to the longest.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Growth {
    pub(super) function: &'static str,
    pub(super) from: usize,
    pub(super) to: usize,
    pub(super) time: f64,
    pub(super) generation: f64,
    pub(super) compilation: f64,
}

/// The results of the measurement.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    pub(super) compiler: String,
    pub(super) flags: String,
    /// Whether the command itself is optimised; generic code and generation are as fast as it is.
    pub(super) optimised: bool,
    pub(super) states: usize,
    pub(super) repetitions: u32,
    /// Size of the buffer and the filler that run before an evaluation with cold caches.
    pub(super) buffer_bytes: usize,
    pub(super) filler_instructions: usize,
    pub(super) units: Units,
    pub(super) points: Vec<Point>,
    pub(super) crossovers: Vec<Crossover>,
    pub(super) growth: Vec<Growth>,
    pub(super) notes: Vec<String>,
}

impl Report {
    /// Adds the points, and the conclusions from them.
    pub(super) fn conclude(&mut self, points: Vec<Point>) {
        let mut rest = points.as_slice();
        while let Some(first) = rest.first() {
            let (own, others) = rest.split_at(rest.iter().take_while(|p| p.function == first.function).count());
            self.crossovers.push(crossover(own));
            self.growth.extend(growth(own));
            rest = others;
        }
        self.points = points;
    }

    /// The functions, each with its points in the order of their lengths.
    pub(super) fn functions(&self) -> impl Iterator<Item = (&'static str, Vec<&Point>)> {
        self.crossovers.iter().map(|c| (c.function, self.points.iter().filter(|p| p.function == c.function).collect()))
    }
}

/// Of the points of one function.
fn crossover(points: &[Point]) -> Crossover {
    let against = |pair: fn(&Point) -> (&Summary, &Summary)| -> Vec<(f64, f64)> {
        points.iter().map(|p| (p.joints as f64, pair(p).0.median / pair(p).1.median)).collect()
    };
    Crossover {
        function: points[0].function,
        hot: last_crossing(&against(|p| (&p.generated_hot, &p.generic_hot))),
        cold: last_crossing(&against(|p| (&p.generated_cold, &p.generic_cold))),
        up_to: points[points.len() - 1].joints,
    }
}

/// Where a curve (n, ratio) last rises above 1; linear in both logarithms between two points.
fn last_crossing(curve: &[(f64, f64)]) -> Option<f64> {
    let below = curve.iter().rposition(|(_, ratio)| *ratio < 1.0);
    let (n, above) = *curve.get(below.map_or(0, |k| k + 1))?;
    let Some((m, under)) = below.map(|k| curve[k]) else { return Some(n) };
    let part = -under.ln() / (above.ln() - under.ln());
    Some(m * (n / m).powf(part))
}

fn growth(points: &[Point]) -> Option<Growth> {
    let (first, last) = (points.first()?, points.last()?);
    let ratio = |cost: fn(&Point) -> f64| (cost(last) / last.joints as f64) / (cost(first) / first.joints as f64);
    (first.joints < last.joints).then(|| Growth {
        function: first.function,
        from: first.joints,
        to: last.joints,
        time: ratio(|p| p.generated_hot.median),
        generation: ratio(|p| p.generation_seconds),
        compilation: ratio(|p| p.compilation_seconds),
    })
}

#[cfg(test)]
mod tests {
    use super::last_crossing;

    #[test]
    fn a_crossing_is_where_the_ratio_stays_above_one() {
        assert_eq!(last_crossing(&[(1.0, 0.5), (2.0, 0.6)]), None);
        assert_eq!(last_crossing(&[(3.0, 1.5), (6.0, 2.0)]), Some(3.0));
        // Above, below, above: only the last counts, half way between the logarithms.
        let n = last_crossing(&[(1.0, 2.0), (10.0, 0.5), (1000.0, 2.0), (2000.0, 3.0)]).unwrap();
        assert!((n - 100.0).abs() < 1e-9, "{n}");
    }
}
