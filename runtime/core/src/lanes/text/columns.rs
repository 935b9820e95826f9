/// What is solved: B in vectors of four columns, D⁻¹, and L row by row.
#[repr(align(64))]
pub(super) struct Unsolved {
    pub(super) x: [[[[f64; 4]; TOGETHER * VECTORS]; NV]; 3 / TOGETHER],
    pub(super) d: [f64; NV],
    pub(super) l: [f64; ENTRIES],
}

impl Unsolved {
    /// Zeros, and the unit matrix for the third B.
    #[inline]
    pub(super) fn new() -> Self {
        let mut new = Self { x: [[[[0.0; 4]; TOGETHER * VECTORS]; NV]; 3 / TOGETHER], d: [0.0; NV], l: [0.0; ENTRIES] };
        let last = &mut new.x[3 / TOGETHER - 1];
        for i in 0..NV {
            last[i][(TOGETHER - 1) * VECTORS + i / 4][i % 4] = 1.0;
        }
        new
    }
}

macro_rules! solve {
    ($(#[$features:meta])?) => {
        $(#[$features])?
        fn solve(unsolved: &mut Unsolved) {
            let Unsolved { x, d, l } = unsolved;
            for x in x {
                // L⁻ᵀ, from the tips to the base.
                for i in (0..NV).rev() {
                    let mut row = [k(0.0); TOGETHER * VECTORS];
                    for b in 0..TOGETHER * VECTORS {
                        row[b] = load(&x[i][b]);
                    }
                    for &(j, at) in BEYOND[i] {
                        let (factor, other) = (k(l[at as usize]), &x[j as usize]);
                        for b in 0..TOGETHER * VECTORS {
                            row[b] = fnmadd(factor, load(&other[b]), row[b]);
                        }
                    }
                    for b in 0..TOGETHER * VECTORS {
                        store(row[b], &mut x[i][b]);
                    }
                }
                // L⁻¹ D⁻¹, from the base to the tips.
                for i in 0..NV {
                    let (factor, mut row) = (k(d[i]), [k(0.0); TOGETHER * VECTORS]);
                    for b in 0..TOGETHER * VECTORS {
                        row[b] = mul(factor, load(&x[i][b]));
                    }
                    for &(j, at) in BEFORE[i] {
                        let (factor, other) = (k(l[at as usize]), &x[j as usize]);
                        for b in 0..TOGETHER * VECTORS {
                            row[b] = fnmadd(factor, load(&other[b]), row[b]);
                        }
                    }
                    for b in 0..TOGETHER * VECTORS {
                        store(row[b], &mut x[i][b]);
                    }
                }
            }
        }
    };
}

/// X = M⁻¹ B of all three.
pub(super) fn columns(unsolved: &mut Unsolved, out: &mut [[[f64; NV]; NV]; 3]) {
    solve(unsolved);
    for (x, out) in unsolved.x.iter().zip(out.chunks_exact_mut(TOGETHER)) {
        for (m, out) in out.iter_mut().enumerate() {
            for (x, out) in x.iter().zip(out) {
                out.copy_from_slice(&x[m * VECTORS..][..VECTORS].as_flattened()[..NV]);
            }
        }
    }
}

fn solve(unsolved: &mut Unsolved) {
    #[cfg(target_arch = "x86_64")]
    {
        use super::avx2_f64x4::*;
        solve!(#[target_feature(enable = "avx2,fma")]);
        #[cfg(all(target_arch = "x86_64", not(all(target_feature = "avx2", target_feature = "fma"))))]
        if ::std::is_x86_feature_detected!("avx2") && ::std::is_x86_feature_detected!("fma") {
            // SAFETY: the processor was just asked for both.
            return unsafe { solve(unsolved) };
        }
        #[cfg(all(target_feature = "avx2", target_feature = "fma"))]
        // SAFETY: this is compiled for processors with both.
        return unsafe { solve(unsolved) };
    }
    #[cfg(target_arch = "aarch64")]
    {
        use super::neon_f64x4::*;
        solve!(#[target_feature(enable = "neon")]);
        // SAFETY: every 64-bit Arm processor has it.
        return unsafe { solve(unsolved) };
    }
    #[cfg(not(any(target_arch = "aarch64", all(target_arch = "x86_64", target_feature = "avx2", target_feature = "fma"))))]
    {
        use super::portable_f64x4::*;
        solve!();
        solve(unsolved)
    }
}
