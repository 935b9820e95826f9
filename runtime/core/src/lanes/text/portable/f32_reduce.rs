
lane_functions! {
    // See `split`.
    fn reduce(x: V) -> (V, V, V) {
        let rounded: [f64; LANES] = each_lane!(i => f64::from(x[i]) * ::core::f64::consts::FRAC_2_PI + REDUCTION_ROUND);
        let n: [f64; LANES] = each_lane!(i => rounded[i] - REDUCTION_ROUND);
        let r: [f64; LANES] = each_lane!(i => f64::from(x[i]) - n[i] * REDUCTION[0] - n[i] * REDUCTION[1]);
        let hi: V = each_lane!(i => r[i] as f32);
        (each_lane!(i => f32::from_bits(rounded[i].to_bits() as u32)), hi, each_lane!(i => (r[i] - f64::from(hi[i])) as f32))
    }
}
