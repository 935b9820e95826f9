//! Cycles in a forest of back references: links to their parents, mimic joints to their leaders.

use std::iter;

/// One member of each cycle among `count` nodes; `on` is the node that a node refers to. Walks from
/// each node along `on`; a walk that meets itself has found a cycle.
pub(crate) fn cycles(count: usize, on: impl Fn(usize) -> Option<usize>) -> Vec<usize> {
    let (mut walk_of, mut cycles) = (vec![usize::MAX; count], Vec::new());
    for start in 0..count {
        let mut next = Some(start);
        while let Some(here) = next.filter(|here| walk_of[*here] == usize::MAX) {
            walk_of[here] = start;
            next = on(here);
        }
        cycles.extend(next.filter(|here| walk_of[*here] == start));
    }
    cycles
}

/// All members of the ring, from this one on.
pub(crate) fn around(start: usize, on: impl Fn(usize) -> Option<usize>) -> impl Iterator<Item = usize> {
    iter::successors(Some(start), move |here| on(*here).filter(|next| *next != start))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_ring_is_found_once() {
        let hangs = [Some(1), Some(2), Some(0), Some(0), None, Some(5)];
        let on = |k: usize| hangs[k];
        assert_eq!(cycles(hangs.len(), on), [0, 5]);
        assert_eq!([0, 5].map(|k| around(k, on).collect::<Vec<_>>()), [vec![0, 1, 2], vec![5]]);
    }
}
