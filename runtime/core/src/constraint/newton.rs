//! The minimum of the problem of constraints, by Newton's method with a line search.
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

use alloc::collections::{BTreeMap, BTreeSet};
use alloc::vec;
use alloc::vec::Vec;

use super::Cone;
use super::anchors::{self, Moving};
use super::contact::{self, Contact, Law};
use super::joints::JointRow;
use super::motion::{self, Column, Twists};
use super::pairs::{self, Found};
use super::sums;
use crate::Scalar;
use crate::algorithm::ltdl::{factor, inverse_square, path_to_root, solve};
use crate::algorithm::{Placed as Bodies, Workspace, mass_matrix};
use crate::index::{BodyId, ById};
use crate::model::Model;
use crate::scalar::{flag, greater, of_precision};
use crate::spatial::{ArticulatedInertia, Matrix3, Wrench};

/// Largest number of steps of Newton's method.
const MOST: usize = 50;
/// Largest number of steps of a line search.
const MOST_ON_A_LINE: usize = 40;
/// The slope on a line that ends its search, as a part of that at its start: less would cost more
/// than it saves.
const LINE: f64 = 1.0 / 256.0;
/// Powers of two, of `f64` and of `f32`: a change of α that is none.
const STILL: [i32; 2] = [-50, -20];
/// The same: a gradient in parts of its terms that ends the iteration, and one that ends it if it
/// no longer falls; a step in parts of x that ends it then too, where stiff rows multiply
/// roundings.
const SETTLED: [i32; 2] = [-49, -16];
const SMALL: [i32; 2] = [-30, -10];
const SHORT: [i32; 2] = [-46, -18];

/// State and smooth motion of a robot.
pub(crate) struct Smooth<'a, S> {
    pub(crate) q: &'a [S],
    pub(crate) v: &'a [S],
    /// The acceleration without constraints, of origins d²p/dt².
    pub(crate) a: &'a [S],
    /// A guess of the acceleration, or empty.
    pub(crate) warm: &'a [S],
    /// Contacts that a caller found, `[given][8]`, or empty: there are none.
    pub(crate) given: &'a [S],
}

/// The acceleration with constraints, of origins d²p/dt², and Jᵀ f of their forces.
pub(crate) fn constrained<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, smooth: &Smooth<'_, S>) -> (Vec<S>, Vec<S>) {
    let problem = Problem::new(model, ws, smooth);
    let x = problem.solved(smooth.warm, None);
    let forces = times(&problem.mass, &problem.branches, &problem.beyond(&x));
    (x, forces)
}

/// How exact an acceleration is.
pub(crate) struct Certificate<S> {
    /// No less than the distance to the optimum: ‖x − x*‖_M ≤ √(gᵀ M⁻¹ g), as the cost less that of
    /// inertia is convex.
    pub(crate) error: S,
    /// ‖x₀‖_M of the acceleration without constraints.
    pub(crate) size: S,
}

/// The acceleration with constraints, of origins d²p/dt², its certificate, and how many steps of
/// Newton's method found it.
pub(crate) fn searched<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, smooth: &Smooth<'_, S>) -> (Vec<S>, Certificate<S>, S) {
    let problem = Problem::new(model, ws, smooth);
    let mut steps = S::zero();
    let x = problem.solved(smooth.warm, Some(&mut steps));
    let certificate = problem.certificate(&x);
    (x, certificate, steps)
}

/// The certificate of the acceleration `smooth.warm`.
pub(crate) fn certified<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, smooth: &Smooth<'_, S>) -> Certificate<S> {
    Problem::new(model, ws, smooth).certificate(smooth.warm)
}

/// Contacts of one dimension: those of one body with the world, or those of several pairs of bodies
/// that nearly the same columns move. They are rows of one table: generated code has each loop over
/// them once.
struct Group<S> {
    dimension: usize,
    /// The body that touches the world.
    body: Option<BodyId>,
    /// The columns that move one of the two bodies of a pair, by their places in
    /// [`Problem::columns`].
    columns: BTreeSet<usize>,
    /// The two bodies of each contact, of which the first may be the base.
    bodies: Vec<[BodyId; 2]>,
    /// A row of numbers for each contact.
    rows: Vec<S>,
    /// Positive where one of them acts.
    acts: S,
}

/// A pair joins a group of pairs if it has at least this part of the group's columns. Each row of J
/// has all columns of its group. A larger part makes more groups, and so more code.
const SHARED: [usize; 2] = [1, 2];

/// A motion of all joints.
struct Motion<'a, S> {
    x: &'a [S],
    /// The twists of all bodies about the origin.
    twists: Twists<S>,
}

struct Problem<'a, S: 'static> {
    model: &'a Model<S>,
    cone: Cone,
    /// The way to the base of each degree of freedom, in H.
    parents: Vec<usize>,
    /// The same while no two bodies touch.
    apart: Vec<usize>,
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
        let branches = ws.parent_dof.clone();
        let placed = Bodies::at(model, ws, smooth.q);
        let origin = motion::origin(model, &placed);
        let columns = motion::columns(&placed, origin);
        let constraints = &model.constraints;
        let mut problem = Self {
            model,
            cone: constraints.cone,
            parents: Vec::new(),
            apart: Vec::new(),
            branches,
            mass,
            start: smooth.a,
            columns,
            rows: constraints.joint_rows(smooth.q, smooth.v),
            groups: Vec::new(),
        };
        let twists = problem.motion(smooth.v).twists;
        let moving = Moving { model, placed: &placed, columns: &problem.columns, origin, twists: &twists };
        sums::rows(&constraints.sums, &placed, (smooth.q, smooth.v), &mut problem.rows);
        anchors::rows(&constraints.anchors, &moving, &mut problem.rows);
        let mut found = pairs::contacts(constraints, &placed, (origin, &twists), smooth.given);
        // Pairs of many columns begin groups.
        found.sort_by_key(|found| core::cmp::Reverse(problem.moving(found.bodies).len()));
        found.iter().for_each(|found| problem.add(found));
        for group in &mut problem.groups {
            group.acts = group.rows.chunks(contact::length(group.dimension)).fold(S::zero(), |sum, row| sum + row[0]);
        }
        problem.parents = problem.ways(true);
        problem.apart = problem.ways(false);
        problem
    }

    fn add(&mut self, found: &Found<S>) {
        let Found { bodies, dimension, ref rows, .. } = *found;
        let body = bodies[0].is_base().then_some(bodies[1]);
        let columns = if body.is_some() { BTreeSet::new() } else { self.moving(bodies) };
        let fits = |group: &Group<S>| {
            let is_part = columns.is_subset(&group.columns) && SHARED[1] * columns.len() >= SHARED[0] * group.columns.len();
            group.dimension == dimension && group.body == body && is_part
        };
        let at = self.groups.iter().position(fits).unwrap_or_else(|| {
            self.groups.push(Group { dimension, body, columns, bodies: Vec::new(), rows: Vec::new(), acts: S::zero() });
            self.groups.len() - 1
        });
        let count = rows.len() / contact::length(dimension);
        self.groups[at].bodies.extend(core::iter::repeat_n(bodies, count));
        self.groups[at].rows.extend_from_slice(rows);
    }

    /// By how much a column moves the second body and not the first: 1, −1 if it moves the first
    /// alone, and 0 if it moves both or none.
    fn moves(&self, column: &Column<S>, bodies: [BodyId; 2]) -> f64 {
        let [first, second] = bodies.map(|body| !body.is_base() && self.model.is_on_the_way(column.body, body));
        f64::from(u8::from(second)) - f64::from(u8::from(first))
    }

    /// The columns that move one of two bodies, by their places.
    fn moving(&self, bodies: [BodyId; 2]) -> BTreeSet<usize> {
        self.columns.iter().enumerate().filter(|(_, column)| self.moves(column, bodies) != 0.0).map(|(k, _)| k).collect()
    }

    /// The columns of a group.
    fn columns(&self, group: &Group<S>) -> Vec<&Column<S>> {
        group.columns.iter().map(|k| &self.columns[*k]).collect()
    }

    /// Entries of H, on and below its diagonal, to which contacts of two bodies add.
    fn entries(&self, group: &Group<S>) -> Vec<[usize; 2]> {
        let mut all = BTreeSet::new();
        for bodies in group.bodies.iter().collect::<BTreeSet<_>>() {
            let own: BTreeSet<usize> = self.moving(*bodies).iter().map(|k| self.columns[*k].at).collect();
            all.extend(own.iter().flat_map(|i| own.range(..=*i).map(|j| [*i, *j])));
        }
        all.into_iter().collect()
    }

    /// The way to the base of each degree of freedom in H: contacts of two bodies couple branches,
    /// and so do rows of several joints. `with_pairs`: with contacts of two bodies.
    /// A factorisation from the last row up leaves zeros off these ways.
    fn ways(&self, with_pairs: bool) -> Vec<usize> {
        let n = self.branches.len();
        let mut before: Vec<BTreeSet<usize>> = (0..n).map(|i| path_to_root(&self.branches, i).collect()).collect();
        let of_pairs = self.groups.iter().filter(|group| with_pairs && group.body.is_none()).flat_map(|group| self.entries(group));
        let of_row = |row: &JointRow<S>| {
            let own: Vec<usize> = row.entries.iter().map(|(k, _)| *k).collect();
            own.iter().flat_map(|i| own.iter().map(|j| [*i, *j])).collect::<Vec<_>>()
        };
        for [i, j] in of_pairs.chain(self.rows.iter().flat_map(of_row)) {
            if j < i {
                before[i].insert(j);
            }
        }
        let mut parents = vec![0; n];
        for i in (0..n).rev() {
            let mut own = core::mem::take(&mut before[i]);
            if let Some(parent) = own.pop_last() {
                parents[i] = parent + 1;
                before[parent].append(&mut own);
            }
        }
        parents
    }

    /// The motion of all bodies at these rates.
    fn motion<'b>(&self, x: &'b [S]) -> Motion<'b, S> {
        Motion { x, twists: motion::twists(self.model, &self.columns, x) }
    }

    /// Visits the contacts of a group that act: `visit(contact, rows, rates, state)` changes the
    /// state, behind which its results are; they are zeros for other contacts. `rates`: B V of N
    /// motions. `rows`: those of J, for each of [`Self::columns`]; none for contacts with the
    /// world.
    fn each<const N: usize>(
        &self,
        group: &Group<S>,
        motions: [&Motion<'_, S>; N],
        [carried, results]: [&mut [S]; 2],
        visit: impl Fn(&Contact<S>, &[Vec<S>], [Vec<S>; N], &mut [S]),
    ) {
        let length = contact::length(group.dimension);
        let columns = self.columns(group);
        let mut table = Vec::new();
        for (row, bodies) in group.rows.chunks(length).zip(&group.bodies) {
            table.extend_from_slice(row);
            table.extend(columns.iter().map(|column| S::from_f64(self.moves(column, *bodies))));
        }
        let turn = |row: &[S], state: &mut [S]| {
            let (row, moves) = row.split_at(length);
            let contact = Contact::of(row, group.dimension);
            if let Some(body) = group.body {
                return visit(&contact, &[], motions.map(|motion| contact.rates(&motion.twists[body])), state);
            }
            let of = |(column, moves): (&&Column<S>, &S)| contact.rates(&column.axis).iter().map(|rate| *moves * *rate).collect();
            let rows: Vec<Vec<S>> = columns.iter().zip(moves).map(of).collect();
            let rate = |x: &[S], k: usize| columns.iter().zip(&rows).fold(S::zero(), |sum, (column, row)| sum + row[k] * x[column.at]);
            let rates = motions.map(|motion| (0..group.dimension).map(|k| rate(motion.x, k)).collect());
            visit(&contact, &rows, rates, state);
        };
        let all = |carried: &mut [S], results: &mut [S]| {
            S::for_each(group.bodies.len(), &table, carried, results, |row, carried, results| {
                let mut state = [&*carried, &*results].concat();
                S::when(row[0].positive(), &mut state, |state| turn(row, state));
                let (before, after) = state.split_at(carried.len());
                carried.copy_from_slice(before);
                results.copy_from_slice(after);
            });
        };
        if group.bodies.len() < 2 {
            return all(carried, results);
        }
        // Most groups of a robot with many have none that acts.
        let mut state = [&*carried, &*results].concat();
        S::when(group.acts.positive(), &mut state, |state| {
            let (before, after) = state.split_at_mut(carried.len());
            all(before, after);
        });
        let (before, after) = state.split_at(carried.len());
        carried.copy_from_slice(before);
        results.copy_from_slice(after);
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
            let slope = |contact: &Contact<S>, rates: &[S]| contact.cost(self.cone, rates).slope;
            if let Some(body) = group.body {
                let mut sum = wrenches[body].to_array();
                self.each(group, [&motion], [&mut sum, &mut []], |contact, _, [rates], sum| {
                    let slope = slope(contact, &rates);
                    let wrench = contact.wrench(&slope[..group.dimension]).to_array();
                    sum.iter_mut().zip(wrench).for_each(|(sum, x)| *sum += x);
                });
                wrenches[body] = Wrench::from_array(sum);
                continue;
            }
            let columns = self.columns(group);
            let mut sums: Vec<S> = columns.iter().map(|_| S::zero()).collect();
            self.each(group, [&motion], [&mut sums, &mut []], |contact, rows, [rates], sums| {
                let slope = slope(contact, &rates);
                for (sum, row) in sums.iter_mut().zip(rows) {
                    *sum += row.iter().zip(slope).fold(S::zero(), |sum, (entry, slope)| sum + *entry * slope);
                }
            });
            columns.iter().zip(sums).for_each(|(column, sum)| forces[column.at] += sum);
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
            let Some(body) = group.body else {
                self.add_pairs(group, &motion, &mut hessian);
                continue;
            };
            let mut sum = [S::zero(); 21];
            self.each(group, [&motion], [&mut sum, &mut []], |contact, _, [rates], sum| {
                let cost = contact.cost(self.cone, &rates);
                sum.iter_mut().zip(contact.inertia(&cost.curvature)).for_each(|(sum, x)| *sum += x);
            });
            *inertias[body].get_or_insert(ArticulatedInertia::zero()) += of_triangle(&sum);
        }
        self.project(&mut inertias, &mut hessian);
        hessian
    }

    /// Adds Jᵀ s″ J of contacts of two bodies.
    fn add_pairs(&self, group: &Group<S>, motion: &Motion<'_, S>, hessian: &mut [S]) {
        let (n, d, entries, columns) = (self.start.len(), group.dimension, self.entries(group), self.columns(group));
        let mut state: Vec<S> = entries.iter().map(|[i, j]| hessian[i * n + j]).collect();
        self.each(group, [motion], [&mut state, &mut []], |contact, own, [rates], state| {
            let s = contact.cost(self.cone, &rates).curvature;
            let mut rows = vec![vec![S::zero(); n]; d];
            for (column, own) in columns.iter().zip(own) {
                rows.iter_mut().zip(own).for_each(|(row, entry)| row[column.at] += *entry);
            }
            let pushed = |k: usize, j: usize| (0..d).fold(S::zero(), |sum, l| sum + s[k][l] * rows[l][j]);
            let pushed: Vec<Vec<S>> = (0..d).map(|k| (0..n).map(|j| pushed(k, j)).collect()).collect();
            for ([i, j], entry) in entries.iter().zip(state) {
                *entry += (0..d).fold(S::zero(), |sum, k| sum + rows[k][*i] * pushed[k][*j]);
            }
        });
        entries.iter().zip(state).for_each(|([i, j], entry)| hessian[i * n + j] = entry);
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
            self.each(group, [&motion], [&mut state, &mut []], |contact, _, [rates], state| {
                state[0] += contact.cost(self.cone, &rates).value;
            });
        }
        state[0]
    }

    /// α where the slope along dx is zero, by Newton's method within bounds.
    fn line(&self, x: &[S], dx: &[S], slope: &[S]) -> S {
        let (zero, one, half) = (S::zero(), S::one(), S::from_f64(0.5));
        let (at, by) = (self.motion(x), self.motion(dx));
        let rows: Vec<[S; 2]> = self.rows.iter().map(|row| [row.along(x) - row.reference, row.along(dx)]).collect();
        let pushed = times(&self.mass, &self.branches, dx);
        let dot = |a: &[S], b: &[S]| a.iter().zip(b).fold(zero, |sum, (a, b)| sum + *a * *b);
        let smooth = [dot(&pushed, &self.beyond(x)), dot(&pushed, dx)];
        // Each contact along the line: those with the world together, if they have one dimension
        let mut tables: BTreeMap<(usize, Option<usize>), (Vec<S>, S)> = BTreeMap::new();
        for (number, group) in self.groups.iter().enumerate() {
            let d = group.dimension;
            let mut found = vec![zero; 2 * d * group.bodies.len()];
            self.each(group, [&at, &by], [&mut [], &mut found], |contact, _, [rates, along], state| {
                state[..d].copy_from_slice(&contact.beyond(&rates));
                state[d..].copy_from_slice(&along);
            });
            let (table, acts) = tables.entry((d, group.body.is_none().then_some(number))).or_insert((Vec::new(), zero));
            for (row, found) in group.rows.chunks(contact::length(d)).zip(found.chunks(2 * d)) {
                table.extend(row[..contact::of_law(d)].iter().chain(found));
            }
            *acts += group.acts;
        }
        let along = |alpha: S| {
            let [slope, curvature] = smooth;
            let mut state = [slope + alpha * curvature, curvature];
            for (row, [own, along]) in self.rows.iter().zip(&rows) {
                let cost = row.cost(*own + alpha * *along);
                state[0] += cost.slope * *along;
                state[1] += cost.curvature * *along * *along;
            }
            for ((d, _), (table, acts)) in &tables {
                let (d, law) = (*d, contact::of_law(*d));
                S::when(acts.positive(), &mut state, |state| {
                    S::for_each(table.len() / (law + 2 * d), table, state, &mut [], |row, state, _| {
                        S::when(row[0].positive(), state, |state| {
                            let [slope, curvature] = Law::of(row, d).along(self.cone, &row[law..][..d], &row[law + d..], alpha);
                            state[0] += slope;
                            state[1] += curvature;
                        });
                    });
                });
            }
            state
        };
        let first = dot(slope, dx);
        let (enough, still) = (S::from_f64(LINE) * first.abs(), of_precision(first.abs(), STILL));
        // α, and bounds below and above it; above is 0 where there is none yet.
        let mut state = [one, zero, zero];
        let _ = S::repeat(MOST_ON_A_LINE, &mut state, |state| {
            let [alpha, below, above] = [state[0], state[1], state[2]];
            let [slope, curvature] = along(alpha);
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

    /// Σ M x², with M's diagonal.
    fn size(&self, x: &[S]) -> S {
        let n = x.len();
        x.iter().enumerate().fold(S::zero(), |sum, (i, x)| sum + *x * *x * self.mass[i * n + i])
    }

    /// Σ g² / M, and the same of the sizes of its terms.
    fn squares(&self, (slope, size): &(Vec<S>, Vec<S>)) -> [S; 2] {
        let n = slope.len();
        let of = |x: &[S]| x.iter().enumerate().fold(S::zero(), |sum, (i, x)| sum + *x * *x / self.mass[i * n + i]);
        [of(slope), of(size)]
    }

    /// The x at which the cost is least, with derivatives. `steps`: how many steps were made.
    fn solved(&self, warm: &[S], steps: Option<&mut S>) -> Vec<S> {
        let mut x = self.start.to_vec();
        match steps {
            None => S::held(&mut x, |x| x.copy_from_slice(&self.minimum(warm, false))),
            Some(steps) => {
                x.push(S::zero());
                S::held(&mut x, |x| x.copy_from_slice(&self.minimum(warm, true)));
                *steps = x.pop().unwrap_or(S::zero());
            }
        }
        // δ = 0 solves g(x + δ, p) = 0. Its derivative is −H⁻¹ ∂g/∂p, that of x(p) by the implicit
        // function theorem. Each time x has derivatives of one more order.
        let mut hessian = vec![S::zero(); x.len() * x.len()];
        if S::orders() > 0 {
            S::held(&mut hessian, |hessian| hessian.copy_from_slice(&self.curvature(&x)));
        }
        for _ in 0..S::orders() {
            let mut correction = vec![S::zero(); x.len()];
            let residual = |_: &mut (), correction: &[S], r: &mut [S]| {
                let moved: Vec<S> = x.iter().zip(correction).map(|(x, own)| *x + *own).collect();
                r.copy_from_slice(&self.slope(&moved).0);
            };
            let inverse = |_: &mut (), b: &mut [S]| {
                let mut matrix = hessian.clone();
                factor(&mut matrix, &self.parents);
                solve(&matrix, &self.parents, b);
            };
            S::implicit(&mut (), &mut correction, |_, correction| correction.fill(S::zero()), residual, inverse);
            x.iter_mut().zip(correction).for_each(|(x, own)| *x += own);
        }
        x
    }

    /// H⁻¹ b in the place of b. Branches that no contact couples stay apart in the factors.
    fn solve(&self, hessian: &[S], b: &mut [S]) {
        let by = |parents: &[usize], b: &mut [S]| {
            let mut matrix = hessian.to_vec();
            factor(&mut matrix, parents);
            solve(&matrix, parents, b);
        };
        if self.apart == self.parents {
            return by(&self.parents, b);
        }
        let touch = self.groups.iter().filter(|group| group.body.is_none()).fold(S::zero(), |sum, group| sum + group.acts);
        S::when(touch.positive(), b, |b| by(&self.parents, b));
        S::when((S::one() - flag::<S>(touch.positive())).positive(), b, |b| by(&self.apart, b));
    }

    /// How far x is from the optimum.
    fn certificate(&self, x: &[S]) -> Certificate<S> {
        let mut matrix = self.mass.clone();
        factor(&mut matrix, &self.branches);
        let error = inverse_square(&matrix, &self.branches, &self.slope(x).0).sqrt();
        let pushed = times(&self.mass, &self.branches, self.start);
        let size = self.start.iter().zip(pushed).fold(S::zero(), |sum, (a, b)| sum + *a * b);
        Certificate { error, size: greater(size, S::zero()).sqrt() }
    }

    /// The x at which the cost is least. `counted`: behind it the number of steps.
    fn minimum(&self, warm: &[S], counted: bool) -> Vec<S> {
        let (nv, one) = (self.start.len(), S::one());
        let mut state = self.start.to_vec();
        if !warm.is_empty() {
            let is_better = (self.cost(self.start) - self.cost(warm)).positive();
            state.iter_mut().zip(warm).for_each(|(x, warm)| *x = S::select(is_better, *warm, *x));
        }
        if counted {
            state.push(S::zero());
        }
        // The last square of the gradient, −1: there is none; whether the last step was short.
        state.extend([-one, S::zero()]);
        let _converged = S::repeat(MOST, &mut state, |state| {
            let (moving, rest) = state.split_at_mut(nv + usize::from(counted));
            let [last, short] = rest else { return one.positive() };
            let (x, count) = moving.split_at_mut(nv);
            let slope = self.slope(x);
            let [square, size] = self.squares(&slope);
            let [settled, small] = [SETTLED, SMALL].map(|n| of_precision(size, n.map(|n| 2 * n)));
            // Also of zeros, and of what is no number
            let is_settled = one - flag::<S>((square - settled * size).positive());
            let is_small = flag::<S>((small * size - square).positive());
            let falls = S::select((-*last).positive(), one, flag::<S>((*last - square - square).positive()));
            let is_done = flag::<S>((is_settled + (is_small + *short) * (one - falls)).positive());
            *last = square;
            count.iter_mut().for_each(|count| *count += one - is_done);
            let mut moved = [&*x, &[*short]].concat();
            S::when((one - is_done).positive(), &mut moved, |moved| {
                let (x, short) = moved.split_at_mut(nv);
                let mut dx: Vec<S> = slope.0.iter().map(|g| -*g).collect();
                self.solve(&self.curvature(x), &mut dx);
                let alpha = self.line(x, &dx, &slope.0);
                let before = self.size(x);
                dx.iter_mut().for_each(|dx| *dx *= alpha);
                short[0] = flag::<S>((of_precision(before, SHORT.map(|n| 2 * n)) * before - self.size(&dx)).positive());
                x.iter_mut().zip(&dx).for_each(|(x, dx)| *x += *dx);
            });
            x.copy_from_slice(&moved[..nv]);
            *short = moved[nv];
            is_done.positive()
        });
        state.truncate(nv + usize::from(counted));
        state
    }

    /// x − x₀.
    fn beyond(&self, x: &[S]) -> Vec<S> {
        x.iter().zip(self.start).map(|(x, start)| *x - *start).collect()
    }
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

/// The inertia of an upper triangle, row by row.
fn of_triangle<S: Scalar>(k: &[S]) -> ArticulatedInertia<S> {
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
    use crate::constraint::{Bound, CONTACT, Constraints, DryFriction, Limit, Pair, Soft, contact_forces};
    use crate::description::{Base, Description, Inertial, Joint, JointKind, Link, LinkId, Origin};
    use crate::dual::Dual;
    use crate::scalar::two_to;
    use crate::spatial::Placement;

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

    #[test]
    fn a_bound_is_that_of_its_precision() {
        for x in [0.0, 1e-30, 7.0, 1e30] {
            assert_eq!((of_precision(x, STILL), of_precision(x as f32, STILL)), (two_to(STILL[0]), two_to(STILL[1]) as f32));
        }
    }

    fn solved(model: &Model<f64>, q: f64, v: f64, a: f64) -> f64 {
        let smooth = Smooth { q: &[q], v: &[v], a: &[a], warm: &[], given: &[] };
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
            given: 0,
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
        // Of dual numbers: da/dv = −d b
        for model in [&touching, &limited] {
            let (model, constant) = (model.map(Dual::constant), |x: f64| Dual::constant(x));
            let smooth = Smooth { q: &[constant(0.095)], v: &[Dual::variable(-1.0)], a: &[constant(-9.81)], warm: &[], given: &[] };
            let (found, _) = constrained(&model, &mut Workspace::new(&model), &smooth);
            assert!((found[0].slope + 0.9 * B).abs() < 1e-12 * B, "{:?}", found[0]);
        }
        // The force of the contact, and the certificate of another acceleration: with one mass it
        // is not less than √m times the distance, and not more than that with the stiffest row.
        let (q, v, a) = (0.095, -1.0, -9.81);
        let exact = solved(&touching, q, v, a);
        let mut ws = Workspace::new(&touching);
        let mut place = [0.0; CONTACT];
        contact_forces(&touching, &mut ws, (&[q], &[v], &[]), &[exact], &mut place);
        let expected = [1.0, 0.0, 0.0, 0.5 * (q - 0.1), 0.0, 0.0, 1.0, 0.0, 0.0, MASS * (exact - a), 0.0, 0.0, 0.0];
        assert!(place.iter().zip(expected).all(|(x, y)| (x - y).abs() < 1e-12 * y.abs().max(1.0)), "{place:?}");
        for moved in [0.0, 1e-3, -1e-3, 5.0, -200.0] {
            let smooth = Smooth { q: &[q], v: &[v], a: &[a], warm: &[exact + moved], given: &[] };
            let Certificate { error, size } = certified(&touching, &mut ws, &smooth);
            let distance = MASS.sqrt() * f64::abs(moved);
            assert!(error >= distance * (1.0 - 1e-12) && error < 10.1 * distance + 1e-11, "{moved}: {error} {distance}");
            assert!((size - MASS.sqrt() * a.abs()).abs() < 1e-12 * size);
        }
        let smooth = Smooth { q: &[q], v: &[v], a: &[a], warm: &[], given: &[] };
        let (found, Certificate { error, .. }, steps) = searched(&touching, &mut ws, &smooth);
        assert!(found[0] == exact && error < 1e-11 && (1.0..4.0).contains(&steps), "{found:?} {error} {steps}");
        // Not in contact
        contact_forces(&touching, &mut ws, (&[0.11], &[v], &[]), &[a], &mut place);
        assert_eq!(place, [0.0; CONTACT]);
        assert_eq!((solved(&touching, 0.11, -1.0, -9.81), solved(&limited, 0.11, -1.0, -9.81)), (-9.81, -9.81));
    }

    /// It holds what is weaker than it, and slows what is stronger.
    #[test]
    fn dry_friction_has_a_greatest_force() {
        let friction = DryFriction { v: 0, along: None, loss: 3.0, soft: soft(), weight: 1.0 / MASS };
        let model = ball(Constraints { friction: [friction].into(), ..Constraints::default() });
        assert!((solved(&model, 0.0, 0.0, 1.0) - 0.1).abs() < 1e-14);
        assert!((solved(&model, 0.0, 0.0, -8.0) - (-8.0 + 3.0 / MASS)).abs() < 1e-14);
        assert!((solved(&model, 0.0, 5.0, 8.0) - (8.0 - 3.0 / MASS)).abs() < 1e-14);
    }
}
