//! The remaining part of a pivot, D/(Σ|terms|), against closed forms: two robots whose terms can be
//! counted by hand.

use articulated_core::algorithm::Workspace;
use articulated_core::algorithm::checked::checked_forward_dynamics;
use articulated_core::description::{Base, Description, Inertial, Joint, JointId, JointKind, Link, LinkId, Mimic, Origin};
use articulated_core::model::Model;

/// A body whose three moments about its frame's origin are equal.
fn ball(name: &str, mass: f64, moment: f64) -> Link {
    let inertia = [moment, 0.0, 0.0, moment, 0.0, moment];
    Link { name: name.into(), inertial: Some(Inertial { origin: Origin::default(), mass, inertia }), ..Link::default() }
}

fn hinge(name: &str, parent: usize, child: usize, x: f64) -> Joint {
    let origin = Origin::at([x, 0.0, 0.0]);
    Joint {
        name: name.into(),
        kind: JointKind::Continuous,
        parent: LinkId(parent),
        child: LinkId(child),
        origin,
        axis: [0.0, 0.0, 1.0],
        ..Joint::default()
    }
}

fn smallest(links: Vec<Link>, joints: Vec<Joint>) -> f64 {
    let description = Description { name: "robot".into(), links: links.into(), joints: joints.into(), frames: Vec::new() };
    let model: Model<f64> = Model::new(&description, Base::Fixed).expect("a tree");
    let zero = vec![0.0; model.nv()];
    checked_forward_dynamics(&model, &mut Workspace::new(&model), &zero, &zero, &zero, &mut zero.clone()).expect("regular")
}

/// M = a + m² b. The terms are √A + |m| √B squared, with A, B the halved sums of the moments of
/// each body.
#[test]
fn a_follower_counts_with_its_rate() {
    let (a, b, m) = (1.0, 0.01, 80.0);
    let follower = Joint { mimic: Some(Mimic::linear(JointId(0), m, 0.0)), ..hinge("pinion", 0, 2, 0.5) };
    let links = vec![Link { name: "base".into(), ..Link::default() }, ball("wheel", 1.0, a), ball("pinion", 1.0, b)];
    let terms = ((1.5 * a).sqrt() + m * (1.5 * b).sqrt()).powi(2);
    let left = smallest(links, vec![hinge("wheel", 0, 1, 0.0), follower]);
    assert!((left - (a + m * m * b) / terms).abs() < 1e-14, "{left}");
}

/// A ball of mass m and moments b turns about a joint at a distance d. The inner joint carries m d²
/// and none of b: D = a + m d². Its terms are those of its own body, 3a/2, and of the ball: 3b, b
/// taken away again, and 3m moved by d.
#[test]
fn what_a_child_hands_on_is_moved_to_its_parent() {
    let (a, b, m, d) = (0.1, 0.01, 1.0, 2.0);
    let links = vec![Link { name: "base".into(), ..Link::default() }, ball("arm", 1.0, a), ball("tip", m, b)];
    let left = smallest(links, vec![hinge("shoulder", 0, 1, 0.0), hinge("wrist", 1, 2, d)]);
    let expected = (a + m * d * d) / (1.5 * a + 3.0 * b + b + 3.0 * m * d * d);
    assert!((left - expected).abs() < 1e-14, "{left}, expected {expected}");
}
