//! Wall times of engines, as text.

use std::fmt::Write;

use super::report::{Report, Target};
use super::search::Effort;
use crate::table::{Table, number, plain};

pub(super) fn text(r: &Report) -> String {
    let mut out = format!(
        "{}: {}, {} s of motion; generated code by {}\nreference: {}\n",
        plain(&r.scene),
        plain(&r.robot),
        number(r.simulated_s),
        r.compiler,
        r.reference
    );
    r.notes.iter().for_each(|note| out += &format!("note: {note}\n"));
    for target in &r.targets {
        let _ = write!(out, "\nerror of the last state at most {:e}\n{}", target.error, table(target).text());
        let ratios = [
            ("the fastest peer takes", &target.times_faster, "times as long as our fastest"),
            ("", &target.times_faster_at_order_4, "times at order 4 with equal steps"),
        ];
        let told: Vec<String> =
            ratios.iter().filter_map(|(a, ratio, b)| Some(format!("{a} {:.1} {b}", ratio.as_ref()?).trim().to_owned())).collect();
        if !told.is_empty() {
            let _ = writeln!(out, "{}", told.join(", "));
        }
    }
    out
}

fn table(target: &Target) -> Table {
    let columns = [
        ("", ""),
        ("order", ""),
        ("step or tolerance", ""),
        ("steps", ""),
        ("evaluations", ""),
        ("error", ""),
        ("time", "ms"),
        ("simulated", "s/s"),
    ];
    let mut table = Table::new(columns);
    for r in &target.reached {
        let effort = match r.effort {
            Effort::Steps(n) => format!("end/{n}"),
            Effort::Tolerance(tol) => format!("{tol:.1e}"),
        };
        let cells = [r.order.to_string(), effort, r.steps.to_string(), r.evaluations.to_string(), format!("{:.1e}", r.error)];
        let times = [number(r.wall_ms), number(r.simulated_s_per_wall_s.round())];
        table.row(std::iter::once(r.name.clone()).chain(cells).chain(times));
    }
    table
}
