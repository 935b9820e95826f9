
/// Bits of a lane.
const BITS: i32 = 8 * ::core::mem::size_of::<Real>() as i32;

register_functions! {
    pub(super) extern "C" fn fmadd(a: V, b: V, c: V) -> V {
        add(mul(a, b), c)
    }

    pub(super) extern "C" fn fmsub(a: V, b: V, c: V) -> V {
        sub(mul(a, b), c)
    }

    pub(super) extern "C" fn fnmadd(a: V, b: V, c: V) -> V {
        sub(c, mul(a, b))
    }

    pub(super) extern "C" fn fnmsub(a: V, b: V, c: V) -> V {
        sub(neg(mul(a, b)), c)
    }
}

lane_functions! {
    pub(super) fn positive(x: V) -> M {
        greater(x, k(0.0))
    }

    pub(super) fn select(m: M, a: V, b: V) -> V {
        or(and(m, a), and_not(m, b))
    }

    fn within(x: V, limit: V) -> bool {
        signs(at_most(and_not(k(-0.0), x), limit)) == (1 << LANES) - 1
    }

    fn turn(quadrant: V, sin: V, cos: V) -> (V, V) {
        let odd = lowest(quadrant);
        let sign = and(real(shift::<{ BITS - 2 }>(bits(quadrant))), k(-0.0));
        let exchange = and(xor(sin, cos), odd);
        (xor(xor(sin, exchange), sign), xor(xor(cos, exchange), xor(sign, and(odd, k(-0.0)))))
    }
}

use self::split as polynomials;
