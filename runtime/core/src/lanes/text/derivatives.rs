/// A number of four joints, a lane each.
type Four = [f64; 4];

/// What does not change of four joints and the bodies that they carry. A place for a joint is a *slot*; slot 4g + l is lane l of group g.
struct Group {
    /// The group of the parents if each stands in the same lane as its child; [`APART`] if not.
    behind: usize,
    /// Slots of the parents.
    parents: [u16; 4],
    /// Places in q and in v.
    q: [u16; 4],
    v: [u16; 4],
    /// One where the joint slides, zero where it turns.
    slides: Four,
    /// One where the parent is the joint before it in its chunk.
    follows: Four,
    /// The joint's frame in the parent's: rotation, row by row, and origin.
    rotation: [Four; 9],
    origin: [Four; 3],
    /// m, h = m c, Σ (xx, yy, zz, xy, xz, yz) of the body, in its own frame.
    mass: Four,
    first: [Four; 3],
    second: [Four; 6],
    /// m of the body and all beyond it.
    beyond: Four,
}

/// Joints side by side in block `at`, once groups are turned: those of a chain, whose columns are side by side too.
struct Chunk {
    at: usize,
    /// Which lanes, a bit each.
    which: u16,
    /// The column of lane 0.
    column: usize,
}

/// From the first joint of a chunk before another to the first joint of that other.
struct Path {
    /// The path to the chunk that this one stands on; 0 if that is where the path begins.
    before: u16,
    /// Slots of the first joint and of the one that it stands on.
    first: u16,
    on: u16,
}

/// What one joint has to do with some of four.
struct Pair {
    /// Its block and lane.
    at: u16,
    lane: u16,
    /// The path between their chunks; 0 if there is but one.
    path: u16,
    /// The others' block, and which of them, a bit each.
    others: u16,
    which: u16,
    /// The place of lane 0 in the matrices, in the joint's row.
    place: u32,
}

/// Lanes by their bits.
static ASKED: [Four; 16] = {
    let mut lanes = [[0.0; 4]; 16];
    let mut at = 0;
    while at < 64 {
        lanes[at / 4][at % 4] = ((at / 4) >> (at % 4) & 1) as f64;
        at += 1;
    }
    lanes
};

/// No group.
const APART: usize = usize::MAX;

/// Numbers of a matrix.
const MATRIX: usize = NV * NV;

/// What four joints have. Of twists and wrenches the angular part comes first; all are in the axes of the root body, each about the joint's origin.
#[derive(::core::clone::Clone, ::core::marker::Copy)]
#[repr(align(32))]
struct Block {
    /// First R, r from the root, V, V̇ and r from the first of the chunk, then `sums`, then `wrenches`.
    x: [Four; 27],
    /// S.
    axis: [Four; 6],
    /// ψ̇ = V_λ × S, which is Ṡ too.
    drift: [Four; 6],
    /// ψ̈ = V̇_λ × S + V_λ × ψ̇.
    curl: [Four; 6],
    /// The joint's origin, from that of its parent, of the first of its chunk and of the root.
    shift: [Four; 3],
    near: [Four; 3],
    origin: [Four; 3],
}

/// The blocks of all groups, filled up to a multiple of four, and the root body's.
#[repr(align(64))]
struct Bodies {
    blocks: [Block; BLOCKS],
    root: Block,
    /// The first is none.
    paths: [[f64; 3]; 1 + STEPS],
}

/// Zeros.
const NOTHING: Block = Block {
    x: [[0.0; 4]; 27],
    axis: [[0.0; 4]; 6],
    drift: [[0.0; 4]; 6],
    curl: [[0.0; 4]; 6],
    shift: [[0.0; 4]; 3],
    near: [[0.0; 4]; 3],
    origin: [[0.0; 4]; 3],
};

const BLOCKS: usize = GROUPS.next_multiple_of(4);

/// The root body's motion.
struct Root {
    /// ω and v, and V̇ on top of −g, in the inertial frame that moves as the body's origin does.
    angular: [f64; 3],
    linear: [f64; 3],
    acceleration: [f64; 6],
    /// −g.
    falling: [f64; 3],
}

impl Root {
    fn new(q: &[f64; NQ], v: &[f64; NV], a: &[f64; NV]) -> Self {
        let (x, y, z, w) = (q[3], q[4], q[5], q[6]);
        let rows = [
            [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - z * w), 2.0 * (x * z + y * w)],
            [2.0 * (x * y + z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - x * w)],
            [2.0 * (x * z - y * w), 2.0 * (y * z + x * w), 1.0 - 2.0 * (x * x + y * y)],
        ];
        let falling: [f64; 3] = ::core::array::from_fn(|i| -(rows[0][i] * GRAVITY[0] + rows[1][i] * GRAVITY[1] + rows[2][i] * GRAVITY[2]));
        let (angular, linear) = ([v[0], v[1], v[2]], [v[3], v[4], v[5]]);
        let turning = cross_of(angular, linear);
        let acceleration = ::core::array::from_fn(|i| if i < 3 { a[i] } else { falling[i - 3] + a[i] + turning[i - 3] });
        Self { angular, linear, acceleration, falling }
    }
}

fn cross_of(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

macro_rules! derivatives {
    ($(#[$features:meta])?) => {
        $(#[$features])?
        #[inline]
        fn read<const N: usize>(from: &[Four]) -> [V; N] {
            let (mut x, from) = ([k(0.0); N], &from[..N]);
            for (x, from) in x.iter_mut().zip(from) {
                *x = load(from);
            }
            x
        }

        $(#[$features])?
        #[inline]
        fn write<const N: usize>(x: [V; N], to: &mut [Four]) {
            let to = &mut to[..N];
            for (x, to) in x.iter().zip(to) {
                store(*x, to);
            }
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
                x[i] = lanes([a.0[first + i][a.1], b.0[first + i][b.1], c.0[first + i][c.1], d.0[first + i][d.1]]);
            }
            x
        }

        /// The root's motion, and for each joint its sine and cosine in the first two numbers of ψ̇, and q, q̇ and q̈ in those of ψ̈.
        $(#[$features])?
        #[inline(never)]
        fn inputs(bodies: &mut Bodies, root: &Root, q: &[f64; NQ], v: &[f64; NV], a: &[f64; NV]) {
            for i in 0..3 {
                bodies.root.x[4 * i] = [1.0; 4];
                bodies.root.x[12 + i] = [root.angular[i]; 4];
                bodies.root.x[18 + i] = [root.acceleration[i]; 4];
                bodies.root.x[21 + i] = [root.acceleration[i + 3]; 4];
            }
            for (block, group) in bodies.blocks.iter_mut().zip(TREE.iter()) {
                let q = group.q.map(|at| q[at as usize]);
                let turns = if SLIDES { mul(load(&q), sub(k(1.0), load(&group.slides))) } else { load(&q) };
                let (sin, cos) = sin_cos(turns);
                write([sin, cos], &mut block.drift);
                block.curl[0] = q;
                block.curl[1] = group.v.map(|at| v[at as usize]);
                block.curl[2] = group.v.map(|at| a[at as usize]);
            }
        }

        /// R (9, by rows) and r of all bodies, and S of all joints.
        $(#[$features])?
        #[inline(never)]
        fn places(bodies: &mut Bodies) {
            for (g, group) in TREE.iter().enumerate() {
                let block = &bodies.blocks[g];
                let (sin, cos, q) = (load(&block.drift[0]), load(&block.drift[1]), load(&block.curl[0]));
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
                write(near, &mut block.near);
                write(origin, &mut block.origin);
                write(angular, &mut block.axis);
                write(linear, &mut block.axis[3..]);
            }
            for (at, path) in PATHS.iter().enumerate() {
                let block = |slot: u16| (&bodies.blocks[slot as usize / 4], slot as usize % 4);
                let ((first, lane), (on, beside)) = (block(path.first), block(path.on));
                bodies.paths[1 + at] =
                    ::core::array::from_fn(|i| bodies.paths[path.before as usize][i] + on.near[i][beside] + first.shift[i][lane]);
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
                let (v, a) = (load(&block.curl[1]), load(&block.curl[2]));
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
                        store(add(load(to), from), to);
                    }
                    continue;
                }
                let handed = handed.map(|x| array(x));
                for (lane, slot) in group.parents.iter().enumerate() {
                    let (to, at) = (before.get_mut(*slot as usize / 4).unwrap_or(&mut bodies.root), *slot as usize % 4);
                    for (to, from) in to.x.iter_mut().zip(&handed) {
                        to[at] += from[lane];
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
        fn turn(tile: &mut [Block; 4]) {
            let [a, b, c, d] = tile;
            let each = |a: &mut [Four], b: &mut [Four], c: &mut [Four], d: &mut [Four]| {
                for (((a, b), c), d) in a.iter_mut().zip(b).zip(c).zip(d) {
                    let x = turned([load(a), load(b), load(c), load(d)]);
                    store(x[0], a);
                    store(x[1], b);
                    store(x[2], c);
                    store(x[3], d);
                }
            };
            each(&mut a.x[..21], &mut b.x[..21], &mut c.x[..21], &mut d.x[..21]);
            let used = if SLIDES { 6 } else { 3 };
            each(&mut a.axis[..used], &mut b.axis[..used], &mut c.axis[..used], &mut d.axis[..used]);
            each(&mut a.drift, &mut b.drift, &mut c.drift, &mut d.drift);
            each(&mut a.curl, &mut b.curl, &mut c.curl, &mut d.curl);
            each(&mut a.near, &mut b.near, &mut c.near, &mut d.near);
            each(&mut a.origin, &mut b.origin, &mut c.origin, &mut d.origin);
        }

        $(#[$features])?
        fn derivatives(q: &[f64; NQ], v: &[f64; NV], a: &[f64; NV], out: &mut [f64; 3 * MATRIX]) {
            let mut bodies = Bodies { blocks: [NOTHING; BLOCKS], root: NOTHING, paths: [[0.0; 3]; 1 + STEPS] };
            let root = Root::new(q, v, a);
            inputs(&mut bodies, &root, q, v, a);
            places(&mut bodies);
            motion(&mut bodies);
            sums(&mut bodies);
            wrenches(&mut bodies);
            out.fill(0.0);
            with_root(&bodies, &root, out);
            pairs(&bodies, out);
            root_alone(&bodies, &root, out);
        }
    };
}

/// ∂τ/∂q, ∂τ/∂v and ∂τ/∂a.
pub(super) fn inverse_dynamics_derivatives(q: &[f64; NQ], v: &[f64; NV], a: &[f64; NV], out: &mut [[[f64; NV]; NV]; 3]) {
    if let ::core::option::Option::Some(out) = out.as_flattened_mut().as_flattened_mut().first_chunk_mut() {
        chosen(q, v, a, out);
    }
}

fn chosen(q: &[f64; NQ], v: &[f64; NV], a: &[f64; NV], out: &mut [f64; 3 * MATRIX]) {
    #[cfg(target_arch = "x86_64")]
    {
        use super::avx2_f64x4::*;
        derivatives!(#[target_feature(enable = "avx2,fma")]);
        #[cfg(all(target_arch = "x86_64", not(all(target_feature = "avx2", target_feature = "fma"))))]
        if ::std::is_x86_feature_detected!("avx2") && ::std::is_x86_feature_detected!("fma") {
            // SAFETY: the processor was just asked for both.
            return unsafe { derivatives(q, v, a, out) };
        }
        #[cfg(all(target_feature = "avx2", target_feature = "fma"))]
        // SAFETY: this is compiled for processors with both.
        return unsafe { derivatives(q, v, a, out) };
    }
    #[cfg(target_arch = "aarch64")]
    {
        use super::neon_f64x4::*;
        derivatives!(#[target_feature(enable = "neon")]);
        // SAFETY: every 64-bit Arm processor has it.
        return unsafe { derivatives(q, v, a, out) };
    }
    #[cfg(not(any(target_arch = "aarch64", all(target_arch = "x86_64", target_feature = "avx2", target_feature = "fma"))))]
    {
        use super::portable_f64x4::*;
        derivatives!();
        derivatives(q, v, a, out)
    }
}
