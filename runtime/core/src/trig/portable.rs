
/// [sin x, cos x] of four angles in rad, any. Error at most 1 ulp where the target has fused multiply-add, the standard library's where it has not.
#[inline(always)]
pub fn four(a: f64, b: f64, c: f64, d: f64) -> [Lanes; 2] {
    portable([a, b, c, d])
}
