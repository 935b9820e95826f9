//! A contact: rows along the normal, across it, and about its axes, with a cone of friction.
//!
//! ```text
//! u = B V − r            B: the axes of the contact, V: the relative twist
//! pyramid:  s = ½ D Σ min(0, u₀ ± μ_k u_k)²
//! ellipse:  N = μ u₀,  U_k = μ_k u_k,  T = |U|
//!           s = 0                                  where N ≥ μ T
//!           s = ½ Σ D_k u_k²,  D_k = D μ_k² / μ²   where μ N + T ≤ 0
//!           s = ½ D / (μ² (1 + μ²)) (N − μ T)²     between them
//! ```
//!
//! Source: MuJoCo documentation, Computation: friction cones.

use alloc::vec;
use alloc::vec::Vec;

use super::{Cone, Pair};
use crate::Scalar;
use crate::collision::Touch;
use crate::spatial::{Matrix3, Twist, Vector3, Wrench};

/// No contact has more rows.
pub const MOST_ROWS: usize = 6;

/// Numbers of a contact that do not change while the accelerations are found.
#[derive(Clone, Debug)]
pub(super) struct Contact<S> {
    /// The normal, and two axes across it if the contact has friction.
    frame: Vec<Vector3<S>>,
    /// The point from the origin.
    point: Vector3<S>,
    /// r.
    reference: Vec<S>,
    law: Law<S>,
}

/// What s is made of.
#[derive(Clone, Debug)]
pub(super) struct Law<S> {
    /// D.
    curvature: S,
    mu: S,
    friction: Vec<S>,
}

/// Value, slope and curvature of s over u.
pub(super) struct Cost<S> {
    pub(super) value: S,
    pub(super) slope: [S; MOST_ROWS],
    pub(super) curvature: [[S; MOST_ROWS]; MOST_ROWS],
}

/// How many numbers a place of a pair is.
pub(super) const fn length_of_place(dimension: usize) -> usize {
    2 + 3 * axes(dimension) + 3 + dimension
}

/// How many numbers a contact is as a row of a table.
pub(super) const fn length(dimension: usize) -> usize {
    of_law(dimension) + 3 * axes(dimension) + 3 + dimension
}

/// How many of them are whether it acts, and its law. These are first.
pub(super) const fn of_law(dimension: usize) -> usize {
    if dimension == 1 { 2 } else { 2 + dimension }
}

const fn axes(dimension: usize) -> usize {
    if dimension == 1 { 1 } else { 3 }
}

impl<S: Scalar> Contact<S> {
    /// A pair that touches. `twist`: of the second body seen from the first, about the same origin
    /// as the touch, in the same axes.
    pub(super) fn new(pair: &Pair<S>, cone: Cone, touch: &Touch<S>, twist: &Twist<S>) -> Self {
        let frame = touch.frame()[..axes(pair.dimension)].to_vec();
        let mut contact = Self {
            frame,
            point: touch.point,
            reference: Vec::new(),
            law: Law { curvature: S::one(), mu: pair.mu, friction: pair.friction[..pair.dimension - 1].to_vec() },
        };
        contact.reference = vec![S::zero(); pair.dimension];
        let rates = contact.rates(twist);
        let (normal, give) = pair.soft.row(touch.distance - pair.margin, rates[0], pair.weight);
        contact.reference = rates.iter().map(|rate| -(pair.tangential_damping * *rate)).collect();
        contact.reference[0] = normal;
        let give = match cone {
            Cone::Pyramid if pair.dimension > 1 => S::from_f64(2.0) * pair.mu * pair.mu * give,
            _ => give,
        };
        contact.law.curvature = S::one() / give;
        contact
    }

    /// The same for the opposite twist.
    pub(super) fn reversed(mut self) -> Self {
        self.frame.iter_mut().for_each(|axis| *axis = -*axis);
        self
    }

    /// Its numbers as a row of a table, without those of its pair.
    pub(super) fn place(&self) -> Vec<S> {
        let mut row = [S::one(), self.law.curvature].to_vec();
        self.frame.iter().chain([&self.point]).for_each(|axis| row.extend_from_slice(axis.as_slice()));
        row.extend_from_slice(&self.reference);
        row
    }

    /// The row of a place of this pair, which begins with 1: it acts. Zeros are a place where
    /// nothing touches.
    pub(super) fn row_of(pair: &Pair<S>, place: &[S]) -> Vec<S> {
        let (acts, rest) = place.split_at(2);
        let own: &[S] = if pair.dimension == 1 { &[] } else { &[pair.mu] };
        [acts, own, &pair.friction[..pair.dimension - 1], rest].concat()
    }

    /// Of such a row.
    pub(super) fn of(row: &[S], dimension: usize) -> Self {
        let (count, rest) = (axes(dimension), &row[of_law(dimension)..]);
        let axis = |k: usize| Vector3::new(rest[3 * k], rest[3 * k + 1], rest[3 * k + 2]);
        Self {
            frame: (0..count).map(axis).collect(),
            point: axis(count),
            reference: rest[3 * count + 3..][..dimension].to_vec(),
            law: Law::of(row, dimension),
        }
    }

    fn dimension(&self) -> usize {
        self.reference.len()
    }

    /// Its point from the origin.
    pub(super) fn point(&self) -> Vector3<S> {
        self.point
    }

    /// The normal.
    pub(super) fn normal(&self) -> Vector3<S> {
        self.frame[0]
    }

    /// The force of f, and its moment about the point.
    pub(super) fn acting(&self, f: &[S]) -> [Vector3<S>; 2] {
        let along = |f: &[S]| self.frame.iter().zip(f).fold(Vector3::zeros(), |sum: Vector3<S>, (axis, f)| sum + axis * *f);
        let (forces, moments) = f.split_at(f.len().min(3));
        [along(forces), along(moments)]
    }

    /// Bᵀ f.
    pub(super) fn wrench(&self, f: &[S]) -> Wrench<S> {
        let [force, turn] = self.acting(f);
        let moment = self.point.cross(&force);
        Wrench { moment: if f.len() > 3 { moment + turn } else { moment }, force }
    }

    /// B V.
    pub(super) fn rates(&self, twist: &Twist<S>) -> Vec<S> {
        let velocity = twist.linear + twist.angular.cross(&self.point);
        let of = |k: usize| if k < 3 { self.frame[k].dot(&velocity) } else { self.frame[k - 3].dot(&twist.angular) };
        (0..self.dimension()).map(of).collect()
    }

    /// B V − r at these rates B V.
    pub(super) fn beyond(&self, rates: &[S]) -> Vec<S> {
        rates.iter().zip(&self.reference).map(|(rate, reference)| *rate - *reference).collect()
    }

    /// s at these rates B V.
    pub(super) fn cost(&self, cone: Cone, rates: &[S]) -> Cost<S> {
        self.law.cost(cone, &self.beyond(rates))
    }

    /// K = Bᵀ s″ B, its upper triangle row by row.
    ///
    /// ```text
    /// A = Σ s″ n nᵀ  over axes of forces, C of force and moment, D of moments
    /// K = [X A Xᵀ + X C + Cᵀ Xᵀ + D,  X A + Cᵀ;  ·,  A]        X: the cross product of the point
    /// ```
    pub(super) fn inertia(&self, s: &[[S; MOST_ROWS]; MOST_ROWS]) -> [S; 21] {
        let d = self.dimension();
        let (forces, moments) = (0..d.min(3), 3..d.max(3));
        let sum = |rows: core::ops::Range<usize>, columns: core::ops::Range<usize>| {
            let mut sum = Matrix3::<S>::zeros();
            for k in rows {
                let pushed = columns.clone().fold(Vector3::zeros(), |sum: Vector3<S>, l| sum + self.frame[l % 3] * s[k][l]);
                sum += self.frame[k % 3] * pushed.transpose();
            }
            sum
        };
        let a = sum(forces.clone(), forces.clone());
        let crossed = |m: &Matrix3<S>| Matrix3::from_columns(&[0, 1, 2].map(|k| self.point.cross(&m.column(k))));
        let mut mixed = crossed(&a);
        let mut angular = crossed(&mixed.transpose()).transpose();
        if d > 3 {
            let c = sum(forces, moments.clone());
            let turned = crossed(&c);
            angular += turned + turned.transpose() + sum(moments.clone(), moments);
            mixed += c.transpose();
        }
        let block = |i: usize, j: usize| match (i / 3, j / 3) {
            (0, 0) => angular[(i, j)],
            (0, _) => mixed[(i, j - 3)],
            _ => a[(i - 3, j - 3)],
        };
        let mut upper = (0..6).flat_map(|i| (i..6).map(move |j| (i, j)));
        core::array::from_fn(|_| upper.next().map_or(S::zero(), |(i, j)| block(i, j)))
    }
}

impl<S: Scalar> Law<S> {
    /// Of the row of a contact.
    pub(super) fn of(row: &[S], dimension: usize) -> Self {
        match dimension {
            1 => Self { curvature: row[1], mu: S::zero(), friction: Vec::new() },
            _ => Self { curvature: row[1], mu: row[2], friction: row[3..][..dimension - 1].to_vec() },
        }
    }

    /// Slope and curvature of s(u + α v) over α.
    pub(super) fn along(&self, cone: Cone, u: &[S], v: &[S], alpha: S) -> [S; 2] {
        let at: Vec<S> = u.iter().zip(v).map(|(u, v)| *u + alpha * *v).collect();
        let Cost { slope, curvature, .. } = self.cost(cone, &at);
        let mut sums = [S::zero(); 2];
        for (k, v_k) in v.iter().enumerate() {
            sums[0] += slope[k] * *v_k;
            sums[1] += v.iter().zip(curvature[k]).fold(S::zero(), |sum, (v, c)| sum + c * *v) * *v_k;
        }
        sums
    }

    fn cost(&self, cone: Cone, u: &[S]) -> Cost<S> {
        match cone {
            Cone::Ellipse if u.len() > 1 => self.ellipse(u),
            _ => self.pyramid(u),
        }
    }

    fn pyramid(&self, u: &[S]) -> Cost<S> {
        let (zero, half) = (S::zero(), S::from_f64(0.5));
        let mut cost = Cost { value: zero, slope: [zero; MOST_ROWS], curvature: [[zero; MOST_ROWS]; MOST_ROWS] };
        let below = |x: S, value: S| S::select((-x).positive(), value, zero);
        let d = self.curvature;
        if u.len() == 1 {
            let force = below(u[0], d * u[0]);
            (cost.value, cost.slope[0], cost.curvature[0][0]) = (half * force * u[0], force, below(u[0], d));
            return cost;
        }
        for (k, mu) in (1..).zip(&self.friction) {
            let across = *mu * u[k];
            let edges = [u[0] + across, u[0] - across];
            let [f, g] = edges.map(|x| below(x, d * x));
            let [a, b] = edges.map(|x| below(x, d));
            cost.value += half * (f * edges[0] + g * edges[1]);
            cost.slope[0] += f + g;
            cost.slope[k] = *mu * (f - g);
            cost.curvature[0][0] += a + b;
            let mixed = *mu * (a - b);
            (cost.curvature[0][k], cost.curvature[k][0]) = (mixed, mixed);
            cost.curvature[k][k] = *mu * *mu * (a + b);
        }
        cost
    }

    fn ellipse(&self, u: &[S]) -> Cost<S> {
        let (zero, one, half) = (S::zero(), S::one(), S::from_f64(0.5));
        let (mu, d) = (self.mu, self.curvature);
        let normal = mu * u[0];
        let across: Vec<S> = u[1..].iter().zip(&self.friction).map(|(u, own)| *own * *u).collect();
        let square = across.iter().fold(zero, |sum, x| sum + *x * *x);
        // Without sliding, T is zero, and so is each U.
        let length = S::select(square.positive(), square, one).sqrt();
        let slip = S::select(square.positive(), length, zero);
        let is_below = (-(mu * normal + slip)).positive();
        let is_above = (normal - mu * slip).positive();
        let choose = |bottom: S, middle: S| S::select(is_above, zero, S::select(is_below, bottom, middle));
        // Between: with e = N − μ T
        let weight = d / (mu * mu * (one + mu * mu));
        let e = normal - mu * slip;
        let unit: Vec<S> = across.iter().map(|x| *x / length).collect();
        let part = |k: usize| if k == 0 { mu } else { self.friction[k - 1] };
        // ∂e/∂u
        let gradient = |k: usize| if k == 0 { mu } else { -(mu * unit[k - 1] * part(k)) };
        let own = |k: usize| if k == 0 { d } else { d * part(k) * part(k) / (mu * mu) };
        let mut cost = Cost { value: zero, slope: [zero; MOST_ROWS], curvature: [[zero; MOST_ROWS]; MOST_ROWS] };
        let bottom = (0..u.len()).fold(zero, |sum, k| sum + own(k) * u[k] * u[k]);
        cost.value = half * choose(bottom, weight * e * e);
        for k in 0..u.len() {
            cost.slope[k] = choose(own(k) * u[k], weight * e * gradient(k));
            for j in 0..=k {
                // ∂²e/∂u² = −μ / T (1 − t tᵀ) across, t = U / T
                let bent = if j == 0 {
                    zero
                } else {
                    let plane = if j == k { one } else { zero } - unit[k - 1] * unit[j - 1];
                    -(mu * e / length * plane * part(k) * part(j))
                };
                let middle = weight * (gradient(k) * gradient(j) + bent);
                let value = choose(if j == k { own(k) } else { zero }, middle);
                (cost.curvature[k][j], cost.curvature[j][k]) = (value, value);
            }
        }
        cost
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn law(dimension: usize) -> Law<f64> {
        Law { curvature: 70.0, mu: 0.8, friction: [0.9, 0.9, 0.05, 0.01, 0.01][..dimension - 1].to_vec() }
    }

    /// Slopes and curvatures are those of the value, in all zones, and the value is continuous.
    #[test]
    fn slopes_and_curvatures_are_derivatives_of_the_cost() {
        for cone in [Cone::Pyramid, Cone::Ellipse] {
            for dimension in [1, 3, 4, 6] {
                let one = law(dimension);
                for k in 0..400_u32 {
                    let x = |j: u32| f64::from((k * 37 + j * 101 + 13) % 97) / 48.5 - 1.0;
                    let u: Vec<f64> = (0..dimension as u32).map(x).collect();
                    let moved = |j: usize, h: f64| {
                        let mut u = u.clone();
                        u[j] += h;
                        one.cost(cone, &u)
                    };
                    let (cost, h) = (one.cost(cone, &u), 1e-6);
                    for i in 0..dimension {
                        let (after, before) = (moved(i, h), moved(i, -h));
                        let slope = (after.value - before.value) / (2.0 * h);
                        assert!((slope - cost.slope[i]).abs() < 1e-3, "{cone:?} {dimension} {u:?}: {slope} {}", cost.slope[i]);
                        for j in 0..dimension {
                            let slope = (after.slope[j] - before.slope[j]) / (2.0 * h);
                            let at_switch = (moved(i, h).curvature[i][j] - moved(i, -h).curvature[i][j]).abs() > 1.0;
                            assert!(
                                at_switch || (slope - cost.curvature[i][j]).abs() < 2e-2,
                                "{cone:?} {u:?} {i} {j}: {slope} {}",
                                cost.curvature[i][j]
                            );
                        }
                    }
                }
            }
        }
    }
}
