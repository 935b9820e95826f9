
/// How many numbers of a state go together: 16 bytes.
pub(super) const TILE: usize = 16 / ::core::mem::size_of::<Real>();

/// `TILE` numbers of a state from number `at` on; zeros where it has fewer.
#[inline(always)]
fn piece<const N: usize>(state: &[Real; N], at: usize) -> [Real; TILE] {
    let mut piece = [0.0; TILE];
    if N < TILE {
        piece[..N].copy_from_slice(state);
    } else {
        piece.copy_from_slice(&state[at..at + TILE]);
    }
    piece
}

/// Puts the piece back.
#[inline(always)]
fn put_piece<const N: usize>(piece: [Real; TILE], state: &mut [Real; N], at: usize) {
    if N < TILE {
        state.copy_from_slice(&piece[..N]);
    } else {
        state[at..at + TILE].copy_from_slice(&piece);
    }
}
