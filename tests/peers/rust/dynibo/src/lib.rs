//! `dynibo` as a peer.
//!
//! Its gravity is 9.80665 m/s² downwards, always. The equations of motion are homogeneous in time:
//! with c = g / 9.80665,
//!
//!   ID(q, v, a; g) = c ID(q, v / √c, a / c; g / c)    and    FD(q, v, τ; g) = c FD(q, v / √c, τ / c; g / c),
//!
//! so another g costs three multiplications a joint, inside the timed calls.
//!
//! Its free base moves by (angular; linear) in world axes, where the linear acceleration is that of
//! the point, ours by (linear; angular) in body axes: a' = R (a + ω × v).

use std::path::Path;

use dynibo::{BaseState, FloatingRobot, Frame, Robot, Twist};
use nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion, Vector3};
use peer_interface::{Engine, Joints, export};

/// Gravity of the crate, m/s².
const GRAVITY: f64 = 9.80665;

pub struct Dynibo {
    robot: Way,
    joints: Joints,
    /// g / 9.80665 and its root.
    scale: f64,
    root: f64,
    q: Vec<f64>,
    v: Vec<f64>,
    a: Vec<f64>,
    out: Vec<f64>,
    square: Vec<f64>,
}

enum Way {
    Fixed(Robot),
    Floating(FloatingRobot),
}

impl Engine for Dynibo {
    fn open(urdf: &Path, floating: bool, gravity: [f64; 3]) -> Result<Self, String> {
        let scale = -gravity[2] / GRAVITY;
        if gravity[0] != 0.0 || gravity[1] != 0.0 || !(scale > 0.0) {
            return Err("dynibo knows gravity along -z only".into());
        }
        let fixed = Robot::from_urdf(urdf).map_err(|e| e.to_string())?;
        let mut joints = Joints::default();
        if floating {
            joints.add_floating_base();
        }
        let count = fixed.joint_count();
        (0..count).filter_map(|i| fixed.joint_name(i).ok()).for_each(|name| joints.add(name, 1, 1));
        let robot = if floating { Way::Floating(fixed.model().floating_robot().map_err(|e| e.to_string())?) } else { Way::Fixed(fixed) };
        let n = joints.nv();
        let vector = |n: usize| vec![0.0; n];
        Ok(Self {
            robot,
            scale,
            root: scale.sqrt(),
            q: vector(count),
            v: vector(count),
            a: vector(n),
            out: vector(n),
            square: vector(n * n),
            joints,
        })
    }

    fn joints(&self) -> &Joints {
        &self.joints
    }

    fn inverse_dynamics(&mut self, q: &[f64], v: &[f64], a: &[f64], tau: &mut [f64]) {
        let (slower, softer) = (1.0 / self.root, 1.0 / self.scale);
        match &mut self.robot {
            Way::Fixed(robot) => {
                scaled(&mut self.v, v, slower);
                scaled(&mut self.a, a, softer);
                let _ = robot.inverse_dynamics(q, &self.v, &self.a, &[], tau);
                tau.iter_mut().for_each(|x| *x *= self.scale);
            }
            Way::Floating(robot) => {
                let (frame, u, w) = (placement(q), vector(v, 0), vector(v, 3));
                let turn = frame.rotation;
                let velocity = Twist::new(turn * w * slower, turn * u * slower);
                let acceleration = Twist::new(turn * vector(a, 3) * softer, turn * (vector(a, 0) + w.cross(&u)) * softer);
                self.q.copy_from_slice(&q[7..]);
                scaled(&mut self.v, &v[6..], slower);
                scaled(&mut self.a[6..], &a[6..], softer);
                let Ok(base) = BaseState::new(frame, velocity, acceleration) else { return tau.fill(f64::NAN) };
                let _ = robot.inverse_dynamics(&base, &self.q, &self.v, &self.a[6..], &[], &mut self.out);
                let back = turn.inverse();
                put(tau, 0, back * vector(&self.out, 3) * self.scale);
                put(tau, 3, back * vector(&self.out, 0) * self.scale);
                scaled(&mut tau[6..], &self.out[6..], self.scale);
            }
        }
    }

    fn forward_dynamics(&mut self, q: &[f64], v: &[f64], tau: &[f64], a: &mut [f64]) {
        let (slower, softer) = (1.0 / self.root, 1.0 / self.scale);
        match &mut self.robot {
            Way::Fixed(robot) => {
                scaled(&mut self.v, v, slower);
                scaled(&mut self.a, tau, softer);
                let _ = robot.forward_dynamics(q, &self.v, &self.a, &[], a);
                a.iter_mut().for_each(|x| *x *= self.scale);
            }
            Way::Floating(robot) => {
                let (frame, u, w) = (placement(q), vector(v, 0), vector(v, 3));
                let turn = frame.rotation;
                let velocity = Twist::new(turn * w * slower, turn * u * slower);
                self.q.copy_from_slice(&q[7..]);
                scaled(&mut self.v, &v[6..], slower);
                put(&mut self.a, 0, turn * vector(tau, 3) * softer);
                put(&mut self.a, 3, turn * vector(tau, 0) * softer);
                scaled(&mut self.a[6..], &tau[6..], softer);
                let Ok(base) = BaseState::new(frame, velocity, Twist::zeros()) else { return a.fill(f64::NAN) };
                let _ = robot.forward_dynamics(&base, &self.q, &self.v, &self.a, &[], &mut self.out);
                let back = turn.inverse();
                put(a, 0, back * vector(&self.out, 3) * self.scale - w.cross(&u));
                put(a, 3, back * vector(&self.out, 0) * self.scale);
                scaled(&mut a[6..], &self.out[6..], self.scale);
            }
        }
    }

    fn mass_matrix(&mut self, q: &[f64], out: &mut [f64]) {
        match &mut self.robot {
            // By columns, but symmetric.
            Way::Fixed(robot) => drop(robot.mass_matrix(q, out)),
            Way::Floating(robot) => {
                let frame = placement(q);
                self.q.copy_from_slice(&q[7..]);
                let Ok(base) = BaseState::stationary(frame) else { return out.fill(f64::NAN) };
                let _ = robot.mass_matrix(&base, &self.q, &mut self.square);
                turned(&self.square, out, self.joints.nv(), frame.rotation.inverse());
            }
        }
    }
}

/// The matrix with its first rows and columns, (angular; linear) in world axes, as (linear;
/// angular) in body axes.
fn turned(from: &[f64], to: &mut [f64], n: usize, back: UnitQuaternion<f64>) {
    let back = back.to_rotation_matrix();
    for (row, out) in from.chunks_exact(n).zip(to.chunks_exact_mut(n)) {
        put(out, 0, back * vector(row, 3));
        put(out, 3, back * vector(row, 0));
        out[6..].copy_from_slice(&row[6..]);
    }
    for j in 0..n {
        let column = |to: &[f64], i: usize| Vector3::new(to[i * n + j], to[(i + 1) * n + j], to[(i + 2) * n + j]);
        let (angular, linear) = (back * column(to, 0), back * column(to, 3));
        for k in 0..3 {
            (to[k * n + j], to[(k + 3) * n + j]) = (linear[k], angular[k]);
        }
    }
}

fn placement(q: &[f64]) -> Frame {
    // The crate takes it as it is; its length is one.
    let rotation = UnitQuaternion::new_unchecked(Quaternion::new(q[6], q[3], q[4], q[5]));
    Isometry3::from_parts(Translation3::new(q[0], q[1], q[2]), rotation)
}

fn vector(x: &[f64], at: usize) -> Vector3<f64> {
    Vector3::new(x[at], x[at + 1], x[at + 2])
}

fn put(x: &mut [f64], at: usize, vector: Vector3<f64>) {
    x[at..at + 3].copy_from_slice(vector.as_slice());
}

fn scaled(out: &mut [f64], x: &[f64], by: f64) {
    out.iter_mut().zip(x).for_each(|(y, x)| *y = x * by);
}

export!(Dynibo, c"dynibo");
