
/// Bits of a lane.
const BITS: i32 = 8 * ::core::mem::size_of::<Real>() as i32;

lane_functions! {
    pub(super) fn positive(x: V) -> M {
        compare::<GREATER>(x, k(0.0))
    }

    pub(super) fn select(m: M, a: V, b: V) -> V {
        blend(b, a, m)
    }

    fn within(x: V, limit: V) -> bool {
        signs(compare::<AT_MOST>(and_not(k(-0.0), x), limit)) == (1 << LANES) - 1
    }

    fn turn(quadrant: V, sin: V, cos: V) -> (V, V) {
        let quadrant = bits(quadrant);
        let odd = real(shift::<{ BITS - 1 }>(quadrant));
        let sign = and(real(shift::<{ BITS - 2 }>(quadrant)), k(-0.0));
        (xor(select(odd, cos, sin), sign), xor(select(odd, sin, cos), xor(sign, odd)))
    }
}

use self::fused as polynomials;
