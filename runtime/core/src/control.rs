//! Controllers of joints, as data in the order of a robot: as scenes contain them, and as
//! simulations use them.

use alloc::string::String;
use alloc::vec;
use alloc::vec::Vec;
use core::fmt;

use crate::scalar::Scalar;

/// A controller of the joints.
#[derive(Clone, Debug, PartialEq)]
pub enum Controller {
    /// No torque.
    None,
    /// The same torques all the time, `[nv]`.
    Torque(Vec<f64>),
    /// Torques over time, `[nv]` a row.
    Table(Series),
    /// τ = kp (target ⊖ q) + kd (target' − v) + torque.
    Pd {
        /// Where to.
        target: Aim,
        /// `[nv]`, N·m/rad or N/m.
        kp: Vec<f64>,
        /// `[nv]`, N·m·s/rad or N·s/m.
        kd: Vec<f64>,
        /// `[nv]`, N·m or N.
        torque: Vec<f64>,
    },
    /// Forces of actuators.
    Actuators(Actuators),
}

/// Actuators with their controls.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Actuators {
    /// The actuators.
    pub laws: Vec<ActuatorLaw>,
    /// The controls u, a number for each of them.
    pub controls: Signal,
    /// Bounds of their torque together on a degree of freedom: (number of the degree of freedom,
    /// [lower, upper]), N·m or N.
    pub bounds: Vec<(usize, [f64; 2])>,
    /// Joints that follow others, on which actuators act.
    pub followers: Vec<Follower>,
    /// Springs and dampers of tendons: they have no control, and no bound applies to them.
    pub passive: Vec<ActuatorLaw>,
}

/// Numbers that may change over time.
#[derive(Clone, Debug, PartialEq)]
pub enum Signal {
    /// They do not change.
    Still(Vec<f64>),
    /// One row a time.
    Moving(Series),
}

impl Default for Signal {
    fn default() -> Self {
        Self::Still(Vec::new())
    }
}

/// A force with an affine law on a sum of coordinates.
///
/// ```text
/// l = Σ gear · q,   l̇ = Σ gear · v
/// f = clamp((g₀ + g₁ l + g₂ l̇) clamp(u) + b₀ + b₁ l + b₂ l̇)
/// τ = gear f
/// ```
///
/// Of a ball joint, l counts the rotation vector log q in axes of the child.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ActuatorLaw {
    /// Its name.
    pub name: String,
    /// The joints that it drives.
    pub drives: Vec<Transmission>,
    /// g₀, g₁, g₂: force for each unit of control, of length, and of rate of length.
    pub gain: [f64; 3],
    /// b₀, b₁, b₂: force without control.
    pub bias: [f64; 3],
    /// Bounds of the control u.
    pub control_range: Option<[f64; 2]>,
    /// Bounds of the force f.
    pub force_range: Option<[f64; 2]>,
}

/// A joint with actuators that follows others: q = Σ multiplier · leader + offset. Each leader gets
/// the torque of these actuators, times the multiplier. The bounds of the leaders do not limit it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Follower {
    /// The actuators on it: the place in [`Actuators::laws`], and the gear.
    pub laws: Vec<(usize, f64)>,
    /// Bounds of their torque together, N·m or N.
    pub range: Option<[f64; 2]>,
    /// The leaders: the degree of freedom, and the multiplier.
    pub leaders: Vec<(usize, f64)>,
}

/// How an actuator drives a joint.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Transmission {
    /// The first coordinate of the joint.
    pub q: usize,
    /// Its first degree of freedom.
    pub v: usize,
    /// d(length)/d(coordinate), a number for each degree of freedom: one, or three of a ball joint.
    pub gear: Vec<f64>,
    /// Whether it gives no torque, only a part of the length: a [`Follower`] has the torque.
    pub has_no_torque: bool,
}

impl Transmission {
    /// Part of the length, and of its rate.
    fn length(&self, q: &[f64], v: &[f64]) -> (f64, f64) {
        let rate = |v: &[f64]| self.gear.iter().zip(v).map(|(gear, v)| gear * v).sum::<f64>();
        let rates = v.get(self.v..).map_or(0.0, rate);
        let length = match (self.gear.as_slice(), q.get(self.q..)) {
            (&[x, y, z], Some(&[qx, qy, qz, qw, ..])) => {
                let way = rotation_vector([qx, qy, qz, qw]);
                x * way[0] + y * way[1] + z * way[2]
            }
            (_, Some(q)) => rate(q),
            _ => 0.0,
        };
        (length, rates)
    }
}

/// The rotation vector of a unit quaternion (x, y, z, w), rad, of norm π at most.
fn rotation_vector([x, y, z, w]: [f64; 4]) -> [f64; 3] {
    let sine = Scalar::sqrt(x * x + y * y + z * z);
    if sine == 0.0 {
        return [0.0; 3];
    }
    let sign = if w < 0.0 { -1.0 } else { 1.0 };
    let turns = sign * 2.0 * Scalar::atan2(sine, w.abs()) / sine;
    [x * turns, y * turns, z * turns]
}

impl ActuatorLaw {
    /// Its force f at a control, N or N·m at the actuator.
    pub fn force(&self, control: f64, q: &[f64], v: &[f64]) -> f64 {
        let parts = self.drives.iter().map(|drive| drive.length(q, v));
        let (length, rate) = parts.fold((0.0, 0.0), |(l, r), (length, rate)| (l + length, r + rate));
        let affine = |[at_rest, of_length, of_rate]: [f64; 3]| at_rest + of_length * length + of_rate * rate;
        clamp(affine(self.gain) * clamp(control, self.control_range) + affine(self.bias), self.force_range)
    }

    /// τ += gear · f.
    fn add_torque(&self, control: f64, q: &[f64], v: &[f64], tau: &mut [f64]) {
        let force = self.force(control, q, v);
        for drive in self.drives.iter().filter(|drive| !drive.has_no_torque) {
            tau.iter_mut().skip(drive.v).zip(&drive.gear).for_each(|(tau, gear)| *tau += gear * force);
        }
    }
}

/// The nearest number within the range.
fn clamp(x: f64, range: Option<[f64; 2]>) -> f64 {
    range.map_or(x, |[lower, upper]| x.max(lower).min(upper))
}

impl Actuators {
    /// Adds their torques to `tau` `[nv]`, N·m or N, which is zero on entry. Actuators without a
    /// control have u = 0.
    pub fn add_torques(&self, controls: &[f64], q: &[f64], v: &[f64], tau: &mut [f64]) {
        let control = |k: usize| controls.get(k).copied().unwrap_or(0.0);
        self.laws.iter().enumerate().for_each(|(k, law)| law.add_torque(control(k), q, v, tau));
        for (k, range) in &self.bounds {
            if let Some(tau) = tau.get_mut(*k) {
                *tau = clamp(*tau, Some(*range));
            }
        }
        for follower in &self.followers {
            let laws = follower.laws.iter().filter_map(|(k, gear)| Some((self.laws.get(*k)?, *k, gear)));
            let torque = laws.map(|(law, k, gear)| gear * law.force(control(k), q, v)).sum();
            let torque = clamp(torque, follower.range);
            for (k, multiplier) in &follower.leaders {
                tau.iter_mut().skip(*k).take(1).for_each(|tau| *tau += multiplier * torque);
            }
        }
        self.passive.iter().for_each(|law| law.add_torque(0.0, q, v, tau));
    }

    /// Whether a torque depends on q or v.
    pub fn depend_on_state(&self) -> bool {
        let depends = |[_, of_length, of_rate]: [f64; 3]| of_length != 0.0 || of_rate != 0.0;
        self.laws.iter().chain(&self.passive).any(|law| depends(law.gain) || depends(law.bias))
    }
}

/// The target of a controller.
#[derive(Clone, Debug, PartialEq)]
pub enum Aim {
    /// Coordinates that do not change, `[nq]`.
    Still(Vec<f64>),
    /// Coordinates over time, `[nq]` a row.
    Moving(Series),
}

/// Numbers over time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Series {
    /// Times in order, s.
    pub times: Vec<f64>,
    /// One row a time, each as long as q or v; quaternions have norm one.
    pub rows: Vec<Vec<f64>>,
    /// The numbers between two rows.
    pub between: Interpolation,
}

/// The numbers between two rows of a table.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Interpolation {
    /// Linear.
    #[default]
    Linear,
    /// Each row holds until the next.
    Hold,
    /// A cubic spline with two continuous derivatives, and rates of zero at its ends:
    /// [`Interpolation::cubic`] makes it. The rates at the rows, each as long as a row.
    Cubic(Vec<Vec<f64>>),
}

impl Interpolation {
    /// The cubic spline of a table without [`Series::problems`]; linear for other tables.
    ///
    /// ```text
    /// m₀ = mₙ = 0,   mᵢ₋₁/hᵢ₋₁ + 2 mᵢ (1/hᵢ₋₁ + 1/hᵢ) + mᵢ₊₁/hᵢ = 3 (δᵢ₋₁/hᵢ₋₁ + δᵢ/hᵢ)
    /// ```
    ///
    /// hᵢ: time from row i to the next; δᵢ: mean rate there; mᵢ: rate at row i.
    pub fn cubic(times: &[f64], rows: &[Vec<f64>]) -> Self {
        let (n, width) = (times.len(), rows.first().map_or(0, Vec::len));
        if n == 0 || rows.len() != n || rows.iter().any(|row| row.len() != width) {
            return Self::Linear;
        }
        let h = |i: usize| times[i + 1] - times[i];
        let mut slopes = vec![vec![0.0; width]; n];
        // Gaussian elimination of a symmetric matrix of three diagonals, with dominant pivots.
        let mut pivots = vec![1.0; n];
        for i in 1..n.saturating_sub(1) {
            let below = if i > 1 { 1.0 / h(i - 1) / pivots[i - 1] } else { 0.0 };
            pivots[i] = 2.0 / h(i - 1) + 2.0 / h(i) - below / h(i - 1);
            for k in 0..width {
                let mean = |i: usize| (rows[i + 1][k] - rows[i][k]) / h(i);
                slopes[i][k] = 3.0 * (mean(i - 1) / h(i - 1) + mean(i) / h(i)) - below * slopes[i - 1][k];
            }
        }
        for i in (1..n.saturating_sub(1)).rev() {
            let (head, tail) = slopes.split_at_mut(i + 1);
            head[i].iter_mut().zip(&tail[0]).for_each(|(slope, next)| *slope = (*slope - next / h(i)) / pivots[i]);
        }
        Self::Cubic(slopes)
    }
}

impl Series {
    /// The numbers at the time `t`, each by itself (between two rows, a quaternion is not a unit
    /// one). Before the first row and after the last, those of the nearest row.
    pub fn at(&self, t: f64, out: &mut [f64]) {
        if let Some(piece) = self.piece(t) {
            out.iter_mut().enumerate().for_each(|(k, out)| *out = piece.at(k)[0]);
        } else if let Some(([since, span], [from, to])) = self.between(t) {
            let part = since / span;
            out.iter_mut().zip(from.iter().zip(to)).for_each(|(out, (a, b))| *out = a + part * (b - a));
        } else if let Some(row) = self.rows.get(self.after(t).saturating_sub(1)) {
            out.iter_mut().zip(row).for_each(|(out, x)| *out = *x);
        }
    }

    /// If `t` is between two rows with linear interpolation: the time since the first, and the time
    /// between them, s; and both rows.
    pub fn between(&self, t: f64) -> Option<([f64; 2], [&[f64]; 2])> {
        let next = self.after(t);
        let before = next.checked_sub(1).filter(|_| self.between == Interpolation::Linear)?;
        let begin = self.times[before];
        Some(([t - begin, self.times.get(next)? - begin], [self.rows.get(before)?, self.rows.get(next)?]))
    }

    /// The rates at the time `t` of a cubic spline; false for other tables.
    pub fn rates(&self, t: f64, out: &mut [f64]) -> bool {
        match self.piece(t) {
            Some(piece) => out.iter_mut().enumerate().for_each(|(k, out)| *out = piece.at(k)[1]),
            None => out.fill(0.0),
        }
        matches!(self.between, Interpolation::Cubic(_))
    }

    /// The piece of a cubic spline around `t`; `None` outside of the table, and for other tables.
    fn piece(&self, t: f64) -> Option<Piece<'_>> {
        let Interpolation::Cubic(slopes) = &self.between else { return None };
        let next = self.after(t);
        let before = next.checked_sub(1)?;
        let (begin, end) = (self.times[before], self.times.get(next)?);
        let (rows, slopes) = ([self.rows.get(before)?, self.rows.get(next)?], [slopes.get(before)?, slopes.get(next)?]);
        Some(Piece { part: (t - begin) / (end - begin), span: end - begin, rows, slopes })
    }

    /// The first of the times after `t` at which the numbers or their first two derivatives jump,
    /// s: infinite after the last. A cubic spline has its ends alone.
    pub fn next(&self, t: f64) -> f64 {
        let next = self.after(t);
        let next = match self.between {
            Interpolation::Cubic(_) if next > 0 && next < self.times.len() => self.times.len() - 1,
            _ => next,
        };
        self.times.get(next).copied().unwrap_or(f64::INFINITY)
    }

    fn after(&self, t: f64) -> usize {
        self.times.partition_point(|x| *x <= t)
    }

    /// All errors of it as a table with rows of `width` numbers.
    pub fn problems(&self, width: usize) -> Vec<TableError> {
        let (Self { times, rows, .. }, mut wrong) = (self, Vec::new());
        if times.is_empty() {
            wrong.push(TableError::Empty);
        }
        if rows.len() != times.len() {
            wrong.push(TableError::Rows { found: rows.len(), expected: times.len() });
        }
        let other = rows.iter().enumerate().filter(|(_, row)| row.len() != width);
        wrong.extend(other.map(|(row, x)| TableError::Width { row, found: x.len(), expected: width }));
        let row = |k: usize| rows.get(k).map_or(&[][..], Vec::as_slice);
        let bad = (0..times.len()).filter(|&k| !times[k].is_finite() || row(k).iter().any(|x| !x.is_finite()));
        wrong.extend(bad.map(|row| TableError::NotFinite { row }));
        let order = times.windows(2).enumerate().filter(|(_, w)| w[1] <= w[0]);
        wrong.extend(order.map(|(k, w)| TableError::Order { row: k + 1, found: w[1], before: w[0] }));
        wrong
    }
}

/// A cubic polynomial between two rows, by their numbers and their rates.
struct Piece<'a> {
    /// From 0 to 1.
    part: f64,
    /// The time between the rows, s.
    span: f64,
    rows: [&'a Vec<f64>; 2],
    slopes: [&'a Vec<f64>; 2],
}

impl Piece<'_> {
    /// Number `k` and its rate.
    fn at(&self, k: usize) -> [f64; 2] {
        let of = |list: &[f64]| list.get(k).copied().unwrap_or(0.0);
        let (s, h) = (self.part, self.span);
        let ([a, b], [m, n]) = (self.rows.map(|row| of(row)), self.slopes.map(|row| of(row)));
        // x = a + s (h m + s (c + s d))
        let (c, d) = (3.0 * (b - a) - h * (2.0 * m + n), h * (m + n) - 2.0 * (b - a));
        [a + s * (h * m + s * (c + s * d)), m + s * (2.0 * c + 3.0 * s * d) / h]
    }
}

/// An error of a table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TableError {
    /// It has no row.
    Empty,
    /// The numbers of rows and times differ.
    Rows {
        /// How many rows there are.
        found: usize,
        /// How many times.
        expected: usize,
    },
    /// A row has the wrong length.
    Width {
        /// Which row, from 0.
        row: usize,
        /// How many numbers it has.
        found: usize,
        /// How many it should have.
        expected: usize,
    },
    /// A number is not finite.
    NotFinite {
        /// In which row, from 0.
        row: usize,
    },
    /// A time is not later than the one before.
    Order {
        /// In which row, from 0.
        row: usize,
        /// The time, s.
        found: f64,
        /// The time before, s.
        before: f64,
    },
}

impl fmt::Display for TableError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Empty => f.write_str("the table has no row"),
            Self::Rows { found, expected } => write!(f, "rows of the table: found {found}, expected {expected}, one for each time"),
            Self::Width { row, found, expected } => write!(f, "row {row} of the table has {found} numbers, expected {expected}"),
            Self::NotFinite { row } => write!(f, "row {row} of the table has a number that is not finite"),
            Self::Order { row, found, before } => write!(f, "row {row} of the table: t = {found} s is not after {before} s"),
        }
    }
}

impl core::error::Error for TableError {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_linear_between_rows_or_held_and_hold_at_the_ends() {
        let between = |hold| if hold { Interpolation::Hold } else { Interpolation::Linear };
        let series = |hold| Series { times: vec![0.0, 1.0, 3.0], rows: vec![vec![1.0], vec![3.0], vec![-1.0]], between: between(hold) };
        let at = |hold, t| {
            let mut out = [f64::NAN];
            series(hold).at(t, &mut out);
            out[0]
        };
        assert_eq!([-1.0, 0.0, 0.5, 1.0, 2.0, 3.0, 9.0].map(|t| at(false, t)), [1.0, 1.0, 2.0, 3.0, 1.0, -1.0, -1.0]);
        assert_eq!([-1.0, 0.5, 1.0, 2.9, 3.0, 9.0].map(|t| at(true, t)), [1.0, 1.0, 3.0, 3.0, -1.0, -1.0]);
    }

    #[test]
    fn an_actuator_follows_its_affine_law_within_its_bounds() {
        let drive = |k, gear: f64| Transmission { q: k, v: k, gear: vec![gear], ..Transmission::default() };
        let servo = ActuatorLaw {
            name: "servo".into(),
            drives: vec![drive(0, 2.0), drive(1, -1.0)],
            gain: [10.0, 1.0, 0.5],
            bias: [1.0, -10.0, -2.0],
            control_range: Some([-1.0, 1.0]),
            force_range: Some([-15.0, 15.0]),
        };
        // Length 2 · 0.5 − 0.25 = 0.75, rate 2 · 1 − 3 = −1.
        let (q, v) = ([0.5, 0.25], [1.0, 3.0]);
        let plain = ActuatorLaw { control_range: None, force_range: None, ..servo.clone() };
        assert_eq!(plain.force(2.0, &q, &v), (10.0 + 0.75 - 0.5) * 2.0 + 1.0 - 7.5 + 2.0);
        assert_eq!(servo.force(2.0, &q, &v), 10.25 - 4.5);
        assert_eq!(servo.force(-2.0, &q, &v), -10.25 - 4.5);
        assert_eq!(ActuatorLaw { bias: [-9.0, 0.0, 0.0], ..servo.clone() }.force(-1.0, &q, &v), -15.0);
        let spring = ActuatorLaw { drives: vec![drive(1, 1.0)], bias: [0.0, -4.0, 0.0], ..ActuatorLaw::default() };
        let mut all = Actuators { laws: vec![servo], passive: vec![spring], bounds: vec![(1, [-1.0, 2.0])], ..Actuators::default() };
        let mut tau = [0.0; 2];
        all.add_torques(&[2.0], &q, &v, &mut tau);
        // The bound is of the servo alone: −5.75 becomes −1.
        assert_eq!(tau, [2.0 * 5.75, -1.0 - 1.0]);
        // A joint that follows the first, x = 3 q₀, has the servo too: its torque is bounded by
        // itself.
        all.laws[0].drives[0].has_no_torque = true;
        all.followers = vec![Follower { laws: vec![(0, 2.0)], range: Some([-4.0, 7.0]), leaders: vec![(0, 3.0)] }];
        let mut tau = [0.0; 2];
        all.add_torques(&[2.0], &q, &v, &mut tau);
        assert_eq!(tau, [3.0 * 7.0, -1.0 - 1.0]);
        assert!(all.depend_on_state());
        (all.laws[0].gain, all.laws[0].bias) = ([1.0, 0.0, 0.0], [0.0; 3]);
        assert!(all.depend_on_state());
        all.passive.clear();
        assert!(!all.depend_on_state());
    }

    #[test]
    fn an_actuator_of_a_ball_joint_pulls_along_the_rotation_vector() {
        let axis = [0.6, 0.0, 0.8];
        let drive = Transmission { q: 1, v: 1, gear: vec![1.0, 2.0, 3.0], ..Transmission::default() };
        let law = ActuatorLaw { drives: vec![drive], bias: [0.0, 1.0, 0.0], ..ActuatorLaw::default() };
        for angle in [0.0, 1e-9, 0.3, 2.5, -2.5] {
            for sign in [1.0, -1.0] {
                let (sine, cosine): (f64, f64) = (angle / 2.0_f64).sin_cos();
                let q = [9.0, sign * axis[0] * sine, 0.0, sign * axis[2] * sine, sign * cosine];
                let length = law.force(0.0, &q, &[0.0; 4]);
                assert!((length - 3.0 * angle).abs() <= 1e-15 * (1.0 + angle.abs()) * 8.0, "{angle}: {length}");
            }
        }
    }

    #[test]
    fn a_row_of_another_length_is_named() {
        let series = Series { times: vec![0.0, 1.0], rows: vec![vec![1.0], vec![]], between: Interpolation::Linear };
        assert_eq!(series.problems(1), [TableError::Width { row: 1, found: 0, expected: 1 }]);
    }

    /// The table, zero rates at its ends, two continuous derivatives, and a cubic in between.
    #[test]
    fn a_cubic_spline_goes_through_its_rows_without_kinks() {
        let times = vec![0.0, 0.5, 1.5, 1.75, 3.0];
        let rows: Vec<Vec<f64>> = [[1.0, 0.0], [3.0, 1.0], [-1.0, 0.5], [0.0, 0.5], [2.0, -2.0]].map(|row| row.to_vec()).into();
        let series = Series { between: Interpolation::cubic(&times, &rows), times, rows };
        let at = |t: f64| {
            let (mut x, mut rate) = ([f64::NAN; 2], [f64::NAN; 2]);
            series.at(t, &mut x);
            assert!(series.rates(t, &mut rate));
            (x, rate)
        };
        for (t, row) in series.times.iter().zip(&series.rows) {
            assert_eq!(at(*t).0.as_slice(), row.as_slice());
        }
        assert!([0.0, 3.0, -1.0, 9.0].iter().all(|t| at(*t).1 == [0.0; 2]));
        assert_eq!((at(-1.0).0, at(9.0).0), ([1.0, 0.0], [2.0, -2.0]));
        let h = 1e-5;
        for t in [0.1, 0.5, 1.0, 1.5, 1.75, 2.9] {
            for k in 0..2 {
                let difference = (at(t + h).0[k] - at(t - h).0[k]) / (2.0 * h);
                assert!((difference - at(t).1[k]).abs() < 1e-7, "{t} {k}");
                // The second derivative from either side.
                let [left, right] = [-h, h].map(|h| (at(t + h).1[k] - at(t).1[k]) / h);
                assert!((left - right).abs() < 1e-2, "{t} {k}: {left} {right}");
            }
        }
        assert_eq!([-1.0, 0.0, 0.7, 2.0, 3.0].map(|t| series.next(t)), [0.0, 3.0, 3.0, 3.0, f64::INFINITY]);
        // A clamped cubic is its own spline: t² (3 − 2 t) on [0, 1].
        let times = vec![0.0, 0.3, 0.8, 1.0];
        let rows: Vec<Vec<f64>> = times.iter().map(|t| vec![t * t * (3.0 - 2.0 * t)]).collect();
        let series = Series { between: Interpolation::cubic(&times, &rows), times, rows };
        for k in 0..=20 {
            let (t, mut x) = (f64::from(k) / 20.0, [0.0]);
            series.at(t, &mut x);
            assert!((x[0] - t * t * (3.0 - 2.0 * t)).abs() < 1e-15);
        }
        assert_eq!(Interpolation::cubic(&[], &[]), Interpolation::Linear);
    }

    #[test]
    fn a_table_that_cannot_be_followed_says_why() {
        let problems = |times: &[f64], rows: &[f64]| {
            Series { times: times.to_vec(), rows: rows.iter().map(|x| vec![*x]).collect(), between: Interpolation::Hold }.problems(1)
        };
        assert_eq!(problems(&[0.0, 1.0], &[1.0, 2.0]), []);
        assert_eq!(problems(&[], &[]), [TableError::Empty]);
        assert_eq!(problems(&[0.0, 1.0], &[1.0]), [TableError::Rows { found: 1, expected: 2 }]);
        assert_eq!(problems(&[0.0], &[1.0, 2.0]), [TableError::Rows { found: 2, expected: 1 }]);
        assert_eq!(problems(&[0.0, f64::INFINITY], &[1.0, 2.0]), [TableError::NotFinite { row: 1 }]);
        assert_eq!(problems(&[0.0, 1.0], &[f64::NAN, 2.0]), [TableError::NotFinite { row: 0 }]);
        for found in [1.0, 0.5] {
            assert_eq!(problems(&[0.0, 1.0, found], &[1.0; 3]), [TableError::Order { row: 2, found, before: 1.0 }]);
        }
    }
}
