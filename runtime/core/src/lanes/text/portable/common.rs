pub(super) type V = [Real; LANES];
pub(super) type M = [bool; LANES];

macro_rules! lane_functions {
    ($($item:item)*) => { $(#[inline(always)] $item)* };
}

/// Whether a·b + c is one instruction with one rounding.
const FMA: bool = ::core::cfg!(any(target_feature = "fma", target_arch = "aarch64"));

#[inline(always)]
fn fma(a: Real, b: Real, c: Real) -> Real {
    if FMA { a.mul_add(b, c) } else { a * b + c }
}

lane_functions! {
    pub(super) fn k(x: f64) -> V {
        [x as Real; LANES]
    }

    pub(super) fn add(a: V, b: V) -> V {
        each_lane!(i => a[i] + b[i])
    }

    pub(super) fn sub(a: V, b: V) -> V {
        each_lane!(i => a[i] - b[i])
    }

    pub(super) fn mul(a: V, b: V) -> V {
        each_lane!(i => a[i] * b[i])
    }

    pub(super) fn div(a: V, b: V) -> V {
        each_lane!(i => a[i] / b[i])
    }

    pub(super) fn neg(x: V) -> V {
        each_lane!(i => -x[i])
    }

    pub(super) fn fmadd(a: V, b: V, c: V) -> V {
        each_lane!(i => fma(a[i], b[i], c[i]))
    }

    pub(super) fn fmsub(a: V, b: V, c: V) -> V {
        each_lane!(i => fma(a[i], b[i], -c[i]))
    }

    pub(super) fn fnmadd(a: V, b: V, c: V) -> V {
        each_lane!(i => fma(-a[i], b[i], c[i]))
    }

    pub(super) fn fnmsub(a: V, b: V, c: V) -> V {
        each_lane!(i => fma(-a[i], b[i], -c[i]))
    }

    pub(super) fn sqrt(x: V) -> V {
        each_lane!(i => x[i].sqrt())
    }

    pub(super) fn positive(x: V) -> M {
        each_lane!(i => x[i] > 0.0)
    }

    pub(super) fn select(m: M, a: V, b: V) -> V {
        each_lane!(i => if m[i] { a[i] } else { b[i] })
    }

    pub(super) fn reduce_add(x: V) -> V {
        let (mut sum, mut step) = (x, 1);
        while step < LANES {
            sum = each_lane!(i => sum[i] + sum[i ^ step]);
            step *= 2;
        }
        sum
    }

    pub(super) fn lanes(x: [Real; LANES]) -> V {
        x
    }

    pub(super) fn array(x: V) -> [Real; LANES] {
        x
    }

    fn within(x: V, limit: V) -> bool {
        let within: M = each_lane!(i => x[i].abs() <= limit[i]);
        !within.contains(&false)
    }

    fn turn(quadrant: V, sin: V, cos: V) -> (V, V) {
        let odd: M = each_lane!(i => quadrant[i].to_bits() & 1 != 0);
        let sign: [Bits; LANES] = each_lane!(i => (quadrant[i].to_bits() >> 1) << (Bits::BITS - 1));
        let (s, c) = (select(odd, cos, sin), select(odd, neg(sin), cos));
        (each_lane!(i => Real::from_bits(s[i].to_bits() ^ sign[i])), each_lane!(i => Real::from_bits(c[i].to_bits() ^ sign[i])))
    }

    fn polynomials(x: V) -> (V, V) {
        if FMA { fused(x) } else { split(x) }
    }
}

// As that of registers; one function of its own, since it is long.
#[inline(never)]
pub(super) fn sin_cos(x: V) -> (V, V) {
    let (mut sin, mut cos) = polynomials(x);
    if !within(x, k(LIMIT)) {
        sin_cos_beyond(&x, &mut sin, &mut cos);
    }
    (sin, cos)
}
