
/// 1.5·2²³: adding it rounds to an integer and leaves that integer in the low bits.
const ROUND: f64 = 12582912.0;

/// π/2 in parts of 24, 10 and 24 bits: n times the second is exact for |n| < 2¹⁴, and 2⁻⁶³ is left
/// over.
const HALF_PI: [f64; 3] = [1.5707963705062866, -4.371395334601402e-08, 2.5633440682570896e-12];

lane_functions! {
    // Sines and cosines of angles within the limit, where a·b + c has one rounding.
    fn fused(x: V) -> (V, V) {
        // x = n·π/2 + hi + lo, |hi| ≤ π/4 and a little, |lo| about ulp(hi)/2. r is exact, and so is
        // what hi lost.
        let rounded = fmadd(x, k(::core::f64::consts::FRAC_2_PI), k(ROUND));
        let n = sub(rounded, k(ROUND));
        let r = fnmadd(n, k(HALF_PI[0]), x);
        let hi = fnmadd(n, k(HALF_PI[1]), r);
        let lo = fnmadd(n, k(HALF_PI[2]), fnmadd(n, k(HALF_PI[1]), sub(r, hi)));
        let z = mul(hi, hi);
        // sin(hi + lo) = hi + (hi³·p + lo)
        let p = fmadd(z, fmadd(z, k(S[2]), k(S[1])), k(S[0]));
        let sin = add(hi, fmadd(mul(hi, z), p, lo));
        // cos(hi + lo) = 1 + hi·(hi·(z·p − 1/2) − lo)
        let p = fmadd(z, fmadd(z, k(C[2]), k(C[1])), k(C[0]));
        let cos = fmadd(hi, fmsub(hi, fmadd(z, p, k(-0.5)), lo), k(1.0));
        // The quadrant is in the two lowest bits of `rounded`: exchange for an odd one, and signs.
        turn(rounded, sin, cos)
    }
}
