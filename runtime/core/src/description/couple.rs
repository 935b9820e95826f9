//! Joints that follow several others: differential and tendon drives.
//!
//! ```text
//! q = Σ coefficientᵢ · qᵢ + offset
//! ```

use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

use super::{Description, EditError, Editor, Joint, JointId, Link, Mimic, Origin};

/// How a joint follows others.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Coupling {
    /// The joint that follows: revolute, continuous, prismatic or helical.
    pub joint: String,
    /// The joints that it follows, each of one coordinate, with d(own)/d(leader's): dimensionless,
    /// m/rad, or rad/m.
    pub leaders: Vec<(String, f64)>,
    /// Own coordinate where all leaders' are zero, rad or m.
    pub offset: f64,
}

impl Description {
    /// [`Editor::couple`], for one edit.
    ///
    /// # Errors
    /// As there.
    pub fn couple(&mut self, coupling: &Coupling) -> Result<(), EditError> {
        Editor::of(self).couple(coupling)
    }

    /// The same robot with each follower of several joints as followers of one joint, one after the
    /// other on an axis: R(Σ qᵢ) = Π R(qᵢ), and so for slides and screws.
    pub(crate) fn in_sequence(&self) -> Self {
        let mut robot = self.clone();
        for (j, joint) in self.joints.with_ids().filter(|(_, joint)| joint.locked.is_none()) {
            let mut parent = joint.child;
            for (k, mimic) in joint.also.iter().enumerate() {
                // The first of them keeps the place among the joints of the parent link.
                let between = robot.links.push(Link { name: format!("{} {k}", joint.name), intermediate: true, ..Link::default() });
                if k == 0 {
                    robot.joints[j].child = between;
                } else if let Some(last) = robot.joints.last_mut() {
                    last.child = between;
                }
                let name = format!("{} {k}", joint.name);
                let (mimic, origin, child) = (Some(*mimic), Origin::default(), parent);
                robot.joints.push(Joint { name, parent: between, child, origin, mimic, also: Vec::new(), ..joint.clone() });
                parent = joint.child;
            }
            robot.joints[j].also.clear();
        }
        robot
    }
}

impl Editor<'_> {
    /// Lets a joint follow others. It has no coordinate any more.
    ///
    /// # Errors
    /// A joint that does not exist; one without exactly one coordinate; a follower that is locked,
    /// follows others already or is followed; a leader that follows several joints, or the follower
    /// itself; no leader; numbers that are not finite.
    pub fn couple(&mut self, coupling: &Coupling) -> Result<(), EditError> {
        let Coupling { joint, leaders, offset } = coupling;
        let refuse = |what: String| Err(EditError::Coupling { joint: joint.clone(), what });
        let Some(index) = self.names.joint(joint) else { return Err(self.unknown_joint(joint, |_| true)) };
        let mut terms = Vec::new();
        for (name, coefficient) in leaders {
            let Some(leader) = self.names.joint(name) else { return Err(self.unknown_joint(name, |_| true)) };
            if !coefficient.is_finite() {
                return refuse(format!("found the coefficient {coefficient} for {name:?}, expected a finite number"));
            }
            terms.push(Mimic { joint: leader, multiplier: *coefficient, offset: 0.0 });
        }
        let joints = &self.robot.joints;
        let one = |j: JointId| joints[j].kind.sizes() == (1, 1);
        if let Some(other) = [index].into_iter().chain(terms.iter().map(|term| term.joint)).find(|j| !one(*j)) {
            let Joint { name, kind, .. } = &joints[other];
            return refuse(format!("found {name:?}, a {} joint, expected joints of one coordinate", kind.name()));
        }
        if joints[index].mimic.is_some() || joints[index].locked.is_some() {
            return refuse("found a joint that is locked or follows another already, expected one that moves by itself".to_string());
        }
        if let Some(term) = terms.iter().find(|term| term.joint == index || !joints[term.joint].also.is_empty()) {
            let name = &joints[term.joint].name;
            return refuse(format!("found the leader {name:?}, expected another joint, which does not follow several"));
        }
        if let Some(other) =
            joints.iter().find(|other| other.mimic.is_some_and(|m| m.joint == index) || other.also.iter().any(|m| m.joint == index))
        {
            return refuse(format!("found {:?}, which follows this joint, expected a joint that no other follows", other.name));
        }
        let Some(first) = terms.first_mut().filter(|_| offset.is_finite()) else {
            return refuse(format!(
                "found {} leaders and the offset {offset}, expected at least one leader and a finite offset",
                leaders.len()
            ));
        };
        first.offset = *offset;
        let joint = &mut self.robot.joints[index];
        joint.mimic = Some(terms[0]);
        joint.also = terms.split_off(1);
        Ok(())
    }
}
