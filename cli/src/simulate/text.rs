//! A summary for people.

use super::summary::Summary;
use crate::table::{Table, freedom, number, plain};

/// Events that are listed; the others are counted.
const LISTED: usize = 12;

pub(super) fn text(s: &Summary) -> String {
    let effects = if s.effects.is_empty() { "no effects".to_owned() } else { s.effects.join(", ") };
    let mut out = format!(
        "{}: {}, {} base, {}; {effects}\n{}\n\n",
        plain(&s.scene),
        plain(&s.robot),
        s.base,
        freedom(s.degrees_of_freedom),
        method(s)
    );
    out += &table(s).text();
    if !s.events.is_empty() {
        let mut events = Table::new([("time", "s"), ("event", "")]).left(0);
        s.events.iter().take(LISTED).for_each(|e| events.row([format!("{:.9}", e.time), e.what.clone()]));
        out += &format!("\n{}", left_aligned(&events.text()));
        if s.events.len() > LISTED {
            out += &format!("… {} more, in the summary's JSON\n", s.events.len() - LISTED);
        }
    }
    if !s.files.is_empty() {
        out += &format!("\nwritten: {}\n", s.files.join(", "));
    }
    if s.page_left_out {
        out += "not written, since the ends alone are recorded (--every SECONDS records a motion): pictures, motion.html\n";
    } else if !s.pictures_left_out.is_empty() {
        out += &format!("not written, since zero throughout: {}\n", s.pictures_left_out.join(", "));
    }
    out
}

fn method(s: &Summary) -> String {
    let m = &s.integrator;
    let steps = match m.step_s {
        Some(step) => format!("steps of {} s", number(step)),
        None => format!("relative tolerance {:e}, absolute {:e}", m.rtol, m.atol),
    };
    format!("{} (order {}), {steps}; {} code; {}", m.name, m.order, s.code, span(s))
}

/// Start and end time, and the time of the last record if it differs.
fn span(s: &Summary) -> String {
    let time = |t: f64| time(t, s.requested_end_s - s.start_s);
    let [start, asked, recorded] = [s.start_s, s.requested_end_s, s.last_record_s].map(time);
    let recorded = if s.end_s == s.last_record_s { String::new() } else { format!("; last record at {recorded} s") };
    let of = if s.end_s == s.requested_end_s { String::new() } else { format!(" of {asked} s") };
    format!("from {start} s to {} s{of}, ended {}{recorded}", time(s.end_s), s.ended)
}

/// With a resolution of at least a millionth of the motion's length.
fn time(t: f64, length: f64) -> String {
    let short = number(t);
    if short.parse().is_ok_and(|x: f64| (x - t).abs() <= 1e-6 * length) { short } else { t.to_string() }
}

fn table(s: &Summary) -> Table {
    let last = if s.end_s == s.last_record_s { "end" } else { "last record" };
    let mut table = Table::new([("", ""), ("start", ""), (last, ""), ("unit", "")]);
    let (e, p, c) = (&s.energy, &s.momentum, &s.counts);
    let mut row = |name: &str, start: String, end: String, unit: &str| table.row([name.to_owned(), start, end, unit.to_owned()]);
    let none = String::new;
    row("energy T + U", number(e.start), number(e.end), "J");
    row("  kinetic", number(e.kinetic_start), number(e.kinetic_end), "J");
    row("  potential", number(e.potential_start), number(e.potential_end), "J");
    row("work of the motors", none(), number(e.work), "J");
    row("dissipated", none(), number(e.dissipated), "J");
    if s.constraints.is_some() {
        row("brought by constraints", none(), number(e.from_events), "J");
    } else if e.from_events != 0.0 || e.ball.is_some() {
        row("brought by events", none(), number(e.from_events), "J");
    }
    if let Some(ball) = e.ball {
        row("  handed to the ball", none(), number(ball), "J");
    }
    if let Some(speed) = s.ball_speed_m_per_s {
        row("  speed of the ball", none(), number(speed), "m/s");
    }
    if let Some(constraints) = &s.constraints {
        row("most contacts at once", none(), constraints.most_contacts.to_string(), "");
        row("largest relative error of an acceleration", none(), number(constraints.largest_relative_error), "");
    } else {
        row("largest imbalance", none(), number(e.largest_imbalance), "J");
        row("  over the largest energy moved", none(), number(e.relative_imbalance), "");
    }
    let length = |p: &[f64]| number(p.iter().fold(0.0_f64, |length, x| length.hypot(*x)));
    row("angular momentum about the centre of mass", length(&p.start[..3]), length(&p.end[..3]), "kg·m²/s");
    row("  largest change", none(), number(p.largest_change_angular), "kg·m²/s");
    row("linear momentum", length(&p.start[3..]), length(&p.end[3..]), "kg·m/s");
    row("  largest change", none(), number(p.largest_change_linear), "kg·m/s");
    for crept in &s.creep {
        row(&format!("creep of {} at {}", crept.effect, plain(&crept.on)), none(), number(crept.distance), crept.unit);
        row("  while it should be held", none(), number(crept.time_s), "s");
    }
    for slid in &s.slides {
        row(&format!("slide of contact at {}", plain(&slid.on)), none(), number(slid.distance_m), "m");
        row("  although its cone holds", none(), number(slid.time_s), "s");
    }
    if last != "end" {
        row("in all", none(), none(), "");
    }
    row("steps", none(), c.steps.to_string(), "");
    row("  rejected", none(), c.rejected_steps.to_string(), "");
    if c.steps_over_stiff_layers > 0 {
        row("  over a stiff layer, not in the balance", none(), c.steps_over_stiff_layers.to_string(), "");
    }
    row("  shortest step", none(), c.smallest_step_s.map_or_else(String::new, number), "s");
    row("  longest step", none(), number(c.largest_step_s), "s");
    row("evaluations of forward dynamics", none(), c.evaluations.to_string(), "");
    if c.derivatives > 0 {
        row("  of its derivatives", none(), c.derivatives.to_string(), "");
    }
    if let Some(joint) = &c.limited_by {
        row("  limited most by joint", none(), plain(joint).to_string(), "");
    }
    if let Some(t) = c.stiff_at_s {
        row("stiff from", none(), number(t), "s");
    }
    row("events", none(), s.events.len().to_string(), "");
    if s.ball_reached == Some(false) {
        row("  the ball", none(), "not hit".into(), "");
    }
    row("wall time", none(), number(s.wall_s), "s");
    row("simulated seconds per second", none(), number(s.simulated_s_per_wall_s), "");
    table
}

/// Events are words: as the last column of a table of numbers they would be aligned to the right.
fn left_aligned(text: &str) -> String {
    text.lines()
        .map(|line| {
            let (time, what) = line.trim_start().split_once("  ").unwrap_or((line.trim(), ""));
            format!("{time:>16}  {}\n", what.trim_start())
        })
        .collect()
}

#[cfg(test)]
mod tests {
    #[test]
    fn times_of_a_short_motion_far_from_zero_are_told_apart() {
        let cases = [
            (1e9, 2.0, "1.000e9"),
            (1e9 + 2.0, 2.0, "1000000002"),
            (160_000.4, 0.4, "160000.4"),
            (1.0 / 3.0, 1.0, "0.333333"),
            (0.0, 1e-9, "0"),
        ];
        cases.iter().for_each(|(t, length, text)| assert_eq!(super::time(*t, *length), *text));
    }
}
