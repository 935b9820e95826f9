//! Random robots: arbitrary trees with everything that a description can contain.

use std::f64::consts::{FRAC_PI_2, PI};

use articulated_core::description::{Description, Inertial, Joint, JointDynamics, JointId, JointKind, Limit, Link, LinkId, Mimic, Origin};

use crate::random::Random;

/// Possible contents of a tree.
#[derive(Clone, Copy, Debug)]
pub struct Flavour {
    /// Links without mass, and point masses: the mass matrix may be singular.
    pub massless: bool,
    /// Joints that follow others.
    pub mimic: bool,
    /// Of these, many by polynomials of a degree up to four.
    pub bent: bool,
    /// Floating joints inside the tree.
    pub floating: bool,
    /// Fixed joints.
    pub fixed: bool,
    /// Planar, spherical, helical and universal joints.
    pub every_kind: bool,
    /// Joints locked at a value, which a URDF has no word for.
    pub locked: bool,
    /// Greatest number of links.
    pub links: usize,
}

impl Flavour {
    /// Everything.
    pub const ANY: Self =
        Self { massless: true, mimic: true, bent: false, floating: true, fixed: true, every_kind: true, locked: true, links: 12 };
    /// Everything, and many joints that follow others, most by polynomials.
    pub const BENT: Self = Self { bent: true, ..Self::ANY };
    /// All that a URDF can contain.
    pub const WRITTEN: Self = Self { locked: false, ..Self::ANY };
    /// Every link has a body's inertia, so that the mass matrix is positive definite.
    pub const REGULAR: Self = Self { massless: false, ..Self::ANY };
}

/// The tree of a seed. Its joints and links are listed in random order, also children before
/// parents.
pub fn random_tree(seed: u64, flavour: Flavour) -> Description {
    let random = &mut Random::new(seed);
    let links = 1 + random.below(flavour.links);
    let chain = random.chance(0.3);
    let mut description = Description { name: format!("tree_{seed}"), ..Description::default() };
    description.links =
        (0..links).map(|k| Link { name: format!("link_{k}"), inertial: inertial(random, flavour), ..Link::default() }).collect();
    description.joints = (1..links)
        .map(|child| {
            let parent = if chain { child - 1 } else { child - 1 - random.below(child.min(3)) };
            joint(random, flavour, parent, child)
        })
        .collect();
    if flavour.mimic {
        follow(random, flavour, &mut description.joints);
    }
    shuffled(random, &description)
}

pub(crate) fn joint(random: &mut Random, flavour: Flavour, parent: usize, child: usize) -> Joint {
    use JointKind::{Continuous, Fixed, Floating, Helical, Planar, Prismatic, Revolute, Spherical, Universal};
    let mut kinds = vec![Revolute, Revolute, Continuous, Prismatic];
    kinds.extend(flavour.fixed.then_some(Fixed));
    kinds.extend((flavour.floating && random.chance(0.4)).then_some(Floating));
    if flavour.every_kind && random.chance(0.6) {
        kinds.extend([Helical, Universal, Spherical, Planar]);
    }
    let kind = *random.choose(&kinds);
    let axis = if kind.has_axis() { axis(random) } else { [1.0, 0.0, 0.0] };
    Joint {
        name: format!("joint_{child}"),
        kind,
        parent: LinkId(parent),
        child: LinkId(child),
        origin: origin(random, 0.6),
        axis,
        second_axis: if kind == Universal { second_axis(random, axis) } else { [0.0; 3] },
        pitch: if kind == Helical { *random.choose(&[0.2, -0.05, 1.5]) } else { 0.0 },
        locked: (flavour.locked && kind != Fixed && random.chance(0.12)).then(|| locked(random, kind)),
        mimic: None,
        also: Vec::new(),
        limit: matches!(kind, Revolute | Prismatic | Helical).then_some(Limit {
            lower: -2.5,
            upper: 2.5,
            effort: 100.0,
            velocity: 10.0,
            ..Limit::NONE
        }),
        dynamics: JointDynamics::default(),
    }
}

/// Not along the first.
fn second_axis(random: &mut Random, first: [f64; 3]) -> [f64; 3] {
    let norm = |a: [f64; 3]| a.iter().map(|x| x * x).sum::<f64>().sqrt();
    loop {
        let second = axis(random);
        if norm(cross(first, second)) > 0.3 * norm(first) * norm(second) {
            return second;
        }
    }
}

/// Coordinates, of turns and slides, or a quaternion.
fn locked(random: &mut Random, kind: JointKind) -> Vec<f64> {
    match kind {
        JointKind::Spherical => random.unit::<4>().to_vec(),
        JointKind::Floating => [random.three(1.0).as_slice(), &random.unit::<4>()].concat(),
        _ => random.vector(kind.sizes().0, -1.5, 1.5),
    }
}

/// Coordinate axes of both signs, tilted ones, and any length.
fn axis(random: &mut Random) -> [f64; 3] {
    let length = *random.choose(&[1.0, 1.0, 1.0, 2.0, 0.37, 1e-3]);
    let direction = if random.chance(0.6) {
        let mut e = [0.0; 3];
        e[random.below(3)] = if random.chance(0.5) { 1.0 } else { -1.0 };
        e
    } else if random.chance(0.3) {
        let h = std::f64::consts::FRAC_1_SQRT_2;
        *random.choose(&[[h, h, 0.0], [0.0, -h, h], [-h, 0.0, h]])
    } else {
        random.unit()
    };
    direction.map(|x| x * length + 0.0)
}

/// Sparse or dense; angles right, nearly right, or any.
fn origin(random: &mut Random, reach: f64) -> Origin {
    let sparse = random.chance(0.5);
    let xyz = random.three(reach).map(|x| if sparse && random.chance(0.6) { 0.0 } else { x });
    Origin::new(xyz, rpy(random))
}

/// Right angles in common spellings, and zero.
#[allow(clippy::approx_constant)]
// Why: the approximation is the point.
const NEARLY_RIGHT: [f64; 6] = [0.0, 0.0, 1.5708, -1.5708, 3.14159, 1.57079632679];

fn rpy(random: &mut Random) -> [f64; 3] {
    match random.below(6) {
        0 | 1 => [0.0; 3],
        2 => [(); 3].map(|()| FRAC_PI_2 * f64::from(*random.choose(&[-2, -1, 0, 0, 1, 2]))),
        3 => [(); 3].map(|()| *random.choose(&NEARLY_RIGHT)),
        4 => [0.0, 0.0, random.within(-PI, PI)],
        _ => random.three(PI),
    }
}

pub(crate) fn inertial(random: &mut Random, flavour: Flavour) -> Option<Inertial> {
    if flavour.massless && random.chance(0.25) {
        return None;
    }
    let mass = 10.0_f64.powf(random.within(-1.0, 1.0));
    let inertia = if flavour.massless && random.chance(0.15) { [0.0; 6] } else { inertia(random, mass) };
    let mut origin = origin(random, 0.3);
    if random.chance(0.2) {
        origin.xyz = [0.0; 3];
    }
    Some(Inertial { origin, mass, inertia })
}

/// The inertia of a possible body: moments of mass along three axes, at right angles or turned.
fn inertia(random: &mut Random, mass: f64) -> [f64; 6] {
    let [x, y, z] = [(); 3].map(|()| mass * random.within(0.02, 0.3).powi(2));
    let (x, y) = if random.chance(0.3) { (x, x) } else { (x, y) };
    let principal = [y + z, x + z, x + y];
    if random.chance(0.5) {
        return [principal[0], 0.0, 0.0, principal[1], 0.0, principal[2]];
    }
    // The axes: two directions and the normal to both.
    let [a, b] = [random.unit::<3>(), random.unit::<3>()];
    let c = unit(cross(a, b));
    let axes = [a, cross(c, a), c];
    let entry = |i: usize, j: usize| (0..3).map(|k| axes[k][i] * principal[k] * axes[k][j]).sum::<f64>();
    [entry(0, 0), entry(0, 1), entry(0, 2), entry(1, 1), entry(1, 2), entry(2, 2)]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn unit(a: [f64; 3]) -> [f64; 3] {
    let norm = a.iter().map(|x| x * x).sum::<f64>().sqrt();
    a.map(|x| x / norm)
}

/// Lets some joints follow others; those may follow further ones, but no joint follows itself.
fn follow(random: &mut Random, flavour: Flavour, joints: &mut [Joint]) {
    let mut able: Vec<usize> = (0..joints.len()).filter(|&j| joints[j].kind.sizes() == (1, 1)).collect();
    random.shuffle(&mut able);
    // Everyone follows only somebody further on in the shuffled list.
    for place in 0..able.len().saturating_sub(1) {
        if random.chance(if flavour.bent { 0.6 } else { 0.3 }) {
            let leader = able[place + 1 + random.below(able.len() - place - 1)];
            let multiplier = *random.choose(&[-1.0, 1.0, 0.5, -1.7]);
            let offset = *random.choose(&[0.0, 0.0, 0.3, -1.1]);
            joints[able[place]].mimic = Some(Mimic::linear(JointId(leader), multiplier, offset));
        }
    }
    if flavour.bent {
        bend(random, &able, joints);
    }
}

/// Bends the laws of most followers, the last leaders first: the product of the degrees in a chain
/// is at most four.
fn bend(random: &mut Random, able: &[usize], joints: &mut [Joint]) {
    let mut degrees = vec![1; joints.len()];
    for &follower in able.iter().rev() {
        let Some(mimic) = &mut joints[follower].mimic else { continue };
        let most = 4 / degrees[mimic.joint.0];
        let degree = if most > 1 && random.chance(0.8) { 2 + random.below(most - 1) } else { 1 };
        for (power, x) in mimic.higher.iter_mut().enumerate().take(degree - 1) {
            *x = *random.choose(&[0.3, -0.2, 0.12]) / f64::powi(3.0, power as i32);
        }
        degrees[follower] = degree * degrees[mimic.joint.0];
    }
}

/// The same tree with links and joints in another order.
fn shuffled(random: &mut Random, tree: &Description) -> Description {
    let mut links: Vec<usize> = (0..tree.links.len()).collect();
    let mut joints: Vec<usize> = (0..tree.joints.len()).collect();
    if random.chance(0.5) {
        random.shuffle(&mut links);
        random.shuffle(&mut joints);
    }
    let new = |order: &[usize], old: usize| order.iter().position(|&o| o == old).expect("a permutation");
    let moved = |old: &usize| {
        let mut joint = tree.joints[JointId(*old)].clone();
        joint.parent = LinkId(new(&links, joint.parent.0));
        joint.child = LinkId(new(&links, joint.child.0));
        joint.mimic = joint.mimic.map(|m| Mimic { joint: JointId(new(&joints, m.joint.0)), ..m });
        joint
    };
    Description {
        name: tree.name.clone(),
        links: links.iter().map(|&l| tree.links[LinkId(l)].clone()).collect(),
        joints: joints.iter().map(moved).collect(),
        frames: Vec::new(),
    }
}
