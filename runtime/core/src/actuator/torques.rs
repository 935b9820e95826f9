//! Torques of actuators, and their slopes in the rates.

use alloc::vec;

use super::{ActuatorLaw, Actuators, FrameRow, Transmission};
use crate::Scalar;
use crate::joint::Follow;
use crate::spatial::screw::Quaternion;

/// The nearest number within the range.
pub(super) fn clamp<S: Scalar>(x: S, range: Option<[S; 2]>) -> S {
    range.map_or(x, |[lower, upper]| {
        let x = S::select((x - lower).positive(), x, lower);
        S::select((upper - x).positive(), x, upper)
    })
}

/// `value` inside of the range, zero at its bounds and beyond.
fn within<S: Scalar>(x: S, range: Option<[S; 2]>, value: S) -> S {
    range.map_or(value, |[lower, upper]| {
        let above = S::select((x - lower).positive(), value, S::zero());
        S::select((upper - x).positive(), above, S::zero())
    })
}

impl<S: Scalar> Transmission<S> {
    /// Part of the length, and of its rate.
    fn length(&self, q: &[S], v: &[S]) -> (S, S) {
        let sum = |x: &[S]| self.gear.iter().zip(x).fold(S::zero(), |sum, (gear, x)| sum + *gear * *x);
        let rates = v.get(self.v..).map_or(S::zero(), sum);
        let length = match (self.gear.len(), q.get(self.q..)) {
            // The rotation vector in axes of the child, rad, of norm π at most
            (3, Some(&[x, y, z, w, ..])) => sum(Quaternion::from_array([x, y, z, w]).log().as_slice()),
            (_, Some(q)) => match self.law() {
                Some(law) => q.first().map_or(S::zero(), |q| law.value(*q)),
                None => sum(q),
            },
            _ => S::zero(),
        };
        match self.law() {
            Some(_) => (length, self.row(q).fold(S::zero(), |sum, (k, slope)| v.get(k).map_or(sum, |v| sum + slope * *v))),
            None => (length, rates),
        }
    }

    /// The part of the length as a polynomial of the coordinate; `None`: it is linear.
    fn law(&self) -> Option<Follow<S>> {
        self.higher.zip(self.gear.first()).map(|(higher, gear)| Follow { multiplier: *gear, offset: S::zero(), higher: Some(higher) })
    }

    /// The torque of a force of one at q: its entries, each with its degree of freedom.
    fn row(&self, q: &[S]) -> impl Iterator<Item = (usize, S)> + Clone + '_ {
        let slope = self.law().and_then(|law| q.get(self.q).map(|q| law.slope(*q)));
        self.gear.iter().enumerate().map(move |(k, gear)| (self.v + k, slope.unwrap_or(*gear)))
    }
}

impl<S: Scalar> ActuatorLaw<S> {
    /// Its force f with the input w of its gain, N or N·m at the actuator.
    pub fn force(&self, input: S, q: &[S], v: &[S]) -> S {
        let (length, rate) = self.length(q, v);
        self.bounded(input, length, rate)
    }

    /// The force at a length and a rate.
    pub(super) fn bounded(&self, input: S, length: S, rate: S) -> S {
        clamp(self.unbounded(input, length, rate), self.force_range)
    }

    fn unbounded(&self, input: S, length: S, rate: S) -> S {
        let affine = |[at_rest, of_length, of_rate]: [S; 3]| at_rest + of_length * length + of_rate * rate;
        let force = affine(self.gain) * input + affine(self.bias);
        self.terms.as_ref().map_or(force, |terms| force + terms.force(length, rate))
    }

    /// Its length and the rate of that, by the joints that it drives.
    fn length(&self, q: &[S], v: &[S]) -> (S, S) {
        let parts = self.drives.iter().map(|drive| drive.length(q, v));
        parts.fold((S::zero(), S::zero()), |(l, r), (length, rate)| (l + length, r + rate))
    }

    /// −∂f/∂l̇, zero at a bound of the force.
    fn damping(&self, input: S, (length, rate): (S, S)) -> S {
        let slope = -(self.gain[2] * input + self.bias[2]);
        let slope = self.terms.as_ref().map_or(slope, |terms| slope + terms.slope(rate));
        within(self.unbounded(input, length, rate), self.force_range, slope)
    }

    /// The degree of freedom, if it drives one joint of one degree.
    fn only_joint(&self) -> Option<usize> {
        let [Transmission { v, gear, .. }] = &self.drives[..] else { return None };
        (gear.len() == 1).then_some(*v)
    }

    /// The torque of a force of one at q: its entries, each with its degree of freedom.
    fn row<'a>(&'a self, q: &'a [S]) -> impl Iterator<Item = (usize, S)> + Clone + 'a {
        self.drives.iter().flat_map(|drive| drive.row(q))
    }

    /// The degrees of freedom of its row.
    fn freedoms(&self) -> impl Iterator<Item = usize> + '_ {
        self.drives.iter().flat_map(|drive| drive.v..drive.v + drive.gear.len())
    }

    /// τ += gear · f.
    fn add_torque(&self, input: S, q: &[S], v: &[S], tau: &mut [S]) {
        let force = self.force(input, q, v);
        for drive in self.drives.iter().filter(|drive| !drive.has_no_torque) {
            drive.row(q).for_each(|(k, gear)| tau.iter_mut().skip(k).take(1).for_each(|tau| *tau += gear * force));
        }
    }

    /// Whether it depends on a rate.
    fn has_damping(&self, is_zero: impl Fn(S) -> bool + Copy) -> bool {
        !is_zero(self.gain[2]) || !is_zero(self.bias[2]) || self.terms.as_ref().is_some_and(|terms| terms.has_damping(is_zero))
    }
}

impl<S: Scalar> Actuators<S> {
    /// Adds their torques to `tau` `[nv]`, N·m or N, which is zero on entry, but for those of
    /// forces on frames. Missing inputs are 0.
    ///
    /// inputs: `[nu]`, of [`Actuators::inputs`]; q: `[nq]`; v: `[nv]`.
    pub fn add_torques(&self, inputs: &[S], q: &[S], v: &[S], tau: &mut [S]) {
        self.add_all_torques(inputs, &[], (q, v), tau);
    }

    /// The same with those of forces on frames, whose rows are these. Bounds of joints are for
    /// actuators together.
    pub(crate) fn add_all_torques(&self, inputs: &[S], rows: &[FrameRow<S>], (q, v): (&[S], &[S]), tau: &mut [S]) {
        let input = |k: usize| inputs.get(k).copied().unwrap_or(S::zero());
        self.laws_of(rows, inputs, false).for_each(|(row, law, input)| row.add(law, input, v, tau));
        self.laws.iter().enumerate().for_each(|(k, law)| law.add_torque(input(k), q, v, tau));
        for (k, range) in &self.bounds {
            if let Some(tau) = tau.get_mut(*k) {
                *tau = clamp(*tau, Some(*range));
            }
        }
        for follower in &self.followers {
            let laws = follower.laws.iter().filter_map(|(k, gear)| Some((self.laws.get(*k)?, *k, *gear)));
            let torque = laws.fold(S::zero(), |sum, (law, k, gear)| sum + gear * law.force(input(k), q, v));
            let torque = clamp(torque, follower.range);
            for own in &follower.leaders {
                tau.iter_mut().skip(own.v).take(1).for_each(|tau| *tau += own.to_leader(q, torque));
            }
        }
        self.passive.iter().for_each(|law| law.add_torque(S::zero(), q, v, tau));
        self.laws_of(rows, inputs, true).for_each(|(row, law, input)| row.add(law, input, v, tau));
    }

    /// Visits d g_i g_j of each force whose slope −∂f/∂l̇ = d may not be zero, for the entries
    /// i ≥ j of its row g = ∂l/∂q.
    ///
    /// As in MuJoCo 4, d is zero at a bound of the force, and for an actuator of one joint at a
    /// bound of the torque of that joint.
    pub(crate) fn damping(&self, inputs: &[S], rows: &[FrameRow<S>], (q, v): (&[S], &[S]), mut visit: impl FnMut(usize, usize, S)) {
        let zero = S::zero();
        let laws = self.laws.iter().enumerate().map(|(k, law)| (law, inputs.get(k).copied().unwrap_or(zero)));
        let bound = |law: &ActuatorLaw<S>| law.only_joint().and_then(|own| self.bounds.iter().find(|(k, _)| *k == own));
        let bounded = laws.clone().map(|(law, input)| (law, input, bound(law)));
        let all = bounded.chain(self.passive.iter().map(|law| (law, zero, None)));
        for (law, input, bound) in all.filter(|(law, ..)| law.has_damping(|x| x == zero)) {
            let mut slope = law.damping(input, law.length(q, v));
            if let Some((own, range)) = bound {
                let mut tau = vec![zero; v.len()];
                self.laws_of(rows, inputs, false).for_each(|(row, law, input)| row.add(law, input, v, &mut tau));
                laws.clone().for_each(|(law, input)| law.add_torque(input, q, v, &mut tau));
                slope = within(tau[*own], Some(*range), slope);
            }
            for (i, a) in law.row(q) {
                law.row(q).filter(|(j, _)| *j <= i).for_each(|(j, b)| visit(i, j, slope * a * b));
            }
        }
        let of_frames = self.laws_of(rows, inputs, false).chain(self.laws_of(rows, inputs, true));
        for (own, law, input) in of_frames.filter(|(_, law, _)| law.has_damping(|x| x == zero)) {
            let slope = law.damping(input, (own.length, own.rate(v)));
            for (i, a) in &own.row {
                own.row.iter().filter(|(j, _)| j <= i).for_each(|(j, b)| visit(*i, *j, slope * *a * *b));
            }
        }
    }

    /// Whether a force that depends on a rate acts on several degrees of freedom.
    pub fn couple_rates(&self) -> bool {
        self.all().filter(|law| law.has_damping(|x| x == S::zero())).any(|law| {
            let first = law.freedoms().next();
            law.frames.is_some() || law.freedoms().any(|k| first.is_some_and(|first| first != k))
        })
    }

    /// Whether a torque depends on q or v.
    pub fn depend_on_state(&self) -> bool {
        let depends = |[_, of_length, of_rate]: [S; 3]| of_length != S::zero() || of_rate != S::zero();
        let is_bent = |law: &ActuatorLaw<S>| law.drives.iter().any(|drive| drive.higher.is_some());
        self.all().any(|law| depends(law.gain) || depends(law.bias) || law.terms.is_some() || is_bent(law))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::actuator::Follower;
    use crate::joint::Coordinates;

    #[test]
    fn an_actuator_follows_its_affine_law_within_its_bounds() {
        let drive = |k, gear: f64| Transmission { q: k, v: k, gear: vec![gear], ..Transmission::default() };
        let servo = ActuatorLaw {
            name: "servo".into(),
            drives: vec![drive(0, 2.0), drive(1, -1.0)],
            frames: None,
            gain: [10.0, 1.0, 0.5],
            bias: [1.0, -10.0, -2.0],
            terms: None,
            control_range: Some([-1.0, 1.0]),
            force_range: Some([-15.0, 15.0]),
            activation: None,
        };
        // Length 2 · 0.5 − 0.25 = 0.75, rate 2 · 1 − 3 = −1.
        let (q, v) = ([0.5, 0.25], [1.0, 3.0]);
        let plain = ActuatorLaw { control_range: None, force_range: None, ..servo.clone() };
        assert_eq!(plain.force(2.0, &q, &v), (10.0 + 0.75 - 0.5) * 2.0 + 1.0 - 7.5 + 2.0);
        assert_eq!(servo.force(1.0, &q, &v), 10.25 - 4.5);
        assert_eq!(servo.force(-1.0, &q, &v), -10.25 - 4.5);
        assert_eq!(ActuatorLaw { bias: [-9.0, 0.0, 0.0], ..servo.clone() }.force(-1.0, &q, &v), -15.0);
        let spring = ActuatorLaw { drives: vec![drive(1, 1.0)], bias: [0.0, -4.0, 0.0], ..ActuatorLaw::default() };
        let mut all = Actuators { laws: vec![servo], passive: vec![spring], bounds: vec![(1, [-1.0, 2.0])], ..Actuators::default() };
        let mut tau = [0.0; 2];
        let inputs = all.inputs(&[], &[2.0], None);
        assert_eq!((&inputs[..], &all.inputs(&[], &[-2.0], None)[..]), (&[1.0][..], &[-1.0][..]));
        all.add_torques(&inputs, &q, &v, &mut tau);
        // The bound is of the servo alone: −5.75 becomes −1.
        assert_eq!(tau, [2.0 * 5.75, -1.0 - 1.0]);
        // A joint that follows the first, x = 3 q₀, has the servo too: its torque is bounded by
        // itself.
        all.laws[0].drives[0].has_no_torque = true;
        let law = Follow { multiplier: 3.0, offset: 0.0, higher: None };
        let leader = Coordinates { q: 0, v: 0, mimic: Some(law), pitch: 0.0 };
        all.followers = vec![Follower { laws: vec![(0, 2.0)], range: Some([-4.0, 7.0]), leaders: vec![leader] }];
        let mut tau = [0.0; 2];
        all.add_torques(&inputs, &q, &v, &mut tau);
        assert_eq!(tau, [3.0 * 7.0, -1.0 - 1.0]);
        // By x = 3 q₀ + q₀², whose slope is 4.
        all.followers[0].leaders[0].mimic = Some(Follow { higher: Some([1.0, 0.0, 0.0]), ..law });
        let mut tau = [0.0; 2];
        all.add_torques(&inputs, &q, &v, &mut tau);
        assert_eq!(tau, [4.0 * 7.0, -1.0 - 1.0]);
        // As a part of the length with the factor 2: 2 (3 · 0.5 + 0.25), and its rate 2 · 4.
        let bent = Transmission { gear: vec![6.0], higher: Some([2.0, 0.0, 0.0]), ..Transmission::default() };
        let law = ActuatorLaw { drives: vec![bent], bias: [1.0, 10.0, 100.0], ..ActuatorLaw::default() };
        assert_eq!(law.force(0.0, &q, &v), 1.0 + 35.0 + 800.0);
        let mut tau = [0.0; 2];
        let passive = Actuators { passive: vec![law], ..Actuators::default() };
        passive.add_torques(&[], &q, &v, &mut tau);
        assert_eq!((tau, passive.depend_on_state()), ([8.0 * 836.0, 0.0], true));
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
}
