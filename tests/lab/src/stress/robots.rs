//! Robots that are hard, as descriptions.

use articulated_core::description::{Base, Description, Inertial, Joint, JointKind, Link, LinkId, Origin};
use articulated_core::model::Model;

use super::judge::State;
use crate::states::SplitMix64;

/// A description that grows link by link.
#[derive(Clone, Debug)]
pub struct Builder(Description);

/// A body: mass, centre of mass, inertia about it.
#[derive(Clone, Copy, Debug)]
pub struct Body {
    /// kg.
    pub mass: f64,
    /// m, in the link.
    pub center: [f64; 3],
    /// Roll, pitch, yaw of the frame that the inertia is given in.
    pub rpy: [f64; 3],
    /// xx, xy, xz, yy, yz, zz, kg·m².
    pub inertia: [f64; 6],
}

impl Body {
    /// A rod along x from the link's origin, with inertia about its own axis due to `thickness`, m,
    /// alone: m r²/2, and m l²/12 across.
    pub fn rod(mass: f64, length: f64, thickness: f64) -> Self {
        let across = mass * length * length / 12.0;
        let own = mass * thickness * thickness / 2.0;
        Self { mass, center: [length / 2.0, 0.0, 0.0], rpy: [0.0; 3], inertia: [own, 0.0, 0.0, across, 0.0, across] }
    }

    /// A body of three radii of gyration, m.
    pub fn of_radii(mass: f64, center: [f64; 3], radii: [f64; 3]) -> Self {
        let [x, y, z] = radii.map(|k| mass * k * k);
        Self { mass, center, rpy: [0.0; 3], inertia: [x, 0.0, 0.0, y, 0.0, z] }
    }
}

impl Builder {
    /// A robot of a base without mass.
    pub fn new(name: &str) -> Self {
        let base = Link { name: "base".into(), ..Link::default() };
        Self(Description { name: name.into(), links: [base].into(), ..Description::default() })
    }

    /// A link with its joint on the last link, or on the one of this index.
    pub fn link(mut self, on: Option<usize>, kind: JointKind, axis: [f64; 3], origin: Origin, body: Option<Body>) -> Self {
        let child = self.0.links.len();
        let inertial = body.map(|b| Inertial { origin: Origin::new(b.center, b.rpy), mass: b.mass, inertia: b.inertia });
        self.0.links.push(Link { name: format!("link_{child}"), inertial, ..Link::default() });
        let parent = on.unwrap_or(child - 1);
        let second_axis = if kind.has_second_axis() { [axis[1], axis[2], axis[0]] } else { [0.0; 3] };
        self.0.joints.push(Joint {
            name: format!("joint_{child}"),
            kind,
            parent: LinkId(parent),
            child: LinkId(child),
            origin,
            axis,
            second_axis,
            ..Joint::default()
        });
        self
    }

    /// A turning joint at a place on the last link.
    pub fn turn(self, axis: [f64; 3], xyz: [f64; 3], body: Option<Body>) -> Self {
        self.link(None, JointKind::Continuous, axis, Origin::at(xyz), body)
    }

    /// The description.
    pub fn done(self) -> Description {
        self.0
    }

    /// The model on a fixed base.
    pub fn model(self) -> Model<f64> {
        built(&self.0, Base::Fixed)
    }
}

/// The model of a valid description.
pub fn built(description: &Description, base: Base) -> Model<f64> {
    Model::new(description, base).expect("the corpus consists of trees of known joints")
}

/// n rods in the plane x–z, joints about y; each `ratio` as long and ratio³ as heavy as the one
/// before.
pub fn chain(n: usize, ratio: f64) -> Description {
    let mut out = Builder::new(&format!("chain_{n}"));
    let (mut length, mut before) = (1.0, 0.0);
    for _ in 0..n {
        let mass = length * length * length;
        out = out.turn([0.0, 1.0, 0.0], [before, 0.0, 0.0], Some(Body::rod(mass, length, 0.02 * length)));
        before = length;
        length *= ratio;
    }
    out.done()
}

/// How a chain is bent: each joint's angle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// All zero.
    Straight,
    /// Half a turn each, so that every rod lies on the one before.
    Folded,
    /// A sixth of a turn, in alternating directions.
    ZigZag,
}

impl Shape {
    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Straight => "straight",
            Self::Folded => "folded",
            Self::ZigZag => "zig-zag",
        }
    }

    /// q, with the first joint hanging at a general angle.
    pub fn angles(self, n: usize) -> Vec<f64> {
        let bend = |k: usize| match self {
            Self::Straight => 0.0,
            Self::Folded => std::f64::consts::PI,
            Self::ZigZag => (if k.is_multiple_of(2) { 1.0 } else { -1.0 }) * std::f64::consts::FRAC_PI_3,
        };
        (0..n).map(|k| if k == 0 { 0.3 } else { bend(k) }).collect()
    }
}

/// Rates, accelerations and torques at random at a configuration.
pub fn state(q: Vec<f64>, nv: usize, seed: u64, torque: f64) -> State {
    let mut random = SplitMix64::new(seed);
    let mut some = |most: f64| (0..nv).map(|_| random.uniform(-most, most)).collect::<Vec<f64>>();
    let (v, a) = (some(1.0), some(1.0));
    State { q, v, a, tau: some(torque) }
}

/// States at random: angles in ±π, lengths in ±1 m, quaternions of norm one.
pub fn states(model: &Model<f64>, count: usize, seed: u64, torque: f64) -> Vec<State> {
    let mut random = SplitMix64::new(seed);
    let mut one = |k: usize| {
        let mut q: Vec<f64> = (0..model.nq()).map(|_| random.uniform(-3.0, 3.0)).collect();
        crate::states::quaternions(model).for_each(|(_, at)| normalise(&mut q[at..at + 4]));
        state(q, model.nv(), seed + 100 + k as u64, torque)
    };
    (0..count).map(&mut one).collect()
}

/// To norm one.
pub fn normalise(x: &mut [f64]) {
    let norm = x.iter().map(|x| x * x).sum::<f64>().sqrt();
    x.iter_mut().for_each(|x| *x /= norm);
}

/// Three links that turn about different axes, of these masses, kg.
pub fn arm(masses: [f64; 3]) -> Description {
    let body = |m: f64| Some(Body::of_radii(m, [0.4, 0.02, -0.03], [0.1, 0.25, 0.24]));
    Builder::new("arm")
        .turn([0.0, 0.0, 1.0], [0.0; 3], body(masses[0]))
        .turn([0.0, 1.0, 0.0], [0.1, 0.0, 0.3], body(masses[1]))
        .turn([0.0, 1.0, 0.0], [0.8, 0.05, 0.0], body(masses[2]))
        .done()
}

/// A link without mass between two that have some: Cardan's joint in two parts.
pub fn cardan() -> Description {
    let body = Some(Body::of_radii(1.0, [0.4, 0.02, -0.03], [0.1, 0.25, 0.24]));
    Builder::new("cardan")
        .turn([0.0, 0.0, 1.0], [0.0; 3], body)
        .turn([0.0, 1.0, 0.0], [0.5, 0.0, 0.0], None)
        .turn([0.0, 0.0, 1.0], [0.0, 0.0, 0.1], body)
        .done()
}

/// Two links with their centres of mass 1 m off their joints, and radii of gyration of k m about
/// them.
pub fn far_off(k: f64) -> Description {
    let small = |c: [f64; 3]| Some(Body::of_radii(1.0, c, [k, 2.0 * k, 1.5 * k]));
    let outer = small([0.6, 0.0, 0.8]);
    Builder::new("far").turn([0.0, 0.0, 1.0], [0.0; 3], small([1.0, 0.0, 0.0])).turn([0.0, 1.0, 0.0], [1.0, 0.0, 0.0], outer).done()
}

/// Thin bodies, with inertias given in arbitrarily turned frames.
pub fn turned() -> Description {
    let mut out = Builder::new("turned");
    for k in 0..4 {
        let rpy = [0.7 + f64::from(k), -1.3 * f64::from(k), 2.1 - f64::from(k)];
        let body = Body { rpy, ..Body::of_radii(1.0, [0.1, 0.0, 0.2], [1e-4, 0.1, 0.1]) };
        out = out.turn([[0.0, 0.0, 1.0], [0.0, 1.0, 0.0]][k as usize % 2], [0.1, 0.0, 0.3], Some(body));
    }
    out.done()
}

/// Turns and a slide, askew, so that units mix in M.
pub fn mixed() -> Description {
    let body = |k: f64| Some(Body { rpy: [0.3 * k, -0.2, 0.9], ..Body::of_radii(1.0 + 0.3 * k, [0.1, 0.07 * k, 0.2], [0.1, 0.17, 0.13]) });
    let at = |k: f64| Origin::new([0.3, -0.1 * k, 0.25], [0.4 * k, 0.7, -0.2 * k]);
    Builder::new("mixed")
        .link(None, JointKind::Continuous, [0.0, 0.0, 1.0], at(0.0), body(1.0))
        .link(None, JointKind::Prismatic, [0.0, 0.6, 0.8], at(1.0), body(2.0))
        .link(None, JointKind::Continuous, [0.3, -0.5, 0.2], at(2.0), body(0.5))
        .link(None, JointKind::Continuous, [0.0, 1.0, 0.0], at(3.0), body(1.5))
        .done()
}

/// Thin rods in a row about three axes.
pub fn rods() -> Description {
    let rod = Some(Body::rod(1.0, 1.0, 0.0));
    let along = [1.0, 0.0, 0.0];
    Builder::new("rods").turn(along, [0.0; 3], rod).turn([0.0, 1.0, 0.0], along, rod).turn([0.0, 0.0, 1.0], along, rod).done()
}

/// A name and a robot on a fixed base for each kind of trouble with constants.
pub fn hard() -> Vec<(&'static str, Description)> {
    vec![
        ("chain", chain(12, 1.0)),
        ("tapering", chain(10, 0.5)),
        ("light_tip", arm([1.0, 1.0, 1e-15])),
        ("heavy_tip", arm([1.0, 1.0, 1e15])),
        ("light_middle", arm([1.0, 1e-9, 1.0])),
        ("heavy_middle", arm([1.0, 1e9, 1.0])),
        ("cardan", cardan()),
        ("far_off", far_off(1e-3)),
        ("farther_off", far_off(1e-6)),
        ("turned", turned()),
        ("mixed", mixed()),
        ("rods", rods()),
    ]
}
