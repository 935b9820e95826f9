//! Edits of a robot before a model is made of it: joints locked, payloads attached, another robot
//! appended.
//!
//! An edit that is refused leaves the description as it was.

use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

use super::names::Names;
use super::{Description, EditError, Frame, Inertial, Joint, JointId, JointKind, Link, LinkId, Mimic, Origin, PrincipalMoments, Shaft};
use crate::effect::Applied;
use crate::model::FLOATING_BASE;
use crate::spatial::normalise_input;
use crate::suggest::Suggester;

/// A rigid load on a link.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Payload {
    /// The link or frame that carries it.
    pub link: String,
    /// Name of its link, and of the fixed joint between; `None`: `<link>_payload`, with a number if
    /// that is taken.
    pub name: Option<String>,
    /// kg, not negative.
    pub mass: f64,
    /// Centre of mass in the frame of the link or frame that carries it, m.
    pub center_of_mass: [f64; 3],
    /// Rotational inertia about the centre of mass in axes of that frame: xx, xy, xz, yy, yz, zz,
    /// kg·m². Zeros: a point mass.
    pub inertia: [f64; 6],
}

/// A robot while it is edited. Its names are gathered once, so that thousands of edits are soon
/// made.
#[derive(Debug)]
pub struct Editor<'a> {
    pub(super) robot: &'a mut Description,
    pub(super) names: Names,
    pub(super) suggester: Suggester,
}

impl Description {
    /// [`Editor::lock`], for one edit.
    pub fn lock(&mut self, joint: &str, at: &[f64]) -> Result<(), EditError> {
        Editor::of(self).lock(joint, at)
    }

    /// [`Editor::attach`], for one edit.
    pub fn attach(&mut self, payload: &Payload) -> Result<String, EditError> {
        Editor::of(self).attach(payload)
    }

    /// [`Editor::append`], for one edit.
    pub fn append(&mut self, at: &str, other: &Self, prefix: &str, origin: Origin) -> Result<(), EditError> {
        Editor::of(self).append(at, other, prefix, origin)
    }

    /// [`Editor::shaft`], for one edit.
    pub fn shaft(&mut self, shaft: &Shaft) -> Result<Vec<Applied>, EditError> {
        Editor::of(self).shaft(shaft)
    }
}

impl<'a> Editor<'a> {
    /// Of this robot.
    pub fn of(robot: &'a mut Description) -> Self {
        Self { names: Names::of(robot), robot, suggester: Suggester::default() }
    }

    /// Locks the joint called `joint` at these coordinates, in the number of its kind (rad or m; a
    /// quaternion as x, y, z, w). Joints that follow it are locked where it puts them. A locked
    /// joint has no place in q and v, and its links belong to the body that they are locked to.
    ///
    /// Refused: a joint that does not exist, does not move or is locked already; a follower (lock
    /// its leader); the base (request a fixed base); a wrong number of coordinates; a quaternion
    /// whose norm is not one within [`NORM_TOLERANCE`](crate::spatial::NORM_TOLERANCE).
    pub fn lock(&mut self, joint: &str, at: &[f64]) -> Result<(), EditError> {
        let Some(index) = self.names.joint(joint) else {
            return Err(match joint {
                FLOATING_BASE => EditError::LockedBase,
                _ => self.unknown_joint(joint, |_| true),
            });
        };
        let joints = &mut self.robot.joints;
        let found = &joints[index];
        let name = || joint.to_string();
        if found.kind.is_fixed() {
            return Err(EditError::LockedFixed { joint: name() });
        }
        let leaders = found.mimic.iter().chain(&found.also).filter_map(|mimic| Some(joints.get(mimic.joint)?.name.clone()));
        let leaders: Vec<String> = leaders.collect();
        if !leaders.is_empty() {
            return Err(EditError::LockedFollower { joint: name(), leaders });
        }
        if found.locked.is_some() {
            return Err(EditError::LockedTwice { joint: name() });
        }
        if at.len() != found.kind.sizes().0 || !at.iter().all(|x| x.is_finite()) {
            return Err(EditError::Coordinates { joint: name(), kind: found.kind, found: at.to_vec() });
        }
        let at = normalised(found.kind, at).map_err(|norm| EditError::Quaternion { joint: name(), norm })?;
        joints[index].locked = Some(at);
        Ok(())
    }

    /// Attaches a payload to a link or frame: a link of its own, whose frame has its origin at the
    /// payload's centre of mass and the axes of the carrying frame, after a fixed joint of the same
    /// name. Returns the name.
    ///
    /// Refused: a link or frame that does not exist, a name that is taken, a mass or a principal
    /// moment below zero, numbers that are not finite, an inertia without mass. An inertia whose
    /// principal moments [miss the triangle inequality](PrincipalMoments::miss_triangle) is used as
    /// given, as that of a link is.
    pub fn attach(&mut self, payload: &Payload) -> Result<String, EditError> {
        let (parent, place) = self.place(&payload.link)?;
        check_mass(payload)?;
        let name = match &payload.name {
            Some(name) if self.names.has(name) => return Err(EditError::NamesTaken { names: [name.clone()].into() }),
            Some(name) => name.clone(),
            None => self.names.free(&format!("{}_payload", payload.link)),
        };
        let inertial = Inertial { origin: Origin::default(), mass: payload.mass, inertia: payload.inertia };
        let child = self.add_link(Link { name: name.clone(), inertial: Some(inertial), ..Link::default() });
        self.join(name.clone(), parent, child, place.then(&Origin::at(payload.center_of_mass)));
        Ok(name)
    }

    /// Appends another robot: its links and joints with `prefix` before their names, and a fixed
    /// joint that places its root in the frame of `at`, a link or frame. The joint is called
    /// `<prefix><root>_mount`, with a number if that is taken.
    ///
    /// Refused: a link or frame that does not exist, a name that does, a robot without a root.
    pub fn append(&mut self, at: &str, other: &Description, prefix: &str, origin: Origin) -> Result<(), EditError> {
        let (parent, place) = self.place(at)?;
        let root = other.root().ok_or_else(|| EditError::NoRoot { robot: other.name.clone() })?;
        let named = |name: &String| format!("{prefix}{name}");
        let links = other.links.iter().map(|l| &l.name).chain(other.frames.iter().map(|f| &f.name));
        let links = links.map(named).filter(|name| self.names.has_frame(name));
        let joints = other.joints.iter().map(|j| named(&j.name)).filter(|name| self.names.joint(name).is_some());
        let names: Vec<String> = links.chain(joints).collect();
        if !names.is_empty() {
            return Err(EditError::NamesTaken { names });
        }
        let (links, joints) = (self.robot.links.len(), self.robot.joints.len());
        let (link_of, joint_of) = (|link: LinkId| LinkId(link.0 + links), |joint: JointId| JointId(joint.0 + joints));
        for link in &other.links {
            self.add_link(Link { name: named(&link.name), ..link.clone() });
        }
        for joint in &other.joints {
            self.add_joint(Joint {
                name: named(&joint.name),
                parent: link_of(joint.parent),
                child: link_of(joint.child),
                mimic: joint.mimic.map(|m| Mimic { joint: joint_of(m.joint), ..m }),
                also: joint.also.iter().map(|m| Mimic { joint: joint_of(m.joint), ..*m }).collect(),
                ..joint.clone()
            });
        }
        for frame in &other.frames {
            let frame = Frame { name: named(&frame.name), link: link_of(frame.link), ..frame.clone() };
            self.names.add_frame(&frame.name, self.robot.frames.len());
            self.robot.frames.push(frame);
        }
        let root = link_of(root);
        let name = self.names.free(&format!("{}_mount", self.robot.links[root].name));
        self.join(name, parent, root, place.then(&origin));
        Ok(())
    }

    /// Adds a link, and returns its index.
    pub(super) fn add_link(&mut self, link: Link) -> LinkId {
        self.names.add_link(&link.name, self.robot.links.next_id());
        self.robot.links.push(link)
    }

    pub(super) fn add_joint(&mut self, joint: Joint) {
        self.names.add_joint(&joint.name, self.robot.joints.next_id());
        self.robot.joints.push(joint);
    }

    fn join(&mut self, name: String, parent: LinkId, child: LinkId, origin: Origin) {
        self.add_joint(Joint { name, parent, child, origin, axis: [1.0, 0.0, 0.0], ..Joint::default() });
    }

    /// The link called `name`, or that of the frame called so, and the pose in its frame; or the
    /// refusal that names the nearest.
    fn place(&mut self, name: &str) -> Result<(LinkId, Origin), EditError> {
        if let Some(link) = self.names.link(name) {
            return Ok((link, Origin::default()));
        }
        if let Some(frame) = self.names.frame(name).and_then(|index| self.robot.frames.get(index)) {
            return Ok((frame.link, frame.origin));
        }
        let names = self.robot.links.iter().map(|link| &link.name).chain(self.robot.frames.iter().map(|frame| &frame.name));
        let nearest = self.suggester.nearest(name, names.map(String::as_str));
        Err(EditError::UnknownLink { name: name.into(), nearest: nearest.map(String::from) })
    }

    /// The refusal that names the nearest of the joints that may be meant.
    pub(super) fn unknown_joint(&mut self, name: &str, meant: impl Fn(&Joint) -> bool) -> EditError {
        let names = self.robot.joints.iter().filter(|j| meant(j)).map(|j| j.name.as_str());
        EditError::UnknownJoint { name: name.into(), nearest: self.suggester.nearest(name, names).map(String::from) }
    }
}

/// The coordinates, a quaternion among them with norm one. Otherwise its norm.
fn normalised(kind: JointKind, at: &[f64]) -> Result<Vec<f64>, f64> {
    let mut at = at.to_vec();
    if let Some(first) = kind.quaternion() {
        normalise_input(&mut at[first..])?;
    }
    Ok(at)
}

fn check_mass(payload: &Payload) -> Result<(), EditError> {
    let link = || payload.link.clone();
    if !(payload.mass.is_finite() && payload.mass >= 0.0) {
        return Err(EditError::Mass { link: link(), found: payload.mass });
    }
    if !payload.center_of_mass.iter().all(|x| x.is_finite()) {
        return Err(EditError::Center { link: link(), found: payload.center_of_mass });
    }
    if !can_be(payload.inertia, payload.mass) {
        return Err(EditError::Inertia { link: link(), found: payload.inertia });
    }
    Ok(())
}

/// Whether a load of this mass may have this inertia. Without mass, all moments must be zero.
fn can_be(inertia: [f64; 6], mass: f64) -> bool {
    let massless = mass == 0.0 && inertia != [0.0; 6];
    inertia.iter().all(|x| x.is_finite()) && !massless && !PrincipalMoments::of(inertia).are_negative()
}

#[cfg(test)]
mod tests {
    use alloc::vec;

    use super::*;

    /// A base and a chain of `count` links on it, the root last.
    fn chain(count: usize) -> Description {
        let links = (0..=count).map(|k| Link { name: format!("link_{k}"), ..Link::default() }).collect();
        let joint = |k: usize| Joint {
            name: format!("joint_{k}"),
            kind: JointKind::Continuous,
            parent: LinkId(k + 1),
            child: LinkId(k),
            ..Joint::default()
        };
        Description { name: "chain".into(), links, joints: (0..count).map(joint).collect(), ..Description::default() }
    }

    #[test]
    fn thousands_of_edits_are_soon_made_and_numbered_one_after_the_other() {
        let mut robot = chain(3);
        let mut editor = Editor::of(&mut robot);
        let payload = Payload { link: "link_0".into(), mass: 1.0, ..Payload::default() };
        for number in 1..=20_000 {
            let name = editor.attach(&payload).unwrap();
            assert!(if number == 1 { name == "link_0_payload" } else { name == format!("link_0_payload_{number}") }, "{name}");
        }
        assert_eq!((robot.links.len(), robot.joints.len()), (20_004, 20_003));
    }

    #[test]
    fn long_chains_are_soon_appended_wherever_their_root_is() {
        let (mut robot, other) = (chain(20_000), chain(20_000));
        assert_eq!(robot.root(), Some(LinkId(20_000)));
        robot.append("link_0", &other, "other_", Origin::default()).unwrap();
        assert_eq!((robot.root(), robot.link("other_link_20000")), (Some(LinkId(20_000)), Some(LinkId(40_001))));
        assert_eq!(robot.joints.last().map(|j| (j.name.as_str(), j.child)), Some(("other_link_20000_mount", LinkId(40_001))));
    }

    /// A site of a link, a quarter turn about x and half a metre along y from it.
    fn with_site() -> Description {
        let origin = Origin::new([0.0, 0.5, 0.0], [core::f64::consts::FRAC_PI_2, 0.0, 0.0]);
        let frames = vec![Frame { name: "site".into(), link: LinkId(1), origin }];
        Description { frames, ..chain(2) }
    }

    #[test]
    fn robots_and_payloads_hang_at_frames() {
        let mut robot = with_site();
        let payload = Payload { link: "site".into(), mass: 1.0, center_of_mass: [1.0, 2.0, 3.0], ..Payload::default() };
        assert_eq!(robot.attach(&payload).as_deref(), Ok("site_payload"));
        robot.append("site", &chain(1), "hand_", Origin::new([0.0, 0.0, 1.0], [0.0, 0.0, 0.25])).unwrap();
        let mount = |name: &str| robot.joints.iter().find(|joint| joint.name == name).unwrap();
        let [load, hand] = ["site_payload", "hand_link_1_mount"].map(mount);
        assert_eq!([load.parent, hand.parent], [LinkId(1); 2]);
        // (x, y, z) of the site is (x, −z, y) of the link. The rotation alone keeps the file's
        // form.
        let close = |found: [f64; 3], expected: [f64; 3]| found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-15);
        assert!(close(load.origin.xyz, [1.0, 0.5 - 3.0, 2.0]) && load.origin.rotation == robot.frames[0].origin.rotation);
        assert!(close(hand.origin.xyz, [0.0, 0.5 - 1.0, 0.0]));
        let [c, s] = [0.25_f64.cos(), 0.25_f64.sin()];
        let expected = nalgebra::Matrix3::new(c, -s, 0.0, 0.0, 0.0, -1.0, s, c, 0.0);
        assert!((hand.origin.rotation.matrix::<f64>() - expected).amax() < 1e-15);
        // Frames of the appended robot carry others.
        robot.append("link_0", &with_site(), "arm_", Origin::default()).unwrap();
        assert!(robot.append("arm_site", &chain(1), "tip_", Origin::default()).is_ok());
        let told = robot.append("arm_sit", &chain(1), "other_", Origin::default()).unwrap_err().to_string();
        assert_eq!(told, "the robot has no link or frame \"arm_sit\", did you mean \"arm_site\"?");
    }

    #[test]
    fn of_thousands_of_names_that_there_are_not_the_first_are_told_with_what_was_meant() {
        let mut robot = chain(2000);
        let mut editor = Editor::of(&mut robot);
        let mut meant = |k: usize| match editor.lock(&format!("jount_{k}"), &[0.0]) {
            Err(EditError::UnknownJoint { nearest, .. }) => nearest.is_some(),
            other => panic!("{other:?}"),
        };
        assert!(meant(0));
        assert!((1..2000).filter(|k| meant(*k)).count() < 100);
    }

    #[test]
    fn a_loads_inertia_is_finite_not_negative_and_not_without_mass() {
        for inertia in [[0.0; 6], [1.0, 0.0, 0.0, 1.0, 0.0, 3.0], [0.0, 0.0, 0.0, 1.0, 0.0009, 1.0], [-1e-10, 0.0, 0.0, 1.0, 0.0, 1.0]] {
            assert!(can_be(inertia, 1.0) && can_be(inertia, 0.0) == (inertia == [0.0; 6]), "{inertia:?}");
        }
        for inertia in [f64::NAN, f64::INFINITY, -1e-8, -1.0].map(|x| [x, 0.0, 0.0, 1.0, 0.0, 1.0]) {
            assert!(!can_be(inertia, 1.0), "{inertia:?}");
        }
        assert!(!can_be([0.0, 0.1, 0.0, 0.0, 0.0, 0.0], 1.0));
    }
}
