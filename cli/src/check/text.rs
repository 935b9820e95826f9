//! The report for people.

use std::fmt::Write;

use super::base::{Base, BaseRow, Identifiable};
use super::report::{JointRow, LinkRow, MimicRow, Report};
use crate::excerpt::Excerpts;
use crate::robot::named;
use crate::table::{Table, counted, freedom, number, plain};

pub(super) fn text(report: &Report) -> String {
    let (mut out, mut excerpts) = (String::new(), Excerpts::default());
    for diagnostic in &report.errors {
        let _ = writeln!(out, "error: {}", plain(&diagnostic.message));
        out.extend(excerpts.of(diagnostic));
    }
    for line in &report.warning_lines {
        let _ = writeln!(out, "warning: {}", plain(line));
    }
    if report.robot.is_some() {
        if !out.is_empty() {
            out.push('\n');
        }
        body(&mut out, report);
    }
    if !report.usable {
        let _ = writeln!(out, "{}: not usable", plain(&subject(report)));
    }
    out
}

fn subject(report: &Report) -> String {
    named(&report.file, report.scene.as_deref())
}

fn body(out: &mut String, report: &Report) {
    let t = report.totals;
    let name = plain(report.robot.as_deref().unwrap_or_default());
    let (links_of, joints_of) = (counted(t.links, "link"), counted(t.joints, "joint"));
    let _ = writeln!(out, "{name}, {} base: {links_of}, {joints_of}, {}", report.base, freedom(t.degrees_of_freedom));
    let _ = writeln!(
        out,
        "{} in q; mass {} kg, of which {} kg move\n",
        counted(t.coordinates, "coordinate"),
        number(t.mass),
        number(t.moving_mass)
    );
    *out += &links(&report.links).text();
    out.push('\n');
    let joints = joints(&report.joints);
    if !joints.is_empty() {
        *out += &joints.text();
        out.push('\n');
    }
    if let Some(base) = report.base_parameters.as_ref().filter(|b| !b.joints.is_empty()) {
        *out += &base_parameters(base);
        out.push('\n');
    }
    if !report.unused.is_empty() {
        *out += "Not used, and why:\n";
        for line in &report.unused {
            let _ = writeln!(out, "  {}", plain(line));
        }
        out.push('\n');
    }
    for function in &report.functions {
        let _ = writeln!(out, "{function} can be generated.");
    }
    if report.usable {
        let _ = writeln!(out, "{}: usable", plain(&subject(report)));
    }
}

fn links(rows: &[LinkRow]) -> Table {
    let mut table = Table::new([
        ("link (frame)", ""),
        ("moves with", "joint"),
        ("mass", "kg"),
        ("centre x", "m"),
        ("y", "m"),
        ("z", "m"),
        ("moment 1", "kg·m²"),
        ("2", "kg·m²"),
        ("3", "kg·m²"),
    ])
    .left(2);
    for row in rows {
        let three = |x: Option<[f64; 3]>| x.map_or([const { String::new() }; 3], |x| x.map(number));
        let mut cells = vec![row.link.clone(), row.moves_with.clone().unwrap_or_else(|| "– (base)".into())];
        cells.push(if row.mass == 0.0 { "0".into() } else { number(row.mass) });
        cells.extend(three(row.centre_of_mass));
        cells.extend(three(row.principal_moments));
        table.row(cells);
    }
    table
}

fn joints(rows: &[JointRow]) -> Table {
    let mut table = Table::new([
        ("joint", ""),
        ("type", ""),
        ("parent", ""),
        ("child", ""),
        ("follows", ""),
        ("q", "index"),
        ("v", "index"),
        ("lower", "rad|m"),
        ("upper", "rad|m"),
        ("velocity", "rad/s|m/s"),
        ("effort", "N·m|N"),
        ("carries", "kg"),
    ])
    .left(5);
    for row in rows {
        let text = |x: &Option<String>| x.clone().unwrap_or_else(|| "–".into());
        let limit = |x: Option<f64>| x.map_or_else(|| "–".to_owned(), number);
        let locked = row.locked.as_ref().map(|at| format!("locked at {}", at.iter().map(|x| number(*x)).collect::<Vec<_>>().join(", ")));
        let follows = row.mimic.as_ref().map(sum);
        table.row([
            row.joint.clone(),
            row.kind.to_owned(),
            text(&row.parent),
            text(&row.child),
            text(&locked.or(follows)),
            range(row.q),
            range(row.v),
            limit(row.lower),
            limit(row.upper),
            limit(row.velocity),
            limit(row.effort),
            if row.kind == "fixed" || row.locked.is_some() { "–".into() } else { number(row.carries) },
        ]);
    }
    table
}

fn sign(x: f64) -> &'static str {
    if x < 0.0 { " - " } else { " + " }
}

/// The law of a follower: `0.5 · a - 0.5 · c + 0.1`, or `0.5 · a + 0.2 · a² + 0.1`.
fn sum(mimic: &MimicRow) -> String {
    let mut out = String::new();
    for (k, leader) in mimic.leaders.iter().enumerate() {
        let (sign, size) = if k == 0 { ("", leader.multiplier) } else { (sign(leader.multiplier), leader.multiplier.abs()) };
        let _ = write!(out, "{sign}{} · {}", number(size), leader.joint);
        for (x, power) in leader.higher.unwrap_or_default().into_iter().zip(["²", "³", "⁴"]).filter(|(x, _)| *x != 0.0) {
            let _ = write!(out, "{}{} · {}{power}", self::sign(x), number(x.abs()), leader.joint);
        }
    }
    let _ = write!(out, "{}{}", sign(mimic.offset), number(mimic.offset.abs()));
    out
}

fn base_parameters(base: &Base) -> String {
    let Base { parameters, stages, regrouped, identifiable, merged_joints, joints } = base;
    let merged = match merged_joints {
        0 => String::new(),
        1 => "1 fixed joint merged; ".into(),
        n => format!("{n} fixed joints merged; "),
    };
    let (left, several) = match stages {
        false => (format!("regrouping leaves {regrouped}, and "), ""),
        true => (
            String::new(),
            ";\na planar or universal joint and one that follows several have a row for each of their stages;\n\
             their parameters, and those of several joints on a body, are not all independent",
        ),
    };
    let head = format!(
        "{merged}of {parameters} inertial parameters {left}torques determine {identifiable}: from the tips inward, in (brackets) what only\n\
         combinations with those before show, left out what no torque shows; about the joint's frame where it was moved to, in its axes; SI units{several}"
    );
    let mut table = Table::new([("joint", ""), ("frame slid by", "m"), ("parameters", "")]).left(3);
    for row in joints {
        table.row([row.joint.clone(), moved(row), listed(row)]);
    }
    format!("{head}\n\n{}", table.text())
}

/// The shift along the joint, or all three numbers if it was shifted in another direction; and the
/// turn about it.
fn moved(row: &BaseRow) -> String {
    let slid = match row.slid {
        [0.0, 0.0, 0.0] => "–".into(),
        [0.0, 0.0, z] => number(z),
        all => all.map(number).join(" "),
    };
    if row.turned == 0.0 { slid } else { format!("{slid}, turned {} rad", number(row.turned)) }
}

fn listed(row: &BaseRow) -> String {
    let one = |p: &super::base::Parameter| match p.identifiable {
        Identifiable::Never => None,
        Identifiable::Alone => Some(format!("{} {}", p.name, number(p.value))),
        Identifiable::WithOthers => Some(format!("({} {})", p.name, number(p.value))),
    };
    let all: Vec<String> = row.parameters.iter().filter_map(one).collect();
    let all = if all.is_empty() { "–".into() } else { all.join("  ") };
    if row.round { all + "  (round: its angle plays no part)" } else { all }
}

/// `3`, `0..7`, or a dash.
fn range(place: Option<(usize, usize)>) -> String {
    match place {
        None => "–".into(),
        Some((at, 1)) => at.to_string(),
        Some((at, n)) => format!("{at}..{}", at + n),
    }
}
