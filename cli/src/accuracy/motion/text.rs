//! A motion's report as tables.

use std::fmt::Write;

use super::super::text::number;
use super::{Motion, Sample};
use crate::table::{Table, plain};

/// For people.
pub(super) fn text(m: &Motion) -> String {
    let mut out = head(m);
    for c in &m.curves {
        let slope = c.slope.map_or_else(|| "too little to tell".to_owned(), |s| format!("{s:.2}"));
        let _ = writeln!(out, "\n{}, order {}; the error falls as this power of the evaluations: {slope}", c.integrator, c.order);
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
    out + "\nError: the largest difference of a number of the last state (rad, m, and those a second). <: below what the reference can tell.\n"
}

/// What was measured.
pub(super) fn head(m: &Motion) -> String {
    let [a, b] = &m.references;
    let mut out = format!(
        "{}: {} s, {} degrees of freedom. Reference: {a} and {b}, which agree to {:.1e}; errors below 100 times that are not shown in diagrams.\n\
         {}; articulated {} ({}), generic code\n",
        m.scene, m.seconds, m.degrees_of_freedom, m.agreement, m.processor, m.version, m.commit
    );
    m.notes.iter().for_each(|note| out += &format!("note: {}\n", plain(note)));
    out
}

fn row(s: &Sample) -> Vec<String> {
    let optional = |x: Option<f64>| x.map_or_else(|| "–".into(), number);
    let error = if s.told { number(s.error) } else { format!("< {}", number(s.error)) };
    vec![
        optional(s.step),
        optional(s.tolerance),
        s.evaluations.to_string(),
        format!("{:.3}", s.wall * 1e3),
        error,
        optional(s.energy),
        optional(s.momentum),
    ]
}

/// Rows of numbers with a head.
pub(super) fn csv(m: &Motion) -> String {
    let number = |x: Option<f64>| x.map_or_else(String::new, |x| format!("{x:e}"));
    let mut out = String::from("scene,integrator,order,step,tolerance,evaluations,wall_seconds,error,energy,momentum,told\n");
    for c in &m.curves {
        for s in &c.samples {
            let (step, tolerance) = (number(s.step), number(s.tolerance));
            let (energy, momentum) = (number(s.energy), number(s.momentum));
            let _ = writeln!(
                out,
                "{},{},{},{step},{tolerance},{},{:e},{:e},{energy},{momentum},{}",
                m.scene, c.integrator, c.order, s.evaluations, s.wall, s.error, s.told
            );
        }
    }
    out
}

/// The cheapest run that is accurate enough, by evaluations and by the clock.
pub(super) fn advice(m: &Motion, wish: f64) -> String {
    let fit: Vec<(&str, &Sample)> = m
        .curves
        .iter()
        .filter(|c| !c.peer)
        .flat_map(|c| c.samples.iter().map(|s| (c.integrator.as_str(), s)))
        .filter(|(_, s)| s.error <= wish)
        .collect();
    let told = |(name, s): &(&str, &Sample)| {
        let how = s.step.map_or_else(|| format!("tolerance {:.1e}", s.tolerance.unwrap_or_default()), |h| format!("steps of {h:.2e} s"));
        format!("{name} with {how}: error {:.1e}, {} evaluations, {:.2} ms", s.error, s.evaluations, s.wall * 1e3)
    };
    let by_evaluations = fit.iter().min_by_key(|(_, s)| s.evaluations);
    let by_time = fit.iter().min_by(|a, b| a.1.wall.total_cmp(&b.1.wall));
    match (by_evaluations, by_time) {
        (Some(a), Some(b)) => format!("{}: fewest evaluations: {}\n{}: least time: {}\n", m.scene, told(a), m.scene, told(b)),
        _ => format!("{}: no run is accurate to {wish:e}\n", m.scene),
    }
}

#[cfg(test)]
mod tests {
    use super::super::sweep::{Curve, Motion, Sample};
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
            told: error > 1e-11,
        };
        let samples = vec![sample(10, 1e-3), sample(100, 1e-7), sample(1000, 1e-12)];
        let curves = vec![Curve { integrator: "rk4".into(), peer: false, order: 4, slope: Some(4.0), samples }];
        let references = ["one".to_owned(), "other".to_owned()];
        let (processor, notes) = ("a processor".to_owned(), vec!["a note".to_owned()]);
        let (scene, seconds, degrees_of_freedom, agreement) = ("a <scene>".to_owned(), 1.0, 2, 1e-13);
        Motion { scene, seconds, degrees_of_freedom, references, agreement, processor, version: "0", commit: "none", notes, curves }
    }

    #[test]
    fn the_cheapest_run_is_named_and_what_the_reference_cannot_tell_is_marked() {
        let m = motion();
        assert!(advice(&m, 1e-6).contains("rk4 with steps of 1.00e-2 s") && advice(&m, 1e-20).contains("no run"));
        assert!(text(&m).contains("< 1.0e-12"));
        assert!(csv(&m).lines().all(|l| l.split(',').count() == 11));
    }

    #[test]
    fn the_page_needs_nothing_else() {
        let m = motion();
        let page = page::html(&m, &plot::diagrams(&m));
        assert!(!page.contains("src=") && page.contains("a &lt;scene&gt;") && page.matches("<svg").count() == 3);
    }
}
