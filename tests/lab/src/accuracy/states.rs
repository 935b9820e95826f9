//! States that are hard: where angles, rates or configurations bring errors out.

use articulated_core::algorithm::Argument;
use articulated_core::model::{JointInfo, Model};

use crate::states::{self, State};

/// A state, and the reason why it is hard; none for a random one.
#[derive(Clone, Debug)]
pub(super) struct Case {
    pub(super) state: State,
    pub(super) hard: Option<&'static str>,
}

/// A hard state's change of a random one.
type Change = fn(&Model<f64>, &mut State);

const HARD: [(&str, Change); 13] = [
    ("all coordinates zero", |m, s| angles(m, s, |_, _| 0.0)),
    ("lower limits", |m, s| angles(m, s, |j, _| j.limit.map_or(-1.0, |l| l.lower).max(-1e3))),
    ("upper limits", |m, s| angles(m, s, |j, _| j.limit.map_or(1.0, |l| l.upper).min(1e3))),
    ("right angles", |m, s| angles(m, s, |_, x| (x / std::f64::consts::FRAC_PI_2).round() * std::f64::consts::FRAC_PI_2)),
    ("angles of 1e-9", |m, s| angles(m, s, |_, x| x * 1e-9)),
    ("at rest", |_, s| times(s, &[Argument::V, Argument::A], 0.0)),
    ("rates a thousand times as large", |_, s| times(s, &[Argument::V], 1e3)),
    ("rates and accelerations of 1e-9", |_, s| times(s, &[Argument::V, Argument::A, Argument::Tau], 1e-9)),
    ("angles of 1e3", |m, s| angles(m, s, |j, x| far(j, x, 1e3))),
    ("angles of 9e4", |m, s| angles(m, s, |j, x| far(j, x, 9e4))),
    ("angles of 1e6", |m, s| angles(m, s, |j, x| far(j, x, 1e6))),
    ("angles of 1e15", |m, s| angles(m, s, |j, x| far(j, x, 1e15))),
    ("angles of 1e22", |m, s| angles(m, s, |j, x| far(j, x, 1e22))),
];

/// States at random, then the hard ones; all numbers such that `f32` has them too if `single`.
pub(super) fn cases(model: &Model<f64>, count: usize, seed: u64, single: bool) -> Vec<Case> {
    let plain = states::random(model, count, seed).into_iter().map(|state| Case { state, hard: None });
    let hard = states::random(model, HARD.len(), seed ^ 0xa5a5).into_iter().zip(HARD).map(|(mut state, (name, change))| {
        change(model, &mut state);
        Case { state, hard: Some(name) }
    });
    let mut cases: Vec<Case> = plain.chain(hard).collect();
    if single {
        cases.iter_mut().for_each(|case| round(&mut case.state));
    }
    cases
}

fn round(state: &mut State) {
    for argument in Argument::ALL {
        if let Some(x) = state.get(argument) {
            let rounded = x.iter().map(|x| f64::from(*x as f32)).collect();
            state.set(argument, rounded);
        }
    }
}

/// Changes the coordinates of joints that have one each.
fn angles(model: &Model<f64>, state: &mut State, change: impl Fn(&JointInfo, f64) -> f64) {
    let Some(mut q) = state.get(Argument::Q).map(<[f64]>::to_vec) else { return };
    for joint in model.joints().iter().filter(|j| j.q.1 == 1) {
        q[joint.q.0] = change(joint, q[joint.q.0]);
    }
    state.set(Argument::Q, q);
}

/// An angle of about this size, not a multiple of anything; a sliding joint stays.
fn far(joint: &JointInfo, x: f64, size: f64) -> f64 {
    if joint.kind.is_linear() { x } else { size * (1.0 + x / 16.0) }
}

fn times(state: &mut State, arguments: &[Argument], factor: f64) {
    for argument in arguments {
        if let Some(x) = state.get(*argument) {
            let scaled = x.iter().map(|x| x * factor).collect();
            state.set(*argument, scaled);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::robot::bundled_model;

    #[test]
    fn hard_states_come_after_the_others_and_are_numbers_of_single_precision_where_asked() {
        let model = bundled_model("panda_like");
        let all = cases(&model, 5, 3, true);
        assert_eq!((all.len(), all.iter().filter(|c| c.hard.is_some()).count()), (5 + HARD.len(), HARD.len()));
        assert!(all[..5].iter().all(|c| c.hard.is_none()));
        let q = |k: usize| all[k].state.get(Argument::Q).unwrap().to_vec();
        assert!(q(5).iter().all(|x| *x == 0.0) && q(17).iter().any(|x| x.abs() > 1e21));
        assert!((0..all.len()).all(|k| q(k).iter().all(|x| f64::from(*x as f32) == *x)));
    }
}
