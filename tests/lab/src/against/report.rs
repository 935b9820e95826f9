//! Wall times of engines, as data.

use serde::Serialize;

use super::search::Effort;

/// The results of the measurement.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    pub(super) scene: String,
    pub(super) robot: String,
    pub(super) simulated_s: f64,
    /// Reference for errors.
    pub(super) reference: String,
    pub(super) compiler: String,
    pub(super) notes: Vec<String>,
    pub(super) targets: Vec<Target>,
}

/// Everybody at the same error.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Target {
    /// For the last state, the largest difference of a coordinate or rate: rad, m, and the same per
    /// second.
    pub(super) error: f64,
    pub(super) reached: Vec<Reached>,
    /// The fastest peer's time over that of our fastest integrator.
    pub(super) times_faster: Option<f64>,
    /// The same against our fourth-order integrator with fixed steps.
    pub(super) times_faster_at_order_4: Option<f64>,
}

#[derive(Clone, Debug, Default, Serialize)]
pub(super) struct Reached {
    pub(super) name: String,
    pub(super) order: u32,
    pub(super) ours: bool,
    pub(super) effort: Effort,
    pub(super) error: f64,
    pub(super) steps: u64,
    /// Of forward dynamics.
    pub(super) evaluations: u64,
    /// Of the fastest run: a motion takes longer than a busy machine leaves it alone.
    pub(super) wall_ms: f64,
    pub(super) simulated_s_per_wall_s: f64,
}

impl Target {
    pub(super) fn new(error: f64, reached: Vec<Reached>) -> Self {
        let fastest = |who: &dyn Fn(&Reached) -> bool| reached.iter().filter(|r| who(r)).map(|r| r.wall_ms).min_by(f64::total_cmp);
        let peer = fastest(&|r| !r.ours);
        let over = |own: Option<f64>| Some(peer? / own?);
        let (all, fourth) = (over(fastest(&|r| r.ours)), over(fastest(&|r| r.ours && r.order == 4)));
        Self { error, times_faster: all, times_faster_at_order_4: fourth, reached }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_fastest_of_each_side_are_compared() {
        let reached = |name: &str, ours, order, wall_ms| Reached { name: name.into(), ours, order, wall_ms, ..Reached::default() };
        let all = vec![reached("a", false, 4, 30.0), reached("b", false, 4, 20.0), reached("c", true, 4, 4.0), reached("d", true, 8, 1.0)];
        let target = Target::new(1e-6, all);
        assert_eq!((target.times_faster, target.times_faster_at_order_4), (Some(20.0), Some(5.0)));
        assert!(Target::new(1e-6, Vec::new()).times_faster.is_none());
    }
}
