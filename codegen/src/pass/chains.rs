//! How to add up terms that become known at different times.

/// When a term is known, in cycles, and whether it is a product that a multiply-add can take in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Known {
    pub(super) at: u32,
    pub(super) fused: bool,
}

/// Cycles that an addition, a multiplication or a multiply-add takes.
const STEP: u32 = 4;

/// Chains to add up one after the other and then together, as indices of terms. Of the plans whose
/// sum is known when it is `due`, in cycles, the one with the fewest instructions; if none is in
/// time, the earliest. `terms` are sorted by the time they are known.
pub(super) fn plan(terms: &[Known], due: u32) -> Vec<Vec<usize>> {
    let single = vec![first_plain(terms)];
    // Nothing takes fewer instructions.
    if finish(terms, &single) <= due {
        return single;
    }
    let candidates = [single, split(terms, 1), split(terms, 2), split(terms, 3)];
    let price = |chains: &Vec<Vec<usize>>| (finish(terms, chains).max(due), instructions(terms, chains));
    candidates.into_iter().min_by_key(price).unwrap_or_default()
}

/// One chain in the order of time, but from the first plain term on: no instruction is wasted.
fn first_plain(terms: &[Known]) -> Vec<usize> {
    let first = terms.iter().position(|t| !t.fused).unwrap_or(0);
    std::iter::once(first).chain((0..terms.len()).filter(|&k| k != first)).collect()
}

/// Each term, in the order of time, to the chain that can take it first.
fn split(terms: &[Known], n: usize) -> Vec<Vec<usize>> {
    let mut chains = vec![Vec::new(); n];
    let mut ready = vec![0; n];
    for (k, term) in terms.iter().enumerate() {
        let next = (0..n).min_by_key(|&c| (step(ready[c], *term, chains[c].is_empty()), c)).unwrap_or(0);
        ready[next] = step(ready[next], *term, chains[next].is_empty());
        chains[next].push(k);
    }
    chains.retain(|c| !c.is_empty());
    chains.sort_by_key(|c| chain_finish(terms, c));
    chains
}

/// When a chain that is ready at `ready` has taken the term in.
fn step(ready: u32, term: Known, first: bool) -> u32 {
    if first { term.at + if term.fused { STEP } else { 0 } } else { ready.max(term.at) + STEP }
}

fn chain_finish(terms: &[Known], chain: &[usize]) -> u32 {
    chain.iter().enumerate().fold(0, |ready, (place, &k)| step(ready, terms[k], place == 0))
}

/// When the sum of all chains is known; they are added in their order.
fn finish(terms: &[Known], chains: &[Vec<usize>]) -> u32 {
    let mut times = chains.iter().map(|c| chain_finish(terms, c));
    let first = times.next().unwrap_or(0);
    times.fold(first, |sum, time| sum.max(time) + STEP)
}

/// Each chain starts with a product, or is itself a term of the sum of chains: one instruction a
/// term, less one for each chain that starts with a plain term, and one for each joint between
/// chains.
fn instructions(terms: &[Known], chains: &[Vec<usize>]) -> u32 {
    let starts = chains.iter().filter(|c| c.first().is_some_and(|&k| !terms[k].fused)).count();
    (terms.len() + chains.len() - 1 - starts) as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    fn product(at: u32) -> Known {
        Known { at, fused: true }
    }

    fn plain(at: u32) -> Known {
        Known { at, fused: false }
    }

    #[test]
    fn a_late_plain_term_comes_last() {
        let terms = [product(0), product(0), product(0), product(0), plain(100)];
        let chains = plan(&terms, 0);
        assert_eq!(finish(&terms, &chains), 104);
        assert_eq!(instructions(&terms, &chains), 5);
    }

    #[test]
    fn a_sum_that_has_time_is_one_chain() {
        let terms = [product(0), product(0), product(0), product(0), plain(100)];
        assert_eq!(plan(&terms, 120), [[4, 0, 1, 2, 3]]);
        assert_eq!(finish(&terms, &plan(&terms, 120)), 116);
    }

    #[test]
    fn a_plain_term_in_time_is_where_the_chain_starts() {
        let terms = [product(0), plain(0), product(8), product(12)];
        assert_eq!(plan(&terms, 0), [[1, 0, 2, 3]]);
    }

    #[test]
    fn many_terms_at_once_are_added_in_parallel() {
        let terms = [product(0); 12];
        let chains = plan(&terms, 0);
        assert!(chains.len() > 1);
        assert!(finish(&terms, &chains) <= 32);
        let mut all: Vec<usize> = chains.into_iter().flatten().collect();
        all.sort_unstable();
        assert_eq!(all, (0..12).collect::<Vec<_>>());
    }
}
