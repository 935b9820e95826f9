
lane_functions! {
    // Numbers `at` and `at + 1` of some states, a state a lane.
    pub(super) fn columns<const N: usize>(states: &[[Real; N]; STATES], at: usize) -> [[Real; STATES]; TILE] {
        let (even, odd) = (beside(states, 0, at), beside(states, 1, at));
        [flat(low(even, odd)), flat(high(even, odd))]
    }

    // The way back.
    pub(super) fn rows<const N: usize>([a, b]: &[[Real; STATES]; TILE], states: &mut [[Real; N]; STATES], at: usize) {
        let (a, b) = (register(*a), register(*b));
        apart(low(a, b), states, 0, at);
        apart(high(a, b), states, 1, at);
    }
}
