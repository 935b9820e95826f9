//! Errors decrease with the evaluations according to the orders, over one and a half decades of
//! evaluations.
//!
//! In doubles this needs a suitable motion: coarse steps must already obey the law of small steps,
//! and fine ones must be above rounding. At order 8 one and a half decades are twelve decades of
//! errors, which doubles do not have: there the slope is that of the same method in 96 digits, with
//! coefficients to thirty, and the integrator is compared with that run, for each step count, down
//! to the limit of doubles.

use articulated::simulate::{Integrator, IntegratorId, integrators};
use articulated_core::Scalar;
use articulated_reference::Big;

use super::dop853_digits::A;
use super::scene::subject;
use super::subject::{How, State, Subject, difference};
use super::sweep::{Curve, Sample, curve, reference, slope};
use crate::session::{bundled, opened};

/// A motion of the pendulum: rad, rad/s, s.
#[derive(Clone, Copy)]
struct Swing {
    q: f64,
    v: f64,
    seconds: f64,
}

/// Let go almost at the top.
const SLOW: Swing = Swing { q: 2.8, v: 0.0, seconds: 1.0 };

/// Full turns. Steps of the implicit midpoint rule are solved by iterations, and short steps need
/// fewer; in this motion errors are large even with two iterations per step.
const FAST: Swing = Swing { q: 2.8, v: 40.0, seconds: 0.05 };

impl Swing {
    fn subject(self) -> Subject {
        let mut subject = subject(&bundled("pendulum")).unwrap();
        (subject.q, subject.v, subject.seconds) = (vec![self.q], vec![self.v], self.seconds);
        subject
    }

    /// q and v at the start, in digits.
    fn start(self) -> [Big; 2] {
        [Big::from_f64(self.q), Big::from_f64(self.v)]
    }

    /// One of `count` equal steps, s.
    fn step(self, count: u32) -> Big {
        Big::from_f64(self.seconds) / Big::from_f64(f64::from(count))
    }
}

/// Step counts over 1.54 decades, of which the evaluations at both ends take some.
fn counts(from: u32) -> impl Iterator<Item = u32> {
    (0..8).map(move |k| (f64::from(from) * 10f64.powf(0.22 * f64::from(k))).ceil() as u32)
}

fn measured(integrator: &'static Integrator, swing: Swing, from: u32, reference: (&State, f64)) -> Curve {
    let how: Vec<How> = counts(from).map(|n| How::Step(swing.seconds / f64::from(n))).collect();
    curve(&swing.subject(), integrator, &how, reference, 1)
}

fn seen(samples: &[Sample]) -> Vec<(u64, f64)> {
    samples.iter().map(|s| (s.evaluations, s.error)).collect()
}

/// The motion on which an integrator is measured, and the least number of steps.
fn range(id: IntegratorId) -> (Swing, u32) {
    match id {
        IntegratorId::semi_implicit_euler => (SLOW, 200),
        IntegratorId::rk4 | IntegratorId::rodas4 => (SLOW, 24),
        IntegratorId::dopri5 => (SLOW, 8),
        IntegratorId::dop853 => (SLOW, 3),
        IntegratorId::lie_midpoint => (FAST, 1000),
    }
}

#[test]
fn errors_fall_with_evaluations_as_the_order_says() {
    for integrator in integrators().iter().filter(|i| i.id != IntegratorId::dop853) {
        let (swing, from) = range(integrator.id);
        let end = in_doubles(swing);
        let curve = measured(integrator, swing, from, (&end, 1e-15));
        let (slope, order) = (slope(&curve.samples).unwrap_or_default(), f64::from(integrator.order));
        println!("{} {slope:.2} {:?}", integrator.name, seen(&curve.samples));
        assert!((slope - order).abs() <= 0.2, "{}: {slope} {:?}", integrator.name, seen(&curve.samples));
        assert!(curve.samples.iter().all(|s| s.resolved), "{}: {:?}", integrator.name, seen(&curve.samples));
        assert!(decades(&curve.samples) >= 1.5, "{}: {:?}", integrator.name, seen(&curve.samples));
    }
}

#[test]
fn the_reference_is_as_near_to_the_end_as_its_two_integrators_are_to_each_other() {
    for swing in [SLOW, FAST] {
        let (names, found, agreement) = reference(&swing.subject()).unwrap();
        assert!(names[0] != names[1] && agreement < 1e-12, "{names:?} {agreement:e}");
        let apart = difference(&swing.subject(), &found, &in_doubles(swing));
        assert!(apart <= 2.0 * agreement, "{apart:e} {agreement:e}");
    }
}

fn decades(samples: &[Sample]) -> f64 {
    (samples[samples.len() - 1].evaluations as f64 / samples[0].evaluations as f64).log10()
}

/// g m l / I of the pendulum: 9.81/1.001.
fn stiffness() -> Big {
    Big::parse("9.81") / Big::parse("1.001")
}

/// (q̇, v̇) = (v, −(g m l/I) sin q).
fn rate([q, v]: [Big; 2]) -> [Big; 2] {
    [v, -stiffness() * q.sin_cos().0]
}

/// q and v after this number of steps of the method of order 8.
fn in_digits(swing: Swing, steps: u32) -> [Big; 2] {
    let h = swing.step(steps);
    let rows = A.map(|row| row.iter().map(|(j, digits)| (*j, Big::parse(digits) * h)).collect::<Vec<_>>());
    let mut y = swing.start();
    for _ in 0..steps {
        let mut k = vec![rate(y)];
        let at = |k: &[[Big; 2]], row: &[(usize, Big)]| row.iter().fold(y, |[q, v], (j, a)| [q + *a * k[*j][0], v + *a * k[*j][1]]);
        for row in &rows[..11] {
            k.push(rate(at(&k, row)));
        }
        y = at(&k, &rows[11]);
    }
    y
}

/// q and v by power series of q, v, sin q and cos q, 50 terms of each, in 40 pieces.
fn by_series(swing: Swing) -> [Big; 2] {
    let (pieces, terms) = (40, 50);
    let (h, w, mut y) = (swing.step(pieces), stiffness(), swing.start());
    for _ in 0..pieces {
        let (sin, cos) = y[0].sin_cos();
        let (mut q, mut v, mut s, mut c) = (vec![y[0]], vec![y[1]], vec![sin], vec![cos]);
        for k in 0..terms {
            // s' = c q', c' = −s q'
            let over = Big::from_f64(1.0) / Big::from_f64((k + 1) as f64);
            let along = |x: &[Big]| (0..=k).fold(Big::from_f64(0.0), |sum, j| sum + v[j] * x[k - j]) * over;
            let (next_s, next_c) = (along(&c), -along(&s));
            let (next_q, next_v) = (v[k] * over, -w * s[k] * over);
            q.push(next_q);
            v.push(next_v);
            s.push(next_s);
            c.push(next_c);
        }
        y = [q, v].map(|x| x.into_iter().rev().reduce(|sum, x| sum * h + x).unwrap_or(Big::from_f64(0.0)));
    }
    y
}

fn in_doubles(swing: Swing) -> State {
    let [q, v] = Big::scope(|| by_series(swing).map(Big::to_f64));
    (vec![q], vec![v])
}

/// ½ v² − (g m l/I) cos q.
fn energy([q, v]: [Big; 2]) -> Big {
    v * v * Big::from_f64(0.5) - stiffness() * q.sin_cos().1
}

fn apart(a: [Big; 2], b: [Big; 2]) -> f64 {
    (a[0] - b[0]).to_f64().abs().max((a[1] - b[1]).to_f64().abs())
}

#[test]
fn the_method_of_order_8_has_it_over_twelve_decades_of_errors_and_the_integrator_is_that_method() {
    Big::scope(|| {
        let exact = by_series(SLOW);
        let drift = (energy(exact) - energy(SLOW.start())).to_f64().abs();
        assert!(drift < 1e-40, "{drift:e}");
        let digits = |n: u32| Sample {
            evaluations: 12 * u64::from(n),
            error: apart(in_digits(SLOW, n), exact),
            resolved: true,
            ..Sample::default()
        };
        let fine: Vec<Sample> = counts(40).map(digits).collect();
        let slope = slope(&fine).unwrap_or_default();
        println!("dop853 {slope:.2} {:?}", seen(&fine));
        assert!((slope - 8.0).abs() <= 0.2 && decades(&fine) >= 1.5, "{slope} {:?}", seen(&fine));
        // The integrator itself: the same errors as far as doubles have them.
        let (_, from) = range(IntegratorId::dop853);
        let found = measured(IntegratorId::dop853.row(), SLOW, from, (&in_doubles(SLOW), 1e-20)).samples;
        let coarse: Vec<Sample> = counts(from).map(digits).collect();
        println!("{:?} {:?}", seen(&found), seen(&coarse));
        assert_eq!(found.len(), coarse.len());
        for (found, digits) in found.iter().zip(&coarse) {
            // Some more at both ends, and where a long step looks out for stiffness.
            assert!((1..8).contains(&(found.evaluations - digits.evaluations)), "{found:?} {digits:?}");
            assert!(
                (found.error - digits.error).abs() < 2e-14,
                "{} evaluations: {:e} and {:e}",
                digits.evaluations,
                found.error,
                digits.error
            );
        }
    });
}

/// Scenes that drive the pendulum; steps end at multiples of a quarter of a second.
const DRIVEN: [(&str, &str); 5] = [
    ("a law of position and rate", "kind = \"pd\"\nkp = 20.0\nkd = 2.0\ntarget = [1.0]"),
    (
        "the same along a table",
        "kind = \"pd\"\nkp = 20.0\nkd = 2.0\ncolumns = [\"swing\"]\nrows = [[0.0, 0.5], [0.25, 1.5], [0.75, -0.5], [1.0, 0.0]]",
    ),
    ("the same, sampled", "kind = \"pd\"\nkp = 20.0\nkd = 2.0\ntarget = [1.0]\nperiod = 0.25"),
    ("a table", "kind = \"table\"\ncolumns = [\"swing\"]\nrows = [[0.0, 1.0], [0.5, -8.0], [0.75, 4.0], [1.0, 0.0]]"),
    (
        "a table that jumps",
        "kind = \"table\"\ninterpolation = \"hold\"\ncolumns = [\"swing\"]\nrows = [[0.0, 1.0], [0.5, -8.0], [0.75, 4.0]]",
    ),
];

#[test]
fn a_controller_costs_no_order() {
    let folder = tempfile::tempdir().unwrap();
    for (what, control) in DRIVEN {
        let path = folder.path().join("driven.toml");
        let scene = format!(
            "robot = \"simple_pendulum\"\n[initial]\nq = [{}]\n[simulation]\nend = {}\n[control]\n{control}\n",
            SLOW.q, SLOW.seconds
        );
        std::fs::write(&path, scene).unwrap();
        let subject = subject(&opened(&path)).unwrap();
        let (_, end, agreement) = reference(&subject).unwrap();
        let rk4 = IntegratorId::rk4.row();
        let how: Vec<How> = (0..7).map(|k| How::Step(SLOW.seconds / f64::from(8 << k))).collect();
        let curve = curve(&subject, rk4, &how, (&end, agreement), 1);
        let slope = slope(&curve.samples).unwrap_or_default();
        println!("{what} {slope} {:?} {agreement:e}", seen(&curve.samples));
        assert!((slope - 4.0).abs() <= 0.2 && decades(&curve.samples) >= 1.5, "{what}: {slope} {:?}", seen(&curve.samples));
        assert!(curve.samples.iter().all(|s| s.resolved), "{what}: {agreement:e} {:?}", seen(&curve.samples));
    }
}

#[test]
fn a_scene_with_a_blow_is_refused() {
    let refused = subject(&bundled("golf_swing")).unwrap_err().to_string();
    assert!(refused.contains("impact: found a blow"), "{refused}");
}
