
/// Bits of a lane.
const BITS: u32 = 8 * ::core::mem::size_of::<Real>() as u32;

lane_functions! {
    pub(super) fn positive(x: V) -> M {
        compare::<GREATER>(x, k(0.0))
    }

    pub(super) fn select(m: M, a: V, b: V) -> V {
        blend(m, b, a)
    }

    fn within(x: V, limit: V) -> bool {
        compare::<NOT_AT_MOST>(abs(x), limit) == 0
    }

    fn turn(quadrant: V, sin: V, cos: V) -> (V, V) {
        let quadrant = bits(quadrant);
        let odd = test(quadrant, integer(1));
        let sign = and(real(shift::<{ BITS - 2 }>(quadrant)), k(-0.0));
        (xor(select(odd, cos, sin), sign), xor(mask_xor(cos, odd, sin, k(-0.0)), sign))
    }
}

use self::fused as polynomials;
