//! The actuators of a file on a model of its robot.

use articulated_core::actuator::{ActuatorLaw, Actuators, Follower, FrameDrive, SiteDrive, SiteFrame, Strand, Terms, Transmission};
use articulated_core::description::Origin;
use articulated_core::model::Model;
use articulated_core::spatial::{Vector3, Wrench};

use crate::world::{self, Actuator, OnFrames, World};

/// An actuator, or a spring or damper of a tendon, on a joint that the model does not have: one
/// that is locked. It acts on its other joints alone.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OnLockedJoint {
    /// Its name.
    pub actuator: String,
    /// The joint.
    pub joint: String,
}

impl World {
    /// The actuators of the file with the coordinates of a model of its robot, and those that act
    /// on joints that the model does not have.
    pub fn actuators_of(&self, model: &Model<f64>) -> (Actuators, Vec<OnLockedJoint>) {
        let (mut followers, mut locked) = (Vec::new(), Vec::new());
        let mut laws = |all: &[Actuator], mut followers: Option<&mut Vec<(String, Follower)>>| {
            let law = |(k, actuator)| law(model, actuator, followers.as_deref_mut().map(|all| (k, all)), &mut locked);
            all.iter().enumerate().map(law).collect()
        };
        let (laws, passive) = (laws(&self.actuators, Some(&mut followers)), laws(&self.passive, None));
        let range = |name: &str| self.joint_forces.iter().find(|(joint, _)| joint == name).map(|(_, range)| *range);
        let followers = followers.into_iter().map(|(name, follower)| Follower { range: range(&name), ..follower }).collect();
        let degree = |(name, range): &(String, [f64; 2])| {
            let joint = model.joints().iter().find(|joint| joint.name == *name && joint.v.1 == 1)?;
            Some((joint.v.0, *range))
        };
        (Actuators { laws, bounds: self.joint_forces.iter().filter_map(degree).collect(), followers, passive }, locked)
    }
}

/// The law of an actuator with the robot's own coordinates. A joint that follows others is
/// q = Σ f(leader's): its part of the length is one of theirs, and a constant.
/// `followers`: the number of the law, and where to put its torques on such joints.
fn law(
    model: &Model<f64>,
    actuator: &Actuator,
    mut followers: Option<(usize, &mut Vec<(String, Follower)>)>,
    locked: &mut Vec<OnLockedJoint>,
) -> ActuatorLaw {
    let (mut drives, mut constant) = (Vec::new(), 0.0);
    for (joint, gear) in &actuator.drives {
        if let Some(one) = model.joints().iter().find(|one| one.name == *joint && one.v.1 == gear.len()) {
            drives.push(Transmission { q: one.q.0, v: one.v.0, gear: gear.clone(), ..Transmission::default() });
            continue;
        }
        // One that follows several is a sequence of bodies with its name.
        let parts = model.bodies().iter().filter(|body| body.name == *joint);
        let (before, mut leaders) = (drives.len(), Vec::new());
        for (body, follow) in parts.filter_map(|body| Some((body, body.coordinates.mimic?))) {
            constant += gear[0] * follow.offset;
            let (at, higher) = (body.coordinates, follow.higher.map(|all| all.map(|x| gear[0] * x)));
            let gear = vec![gear[0] * follow.multiplier];
            drives.push(Transmission { q: at.q, v: at.v, gear, higher, has_no_torque: followers.is_some() });
            leaders.push(at);
        }
        if let Some((law, all)) = followers.as_mut().filter(|_| !leaders.is_empty()) {
            let known = all.iter().position(|(name, _)| name == joint);
            let index = known.unwrap_or_else(|| {
                all.push((joint.clone(), Follower { leaders, ..Follower::default() }));
                all.len() - 1
            });
            all[index].1.laws.push((*law, gear[0]));
        }
        if drives.len() == before {
            locked.push(OnLockedJoint { actuator: actuator.name.clone(), joint: joint.clone() });
        }
    }
    let from = |[at_rest, of_length, of_rate]: [f64; 3]| [at_rest + of_length * constant, of_length, of_rate];
    ActuatorLaw {
        name: actuator.name.clone(),
        drives,
        frames: actuator.frames.as_ref().and_then(|frames| drive(model, frames)),
        gain: from(actuator.gain),
        bias: from(actuator.bias),
        terms: actuator.terms.clone().map(|own| Terms { rest: own.rest.map(|length| length - constant), ..own }),
        control_range: actuator.control_range,
        force_range: actuator.force_range,
        activation: actuator.activation.clone(),
    }
}

/// Frames of the file on their bodies. `None`: a model without a link.
fn drive(model: &Model<f64>, frames: &OnFrames) -> Option<FrameDrive> {
    let site = match frames {
        OnFrames::Path(strands) => return strands_of(model, strands).map(FrameDrive::Path),
        OnFrames::Site(site) => site,
    };
    let reference = match &site.reference {
        Some(reference) => Some(frame(model, reference)?),
        None => None,
    };
    let [x, y, z, a, b, c] = site.gear;
    let gear = Wrench { moment: Vector3::new(a, b, c), force: Vector3::new(x, y, z) };
    Some(FrameDrive::Site(SiteDrive { site: frame(model, &site.at)?, reference, gear }))
}

fn frame(model: &Model<f64>, (link, at): &(String, Origin)) -> Option<SiteFrame> {
    let own = model.frames().iter().find(|frame| frame.name == *link)?;
    Some(SiteFrame { body: own.body, placement: own.placement.compose(&at.placement()) })
}

/// A path of the file on its bodies. `None`: a model without a link.
pub(crate) fn strands_of(model: &Model<f64>, strands: &[world::Strand]) -> Option<Vec<Strand>> {
    let of = |own: &world::Strand| {
        let points = own.points.iter().map(|point| frame(model, point)).collect::<Option<Vec<SiteFrame>>>()?;
        Some(Strand { points, factor: own.factor })
    };
    strands.iter().map(of).collect()
}
