
/// π/2 in parts of 33 and 53 bits: n times the first is exact for |n| < 2²⁰, and 2⁻⁸⁷ is left over.
const COARSE: [f64; 2] = [1.5707963267341256, 6.077100506506192e-11];

lane_functions! {
    // Sines and cosines of angles within the limit, |error| ≤ 10⁻⁷: minimax polynomials on
    // [−π/4, π/4] by Remez' exchange, sin of degree 7 (1.8e-9) and cos of degree 6 (3.3e-8).
    fn fused(x: V) -> (V, V) {
        let rounded = fmadd(x, k(::core::f64::consts::FRAC_2_PI), k(ROUND));
        let n = sub(rounded, k(ROUND));
        let r = fnmadd(n, k(COARSE[1]), fnmadd(n, k(COARSE[0]), x));
        let z = mul(r, r);
        let p = fmadd(z, fmadd(z, k(-0.0001949556790972763), k(0.008331978126489873)), k(-0.16666650659782803));
        let sin = fmadd(mul(r, z), p, r);
        let p = fmadd(z, fmadd(z, k(-0.001359776545549477), k(0.04165629045617894)), k(-0.49999894718541193));
        let cos = fmadd(z, p, k(1.0));
        turn(rounded, sin, cos)
    }

    fn split(x: V) -> (V, V) {
        fused(x)
    }
}
