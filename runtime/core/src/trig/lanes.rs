// Sines and cosines of four angles. This file and one of `vector.rs` and `portable.rs` are compiled in the runtime and copied into generated
// code; they need nothing but `std`.

/// Four numbers.
type Lanes = [f64; 4];

/// Up to this |x|, rad, the polynomials are used; if one of four angles is beyond it, or NaN, they go to the standard library.
const LIMIT: f64 = 1e5;

/// π/2 in parts of 33, 33 and 53 bits: k times one of the first two is exact for |k| < 2²⁰, and 2⁻¹²² is left over.
const HALF_PI: [f64; 3] = [1.5707963267341256, 6.077100506303966e-11, 2.0222662487959506e-21];

/// 1.5·2⁵²: adding it rounds to an integer and leaves that integer in the low bits.
const ROUND: f64 = 6755399441055744.0;

// Minimax polynomials on [−π/4, π/4]; coefficients of fdlibm's k_sin.c and k_cos.c (Sun Microsystems, 1993).
const S: [f64; 6] = [
    -1.66666666666666324348e-01,
    8.33333333332248946124e-03,
    -1.98412698298579493134e-04,
    2.75573137070700676789e-06,
    -2.50507602534068634195e-08,
    1.58969099521155010221e-10,
];
const C: [f64; 6] = [
    4.16666666666666019037e-02,
    -1.38888888888741095749e-03,
    2.48015872894767294178e-05,
    -2.75573143513906633035e-07,
    2.08757232129817482790e-09,
    -1.13596475577881948265e-11,
];


#[cold]
#[inline(never)]
fn one_by_one([a, b, c, d]: Lanes) -> [Lanes; 2] {
    [[a.sin(), b.sin(), c.sin(), d.sin()], [a.cos(), b.cos(), c.cos(), d.cos()]]
}

/// [sin x, cos x]: for processors whose vector instructions are not written out.
#[inline(always)]
fn portable(x: Lanes) -> [Lanes; 2] {
    let [a, b, c, d] = x;
    let within = (a.abs() <= LIMIT) & (b.abs() <= LIMIT) & (c.abs() <= LIMIT) & (d.abs() <= LIMIT);
    if !FMA || !within {
        return one_by_one(x);
    }
    let [(a, e), (b, f), (c, g), (d, h)] = [lane(a), lane(b), lane(c), lane(d)];
    [[a, b, c, d], [e, f, g, h]]
}

/// Whether a·b + c is one instruction with one rounding.
const FMA: bool = ::core::cfg!(any(target_feature = "fma", target_arch = "aarch64"));

#[inline(always)]
fn fma(a: f64, b: f64, c: f64) -> f64 {
    if FMA { a.mul_add(b, c) } else { a * b + c }
}

#[inline(always)]
fn lane(x: f64) -> (f64, f64) {
    // x = k·π/2 + hi + lo, |hi| ≤ π/4 and a little. The first step is exact, and so is what the second one lost.
    let rounded = fma(x, ::core::f64::consts::FRAC_2_PI, ROUND);
    let k = rounded - ROUND;
    let r = fma(-k, HALF_PI[0], x);
    let hi = fma(-k, HALF_PI[1], r);
    let lo = fma(-k, HALF_PI[2], fma(-k, HALF_PI[1], r - hi));
    let z = hi * hi;
    let zz = z * z;
    let half = 0.5 * z;
    let w = 1.0 - half;
    // sin(hi + lo) = hi + (hi³·(S₀ + z·p) + lo·(1 − z/2))
    let p = fma(zz, fma(zz, S[5], fma(z, S[4], S[3])), fma(z, S[2], S[1]));
    let s = hi + fma(hi * z, fma(z, p, S[0]), lo * w);
    // cos(hi + lo) = w + ((1 − w − z/2) + (z²·p − hi·lo)), w = 1 − z/2
    let p = fma(zz, fma(zz, fma(z, C[5], C[4]), fma(z, C[3], C[2])), fma(z, C[1], C[0]));
    let c = w + fma(zz, p, (1.0 - w) - half - hi * lo);
    // The quadrant is in the two lowest bits of `rounded`: exchange for an odd one, and signs.
    let quadrant = rounded.to_bits();
    let (s, c) = (s.to_bits(), c.to_bits());
    let exchange = (s ^ c) & 0u64.wrapping_sub(quadrant & 1);
    let (sin_sign, cos_sign) = ((quadrant & 2) << 62, (quadrant.wrapping_add(1) & 2) << 62);
    (f64::from_bits(s ^ exchange ^ sin_sign), f64::from_bits(c ^ exchange ^ cos_sign))
}
