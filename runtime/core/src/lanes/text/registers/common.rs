
lane_functions! {
    pub(super) fn lanes(x: [Real; LANES]) -> V {
        // SAFETY: as many bytes on both sides, and any of them are numbers.
        unsafe { ::core::mem::transmute::<[Real; LANES], V>(x) }
    }

    pub(super) fn array(x: V) -> [Real; LANES] {
        // SAFETY: as many bytes on both sides, and any of them are numbers.
        unsafe { ::core::mem::transmute::<V, [Real; LANES]>(x) }
    }

    // By the standard library where |x| is beyond the limit, or x is not a number.
    pub(super) fn sin_cos(x: V) -> (V, V) {
        let (sin, cos) = polynomials(x);
        if within(x, k(LIMIT)) {
            return (sin, cos);
        }
        let (mut sin, mut cos) = (array(sin), array(cos));
        sin_cos_beyond(&array(x), &mut sin, &mut cos);
        (lanes(sin), lanes(cos))
    }
}
