
register_functions! {
    pub(super) extern "C" fn fmadd(a: V, b: V, c: V) -> V {
        instruction::fmadd(a, b, c)
    }

    pub(super) extern "C" fn fmsub(a: V, b: V, c: V) -> V {
        instruction::fmsub(a, b, c)
    }

    pub(super) extern "C" fn fnmadd(a: V, b: V, c: V) -> V {
        instruction::fnmadd(a, b, c)
    }

    pub(super) extern "C" fn fnmsub(a: V, b: V, c: V) -> V {
        instruction::fnmsub(a, b, c)
    }
}
