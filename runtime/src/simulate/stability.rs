//! Whether a fixed step of an explicit integrator is stable here: the fastest pair of eigenvalues
//! of the motion's Jacobian, without the Jacobian.
//!
//! A vector z is driven by the Jacobian again and again, J z ≈ (f(y + εz) − f(y))/ε, until it lies
//! in the plane of the fastest motions; the last two of z, Jz, J²z then give the λ² = aλ + b of
//! that plane, real or complex (power iteration with a fit to a pair: Wilkinson, *The Algebraic
//! Eigenvalue Problem*, 1965, §9.3). z is kept from one check to the next, so that later checks
//! need two evaluations.

use super::integrator::{Method, roots};
use super::system::System;
use super::{Control, SimulateError};

/// Steps between two checks, and between checks without fast motion.
const EVERY: u64 = 16;
const SELDOM: u64 = 256;

/// |hλ| below which checks become rare.
const CALM: f64 = 0.5;

/// |hλ|, roughly, of fast motion in a step from which on a check is due.
pub(crate) const SUSPICIOUS: f64 = 0.6;

/// Growth tolerated in a step: eigenvalues are not known well enough to distinguish slight damping
/// from none.
const MAX_AMPLIFICATION: f64 = 1e-3;

/// Growth accepted in a step reported as stable: rounding.
const MIN_GROWTH: f64 = 1e-5;

/// Largest number of rounds of a check that begins anew, and of one that confirms.
const ROUNDS: usize = 40;

#[derive(Clone, Debug)]
pub(crate) struct Stability {
    z: [Vec<f64>; 3],
    at: Vec<f64>,
    fresh: bool,
    largest: f64,
    /// Steps to the next check, and its step.
    interval: u64,
    next: u64,
    wait: u64,
    /// |hλ| of the step that caused the last check.
    seen: f64,
}

/// Result of a check: λ² = aλ + b, and |λ|.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Pair {
    a: f64,
    b: f64,
    pub(crate) rate: f64,
}

impl Stability {
    pub(crate) fn new(n: usize) -> Self {
        Self {
            z: std::array::from_fn(|_| vec![0.0; n]),
            at: vec![0.0; n],
            fresh: true,
            largest: 0.0,
            interval: EVERY,
            next: 0,
            wait: 0,
            seen: 0.0,
        }
    }

    pub(crate) fn reset(&mut self) {
        (self.fresh, self.largest, self.wait, self.seen) = (true, 0.0, 0, 0.0);
        (self.interval, self.next) = (EVERY, 0);
    }

    /// The next look begins with everything.
    pub(crate) fn begin_anew(&mut self) {
        self.fresh = true;
    }

    /// Whether a check is due after this many steps, or the motion has jumped: the largest velocity
    /// is more than eight times its largest value so far.
    pub(crate) fn due(&mut self, steps: u64, v: &[f64]) -> bool {
        let size = v.iter().fold(0.0, |most: f64, v| if v.is_finite() { most.max(v.abs()) } else { f64::INFINITY });
        let jumped = size > 8.0 * self.largest && self.largest > 0.0;
        if size.is_finite() {
            self.largest = self.largest.max(size);
        }
        let due = jumped || steps >= self.next;
        if due {
            self.interval = if jumped { EVERY } else { self.interval };
            self.next = steps + self.interval;
        }
        due
    }

    /// Whether fast motion in a step, |hλ| roughly, requires a check; not twice in a row, unless it
    /// is much faster than at the last check.
    pub(crate) fn suspects(&mut self, steps: u64, seen: f64) -> bool {
        let look = seen > SUSPICIOUS && (steps >= self.wait || seen > 4.0 * self.seen);
        if look {
            (self.wait, self.seen) = (steps + EVERY, seen);
        }
        look
    }

    /// The longest stable step up to h and the rate that bounds it, if h itself is not stable at
    /// (t, y), where dy/dt = f.
    pub(crate) fn exceeded(
        &mut self,
        system: &mut System<'_>,
        control: &mut dyn Control,
        method: &dyn Method,
        (t, y, f): (f64, &[f64], &[f64]),
        h: f64,
    ) -> Result<Option<(f64, f64)>, SimulateError> {
        let rounds = if self.fresh { ROUNDS } else { 1 };
        let mut found = self.look(system, control, (t, y, f), rounds)?;
        if !self.fresh && found.is_some_and(|pair| !stable(method, pair, h)) {
            found = self.look(system, control, (t, y, f), ROUNDS)?;
        }
        self.fresh = false;
        let calm = found.is_some_and(|pair| h * pair.rate < CALM);
        self.interval = if calm { (2 * self.interval).min(SELDOM) } else { EVERY };
        let Some(pair) = found.filter(|pair| !stable(method, *pair, h)) else { return Ok(None) };
        // The first step beyond |hλ| = 1 that is not stable bounds the admissible ones. Even a step
        // with very little growth is not reported as admissible, since the number of steps is
        // unknown.
        let mut admissible = (1.0 / pair.rate).min(h);
        while admissible < h && excess(method, pair, 1.01 * admissible) <= MIN_GROWTH {
            admissible *= 1.01;
        }
        Ok(Some((admissible, pair.rate)))
    }

    fn look(
        &mut self,
        system: &mut System<'_>,
        control: &mut dyn Control,
        at: (f64, &[f64], &[f64]),
        rounds: usize,
    ) -> Result<Option<Pair>, SimulateError> {
        let n = 2 * system.nv();
        if n == 0 {
            return Ok(None);
        }
        self.begin(n);
        let mut before: Option<Pair> = None;
        for _ in 0..rounds {
            let size = norm(&self.z[0][..n]);
            if !(size > 0.0 && size.is_finite()) {
                return Ok(before);
            }
            self.z[0][..n].iter_mut().for_each(|z| *z /= size);
            self.drive(system, control, at, 0)?;
            self.drive(system, control, at, 1)?;
            let Some(pair) = fit(&self.z[0][..n], &self.z[1][..n], &self.z[2][..n]) else { return Ok(before) };
            let settled = before.is_some_and(|b| (b.rate - pair.rate).abs() <= 0.01 * pair.rate);
            before = Some(pair);
            // The next round begins with Jz: with J²z alone, pairs ±λ would never separate from
            // their initial mix.
            self.z.swap(0, 1);
            if settled {
                break;
            }
        }
        Ok(before)
    }

    /// The previous fast motion is checked again; small parts of all motions, in numbers without a
    /// pattern, admit newly fast ones.
    fn begin(&mut self, n: usize) {
        let size = norm(&self.z[0][..n]);
        let kept = if self.fresh || !(size > 0.0 && size.is_finite()) { 0.0 } else { 1.0 / size };
        let other = if kept > 0.0 { 1e-2 } else { 1.0 };
        for (i, z) in self.z[0][..n].iter_mut().enumerate() {
            *z = if kept > 0.0 { *z * kept } else { 0.0 } + other * (1.5 + (i as f64 * 2.399_963).sin());
        }
    }

    /// z_{k+1} = J z_k by a difference of rates, at the time t, the state y and its rate f.
    fn drive(
        &mut self,
        system: &mut System<'_>,
        control: &mut dyn Control,
        (t, y, f): (f64, &[f64], &[f64]),
        k: usize,
    ) -> Result<(), SimulateError> {
        let n = 2 * system.nv();
        let (from, to) = self.z.split_at_mut(k + 1);
        let (from, to) = (&from[k], &mut to[0]);
        let by = 1e-7 * (1.0 + norm(&y[..n])) / norm(&from[..n]).max(1e-300);
        self.at.copy_from_slice(y);
        self.at[..n].iter_mut().zip(from).for_each(|(y, z)| *y += by * z);
        system.rate(control, t, &self.at, to)?;
        system.counts.evaluations -= 1;
        system.counts.checks += 1;
        to[..n].iter_mut().zip(f).for_each(|(rate, f)| *rate = (*rate - f) / by);
        Ok(())
    }
}

fn stable(method: &dyn Method, pair: Pair, h: f64) -> bool {
    // Where |hλ| < 1 accuracy decides.
    h * pair.rate <= 1.0 || excess(method, pair, h) <= MAX_AMPLIFICATION
}

/// Relative growth of the pair in a step of length h beyond its own growth, at least −1.
fn excess(method: &dyn Method, pair: Pair, h: f64) -> f64 {
    let grows = roots(pair.a, pair.b).into_iter().map(|(re, _)| (h * re).exp()).fold(1.0, f64::max);
    method.amplification(pair.a, pair.b, h).map_or(-1.0, |r| r / grows - 1.0)
}

fn norm(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// Least squares w_2 = a w_1 + b w_0, or w_1 = a w_0 where the three are on a line.
fn fit(w0: &[f64], w1: &[f64], w2: &[f64]) -> Option<Pair> {
    let dot = |x: &[f64], y: &[f64]| x.iter().zip(y).map(|(x, y)| x * y).sum::<f64>();
    let (p, q, r) = (dot(w0, w0), dot(w0, w1), dot(w1, w1));
    let (s, t) = (dot(w0, w2), dot(w1, w2));
    let determinant = p * r - q * q;
    let (a, b) = if determinant > 1e-6 * p * r { ((p * t - q * s) / determinant, (r * s - q * t) / determinant) } else { (q / p, 0.0) };
    let rate = roots(a, b).into_iter().map(|(re, im)| re.hypot(im)).fold(0.0, f64::max);
    rate.is_finite().then_some(Pair { a, b, rate })
}

#[cfg(test)]
mod tests {
    use super::{EVERY, Stability, fit};

    #[test]
    fn a_look_is_due_now_and_then_and_where_the_motion_jumps() {
        let mut stability = Stability::new(2);
        assert!(stability.due(0, &[0.0, 0.0]));
        // A start from rest is no jump.
        assert_eq!([0.0, 1.0, -8.0, 8.0].map(|v| stability.due(1, &[v, 0.0])), [false; 4]);
        assert_eq!([-64.0, 513.0, 100.0].map(|v| stability.due(1, &[0.0, v])), [false, true, false]);
        // Infinite or NaN sizes are not kept.
        assert_eq!([f64::NAN, f64::INFINITY, 5000.0].map(|v| stability.due(1, &[v, 1.0])), [true; 3]);
        assert_eq!([EVERY, EVERY + 1, EVERY + 2, 3 * EVERY].map(|steps| stability.due(steps, &[1.0, 1.0])), [false, true, false, true]);
    }

    #[test]
    fn what_a_step_saw_is_not_looked_at_twice_in_a_row_unless_it_is_much_faster() {
        let mut stability = Stability::new(2);
        let seen = [(1, 0.5), (1, 0.7), (2, 0.7), (3, 2.7), (4, 2.9), (5, 2.9), (3 + EVERY, 2.9), (4 + EVERY, 2.9)];
        assert_eq!(seen.map(|(steps, seen)| stability.suspects(steps, seen)), [false, true, false, false, true, false, false, true]);
    }

    #[test]
    fn a_pair_is_found_real_or_complex() {
        // ü = a u̇ + b u, as a first-order system.
        for (a, b) in [(-3.0, -2.0), (-0.1, -9.0), (0.0, 4.0)] {
            let drive = |z: [f64; 2]| [z[1], b * z[0] + a * z[1]];
            let z = [0.3, -0.7];
            let pair = fit(&z, &drive(z), &drive(drive(z))).unwrap();
            assert!((pair.a - a).abs() < 1e-12 && (pair.b - b).abs() < 1e-12, "{pair:?}");
        }
        let line = fit(&[1.0, 0.0], &[-5.0, 0.0], &[25.0, 0.0]).unwrap();
        assert_eq!((line.a, line.b, line.rate), (-5.0, 0.0, 5.0));
    }
}
