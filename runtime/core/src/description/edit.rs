//! Edits of a robot before a model is made of it: joints locked, payloads attached, another robot appended.
//!
//! An edit that is refused leaves the description as it was.

use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

use super::{Description, EditError, Inertial, Joint, JointKind, Link, Mimic, Origin, PrincipalMoments};
use crate::model::FLOATING_BASE;
use crate::scalar::Scalar;
use crate::suggest::nearest;

/// A rigid load on a link.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Payload {
    /// The link that carries it.
    pub link: String,
    /// Name of the link that stands for it, and of the fixed joint between; `None`: `<link>_payload`, with a number if that is taken.
    pub name: Option<String>,
    /// kg, not negative.
    pub mass: f64,
    /// Centre of mass in the carrying link's frame, m.
    pub center_of_mass: [f64; 3],
    /// Rotational inertia about the centre of mass in axes of the carrying link: xx, xy, xz, yy, yz, zz, kg·m². Zeros: a point mass.
    pub inertia: [f64; 6],
}

/// A quaternion's norm may be off by so much: four written digits. It is normalised.
const NORM: f64 = 1e-3;

impl Description {
    /// Locks the joint called `joint` at these coordinates, as many as its kind has (rad or m; a quaternion as x, y, z, w). Joints that follow
    /// it stop where it puts them. A locked joint has no place in q and v, and its links belong to the body that they are locked to.
    ///
    /// Refused: what does not exist, does not move or moves already no more; a follower (lock what it follows); the base (say that it is fixed); a
    /// wrong number of coordinates; a quaternion whose norm is not one within 10⁻³.
    pub fn lock(&mut self, joint: &str, at: &[f64]) -> Result<(), EditError> {
        let Some(index) = self.joint(joint) else {
            return Err(match joint {
                FLOATING_BASE => EditError::LockedBase,
                _ => EditError::UnknownJoint { name: joint.into(), nearest: nearest(joint, self.joints.iter().map(|j| j.name.as_str())) },
            });
        };
        let found = &self.joints[index];
        let name = || joint.to_string();
        if found.kind == JointKind::Fixed {
            return Err(EditError::LockedFixed { joint: name() });
        }
        if let Some(leader) = found.mimic.and_then(|mimic| self.joints.get(mimic.joint)) {
            return Err(EditError::LockedFollower { joint: name(), leader: leader.name.clone() });
        }
        if found.locked.is_some() {
            return Err(EditError::LockedTwice { joint: name() });
        }
        if at.len() != found.kind.sizes().0 || !at.iter().all(|x| x.is_finite()) {
            return Err(EditError::Coordinates { joint: name(), kind: found.kind, found: at.to_vec() });
        }
        let at = normalised(found.kind, at).map_err(|norm| EditError::Quaternion { joint: name(), norm })?;
        self.joints[index].locked = Some(at);
        Ok(())
    }

    /// Attaches a payload: a link of its own, whose frame has its origin at the payload's centre of mass and the axes of the carrying link, behind a fixed
    /// joint of the same name. Gives the name.
    ///
    /// Refused: a link that does not exist, a name that does, a mass or a principal moment below zero, numbers that are not finite, an inertia without mass. One whose principal moments
    /// [miss the triangle inequality](PrincipalMoments::miss_triangle) is used as it is given, as that of a link is.
    pub fn attach(&mut self, payload: &Payload) -> Result<String, EditError> {
        let parent = self.link_or_nearest(&payload.link)?;
        check_mass(payload)?;
        let name = match &payload.name {
            Some(name) if self.has(name) => return Err(EditError::NamesTaken { names: [name.clone()].into() }),
            Some(name) => name.clone(),
            None => self.free_name(&format!("{}_payload", payload.link)),
        };
        let inertial = Inertial { origin: Origin::default(), mass: payload.mass, inertia: payload.inertia };
        self.links.push(Link { name: name.clone(), inertial: Some(inertial) });
        self.join(name.clone(), parent, self.links.len() - 1, Origin { xyz: payload.center_of_mass, ..Origin::default() });
        Ok(name)
    }

    /// Appends another robot: its links and joints with `prefix` before their names, and a fixed joint that places its root in the frame of `at_link`, called
    /// `<prefix><root>_mount`, with a number if that is taken.
    ///
    /// Refused: a link that does not exist, a name that does, a robot without a root.
    pub fn append(&mut self, at_link: &str, other: &Self, prefix: &str, origin: Origin) -> Result<(), EditError> {
        let parent = self.link_or_nearest(at_link)?;
        let root = other.root().ok_or_else(|| EditError::NoRoot { robot: other.name.clone() })?;
        let named = |name: &String| format!("{prefix}{name}");
        let links = other.links.iter().map(|l| named(&l.name)).filter(|name| self.link(name).is_some());
        let joints = other.joints.iter().map(|j| named(&j.name)).filter(|name| self.joint(name).is_some());
        let names: Vec<String> = links.chain(joints).collect();
        if !names.is_empty() {
            return Err(EditError::NamesTaken { names });
        }
        let (first_link, first_joint) = (self.links.len(), self.joints.len());
        self.links.extend(other.links.iter().map(|l| Link { name: named(&l.name), ..l.clone() }));
        self.joints.extend(other.joints.iter().map(|j| Joint {
            name: named(&j.name),
            parent: j.parent + first_link,
            child: j.child + first_link,
            mimic: j.mimic.map(|m| Mimic { joint: m.joint + first_joint, ..m }),
            ..j.clone()
        }));
        let root = first_link + root;
        let name = self.free_name(&format!("{}_mount", self.links[root].name));
        self.join(name, parent, root, origin);
        Ok(())
    }

    fn join(&mut self, name: String, parent: usize, child: usize, origin: Origin) {
        self.joints.push(Joint { name, parent, child, origin, axis: [1.0, 0.0, 0.0], ..Joint::default() });
    }

    /// Index of the link called `name`, or the refusal that names the nearest.
    pub fn link_or_nearest(&self, name: &str) -> Result<usize, EditError> {
        let unknown = || EditError::UnknownLink { name: name.into(), nearest: nearest(name, self.links.iter().map(|l| l.name.as_str())) };
        self.link(name).ok_or_else(unknown)
    }

    fn has(&self, name: &str) -> bool {
        self.link(name).is_some() || self.joint(name).is_some()
    }

    /// `name`, or with the first number from 2 on that no link and no joint has.
    fn free_name(&self, name: &str) -> String {
        let mut free = name.to_string();
        let mut number = 2;
        while self.has(&free) {
            free = format!("{name}_{number}");
            number += 1;
        }
        free
    }
}

/// The coordinates, a quaternion among them with norm one. Otherwise its norm.
fn normalised(kind: JointKind, at: &[f64]) -> Result<Vec<f64>, f64> {
    let mut at = at.to_vec();
    let first = match kind {
        JointKind::Spherical => 0,
        JointKind::Floating => 3,
        _ => return Ok(at),
    };
    let quaternion = &mut at[first..];
    let norm = Scalar::sqrt(quaternion.iter().map(|x| x * x).sum::<f64>());
    if Scalar::abs(norm - 1.0) > NORM {
        return Err(norm);
    }
    quaternion.iter_mut().for_each(|x| *x /= norm);
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

/// Whether a load of this mass may have this inertia. That of no moment is none; without mass there is no other.
fn can_be(inertia: [f64; 6], mass: f64) -> bool {
    let massless = mass == 0.0 && inertia != [0.0; 6];
    inertia.iter().all(|x| x.is_finite()) && !massless && !PrincipalMoments::of(inertia).are_negative()
}

#[cfg(test)]
mod tests {
    use super::*;

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
