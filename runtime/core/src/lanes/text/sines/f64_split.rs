
/// π/2 in parts of 33, 33 and 53 bits: n times one of the first two is exact for |n| < 2²⁰, and
/// 2⁻¹²² is left over.
const SPLIT: [f64; 3] = [1.5707963267341256, 6.077100506303966e-11, 2.0222662487959506e-21];

lane_functions! {
    // Sines and cosines of angles within the limit, where a·b + c has two roundings.
    fn split(x: V) -> (V, V) {
        // x = n·π/2 + hi + lo, |hi| ≤ π/4 and a little. r is exact, and so is what hi lost before
        // the last step.
        let rounded = fmadd(x, k(::core::f64::consts::FRAC_2_PI), k(ROUND));
        let n = sub(rounded, k(ROUND));
        let r = fnmadd(n, k(SPLIT[0]), x);
        let hi = fnmadd(n, k(SPLIT[1]), r);
        let lo = fnmadd(n, k(SPLIT[2]), fnmadd(n, k(SPLIT[1]), sub(r, hi)));
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
