
/// π/2 in parts of 53, 36 and 53 bits: n times the second is exact for |n| < 2¹⁷, and 2⁻¹⁴⁵ is left
/// over.
const HALF_PI: [f64; 3] = [1.5707963267948966, 6.123233995707727e-17, 2.9038559739793605e-28];

lane_functions! {
    // Sines and cosines of angles within the limit, where a·b + c has one rounding.
    fn fused(x: V) -> (V, V) {
        // x = n·π/2 + hi + lo, |hi| ≤ π/4 and a little, |lo| ≤ ulp(hi)/2. r is exact, and so is
        // what hi lost.
        let rounded = fmadd(x, k(::core::f64::consts::FRAC_2_PI), k(ROUND));
        let n = sub(rounded, k(ROUND));
        let r = fnmadd(n, k(HALF_PI[0]), x);
        let hi = fnmadd(n, k(HALF_PI[1]), r);
        let lo = fnmadd(n, k(HALF_PI[2]), fnmadd(n, k(HALF_PI[1]), sub(r, hi)));
        let z = mul(hi, hi);
        let zz = mul(z, z);
        let cube = mul(hi, z);
        // sin(hi + lo) = hi + (hi³·p + lo)
        let p = fmadd(zz, fmadd(zz, fmadd(z, k(S[5]), k(S[4])), fmadd(z, k(S[3]), k(S[2]))), fmadd(z, k(S[1]), k(S[0])));
        let sin = add(hi, fmadd(cube, p, lo));
        // cos(hi + lo) = 1 + hi·(hi³·p − hi/2 − lo)
        let p = fmadd(zz, fmadd(zz, fmadd(z, k(C[5]), k(C[4])), fmadd(z, k(C[3]), k(C[2]))), fmadd(z, k(C[1]), k(C[0])));
        let cos = fmadd(hi, fmadd(cube, p, fmsub(hi, k(-0.5), lo)), k(1.0));
        // The quadrant is in the two lowest bits of `rounded`: exchange for an odd one, and signs.
        turn(rounded, sin, cos)
    }
}
