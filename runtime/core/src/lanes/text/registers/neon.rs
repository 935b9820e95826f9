
/// Bits of a lane.
const BITS: i32 = 8 * ::core::mem::size_of::<Real>() as i32;

lane_functions! {
    pub(super) fn fmadd(a: V, b: V, c: V) -> V {
        fma(c, a, b)
    }

    pub(super) fn fmsub(a: V, b: V, c: V) -> V {
        fma(neg(c), a, b)
    }

    pub(super) fn fnmadd(a: V, b: V, c: V) -> V {
        fms(c, a, b)
    }

    pub(super) fn fnmsub(a: V, b: V, c: V) -> V {
        fms(neg(c), a, b)
    }

    pub(super) fn positive(x: V) -> M {
        greater_than_0(x)
    }

    pub(super) fn select(m: M, a: V, b: V) -> V {
        choose(m, a, b)
    }

    fn within(x: V, limit: V) -> bool {
        all(at_most(x, limit))
    }

    fn turn(quadrant: V, sin: V, cos: V) -> (V, V) {
        let quadrant = bits(quadrant);
        let odd = test(quadrant, integer(1));
        let sign = and(shift::<{ BITS - 2 }>(quadrant), bits(k(-0.0)));
        let (s, c) = (select(odd, cos, sin), select(odd, neg(sin), cos));
        (real(xor(bits(s), sign)), real(xor(bits(c), sign)))
    }
}

use self::fused as polynomials;
