//! Effects of a scene as text.

use std::fmt::Write;

use super::report::{Cost, Ignored, On, Operations, Report};
use crate::table::{Table, freedom, number, plain};
use articulated_lab::timing::Summary;

pub(super) fn text(r: &Report) -> String {
    let [x, y, z] = r.gravity.map(number);
    let mut out = format!(
        "{}: {}, {} base, {}, gravity ({x}, {y}, {z}) m/s²\n",
        plain(&r.scene),
        plain(&r.robot),
        r.base,
        freedom(r.degrees_of_freedom)
    );
    let none = |count: usize| if count == 0 { " nothing" } else { "" };
    let _ = writeln!(out, "\non:{}", none(r.on.len()));
    let mut last = "";
    for (e, names, lines) in together(&r.on) {
        if e.effect != last {
            let count = r.counts.iter().find(|count| count.effect == e.effect).map_or("", |count| count.text.as_str());
            let _ = writeln!(out, "  {}: {count}\n    law: {}", e.effect, e.law);
            last = e.effect;
        }
        let lines = if lines.is_empty() { String::new() } else { format!("   (line {})", lines.join(", ")) };
        let _ = writeln!(out, "    {}: {}{lines}", plain(&names.join(", ")), numbers(e));
    }
    let _ = writeln!(out, "\noff:{}", none(r.off.len()));
    r.off.iter().for_each(|e| out += &format!("  {}: {}\n", e.effect, e.why));
    let _ = writeln!(out, "\nin the robot's file, and not used:{}", none(r.ignored.len()));
    for (tag, why, subjects) in alike(&r.ignored) {
        let _ = writeln!(out, "  {}: {}: {}", plain(tag), plain(why), plain(&subjects.join(", ")));
    }
    if r.limbs > 1 {
        let _ = writeln!(out, "\n{} limbs that are alike are computed at once: an instruction for all of them counts once", r.limbs);
    }
    for cost in &r.costs {
        let what = match &cost.only_with {
            Some(only) => {
                format!("without the effects it is not defined ({}): what generated code costs with all of them", plain(&only.why))
            }
            None => "what generated code costs, and what each effect adds to it".into(),
        };
        let _ = write!(out, "\n{}: {what}\n{}", cost.function, table(cost).text());
    }
    if let Some(compiler) = &r.compiler {
        let _ = writeln!(out, "\nmedians of differences, ns; {compiler}");
    }
    out
}

/// Effects with the same numbers: the first one, the joints or links of all, and their lines.
fn together(on: &[On]) -> Vec<(&On, Vec<String>, Vec<String>)> {
    let mut groups: Vec<(&On, Vec<String>, Vec<String>)> = Vec::new();
    for e in on {
        let line = e.line.map(|l| l.to_string());
        match groups.iter_mut().find(|(first, ..)| (first.effect, numbers(first)) == (e.effect, numbers(e))) {
            Some((_, names, lines)) => {
                names.push(e.on.clone());
                lines.extend(line.filter(|l| !lines.contains(l)));
            }
            None => groups.push((e, vec![e.on.clone()], line.into_iter().collect())),
        }
    }
    groups
}

/// Unused content with the same reason: tag, reason, and all subjects.
fn alike(ignored: &[Ignored]) -> Vec<(&str, &str, Vec<String>)> {
    let mut groups: Vec<(&str, &str, Vec<String>)> = Vec::new();
    for i in ignored {
        match groups.iter_mut().find(|(tag, why, _)| (*tag, *why) == (&i.tag, &i.why)) {
            // "joint" once for all subjects
            Some((.., subjects)) => subjects.push(i.of.split_once(' ').map_or(i.of.clone(), |(_, name)| name.to_owned())),
            None => groups.push((&i.tag, &i.why, vec![i.of.clone()])),
        }
    }
    groups
}

fn numbers(e: &On) -> String {
    e.numbers.iter().map(|n| format!("{} {}{}", n.name, values(&n.values), unit(n.unit, n.from))).collect::<Vec<_>>().join(", ")
}

fn values(x: &[f64]) -> String {
    let all: Vec<String> = x.iter().map(|x| number(*x)).collect();
    if all.len() == 1 { all[0].clone() } else { format!("({})", all.join(", ")) }
}

fn unit(unit: &str, from: Option<&str>) -> String {
    let unit = if unit.is_empty() || unit == "1" { String::new() } else { format!(" {unit}") };
    from.map_or(unit.clone(), |tag| format!("{unit} (file: {tag})"))
}

fn table(cost: &Cost) -> Table {
    let timed = cost.whole().is_some_and(|c| c.ns.is_some());
    let columns = ["", "on", "multiplications", "additions", "divisions, roots", "instructions", "ns"];
    let mut table = Table::new(columns.iter().take(if timed { 7 } else { 6 }).map(|c| (*c, "")));
    let mut row = |what: String, places: String, o: Operations, ns: Option<Summary>, plus: bool| {
        let count = |n: i64| if plus { format!("{n:+}") } else { n.to_string() };
        let mut cells =
            vec![what, places, count(o.multiplications), count(o.additions), count(o.divisions_and_roots), count(o.instructions)];
        cells.extend(ns.map(|s| if plus { format!("{:+.1}", s.median) } else { format!("{:.1}", s.median) }));
        table.row(cells);
    };
    let name = if cost.only_with.is_some() { "with all effects" } else { "without effects" };
    cost.whole().into_iter().for_each(|c| row(name.into(), String::new(), c.operations, c.ns, false));
    for a in &cost.adds {
        let (what, places) =
            if a.what == "gravity" { ("  of it gravity".to_owned(), String::new()) } else { (a.what.clone(), a.places.to_string()) };
        row(what, places, a.operations, a.ns, true);
    }
    table
}
