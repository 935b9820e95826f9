//! Pseudo-random numbers: the same for the same seed, on every machine.

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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_generator_gives_its_published_numbers() {
        let mut numbers = SplitMix64::new(1_234_567);
        assert_eq!([numbers.bits(), numbers.bits()], [6_457_827_717_110_365_317, 3_203_168_211_198_807_973]);
    }
}
