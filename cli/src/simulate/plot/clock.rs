//! The times of a picture as its axis shows them.

/// Times, and what the axis is called.
pub(super) struct Clock {
    pub(super) t: Vec<f64>,
    /// Of events.
    pub(super) events: Vec<f64>,
    pub(super) title: String,
}

/// Where times are so many lengths of the motion from 0, they are told from its start: numbers at ticks would be alike but for their last digits.
const FAR: f64 = 1e4;

impl Clock {
    pub(super) fn of(t: &[f64], events: &[f64]) -> Self {
        let [first, last] = [t.first(), t.last()].map(|t| t.copied().unwrap_or(0.0));
        if first.abs().max(last.abs()) <= FAR * (last - first) || first == 0.0 {
            return Self { t: t.to_vec(), events: events.to_vec(), title: "time, s".to_owned() };
        }
        let since = |all: &[f64]| all.iter().map(|t| t - first).collect();
        let start = if (1e-4..1e15).contains(&first.abs()) { first.to_string() } else { format!("{first:e}") };
        Self { t: since(t), events: since(events), title: format!("time since {} s, s", start.replace('-', "−")) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_far_from_zero_are_told_from_the_start() {
        let clock = Clock::of(&[-1e6, -1e6 + 0.5], &[-1e6 + 0.25]);
        assert_eq!((clock.t, clock.events, clock.title.as_str()), (vec![0.0, 0.5], vec![0.25], "time since −1000000 s, s"));
        assert_eq!(Clock::of(&[1e20, 1e20], &[]).title, "time since 1e20 s, s");
        for near in [&[0.0, 5e-4][..], &[-0.1, 1.0], &[100.0, 110.0], &[0.0], &[]] {
            let clock = Clock::of(near, &[]);
            assert_eq!((&clock.t[..], clock.title.as_str()), (near, "time, s"));
        }
    }
}
