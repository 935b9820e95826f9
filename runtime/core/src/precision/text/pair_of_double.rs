
/// (sin x, cos x) from those of the double.
#[inline(always)]
pub(super) fn turned<const FUSED: bool>(x: V, sin: f64, cos: f64) -> (V, V) {
    ((sin, cos * x.1), (cos, -(sin * x.1)))
}
