
/// (sin x, cos x), x in rad. Error at most 2⁻¹⁰⁰ of each.
#[inline(always)]
pub(super) fn sin_cos<const FUSED: bool>(x: V) -> (V, V) {
    sines_of_two::<FUSED>(fast_two_sum(x.0, x.1))
}
