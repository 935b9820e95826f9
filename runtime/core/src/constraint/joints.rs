//! Rows of joints and tendons: limits, dry friction and equations.
//!
//! ```text
//! limit:         s(x) = ½ D x² where x < 0, else 0           x = J a − r
//! dry friction:  s(x) = ½ D x² where |x| < R f, else f |x| − ½ R f²
//! equation:      s(x) = ½ D x²
//! ```

use alloc::vec::Vec;

use super::{Bound, Constraints, DryFriction, Limit};
use crate::Scalar;
use crate::algorithm::manifold::{quaternion, three};
use crate::scalar::flag;
use crate::spatial::Vector3;

/// A row of J that has few entries.
pub(super) struct JointRow<S> {
    /// Degrees of freedom, each with its entry.
    pub(super) entries: Vec<(usize, S)>,
    /// D; 0 where the row does not count.
    pub(super) curvature: S,
    /// r.
    pub(super) reference: S,
    /// Where it pushes.
    pub(super) side: Side<S>,
}

/// Where a row pushes.
#[derive(Clone, Copy, Debug)]
pub(super) enum Side<S> {
    /// A limit: where J a is below r.
    Below,
    /// An equation: on both sides.
    Both,
    /// Dry friction, with R f and f: on both sides, by f at most.
    Within([S; 2]),
}

/// Value, slope and curvature of s.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cost<S> {
    pub(super) value: S,
    pub(super) slope: S,
    pub(super) curvature: S,
}

impl<S: Scalar> JointRow<S> {
    /// J x.
    pub(super) fn along(&self, x: &[S]) -> S {
        self.entries.iter().fold(S::zero(), |sum, (k, entry)| sum + *entry * x[*k])
    }

    /// s at J a − r = x.
    pub(super) fn cost(&self, x: S) -> Cost<S> {
        let (zero, half) = (S::zero(), S::from_f64(0.5));
        let d = self.curvature;
        let slope = d * x;
        let inner = Cost { value: half * slope * x, slope, curvature: d };
        let choose = |mask: S::Mask, a: Cost<S>, b: Cost<S>| Cost {
            value: S::select(mask, a.value, b.value),
            slope: S::select(mask, a.slope, b.slope),
            curvature: S::select(mask, a.curvature, b.curvature),
        };
        match self.side {
            Side::Both => inner,
            Side::Below => choose((-x).positive(), inner, Cost { value: zero, slope: zero, curvature: zero }),
            Side::Within([reach, loss]) => {
                let outer = |sign: S| Cost { value: loss * (sign * x - half * reach), slope: sign * loss, curvature: zero };
                let above = choose((reach - x).positive(), inner, outer(S::one()));
                choose((x + reach).positive(), above, outer(-S::one()))
            }
        }
    }
}

impl<S: Scalar> Constraints<S> {
    /// The rows of joints in a state.
    pub(super) fn joint_rows(&self, q: &[S], v: &[S]) -> Vec<JointRow<S>> {
        let mut rows: Vec<JointRow<S>> = self.friction.iter().map(|own| own.row(q, v)).collect();
        self.limits.iter().for_each(|limit| limit.rows(q, v, &mut rows));
        rows
    }
}

impl<S: Scalar> DryFriction<S> {
    fn row(&self, q: &[S], v: &[S]) -> JointRow<S> {
        let entries: Vec<(usize, S)> = match self.along {
            None => [(self.v, S::one())].into(),
            // Velocities are in axes of the body: a row of its rotation matrix
            Some((at, axis)) => {
                let rotation = quaternion(&q[at..]).to_rotation();
                (0..3).map(|k| (self.v + k, rotation[(axis, k)])).collect()
            }
        };
        // Its violation is zero.
        let rate = entries.iter().fold(S::zero(), |sum, (k, entry)| sum + *entry * v[*k]);
        let (reference, give) = self.soft.row(S::zero(), rate, self.weight);
        JointRow { entries, curvature: S::one() / give, reference, side: Side::Within([give * self.loss, self.loss]) }
    }
}

impl<S: Scalar> Limit<S> {
    /// One at each bound, where the coordinate is less than the margin away from it.
    fn rows(&self, q: &[S], v: &[S], rows: &mut Vec<JointRow<S>>) {
        let mut push = |entries: Vec<(usize, S)>, distance: S| {
            let rate = entries.iter().fold(S::zero(), |sum, (k, entry)| sum + *entry * v[*k]);
            let (reference, give) = self.soft.row(distance - self.margin, rate, self.weight);
            let curvature = flag::<S>((self.margin - distance).positive()) / give;
            rows.push(JointRow { entries, curvature, reference, side: Side::Below });
        };
        match self.bound {
            Bound::Between([lower, upper]) => {
                push([(self.v, S::one())].into(), q[self.q] - lower);
                push([(self.v, -S::one())].into(), upper - q[self.q]);
            }
            Bound::Angle(most) => {
                let turn = three(quaternion(&q[self.q..]).log().as_slice());
                let square = turn.dot(&turn);
                let is_turned = square.positive();
                let angle = S::select(is_turned, square, S::one()).sqrt();
                let axis: Vector3<S> = turn.map(|x| x / angle);
                let angle = S::select(is_turned, angle, S::zero());
                push((0..3).map(|k| (self.v + k, -axis[k])).collect(), most - angle);
            }
        }
    }
}
