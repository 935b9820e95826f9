//! Random robots with limbs that are alike, or nearly: limbs that are evaluated in lanes, and limbs
//! that only look like it.

use articulated_core::description::{Description, Inertial, Joint, JointId, JointKind, Link, LinkId, Mimic, Origin};

use crate::random::Random;
use crate::random_tree::{Flavour, inertial, joint};

/// Differences between the limbs of a robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Style {
    /// None, except their starting points.
    Copies,
    /// Every other one is a mirror image.
    Mirrored,
    /// By a number somewhere.
    Near,
    /// Some are a joint longer.
    Uneven,
}

/// A trunk with two to six limbs of one to four joints. Inertias are physical, except some links
/// without mass that are not the last of a limb.
pub fn random_limbs(seed: u64) -> Description {
    let random = &mut Random::new(seed);
    let style = *random.choose(&[Style::Copies, Style::Mirrored, Style::Near, Style::Uneven]);
    let template = template(random);
    let mut robot = Description { name: format!("limbs_{seed}"), ..Description::default() };
    robot.links.push(link("trunk".into(), inertial(random, BODY)));
    let on_spine = random.chance(0.3);
    if on_spine {
        let spine = one_joint(random, BODY);
        attach(&mut robot, "spine", 0, spine, inertial(random, BODY));
    }
    let (limbs, mimic) = (2 + random.below(5), random.chance(0.25));
    for limb in 0..limbs {
        let mut last = if on_spine && random.chance(0.8) { 1 } else { 0 };
        let longer = style == Style::Uneven && random.chance(0.4);
        let parts = template.iter().chain(longer.then(|| &template[template.len() - 1])).cloned();
        for (k, (mut joint, mut body)) in parts.enumerate() {
            if k == 0 {
                joint.origin.xyz = random.three(0.4);
            }
            match style {
                Style::Mirrored if limb % 2 == 1 => mirror(random, &mut joint, &mut body),
                Style::Near if random.chance(0.2) => alter(random, &mut joint, body.as_mut()),
                _ => {}
            }
            let before = robot.joints.len();
            last = attach(&mut robot, &format!("{limb}_{k}"), last, joint, body);
            if mimic && k == 1 && [before - 1, before].iter().all(|&j| robot.joints[JointId(j)].kind.sizes() == (1, 1)) {
                robot.joints[JointId(before)].mimic = Some(Mimic::linear(JointId(before - 1), -0.7, 0.2));
            }
        }
    }
    robot
}

/// Bodies, and joints that a URDF has words for.
const BODY: Flavour =
    Flavour { massless: false, mimic: false, bent: false, floating: false, fixed: false, every_kind: false, locked: false, links: 1 };

/// The joints of a limb, and the bodies behind them.
fn template(random: &mut Random) -> Vec<(Joint, Option<Inertial>)> {
    let every_kind = random.chance(0.25);
    let only = random.chance(0.5).then(|| *random.choose(&[JointKind::Revolute, JointKind::Revolute, JointKind::Prismatic]));
    let length = 1 + random.below(4);
    let part = |k: usize| {
        let mut joint = one_joint(random, Flavour { every_kind, fixed: k + 1 < length, ..BODY });
        // Limits do not matter here, and both these kinds have an axis.
        joint.kind = only.filter(|_| joint.kind.sizes() == (1, 1)).unwrap_or(joint.kind);
        (joint, inertial(random, Flavour { massless: k + 1 < length, ..BODY }))
    };
    (0..length).map(part).collect()
}

fn one_joint(random: &mut Random, flavour: Flavour) -> Joint {
    joint(random, flavour, 0, 0)
}

fn link(name: String, inertial: Option<Inertial>) -> Link {
    Link { name, inertial, ..Link::default() }
}

/// Hangs a body on a link; the new link.
fn attach(robot: &mut Description, name: &str, parent: usize, joint: Joint, body: Option<Inertial>) -> usize {
    let child = robot.links.len();
    robot.links.push(link(format!("link_{name}"), body));
    robot.joints.push(Joint { name: format!("joint_{name}"), parent: LinkId(parent), child: LinkId(child), ..joint });
    child
}

/// The image in the plane y = 0: points change the sign of y, rotations those of x and z; the axis
/// may be reversed.
fn mirror(random: &mut Random, joint: &mut Joint, body: &mut Option<Inertial>) {
    let [point, turn] = [|[x, y, z]: [f64; 3]| [x, -y, z], |[x, y, z]: [f64; 3]| [-x, y, -z]];
    let place = |o: Origin| Origin::new(point(o.xyz), turn(o.rotation.rpy()));
    let direction = |axis| if joint.kind.is_linear() { point(axis) } else { turn(axis) };
    let sign = if random.chance(0.5) { 1.0 } else { -1.0 };
    (joint.axis, joint.second_axis) = (direction(joint.axis).map(|x| sign * x + 0.0), direction(joint.second_axis).map(|x| x + 0.0));
    joint.origin = place(joint.origin);
    joint.pitch = -joint.pitch + 0.0;
    if let Some(body) = body {
        let [xx, xy, xz, yy, yz, zz] = body.inertia;
        (body.origin, body.inertia) = (place(body.origin), [xx, -xy, xz, yy, -yz, zz]);
    }
}

/// Another number, or one less.
fn alter(random: &mut Random, joint: &mut Joint, body: Option<&mut Inertial>) {
    let k = random.below(3);
    match (random.below(3), body) {
        (0, Some(body)) => body.origin.xyz[k] = *random.choose(&[0.0, 0.03]),
        (1, Some(body)) => body.mass *= 1.1,
        _ => joint.origin.xyz[k] = *random.choose(&[0.0, 0.05]),
    }
}
