//! `featherstone` as a peer, which computes in single precision; numbers are converted inside the
//! timed calls.
//!
//! Its placements are those of the parent in the child: a transform (E, t) takes a motion from the
//! parent to the child, E = Rᵀ and t = Rᵀ p if (R, p) is the child in the parent. Its own URDF
//! reader passes (R, p), and its joints turn by E = exp(q â), so that is corrected here: the bodies
//! are those of its reader (one per link, fixed ones too), their placements inverted, and revolute
//! joints get −q.

use std::collections::HashMap;
use std::path::Path;

use featherstone::aba::aba_forward_dynamics;
use featherstone::body::ArticulatedBody;
use featherstone::crba::crba_mass_matrix;
use featherstone::joint::GenJoint;
use featherstone::rnea::rnea_inverse_dynamics;
use featherstone::spatial::SpatialTransform;
use featherstone::urdf_convert::{urdf_inertial_to_spatial, urdf_joint_to_gen_joint};
use nalgebra::{Quaternion, Rotation3, UnitQuaternion, Vector3};
use peer_interface::{Engine, Joints, export};

pub struct Single {
    body: ArticulatedBody,
    joints: Joints,
    /// Of each coordinate behind the base's.
    signs: Vec<f32>,
    floating: bool,
}

impl Single {
    fn place(&mut self, q: &[f64]) {
        let base = if self.floating { 7 } else { 0 };
        if self.floating {
            // The parent in the child, its quaternion w x y z.
            let turn = UnitQuaternion::new_normalize(Quaternion::new(q[6], q[3], q[4], q[5])).inverse();
            let t = turn * Vector3::new(q[0], q[1], q[2]);
            let numbers = [t.x, t.y, t.z, turn.w, turn.i, turn.j, turn.k];
            self.body.q.iter_mut().zip(numbers).for_each(|(y, x)| *y = x as f32);
        }
        let behind = self.body.q.iter_mut().skip(base).zip(&q[base..]).zip(&self.signs);
        behind.for_each(|((y, x), sign)| *y = sign * *x as f32);
    }

    /// Adds the links below one that is there, breadth first as the crate's reader does.
    fn grow(&mut self, robot: &urdf_rs::Robot, root: usize, at: usize) -> Result<(), String> {
        let mut queue = std::collections::VecDeque::from([(root, at)]);
        let place: HashMap<&str, usize> = robot.links.iter().enumerate().map(|(i, l)| (l.name.as_str(), i)).collect();
        while let Some((link, at)) = queue.pop_front() {
            for joint in robot.joints.iter().filter(|j| j.parent.link == robot.links[link].name) {
                let child = *place.get(joint.child.link.as_str()).ok_or_else(|| format!("no link {}", joint.child.link))?;
                let kind = urdf_joint_to_gen_joint(&joint.joint_type, &joint.axis.xyz);
                let sign = match kind {
                    GenJoint::Fixed => None,
                    GenJoint::Revolute { .. } => Some(-1.0),
                    GenJoint::Prismatic { .. } => Some(1.0),
                    _ => return Err(format!("joint {}: neither revolute nor prismatic", joint.name)),
                };
                if let Some(sign) = sign {
                    self.joints.add(&joint.name, 1, 1);
                    self.signs.push(sign);
                }
                let inertia = urdf_inertial_to_spatial(&robot.links[child].inertial);
                let body = self.body.add_body(&joint.child.link, at as i32, kind, inertia, inverse(&joint.origin));
                queue.push_back((child, body));
            }
        }
        Ok(())
    }
}

/// The placement of the parent in the child, from that of the child in the parent.
fn inverse(origin: &urdf_rs::Pose) -> SpatialTransform {
    let [roll, pitch, yaw] = *origin.rpy;
    let back = Rotation3::from_euler_angles(roll, pitch, yaw).inverse();
    let t = back * Vector3::new(origin.xyz[0], origin.xyz[1], origin.xyz[2]);
    SpatialTransform::from_rotation_translation(back.matrix().cast(), t.cast())
}

impl Engine for Single {
    fn open(urdf: &Path, floating: bool, gravity: [f64; 3]) -> Result<Self, String> {
        let robot = urdf_rs::read_file(urdf).map_err(|e| e.to_string())?;
        let is_root = |l: &urdf_rs::Link| robot.joints.iter().all(|j| j.child.link != l.name);
        let root = robot.links.iter().position(is_root).ok_or("no root link")?;
        let mut body = ArticulatedBody::new();
        body.set_gravity(Vector3::from(gravity.map(|x| x as f32)));
        let kind = if floating { GenJoint::Floating } else { GenJoint::Fixed };
        let inertia = urdf_inertial_to_spatial(&robot.links[root].inertial);
        let at = body.add_body(&robot.links[root].name, -1, kind, inertia, SpatialTransform::identity());
        let mut joints = Joints::default();
        if floating {
            joints.add_floating_base();
        }
        let mut engine = Self { body, joints, signs: Vec::new(), floating };
        engine.grow(&robot, root, at)?;
        Ok(engine)
    }

    fn joints(&self) -> &Joints {
        &self.joints
    }

    fn inverse_dynamics(&mut self, q: &[f64], v: &[f64], a: &[f64], tau: &mut [f64]) {
        self.place(q);
        self.body.qd.iter_mut().zip(v).for_each(|(y, x)| *y = *x as f32);
        self.body.qdd.iter_mut().zip(a).for_each(|(y, x)| *y = *x as f32);
        let (found, _) = rnea_inverse_dynamics(&self.body);
        tau.iter_mut().zip(&found).for_each(|(y, x)| *y = f64::from(*x));
    }

    fn forward_dynamics(&mut self, q: &[f64], v: &[f64], tau: &[f64], a: &mut [f64]) {
        self.place(q);
        self.body.qd.iter_mut().zip(v).for_each(|(y, x)| *y = *x as f32);
        self.body.tau.iter_mut().zip(tau).for_each(|(y, x)| *y = *x as f32);
        let found = aba_forward_dynamics(&mut self.body);
        a.iter_mut().zip(found).for_each(|(y, x)| *y = f64::from(*x));
    }

    fn mass_matrix(&mut self, q: &[f64], out: &mut [f64]) {
        self.place(q);
        let found = crba_mass_matrix(&self.body);
        // By columns, but symmetric.
        out.iter_mut().zip(found.iter()).for_each(|(y, x)| *y = f64::from(*x));
    }
}

export!(Single, c"featherstone");
