
// Arithmetic that takes and gives vectors in registers. By its own convention the compiler hands
// them over in memory, unless it inlines a call before anything is optimised, which it does where
// both functions have the same features; to take three places in memory for each operation away
// again was up to two fifths of the time to compile. Hence "C", and hence fewer features than the
// callers have: each of these becomes an instruction first, and is inlined then.
register_functions! {
    pub(super) extern "C" fn k(x: f64) -> V {
        instruction::k(x as Real)
    }

    pub(super) extern "C" fn add(a: V, b: V) -> V {
        instruction::add(a, b)
    }

    pub(super) extern "C" fn sub(a: V, b: V) -> V {
        instruction::sub(a, b)
    }

    pub(super) extern "C" fn mul(a: V, b: V) -> V {
        instruction::mul(a, b)
    }

    pub(super) extern "C" fn div(a: V, b: V) -> V {
        instruction::div(a, b)
    }

    extern "C" fn xor(a: V, b: V) -> V {
        instruction::xor(a, b)
    }

    pub(super) extern "C" fn sqrt(a: V) -> V {
        instruction::sqrt(a)
    }

    pub(super) extern "C" fn neg(a: V) -> V {
        xor(a, k(-0.0))
    }
}
