//! The plain matrix form: 6×6 Adjoint and inertia matrices, one screw axis a joint, in the frames of the file.
//!
//! It reads like Lynch & Park, *Modern Robotics*, 2017, §8.3.2, shares no formula with [`super::inverse_dynamics`] and
//! is the reference that the others are measured against, in big floats where it matters. It is not meant to be fast.

use alloc::vec;
use alloc::vec::Vec;

use nalgebra::{Matrix3, Matrix6, Vector3, Vector6};

use crate::Scalar;
use crate::algorithm::{FunctionError, Shape};
use crate::description::{Base, Description, Inertial, JointKind, Origin};
use crate::model::{Model, ModelError};
use crate::spatial::{Placement, from_quaternion, from_rpy};

/// A described robot with every link a body and every joint a joint, fixed ones too. Constants are computed in the scalar `S`
/// from the numbers of the file.
#[derive(Clone, Debug)]
pub struct Textbook<S> {
    bodies: Vec<Link<S>>,
    /// Body of each link of the file.
    body_of_link: Vec<usize>,
    gravity: Vector3<S>,
    shape: Shape,
}

#[derive(Clone, Debug)]
struct Link<S> {
    parent: Option<usize>,
    /// The joint's frame in the parent link's.
    placement: Placement<S>,
    /// Unit axis.
    axis: Vector3<S>,
    kind: JointKind,
    /// First indices in q and v, multiplier and offset.
    q: usize,
    v: usize,
    multiplier: S,
    offset: S,
    /// G, 6×6, about the link's origin.
    inertia: Matrix6<S>,
}

impl<S: Scalar> Textbook<S> {
    /// From a description; gravity in the base frame, m/s². Fails where [`Model::new`] fails.
    pub fn new(description: &Description, base: Base, gravity: [f64; 3]) -> Result<Self, ModelError> {
        // The order and the places of coordinates are the interface's, so they are taken from the model; no number is.
        let model = Model::new(description, base)?;
        let order = depth_first(description);
        let mut body_of_link = vec![0; description.links.len()];
        let mut bodies: Vec<Link<S>> = Vec::with_capacity(order.len());
        for (link, joint) in order {
            body_of_link[link] = bodies.len();
            let inertia = description.links[link].inertial.as_ref().map_or_else(Matrix6::zeros, inertia_matrix);
            let mut body = Link {
                parent: joint.map(|j| body_of_link[description.joints[j].parent]),
                placement: Placement::identity(),
                axis: Vector3::zeros(),
                kind: if base == Base::Floating { JointKind::Floating } else { JointKind::Fixed },
                q: 0,
                v: 0,
                multiplier: S::one(),
                offset: S::zero(),
                inertia,
            };
            if let Some(j) = joint {
                let joint = &description.joints[j];
                body.placement = placement(&joint.origin);
                body.kind = joint.kind;
                if !matches!(joint.kind, JointKind::Fixed | JointKind::Floating) {
                    body.axis = unit(joint.axis);
                }
                let (leader, multiplier, offset) = leader(description, j);
                (body.multiplier, body.offset) = (multiplier, offset);
                if let Some(info) = model.joints.iter().find(|i| i.name == description.joints[leader].name) {
                    (body.q, body.v) = (info.q.0, info.v.0);
                }
            }
            bodies.push(body);
        }
        let gravity = Vector3::from(gravity).map(S::from_f64);
        Ok(Self { bodies, body_of_link, gravity, shape: model.shape() })
    }

    /// τ = M(q)·a + h(q, v); shapes and units as [`super::inverse_dynamics`].
    pub fn inverse_dynamics(&self, q: &[S], v: &[S], a: &[S]) -> Result<Vec<S>, FunctionError> {
        self.check(&[("q", q.len(), self.shape.nq), ("v", v.len(), self.shape.nv), ("a", a.len(), self.shape.nv)])?;
        let n = self.bodies.len();
        let mut adjoint = vec![Matrix6::<S>::identity(); n];
        let mut twist = vec![Vector6::<S>::zeros(); n];
        let mut acceleration = vec![Vector6::<S>::zeros(); n];
        for (i, body) in self.bodies.iter().enumerate() {
            let x = self.relative(body, q);
            // Ad(T_iλ) with T_iλ = (T_λi)⁻¹
            adjoint[i] = adjoint_of_inverse(&x);
            let (v_parent, a_parent) = match body.parent {
                Some(p) => (twist[p], acceleration[p]),
                // V̇_0 = [0; −g]
                None => (Vector6::zeros(), stack(Vector3::zeros(), -self.gravity)),
            };
            let (rate, rate_derivative) = (body.screw_times(v), body.screw_times(a));
            // V_i = Ad(T_iλ) V_λ + A_i q̇_i
            twist[i] = adjoint[i] * v_parent + rate;
            // V̇_i = Ad(T_iλ) V̇_λ + A_i q̈_i + ad(V_i) A_i q̇_i
            acceleration[i] = adjoint[i] * a_parent + rate_derivative + ad(&twist[i]) * rate;
        }
        let mut wrench: Vec<Vector6<S>> = (0..n)
            .map(|i| {
                let g = &self.bodies[i].inertia;
                // F_i = G_i V̇_i − ad(V_i)ᵀ G_i V_i
                g * acceleration[i] - ad(&twist[i]).transpose() * (g * twist[i])
            })
            .collect();
        let mut tau = vec![S::zero(); self.shape.nv];
        for (i, body) in self.bodies.iter().enumerate().rev() {
            // τ_i = A_iᵀ F_i
            body.add_torque(&wrench[i], &mut tau);
            if let Some(p) = body.parent {
                // F_λ += Ad(T_iλ)ᵀ F_i
                let below = adjoint[i].transpose() * wrench[i];
                wrench[p] += below;
            }
        }
        Ok(tau)
    }

    /// M(q), column by column: the torques of a unit acceleration of one joint, at rest and without gravity. `[nv · nv]`, row by row.
    pub fn mass_matrix(&self, q: &[S]) -> Result<Vec<S>, FunctionError> {
        let n = self.shape.nv;
        let weightless = Self { gravity: Vector3::zeros(), ..self.clone() };
        let zeros = vec![S::zero(); n];
        let mut m = vec![S::zero(); n * n];
        for j in 0..n {
            let mut unit = zeros.clone();
            unit[j] = S::one();
            let column = weightless.inverse_dynamics(q, &zeros, &unit)?;
            column.into_iter().enumerate().for_each(|(i, x)| m[i * n + j] = x);
        }
        Ok(m)
    }

    /// Placements of all links in the base frame; shapes and units as [`super::placements`].
    pub fn placements(&self, q: &[S]) -> Result<Vec<S>, FunctionError> {
        self.check(&[("q", q.len(), self.shape.nq)])?;
        let mut world: Vec<Placement<S>> = Vec::with_capacity(self.bodies.len());
        for body in &self.bodies {
            let x = self.relative(body, q);
            world.push(body.parent.map_or(x, |p| world[p].compose(&x)));
        }
        Ok(self.body_of_link.iter().flat_map(|&b| world[b].to_array()).collect())
    }

    /// Any function of the registry by its name; `arguments` in its order. `None` where this form does not have it.
    pub fn call(&self, name: &str, arguments: &[&[S]]) -> Option<Result<Vec<S>, FunctionError>> {
        let zeros = vec![S::zero(); self.shape.nv];
        Some(match (name, arguments) {
            ("placements", [q]) => self.placements(q),
            ("inverse_dynamics", [q, v, a]) => self.inverse_dynamics(q, v, a),
            ("bias_forces", [q, v]) => self.inverse_dynamics(q, v, &zeros),
            ("mass_matrix", [q]) => self.mass_matrix(q),
            ("gravity_torque", [q]) => self.inverse_dynamics(q, &zeros, &zeros),
            _ => return None,
        })
    }

    fn check(&self, lengths: &[(&'static str, usize, usize)]) -> Result<(), FunctionError> {
        lengths.iter().try_for_each(|&(name, found, expected)| super::check_length(name, found, expected))
    }

    /// T_λi(q).
    fn relative(&self, body: &Link<S>, q: &[S]) -> Placement<S> {
        let angle = || q[body.q] * body.multiplier + body.offset;
        let joint = match body.kind {
            JointKind::Revolute | JointKind::Continuous => {
                Placement { rotation: rodrigues(body.axis, angle()), position: Vector3::zeros() }
            }
            JointKind::Prismatic => Placement { rotation: Matrix3::identity(), position: body.axis * angle() },
            JointKind::Floating => {
                let q = &q[body.q..];
                Placement { rotation: from_quaternion([q[3], q[4], q[5], q[6]]), position: Vector3::new(q[0], q[1], q[2]) }
            }
            _ => Placement::identity(),
        };
        body.placement.compose(&joint)
    }
}

impl<S: Scalar> Link<S> {
    /// A·x, for the joint's numbers x in a vector of rates.
    fn screw_times(&self, rates: &[S]) -> Vector6<S> {
        let rate = || rates[self.v] * self.multiplier;
        match self.kind {
            JointKind::Revolute | JointKind::Continuous => stack(self.axis * rate(), Vector3::zeros()),
            JointKind::Prismatic => stack(Vector3::zeros(), self.axis * rate()),
            JointKind::Floating => Vector6::from_fn(|k, _| rates[self.v + k]),
            _ => Vector6::zeros(),
        }
    }

    /// τ += Aᵀ·F.
    fn add_torque(&self, f: &Vector6<S>, tau: &mut [S]) {
        let (moment, force) = (f.fixed_rows::<3>(0), f.fixed_rows::<3>(3));
        match self.kind {
            JointKind::Revolute | JointKind::Continuous => tau[self.v] += self.axis.dot(&moment) * self.multiplier,
            JointKind::Prismatic => tau[self.v] += self.axis.dot(&force) * self.multiplier,
            JointKind::Floating => (0..6).for_each(|k| tau[self.v + k] += f[k]),
            _ => {}
        }
    }
}

/// (link, the joint that carries it), parents first.
fn depth_first(description: &Description) -> Vec<(usize, Option<usize>)> {
    let mut order = Vec::new();
    let mut stack: Vec<(usize, Option<usize>)> = description.root().map(|r| (r, None)).into_iter().collect();
    let mut children = vec![Vec::new(); description.links.len()];
    for (j, joint) in description.joints.iter().enumerate() {
        children[joint.parent].push((joint.child, Some(j)));
    }
    while let Some(next) = stack.pop() {
        order.push(next);
        stack.extend(children[next.0].iter().rev());
    }
    order
}

/// The joint whose coordinate moves joint `j`, with multiplier and offset.
fn leader<S: Scalar>(description: &Description, mut j: usize) -> (usize, S, S) {
    let (mut multiplier, mut offset) = (S::one(), S::zero());
    while let Some(mimic) = description.joints[j].mimic {
        offset += multiplier * S::from_f64(mimic.offset);
        multiplier *= S::from_f64(mimic.multiplier);
        j = mimic.joint;
    }
    (j, multiplier, offset)
}

fn placement<S: Scalar>(origin: &Origin) -> Placement<S> {
    Placement { rotation: from_rpy(origin.rpy), position: Vector3::from(origin.xyz).map(S::from_f64) }
}

fn unit<S: Scalar>(axis: [f64; 3]) -> Vector3<S> {
    let largest = axis.iter().fold(0.0_f64, |m, x| m.max(if *x < 0.0 { -x } else { *x }));
    let v = Vector3::from(axis).map(|x| S::from_f64(x) / S::from_f64(largest));
    let norm = v.dot(&v).sqrt();
    v.map(|x| x / norm)
}

/// R = 1 + sin θ [ω]× + (1 − cos θ) [ω]×².
fn rodrigues<S: Scalar>(axis: Vector3<S>, angle: S) -> Matrix3<S> {
    let (sin, cos) = angle.sin_cos();
    let w = cross_matrix(axis);
    Matrix3::identity() + w * sin + w * w * (S::one() - cos)
}

fn cross_matrix<S: Scalar>(v: Vector3<S>) -> Matrix3<S> {
    let o = S::zero();
    Matrix3::new(o, -v.z, v.y, v.z, o, -v.x, -v.y, v.x, o)
}

fn stack<S: Scalar>(angular: Vector3<S>, linear: Vector3<S>) -> Vector6<S> {
    Vector6::new(angular.x, angular.y, angular.z, linear.x, linear.y, linear.z)
}

/// A 6×6 matrix from its four 3×3 blocks.
fn blocks<S: Scalar>(a: &Matrix3<S>, b: &Matrix3<S>, c: &Matrix3<S>, d: &Matrix3<S>) -> Matrix6<S> {
    Matrix6::from_fn(|i, j| match (i < 3, j < 3) {
        (true, true) => a[(i, j)],
        (true, false) => b[(i, j - 3)],
        (false, true) => c[(i - 3, j)],
        (false, false) => d[(i - 3, j - 3)],
    })
}

/// Ad(T⁻¹) = [Rᵀ 0; −Rᵀ[p]× Rᵀ].
fn adjoint_of_inverse<S: Scalar>(x: &Placement<S>) -> Matrix6<S> {
    let rt = x.rotation.transpose();
    blocks(&rt, &Matrix3::zeros(), &-(rt * cross_matrix(x.position)), &rt)
}

/// ad(V) = [[ω]× 0; [v]× [ω]×].
fn ad<S: Scalar>(v: &Vector6<S>) -> Matrix6<S> {
    let w = cross_matrix(v.fixed_rows::<3>(0).into_owned());
    blocks(&w, &Matrix3::zeros(), &cross_matrix(v.fixed_rows::<3>(3).into_owned()), &w)
}

/// G = [I_c + m [c]×[c]×ᵀ, m [c]×; m [c]×ᵀ, m 1] with everything in the link's axes.
fn inertia_matrix<S: Scalar>(i: &Inertial) -> Matrix6<S> {
    let x = placement::<S>(&i.origin);
    let m = S::from_f64(i.mass);
    let [xx, xy, xz, yy, yz, zz] = i.inertia.map(S::from_f64);
    let central = x.rotation * Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz) * x.rotation.transpose();
    let c = cross_matrix(x.position);
    blocks(&(central + c * c.transpose() * m), &(c * m), &(c.transpose() * m), &(Matrix3::identity() * m))
}
