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

/// What two joints of a block have to do with some of four.
struct Pair {
    /// The joints' block.
    at: u16,
    /// The path between the chunks; 0 if there is but one.
    path: u16,
    /// The others' block.
    others: u16,
    own: [Own; 2],
}

/// One of the two.
struct Own {
    lane: u16,
    /// Which of the others, a bit each; none of them if there is no second joint.
    which: u16,
    /// The place of lane 0 in the matrices, in the joint's row.
    place: u32,
}

/// Lanes by their bits: all bits of a number, or none.
static ASKED: [[u64; 4]; 16] = {
    let mut lanes = [[0; 4]; 16];
    let mut at = 0;
    while at < 64 {
        lanes[at / 4][at % 4] = 0_u64.wrapping_sub((at / 4) as u64 >> (at % 4) & 1);
        at += 1;
    }
    lanes
};

/// No group.
const APART: usize = usize::MAX;

/// Numbers of a matrix.
const MATRIX: usize = NV * NV;

/// A number of four joints. A sweep writes it before any sweep reads it.
type Held = ::core::mem::MaybeUninit<Four>;

/// Where four numbers stand.
trait Numbers {
    fn numbers(&self) -> &Four;
}

impl Numbers for Four {
    fn numbers(&self) -> &Four {
        self
    }
}

impl Numbers for Held {
    fn numbers(&self) -> &Four {
        // SAFETY: blocks without joints are zeros, and so is the root's. In all others:
        // * `inputs` writes the first two numbers of `drift` and the first three of `curl`. `places`
        //   reads these and no others.
        // * `places` writes all of `axis`, `shift` and `points`, x[..12] and x[24..]. `motion` writes
        //   x[12..24] and the rest of `drift` and `curl`. Both read numbers of parents, which stand in
        //   groups before their children: the tables are checked for that where they are written.
        // * Paths are read after the loop of `places` over all groups.
        // * `sums` writes all of `x` before it adds any of it to a parent. After `sums` nothing is
        //   left unwritten.
        unsafe { self.assume_init_ref() }
    }
}

/// What four joints have. Of twists and wrenches the angular part comes first; all are in the axes of the root body, each about the joint's origin. In pairs within lines of 64 bytes.
#[derive(::core::clone::Clone, ::core::marker::Copy)]
#[repr(C, align(64))]
struct Block {
    /// First R, r from the root, V, V̇ and r from the first of the chunk, then `sums`, then `wrenches`.
    x: [Held; 27],
    /// The joint's origin, from that of its parent.
    shift: [Held; 3],
    /// S.
    axis: [Held; 6],
    /// ψ̇ = V_λ × S, which is Ṡ too.
    drift: [Held; 6],
    /// ψ̈ = V̇_λ × S + V_λ × ψ̇.
    curl: [Held; 6],
    /// The joint's origin, from that of the first of its chunk, and from the root's.
    points: [Held; 6],
}

/// The blocks of all groups, filled up to a multiple of four, and the root body's.
#[repr(align(64))]
struct Bodies {
    blocks: [Block; BLOCKS],
    root: Block,
    /// The first is none.
    paths: [[f64; 3]; 1 + STEPS],
}

/// Four joints, not yet written: 20 kB of zeros for a humanoid would take a tenth of the time.
const UNKNOWN: Block = Block::filled(Held::uninit());

/// Zeros.
const NOTHING: Block = Block::filled(Held::new([0.0; 4]));

impl Block {
    const fn filled(x: Held) -> Self {
        Self { x: [x; 27], shift: [x; 3], axis: [x; 6], drift: [x; 6], curl: [x; 6], points: [x; 6] }
    }
}

const BLOCKS: usize = GROUPS.next_multiple_of(4);

impl Bodies {
    /// Blocks of joints that hold `unknown`, and zeros.
    fn new(unknown: Block) -> Self {
        let mut bodies = Self { blocks: [unknown; BLOCKS], root: NOTHING, paths: [[0.0; 3]; 1 + STEPS] };
        bodies.blocks[GROUPS..].fill(NOTHING);
        bodies
    }
}

/// Whether the lanes of a vector at `place` that `which` selects, a bit each, lie inside an array of so many numbers.
#[inline]
fn lies_in(numbers: usize, place: usize, which: u16) -> bool {
    let room = numbers.saturating_sub(place);
    room >= 4 || which >> room == 0
}

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
