
/// Up to this |x|, rad, the polynomials are used.
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

functions! {
    // Sines and cosines of angles within the limit.
    fn polynomials(x: V) -> (V, V) {
        // x = n·π/2 + hi + lo, |hi| ≤ π/4 and a little. The first step is exact, and so is what the second one lost.
        let rounded = fmadd(x, k(::core::f64::consts::FRAC_2_PI), k(ROUND));
        let n = sub(rounded, k(ROUND));
        let r = fnmadd(n, k(HALF_PI[0]), x);
        let hi = fnmadd(n, k(HALF_PI[1]), r);
        let lo = fnmadd(n, k(HALF_PI[2]), fnmadd(n, k(HALF_PI[1]), sub(r, hi)));
        let z = mul(hi, hi);
        let zz = mul(z, z);
        let half = mul(k(0.5), z);
        let w = sub(k(1.0), half);
        // sin(hi + lo) = hi + (hi³·(S₀ + z·p) + lo·(1 − z/2))
        let p = fmadd(zz, fmadd(zz, k(S[5]), fmadd(z, k(S[4]), k(S[3]))), fmadd(z, k(S[2]), k(S[1])));
        let sin = add(hi, fmadd(mul(hi, z), fmadd(z, p, k(S[0])), mul(lo, w)));
        // cos(hi + lo) = w + ((1 − w − z/2) + (z²·p − hi·lo)), w = 1 − z/2
        let p = fmadd(zz, fmadd(zz, fmadd(z, k(C[5]), k(C[4])), fmadd(z, k(C[3]), k(C[2]))), fmadd(z, k(C[1]), k(C[0])));
        let cos = add(w, fmadd(zz, p, sub(sub(sub(k(1.0), w), half), mul(hi, lo))));
        // The quadrant is in the two lowest bits of `rounded`: exchange for an odd one, and signs.
        turn(rounded, sin, cos)
    }
}
