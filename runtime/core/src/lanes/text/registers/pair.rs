// Four f64 in a pair of registers.
pub(super) type Real = half::Real;
pub(super) const LANES: usize = 2 * half::LANES;
pub(super) type V = (half::V, half::V);
pub(super) type M = (half::M, half::M);

four_functions! {
    pub(super) fn k(x: f64) -> V {
        (half::k(x), half::k(x))
    }

    pub(super) fn lanes([a, b, c, d]: [Real; LANES]) -> V {
        (half::lanes([a, b]), half::lanes([c, d]))
    }

    pub(super) fn array(x: V) -> [Real; LANES] {
        let ([a, b], [c, d]) = (half::array(x.0), half::array(x.1));
        [a, b, c, d]
    }

    pub(super) fn load(from: &[Real; LANES]) -> V {
        lanes(*from)
    }

    pub(super) fn store(x: V, to: &mut [Real; LANES]) {
        *to = array(x);
    }

    pub(super) fn lane<const K: usize>(x: V) -> Real {
        if K < half::LANES { half::array(x.0)[K] } else { half::array(x.1)[K % half::LANES] }
    }

    pub(super) fn add(a: V, b: V) -> V {
        (half::add(a.0, b.0), half::add(a.1, b.1))
    }

    pub(super) fn sub(a: V, b: V) -> V {
        (half::sub(a.0, b.0), half::sub(a.1, b.1))
    }

    pub(super) fn mul(a: V, b: V) -> V {
        (half::mul(a.0, b.0), half::mul(a.1, b.1))
    }

    pub(super) fn div(a: V, b: V) -> V {
        (half::div(a.0, b.0), half::div(a.1, b.1))
    }

    pub(super) fn neg(x: V) -> V {
        (half::neg(x.0), half::neg(x.1))
    }

    pub(super) fn fmadd(a: V, b: V, c: V) -> V {
        (half::fmadd(a.0, b.0, c.0), half::fmadd(a.1, b.1, c.1))
    }

    pub(super) fn fmsub(a: V, b: V, c: V) -> V {
        (half::fmsub(a.0, b.0, c.0), half::fmsub(a.1, b.1, c.1))
    }

    pub(super) fn fnmadd(a: V, b: V, c: V) -> V {
        (half::fnmadd(a.0, b.0, c.0), half::fnmadd(a.1, b.1, c.1))
    }

    pub(super) fn fnmsub(a: V, b: V, c: V) -> V {
        (half::fnmsub(a.0, b.0, c.0), half::fnmsub(a.1, b.1, c.1))
    }

    pub(super) fn sqrt(x: V) -> V {
        (half::sqrt(x.0), half::sqrt(x.1))
    }

    pub(super) fn atan2(y: V, x: V) -> V {
        (half::atan2(y.0, x.0), half::atan2(y.1, x.1))
    }

    pub(super) fn positive(x: V) -> M {
        (half::positive(x.0), half::positive(x.1))
    }

    pub(super) fn select(m: M, a: V, b: V) -> V {
        (half::select(m.0, a.0, b.0), half::select(m.1, a.1, b.1))
    }

    pub(super) fn sin_cos(x: V) -> (V, V) {
        let ((s, c), (t, d)) = (half::sin_cos(x.0), half::sin_cos(x.1));
        ((s, t), (c, d))
    }

    pub(super) fn reduce_add(x: V) -> V {
        // (x₀ + x₁) + (x₂ + x₃), as in one register.
        let sum = half::add(half::reduce_add(x.0), half::reduce_add(x.1));
        (sum, sum)
    }
}
