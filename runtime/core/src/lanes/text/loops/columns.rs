type Matrix = [[f64; NV]; NV];

/// Matrices that are solved for at once, side by side: rows of `ROW` vectors of `LANES` columns.
#[repr(align(64))]
struct Block<const LANES: usize, const ROW: usize>([[[f64; LANES]; ROW]; NV]);

impl<const LANES: usize, const ROW: usize> Block<LANES, ROW> {
    /// −B, and for the last of three the unit matrix.
    #[inline]
    fn take(&mut self, first: usize, b: &[Matrix]) {
        let vectors = NV.div_ceil(LANES);
        for (m, b) in b.iter().enumerate() {
            for i in 0..NV {
                let x = self.0[i][m * vectors..][..vectors].as_flattened_mut();
                if first + m == 2 {
                    x.fill(0.0);
                    x[i] = 1.0;
                    continue;
                }
                for (x, b) in x.iter_mut().zip(&b[i]) {
                    *x = -b;
                }
            }
        }
    }

    #[inline]
    fn give(&self, x: &mut [Matrix]) {
        let vectors = NV.div_ceil(LANES);
        for (m, x) in x.iter_mut().enumerate() {
            for (to, from) in x.iter_mut().zip(&self.0) {
                to.copy_from_slice(&from[m * vectors..][..vectors].as_flattened()[..NV]);
            }
        }
    }
}

/// In vectors of so many columns, for so many matrices at once.
macro_rules! solve {
    ($lanes:literal, $together:expr; $(#[$features:meta])?) => {
        const ROW: usize = $together * NV.div_ceil($lanes);

        $(#[$features])?
        fn solve(b: &mut [Matrix; 3]) {
            let mut block = Block([[[0.0; $lanes]; ROW]; NV]);
            for first in (0..3).step_by($together) {
                block.take(first, &b[first..first + $together]);
                // The factors stay until the last matrix is given.
                let (x, l) = (&mut block.0, &b[2]);
                // L⁻ᵀ, from the tips to the base.
                for i in (0..NV).rev() {
                    let mut row = [k(0.0); ROW];
                    for b in 0..ROW {
                        row[b] = load(&x[i][b]);
                    }
                    for &j in BEYOND[i] {
                        let (factor, other) = (k(l[j as usize][i]), &x[j as usize]);
                        for b in 0..ROW {
                            row[b] = fnmadd(factor, load(&other[b]), row[b]);
                        }
                    }
                    for b in 0..ROW {
                        store(row[b], &mut x[i][b]);
                    }
                }
                // L⁻¹ D⁻¹, from the base to the tips.
                for i in 0..NV {
                    let (factor, mut row) = (k(l[i][i]), [k(0.0); ROW]);
                    for b in 0..ROW {
                        row[b] = mul(factor, load(&x[i][b]));
                    }
                    for &j in BEFORE[i] {
                        let (factor, other) = (k(l[i][j as usize]), &x[j as usize]);
                        for b in 0..ROW {
                            row[b] = fnmadd(factor, load(&other[b]), row[b]);
                        }
                    }
                    for b in 0..ROW {
                        store(row[b], &mut x[i][b]);
                    }
                }
                block.give(&mut b[first..first + $together]);
            }
        }
    };
}

/// −M⁻¹ B in the place of both B, and M⁻¹ in that of the factors of M = Lᵀ D L: the third matrix
/// has L below the diagonal and D⁻¹ on it.
pub(super) fn columns(b: &mut [Matrix; 3]) {
    // Processors with AVX-512 whose clock does not slow down for it: Ice Lake and Zen 4, and what
    // came after.
    #[cfg(all(target_arch = "x86_64", target_feature = "avx512dq", target_feature = "avx512vl", target_feature = "avx512vbmi2"))]
    {
        use super::avx512_f64x8::*;
        solve!(8, TOGETHER[1]; #[target_feature(enable = "avx512f,avx512dq,avx2,fma")]);
        // SAFETY: this is compiled for processors with all of it.
        return unsafe { solve(b) };
    }
    #[cfg(all(target_arch = "x86_64", not(all(target_feature = "avx512dq", target_feature = "avx512vl", target_feature = "avx512vbmi2"))))]
    {
        use super::avx2_f64x4::*;
        solve!(4, TOGETHER[0]; #[target_feature(enable = "avx2,fma")]);
        #[cfg(all(target_arch = "x86_64", not(all(target_feature = "avx2", target_feature = "fma"))))]
        if ::std::is_x86_feature_detected!("avx2") && ::std::is_x86_feature_detected!("fma") {
            // SAFETY: the processor was just asked for both.
            return unsafe { solve(b) };
        }
        #[cfg(all(target_feature = "avx2", target_feature = "fma"))]
        // SAFETY: this is compiled for processors with both.
        return unsafe { solve(b) };
    }
    #[cfg(target_arch = "aarch64")]
    {
        use super::neon_f64x4::*;
        solve!(4, TOGETHER[0]; #[target_feature(enable = "neon")]);
        // SAFETY: every 64-bit Arm processor has it.
        return unsafe { solve(b) };
    }
    #[cfg(not(any(target_arch = "aarch64", all(target_arch = "x86_64", target_feature = "avx2", target_feature = "fma"))))]
    {
        use super::portable_f64x4::*;
        solve!(4, TOGETHER[0];);
        solve(b)
    }
}
