
/// What each joint has, by sweeps from the root to the tips and back.
macro_rules! sweeps {
    ($(#[$features:meta])?) => {
        /// Numbers of the parents of a group.
        $(#[$features])?
        #[inline]
        fn parents<const N: usize>(bodies: &Bodies, group: &Group, first: usize) -> [V; N] {
            let block = |at: usize| bodies.blocks.get(at).unwrap_or(&bodies.root);
            if group.behind != APART {
                return read(&block(group.behind).x[first..first + N]);
            }
            let [a, b, c, d] = group.parents.map(|slot| (&block(slot as usize / 4).x, slot as usize % 4));
            let mut x = [k(0.0); N];
            for i in 0..N {
                x[i] = lanes([a, b, c, d].map(|(x, lane)| x[first + i].numbers()[lane]));
            }
            x
        }

        /// The root's motion, and for each joint its sine and cosine in the first two numbers of ψ̇, and q, q̇ and q̈ in those of ψ̈.
        $(#[$features])?
        #[inline(never)]
        fn inputs(bodies: &mut Bodies, root: &Root, q: &[f64; NQ], v: &[f64; NV], a: &[f64; NV]) {
            for i in 0..3 {
                bodies.root.x[4 * i].write([1.0; 4]);
                bodies.root.x[12 + i].write([root.angular[i]; 4]);
                bodies.root.x[18 + i].write([root.acceleration[i]; 4]);
                bodies.root.x[21 + i].write([root.acceleration[i + 3]; 4]);
            }
            for (block, group) in bodies.blocks.iter_mut().zip(TREE.iter()) {
                let q = group.q.map(|at| q[at as usize]);
                let turns = if SLIDES { mul(load(&q), sub(k(1.0), load(&group.slides))) } else { load(&q) };
                let (sin, cos) = sin_cos(turns);
                write([sin, cos], &mut block.drift);
                block.curl[0].write(q);
                block.curl[1].write(group.v.map(|at| v[at as usize]));
                block.curl[2].write(group.v.map(|at| a[at as usize]));
            }
        }

        /// R (9, by rows) and r of all bodies, and S of all joints.
        $(#[$features])?
        #[inline(never)]
        fn places(bodies: &mut Bodies) {
            for (g, group) in TREE.iter().enumerate() {
                let block = &bodies.blocks[g];
                let ([sin, cos], [q]) = (read(&block.drift), read(&block.curl));
                // R = R_λ X, X = the joint's frame turned about its z.
                let (r, fixed): ([V; 9], [V; 9]) = (parents(bodies, group, 0), read(&group.rotation));
                let x = product(&r, [fixed[0], fixed[3], fixed[6]]);
                let y = product(&r, [fixed[1], fixed[4], fixed[7]]);
                let z = product(&r, [fixed[2], fixed[5], fixed[8]]);
                let (x, y) = (times_and(y, sin, times(x, cos)), times_and(y, cos, times(x, neg(sin))));
                let mut shift = product(&r, read(&group.origin));
                let (mut angular, mut linear) = (z, [k(0.0); 3]);
                if SLIDES {
                    let slides = load(&group.slides);
                    shift = times_and(z, mul(q, slides), shift);
                    (angular, linear) = (times(z, sub(k(1.0), slides)), times(z, slides));
                }
                let origin = plus(parents(bodies, group, 9), shift);
                let near = times(plus(parents(bodies, group, 24), shift), load(&group.follows));
                let block = &mut bodies.blocks[g];
                write([x[0], y[0], z[0], x[1], y[1], z[1], x[2], y[2], z[2]], &mut block.x);
                write(origin, &mut block.x[9..]);
                write(near, &mut block.x[24..]);
                write(shift, &mut block.shift);
                write(near, &mut block.points);
                write(origin, &mut block.points[3..]);
                write(angular, &mut block.axis);
                write(linear, &mut block.axis[3..]);
            }
            for (at, path) in PATHS.iter().enumerate() {
                let block = |slot: u16| (&bodies.blocks[slot as usize / 4], slot as usize % 4);
                let ((first, lane), (on, beside)) = (block(path.first), block(path.on));
                let before = bodies.paths[path.before as usize];
                bodies.paths[1 + at] = ::core::array::from_fn(|i| before[i] + on.points[i].numbers()[beside] + first.shift[i].numbers()[lane]);
            }
        }

        /// V and V̇ of all bodies, ψ̇ and ψ̈ of all joints.
        $(#[$features])?
        #[inline(never)]
        fn motion(bodies: &mut Bodies) {
            for (g, group) in TREE.iter().enumerate() {
                // V = V_λ + S q̇, V̇ = V̇_λ + S q̈ + ψ̇ q̇
                let (w, dw) = (parents(bodies, group, 12), parents(bodies, group, 18));
                let (u, du) = (parents(bodies, group, 15), parents(bodies, group, 21));
                let block = &mut bodies.blocks[g];
                let shift = read(&block.shift);
                let (u, du) = (cross_and(w, shift, u), cross_and(dw, shift, du));
                let [v, a] = read(&block.curl[1..]);
                let angular = read(&block.axis);
                let mut drift = (cross(w, angular), cross(u, angular));
                let mut curl = cross(du, angular);
                let (mut twist, mut rate) = (u, du);
                if SLIDES {
                    let linear = read(&block.axis[3..]);
                    drift.1 = cross_and(w, linear, drift.1);
                    curl = cross_and(dw, linear, curl);
                    (twist, rate) = (times_and(linear, v, u), times_and(linear, a, du));
                }
                write(times_and(angular, v, w), &mut block.x[12..]);
                write(twist, &mut block.x[15..]);
                write(times_and(drift.0, v, times_and(angular, a, dw)), &mut block.x[18..]);
                write(times_and(drift.1, v, rate), &mut block.x[21..]);
                write(cross_and(w, drift.0, cross(dw, angular)), &mut block.curl);
                write(cross_and(u, drift.0, cross_and(w, drift.1, curl)), &mut block.curl[3..]);
                write(drift.0, &mut block.drift);
                write(drift.1, &mut block.drift[3..]);
            }
        }

        /// h, Σ (6), p, K (9, by rows) and F (moment, force), of every body and then of it and all beyond it.
        $(#[$features])?
        #[inline(never)]
        fn sums(bodies: &mut Bodies) {
            for (block, group) in bodies.blocks.iter_mut().zip(TREE.iter()) {
                let (r, mass): ([V; 9], V) = (read(&block.x), load(&group.mass));
                // h = R h', Σ = R Σ' Rᵀ
                let (first, second): ([V; 3], [V; 6]) = (product(&r, read(&group.first)), read(&group.second));
                let second = symmetric(&second);
                let rows = [three(&r), three(&r[3..]), three(&r[6..])];
                let half = [product(&second, rows[0]), product(&second, rows[1]), product(&second, rows[2])];
                let entry = |i: usize, j: usize| dot(half[i], rows[j]);
                let second = [entry(0, 0), entry(1, 1), entry(2, 2), entry(0, 1), entry(0, 2), entry(1, 2)];
                let (twist, acceleration) = (read(&block.x[12..]), read(&block.x[18..]));
                write(of_body(mass, first, second, twist, acceleration), &mut block.x);
            }
            let alone = |x: f64| lanes([x, 0.0, 0.0, 0.0]);
            let mut own = [k(0.0); 10];
            for (own, x) in own.iter_mut().zip(ROOT.iter()) {
                *own = alone(*x);
            }
            let [mass, x, y, z, second @ ..] = own;
            let (twist, acceleration) = (read(&bodies.root.x[12..]), read(&bodies.root.x[18..]));
            write(of_body(mass, [x, y, z], second, twist, acceleration), &mut bodies.root.x);
            for (g, group) in TREE.iter().enumerate().rev() {
                let (before, from) = bodies.blocks.split_at_mut(g);
                let handed = handed(read(&from[0].x), load(&group.beyond), read(&from[0].shift));
                if group.behind != APART {
                    let to = before.get_mut(group.behind).unwrap_or(&mut bodies.root);
                    for (to, from) in to.x.iter_mut().zip(handed) {
                        to.write(array(add(load(to.numbers()), from)));
                    }
                    continue;
                }
                let handed = handed.map(|x| array(x));
                for (lane, slot) in group.parents.iter().enumerate() {
                    let (to, at) = (before.get_mut(*slot as usize / 4).unwrap_or(&mut bodies.root), *slot as usize % 4);
                    for (to, from) in to.x.iter_mut().zip(&handed) {
                        let mut x = *to.numbers();
                        x[at] += from[lane];
                        to.write(x);
                    }
                }
            }
        }

        /// What `sums` has of a body and all beyond it, about the origin of its parent.
        $(#[$features])?
        #[inline]
        fn handed(x: [V; 27], mass: V, shift: [V; 3]) -> [V; 27] {
            let (own, momentum, force) = (three(&x), three(&x[9..]), three(&x[24..]));
            let first = times_and(shift, mass, own);
            let mut handed = x;
            handed[..3].copy_from_slice(&first);
            // Σ + d hᵀ + (h + m d) dᵀ
            for (at, &(i, j)) in [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)].iter().enumerate() {
                handed[3 + at] = fmadd(shift[i], own[j], fmadd(first[i], shift[j], x[3 + at]));
            }
            for (i, j) in [(0, 0), (0, 1), (0, 2), (1, 0), (1, 1), (1, 2), (2, 0), (2, 1), (2, 2)] {
                handed[12 + 3 * i + j] = fmadd(momentum[i], shift[j], x[12 + 3 * i + j]);
            }
            handed[21..24].copy_from_slice(&cross_and(shift, force, three(&x[21..])));
            handed
        }

        /// What moves with a joint, from its body and all beyond it: G S (6), 2 Bᵀ S (3), and with ψ̇ and ψ̈ what S meets of a joint before it,
        /// 2B ψ̇ + G ψ̈ + S ×* F and 2 (B S + G ψ̇). From then on groups are turned.
        $(#[$features])?
        #[inline(never)]
        fn wrenches(bodies: &mut Bodies) {
            for (block, group) in bodies.blocks.iter_mut().zip(TREE.iter()) {
                let (axis, drift, curl): ([V; 6], [V; 6], [V; 6]) = (read(&block.axis), read(&block.drift), read(&block.curl));
                let x: [V; 27] = read(&block.x);
                let sums = Sums { mass: load(&group.beyond), first: three(&x), second: complement(&symmetric(&x[3..])), momentum: three(&x[9..]), k: coriolis(&x) };
                let angular = three(&axis);
                let mut held = (product(&sums.second, angular), cross(angular, sums.first));
                let mut turning = product(&transposed(&sums.k), angular);
                let (w, twice) = (three(&drift), times(three(&drift), k(2.0)));
                let (moment, force) = sums.inertia(three(&curl), three(&curl[3..]));
                let (moment, force) = (product_and(&sums.k, twice, moment), cross_and(twice, sums.momentum, force));
                let mut moment = cross_and(angular, three(&x[21..]), moment);
                let force = cross_and(angular, three(&x[24..]), force);
                let by_v = sums.inertia(w, three(&drift[3..]));
                let by_v = (product_and(&sums.k, angular, by_v.0), cross_and(angular, sums.momentum, by_v.1));
                if SLIDES {
                    let linear = three(&axis[3..]);
                    held = (cross_and(sums.first, linear, held.0), times_and(linear, sums.mass, held.1));
                    turning = cross_and(sums.momentum, linear, turning);
                    moment = cross_and(linear, three(&x[24..]), moment);
                }
                write(held.0, &mut block.x[..3]);
                write(held.1, &mut block.x[3..6]);
                write(times(turning, k(2.0)), &mut block.x[6..9]);
                write(moment, &mut block.x[9..12]);
                write(force, &mut block.x[12..15]);
                write(times(by_v.0, k(2.0)), &mut block.x[15..18]);
                write(times(by_v.1, k(2.0)), &mut block.x[18..21]);
            }
            for tile in bodies.blocks.as_chunks_mut().0 {
                turn(tile);
            }
        }

        /// m, h, tr(Σ) 1 − Σ, p and tr(K) 1 − K.
        struct Sums {
            mass: V,
            first: [V; 3],
            second: [V; 9],
            momentum: [V; 3],
            k: [V; 9],
        }

        impl Sums {
            /// The wrench G V.
            $(#[$features])?
            #[inline]
            fn inertia(&self, angular: [V; 3], linear: [V; 3]) -> ([V; 3], [V; 3]) {
                (
                    cross_and(self.first, linear, product(&self.second, angular)),
                    cross_and(angular, self.first, times(linear, self.mass)),
                )
            }
        }

        /// tr(K) 1 − K of what `sums` wrote.
        $(#[$features])?
        #[inline]
        fn coriolis(x: &[V; 27]) -> [V; 9] {
            complement(&[x[12], x[13], x[14], x[15], x[16], x[17], x[18], x[19], x[20]])
        }

        /// What `sums` adds up: p = m v + ω × h, K = v hᵀ + [ω]× Σ, F = G V̇ + B ω.
        $(#[$features])?
        #[inline]
        fn of_body(mass: V, first: [V; 3], second: [V; 6], twist: [V; 6], acceleration: [V; 6]) -> [V; 27] {
            let (w, u) = (three(&twist), three(&twist[3..]));
            let s = symmetric(&second);
            let momentum = cross_and(w, first, times(u, mass));
            let column = |i: usize| cross_and(w, three(&s[3 * i..]), times(u, first[i]));
            let (a, b, c) = (column(0), column(1), column(2));
            let rows = [a[0], b[0], c[0], a[1], b[1], c[1], a[2], b[2], c[2]];
            let sums = Sums { mass, first, second: complement(&s), momentum, k: complement(&rows) };
            let (moment, force) = sums.inertia(three(&acceleration), three(&acceleration[3..]));
            let (moment, force) = (product_and(&sums.k, w, moment), cross_and(w, momentum, force));
            let mut all = [k(0.0); 27];
            all[..3].copy_from_slice(&first);
            all[3..9].copy_from_slice(&second);
            all[9..12].copy_from_slice(&momentum);
            all[12..21].copy_from_slice(&rows);
            all[21..24].copy_from_slice(&moment);
            all[24..].copy_from_slice(&force);
            all
        }

        /// Four groups turned: what was lane l of each becomes block l.
        $(#[$features])?
        #[inline]
        fn turn([a, b, c, d]: &mut [Block; 4]) {
            turn_each([&mut a.x[..22], &mut b.x[..22], &mut c.x[..22], &mut d.x[..22]]);
            turn_each([&mut a.axis, &mut b.axis, &mut c.axis, &mut d.axis]);
            turn_each([&mut a.drift, &mut b.drift, &mut c.drift, &mut d.drift]);
            turn_each([&mut a.curl, &mut b.curl, &mut c.curl, &mut d.curl]);
            turn_each([&mut a.points, &mut b.points, &mut c.points, &mut d.points]);
        }
    };
}
