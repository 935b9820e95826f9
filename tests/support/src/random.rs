//! Pseudo-random numbers: the same for the same seed, on every machine.

use articulated_reference::SplitMix64;

/// The command's generator, with additions for random trees.
#[derive(Clone, Debug)]
pub struct Random(SplitMix64);

impl Random {
    /// From a seed.
    pub fn new(seed: u64) -> Self {
        // Neighbouring seeds must not give neighbouring numbers.
        Self(SplitMix64::new(SplitMix64::new(seed).bits()))
    }

    /// 64 bits.
    pub fn bits(&mut self) -> u64 {
        self.0.bits()
    }

    /// Uniform in [lower, upper).
    pub fn within(&mut self, lower: f64, upper: f64) -> f64 {
        self.0.uniform(lower, upper)
    }

    /// Below `n`.
    ///
    /// # Panics
    /// If `n` is 0.
    pub fn below(&mut self, n: usize) -> usize {
        usize::try_from(self.bits() % u64::try_from(n).expect("a usize")).expect("less than n")
    }

    /// True with this probability.
    pub fn chance(&mut self, probability: f64) -> bool {
        self.within(0.0, 1.0) < probability
    }

    /// One of several.
    pub fn choose<'a, T>(&mut self, from: &'a [T]) -> &'a T {
        &from[self.below(from.len())]
    }

    /// Several uniform numbers in [lower, upper).
    pub fn vector(&mut self, n: usize, lower: f64, upper: f64) -> Vec<f64> {
        (0..n).map(|_| self.within(lower, upper)).collect()
    }

    /// Three uniform numbers in ±`most`.
    pub fn three(&mut self, most: f64) -> [f64; 3] {
        [(); 3].map(|()| self.within(-most, most))
    }

    /// A direction, or for that matter a quaternion: N numbers with a norm of 1.
    pub fn unit<const N: usize>(&mut self) -> [f64; N] {
        loop {
            let x = [(); N].map(|()| self.within(-1.0, 1.0));
            let norm = x.iter().map(|c| c * c).sum::<f64>().sqrt();
            if norm > 0.1 {
                return x.map(|c| c / norm);
            }
        }
    }

    /// The same things in another order.
    pub fn shuffle<T>(&mut self, things: &mut [T]) {
        for i in (1..things.len()).rev() {
            things.swap(i, self.below(i + 1));
        }
    }
}
