
lane_functions! {
    fn register(x: [Real; STATES]) -> Register {
        // SAFETY: as many bytes on both sides, and any of them are numbers.
        unsafe { ::core::mem::transmute::<[Real; STATES], Register>(x) }
    }

    fn flat(x: Register) -> [Real; STATES] {
        // SAFETY: as many bytes on both sides, and any of them are numbers.
        unsafe { ::core::mem::transmute::<Register, [Real; STATES]>(x) }
    }
}
