//! A linear axis: where a number stands, and which numbers are written at it.

/// From a number to a place on the paper.
#[derive(Clone, Debug)]
pub(super) struct Axis {
    /// Numbers at the ends.
    pub(super) range: [f64; 2],
    /// Where the ends are drawn.
    pub(super) ends: [f64; 2],
    /// Between two ticks.
    step: f64,
}

impl Axis {
    /// Over all numbers that are finite, its ends at ticks; about `count` ticks.
    pub(super) fn around(numbers: impl Iterator<Item = f64>, ends: [f64; 2], count: f64) -> Self {
        let [low, high] = wide(numbers);
        let step = step((high - low) / count);
        Self { range: [(low / step).floor() * step, (high / step).ceil() * step], ends, step }
    }

    /// From the least to the most, whatever ticks there are.
    pub(super) fn exactly(numbers: impl Iterator<Item = f64>, ends: [f64; 2], count: f64) -> Self {
        let [low, high] = wide(numbers);
        Self { range: [low, high], ends, step: step((high - low) / count) }
    }

    pub(super) fn at(&self, number: f64) -> f64 {
        let part = (number - self.range[0]) / (self.range[1] - self.range[0]);
        self.ends[0] + part * (self.ends[1] - self.ends[0])
    }

    /// The numbers written at the axis, with their texts, and the power of ten that all of them are to be multiplied with.
    pub(super) fn ticks(&self) -> (Vec<(f64, String)>, i32) {
        let [low, high] = self.range;
        let slack = 1e-9 * self.step;
        let (first, last) = (((low - slack) / self.step).ceil() as i64, ((high + slack) / self.step).floor() as i64);
        let largest = low.abs().max(high.abs());
        let power = if (1e-3..1e5).contains(&largest) { 0 } else { 3 * (largest.log10() / 3.0).floor() as i32 };
        let unit = self.step / 10f64.powi(power);
        let places = (-unit.log10() + 0.01).floor().clamp(0.0, 9.0) as usize;
        // 2.5 has a place more than its power of ten.
        let places = if (unit * 10f64.powi(places as i32)).fract().abs() > 0.1 { places + 1 } else { places };
        let tick = |k: i64| {
            let text = format!("{:.places$}", k as f64 * unit);
            (k as f64 * self.step, text.replace('-', "−"))
        };
        ((first..=last.min(first + 50)).map(tick).collect(), power)
    }
}

/// The least and the most, some way apart: numbers that differ in their last digits only are drawn as one.
fn wide(numbers: impl Iterator<Item = f64>) -> [f64; 2] {
    let ends = numbers.filter(|x| x.is_finite()).fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], x| [a.min(x), b.max(x)]);
    let [low, high] = if ends[0] <= ends[1] { ends.map(|x| x.clamp(-1e300, 1e300)) } else { [0.0, 1.0] };
    let size = low.abs().max(high.abs());
    if high - low > 1e-7 * size && size > 1e-290 {
        [low, high]
    } else {
        let room = if size > 1e-290 { 0.1 * size } else { 1.0 };
        [low - room, high + room]
    }
}

/// 1, 2 or 5 times a power of ten, at least `least`.
fn step(least: f64) -> f64 {
    let power = 10f64.powf(least.log10().floor());
    [1.0, 2.0, 5.0].map(|m| m * power).into_iter().find(|s| *s >= least * (1.0 - 1e-9)).unwrap_or(10.0 * power)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(axis: &Axis) -> Vec<String> {
        axis.ticks().0.into_iter().map(|(_, text)| text).collect()
    }

    #[test]
    fn ticks_are_round_numbers() {
        let axis = Axis::around([-0.93, 1.2].into_iter(), [100.0, 0.0], 5.0);
        assert_eq!(texts(&axis), ["−1.0", "−0.5", "0.0", "0.5", "1.0", "1.5"]);
        assert_eq!((axis.at(-1.0), axis.at(1.5)), (100.0, 0.0));
        let small = Axis::around([0.0, 3.2e-13].into_iter(), [0.0, 1.0], 4.0);
        assert_eq!((texts(&small), small.ticks().1), (vec!["0".into(), "100".into(), "200".into(), "300".into(), "400".into()], -15));
    }

    #[test]
    fn what_hardly_changes_is_a_straight_line() {
        let axis = Axis::around([5.0, 5.0 + 1e-12].into_iter(), [0.0, 100.0], 4.0);
        assert!((axis.at(5.0) - axis.at(5.0 + 1e-12)).abs() < 1e-6);
        for odd in [vec![], vec![f64::NAN], vec![0.0], vec![f64::MAX, f64::MIN], vec![5e-324, 0.0]] {
            let axis = Axis::around(odd.into_iter(), [0.0, 1.0], 5.0);
            assert!(axis.range[0] < axis.range[1] && axis.ticks().0.len() < 60, "{axis:?}");
        }
    }
}
