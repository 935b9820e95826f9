//! States at random, the same for the same seed.

use articulated_core::algorithm::{Argument, Workspace, random_configuration};
use articulated_core::model::Model;

use super::State;

/// Rates, accelerations, torques, wrenches and steps lie in ± this.
const RATE: f64 = 2.0;

/// A small generator of pseudo-random numbers (Steele, Lea & Flood 2014).
#[derive(Clone, Debug)]
pub struct SplitMix64(u64);

impl SplitMix64 {
    /// From a seed.
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// 64 bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut x = self.0;
        x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        x ^ (x >> 31)
    }

    /// Uniform in [lower, upper).
    pub fn uniform(&mut self, lower: f64, upper: f64) -> f64 {
        // 53 bits: every multiple of 2⁻⁵³ in [0, 1)
        let unit = (self.bits() >> 11) as f64 / (1_u64 << 53) as f64;
        lower + (upper - lower) * unit
    }
}

/// `count` states: configurations as [`random_configuration`] makes them, numbers in [0, 1) where that is asked for, all else in ±2.
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
    state
}

fn configuration(model: &Model<f64>, workspace: &mut Workspace<f64>, uniform: &[f64]) -> Vec<f64> {
    let mut q = vec![0.0; model.nq];
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
    fn the_generator_gives_its_published_numbers() {
        let mut numbers = SplitMix64::new(1_234_567);
        assert_eq!([numbers.bits(), numbers.bits()], [6_457_827_717_110_365_317, 3_203_168_211_198_807_973]);
    }

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
            assert_eq!(state.get(Argument::Wrenches).map(<[f64]>::len), Some(6 * model.frames.len()));
            assert_ne!(state.get(Argument::Target), Some(q));
            for joint in model.joints.iter().filter(|j| j.q.1 == 1) {
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
