//! The least effort that reaches an error.

use serde::Serialize;

use super::Runner;

/// The effort of a run.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Effort {
    /// A number of equal steps.
    Steps(usize),
    /// Steps by this tolerance, relative and absolute.
    Tolerance(f64),
}

impl Default for Effort {
    fn default() -> Self {
        Self::Steps(0)
    }
}

/// The largest difference of two states.
pub(super) fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, |most, x| if x > most || x.is_nan() { x } else { most })
}

/// Efforts of fixed steps: four to an octave.
pub(super) fn steps(level: usize) -> Option<Effort> {
    (level < 76).then(|| Effort::Steps((64.0 * (level as f64 / 4.0).exp2()).round() as usize))
}

/// Efforts of tolerances: four to a decade.
pub(super) fn tolerances(level: usize) -> Option<Effort> {
    (level < 49).then(|| Effort::Tolerance(10_f64.powf(-1.5 - level as f64 / 4.0)))
}

/// The first level whose error is at most the target, and stays so at the next level: a lucky hit
/// does not count.
pub(super) fn search(runner: &mut dyn Runner, best: &[f64], target: f64, from: usize) -> Option<(usize, Effort, f64)> {
    let mut before: Option<(usize, Effort, f64)> = None;
    for level in from.. {
        let effort = runner.effort(level)?;
        let error = runner.run(effort).map_or(f64::INFINITY, |end| distance(&end, best));
        match before {
            Some(found) if error <= target => return Some(found),
            _ => before = (error <= target).then_some((level, effort, error)),
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Its error decreases with the fourth power of the step, except for one lucky hit.
    struct Fourth;

    impl Runner for Fourth {
        fn name(&self) -> String {
            String::new()
        }

        fn order(&self) -> u32 {
            4
        }

        fn is_ours(&self) -> bool {
            false
        }

        fn effort(&self, level: usize) -> Option<Effort> {
            steps(level)
        }

        fn run(&mut self, effort: Effort) -> Option<Vec<f64>> {
            let Effort::Steps(n) = effort else { return None };
            Some(vec![if n == 76 { 0.0 } else { (n as f64).powi(-4) }])
        }

        fn spent(&self) -> (u64, u64) {
            (0, 0)
        }
    }

    #[test]
    fn the_least_effort_is_found_to_a_quarter_of_an_octave_and_luck_does_not_count() {
        let (_, effort, error) = search(&mut Fourth, &[0.0], 1e-8, 0).unwrap();
        let Effort::Steps(n) = effort else { panic!() };
        assert!((100..=120).contains(&n) && error <= 1e-8, "{n} {error}");
        assert!(search(&mut Fourth, &[0.0], 0.0, 0).is_none());
    }

    #[test]
    fn a_number_that_is_none_is_no_small_distance() {
        assert!(distance(&[1.0, f64::NAN], &[1.0, 1.0]).is_nan());
        assert_eq!(distance(&[1.0, 3.0], &[1.5, 1.0]), 2.0);
    }
}
