//! Index of a node in its graph: open addressing with a fixed hash. Generators run unoptimised,
//! where a map of the standard library costs five times as much. No order depends on it.

use super::Node;

/// Hash table of node indices into a list that the graph holds.
#[derive(Clone, Debug, Default)]
pub(super) struct Places {
    /// Places plus one; 0 is free. The length is a power of two, and at most half of them are
    /// taken.
    slots: Vec<u32>,
    taken: usize,
}

impl Places {
    /// The place of `node` in `nodes`.
    pub(super) fn find(&self, nodes: &[Node], node: &Node) -> Option<u32> {
        if self.slots.is_empty() {
            return None;
        }
        let slot = self.slots[self.slot(nodes, node)];
        slot.checked_sub(1)
    }

    /// The place of `node`; `next` if it is now inserted there.
    pub(super) fn find_or_insert(&mut self, nodes: &[Node], node: &Node, next: u32) -> u32 {
        if self.taken * 2 >= self.slots.len() {
            self.grow(nodes);
        }
        let slot = self.slot(nodes, node);
        match self.slots[slot] {
            0 => {
                self.slots[slot] = next + 1;
                self.taken += 1;
                next
            }
            place => place - 1,
        }
    }

    /// The slot that holds the node, or that it would take.
    fn slot(&self, nodes: &[Node], node: &Node) -> usize {
        let mask = self.slots.len() - 1;
        let mut at = hash(node) & mask;
        loop {
            let place = self.slots[at];
            if place == 0 || same(&nodes[place as usize - 1], node) {
                return at;
            }
            at = (at + 1) & mask;
        }
    }

    /// Room for this many nodes before it grows.
    pub(super) fn with_room(nodes: usize) -> Self {
        Self { slots: vec![0; (2 * nodes + 1).next_power_of_two().max(64)], taken: 0 }
    }

    /// Doubles the room. `nodes` are the inserted nodes, each once and in this order, so that they
    /// need not be compared.
    fn grow(&mut self, nodes: &[Node]) {
        self.slots = vec![0; (self.slots.len() * 2).max(64)];
        let mask = self.slots.len() - 1;
        for (place, node) in nodes.iter().enumerate() {
            let mut at = hash(node) & mask;
            while self.slots[at] != 0 {
                at = (at + 1) & mask;
            }
            self.slots[at] = place as u32 + 1;
        }
    }
}

fn same(a: &Node, b: &Node) -> bool {
    a.op as u8 == b.op as u8 && a.args[0] == b.args[0] && a.args[1] == b.args[1] && a.args[2] == b.args[2]
}

/// Multiply and shift over the words of a node.
fn hash(node: &Node) -> usize {
    let [a, b, c] = node.args;
    let mut x = ((a as u64) << 32 | b as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    x ^= x >> 29;
    x = (x ^ ((c as u64) << 8 | node.op as u64)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    (x ^ (x >> 32)) as usize
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::graph::Op;

    #[test]
    fn every_node_is_found_where_it_was_put_and_no_other_is() {
        let mut nodes: Vec<Node> = Vec::new();
        let mut places = Places::default();
        let node = |k: u32| Node { op: if k.is_multiple_of(2) { Op::Add } else { Op::Sub }, args: [k / 7, k % 7, k % 3] };
        for k in 0..5000 {
            assert_eq!(places.find(&nodes, &node(k)), None);
            assert_eq!(places.find_or_insert(&nodes, &node(k), k), k);
            nodes.push(node(k));
        }
        for k in 0..5000 {
            assert_eq!(places.find(&nodes, &node(k)), Some(k));
            assert_eq!(places.find_or_insert(&nodes, &node(k), 9999), k);
        }
        let mut roomy = Places::with_room(5000);
        let slots = roomy.slots.len();
        nodes.iter().enumerate().for_each(|(k, node)| assert_eq!(roomy.find_or_insert(&nodes, node, k as u32), k as u32));
        assert_eq!(roomy.slots.len(), slots);
    }
}
