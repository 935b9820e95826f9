
lane_functions! {
    pub(super) fn lanes(x: [Real; LANES]) -> V {
        // SAFETY: as many bytes on both sides, and any of them are numbers.
        unsafe { ::core::mem::transmute::<[Real; LANES], V>(x) }
    }

    pub(super) fn array(x: V) -> [Real; LANES] {
        // SAFETY: as many bytes on both sides, and any of them are numbers.
        unsafe { ::core::mem::transmute::<V, [Real; LANES]>(x) }
    }
}
