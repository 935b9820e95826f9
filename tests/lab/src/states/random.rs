//! States at random, the same for the same seed.

use articulated_core::algorithm::{Argument, Workspace, random_configuration};
use articulated_core::model::Model;
use articulated_core::step::{ACT, CTRL};
use articulated_reference::SplitMix64;

use super::State;

/// Rates, accelerations, torques, wrenches and steps lie in ± this.
const RATE: f64 = 2.0;

/// `count` states: configurations by [`random_configuration`], numbers in [0, 1) for arguments that
/// require it, controls and activations within their bounds (±1 where there are none), all others
/// in ±2.
pub fn random(model: &Model<f64>, count: usize, seed: u64) -> Vec<State> {
    let mut numbers = SplitMix64::new(seed);
    let mut workspace = Workspace::new(model);
    (0..count).map(|_| one(model, &mut workspace, &mut numbers)).collect()
}

fn one(model: &Model<f64>, workspace: &mut Workspace<f64>, numbers: &mut SplitMix64) -> State {
    let mut state = State::default();
    for argument in Argument::ALL {
        let length = argument.len(model.shape());
        let mut draw = |lower, upper| (0..length).map(|_| numbers.uniform(lower, upper)).collect::<Vec<_>>();
        let vector = match argument {
            Argument::Q | Argument::Target => configuration(model, workspace, &draw(0.0, 1.0)),
            Argument::Uniform => draw(0.0, 1.0),
            _ => draw(-RATE, RATE),
        };
        state.set(argument, vector);
    }
    let laws = &model.actuators().laws;
    let within = |numbers: &mut SplitMix64, range: Option<[f64; 2]>| {
        let [lower, upper] = range.unwrap_or([-1.0, 1.0]);
        numbers.uniform(lower, upper)
    };
    state.set(CTRL, laws.iter().map(|law| within(numbers, law.control_range)).collect());
    let activations = laws.iter().filter_map(|law| law.activation.as_ref());
    state.set(ACT, activations.map(|activation| within(numbers, activation.range)).collect());
    state
}

fn configuration(model: &Model<f64>, workspace: &mut Workspace<f64>, uniform: &[f64]) -> Vec<f64> {
    let mut q = vec![0.0; model.nq()];
    random_configuration(model, workspace, uniform, &mut q);
    q
}

/// Divides by the norm; zero becomes (…, 1).
pub(super) fn normalise(quaternion: &mut [f64]) {
    let norm = quaternion.iter().map(|x| x * x).sum::<f64>().sqrt();
    match norm {
        0.0 => quaternion[3] = 1.0,
        _ => quaternion.iter_mut().for_each(|x| *x /= norm),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::robot::bundled_model;

    #[test]
    fn states_keep_to_the_limits_and_to_the_seed() {
        let model = bundled_model("humanoid");
        let states = random(&model, 20, 7);
        assert_eq!(states, random(&model, 20, 7));
        assert_ne!(states, random(&model, 20, 8));
        for state in &states {
            let q = state.get(Argument::Q).unwrap();
            assert!((q[3..7].iter().map(|x| x * x).sum::<f64>() - 1.0).abs() < 1e-15);
            assert!(state.get(Argument::Uniform).unwrap().iter().all(|x| (0.0..1.0).contains(x)));
            assert_eq!(state.get(Argument::Wrenches).map(<[f64]>::len), Some(6 * model.frames().len()));
            assert_ne!(state.get(Argument::Target), Some(q));
            for joint in model.joints().iter().filter(|j| j.q.1 == 1) {
                let limit = joint.limit.unwrap();
                assert!((limit.lower..=limit.upper).contains(&q[joint.q.0]), "{}", joint.name);
            }
        }
    }

    #[test]
    fn a_quaternion_of_zeros_does_not_turn() {
        let normal = |mut q: [f64; 4]| {
            normalise(&mut q);
            q
        };
        assert_eq!([normal([0.0; 4]), normal([0.0, 3.0, 0.0, 4.0])], [[0.0, 0.0, 0.0, 1.0], [0.0, 0.6, 0.0, 0.8]]);
    }
}
