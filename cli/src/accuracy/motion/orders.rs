//! Errors fall with the evaluations as the orders say, over one and a half decades of evaluations.
//!
//! In doubles that is a matter of finding a motion: coarse steps have to be within the law of small steps already, fine ones above rounding. At order 8 one and a half
//! decades are twelve of errors, and doubles do not have them: there the slope is that of the same method in 96 digits, with coefficients to thirty, and the
//! integrator is held to that run, step count by step count, down to where doubles end.

use articulated::simulate::{Integrator, IntegratorId, integrators};
use articulated_core::Scalar;

use super::dop853_digits::A;
use super::scene::find;
use super::subject::{How, State, Subject};
use super::sweep::{Curve, Sample, curve, reference, slope};
use crate::precise::Big;

/// A pendulum let go almost at the top.
const START: f64 = 2.8;
const SECONDS: f64 = 1.0;

fn subject() -> Subject {
    let (_, mut subject) = find("pendulum").unwrap();
    (subject.q, subject.v, subject.seconds) = (vec![START], vec![0.0], SECONDS);
    subject
}

/// Step counts over 1.54 decades, a hundredth of which goes to the evaluation before the first step.
fn counts(from: u32) -> impl Iterator<Item = u32> {
    (0..8).map(move |k| (f64::from(from) * 10f64.powf(0.22 * f64::from(k))).ceil() as u32)
}

fn measured(integrator: &'static Integrator, from: u32, reference: (&State, f64)) -> Curve {
    let how: Vec<How> = counts(from).map(|n| How::Step(SECONDS / f64::from(n))).collect();
    curve(&subject(), integrator, &how, reference, 1)
}

fn seen(samples: &[Sample]) -> Vec<(u64, f64)> {
    samples.iter().map(|s| (s.evaluations, s.error)).collect()
}

/// Of an implicit step the shorter ones take fewer rounds; from 2·10⁻⁴ s on there are two.
fn coarsest(id: IntegratorId) -> u32 {
    match id {
        IntegratorId::semi_implicit_euler => 400,
        IntegratorId::rk4 => 24,
        IntegratorId::dopri5 => 4,
        IntegratorId::dop853 => 3,
        IntegratorId::rodas4 => 24,
        IntegratorId::lie_midpoint => 5000,
    }
}

#[test]
fn errors_fall_with_evaluations_as_the_order_says() {
    let (names, end, agreement) = reference(&subject()).unwrap();
    assert!(names[0] != names[1] && agreement < 1e-14, "{names:?} {agreement:e}");
    for integrator in integrators().iter().filter(|i| i.id != IntegratorId::dop853) {
        let curve = measured(integrator, coarsest(integrator.id), (&end, agreement));
        let (slope, order) = (curve.slope.unwrap_or_default(), f64::from(integrator.order));
        println!("{} {slope} {:?}", integrator.name, seen(&curve.samples));
        assert!((slope - order).abs() <= 0.2, "{}: {slope} {:?}", integrator.name, seen(&curve.samples));
        assert!(curve.samples.iter().all(|s| s.told), "{}: {:?}", integrator.name, seen(&curve.samples));
        assert!(decades(&curve.samples) >= 1.5, "{}: {:?}", integrator.name, seen(&curve.samples));
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

/// q and v after so many steps of the method of order 8.
fn in_digits(steps: u32) -> [Big; 2] {
    let h = Big::from_f64(SECONDS) / Big::from_f64(f64::from(steps));
    let rows = A.map(|row| row.iter().map(|(j, digits)| (*j, Big::parse(digits) * h)).collect::<Vec<_>>());
    let mut y = [Big::from_f64(START), Big::from_f64(0.0)];
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
fn by_series() -> [Big; 2] {
    let (pieces, terms) = (40, 50);
    let h = Big::from_f64(SECONDS) / Big::from_f64(f64::from(pieces));
    let (w, mut y) = (stiffness(), [Big::from_f64(START), Big::from_f64(0.0)]);
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
        let exact = by_series();
        let start = [Big::from_f64(START), Big::from_f64(0.0)];
        let drift = (energy(exact) - energy(start)).to_f64().abs();
        assert!(drift < 1e-40, "{drift:e}");
        let mut samples = Vec::new();
        for n in counts(coarsest(IntegratorId::dop853)) {
            let error = apart(in_digits(n), exact);
            samples.push(Sample { evaluations: 12 * u64::from(n), error, told: true, ..Sample::default() });
        }
        let slope = slope(&samples).unwrap_or_default();
        println!("dop853 {slope} {:?}", seen(&samples));
        assert!((slope - 8.0).abs() <= 0.2 && decades(&samples) >= 1.5, "{slope} {:?}", seen(&samples));
        // The integrator itself: the same error wherever doubles have it.
        let end = (vec![exact[0].to_f64()], vec![exact[1].to_f64()]);
        let dop853 = IntegratorId::dop853.row();
        let found = measured(dop853, coarsest(dop853.id), (&end, 1e-20));
        println!("{:?}", seen(&found.samples));
        assert_eq!(found.samples.len(), samples.len());
        for (found, digits) in found.samples.iter().zip(&samples) {
            assert!(
                (found.error - digits.error).abs() < 2e-14,
                "{} evaluations: {:e} and {:e}",
                digits.evaluations,
                found.error,
                digits.error
            );
            assert_eq!(found.evaluations, digits.evaluations + 1);
        }
    });
}

/// Scenes that drive the pendulum; steps end at multiples of a quarter of a second.
const DRIVEN: [(&str, &str); 5] = [
    ("a law of position and rate", "kind = \"pd\"\nkp = 20.0\nkd = 2.0\ntarget = 1.0"),
    (
        "the same along a table",
        "kind = \"pd\"\nkp = 20.0\nkd = 2.0\ncolumns = [\"swing\"]\nrows = [[0.0, 0.5], [0.25, 1.5], [0.75, -0.5], [1.0, 0.0]]",
    ),
    ("the same, sampled", "kind = \"pd\"\nkp = 20.0\nkd = 2.0\ntarget = 1.0\nperiod = 0.25"),
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
        let scene = format!("robot = \"simple_pendulum\"\n[initial]\nq = [{START}]\n[simulation]\nend = {SECONDS}\n[control]\n{control}\n");
        std::fs::write(&path, scene).unwrap();
        let (_, subject) = find(&path.to_string_lossy()).unwrap();
        let (_, end, agreement) = reference(&subject).unwrap();
        assert!(agreement < 1e-13, "{what}: {agreement:e}");
        let rk4 = IntegratorId::rk4.row();
        let how: Vec<How> = (0..6).map(|k| How::Step(SECONDS / f64::from(24 << k))).collect();
        let curve = curve(&subject, rk4, &how, (&end, agreement), 1);
        let slope = curve.slope.unwrap_or_default();
        println!("{what} {slope} {:?} {agreement:e}", seen(&curve.samples));
        assert!((slope - 4.0).abs() <= 0.2 && decades(&curve.samples) >= 1.5, "{what}: {slope} {:?}", seen(&curve.samples));
    }
}

#[test]
fn a_scene_with_a_blow_is_refused() {
    let refused = find("golf_swing").map(|_| ()).unwrap_err();
    assert!(refused.lines[0].contains("impact: found a blow"), "{:?}", refused.lines);
}
