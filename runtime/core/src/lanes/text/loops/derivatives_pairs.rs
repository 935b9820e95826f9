
/// What joints have to do with the root, into the matrices.
macro_rules! rooted {
    ($(#[$features:meta])?) => {
        /// Rows and columns of the root's degrees of freedom.
        $(#[$features])?
        #[inline(never)]
        fn with_root(bodies: &Bodies, root: &Root, out: &mut [f64; 3 * MATRIX]) {
            for chunk in CHUNKS.iter() {
                let (block, which) = (&bodies.blocks[chunk.at], chunk.which);
                let origin = read(&block.points[3..]);
                // About the root's origin.
                let wrench = |at: usize| {
                    let force: [V; 3] = read(&block.x[at + 3..]);
                    (cross_and(origin, force, read(&block.x[at..])), force)
                };
                let wrenches = [wrench(9), wrench(15), wrench(0)];
                for (matrix, (moment, force)) in wrenches.iter().enumerate() {
                    for i in 0..3 {
                        let place = matrix * MATRIX + i * NV + chunk.column;
                        mix(moment[i], which, out, place);
                        mix(force[i], which, out, place + 3 * NV);
                    }
                }
                let ([_, _, ([a, b, c], [d, e, f])], [g, h, i]) = (wrenches, read(&block.x[6..]));
                let rows = against_root(root, [a, b, c, d, e, f, g, h, i]);
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

        /// The root's degrees of freedom with one another.
        $(#[$features])?
        #[inline(never)]
        fn root_alone(bodies: &Bodies, root: &Root, out: &mut [f64; 3 * MATRIX]) {
            let mut x = [k(0.0); 27];
            for (x, from) in x.iter_mut().zip(&bodies.root.x) {
                *x = across(load(from.numbers()));
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

/// What joints have to do with one another, into the matrices: as many of two joints at once as have room, each with four others.
macro_rules! pairings {
    ($(#[$features:meta])?) => {
        /// What joints bring along to meet those before them: their origins, and of G S force, turning and moment.
        $(#[$features])?
        #[inline]
        fn acting(bodies: &Bodies, pair: &Pair, own: &[Own; OWN]) -> [[V; 3]; 4] {
            let Block { points, x, .. } = &bodies.blocks[pair.at as usize];
            [of_each(points, own), of_each(&x[3..], own), of_each(&x[6..], own), of_each(x, own)]
        }

        /// What joints bring along to meet those beyond them: their origins, and S.
        $(#[$features])?
        #[inline]
        fn moving(bodies: &Bodies, pair: &Pair, own: &[Own; OWN]) -> [[V; 3]; 3] {
            let Block { points, axis, .. } = &bodies.blocks[pair.at as usize];
            [of_each(points, own), of_each(axis, own), if SLIDES { of_each(&axis[3..], own) } else { [k(0.0); 3] }]
        }

        $(#[$features])?
        #[inline]
        fn before(bodies: &Bodies, pair: &Pair, own: &[Own; OWN], [points, force, turning, moment]: [[V; 3]; 4], out: &mut [f64; 3 * MATRIX]) {
            let ((others, path), rows) = (meeting(bodies, pair), rows(own));
            // G S about the origins of the others.
            let arm = minus(plus(points, path), read(&others.points));
            let moment = cross_and(arm, force, moment);
            let (axis, drift, curl): ([V; 6], [V; 6], [V; 6]) = (read(&others.axis), read(&others.drift), read(&others.curl));
            let mut by_a = dot(moment, three(&axis));
            if SLIDES {
                by_a = dot_and(force, three(&axis[3..]), by_a);
            }
            let by_q = dot_and(moment, three(&curl), dot_and(force, three(&curl[3..]), dot(turning, three(&drift))));
            let twice = dot_and(moment, three(&drift), dot(force, three(&drift[3..])));
            put(by_q, rows, out, 0);
            put(fmadd(twice, k(2.0), dot(turning, three(&axis))), rows, out, 1);
            put(by_a, rows, out, 2);
        }

        $(#[$features])?
        #[inline]
        fn beyond(bodies: &Bodies, pair: &Pair, own: &[Own; OWN], [points, angular, slide]: [[V; 3]; 3], out: &mut [f64; 3 * MATRIX]) {
            let ((others, path), rows) = (meeting(bodies, pair), rows(own));
            // S about the origins of the others.
            let arm = minus(read(&others.points), minus(points, path));
            let mut linear = cross(angular, arm);
            if SLIDES {
                linear = plus(linear, slide);
            }
            let x: [V; 21] = read(&others.x);
            for (matrix, &at) in [9, 15, 0].iter().enumerate() {
                put(dot_and(linear, three(&x[at + 3..]), dot(angular, three(&x[at..]))), rows, out, matrix);
            }
        }

        /// The block of the others, and the path between the first joints of their chunks.
        $(#[$features])?
        #[inline]
        fn meeting<'a>(bodies: &'a Bodies, pair: &Pair) -> (&'a Block, [V; 3]) {
            let path = &bodies.paths[pair.path as usize];
            (&bodies.blocks[pair.others as usize], [k(path[0]), k(path[1]), k(path[2])])
        }

        /// Three numbers of each of the two, in all of its lanes.
        $(#[$features])?
        #[inline]
        fn of_each(x: &[Held], own: &[Own; OWN]) -> [V; 3] {
            [each(&x[0], own), each(&x[1], own), each(&x[2], own)]
        }
    };
}

/// What differs between processors, in vectors of four.
macro_rules! narrow {
    ($(#[$features:meta])?) => {
        /// Of two joints, one at a time.
        const OWN: usize = 1;

        /// Rows of joints with themselves and with those before them, and with those beyond them. What a joint brings along is read for each pair anew: sixteen registers do not hold it.
        $(#[$features])?
        #[inline(never)]
        fn pairs(bodies: &Bodies, out: &mut [f64; 3 * MATRIX]) {
            for pair in BEFORE.iter() {
                for own in pair.own.as_chunks().0 {
                    if own[0].which != 0 {
                        before(bodies, pair, own, acting(bodies, pair, own), out);
                    }
                }
            }
            for pair in BEYOND.iter() {
                for own in pair.own.as_chunks().0 {
                    if own[0].which != 0 {
                        beyond(bodies, pair, own, moving(bodies, pair, own), out);
                    }
                }
            }
        }

        /// A joint's number in all lanes.
        $(#[$features])?
        #[inline]
        fn each(x: &Held, own: &[Own; OWN]) -> V {
            k(x.numbers()[own[0].lane as usize % 4])
        }

        /// A joint's rows: each is looked at by itself.
        type Rows<'a> = &'a [Own; OWN];

        #[inline]
        fn rows(own: &[Own; OWN]) -> Rows<'_> {
            own
        }

        /// A joint's row, into one of the matrices.
        $(#[$features])?
        #[inline]
        fn put(x: V, own: Rows<'_>, out: &mut [f64; 3 * MATRIX], matrix: usize) {
            mix(x, own[0].which, out, own[0].place as usize + matrix * MATRIX);
        }

        /// The lanes asked for, into the matrices. Not a vector selected by a mask: compilers make a masked store of that, which takes a processor without AVX-512 a dozen cycles.
        $(#[$features])?
        #[inline]
        fn mix(x: V, which: u16, out: &mut [f64; 3 * MATRIX], place: usize) {
            let (x, which) = (array(x), &ASKED[which as usize % 16]);
            let mixed = |lane: usize, old: f64| f64::from_bits(x[lane].to_bits() & which[lane] | old.to_bits() & !which[lane]);
            match out.get_mut(place..place + 4).and_then(|to| to.first_chunk_mut::<4>()) {
                ::core::option::Option::Some(to) => *to = [mixed(0, to[0]), mixed(1, to[1]), mixed(2, to[2]), mixed(3, to[3])],
                ::core::option::Option::None => {
                    for (lane, to) in out[place..].iter_mut().enumerate() {
                        *to = mixed(lane, *to);
                    }
                }
            }
        }

        /// The same numbers of four groups, turned.
        $(#[$features])?
        #[inline]
        fn turn_each([a, b, c, d]: [&mut [Held]; 4]) {
            for (((a, b), c), d) in a.iter_mut().zip(b).zip(c).zip(d) {
                let x = turned_from([a.numbers(), b.numbers(), c.numbers(), d.numbers()]);
                a.write(array(x[0]));
                b.write(array(x[1]));
                c.write(array(x[2]));
                d.write(array(x[3]));
            }
        }

        pairings!($(#[$features])?);
    };
}
