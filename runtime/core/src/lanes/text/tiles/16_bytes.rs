
/// As many as [`TILE`]: there are no wider ones.
pub(super) const WIDE: usize = TILE;

/// How many states at once.
pub(super) const STATES: usize = TILE;

lane_functions! {
    // 16 bytes of each `TILE`th state, from state `first` and number `at` on, side by side.
    fn beside<const N: usize>(states: &[[Real; N]; STATES], first: usize, at: usize) -> Register {
        register(piece(&states[first], at))
    }

    // The way back.
    fn apart<const N: usize>(x: Register, states: &mut [[Real; N]; STATES], first: usize, at: usize) {
        put_piece(flat(x), &mut states[first], at);
    }
}

#[inline(always)]
pub(super) fn wide_columns<const N: usize>(_: &[[Real; N]; STATES], _: usize) -> [[Real; STATES]; WIDE] {
    [[0.0; STATES]; WIDE]
}

#[inline(always)]
pub(super) fn wide_rows<const N: usize>(_: &[[Real; STATES]; WIDE], _: &mut [[Real; N]; STATES], _: usize) {}
