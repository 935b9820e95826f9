//! Who needs how long, as data.

use serde::Serialize;

use super::search::Effort;
use crate::compare::timing;

#[derive(Clone, Debug, Serialize)]
pub(super) struct Report {
    pub(super) scene: String,
    pub(super) robot: String,
    pub(super) simulated_s: f64,
    /// What errors are measured against.
    pub(super) reference: String,
    pub(super) compiler: String,
    pub(super) notes: Vec<String>,
    pub(super) targets: Vec<Target>,
}

/// Everybody at the same error.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Target {
    /// Of the last state, the largest difference of a coordinate or rate: rad, m, and those a second.
    pub(super) error: f64,
    pub(super) reached: Vec<Reached>,
    /// The fastest peer's time over that of our fastest integrator, repetition by repetition.
    pub(super) times_faster: Option<timing::Summary>,
    /// The same against our fourth-order integrator with fixed steps.
    pub(super) times_faster_at_order_4: Option<timing::Summary>,
}

#[derive(Clone, Debug, Default, Serialize)]
pub(super) struct Reached {
    pub(super) name: String,
    pub(super) order: u32,
    pub(super) own: bool,
    pub(super) effort: Effort,
    pub(super) error: f64,
    pub(super) steps: u64,
    /// Of forward dynamics.
    pub(super) evaluations: u64,
    pub(super) wall_ms: f64,
    pub(super) simulated_s_per_wall_s: f64,
}

impl Target {
    /// With the times of each, repetition by repetition.
    pub(super) fn new(error: f64, reached: Vec<Reached>, times: &[Vec<f64>]) -> Self {
        let fastest = |who: &dyn Fn(&Reached) -> bool| {
            let some = (0..reached.len()).filter(|k| who(&reached[*k]));
            some.min_by(|a, b| reached[*a].wall_ms.total_cmp(&reached[*b].wall_ms))
        };
        let peer = fastest(&|r| !r.own);
        let over = |own: Option<usize>| Some(timing::ratio(&times[peer?], &times[own?]));
        let (all, fourth) = (over(fastest(&|r| r.own)), over(fastest(&|r| r.own && r.order == 4)));
        Self { error, times_faster: all, times_faster_at_order_4: fourth, reached }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_fastest_of_each_side_are_compared() {
        let reached = |name: &str, own, order, wall_ms| Reached { name: name.into(), own, order, wall_ms, ..Reached::default() };
        let all = vec![reached("a", false, 4, 30.0), reached("b", false, 4, 20.0), reached("c", true, 4, 4.0), reached("d", true, 8, 1.0)];
        let times = [vec![30.0], vec![20.0], vec![4.0], vec![1.0]];
        let target = Target::new(1e-6, all, &times);
        assert_eq!(target.times_faster.unwrap().median, 20.0);
        assert_eq!(target.times_faster_at_order_4.unwrap().median, 5.0);
        assert!(Target::new(1e-6, Vec::new(), &[]).times_faster.is_none());
    }
}
