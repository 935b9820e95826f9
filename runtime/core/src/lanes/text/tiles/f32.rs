
lane_functions! {
    // Numbers `at` to `at + 3` of some states, a state a lane.
    pub(super) fn columns<const N: usize>(states: &[[Real; N]; STATES], at: usize) -> [[Real; STATES]; TILE] {
        let [a, b, c, d] = turned([beside(states, 0, at), beside(states, 1, at), beside(states, 2, at), beside(states, 3, at)]);
        [flat(a), flat(b), flat(c), flat(d)]
    }

    // The way back.
    pub(super) fn rows<const N: usize>([a, b, c, d]: &[[Real; STATES]; TILE], states: &mut [[Real; N]; STATES], at: usize) {
        let [a, b, c, d] = turned([register(*a), register(*b), register(*c), register(*d)]);
        apart(a, states, 0, at);
        apart(b, states, 1, at);
        apart(c, states, 2, at);
        apart(d, states, 3, at);
    }

    // Rows and columns of four times four numbers exchanged in each 16 bytes.
    fn turned([a, b, c, d]: [Register; TILE]) -> [Register; TILE] {
        let (ab, cd, ef, gh) = (low(a, b), low(c, d), high(a, b), high(c, d));
        [low_pairs(ab, cd), high_pairs(ab, cd), low_pairs(ef, gh), high_pairs(ef, gh)]
    }
}
