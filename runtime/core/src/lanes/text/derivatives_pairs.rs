
/// What joints have to do with one another and with the root, into the matrices.
macro_rules! pairings {
    ($(#[$features:meta])?) => {
        /// The lanes asked for, into the matrices.
        $(#[$features])?
        #[inline]
        fn mix(x: V, which: &Four, out: &mut [f64; 3 * MATRIX], place: usize) {
            match out.get_mut(place..place + 4).and_then(|to| to.first_chunk_mut()) {
                ::core::option::Option::Some(to) => store(select(positive(load(which)), x, load(to)), to),
                ::core::option::Option::None => {
                    for ((to, x), which) in out[place..].iter_mut().zip(array(x)).zip(which) {
                        *to = if *which > 0.0 { x } else { *to };
                    }
                }
            }
        }

        /// Rows and columns of the root's degrees of freedom.
        $(#[$features])?
        #[inline(never)]
        fn with_root(bodies: &Bodies, root: &Root, out: &mut [f64; 3 * MATRIX]) {
            for chunk in CHUNKS.iter() {
                let (block, which) = (&bodies.blocks[chunk.at], &ASKED[chunk.which as usize % 16]);
                let (mut x, origin): ([V; 21], [V; 3]) = (read(&block.x), read(&block.origin));
                // About the root's origin.
                for at in [0, 9, 15] {
                    let moment = cross_and(origin, three(&x[at + 3..]), three(&x[at..]));
                    x[at..at + 3].copy_from_slice(&moment);
                }
                for i in 0..6 {
                    let place = i * NV + chunk.column;
                    mix(x[9 + i], which, out, place);
                    mix(x[15 + i], which, out, place + MATRIX);
                    mix(x[i], which, out, place + 2 * MATRIX);
                }
                let rows = against_root(root, [x[0], x[1], x[2], x[3], x[4], x[5], x[6], x[7], x[8]]);
                for (i, rows) in rows.iter().enumerate().filter(|(i, _)| chunk.which >> i & 1 == 1) {
                    let place = (chunk.column + i) * NV;
                    out[place..place + 4].copy_from_slice(&rows[0]);
                    out[place + MATRIX..place + MATRIX + 4].copy_from_slice(&rows[1]);
                    out[place + MATRIX + 4..place + MATRIX + 6].copy_from_slice(&rows[2][..2]);
                    out[place + 2 * MATRIX..place + 2 * MATRIX + 4].copy_from_slice(&rows[3]);
                    out[place + 2 * MATRIX + 4..place + 2 * MATRIX + 6].copy_from_slice(&rows[2][2..]);
                }
            }
        }

        /// Rows of joints with themselves and with those before them, and with those beyond them.
        $(#[$features])?
        #[inline(never)]
        fn pairs(bodies: &Bodies, out: &mut [f64; 3 * MATRIX]) {
            for pair in BEFORE.iter() {
                let (own, others, lane) = (&bodies.blocks[pair.at as usize], &bodies.blocks[pair.others as usize], pair.lane as usize % 4);
                let (which, place) = (&ASKED[pair.which as usize % 16], pair.place as usize);
                // G S about the origins of the others.
                let arm = minus(from_first(bodies, pair, own, 1.0), read(&others.near));
                let x = |i: usize| k(own.x[i][lane]);
                let (force, turning) = ([x(3), x(4), x(5)], [x(6), x(7), x(8)]);
                let moment = cross_and(arm, force, [x(0), x(1), x(2)]);
                let (axis, drift, curl): ([V; 6], [V; 6], [V; 6]) = (read(&others.axis), read(&others.drift), read(&others.curl));
                let mut by_a = dot(moment, three(&axis));
                if SLIDES {
                    by_a = dot_and(force, three(&axis[3..]), by_a);
                }
                let by_q = dot_and(turning, three(&drift), dot_and(force, three(&curl[3..]), dot(moment, three(&curl))));
                let twice = dot_and(force, three(&drift[3..]), dot(moment, three(&drift)));
                mix(by_q, which, out, place);
                mix(fmadd(twice, k(2.0), dot(turning, three(&axis))), which, out, place + MATRIX);
                mix(by_a, which, out, place + 2 * MATRIX);
            }
            for pair in BEYOND.iter() {
                let (own, others, lane) = (&bodies.blocks[pair.at as usize], &bodies.blocks[pair.others as usize], pair.lane as usize % 4);
                let (which, place) = (&ASKED[pair.which as usize % 16], pair.place as usize);
                // S about the origins of the others.
                let arm = minus(read(&others.near), from_first(bodies, pair, own, -1.0));
                let angular = [k(own.axis[0][lane]), k(own.axis[1][lane]), k(own.axis[2][lane])];
                let mut linear = cross(angular, arm);
                if SLIDES {
                    linear = plus(linear, [k(own.axis[3][lane]), k(own.axis[4][lane]), k(own.axis[5][lane])]);
                }
                let x: [V; 21] = read(&others.x);
                let power = |at: usize| dot_and(linear, three(&x[at + 3..]), dot(angular, three(&x[at..])));
                mix(power(9), which, out, place);
                mix(power(15), which, out, place + MATRIX);
                mix(power(0), which, out, place + 2 * MATRIX);
            }
        }

        /// The joint's origin, from that of the first joint of the others' chunk; the sign says which of the two chunks the path begins at.
        $(#[$features])?
        #[inline]
        fn from_first(bodies: &Bodies, pair: &Pair, own: &Block, sign: f64) -> [V; 3] {
            let (path, lane) = (&bodies.paths[pair.path as usize], pair.lane as usize % 4);
            [k(own.near[0][lane] + sign * path[0]), k(own.near[1][lane] + sign * path[1]), k(own.near[2][lane] + sign * path[2])]
        }

        /// The root's degrees of freedom with one another.
        $(#[$features])?
        #[inline(never)]
        fn root_alone(bodies: &Bodies, root: &Root, out: &mut [f64; 3 * MATRIX]) {
            let mut x = [k(0.0); 27];
            for (x, from) in x.iter_mut().zip(&bodies.root.x) {
                *x = across(load(from));
            }
            let sums = Sums { mass: k(MASS), first: three(&x), second: complement(&symmetric(&x[3..])), momentum: three(&x[9..]), k: coriolis(&x) };
            // Turns about x, y, z in lanes, then moves along them.
            for (first, angular, linear) in [(0, 1.0, 0.0), (3, 0.0, 1.0)] {
                let unit = |x: f64| [lanes([x, 0.0, 0.0, 0.0]), lanes([0.0, x, 0.0, 0.0]), lanes([0.0, 0.0, x, 0.0])];
                let held = sums.inertia(unit(angular), unit(linear));
                let turning = cross_and(sums.momentum, unit(linear), product(&transposed(&sums.k), unit(angular)));
                let turning = times(turning, k(2.0));
                let x = [held.0[0], held.0[1], held.0[2], held.1[0], held.1[1], held.1[2], turning[0], turning[1], turning[2]];
                for (i, rows) in against_root(root, x).iter().enumerate().take(3) {
                    let place = (first + i) * NV;
                    out[place..place + 6].copy_from_slice(&[rows[0][0], rows[0][1], rows[0][2], 0.0, 0.0, 0.0]);
                    out[place + MATRIX..place + MATRIX + 6].copy_from_slice(&[rows[1][0], rows[1][1], rows[1][2], rows[1][3], rows[2][0], rows[2][1]]);
                    out[place + 2 * MATRIX..place + 2 * MATRIX + 6].copy_from_slice(&[rows[3][0], rows[3][1], rows[3][2], rows[3][3], rows[2][2], rows[2][3]]);
                }
            }
        }

        /// What G S and 2 Bᵀ S of four joints have to do with the root's degrees of freedom, a joint a row: of ∂τ/∂q the first three and a zero, of ∂τ/∂v the first four, the
        /// last two of ∂τ/∂v and of ∂τ/∂a, and the first four of that.
        $(#[$features])?
        #[inline]
        fn against_root(root: &Root, x: [V; 9]) -> [[Four; 4]; 4] {
            let of = |x: [f64; 3]| [k(x[0]), k(x[1]), k(x[2])];
            let (moment, force, turning) = (three(&x), three(&x[3..]), three(&x[6..]));
            let (w, u) = (of(root.angular), of(root.linear));
            let by_q = cross(force, of(root.falling));
            let by_angular = cross_and(u, force, cross_and(moment, w, turning));
            let by_linear = cross(force, w);
            let columns = [
                turned([by_q[0], by_q[1], by_q[2], k(0.0)]),
                turned([by_angular[0], by_angular[1], by_angular[2], by_linear[0]]),
                turned([by_linear[1], by_linear[2], force[1], force[2]]),
                turned([moment[0], moment[1], moment[2], force[0]]),
            ];
            ::core::array::from_fn(|i| ::core::array::from_fn(|j| array(columns[j][i])))
        }
    };
}
