//! Control flow over any scalar: a body that runs until a mask holds, only if a mask holds, or for
//! each row of a table.
//!
//! [`Scalar`] has no order, so a body cannot branch on a value. These three are the only loops
//! whose length depends on one. Numbers run them; a symbol traces the body once and makes a region
//! of the generated code of it; a dual number differentiates them.

use alloc::vec;
use alloc::vec::Vec;

use crate::Scalar;

/// [`Scalar::repeat`] of scalars whose comparisons are known.
pub fn repeat_known<S: Scalar<Mask = bool>>(most: usize, state: &mut [S], mut body: impl FnMut(&mut [S]) -> bool) -> bool {
    (0..most).any(|_| body(state))
}

/// [`Scalar::repeat`] of any scalar: all turns, after which each value is chosen.
pub(crate) fn repeat_all<S: Scalar>(most: usize, state: &mut [S], mut body: impl FnMut(&mut [S]) -> S::Mask) -> S::Mask {
    let mut is_done = S::zero();
    for _ in 0..most {
        let before = state.to_vec();
        let ends = body(state);
        let done = is_done.positive();
        choose(done, &before, state);
        is_done = S::select(done, is_done, S::select(ends, S::one(), S::zero()));
    }
    is_done.positive()
}

/// [`Scalar::when`] of any scalar: the body runs, after which each value is chosen.
pub(crate) fn when_all<S: Scalar>(mask: S::Mask, state: &mut [S], body: impl FnOnce(&mut [S])) {
    let mut changed = state.to_vec();
    body(&mut changed);
    for (value, changed) in state.iter_mut().zip(changed) {
        *value = S::select(mask, changed, *value);
    }
}

/// [`Scalar::for_each`] of any scalar: the turns one after the other.
pub fn for_each_turn<S: Scalar>(
    turns: usize,
    table: &[S],
    state: &mut [S],
    results: &mut [S],
    mut body: impl FnMut(&[S], &mut [S], &mut [S]),
) {
    let [row, own] = widths(turns, table.len(), results.len());
    for turn in 0..turns {
        body(&table[turn * row..][..row], state, &mut results[turn * own..][..own]);
    }
}

/// The lengths of a row of a table and of the results of a turn.
///
/// # Panics
/// If the rows, or the results of the turns, do not have the same length.
pub fn widths(turns: usize, table: usize, results: usize) -> [usize; 2] {
    let of = |length: usize, what: &str| {
        assert!(length.is_multiple_of(turns.max(1)), "{what} of {length} values for {turns} turns: expected as many for each turn");
        length / turns.max(1)
    };
    [of(table, "a table"), of(results, "results")]
}

/// Each value of `new` where the mask holds as in `old`.
fn choose<S: Scalar>(mask: S::Mask, old: &[S], new: &mut [S]) {
    for (new, old) in new.iter_mut().zip(old) {
        *new = S::select(mask, *old, *new);
    }
}

/// Bits by which a value may change in the last turn of [`settled`].
const SPARE: u32 = 8;

/// Whether no value changed from `old` to `new`, but for roundings.
pub(crate) fn settled<S: Scalar>(old: &[S], new: &[S]) -> S::Mask {
    let tolerance = S::from_f64(crate::scalar::two_to(SPARE as i32 - S::BITS as i32));
    let mut moves = S::zero();
    for (old, new) in old.iter().zip(new) {
        let beyond = (*new - *old).abs() - tolerance * new.abs();
        moves = S::select(beyond.positive(), S::one(), moves);
    }
    (S::from_f64(0.5) - moves).positive()
}

/// The derivative of an iteration to a fixed point x = F(x, p), along dp: the fixed point of
/// dx = F_x dx + F_p dp, found by the same iteration (Christianson, "Reverse accumulation and
/// attractive fixed points", Optimization Methods and Software 3, 1994).
///
/// `along(dx)` replaces dx by F_x dx + F_p dp.
pub(crate) fn repeat_slopes<S: Scalar>(most: usize, slopes: &mut [S], mut along: impl FnMut(&mut [S])) {
    let _ = S::repeat(2 * most, slopes, |slopes| {
        let before: Vec<S> = slopes.to_vec();
        along(slopes);
        settled(&before, slopes)
    });
}

/// A state of zeros.
pub(crate) fn zeros<S: Scalar>(count: usize) -> Vec<S> {
    vec![S::zero(); count]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dual::Dual;
    use crate::running::Running;

    /// √a by Newton's iteration, x ← (x + a/x)/2.
    fn root<S: Scalar>(a: S) -> (S, S::Mask) {
        let mut x = [a];
        let converged = S::repeat(50, &mut x, |x| {
            let before = x[0];
            x[0] = S::from_f64(0.5) * (before + a / before);
            (S::from_f64(1e-12) * x[0] - (x[0] - before).abs()).positive()
        });
        (x[0], converged)
    }

    #[test]
    fn an_iteration_ends_where_its_mask_holds_or_at_the_bound() {
        let (x, converged) = root(2.0_f64);
        assert!(converged && (x - 2_f64.sqrt()).abs() < 1e-15);
        let mut count = [0.0_f64];
        assert!(!f64::repeat(7, &mut count, |count| {
            count[0] += 1.0;
            false
        }));
        assert_eq!(count, [7.0]);
        assert!(f64::repeat(7, &mut count, |count| {
            count[0] += 1.0;
            count[0] > 8.5
        }));
        assert_eq!(count, [9.0]);
        assert!(!f64::repeat(0, &mut count, |_| unreachable!()));
    }

    #[test]
    fn all_turns_with_a_choice_are_the_same() {
        let mut x = [2.0_f64];
        let newton = |x: &mut [f64]| {
            let before = x[0];
            x[0] = 0.5 * (before + 2.0 / before);
            (x[0] - before).abs() < 1e-6
        };
        let mut y = x;
        assert_eq!(repeat_all(50, &mut x, newton), repeat_known(50, &mut y, newton));
        assert_eq!(x, y);
        for mask in [true, false] {
            let (mut x, mut y) = ([1.0, 2.0], [1.0, 2.0]);
            when_all(mask, &mut x, |x: &mut [f64]| x[1] = 3.0 * x[0]);
            f64::when(mask, &mut y, |y| y[1] = 3.0 * y[0]);
            assert_eq!((x, y[1]), (y, if mask { 3.0 } else { 2.0 }));
        }
    }

    /// The first and second derivative of √a: of the fixed point, not of the turns.
    #[test]
    fn slopes_are_those_of_the_fixed_point() {
        for a in [0.3, 2.0, 50.0] {
            let (x, _) = root(Dual::new(Dual::variable(a), Dual::new(1.0, 0.0)));
            let exact = [a.sqrt(), 0.5 / a.sqrt(), -0.25 / (a * a.sqrt())];
            for (found, exact) in [x.value.value, x.value.slope, x.slope.slope].into_iter().zip(exact) {
                assert!((found - exact).abs() < 1e-14 * exact.abs(), "{found} {exact}");
            }
        }
    }

    #[test]
    fn an_iteration_is_bounded_where_its_end_is_certain() {
        let (x, _) = root(Running::<53, 0>::within(2.0, 0.0));
        assert!(x.error > 0.0 && x.error < 1e-14, "{x:?}");
        let mut x = [Running::<53, 0>::within(1.0, 0.5)];
        let _ = Scalar::repeat(5, &mut x, |x| (x[0] - Running::within(1.0, 0.0)).positive());
        assert_eq!(x[0].error, f64::INFINITY);
    }

    #[test]
    fn each_row_of_a_table_has_its_turn() {
        // Horner's scheme: 3 x² + 5 x + 7 with its partial sums.
        let (mut sum, mut sums) = ([0.0_f64], [0.0; 3]);
        f64::for_each(3, &[3.0, 5.0, 7.0], &mut sum, &mut sums, |row, sum, now| {
            sum[0] = sum[0] * 2.0 + row[0];
            now[0] = sum[0];
        });
        assert_eq!((sum, sums), ([29.0], [3.0, 11.0, 29.0]));
    }

    #[test]
    #[should_panic(expected = "a table of 4 values for 3 turns")]
    fn a_table_has_whole_rows() {
        f64::for_each(3, &[0.0; 4], &mut [], &mut [], |_, _, _| {});
    }
}
