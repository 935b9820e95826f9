
/// Vectors of three, of as many joints as a vector has lanes.
macro_rules! vectors {
    ($(#[$features:meta])?) => {
        $(#[$features])?
        #[inline]
        fn read<const N: usize>(from: &[impl Numbers]) -> [V; N] {
            let (mut x, from) = ([k(0.0); N], &from[..N]);
            for (x, from) in x.iter_mut().zip(from) {
                *x = load(from.numbers());
            }
            x
        }

        $(#[$features])?
        #[inline]
        fn three(x: &[V]) -> [V; 3] {
            [x[0], x[1], x[2]]
        }

        /// a + b
        $(#[$features])?
        #[inline]
        fn plus(a: [V; 3], b: [V; 3]) -> [V; 3] {
            [add(a[0], b[0]), add(a[1], b[1]), add(a[2], b[2])]
        }

        /// a − b
        $(#[$features])?
        #[inline]
        fn minus(a: [V; 3], b: [V; 3]) -> [V; 3] {
            [sub(a[0], b[0]), sub(a[1], b[1]), sub(a[2], b[2])]
        }

        /// a × b
        $(#[$features])?
        #[inline]
        fn cross(a: [V; 3], b: [V; 3]) -> [V; 3] {
            [fmsub(a[1], b[2], mul(a[2], b[1])), fmsub(a[2], b[0], mul(a[0], b[2])), fmsub(a[0], b[1], mul(a[1], b[0]))]
        }

        /// a × b + c
        $(#[$features])?
        #[inline]
        fn cross_and(a: [V; 3], b: [V; 3], c: [V; 3]) -> [V; 3] {
            [
                fmadd(a[1], b[2], fnmadd(a[2], b[1], c[0])),
                fmadd(a[2], b[0], fnmadd(a[0], b[2], c[1])),
                fmadd(a[0], b[1], fnmadd(a[1], b[0], c[2])),
            ]
        }

        /// a · b
        $(#[$features])?
        #[inline]
        fn dot(a: [V; 3], b: [V; 3]) -> V {
            fmadd(a[0], b[0], fmadd(a[1], b[1], mul(a[2], b[2])))
        }

        /// a · b + c
        $(#[$features])?
        #[inline]
        fn dot_and(a: [V; 3], b: [V; 3], c: V) -> V {
            fmadd(a[0], b[0], fmadd(a[1], b[1], fmadd(a[2], b[2], c)))
        }
    };
}

/// Matrices of four joints, and what is read and written of them.
macro_rules! matrices {
    ($(#[$features:meta])?) => {
        $(#[$features])?
        #[inline]
        fn write<const N: usize>(x: [V; N], to: &mut [Held]) {
            let to = &mut to[..N];
            for (x, to) in x.iter().zip(to) {
                to.write(array(*x));
            }
        }

        /// a s
        $(#[$features])?
        #[inline]
        fn times(a: [V; 3], s: V) -> [V; 3] {
            [mul(a[0], s), mul(a[1], s), mul(a[2], s)]
        }

        /// a s + c
        $(#[$features])?
        #[inline]
        fn times_and(a: [V; 3], s: V, c: [V; 3]) -> [V; 3] {
            [fmadd(a[0], s, c[0]), fmadd(a[1], s, c[1]), fmadd(a[2], s, c[2])]
        }

        /// M a, by rows.
        $(#[$features])?
        #[inline]
        fn product(m: &[V; 9], a: [V; 3]) -> [V; 3] {
            [dot(three(m), a), dot(three(&m[3..]), a), dot(three(&m[6..]), a)]
        }

        /// M a + c, by rows.
        $(#[$features])?
        #[inline]
        fn product_and(m: &[V; 9], a: [V; 3], c: [V; 3]) -> [V; 3] {
            [dot_and(three(m), a, c[0]), dot_and(three(&m[3..]), a, c[1]), dot_and(three(&m[6..]), a, c[2])]
        }

        /// A symmetric matrix, by rows.
        $(#[$features])?
        #[inline]
        fn symmetric(s: &[V]) -> [V; 9] {
            [s[0], s[3], s[4], s[3], s[1], s[5], s[4], s[5], s[2]]
        }

        /// tr(M) 1 − M, by rows.
        $(#[$features])?
        #[inline]
        fn complement(m: &[V; 9]) -> [V; 9] {
            [add(m[4], m[8]), neg(m[1]), neg(m[2]), neg(m[3]), add(m[0], m[8]), neg(m[5]), neg(m[6]), neg(m[7]), add(m[0], m[4])]
        }

        $(#[$features])?
        #[inline]
        fn transposed(m: &[V; 9]) -> [V; 9] {
            [m[0], m[3], m[6], m[1], m[4], m[7], m[2], m[5], m[8]]
        }

        /// Rows and columns of four by four exchanged.
        $(#[$features])?
        #[inline]
        fn turned(x: [V; 4]) -> [V; 4] {
            let [a, b, c, d] = [array(x[0]), array(x[1]), array(x[2]), array(x[3])];
            [lanes([a[0], b[0], c[0], d[0]]), lanes([a[1], b[1], c[1], d[1]]), lanes([a[2], b[2], c[2], d[2]]), lanes([a[3], b[3], c[3], d[3]])]
        }
    };
}
