//! The plain document that `urdf-rs` is given.
//!
//! It says what was found and nothing else: no appearance, no extensions, no defaults, links and joints named by their
//! index. So that reader never meets what it would misread (names with blanks, numbers with letters behind) or stumble
//! over (meshes, deep nesting), and its time goes into what matters.

use std::fmt::Write;

use articulated_core::description::{Inertial, JointDynamics, JointKind, Limit, Origin};

use crate::draft::{Draft, DraftJoint};
use crate::tree::Tree;

/// The document. Numbers are written so that they are read back exactly.
pub(crate) fn document(draft: &Draft, tree: &Tree, leaders: &[Option<usize>]) -> String {
    let mut out = Out(String::from("<robot name=\"\">"));
    for (i, link) in draft.links.iter().enumerate() {
        out.link(i, link.inertial.as_ref());
    }
    for (i, joint) in draft.joints.iter().enumerate() {
        out.joint(i, joint, tree, leaders[i]);
    }
    out.0 + "</robot>"
}

struct Out(String);

/// `urdf-rs`'s name of a kind.
fn name(kind: Option<JointKind>) -> &'static str {
    match kind {
        Some(JointKind::Revolute) => "revolute",
        Some(JointKind::Continuous) => "continuous",
        Some(JointKind::Prismatic) => "prismatic",
        Some(JointKind::Floating) => "floating",
        Some(JointKind::Planar) => "planar",
        Some(JointKind::Fixed) | None => "fixed",
    }
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
        self.put(format_args!("<mass value=\"{:e}\"/><inertia", inertial.mass));
        for (name, moment) in ["ixx", "ixy", "ixz", "iyy", "iyz", "izz"].iter().zip(inertial.inertia) {
            self.put(format_args!(" {name}=\"{moment:e}\""));
        }
        self.put(format_args!("/></inertial>"));
    }

    fn vector(&mut self, name: &str, [x, y, z]: [f64; 3]) {
        self.put(format_args!(" {name}=\"{x:e} {y:e} {z:e}\""));
    }

    fn origin(&mut self, origin: &Origin) {
        if is_zero(origin.xyz) && is_zero(origin.rpy) {
            return;
        }
        self.put(format_args!("<origin"));
        self.vector("xyz", origin.xyz);
        if !is_zero(origin.rpy) {
            self.vector("rpy", origin.rpy);
        }
        self.put(format_args!("/>"));
    }

    fn joint(&mut self, index: usize, joint: &DraftJoint, tree: &Tree, leader: Option<usize>) {
        self.put(format_args!("<joint name=\"{index}\" type=\"{}\">", name(joint.kind)));
        self.origin(&joint.origin);
        self.put(format_args!("<parent link=\"{}\"/><child link=\"{}\"/><axis", tree.parent[index], tree.child[index]));
        self.vector("xyz", joint.axis);
        self.put(format_args!("/>"));
        joint.limit.iter().for_each(|limit| self.limit(limit));
        joint.dynamics.iter().for_each(|dynamics| self.dynamics(dynamics));
        if let (Some(leader), Some(mimic)) = (leader, &joint.mimic) {
            self.put(format_args!("<mimic joint=\"{leader}\""));
            mimic.multiplier.iter().for_each(|x| self.put(format_args!(" multiplier=\"{x:e}\"")));
            mimic.offset.iter().for_each(|x| self.put(format_args!(" offset=\"{x:e}\"")));
            self.put(format_args!("/>"));
        }
        self.put(format_args!("</joint>"));
    }

    fn limit(&mut self, Limit { lower, upper, effort, velocity }: &Limit) {
        self.put(format_args!("<limit lower=\"{lower:e}\" upper=\"{upper:e}\" effort=\"{effort:e}\" velocity=\"{velocity:e}\"/>"));
    }

    fn dynamics(&mut self, JointDynamics { damping, friction }: &JointDynamics) {
        self.put(format_args!("<dynamics damping=\"{damping:e}\" friction=\"{friction:e}\"/>"));
    }
}

/// Zeros are the default; a negative zero is written out.
fn is_zero(vector: [f64; 3]) -> bool {
    vector.iter().all(|x| x.to_bits() == 0)
}
