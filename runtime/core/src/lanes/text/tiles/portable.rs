
/// How many numbers of a state go together.
pub(super) const TILE: usize = 1;

/// As many as [`TILE`]: there are no wider ones.
pub(super) const WIDE: usize = TILE;

/// How many states at once.
pub(super) const STATES: usize = LANES;

lane_functions! {
    // Number `at` of some states, a state a lane.
    pub(super) fn columns<const N: usize>(states: &[[Real; N]; STATES], at: usize) -> [[Real; STATES]; TILE] {
        [each_lane!(i => states[i][at])]
    }

    // The way back.
    pub(super) fn rows<const N: usize>([x]: &[[Real; STATES]; TILE], states: &mut [[Real; N]; STATES], at: usize) {
        let _: [(); STATES] = each_lane!(i => states[i][at] = x[i]);
    }
}

#[inline(always)]
pub(super) fn wide_columns<const N: usize>(_: &[[Real; N]; STATES], _: usize) -> [[Real; STATES]; WIDE] {
    [[0.0; STATES]; WIDE]
}

#[inline(always)]
pub(super) fn wide_rows<const N: usize>(_: &[[Real; STATES]; WIDE], _: &mut [[Real; N]; STATES], _: usize) {}
