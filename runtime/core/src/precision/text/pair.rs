
/// A double and, to first order, what it lost: double-double arithmetic without normalisation. The
/// sum of both is that of a computation with some 2⁻¹⁰⁶, as long as what is lost stays small (Lange
/// & Rump, Faithfully rounded floating-point computations, ACM TOMS 46, 2020).
pub(super) type V = (f64, f64);

#[inline(always)]
pub(super) fn add<const FUSED: bool>(a: V, b: V) -> V {
    let (s, e) = two_sum(a.0, b.0);
    (s, e + (a.1 + b.1))
}

#[inline(always)]
pub(super) fn mul<const FUSED: bool>(a: V, b: V) -> V {
    let (p, e) = two_prod::<FUSED>(a.0, b.0);
    (p, multiply_add::<FUSED>(a.0, b.1, multiply_add::<FUSED>(a.1, b.0, e)))
}

#[inline(always)]
pub(super) fn div<const FUSED: bool>(a: V, b: V) -> V {
    let q = a.0 / b.0;
    let (p, e) = two_prod::<FUSED>(q, b.0);
    let rest = ((a.0 - p) - e) + multiply_add::<FUSED>(-q, b.1, a.1);
    (q, rest / (b.0 + b.1))
}

#[inline(always)]
pub(super) fn sqrt<const FUSED: bool>(x: V) -> V {
    let s = x.0.sqrt();
    if s == 0.0 {
        return (s, 0.0);
    }
    let (p, e) = two_prod::<FUSED>(s, s);
    (s, ((x.0 - p) - e + x.1) / (s + s))
}

/// The angle of the point (x, y), rad: the standard library's, and what the lost parts turn it.
#[inline(always)]
pub(super) fn atan2<const FUSED: bool>(y: V, x: V) -> V {
    let angle = y.0.atan2(x.0);
    let size = x.0 * x.0 + y.0 * y.0;
    (angle, if size > 0.0 { (x.0 * y.1 - y.0 * x.1) / size } else { 0.0 })
}
