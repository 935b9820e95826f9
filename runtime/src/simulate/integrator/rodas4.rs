//! RODAS: a linearly implicit (Rosenbrock) method of six stages, order 4(3), L-stable.
//!
//! ```text
//! (1/(hγ) − J) k_i = f(t + α_i h, y + Σ a_ij k_j) + Σ c_ij k_j/h + h γ_i ∂f/∂t      y_1 = y + Σ a_6j k_j + k_6,  error k_6
//! ```
//!
//! Its factor for a decay e^{−xt}, R(−hx), is between 0 and 1 for every hx > 0: a decay never
//! changes its sign. Hairer & Wanner, *Solving Ordinary Differential Equations II*, 1996, §IV.7
//! (method, form without products by J), §VI.4 (RODAS: coefficients and curve of order 3).
//!
//! J is exact: derivatives of forward dynamics along ⊕, −½ ad(v) for joints that turn freely, and
//! those of the controller by differences. The first half of the equations is eliminated by hand,
//! so that the factorised matrix is `[nv][nv]`. Work and losses are integrated over the curve, by
//! Gauss with three nodes. Over a layer, in which a velocity decays faster than the step, the curve
//! does not resolve the motion, and they come from the change of energy.

use articulated_core::dynamics::Dynamics;
use articulated_core::nalgebra::{Matrix6, Vector6};

use super::lu::Lu;
use super::{Method, Start};
use crate::simulate::control::Dependence;
use crate::simulate::manifold::{Free, Manifold};
use crate::simulate::step_control::{Controller, Error, Norm};
use crate::simulate::system::System;
use crate::simulate::{Control, SimulateError};

const GAMMA: f64 = 0.25;

/// Nodes of the stages.
const NODES: [f64; 6] = [0.0, 0.386, 0.21, 0.63, 1.0, 1.0];

/// Weights of ∂f/∂t.
const TIME: [f64; 6] = [0.25, -0.1043, 0.1035, -0.0362, 0.0, 0.0];

const A: [&[f64]; 6] = [
    &[],
    &[1.544],
    &[0.946_678_528_081_582_6, 0.255_701_169_898_328_4],
    &[3.314_825_187_068_521, 2.896_124_015_972_201, 0.998_641_913_997_781_7],
    &[1.221_224_509_226_641, 6.019_134_481_288_629, 12.537_083_329_320_87, -0.687_886_036_105_895],
    &[1.221_224_509_226_641, 6.019_134_481_288_629, 12.537_083_329_320_87, -0.687_886_036_105_895, 1.0],
];

const C: [&[f64]; 6] = [
    &[],
    &[-5.6688],
    &[-2.430_093_356_833_875, -0.206_359_915_709_191_5],
    &[-0.107_352_905_815_137_5, -9.594_562_251_023_355, -20.470_286_148_096_16],
    &[7.496_443_313_967_647, -10.246_804_314_643_52, -33.999_903_528_199_05, 11.708_908_932_061_6],
    &[8.083_246_795_921_522, -7.981_132_988_064_893, -31.521_594_328_743_71, 16.319_305_431_231_36, -6.058_818_238_834_054],
];

/// The curve's combinations of stages.
const CURVE: [[f64; 5]; 2] = [
    [10.126_235_083_445_86, -7.487_995_877_610_167, -34.800_918_615_557_47, -7.992_771_707_568_823, 1.025_137_723_295_662],
    [-0.676_280_339_280_125_3, 6.087_714_651_680_015, 16.430_843_208_924_78, 24.767_225_114_183_86, -6.594_389_125_716_872],
];

pub(crate) struct Rodas4 {
    nv: usize,
    /// Stages, `[6][2 nv + 2]`.
    k: Vec<f64>,
    argument: Vec<f64>,
    f: Vec<f64>,
    /// ∂a/∂q, ∂a/∂v, M⁻¹, `[3][nv][nv]`, the controller's part included in the first two.
    derivatives: Vec<f64>,
    /// ∂τ/∂(q, v, t) column by column, `[2 nv + 1][nv]`.
    feedback: Vec<f64>,
    /// ∂a/∂t, `[nv]`.
    drift: Vec<f64>,
    /// (1/(hγ) − ∂u̇/∂u)⁻¹ of the joints that turn freely.
    inverses: Vec<Matrix6<f64>>,
    lu: Lu,
    curve: [Vec<f64>; 2],
    /// Powers at the three nodes of Gauss, for work and losses.
    powers: [[f64; 3]; 2],
    tau: [Vec<f64>; 2],
    q: Vec<f64>,
    /// Torques at the ends of a step over a layer, `[nv]` each.
    given: [Vec<f64>; 2],
    /// Time and number of steps at which the derivatives were taken.
    at: Option<(f64, u64)>,
}

impl Rodas4 {
    pub(super) fn new(manifold: &Manifold) -> Self {
        let nv = manifold.nv;
        let n = 2 * nv + 2;
        Self {
            nv,
            k: vec![0.0; 6 * n],
            argument: vec![0.0; n],
            f: vec![0.0; n],
            derivatives: vec![0.0; 3 * nv * nv],
            feedback: vec![0.0; (2 * nv + 1) * nv],
            drift: vec![0.0; nv],
            inverses: vec![Matrix6::identity(); manifold.free.len()],
            lu: Lu::new(nv),
            curve: [vec![0.0; n], vec![0.0; n]],
            powers: [[0.0; 3]; 2],
            tau: [vec![0.0; nv], vec![0.0; nv]],
            q: vec![0.0; manifold.nq],
            given: [vec![0.0; nv], vec![0.0; nv]],
            at: None,
        }
    }

    /// ∂f/∂y and ∂f/∂t at the start of a step.
    fn differentiate(&mut self, system: &mut System<'_>, control: &mut dyn Control, start: Start) -> Result<(), SimulateError> {
        let nv = self.nv;
        self.q.copy_from_slice(&system.origin);
        let (v, [tau, _]) = (&start.y[nv..2 * nv], &mut self.tau);
        system.command(control, start.t, &self.q, v, tau);
        system.robot.forward_dynamics_derivatives(&mut system.ws, &system.origin, v, tau, &mut self.derivatives)?;
        system.counts.derivatives += 1;
        self.drift.fill(0.0);
        let depends = if system.holds { Dependence::NOTHING } else { control.depends_on() };
        if depends.state || depends.time {
            self.feedback.fill(0.0);
            self.differentiate_control(system, control, start, depends)?;
            self.add_feedback();
        }
        Ok(())
    }

    /// Columns of ∂τ, by differences.
    fn differentiate_control(
        &mut self,
        system: &mut System<'_>,
        control: &mut dyn Control,
        start: Start,
        depends: Dependence,
    ) -> Result<(), SimulateError> {
        let nv = self.nv;
        let [base, moved] = &mut self.tau;
        let small = f64::EPSILON.sqrt();
        let y = &mut self.argument;
        y.copy_from_slice(start.y);
        for column in 0..if depends.state { 2 * nv } else { 0 } {
            let by = small * y[column].abs().max(1.0);
            y[column] += by;
            system.configuration(&y[..nv], &mut self.q)?;
            system.command(control, start.t, &self.q, &y[nv..2 * nv], moved);
            let out = &mut self.feedback[column * nv..(column + 1) * nv];
            out.iter_mut().zip(moved.iter().zip(base.iter())).for_each(|(out, (a, b))| *out = (a - b) / by);
            y[column] = start.y[column];
        }
        if depends.time {
            // A small part of the step, as far as such times are distinct; not across a jump, with
            // which the step ends.
            let later = start.t + (small * start.h).max(8.0 * (start.t.abs().next_up() - start.t.abs()));
            if later < system.kink {
                self.q.copy_from_slice(&system.origin);
                system.command(control, later, &self.q, &start.y[nv..2 * nv], moved);
                let (out, by) = (&mut self.feedback[2 * nv * nv..], later - start.t);
                out.iter_mut().zip(moved.iter().zip(base.iter())).for_each(|(out, (a, b))| *out = (a - b) / by);
            }
        }
        Ok(())
    }

    /// ∂a/∂x += M⁻¹ ∂τ/∂x.
    fn add_feedback(&mut self) {
        let nv = self.nv;
        let (first, inverse) = self.derivatives.split_at_mut(2 * nv * nv);
        let response =
            |row: usize, column: &[f64]| -> f64 { inverse[row * nv..(row + 1) * nv].iter().zip(column).map(|(m, t)| m * t).sum() };
        for (column, tau) in self.feedback.chunks_exact(nv.max(1)).enumerate() {
            for row in 0..nv {
                let part = response(row, tau);
                match column {
                    c if c < nv => first[row * nv + c] += part,
                    c if c < 2 * nv => first[nv * nv + row * nv + c - nv] += part,
                    _ => self.drift[row] = part,
                }
            }
        }
    }

    /// Factorises 1/(hγ) − ∂a/∂v − ∂a/∂q (1/(hγ) − ∂u̇/∂u)⁻¹.
    fn factorize(&mut self, system: &mut System<'_>, start: Start) -> Result<(), SimulateError> {
        let h = start.h;
        let (nv, g) = (self.nv, 1.0 / (h * GAMMA));
        let singular = SimulateError::Singular { t: start.t, step: h };
        for (free, inverse) in system.manifold.free.iter().zip(&mut self.inverses) {
            let matrix = Matrix6::identity() * g - Manifold::rates_derivative(free, &start.y[nv..2 * nv]);
            *inverse = matrix.try_inverse().ok_or_else(|| singular.clone())?;
        }
        for row in 0..nv {
            let (aq, av) = (&self.derivatives[row * nv..], &self.derivatives[(nv + row) * nv..]);
            let out = &mut self.lu.matrix[row * nv..(row + 1) * nv];
            for (j, out) in out.iter_mut().enumerate() {
                *out = -av[j] - aq[j] / g;
            }
            out[row] += g;
            for (free, inverse) in system.manifold.free.iter().zip(&self.inverses) {
                let (at, n) = (free.v, free.rates());
                for j in 0..n {
                    out[at + j] =
                        f64::from(u8::from(row == at + j)) * g - av[at + j] - (0..n).map(|i| aq[at + i] * inverse[(i, j)]).sum::<f64>();
                }
            }
        }
        system.counts.factorizations += 1;
        if self.lu.factorize() { Ok(()) } else { Err(singular) }
    }

    /// Where stage i is, and the rate there.
    fn begin_stage(&mut self, i: usize, system: &mut System<'_>, control: &mut dyn Control, start: Start) -> Result<(), SimulateError> {
        let nv = self.nv;
        for m in 0..2 * nv {
            self.argument[m] = start.y[m] + self.combine(A[i], m);
        }
        self.argument[2 * nv..].copy_from_slice(&start.y[2 * nv..]);
        if i == 0 {
            self.f.copy_from_slice(start.f);
            return Ok(());
        }
        system.rate(control, start.t + NODES[i] * start.h, &self.argument, &mut self.f)
    }

    /// (1/(hγ) − J) k_i = f + Σ c_ij k_j / h + h γ_i ∂f/∂t
    fn end_stage(&mut self, i: usize, free: &[Free], h: f64) {
        let (nv, n) = (self.nv, self.f.len());
        for m in 0..2 * nv {
            let drift = if m < nv { 0.0 } else { self.drift[m - nv] };
            self.k[i * n + m] = self.f[m] + self.combine(C[i], m) / h + h * TIME[i] * drift;
        }
        self.solve(free, i, h);
    }

    /// k ← (1/(hγ) − J)⁻¹ k of stage i.
    fn solve(&mut self, free: &[Free], i: usize, h: f64) {
        let (nv, n, g) = (self.nv, self.f.len(), 1.0 / (h * GAMMA));
        let (u, rest) = self.k[i * n..(i + 1) * n].split_at_mut(nv);
        let v = &mut rest[..nv];
        // (1/(hγ) − ∂a/∂v − ∂a/∂q G) k_v = r_v + ∂a/∂q G r_u, k_u = G (r_u + k_v)
        let carried = &mut self.argument[..nv];
        carried.copy_from_slice(u);
        apply(free, &self.inverses, g, carried);
        for (row, v) in v.iter_mut().enumerate() {
            *v += self.derivatives[row * nv..(row + 1) * nv].iter().zip(carried.iter()).map(|(a, u)| a * u).sum::<f64>();
        }
        self.lu.solve(v);
        u.iter_mut().zip(v.iter()).for_each(|(u, v)| *u += v);
        apply(free, &self.inverses, g, u);
    }

    /// Whether a step begins with a layer: a velocity that decays by its rates, as far as it does,
    /// with h·λ > 1, and whose acceleration at the start would carry it beyond its size at both
    /// ends.
    ///
    /// On a slow motion through stiff forces the derivative of the acceleration along the motion,
    /// ȧ = ∂a/∂q v + ∂a/∂v a + ∂a/∂t, is no larger than that of the slow motion: it is no layer.
    fn begins_with_layer(&self, start: Start, end: &[f64]) -> bool {
        let (nv, h) = (self.nv, start.h);
        let (v, a) = (&start.y[nv..2 * nv], &start.f[nv..2 * nv]);
        let dot = |row: &[f64], x: &[f64]| row.iter().zip(x).map(|(m, x)| m * x).sum::<f64>();
        (0..nv).any(|i| {
            let by_rates = dot(&self.derivatives[(nv + i) * nv..][..nv], a);
            let along = dot(&self.derivatives[i * nv..][..nv], v) + by_rates + self.drift[i];
            let decays = |change: f64| -h * change * a[i].signum() > a[i].abs();
            h * a[i].abs() > v[i].abs().max(end[nv + i].abs()) && decays(by_rates) && decays(along)
        })
    }

    /// Work and losses of a step over a layer, in J: by the change of energy. The work is that of
    /// the mean torque on the way, which is exact if the torque is linear in the way. `None` if the
    /// powers at the nodes agree.
    fn over_layer(
        &mut self,
        system: &mut System<'_>,
        control: &mut dyn Control,
        start: Start,
        end: &[f64],
        by_powers: [f64; 2],
    ) -> Result<Option<[f64; 2]>, SimulateError> {
        let nv = self.nv;
        let (Some(before), Some(after)) = (system.energy(start.y)?, system.energy(end)?) else { return Ok(None) };
        let change = after - before;
        let moved = change.abs() + start.y[2 * nv].abs() + start.y[2 * nv + 1].abs();
        if (change - by_powers[0] - by_powers[1]).abs() <= SAME_ENERGY * moved {
            return Ok(None);
        }
        if !system.has_losses {
            return Ok(Some([change, 0.0]));
        }
        let [first, last] = &mut self.given;
        system.motor_torques(control, start.t, start.y, first)?;
        system.motor_torques(control, start.t + start.h, end, last)?;
        let work = first.iter().zip(last.iter()).zip(&end[..nv]).map(|((a, b), u)| 0.5 * (a + b) * u).sum::<f64>();
        Ok(Some([work, change - work]))
    }

    fn combine(&self, a: &[f64], i: usize) -> f64 {
        let n = self.f.len();
        a.iter().enumerate().map(|(j, a)| a * self.k[j * n + i]).sum()
    }
}

/// x ← (1/(hγ) − ∂u̇/∂u)⁻¹ x.
fn apply(free: &[Free], inverses: &[Matrix6<f64>], g: f64, x: &mut [f64]) {
    let mut next = 0;
    for (free, inverse) in free.iter().zip(inverses) {
        x[next..free.v].iter_mut().for_each(|x| *x /= g);
        let n = free.rates();
        let part = &mut x[free.v..free.v + n];
        let mut six = Vector6::zeros();
        six.as_mut_slice()[..n].copy_from_slice(part);
        part.copy_from_slice(&(inverse * six).as_slice()[..n]);
        next = free.v + n;
    }
    x[next..].iter_mut().for_each(|x| *x /= g);
}

/// Two sums of energy count as equal if they differ by at most this part of the energy moved so
/// far.
const SAME_ENERGY: f64 = 1e-9;

/// Where the middle of the other two nodes of Gauss is, from ½.
const OUTER: f64 = 0.387_298_334_620_741_7;

impl Method for Rodas4 {
    fn reset(&mut self) {
        self.at = None;
    }

    fn step(
        &mut self,
        system: &mut System<'_>,
        control: &mut dyn Control,
        start: Start,
        end: &mut [f64],
        norm: &Norm,
    ) -> Result<Error, SimulateError> {
        let (nv, n) = (self.nv, self.f.len());
        // A step that is tried again has the same derivatives.
        let here = Some((start.t, system.counts.steps));
        if self.at != here {
            self.differentiate(system, control, start)?;
            self.at = here;
        }
        self.factorize(system, start)?;
        for i in 0..6 {
            self.begin_stage(i, system, control, start)?;
            if i == 5 {
                end.copy_from_slice(&self.argument);
            }
            self.end_stage(i, &system.manifold.free, start.h);
        }
        let last = &self.k[5 * n..5 * n + 2 * nv];
        end.iter_mut().zip(last).for_each(|(end, k)| *end += k);
        for (row, d) in CURVE.iter().enumerate() {
            for m in 0..2 * nv {
                self.curve[row][m] = self.combine(d, m);
            }
        }
        Ok(norm.of(|i| self.k[5 * n + i], end))
    }

    fn finish(&mut self, system: &mut System<'_>, control: &mut dyn Control, start: Start, end: &mut [f64]) -> Result<(), SimulateError> {
        if !system.follows_work {
            end[2 * self.nv..].copy_from_slice(&start.y[2 * self.nv..]);
            return Ok(());
        }
        let h = start.h;
        let mut y = std::mem::take(&mut self.argument);
        for (node, s) in [0.5 - OUTER, 0.5, 0.5 + OUTER].into_iter().enumerate() {
            Method::between(self, s, start, end, &mut y);
            let powers = system.power(control, start.t + s * h, &y)?;
            (self.powers[0][node], self.powers[1][node]) = (powers[0], powers[1]);
        }
        self.argument = y;
        let mut gained = self.powers.map(|p| h * (5.0 * (p[0] + p[2]) + 8.0 * p[1]) / 18.0);
        system.over_layer = false;
        if self.begins_with_layer(start, end)
            && let Some(right) = self.over_layer(system, control, start, end, gained)?
        {
            (gained, system.over_layer) = (right, true);
            self.powers = right.map(|energy| [energy / h; 3]);
        }
        for (k, gained) in gained.into_iter().enumerate() {
            end[2 * self.nv + k] = start.y[2 * self.nv + k] + gained;
        }
        Ok(())
    }

    fn prepare(&mut self, _: &mut System<'_>, _: &mut dyn Control, _: Start, _: &[f64]) -> Result<(), SimulateError> {
        Ok(())
    }

    fn between(&self, s: f64, start: Start, end: &[f64], out: &mut [f64]) {
        let h = start.h;
        let (nv, r) = (self.nv, 1.0 - s);
        let [first, second] = &self.curve;
        for i in 0..2 * nv {
            out[i] = r * start.y[i] + s * (end[i] + r * (first[i] + s * second[i]));
        }
        // The integral of the parabola through the powers.
        let x = s - 0.5;
        for (k, p) in self.powers.iter().enumerate() {
            let (slope, bend) = ((p[2] - p[0]) / (2.0 * OUTER), (p[2] - 2.0 * p[1] + p[0]) / (2.0 * OUTER * OUTER));
            out[2 * nv + k] = start.y[2 * nv + k] + h * (p[1] * s + slope * (x * x - 0.25) / 2.0 + bend * (x * x * x + 0.125) / 3.0);
        }
    }

    fn controller(&self) -> Option<Controller> {
        Some(Controller::new(4.0, 0.0, 0.2, 6.0))
    }
}

#[cfg(test)]
mod tests {
    use super::{A, C, GAMMA, TIME};

    /// The factor of one step of e^{zt}.
    fn factor(z: f64) -> f64 {
        let mut k = [0.0; 6];
        let sum = |row: &[f64], k: &[f64; 6]| row.iter().zip(k).map(|(a, k)| a * k).sum::<f64>();
        let mut y = 0.0;
        for i in 0..6 {
            y = 1.0 + sum(A[i], &k);
            k[i] = (z * y + sum(C[i], &k)) / (1.0 / GAMMA - z);
        }
        y + k[5]
    }

    #[test]
    fn no_decay_is_ever_turned_round() {
        for n in -400..1000 {
            let x = 10_f64.powf(f64::from(n) / 100.0);
            let r = factor(-x);
            assert!(r > 0.0 && r < 1.0, "R(−{x}) = {r}");
        }
        assert!(factor(-1e12) < 1e-10);
    }

    #[test]
    fn a_step_is_that_of_the_exponential_to_order_four() {
        for z in [-0.02, 0.02_f64] {
            assert!((factor(z) - z.exp()).abs() < 2.0 * z.abs().powi(5) / 120.0, "{z}");
        }
        assert_eq!(TIME[0], GAMMA);
    }
}
