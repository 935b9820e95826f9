//! M X = B for all columns: generated code agrees with the loop at run time, on trees of every
//! shape.

use std::sync::LazyLock;

#[cfg(target_arch = "aarch64")]
use super::super::neon_f64x4;
use super::super::portable_f64x4;
#[cfg(target_arch = "x86_64")]
#[allow(unused_imports, reason = "one or the other, as the processor has it")]
use super::super::{avx2_f64x4, avx512_f64x8};
use crate::algorithm::ltdl::{path_to_root, solve_rows};

/// Rows of numbers.
type Table = Vec<&'static [u16]>;

/// M, B and X in whole numbers and halves, too small to be rounded: every order of the sums and
/// every instruction set gives the same.
struct Sample {
    /// `[nv]`, next joint to the base, from 1; 0 at the base.
    parent_dof: Vec<usize>,
    /// `[nv][nv]`, L below the diagonal, D⁻¹ on it.
    l: Vec<f64>,
    /// `[3][nv][nv]`, the third the unit matrix.
    b: Vec<f64>,
    /// `[3][nv][nv]`, of −B for the first two.
    x: Vec<f64>,
}

impl Sample {
    /// The parent of each joint is one of the `near` before it, the base being before the first.
    fn random(nv: usize, near: usize) -> Self {
        let mut random = random((100 * nv + near) as u64);
        let parent_dof: Vec<usize> = (0..nv).map(|k| k - random(near.min(k + 1))).collect();
        let mut l = vec![f64::NAN; nv * nv];
        for k in 0..nv {
            l[k * nv + k] = [0.5, 1.0, 2.0, -3.0][random(4)];
            path_to_root(&parent_dof, k).for_each(|i| l[k * nv + i] = [-2.0, -1.0, 1.0, 2.0][random(4)]);
        }
        let mut b: Vec<f64> = (0..2 * nv * nv).map(|_| random(19) as f64 - 9.0).collect();
        b.extend((0..nv * nv).map(|at| f64::from(at / nv == at % nv)));
        let mut x = b.clone();
        x[..2 * nv * nv].iter_mut().for_each(|x| *x = -*x);
        x.chunks_mut(nv * nv).for_each(|x| solve_rows(&l, &parent_dof, x));
        assert!(x.iter().all(|x| x.abs() < 2_f64.powi(48)), "numbers so large could be rounded");
        Self { parent_dof, l, b, x }
    }

    /// Numbers of L: for each row their columns, and for each column their rows.
    fn tables(&self) -> [Table; 2] {
        let mut tables = [(); 2].map(|()| vec![Vec::new(); self.parent_dof.len()]);
        for (k, i) in (0..self.parent_dof.len()).flat_map(|k| path_to_root(&self.parent_dof, k).map(move |i| (k, i))) {
            tables[0][k].push(i as u16);
            tables[1][i].push(k as u16);
        }
        tables.map(|table| table.into_iter().map(|row| &*row.leak()).collect())
    }
}

/// Whole numbers below a bound; Knuth's constants, TAOCP 2, 3.3.4.
fn random(mut state: u64) -> impl FnMut(usize) -> usize {
    move |bound| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % bound
    }
}

/// The text with a tree of `$nv` joints, the parent of each being one of the `$near` before it,
/// solved for `$together` matrices at once.
macro_rules! columns {
    ($($name:ident: $nv:literal, $near:literal, $together:expr;)+) => { $(
        #[allow(unsafe_code, unused_imports, unused_unsafe, clippy::all, clippy::pedantic)]
        mod $name {
            use super::{LazyLock, Sample, Table};

            const NV: usize = $nv;
            const TOGETHER: [usize; 2] = $together;

            static SAMPLE: LazyLock<Sample> = LazyLock::new(|| Sample::random(NV, $near));
            static BEFORE: LazyLock<Table> = LazyLock::new(|| SAMPLE.tables()[0].clone());
            static BEYOND: LazyLock<Table> = LazyLock::new(|| SAMPLE.tables()[1].clone());

            include!("../text/loops/columns.rs");

            #[test]
            fn columns_in_vectors_solve_as_rows_one_by_one() {
                let mut x = [[[f64::NAN; NV]; NV]; 3];
                let given = [&SAMPLE.b[..2 * NV * NV], &SAMPLE.l].concat();
                x.as_flattened_mut().as_flattened_mut().copy_from_slice(&given);
                let mut portable = x;
                columns(&mut x);
                assert_eq!(x.as_flattened().as_flattened(), SAMPLE.x);

                // With AVX2 alone: what this is compiled for may have more.
                #[cfg(target_arch = "x86_64")]
                if is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma") {
                    use super::avx2_f64x4::*;
                    solve!(4, TOGETHER[0]; #[target_feature(enable = "avx2,fma")]);
                    let mut in_fours = portable;
                    // SAFETY: the processor was just asked for both.
                    unsafe { solve(&mut in_fours) };
                    assert_eq!(in_fours, x);
                }
                // The code for processors without such vectors.
                use super::portable_f64x4::*;
                solve!(4, TOGETHER[0];);
                solve(&mut portable);
                assert_eq!(portable, x);
            }
        }
    )+ };
}

columns! {
    one: 1, 1, [3, 3];
    five: 5, 5, [3, 1];
    chain: 10, 1, [3, 3];
    ten: 10, 4, [3, 1];
    full_vectors: 12, 3, [3, 3];
    legs: 18, 5, [3, 3];
    wide: 20, 20, [3, 1];
    one_by_one: 21, 6, [1, 3];
    full_vectors_of_eight: 24, 7, [1, 3];
    one_by_one_in_full_vectors: 32, 12, [1, 1];
}
