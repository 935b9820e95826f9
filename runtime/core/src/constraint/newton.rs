//! The minimum of the problem of constraints, by Newton's method with an exact line search.
//!
//! ```text
//! g = M (x − x₀) + Jᵀ s′(J x − r)      H = M + Jᵀ s″ J      x ← x − α H⁻¹ g
//! ```
//!
//! A contact of body b with the world has rows B V_b, so that it gives H what a 6×6 inertia
//! K = Bᵀ s″ B on that body gives to M: no row of J is formed. A contact of two bodies has the rows
//! of both, of opposite sign.
//!
//! x is the acceleration with those of origins of floating joints as d²p/dt²: J̇ v is not in the
//! law. Source: Todorov, ICRA 2014; MuJoCo documentation, Computation: primal solvers.

use alloc::vec;
use alloc::vec::Vec;

use super::contact::{self, Contact};
use super::joints::JointRow;
use super::{Cone, Constraints};
use crate::Scalar;
use crate::algorithm::ltdl::{factor, path_to_root, solve};
use crate::algorithm::{Placed as Bodies, Workspace, mass_matrix};
use crate::collision::{Placed, touches};
use crate::index::{BodyId, ById};
use crate::model::Model;
use crate::scalar::{flag, two_to};
use crate::spatial::{ArticulatedInertia, Matrix3, Placement, Twist, Vector3, Wrench};

/// Largest number of steps of Newton's method.
const MOST: usize = 50;
/// Largest number of steps of a line search.
const MOST_ON_A_LINE: usize = 40;
/// Powers of two, of `f64` and of `f32`: the slope on a line that ends its search, as a part of
/// that at its start, and a change of α that is none.
const LINE: [i32; 2] = [-30, -10];
const STILL: [i32; 2] = [-50, -20];
/// The same: a gradient in parts of its terms that ends the iteration, and one that ends it if it
/// no longer falls.
const SETTLED: [i32; 2] = [-49, -16];
const SMALL: [i32; 2] = [-30, -10];

/// State and smooth motion of a robot.
pub(crate) struct Smooth<'a, S> {
    pub(crate) q: &'a [S],
    pub(crate) v: &'a [S],
    /// The acceleration without constraints, of origins d²p/dt².
    pub(crate) a: &'a [S],
    /// A guess of the acceleration, or empty.
    pub(crate) warm: &'a [S],
}

/// The acceleration with constraints, of origins d²p/dt², and Jᵀ f of their forces.
pub(crate) fn constrained<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, smooth: &Smooth<'_, S>) -> (Vec<S>, Vec<S>) {
    let problem = Problem::new(model, ws, smooth);
    let mut x = problem.minimum(smooth.warm);
    // δ = 0 solves H δ + g(x, p) = 0. Its derivative is −H⁻¹ ∂g/∂p, that of x(p) by the implicit
    // function theorem.
    S::hold(&mut x);
    let mut hessian = problem.curvature(&x);
    S::hold(&mut hessian);
    let mut correction = vec![S::zero(); x.len()];
    let residual = |_: &mut (), correction: &[S], r: &mut [S]| {
        let (slope, _) = problem.slope(&x);
        let product = times(&hessian, &problem.parents, correction);
        r.iter_mut().zip(slope).zip(product).for_each(|((r, g), own)| *r = g + own);
    };
    let inverse = |_: &mut (), b: &mut [S]| {
        let mut matrix = hessian.clone();
        factor(&mut matrix, &problem.parents);
        solve(&matrix, &problem.parents, b);
    };
    S::implicit(&mut (), &mut correction, |_, correction| correction.fill(S::zero()), residual, inverse);
    x.iter_mut().zip(correction).for_each(|(x, own)| *x += own);
    let forces = times(&problem.mass, &problem.branches, &problem.beyond(&x));
    (x, forces)
}

/// A column of J of all bodies beyond a joint.
struct Column<S> {
    body: BodyId,
    at: usize,
    axis: Twist<S>,
}

/// Contacts of one dimension: of one body with the world, or of pairs of bodies.
struct Group<S> {
    /// `None`: pairs of bodies. Each has a sign for each column: in which way it moves the contact.
    body: Option<BodyId>,
    dimension: usize,
    count: usize,
    table: Vec<S>,
}

/// Twists of all bodies about the origin, or of each column alone.
struct Motion<S> {
    bodies: ById<BodyId, Twist<S>>,
    columns: Vec<Twist<S>>,
}

struct Problem<'a, S: 'static> {
    model: &'a Model<S>,
    cone: Cone,
    /// The way to the base of each degree of freedom, in H.
    parents: Vec<usize>,
    /// The same in M.
    branches: Vec<usize>,
    mass: Vec<S>,
    start: &'a [S],
    columns: Vec<Column<S>>,
    rows: Vec<JointRow<S>>,
    groups: Vec<Group<S>>,
}

impl<'a, S: Scalar> Problem<'a, S> {
    fn new(model: &'a Model<S>, ws: &mut Workspace<S>, smooth: &Smooth<'a, S>) -> Self {
        let nv = model.nv;
        let mut mass = vec![S::zero(); nv * nv];
        mass_matrix(model, ws, smooth.q, &mut mass);
        let floats = model.bodies.get(BodyId(1)).is_some_and(|body| body.joint.is_unconstrained());
        let branches = ws.parent_dof.clone();
        let placed = Bodies::at(model, ws, smooth.q);
        // All moments are about the first body, if it floats: numbers stay small far from the
        // origin of the world.
        let origin = if floats { placed.frame(BodyId(1), &Placement::identity()).position } else { Vector3::zeros() };
        let columns = placed.columns(origin).map(|(body, at, axis)| Column { body, at, axis }).collect();
        let constraints = &model.constraints;
        let mut problem = Self {
            model,
            cone: constraints.cone,
            parents: branches.clone(),
            branches,
            mass,
            start: smooth.a,
            columns,
            rows: constraints.joint_rows(smooth.q, smooth.v),
            groups: Vec::new(),
        };
        problem.find_contacts(constraints, &placed, origin, smooth.v);
        // Pairs couple branches: all are one chain.
        if problem.groups.iter().any(|group| group.body.is_none()) {
            problem.parents = (0..nv).collect();
        }
        problem
    }

    fn find_contacts(&mut self, constraints: &Constraints<S>, placed: &Bodies<'_, S>, origin: Vector3<S>, v: &[S]) {
        let twists = self.motion(v).bodies;
        let place = |shape: usize| {
            let shape = &constraints.shapes[shape];
            let at = match shape.body.is_base() {
                true => shape.placement,
                false => placed.frame(shape.body, &shape.placement),
            };
            let Placement { rotation, position } = Placement { position: at.position - origin, ..at };
            Placed { form: &shape.form, rotation, position }
        };
        for pair in &constraints.pairs {
            let [first, second] = pair.shapes;
            let bodies = [first, second].map(|shape| constraints.shapes[shape].body);
            let relative = twists[bodies[1]] - twists[bodies[0]];
            for touch in touches(&place(first), &place(second), pair.margin) {
                self.add(bodies, pair.dimension, Contact::new(pair, self.cone, &touch, &relative));
            }
        }
    }

    fn add(&mut self, bodies: [BodyId; 2], dimension: usize, contact: Contact<S>) {
        let (moving, contact) = match bodies {
            [BodyId::BASE, second] => (Some(second), contact),
            [first, BodyId::BASE] => (Some(first), contact.reversed()),
            _ => (None, contact),
        };
        let known = self.groups.iter().position(|group| group.body == moving && group.dimension == dimension);
        let index = known.unwrap_or_else(|| {
            self.groups.push(Group { body: moving, dimension, count: 0, table: Vec::new() });
            self.groups.len() - 1
        });
        let group = &mut self.groups[index];
        group.count += 1;
        contact.put(&mut group.table);
        if moving.is_none() {
            let signs = self.columns.iter().map(|column| {
                let [first, second] = bodies.map(|body| self.model.is_on_the_way(column.body, body));
                match (first, second) {
                    (true, false) => -S::one(),
                    (false, true) => S::one(),
                    _ => S::zero(),
                }
            });
            group.table.extend(signs);
        }
    }

    /// Motion at these rates.
    fn motion(&self, x: &[S]) -> Motion<S> {
        let mut bodies: ById<BodyId, Twist<S>> = vec![Twist::zero(); self.model.bodies.len()].into();
        let columns: Vec<Twist<S>> = self.columns.iter().map(|column| column.axis.times(x[column.at])).collect();
        let mut next = self.columns.iter().zip(&columns).peekable();
        for body in self.model.outward() {
            let mut twist = bodies[self.model.bodies[body].parent];
            while let Some((_, own)) = next.next_if(|(column, _)| column.body == body) {
                twist = twist + *own;
            }
            bodies[body] = twist;
        }
        Motion { bodies, columns }
    }

    /// Visits the contacts of a group that act, with the relative twists of N motions:
    /// `visit(contact, twists, signs of the columns, state)`.
    fn each<const N: usize>(
        group: &Group<S>,
        motions: [&Motion<S>; N],
        state: &mut [S],
        visit: impl Fn(&Contact<S>, [Twist<S>; N], &[S], &mut [S]),
    ) {
        let length = contact::length(group.dimension);
        S::for_each(group.count, &group.table, state, &mut [], |row, state, _| {
            S::when(row[0].positive(), state, |state| {
                let (contact, signs) = (Contact::of(row, group.dimension), &row[length..]);
                let relative = motions.map(|motion| match group.body {
                    Some(body) => motion.bodies[body],
                    None => {
                        let columns = motion.columns.iter().zip(signs);
                        columns.fold(Twist::zero(), |sum, (own, sign)| sum + own.times(*sign))
                    }
                });
                visit(&contact, relative, signs, state);
            });
        });
    }

    /// g, and the sum of the sizes of its terms, both with M's diagonal as weights.
    fn slope(&self, x: &[S]) -> (Vec<S>, Vec<S>) {
        let smooth = times(&self.mass, &self.branches, &self.beyond(x));
        let mut forces = vec![S::zero(); smooth.len()];
        for row in &self.rows {
            let slope = row.cost(row.along(x) - row.reference).slope;
            row.entries.iter().for_each(|(k, entry)| forces[*k] += *entry * slope);
        }
        let motion = self.motion(x);
        let mut wrenches: ById<BodyId, Wrench<S>> = vec![Wrench::zero(); self.model.bodies.len()].into();
        for group in &self.groups {
            let on_contact = |contact: &Contact<S>, twist: Twist<S>| {
                let cost = contact.cost(self.cone, &contact.residual(&twist));
                (0..group.dimension).fold(Wrench::zero(), |sum, k| sum + contact.row(k).times(cost.slope[k]))
            };
            match group.body {
                Some(body) => {
                    let mut state = [S::zero(); 6];
                    Self::each(group, [&motion], &mut state, |contact, [twist], _, state| {
                        let w = on_contact(contact, twist);
                        state.iter_mut().zip(w.moment.iter().chain(&w.force)).for_each(|(sum, x)| *sum += *x);
                    });
                    let [a, b, c, x, y, z] = state;
                    wrenches[body] += Wrench { moment: Vector3::new(a, b, c), force: Vector3::new(x, y, z) };
                }
                None => Self::each(group, [&motion], &mut forces, |contact, [twist], signs, state| {
                    let w = on_contact(contact, twist);
                    self.columns.iter().zip(signs).for_each(|(column, sign)| state[column.at] += *sign * w.power(&column.axis));
                }),
            }
        }
        for body in self.model.inward() {
            let own = wrenches[body];
            self.columns.iter().filter(|column| column.body == body).for_each(|column| forces[column.at] += own.power(&column.axis));
            wrenches[self.model.bodies[body].parent] += own;
        }
        let slope = smooth.iter().zip(&forces).map(|(a, b)| *a + *b).collect();
        let size = smooth.iter().zip(&forces).map(|(a, b)| a.abs() + b.abs()).collect();
        (slope, size)
    }

    /// H, on and below its diagonal.
    fn curvature(&self, x: &[S]) -> Vec<S> {
        let n = x.len();
        let mut hessian = self.mass.clone();
        for row in &self.rows {
            let curvature = row.cost(row.along(x) - row.reference).curvature;
            for (i, a) in &row.entries {
                row.entries.iter().filter(|(j, _)| j <= i).for_each(|(j, b)| hessian[i * n + j] += curvature * *a * *b);
            }
        }
        let motion = self.motion(x);
        let mut inertias: ById<BodyId, Option<ArticulatedInertia<S>>> = vec![None; self.model.bodies.len()].into();
        for group in &self.groups {
            let d = group.dimension;
            let of = |contact: &Contact<S>, twist: Twist<S>| contact.cost(self.cone, &contact.residual(&twist)).curvature;
            match group.body {
                Some(body) => {
                    let mut state = [S::zero(); 21];
                    Self::each(group, [&motion], &mut state, |contact, [twist], _, state| {
                        let (s, rows) = (of(contact, twist), (0..d).map(|k| six(&contact.row(k))));
                        let rows: Vec<[S; 6]> = rows.collect();
                        // K += Σ_k b_k (Σ_l s″_kl b_l)ᵀ
                        for (k, row) in rows.iter().enumerate() {
                            let other: [S; 6] = core::array::from_fn(|j| (0..d).fold(S::zero(), |sum, l| sum + s[k][l] * rows[l][j]));
                            let mut place = 0;
                            for i in 0..6 {
                                for x in &other[i..] {
                                    state[place] += row[i] * *x;
                                    place += 1;
                                }
                            }
                        }
                    });
                    *inertias[body].get_or_insert(ArticulatedInertia::zero()) += of_triangle(&state);
                }
                None => {
                    let mut state: Vec<S> = (0..n).flat_map(|i| hessian[i * n..][..=i].to_vec()).collect();
                    Self::each(group, [&motion], &mut state, |contact, [twist], signs, state| {
                        let s = of(contact, twist);
                        let mut rows = vec![vec![S::zero(); n]; d];
                        for (column, sign) in self.columns.iter().zip(signs) {
                            (0..d).for_each(|k| rows[k][column.at] += *sign * contact.along(k, &column.axis));
                        }
                        for k in 0..d {
                            let other: Vec<S> = (0..n).map(|j| (0..d).fold(S::zero(), |sum, l| sum + s[k][l] * rows[l][j])).collect();
                            let mut place = 0;
                            for i in 0..n {
                                for x in &other[..=i] {
                                    state[place] += rows[k][i] * *x;
                                    place += 1;
                                }
                            }
                        }
                    });
                    let mut place = 0;
                    for i in 0..n {
                        hessian[i * n..][..=i].copy_from_slice(&state[place..][..=i]);
                        place += i + 1;
                    }
                }
            }
        }
        self.project(&mut inertias, &mut hessian);
        hessian
    }

    /// Adds what inertias on bodies are in joints: Sᵀ K S.
    fn project(&self, inertias: &mut ById<BodyId, Option<ArticulatedInertia<S>>>, hessian: &mut [S]) {
        let n = self.start.len();
        for body in self.model.inward() {
            let Some(inertia) = inertias[body] else { continue };
            for (c, column) in self.columns.iter().enumerate().filter(|(_, column)| column.body == body) {
                let wrench = inertia.apply(&column.axis);
                for (other, own) in self.columns[..=c].iter().enumerate().filter(|(_, own)| self.model.is_on_the_way(own.body, body)) {
                    let entry = wrench.power(&own.axis);
                    let (i, j) = (column.at.max(own.at), column.at.min(own.at));
                    // Two columns that move by one coordinate
                    let entry = if i == j && other != c { entry + entry } else { entry };
                    hessian[i * n + j] += entry;
                }
            }
            let parent = self.model.bodies[body].parent;
            if !parent.is_base() {
                *inertias[parent].get_or_insert(ArticulatedInertia::zero()) += inertia;
            }
        }
    }

    /// ½ (x − x₀)ᵀ M (x − x₀) + s.
    fn cost(&self, x: &[S]) -> S {
        let (y, half) = (self.beyond(x), S::from_f64(0.5));
        let mut cost = times(&self.mass, &self.branches, &y).iter().zip(&y).fold(S::zero(), |sum, (a, b)| sum + *a * *b) * half;
        for row in &self.rows {
            cost += row.cost(row.along(x) - row.reference).value;
        }
        let motion = self.motion(x);
        let mut state = [cost];
        for group in &self.groups {
            Self::each(group, [&motion], &mut state, |contact, [twist], _, state| {
                state[0] += contact.cost(self.cone, &contact.residual(&twist)).value;
            });
        }
        state[0]
    }

    /// Slope and curvature of the cost at x + α dx, along dx.
    fn along(&self, [at, by]: [&Motion<S>; 2], rows: &[[S; 2]], [slope, curvature]: [S; 2], alpha: S) -> [S; 2] {
        let mut state = [slope + alpha * curvature, curvature];
        for (row, [own, along]) in self.rows.iter().zip(rows) {
            let cost = row.cost(*own + alpha * *along);
            state[0] += cost.slope * *along;
            state[1] += cost.curvature * *along * *along;
        }
        for group in &self.groups {
            let d = group.dimension;
            Self::each(group, [at, by], &mut state, |contact, [twist, dx], _, state| {
                let along = contact.rates(&dx);
                let u: Vec<S> = contact.residual(&twist).iter().zip(&along).map(|(u, du)| *u + alpha * *du).collect();
                let cost = contact.cost(self.cone, &u);
                for k in 0..d {
                    state[0] += cost.slope[k] * along[k];
                    state[1] += (0..d).fold(S::zero(), |sum, l| sum + cost.curvature[k][l] * along[l]) * along[k];
                }
            });
        }
        state
    }

    /// α where the slope along dx is zero, by Newton's method within bounds.
    fn line(&self, x: &[S], dx: &[S]) -> S {
        let (zero, one, half) = (S::zero(), S::one(), S::from_f64(0.5));
        let (at, by) = (self.motion(x), self.motion(dx));
        let rows: Vec<[S; 2]> = self.rows.iter().map(|row| [row.along(x) - row.reference, row.along(dx)]).collect();
        let pushed = times(&self.mass, &self.branches, dx);
        let dot = |a: &[S], b: &[S]| a.iter().zip(b).fold(zero, |sum, (a, b)| sum + *a * *b);
        let smooth = [dot(&pushed, &self.beyond(x)), dot(&pushed, dx)];
        let [first, _] = self.along([&at, &by], &rows, smooth, zero);
        let [enough, still] = [LINE, STILL].map(|n| bound(first, n));
        let enough = enough * first.abs();
        // α, and bounds below and above it; above is 0 where there is none yet.
        let mut state = [one, zero, zero];
        let _ = S::repeat(MOST_ON_A_LINE, &mut state, |state| {
            let [alpha, below, above] = [state[0], state[1], state[2]];
            let [slope, curvature] = self.along([&at, &by], &rows, smooth, alpha);
            let is_before = (-slope).positive();
            let (below, above) = (S::select(is_before, alpha, below), S::select(is_before, above, alpha));
            let divisor = S::select(curvature.positive(), curvature, one);
            let next = alpha - slope / divisor;
            // Half way where Newton's step leaves the bounds, twice as far where there is none.
            let fallback = S::select(above.positive(), half * (below + above), alpha + alpha);
            let inside = S::select((next - below).positive(), next, fallback);
            let beyond = S::select(above.positive(), next - above, -one);
            let inside = S::select(beyond.positive(), fallback, inside);
            let ends = (enough - slope.abs()).positive();
            // Also where nothing moves, and where something is no number
            let moves = flag::<S>(((inside - alpha).abs() - still * alpha.abs()).positive());
            let is_done = S::select(ends, one, one - moves * flag::<S>(slope.abs().positive()));
            state[0] = S::select(is_done.positive(), alpha, inside);
            (state[1], state[2]) = (below, above);
            is_done.positive()
        });
        state[0]
    }

    /// Σ g² / M, and the same of the sizes of its terms.
    fn squares(&self, (slope, size): &(Vec<S>, Vec<S>)) -> [S; 2] {
        let n = slope.len();
        let of = |x: &[S]| x.iter().enumerate().fold(S::zero(), |sum, (i, x)| sum + *x * *x / self.mass[i * n + i]);
        [of(slope), of(size)]
    }

    /// The x at which the cost is least.
    fn minimum(&self, warm: &[S]) -> Vec<S> {
        let nv = self.start.len();
        let mut state = self.start.to_vec();
        if !warm.is_empty() {
            let is_better = (self.cost(self.start) - self.cost(warm)).positive();
            state.iter_mut().zip(warm).for_each(|(x, warm)| *x = S::select(is_better, *warm, *x));
        }
        let [square, size] = self.squares(&self.slope(&state));
        // The last square of the gradient
        state.push(square);
        let [settled, small] = [SETTLED, SMALL].map(|n| bound(size, n.map(|n| 2 * n)));
        S::when((square - settled * size).positive(), &mut state, |state| {
            let _converged = S::repeat(MOST, state, |state| {
                let (x, last) = state.split_at_mut(nv);
                let mut hessian = self.curvature(x);
                let (mut dx, _) = self.slope(x);
                factor(&mut hessian, &self.parents);
                solve(&hessian, &self.parents, &mut dx);
                dx.iter_mut().for_each(|dx| *dx = -*dx);
                let alpha = self.line(x, &dx);
                x.iter_mut().zip(&dx).for_each(|(x, dx)| *x += alpha * *dx);
                let [square, size] = self.squares(&self.slope(x));
                // Also of zeros, and of what is no number
                let is_settled = S::one() - flag::<S>((square - settled * size).positive());
                let is_small = flag::<S>((small * size - square).positive());
                let falls = flag::<S>((last[0] - square - square).positive());
                last[0] = square;
                (is_settled + is_small * (S::one() - falls)).positive()
            });
        });
        state.truncate(nv);
        state
    }

    /// x − x₀.
    fn beyond(&self, x: &[S]) -> Vec<S> {
        x.iter().zip(self.start).map(|(x, start)| *x - *start).collect()
    }
}

/// A bound of each precision, of which one counts: generated code is the same for both, so that x,
/// a number of the state, tells how many bits there are.
fn bound<S: Scalar>(x: S, [wide, narrow]: [i32; 2]) -> S {
    let change = (x + x * S::from_f64(two_to(-40))) - x;
    S::select(change.abs().positive(), S::from_f64(two_to(wide)), S::from_f64(two_to(narrow)))
}

/// M y of a symmetric matrix by its entries on and below the diagonal.
fn times<S: Scalar>(matrix: &[S], parents: &[usize], y: &[S]) -> Vec<S> {
    let n = y.len();
    let mut product: Vec<S> = (0..n).map(|i| matrix[i * n + i] * y[i]).collect();
    for i in 0..n {
        for j in path_to_root(parents, i) {
            product[i] += matrix[i * n + j] * y[j];
            product[j] += matrix[i * n + j] * y[i];
        }
    }
    product
}

fn six<S: Scalar>(w: &Wrench<S>) -> [S; 6] {
    [w.moment.x, w.moment.y, w.moment.z, w.force.x, w.force.y, w.force.z]
}

/// The inertia of an upper triangle, row by row.
fn of_triangle<S: Scalar>(k: &[S; 21]) -> ArticulatedInertia<S> {
    let symmetric = |[a, b, c, d, e, f]: [usize; 6]| Matrix3::new(k[a], k[b], k[c], k[b], k[d], k[e], k[c], k[e], k[f]);
    ArticulatedInertia {
        angular: symmetric([0, 1, 2, 6, 7, 11]),
        coupling: Matrix3::new(k[3], k[4], k[5], k[8], k[9], k[10], k[12], k[13], k[14]),
        linear: symmetric([15, 16, 17, 18, 19, 20]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::collision::{Form, Shape};
    use crate::constraint::{Bound, DryFriction, Limit, Pair, Soft};
    use crate::description::{Base, Description, Inertial, Joint, JointKind, Link, LinkId, Origin};

    const MASS: f64 = 2.0;

    /// A ball of radius 0.1 m on a slide along z.
    fn ball(constraints: Constraints) -> Model<f64> {
        let link = |name: &str| Link { name: name.into(), ..Link::default() };
        let inertial = Inertial { origin: Origin::default(), mass: MASS, inertia: [1.0, 0.0, 0.0, 1.0, 0.0, 1.0] };
        let heavy = Link { inertial: Some(inertial), ..link("ball") };
        let joint = Joint {
            name: "z".into(),
            kind: JointKind::Prismatic,
            parent: LinkId(0),
            child: LinkId(1),
            axis: [0.0, 0.0, 1.0],
            ..Joint::default()
        };
        let robot = Description { name: "r".into(), links: [link("floor"), heavy].into(), joints: [joint].into(), frames: Vec::new() };
        Model::new(&robot, Base::Fixed).expect("a model").with_constraints(constraints)
    }

    fn solved(model: &Model<f64>, q: f64, v: f64, a: f64) -> f64 {
        let smooth = Smooth { q: &[q], v: &[v], a: &[a], warm: &[] };
        constrained(model, &mut Workspace::new(model), &smooth).0[0]
    }

    fn soft() -> Soft {
        Soft::of([0.02, 1.0], [0.9, 0.9, 0.001, 0.5, 2.0], None).expect("a constant impedance")
    }

    /// k and b of this impedance.
    const K: f64 = 1.0 / (0.9 * 0.9 * 0.02 * 0.02);
    const B: f64 = 2.0 / (0.9 * 0.02);

    /// With one row, a = (1 − d) a₀ + d r where that pushes.
    #[test]
    fn a_contact_and_a_limit_are_those_of_the_closed_form() {
        let floor = Shape { name: "floor".into(), body: BodyId::BASE, placement: Placement::identity(), form: Form::Plane };
        let shape = Shape { name: "ball".into(), body: BodyId(1), placement: Placement::identity(), form: Form::Sphere { radius: 0.1 } };
        let pair = Pair {
            shapes: [0, 1],
            dimension: 1,
            friction: [1.0; 5],
            mu: 1.0,
            margin: 0.0,
            soft: soft(),
            tangential_damping: B,
            weight: 1.0 / MASS,
        };
        let touching = ball(Constraints { shapes: [floor, shape].into(), pairs: [pair].into(), ..Constraints::default() });
        let limit = Limit { q: 0, v: 0, bound: Bound::Between([0.1, 9.0]), margin: 0.0, soft: soft(), weight: 1.0 / MASS };
        let limited = ball(Constraints { limits: [limit].into(), ..Constraints::default() });
        for (q, v) in [(0.095, 0.0), (0.095, -1.0), (0.099, 0.3), (0.0999, 2.0)] {
            let (a, r) = (-9.81, -B * v - K * 0.9 * (q - 0.1));
            let expected = if r > a { 0.1 * a + 0.9 * r } else { a };
            for model in [&touching, &limited] {
                let found = solved(model, q, v, a);
                assert!((found - expected).abs() < 1e-12 * expected.abs(), "{q} {v}: {found} {expected}");
            }
        }
        // Not in contact
        assert_eq!((solved(&touching, 0.11, -1.0, -9.81), solved(&limited, 0.11, -1.0, -9.81)), (-9.81, -9.81));
    }

    /// It holds what is weaker than it, and slows what is stronger.
    #[test]
    fn dry_friction_has_a_greatest_force() {
        let friction = DryFriction { v: 0, loss: 3.0, soft: soft(), weight: 1.0 / MASS };
        let model = ball(Constraints { friction: [friction].into(), ..Constraints::default() });
        assert!((solved(&model, 0.0, 0.0, 1.0) - 0.1).abs() < 1e-14);
        assert!((solved(&model, 0.0, 0.0, -8.0) - (-8.0 + 3.0 / MASS)).abs() < 1e-14);
        assert!((solved(&model, 0.0, 5.0, 8.0) - (8.0 - 3.0 / MASS)).abs() < 1e-14);
    }
}
