
/// 1.5·2⁵²: adding it rounds an f64 to an integer and leaves that integer in the low bits.
const REDUCTION_ROUND: f64 = 6755399441055744.0;

/// π/2 in parts of 33 and 53 bits: n times the first is exact for |n| < 2²⁰, and 2⁻⁸⁸ is left over.
const REDUCTION: [f64; 2] = [1.5707963267341256, 6.077100506506192e-11];

lane_functions! {
    // Sines and cosines of angles within the limit, where a·b + c has two roundings.
    fn split(x: V) -> (V, V) {
        // x = n·π/2 + hi + lo, |hi| ≤ π/4 and a little, by way of f64; n in the low bits of
        // `quadrant`.
        let (quadrant, hi, lo) = reduce(x);
        let z = mul(hi, hi);
        let half = mul(k(0.5), z);
        let w = sub(k(1.0), half);
        // sin(hi + lo) = hi + (hi³·p + lo)
        let p = fmadd(z, fmadd(z, k(S[2]), k(S[1])), k(S[0]));
        let sin = add(hi, fmadd(mul(hi, z), p, lo));
        // cos(hi + lo) = w + ((1 − w − z/2) + (z²·p − hi·lo)), w = 1 − z/2
        let p = fmadd(z, fmadd(z, k(C[2]), k(C[1])), k(C[0]));
        let cos = add(w, fmadd(mul(z, z), p, sub(sub(sub(k(1.0), w), half), mul(hi, lo))));
        turn(quadrant, sin, cos)
    }
}
