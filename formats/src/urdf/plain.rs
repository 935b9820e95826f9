//! The plain documents for `urdf-rs`.
//!
//! They contain only what was found: no appearance, no extensions, links and joints named by their
//! index. So that reader gets no content that it would misread (names with blanks, numbers with
//! letters behind) or fail on (meshes, deep nesting), and spends no time on the rest. A large robot
//! is passed in pieces, since that reader holds several copies of a whole document in memory.

use std::fmt::{self, Write};

use articulated_core::description::{Inertial, JointDynamics, JointKind, Limit, Origin};

use super::ast::{Draft, DraftJoint};
use super::tree::Tree;

/// Links and joints per document.
const PIECE: usize = 64;

/// A document: its text, and how many links and joints it holds.
pub(crate) struct Piece {
    pub(crate) text: String,
    pub(crate) links: usize,
    pub(crate) joints: usize,
}

/// The documents in order: links and joints by rising index. Numbers are written so that they are
/// read back exactly.
pub(crate) fn pieces<'a>(draft: &'a Draft, tree: &'a Tree, leaders: &'a [Option<usize>]) -> impl Iterator<Item = Piece> + 'a {
    let most = draft.links.len().max(draft.joints.len());
    (0..most).step_by(PIECE).map(move |from| {
        let mut out = Out(String::from("<robot name=\"\">"));
        let links = within(&draft.links, from);
        links.iter().enumerate().for_each(|(i, link)| out.link(from + i, link.inertial.as_ref()));
        let joints = within(&draft.joints, from);
        joints.iter().enumerate().for_each(|(i, joint)| out.joint(from + i, joint, tree, leaders[from + i]));
        Piece { text: out.0 + "</robot>", links: links.len(), joints: joints.len() }
    })
}

fn within<T>(all: &[T], from: usize) -> &[T] {
    &all[from.min(all.len())..(from + PIECE).min(all.len())]
}

struct Out(String);

/// Whether a kind is this crate's own.
pub(crate) fn is_unknown_to_urdf_rs(kind: JointKind) -> bool {
    use JointKind::{Continuous, Fixed, Floating, Helical, Planar, Prismatic, Revolute, Spherical, Universal};
    match kind {
        Revolute | Continuous | Prismatic | Fixed | Floating | Planar | Spherical => false,
        Helical | Universal => true,
    }
}

/// `urdf-rs`'s name of a kind; the fixed joint replaces kinds that it does not know.
fn name(kind: Option<JointKind>) -> &'static str {
    kind.filter(|kind| !is_unknown_to_urdf_rs(*kind)).unwrap_or(JointKind::Fixed).name()
}

impl Out {
    fn put(&mut self, text: std::fmt::Arguments<'_>) {
        // Writing to a string cannot fail.
        let _ = self.0.write_fmt(text);
    }

    fn link(&mut self, index: usize, inertial: Option<&Inertial>) {
        match inertial {
            None => self.put(format_args!("<link name=\"{index}\"/>")),
            Some(inertial) => {
                self.put(format_args!("<link name=\"{index}\">"));
                self.inertial(inertial);
                self.put(format_args!("</link>"));
            }
        }
    }

    fn inertial(&mut self, inertial: &Inertial) {
        self.put(format_args!("<inertial>"));
        self.origin(&inertial.origin);
        self.put(format_args!("<mass value=\"{}\"/><inertia", Number(inertial.mass)));
        for (name, moment) in ["ixx", "ixy", "ixz", "iyy", "iyz", "izz"].iter().zip(inertial.inertia.map(Number)) {
            self.put(format_args!(" {name}=\"{moment}\""));
        }
        self.put(format_args!("/></inertial>"));
    }

    fn vector(&mut self, name: &str, xyz: [f64; 3]) {
        let [x, y, z] = xyz.map(Number);
        self.put(format_args!(" {name}=\"{x} {y} {z}\""));
    }

    fn origin(&mut self, origin: &Origin) {
        if is_zero(origin.xyz) && is_zero(origin.rotation.rpy()) {
            return;
        }
        self.put(format_args!("<origin"));
        self.vector("xyz", origin.xyz);
        if !is_zero(origin.rotation.rpy()) {
            self.vector("rpy", origin.rotation.rpy());
        }
        self.put(format_args!("/>"));
    }

    fn joint(&mut self, index: usize, joint: &DraftJoint, tree: &Tree, leader: Option<usize>) {
        self.put(format_args!("<joint name=\"{index}\" type=\"{}\">", name(joint.kind)));
        self.origin(&joint.origin);
        self.put(format_args!("<parent link=\"{}\"/><child link=\"{}\"/>", tree.parent[index], tree.child[index]));
        self.axis(joint.axis);
        joint.limit.iter().for_each(|limit| self.limit(limit));
        self.dynamics(&joint.dynamics);
        if let (Some(leader), Some(mimic)) = (leader, &joint.mimic) {
            self.put(format_args!("<mimic joint=\"{leader}\""));
            for (name, number) in [("multiplier", mimic.multiplier), ("offset", mimic.offset)] {
                number.iter().for_each(|x| self.put(format_args!(" {name}=\"{}\"", Number(*x))));
            }
            self.put(format_args!("/>"));
        }
        self.put(format_args!("</joint>"));
    }

    fn axis(&mut self, axis: [f64; 3]) {
        self.put(format_args!("<axis"));
        self.vector("xyz", axis);
        self.put(format_args!("/>"));
    }

    fn limit(&mut self, limit: &Limit) {
        let [lower, upper, effort, velocity] = [limit.lower, limit.upper, limit.effort, limit.velocity].map(Number);
        self.put(format_args!("<limit lower=\"{lower}\" upper=\"{upper}\" effort=\"{effort}\" velocity=\"{velocity}\"/>"));
    }

    fn dynamics(&mut self, dynamics: &JointDynamics) {
        let numbers = [dynamics.damping, dynamics.friction];
        if numbers == [None; 2] {
            return;
        }
        let [damping, friction] = numbers.map(|x| Number(x.unwrap_or_default()));
        self.put(format_args!("<dynamics damping=\"{damping}\" friction=\"{friction}\"/>"));
    }
}

/// A number in the fewest digits that are read back exactly, with an exponent if that is shorter.
struct Number(f64);

impl fmt::Display for Number {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0.abs() {
            size if size == 0.0 || (1e-2..1e6).contains(&size) => write!(f, "{}", self.0),
            _ => write!(f, "{:e}", self.0),
        }
    }
}

/// Zeros are the default; a negative zero is written out.
fn is_zero(vector: [f64; 3]) -> bool {
    vector.iter().all(|x| x.to_bits() == 0)
}
