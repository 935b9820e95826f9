
/// hi + lo with |lo| ≤ ulp(hi)/2. Errors in units of u² = 2⁻¹⁰⁶ (Joldes, Muller & Popescu, Tight
/// and rigorous error bounds for basic building blocks of double-word arithmetic, ACM TOMS 44,
/// 2017).
pub(super) type V = (f64, f64);

/// 3 u²
#[inline(always)]
pub(super) fn add<const FUSED: bool>(a: V, b: V) -> V {
    let (s, e) = two_sum(a.0, b.0);
    let (t, f) = two_sum(a.1, b.1);
    let (v, w) = fast_two_sum(s, e + t);
    fast_two_sum(v, f + w)
}

/// 5 u²
#[inline(always)]
pub(super) fn mul<const FUSED: bool>(a: V, b: V) -> V {
    let (p, e) = two_prod::<FUSED>(a.0, b.0);
    let lows = multiply_add::<FUSED>(a.1, b.0, multiply_add::<FUSED>(a.0, b.1, a.1 * b.1));
    fast_two_sum(p, e + lows)
}

/// 10 u²
#[inline(always)]
pub(super) fn div<const FUSED: bool>(a: V, b: V) -> V {
    let q = a.0 / b.0;
    let r = sub::<FUSED>(a, mul::<FUSED>(b, (q, 0.0)));
    fast_two_sum(q, r.0 / b.0)
}

/// 4 u²
#[inline(always)]
pub(super) fn sqrt<const FUSED: bool>(x: V) -> V {
    let s = x.0.sqrt();
    if s == 0.0 {
        return (s, 0.0);
    }
    let (p, e) = two_prod::<FUSED>(s, s);
    fast_two_sum(s, ((x.0 - p) - e + x.1) / (s + s))
}

/// (sin x, cos x), x in rad. Error at most 2⁻¹⁰⁰ of each.
#[inline(always)]
pub(super) fn sin_cos<const FUSED: bool>(x: V) -> (V, V) {
    sines_of_two::<FUSED>(x)
}

/// The angle of the point (x, y), rad; error at most 2⁻⁹⁸. One step of Newton's from that of
/// doubles.
#[inline(never)]
pub(super) fn atan2<const FUSED: bool>(y: V, x: V) -> V {
    let angle = y.0.atan2(x.0);
    if x.0 == 0.0 && y.0 == 0.0 {
        return (angle, 0.0);
    }
    // Of a size with which nothing overflows.
    let size = x.0.abs() + y.0.abs();
    let (x, y) = (div::<FUSED>(x, (size, 0.0)), div::<FUSED>(y, (size, 0.0)));
    let (s, c) = sines_of_two::<FUSED>((angle, 0.0));
    let across = sub::<FUSED>(mul::<FUSED>(y, c), mul::<FUSED>(x, s));
    let along = add::<FUSED>(mul::<FUSED>(x, c), mul::<FUSED>(y, s));
    add::<FUSED>((angle, 0.0), div::<FUSED>(across, along))
}
