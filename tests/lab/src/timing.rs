//! Comparable times: all contenders are timed in every repetition, so that drifts affect all of
//! them, and from their second round on, so that all have warm caches.

use std::time::Duration;

use serde::Serialize;

/// A timed contender.
pub struct Run<'a> {
    /// Number of states of a round.
    states: usize,
    clocked: Box<dyn FnMut(usize) -> Duration + 'a>,
}

impl<'a> Run<'a> {
    /// `clocked` runs a number of rounds, each through `states` states, and returns the time.
    pub fn new(states: usize, clocked: impl FnMut(usize) -> Duration + 'a) -> Self {
        Self { states: states.max(1), clocked: Box::new(clocked) }
    }

    /// Time of this number of rounds.
    pub fn go(&mut self, rounds: usize) -> Duration {
        (self.clocked)(rounds)
    }
}

/// One batch of one contender takes about this long.
const BATCH: Duration = Duration::from_micros(400);

/// The middle of some numbers and the quartiles around it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Summary {
    /// The middle.
    pub median: f64,
    /// A quarter is below it.
    pub lower_quartile: f64,
    /// A quarter is above it.
    pub upper_quartile: f64,
}

/// ns per state of each run in each repetition.
pub fn interleaved(runs: &mut [Run<'_>], repetitions: usize) -> Vec<Vec<f64>> {
    let rounds: Vec<usize> = runs.iter_mut().map(rounds_of_a_batch).collect();
    let mut times = vec![Vec::with_capacity(repetitions); runs.len()];
    for repetition in 0..repetitions {
        for turn in 0..runs.len() {
            // Everybody is first in turn.
            let k = (turn + repetition) % runs.len();
            // Contents of the caches left by others must not count.
            runs[k].go(1);
            let time = runs[k].go(rounds[k]);
            times[k].push(time.as_secs_f64() * 1e9 / (rounds[k] * runs[k].states) as f64);
        }
    }
    times
}

/// Number of rounds in a batch; the measurement also warms up.
fn rounds_of_a_batch(run: &mut Run<'_>) -> usize {
    let mut rounds = 1;
    loop {
        // The minimum of three: other processes interrupt.
        let time = (0..3).map(|_| run.go(rounds)).min().unwrap_or_default();
        if time * 4 >= BATCH || rounds > 1 << 24 {
            let scale = BATCH.as_secs_f64() / time.as_secs_f64().max(1e-9);
            return ((rounds as f64 * scale) as usize).max(1);
        }
        rounds *= 2;
    }
}

/// Median and quartiles.
pub fn summary(numbers: &[f64]) -> Summary {
    let mut sorted = numbers.to_vec();
    sorted.sort_by(f64::total_cmp);
    let at = |part: f64| {
        let place = part * (sorted.len().max(1) - 1) as f64;
        let (below, above) = (place.floor() as usize, place.ceil() as usize);
        let value = |k: usize| sorted.get(k).copied().unwrap_or(f64::NAN);
        value(below) + (value(above) - value(below)) * place.fract()
    };
    Summary { median: at(0.5), lower_quartile: at(0.25), upper_quartile: at(0.75) }
}

/// The ratios of two contenders' times, repetition by repetition.
pub fn ratio(a: &[f64], b: &[f64]) -> Summary {
    let ratios: Vec<f64> = a.iter().zip(b).map(|(a, b)| a / b).collect();
    summary(&ratios)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quartiles_of_known_numbers() {
        let s = summary(&[5.0, 1.0, 4.0, 2.0, 3.0]);
        assert_eq!((s.lower_quartile, s.median, s.upper_quartile), (2.0, 3.0, 4.0));
        assert_eq!(summary(&[1.0, 2.0]).median, 1.5);
        assert!(summary(&[]).median.is_nan());
        assert_eq!(ratio(&[2.0, 4.0, 8.0], &[1.0, 2.0, 4.0]).median, 2.0);
    }

    #[test]
    fn everybody_is_timed_in_every_repetition() {
        let took = |micros: u64| move |n: usize| Duration::from_micros(micros) * n as u32;
        let mut runs = [Run::new(10, took(10)), Run::new(20, took(60))];
        let times = interleaved(&mut runs, 5);
        assert_eq!(times.iter().map(Vec::len).collect::<Vec<_>>(), [5, 5]);
        assert!((summary(&ratio_list(&times)).median - 3.0).abs() < 1e-9);
    }

    fn ratio_list(times: &[Vec<f64>]) -> Vec<f64> {
        times[1].iter().zip(&times[0]).map(|(a, b)| a / b).collect()
    }
}
