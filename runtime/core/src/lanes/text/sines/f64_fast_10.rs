
/// π/2 in parts of 33 and 53 bits: n times the first is exact for |n| < 2²⁰, and 2⁻⁸⁷ is left over.
const COARSE: [f64; 2] = [1.5707963267341256, 6.077100506506192e-11];

lane_functions! {
    // Sines and cosines of angles within the limit, |error| ≤ 10⁻¹⁰: minimax polynomials on
    // [−π/4, π/4] by Remez' exchange, sin of degree 9 (2.4e-12) and cos of degree 8 (5.4e-11).
    fn fused(x: V) -> (V, V) {
        let rounded = fmadd(x, k(::core::f64::consts::FRAC_2_PI), k(ROUND));
        let n = sub(rounded, k(ROUND));
        let r = fnmadd(n, k(COARSE[1]), fnmadd(n, k(COARSE[0]), x));
        let z = mul(r, r);
        let zz = mul(z, z);
        let p = fmadd(zz, fmadd(z, k(2.71600618044103e-06), k(-0.00019839042890751698)), fmadd(z, k(0.00833332823569497), k(-0.16666666627968518)));
        let sin = fmadd(mul(r, z), p, r);
        let p = fmadd(zz, fmadd(z, k(2.4390369451885502e-05), k(-0.0013886762952573994)), fmadd(z, k(0.04166662329856291), k(-0.49999999724890004)));
        let cos = fmadd(z, p, k(1.0));
        turn(rounded, sin, cos)
    }

    fn split(x: V) -> (V, V) {
        fused(x)
    }
}
