
/// (sin x, cos x), x in rad: the doubles nearest to them, of any finite x; NaN of any other. Two
/// doubles decide nearly always, whole numbers of 384 bits the rest: no double's sine comes nearer
/// than 2⁻¹²⁰ or so to the middle between two doubles (Lefèvre & Muller).
#[inline(always)]
pub(super) fn sin_cos_correct<const FUSED: bool>(x: f64) -> (f64, f64) {
    if x.abs() < 3.725290298461914e-9 {
        // 2⁻²⁸: x³/6 and x²/2 are less than a quarter of an ulp. −0 stays −0.
        return (x, 1.0);
    }
    let (s, c) = sines_of_two::<FUSED>((x, 0.0));
    let ((sin, certain), (cos, sure)) = (decided(s), decided(c));
    if certain && sure || !(x.abs() < f64::INFINITY) { (sin, cos) } else { sines_in_whole_numbers(x) }
}

/// The double nearest to a sum of two with an error of 2⁻⁹⁹, and whether that is sure.
#[inline(always)]
fn decided(x: (f64, f64)) -> (f64, bool) {
    let error = x.0.abs() * 1.5777218104420236e-30;
    let (low, high) = (x.0 + (x.1 - error), x.0 + (x.1 + error));
    (high, low == high)
}

/// The same of single precision.
#[inline(always)]
pub(super) fn sin_cos_correct_f32<const FUSED: bool>(x: f32) -> (f32, f32) {
    if x.abs() < 1.1920929e-7 {
        // 2⁻²³, as above. −0 stays −0.
        return (x, 1.0);
    }
    let (s, c) = sines_of_two::<FUSED>((x as f64, 0.0));
    (to_single(s), to_single(c))
}

/// Rounded once: first cut off, with an odd last bit where something was cut off.
#[inline(always)]
fn to_single(x: (f64, f64)) -> f32 {
    let bits = x.0.to_bits();
    let inward = (x.1 < 0.0) == (x.0 > 0.0);
    f64::from_bits(if x.1 == 0.0 || x.0 != x.0 { bits } else if inward { (bits - 1) | 1 } else { bits | 1 }) as f32
}
