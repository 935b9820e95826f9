//! Robots that are hard, as descriptions.

use articulated_core::description::{Base, Description, Inertial, Joint, JointKind, Link, Origin};
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
    /// A rod along x from the link's origin, with inertia about its own axis only as far as `thickness`, m, says: m r²/2, and m l²/12 across.
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
        let base = Link { name: "base".into(), inertial: None };
        Self(Description { name: name.into(), links: vec![base], joints: vec![] })
    }

    /// A link with its joint on the last link, or on the one of this index.
    pub fn link(mut self, on: Option<usize>, kind: JointKind, axis: [f64; 3], origin: Origin, body: Option<Body>) -> Self {
        let child = self.0.links.len();
        let inertial = body.map(|b| Inertial { origin: Origin { xyz: b.center, rpy: b.rpy }, mass: b.mass, inertia: b.inertia });
        self.0.links.push(Link { name: format!("link_{child}"), inertial });
        let parent = on.unwrap_or(child - 1);
        let second_axis = if kind == JointKind::Universal { [axis[1], axis[2], axis[0]] } else { [0.0; 3] };
        self.0.joints.push(Joint { name: format!("joint_{child}"), kind, parent, child, origin, axis, second_axis, ..Joint::default() });
        self
    }

    /// A turning joint at a place on the last link.
    pub fn turn(self, axis: [f64; 3], xyz: [f64; 3], body: Option<Body>) -> Self {
        self.link(None, JointKind::Continuous, axis, Origin { xyz, rpy: [0.0; 3] }, body)
    }

    /// The description.
    pub fn done(self) -> Description {
        self.0
    }

    /// The model on a fixed base.
    pub fn model(self) -> Model<f64> {
        model(&self.0, Base::Fixed)
    }
}

/// The model of a description that is right.
pub fn model(description: &Description, base: Base) -> Model<f64> {
    Model::new(description, base).expect("the corpus consists of trees of known joints")
}

/// n rods in the plane x–z, joints about y; each `ratio` as long and ratio³ as heavy as the one before.
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
    /// A sixth of a turn to and fro.
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

    /// q, the first joint hanging at an angle that is no special one.
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
        let mut q: Vec<f64> = (0..model.nq).map(|_| random.uniform(-3.0, 3.0)).collect();
        crate::states::quaternions(model).for_each(|(_, at)| normalise(&mut q[at..at + 4]));
        state(q, model.nv, seed + 100 + k as u64, torque)
    };
    (0..count).map(&mut one).collect()
}

/// To norm one.
pub fn normalise(x: &mut [f64]) {
    let norm = x.iter().map(|x| x * x).sum::<f64>().sqrt();
    x.iter_mut().for_each(|x| *x /= norm);
}
