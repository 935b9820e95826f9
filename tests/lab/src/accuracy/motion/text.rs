//! A motion's report as tables.

use std::fmt::Write;

use super::super::text::number;
use super::advise::{self, Run};
use super::plot::lost;
use super::sweep::{COARSE, Curve};
use super::{Motion, Sample};
use crate::table::{Table, freedom, plain, wrapped};

/// For people.
pub(super) fn text(m: &Motion) -> String {
    let mut out = head(m);
    for c in &m.curves {
        let _ = writeln!(out, "\n{}, order {}{}", c.integrator, c.order, power(c));
        let mut table = Table::new([
            ("step", "s"),
            ("tolerance", ""),
            ("evaluations", ""),
            ("wall time", "ms"),
            ("error", ""),
            ("energy", "relative"),
            ("momentum", "relative"),
        ]);
        for s in &c.samples {
            table.row(row(s));
        }
        out += &table.text();
    }
    out + "\n" + &wrapped(&format!("{EXPLAINED} Rows with errors from {COARSE} on are left out.\n"))
}

const EXPLAINED: &str = "Error: the largest difference of a number of the last state (rad, m, and those a second). <: below what the reference can tell; lost: larger than the motion itself, not drawn.
Energy: missing or too much at the end, relative to the largest kinetic or potential energy; momentum: its change, relative to it, where nothing acts from outside.
Power: the slope of a straight line through the logarithms of the finest rows that the reference can tell, half of these and three at least. The order is that of short \
steps; it does not show where steps are longer than that, or where evaluations do not grow as steps do (steps that are refused, rounds of an implicit method).";

/// The measured order.
fn power(c: &Curve) -> String {
    let Some(slope) = c.slope else { return "; too few rows to measure it".into() };
    let seen = if c.shows_order() { "" } else { ", which does not show here" };
    format!("{seen}; measured over the finest {} rows: the error falls as the power {slope:.2} of the evaluations", c.slope_rows)
}

/// The description of the measurement.
pub(super) fn head(m: &Motion) -> String {
    let [a, b] = &m.references;
    let mut out = format!(
        "{}: {} s, {}. Reference: {a} and {b}, which agree to {:.1e}; errors below 100 times that are not shown in diagrams.\n\
         {}; articulated {} ({}), generic code\n",
        m.scene,
        m.seconds,
        freedom(m.degrees_of_freedom),
        m.agreement,
        m.processor,
        m.version,
        m.commit
    );
    lost(m).iter().for_each(|line| out += &format!("note: {line}; marked \"lost\" in the tables\n"));
    m.notes.iter().for_each(|note| out += &format!("note: {}\n", plain(note)));
    wrapped(&out)
}

fn row(s: &Sample) -> Vec<String> {
    let optional = |x: Option<f64>| x.map_or_else(|| "–".into(), number);
    vec![
        optional(s.step),
        optional(s.tolerance),
        s.evaluations.to_string(),
        format!("{:.3}", s.wall * 1e3),
        error(s),
        optional(s.energy),
        optional(s.momentum),
    ]
}

/// Marked if it is below the accuracy of the reference.
fn error(s: &Sample) -> String {
    match s {
        Sample { lost: true, .. } => format!("lost {}", number(s.error)),
        Sample { resolved: true, .. } => number(s.error),
        _ => format!("< {}", number(s.error)),
    }
}

/// Rows of numbers with a head.
pub(super) fn csv(m: &Motion) -> String {
    let number = |x: Option<f64>| x.map_or_else(String::new, |x| format!("{x:e}"));
    let mut out = String::from("scene,integrator,order,step,tolerance,evaluations,wall_seconds,error,energy,momentum,told,lost\n");
    for c in &m.curves {
        for s in &c.samples {
            let (step, tolerance) = (number(s.step), number(s.tolerance));
            let (energy, momentum) = (number(s.energy), number(s.momentum));
            let _ = writeln!(
                out,
                "{},{},{},{step},{tolerance},{},{:e},{:e},{energy},{momentum},{},{}",
                m.scene, c.integrator, c.order, s.evaluations, s.wall, s.error, s.resolved, s.lost
            );
        }
    }
    out
}

/// The cheapest run that is accurate enough, by evaluations and by the clock, in sentences.
pub(super) fn advice(m: &Motion, wish: f64) -> String {
    match advise::all(m, wish).runs.as_slice() {
        [a, b] => format!("{}: fewest evaluations: {}\n{}: least time: {}\n", m.scene, summary(a), m.scene, summary(b)),
        _ => format!("{}: no run is accurate to {wish:e}, and the finer ones of its integrator with it\n", m.scene),
    }
}

/// An integrator with its setting and its results.
fn summary(Run { integrator, sample: s, .. }: &Run<'_>) -> String {
    let how = s.step.map_or_else(|| format!("tolerance {:.1e}", s.tolerance.unwrap_or_default()), |h| format!("steps of {h:.2e} s"));
    format!("{integrator} with {how}: error {}, {} evaluations, {:.2} ms", error(s), s.evaluations, s.wall * 1e3)
}

#[cfg(test)]
mod tests {
    use super::super::sweep::UNITS;
    use super::super::{page, plot};
    use super::*;

    fn motion() -> Motion {
        let sample = |n: u64, error: f64| Sample {
            step: Some(1.0 / n as f64),
            tolerance: None,
            evaluations: 4 * n,
            wall: 1e-6 * n as f64,
            error,
            energy: Some(error / 2.0),
            momentum: None,
            resolved: error > 1e-11,
            lost: false,
        };
        let samples = vec![sample(10, 1e-3), sample(100, 1e-7), sample(1000, 1e-12)];
        let curves = vec![Curve::new("rk4".into(), false, 4, samples)];
        let references = ["one".to_owned(), "other".to_owned()];
        let (processor, notes) = ("a processor".to_owned(), vec!["a note".to_owned()]);
        let (scene, seconds, degrees_of_freedom, agreement) = ("a <scene>".to_owned(), 1.0, 2, 1e-13);
        let (version, commit, units, extent) = ("0", "none", UNITS, 3.0);
        Motion { scene, seconds, degrees_of_freedom, references, agreement, extent, processor, version, commit, units, notes, curves }
    }

    #[test]
    fn the_cheapest_run_is_named_and_what_the_reference_cannot_tell_is_marked() {
        let m = motion();
        assert!(advice(&m, 1e-6).contains("rk4 with steps of 1.00e-2 s") && advice(&m, 1e-20).contains("no run"));
        assert!(text(&m).contains("< 1.0e-12"));
        assert!(csv(&m).lines().all(|l| l.split(',').count() == 12));
    }

    #[test]
    fn a_run_that_has_lost_the_motion_is_marked_and_not_drawn() {
        let mut m = motion();
        let drawn = |m: &Motion| plot::diagrams(m).into_iter().map(|(_, d)| d.svg()).collect::<Vec<_>>();
        let before = drawn(&m);
        m.curves[0]
            .samples
            .insert(0, Sample { evaluations: 8, error: 1e98, energy: Some(1.0), resolved: true, lost: true, ..Sample::default() });
        let line = "1 run not drawn: off by more than the motion itself (3 rad, m, and those a second)";
        for (with, without) in drawn(&m).iter().zip(&before) {
            assert!(with.contains(line) && !with.contains("1e98") && !without.contains("not drawn"));
            let others = with.lines().filter(|l| !l.contains(line)).collect::<Vec<_>>();
            assert_eq!(others, without.lines().collect::<Vec<_>>());
        }
        assert!(
            text(&m).contains("lost 1.0e98") && text(&m).contains(&format!("note: {line}")) && !text(&motion()).contains("note: 1 run")
        );
        assert!(csv(&m).lines().nth(1).unwrap().ends_with(",true,true"));
    }

    /// Errors and tolerances of dop853 on the pendulum: 3.2e-6 is a lucky hit, and the last two are
    /// below the accuracy of the reference.
    fn lucky() -> Motion {
        let errors = [(1e-5, 1.9e-4), (3.2e-6, 1.9e-5), (1e-6, 1.3e-4), (3.2e-7, 1.6e-5), (1e-7, 3e-6), (1e-11, 8.6e-11), (3.2e-12, 3e-11)];
        let sample = |(k, (tolerance, error)): (usize, (f64, f64))| Sample {
            tolerance: Some(tolerance),
            evaluations: 500 + 100 * k as u64,
            wall: 1e-4 * (k + 1) as f64,
            error,
            resolved: error > 1e-10,
            ..Sample::default()
        };
        let samples = errors.into_iter().enumerate().map(sample).collect();
        Motion { curves: vec![Curve::new("dop853".into(), false, 8, samples)], ..motion() }
    }

    #[test]
    fn a_lucky_hit_is_not_advised() {
        let told = advice(&lucky(), 1e-4);
        assert!(told.lines().all(|l| l.contains("dop853 with tolerance 3.2e-7: error 1.6e-5")), "{told}");
        // The finest run has no neighbour that would exclude a lucky hit.
        assert!(advice(&lucky(), 5e-11).contains("no run is accurate to 5e-11"));
        assert!(advice(&Motion { curves: Vec::new(), ..motion() }, 1.0).contains("no run"));
        let mut broken = lucky();
        broken.curves[0].samples[6].error = f64::NAN;
        assert!(advice(&broken, 1.0).contains("no run"));
    }

    #[test]
    fn what_the_reference_cannot_tell_is_marked_in_the_advice_too() {
        let told = advice(&lucky(), 1e-9);
        assert!(told.lines().all(|l| l.contains("error < 8.6e-11,")), "{told}");
    }

    #[test]
    fn an_order_that_does_not_show_is_said_not_to() {
        let m = motion();
        assert!(text(&m).contains("rk4, order 4; too few rows to measure it\n"));
        let shown = |order: u32, power: i32| {
            let sample = |n: u64| Sample { evaluations: n, error: (n as f64).powi(power), resolved: true, ..Sample::default() };
            let samples = [10, 30, 100, 300, 1000].map(sample).to_vec();
            text(&Motion { curves: vec![Curve::new("a".into(), false, order, samples)], ..motion() })
        };
        let right = "a, order 4; measured over the finest 3 rows: the error falls as the power 4.00 of the evaluations\n";
        assert!(shown(4, -4).contains(right));
        assert!(
            shown(8, -4)
                .contains("a, order 8, which does not show here; measured over the finest 3 rows: the error falls as the power 4.00")
        );
    }

    #[test]
    fn units_are_those_of_numbers_that_are_there() {
        assert!(crate::json::lead(UNITS, &serde_json::to_value(motion()).unwrap()));
        let m = motion();
        assert!(crate::json::lead(advise::UNITS, &serde_json::to_value(advise::all(&m, 1e-6)).unwrap()));
    }

    #[test]
    fn the_page_needs_nothing_else() {
        let m = motion();
        let page = page::html(&m, &plot::diagrams(&m));
        assert!(!page.contains("src=") && page.contains("a &lt;scene&gt;") && page.matches("<svg").count() == 3);
    }
}
