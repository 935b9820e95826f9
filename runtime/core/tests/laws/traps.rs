//! Four mistakes that are common in pseudo-code of the recursion, each made on purpose in a small
//! matrix form of it: the laws of this crate must distinguish them from the correct one. A law that
//! has never failed proves little.

use articulated_core::description::{Base, Description};
use articulated_test_support::case::{Case, State, read};
use articulated_test_support::random::Random;
use articulated_test_support::{measure, rigid};
use nalgebra::{Matrix3, Matrix4, Matrix6, Vector3, Vector6};

/// One way to get it wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Mistake {
    None,
    /// ad(A_i q̇_i) V_i instead of ad(V_i) A_i q̇_i.
    BiasReversed,
    /// Transforms from the base to the body instead of from its parent to the body, in both sweeps.
    TransformsCumulative,
    /// As above in the sweep outward only.
    OutwardCumulative,
    /// The wrench goes back with the Adjoint itself and not with its transpose.
    NotTransposed,
    /// The wrench goes back with the transpose of the inverse Adjoint.
    TransposeOfInverse,
    /// + ad(V)ᵀ G V instead of −.
    MomentumSign,
    /// Gravity downward.
    GravitySign,
}

const MISTAKES: [Mistake; 7] = [
    Mistake::BiasReversed,
    Mistake::TransformsCumulative,
    Mistake::OutwardCumulative,
    Mistake::NotTransposed,
    Mistake::TransposeOfInverse,
    Mistake::MomentumSign,
    Mistake::GravitySign,
];

/// A chain of revolute joints: everything of the textbook's recursion, on plain matrices.
struct Chain {
    /// The joint's frame in the parent's, the unit axis, and G about the link's origin.
    links: Vec<(Matrix4<f64>, Vector3<f64>, Matrix6<f64>)>,
}

impl Chain {
    fn of(tree: &Description) -> Self {
        let link = |joint: &articulated_core::description::Joint| {
            let inertial = tree.links[joint.child].inertial.unwrap();
            let [xx, xy, xz, yy, yz, zz] = inertial.inertia;
            let (r, c) = (rigid::rotation(inertial.origin.rotation.rpy()), cross(Vector3::from(inertial.origin.xyz)));
            let central = r * Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz) * r.transpose();
            let m = inertial.mass;
            let g = blocks(central + c * c.transpose() * m, c * m, c.transpose() * m, Matrix3::identity() * m);
            let x = homogeneous(rigid::rotation(joint.origin.rotation.rpy()), Vector3::from(joint.origin.xyz));
            (x, Vector3::from(joint.axis).normalize(), g)
        };
        Self { links: tree.joints.iter().map(link).collect() }
    }

    /// T_λi(q).
    fn relative(&self, i: usize, q: &[f64]) -> Matrix4<f64> {
        let (x, axis, _) = &self.links[i];
        let turn = nalgebra::Rotation3::from_axis_angle(&nalgebra::Unit::new_normalize(*axis), q[i]);
        x * homogeneous(*turn.matrix(), Vector3::zeros())
    }

    fn screw(&self, i: usize) -> Vector6<f64> {
        let axis = &self.links[i].1;
        Vector6::new(axis.x, axis.y, axis.z, 0.0, 0.0, 0.0)
    }

    fn inverse_dynamics(&self, mistake: Mistake, q: &[f64], v: &[f64], a: &[f64], g: f64) -> Vec<f64> {
        let n = self.links.len();
        let up = if mistake == Mistake::GravitySign { -g } else { g };
        let mut twist = vec![Vector6::zeros(); n + 1];
        let mut acceleration = vec![Vector6::new(0.0, 0.0, 0.0, 0.0, 0.0, up); n + 1];
        let (mut from_base, mut there, mut back) = (Matrix4::identity(), Vec::new(), Vec::new());
        for i in 0..n {
            from_base *= self.relative(i, q);
            let relative = adjoint(&self.relative(i, q).try_inverse().unwrap());
            let cumulative = adjoint(&from_base.try_inverse().unwrap());
            let out = matches!(mistake, Mistake::TransformsCumulative | Mistake::OutwardCumulative);
            there.push(if out { cumulative } else { relative });
            back.push(match mistake {
                Mistake::TransformsCumulative => cumulative.transpose(),
                Mistake::NotTransposed => relative,
                Mistake::TransposeOfInverse => adjoint(&self.relative(i, q)).transpose(),
                _ => relative.transpose(),
            });
            let rate = self.screw(i) * v[i];
            twist[i + 1] = there[i] * twist[i] + rate;
            let bias = match mistake {
                Mistake::BiasReversed => ad(&rate) * twist[i + 1],
                _ => ad(&twist[i + 1]) * rate,
            };
            acceleration[i + 1] = there[i] * acceleration[i] + self.screw(i) * a[i] + bias;
        }
        let (mut tau, mut wrench) = (vec![0.0; n], Vector6::zeros());
        for i in (0..n).rev() {
            let inertia = &self.links[i].2;
            let momentum = ad(&twist[i + 1]).transpose() * (inertia * twist[i + 1]);
            let sign = if mistake == Mistake::MomentumSign { 1.0 } else { -1.0 };
            wrench += inertia * acceleration[i + 1] + momentum * sign;
            tau[i] = self.screw(i).dot(&wrench);
            wrench = back[i] * wrench;
        }
        tau
    }

    /// The composite rigid body algorithm; without composing, it is the mistake of taking it for n
    /// calls of the recursion on single links.
    fn mass_matrix(&self, q: &[f64], compose: bool) -> nalgebra::DMatrix<f64> {
        let n = self.links.len();
        let out: Vec<Matrix6<f64>> = (0..n).map(|i| adjoint(&self.relative(i, q).try_inverse().unwrap())).collect();
        let mut inertia: Vec<Matrix6<f64>> = self.links.iter().map(|l| l.2).collect();
        let mut m = nalgebra::DMatrix::zeros(n, n);
        for i in (0..n).rev() {
            if i > 0 && compose {
                let carried = out[i].transpose() * inertia[i] * out[i];
                inertia[i - 1] += carried;
            }
            let mut wrench = inertia[i] * self.screw(i);
            for j in (0..=i).rev() {
                m[(i, j)] = self.screw(j).dot(&wrench);
                m[(j, i)] = m[(i, j)];
                wrench = out[j].transpose() * wrench;
            }
        }
        m
    }
}

fn homogeneous(r: Matrix3<f64>, p: Vector3<f64>) -> Matrix4<f64> {
    let mut x = Matrix4::identity();
    x.fixed_view_mut::<3, 3>(0, 0).copy_from(&r);
    x.fixed_view_mut::<3, 1>(0, 3).copy_from(&p);
    x
}

fn cross(p: Vector3<f64>) -> Matrix3<f64> {
    p.cross_matrix()
}

fn blocks(a: Matrix3<f64>, b: Matrix3<f64>, c: Matrix3<f64>, d: Matrix3<f64>) -> Matrix6<f64> {
    let mut x = Matrix6::zeros();
    for (block, (i, j)) in [a, b, c, d].iter().zip([(0, 0), (0, 3), (3, 0), (3, 3)]) {
        x.fixed_view_mut::<3, 3>(i, j).copy_from(block);
    }
    x
}

/// Ad(T) = [R 0; [p]× R, R].
fn adjoint(x: &Matrix4<f64>) -> Matrix6<f64> {
    let r: Matrix3<f64> = x.fixed_view::<3, 3>(0, 0).into();
    let p: Vector3<f64> = x.fixed_view::<3, 1>(0, 3).into();
    blocks(r, Matrix3::zeros(), cross(p) * r, r)
}

/// ad(V) = [[ω]× 0; [v]× [ω]×].
fn ad(v: &Vector6<f64>) -> Matrix6<f64> {
    let w = cross(Vector3::new(v[0], v[1], v[2]));
    blocks(w, Matrix3::zeros(), cross(Vector3::new(v[3], v[4], v[5])), w)
}

/// The bundled six-axis arm without its fixed links: six turning joints in a row.
fn arm() -> (Case, Chain) {
    let mut tree = read(articulated_models::robot("ur5_like").unwrap().urdf);
    let fixed = tree.joints.position(|j| j.kind.is_fixed()).unwrap();
    let tip = tree.joints.remove(fixed).child;
    assert_eq!((tip.0, tree.joints.len()), (tree.links.len() - 1, 6), "a flange listed last");
    tree.links.pop();
    let chain = Chain::of(&tree);
    (Case::new("arm", tree, Base::Fixed), chain)
}

/// |τ·v − d(T + U)/dt| relative to its terms.
fn power_gap(case: &Case, state: &State, tau: &[f64]) -> f64 {
    let given: f64 = tau.iter().zip(&state.v).map(|(t, v)| t * v).sum();
    let gained = case.motions().energy(&state.q, &state.v, &state.a).power;
    let scale: f64 = measure::torque_scale(case, state).iter().zip(&state.v).map(|(t, v)| t * v.abs()).sum();
    (given - gained).abs() / scale
}

#[test]
fn power_balance_catches_every_trap_but_one_that_does_no_work() {
    let (case, chain) = arm();
    let mut random = Random::new(11);
    let states: Vec<State> = (0..10).map(|_| case.state(&mut random)).collect();
    let worst = |mistake: Mistake| {
        let gap = |s: &State| power_gap(&case, s, &chain.inverse_dynamics(mistake, &s.q, &s.v, &s.a, 9.81));
        states.iter().map(gap).fold(0.0, f64::max)
    };
    let right = worst(Mistake::None);
    assert!(right < 1e-15, "the right form: {right:e}");
    for mistake in MISTAKES {
        let gap = worst(mistake);
        // Vᵀ ad(V)ᵀ G V = 0: no sign of this term shows in the power.
        assert_eq!(gap > 1e-4, mistake != Mistake::MomentumSign, "{mistake:?}: {gap:e}");
    }
}

#[test]
fn virtual_power_catches_every_trap() {
    let (case, chain) = arm();
    let state = case.state(&mut Random::new(12));
    let tau = case.motions().inverse_dynamics(&state.q, &state.v, &state.a);
    let scale = measure::torque_scale(&case, &state);
    let far = |mistake| measure::distance(&chain.inverse_dynamics(mistake, &state.q, &state.v, &state.a, 9.81), &tau, &scale);
    assert!(far(Mistake::None) < 16.0);
    for mistake in MISTAKES {
        assert!(far(mistake) > 1e10, "{mistake:?} goes unseen");
    }
}

/// Trap 4: the composite rigid body algorithm composes inertias; n calls of the recursion give the
/// same matrix, single links do not.
#[test]
fn composite_bodies_give_the_matrix_of_n_recursions_and_single_links_do_not() {
    let (case, chain) = arm();
    let state = case.state(&mut Random::new(13));
    let expected = articulated_test_support::case::mass_matrix(&case.model, &state.q);
    let gap = |m: &nalgebra::DMatrix<f64>| (m - &expected).amax() / expected.amax();
    assert!(gap(&chain.mass_matrix(&state.q, true)) < 1e-15);
    assert!(gap(&chain.mass_matrix(&state.q, false)) > 1e-2);
    // n calls with gravity left in are not a mass matrix either: it is not symmetric.
    let zero = vec![0.0; 6];
    let with_gravity = nalgebra::DMatrix::from_fn(6, 6, |i, k| {
        let mut unit = zero.clone();
        unit[k] = 1.0;
        chain.inverse_dynamics(Mistake::None, &state.q, &zero, &unit, 9.81)[i]
    });
    assert!((&with_gravity - with_gravity.transpose()).amax() > 1e-2 * expected.amax());
}
