
/// A double as a sum of two.
#[inline(always)]
pub(super) fn k<const FUSED: bool>(x: f64) -> V {
    (x, 0.0)
}

#[inline(always)]
pub(super) fn neg<const FUSED: bool>(x: V) -> V {
    (-x.0, -x.1)
}

#[inline(always)]
pub(super) fn sub<const FUSED: bool>(a: V, b: V) -> V {
    add::<FUSED>(a, (-b.0, -b.1))
}

#[inline(always)]
pub(super) fn fmadd<const FUSED: bool>(a: V, b: V, c: V) -> V {
    add::<FUSED>(mul::<FUSED>(a, b), c)
}

#[inline(always)]
pub(super) fn fmsub<const FUSED: bool>(a: V, b: V, c: V) -> V {
    sub::<FUSED>(mul::<FUSED>(a, b), c)
}

#[inline(always)]
pub(super) fn fnmadd<const FUSED: bool>(a: V, b: V, c: V) -> V {
    sub::<FUSED>(c, mul::<FUSED>(a, b))
}

#[inline(always)]
pub(super) fn fnmsub<const FUSED: bool>(a: V, b: V, c: V) -> V {
    neg::<FUSED>(add::<FUSED>(mul::<FUSED>(a, b), c))
}

#[inline(always)]
pub(super) fn positive<const FUSED: bool>(x: V) -> bool {
    x.0 + x.1 > 0.0
}

#[inline(always)]
pub(super) fn select<const FUSED: bool>(m: bool, a: V, b: V) -> V {
    if m { a } else { b }
}

/// The double nearest to x, or next to it.
#[inline(always)]
pub(super) fn number<const FUSED: bool>(x: V) -> f64 {
    x.0 + x.1
}
