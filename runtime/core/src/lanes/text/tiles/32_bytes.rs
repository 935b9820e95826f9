
/// How many numbers of a state go together where it has so many: 32 bytes.
pub(super) const WIDE: usize = 2 * TILE;

/// How many states at once.
pub(super) const STATES: usize = 2 * TILE;

lane_functions! {
    // 16 bytes of each `TILE`th state, from state `first` and number `at` on, side by side.
    fn beside<const N: usize>(states: &[[Real; N]; STATES], first: usize, at: usize) -> Register {
        with_upper::<1>(widened(half(piece(&states[first], at))), half(piece(&states[first + TILE], at)))
    }

    // The way back.
    fn apart<const N: usize>(x: Register, states: &mut [[Real; N]; STATES], first: usize, at: usize) {
        put_piece(flat_half(lower(x)), &mut states[first], at);
        put_piece(flat_half(upper::<1>(x)), &mut states[first + TILE], at);
    }

    fn half(x: [Real; TILE]) -> Half {
        // SAFETY: as many bytes on both sides, and any of them are numbers.
        unsafe { ::core::mem::transmute::<[Real; TILE], Half>(x) }
    }

    fn flat_half(x: Half) -> [Real; TILE] {
        // SAFETY: as many bytes on both sides, and any of them are numbers.
        unsafe { ::core::mem::transmute::<Half, [Real; TILE]>(x) }
    }

    // Numbers `at` and on of some states, a state a lane: 32 bytes of each.
    pub(super) fn wide_columns<const N: usize>(states: &[[Real; N]; STATES], at: usize) -> [[Real; STATES]; WIDE] {
        let mut rows = [[0.0; WIDE]; STATES];
        for (row, state) in rows.iter_mut().zip(states) {
            row.copy_from_slice(&state[at..at + WIDE]);
        }
        exchanged(&rows)
    }

    // The way back.
    pub(super) fn wide_rows<const N: usize>(columns: &[[Real; STATES]; WIDE], states: &mut [[Real; N]; STATES], at: usize) {
        for (row, state) in exchanged(columns).iter().zip(states) {
            state[at..at + WIDE].copy_from_slice(row);
        }
    }
}
