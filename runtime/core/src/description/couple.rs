//! Joints that follow others: several linearly (differential and tendon drives), or one by a
//! polynomial (cams, four-bars near a position).
//!
//! ```text
//! q = Σ coefficientᵢ · qᵢ + offset
//! q = offset + coefficient · x + higher₀ x² + higher₁ x³ + higher₂ x⁴
//! ```

use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

use super::{ById, Description, EditError, Editor, Joint, JointId, Link, Mimic, Origin};

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
    /// Coefficients of the powers 2, 3 and 4 of the leader's coordinate; zeros where the joint
    /// follows linearly. Others than zeros are for one leader alone.
    pub higher: [f64; 3],
}

/// The highest degree of the polynomial by which a joint follows another.
pub const MOST_DEGREE: usize = 4;

impl Coupling {
    /// A joint that follows one leader by a polynomial of its coordinate x:
    ///
    /// ```text
    /// q = Σ coefficientsₖ (x − reference)ᵏ
    /// ```
    ///
    /// coefficients: from power zero on, rad or m over powers of rad or m; reference: rad or m. The
    /// powers are expanded about zero.
    ///
    /// # Errors
    /// [`EditError::Coupling`] of more than five coefficients, of none, and of numbers that are not
    /// finite.
    pub fn polynomial(joint: &str, leader: &str, coefficients: &[f64], reference: f64) -> Result<Self, EditError> {
        let refuse = |what: String| Err(EditError::Coupling { joint: joint.to_string(), what });
        if coefficients.is_empty() || coefficients.len() > MOST_DEGREE + 1 {
            let found = coefficients.len();
            return refuse(format!("found {found} coefficients of a polynomial, expected one to five: of the powers 0 to {MOST_DEGREE}"));
        }
        // Horner: p ← p (x − r) + c
        let mut powers = [0.0; MOST_DEGREE + 1];
        for c in coefficients.iter().rev() {
            for k in (0..powers.len()).rev() {
                let below = if k == 0 { *c } else { powers[k - 1] };
                powers[k] = below - reference * powers[k];
            }
        }
        if !powers.iter().all(|x| x.is_finite()) {
            return refuse(format!("found the polynomial {coefficients:?} about {reference}, expected finite numbers"));
        }
        let [offset, coefficient, higher @ ..] = powers;
        Ok(Self { joint: joint.to_string(), leaders: alloc::vec![(leader.to_string(), coefficient)], offset, higher })
    }
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

/// The degree of the polynomial by which a joint follows the last of its leaders: the product of
/// those on the way.
pub(crate) fn degree_of_chain(joints: &ById<JointId, Joint>, first: &Mimic) -> usize {
    let (mut degree, mut at) = (first.degree(), first.joint);
    // A ring of followers has no last.
    for _ in 0..joints.len() {
        let Some(next) = joints.get(at).filter(|joint| joint.locked.is_none()).and_then(|joint| joint.mimic) else { break };
        (degree, at) = (degree.saturating_mul(next.degree()), next.joint);
    }
    degree
}

impl Editor<'_> {
    /// Lets a joint follow others. It has no coordinate any more.
    ///
    /// # Errors
    /// A joint that does not exist; one without exactly one coordinate; a follower that is locked,
    /// follows others already or is followed; a leader that follows several joints, or the follower
    /// itself; no leader; numbers that are not finite; a polynomial of several leaders, or one
    /// that makes a polynomial of a degree above [`MOST_DEGREE`] with those of its leader.
    pub fn couple(&mut self, coupling: &Coupling) -> Result<(), EditError> {
        let Coupling { joint, leaders, offset, higher } = coupling;
        let refuse = |what: String| Err(EditError::Coupling { joint: joint.clone(), what });
        let Some(index) = self.names.joint(joint) else { return Err(self.unknown_joint(joint, |_| true)) };
        let mut terms = Vec::new();
        for (name, coefficient) in leaders {
            let Some(leader) = self.names.joint(name) else { return Err(self.unknown_joint(name, |_| true)) };
            if !coefficient.is_finite() {
                return refuse(format!("found the coefficient {coefficient} for {name:?}, expected a finite number"));
            }
            terms.push(Mimic::linear(leader, *coefficient, 0.0));
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
        first.higher = *higher;
        if first.degree() > 1 {
            if leaders.len() > 1 {
                let found = leaders.len();
                return refuse(format!("found a polynomial of degree {} with {found} leaders, expected one leader", first.degree()));
            }
            if !higher.iter().all(|x| x.is_finite()) {
                return refuse(format!("found the coefficients {higher:?} of powers 2 to 4, expected finite numbers"));
            }
        }
        if let Some(term) = terms.iter().find(|term| degree_of_chain(&self.robot.joints, term) > MOST_DEGREE) {
            let (name, degree) = (&self.robot.joints[term.joint].name, term.degree());
            return refuse(format!(
                "found a polynomial of degree {degree} of {name:?}, which follows by a polynomial itself, expected at most {MOST_DEGREE} as the product of the degrees"
            ));
        }
        let joint = &mut self.robot.joints[index];
        joint.mimic = Some(terms[0]);
        joint.also = terms.split_off(1);
        Ok(())
    }
}
