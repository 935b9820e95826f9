//! The report as one self-contained page.

use std::fmt::Write;

use articulated_codegen::Precision;

use super::report::{FunctionReport, Point, Report};
use super::text;
use crate::compare::accuracy::Against;
use crate::plot::{Drawing, escaped};
use crate::robot::named;

const STYLE: &str = "body{font:15px/1.5 sans-serif;max-width:82em;margin:2em auto;padding:0 1em;color:#222}table{border-collapse:collapse;font-size:13px}\
td,th{padding:.2em .6em;text-align:right;border-bottom:1px solid #ddd;white-space:nowrap}td:first-child,th:first-child{text-align:left}td:nth-child(11){white-space:normal;min-width:13em}tr.front{font-weight:bold}\
.scroll{overflow-x:auto}svg{max-width:100%;height:auto}pre{background:#f5f5f5;padding:.6em;white-space:pre-wrap}p,li{max-width:62em}";

/// The page.
pub(super) fn html(report: &Report, diagrams: &[(String, Drawing)]) -> String {
    let mut out = format!(
        "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>What accuracy costs: {0}</title><style>{STYLE}</style></head><body>\n<h1>What accuracy costs: {0}</h1>\n",
        escaped(&named(&report.robot, report.scene.as_deref()))
    );
    out += &INTRODUCTION.replace(
        "REFERENCE",
        match report.reference {
            Against::Textbook => "the textbook's formulas computed with 96 digits, which share no line with the code that is judged",
            Against::Library => "the generic library computed with 96 digits, as the textbook's formulas know no effects",
        },
    );
    let _ = writeln!(out, "<h2>What was measured</h2><pre>{}</pre>", escaped(&text::head(report)));
    out += &CHOICE.replace("CYCLE", &cycle(report));
    out += COLUMNS;
    for (f, (_, drawing)) in report.functions.iter().zip(diagrams) {
        function(&mut out, f, drawing);
    }
    contracts(&mut out, report);
    out + "</body></html>\n"
}

const INTRODUCTION: &str = "<p>A computer rounds every number it computes. The same formulas can be computed with more or fewer digits, and more digits take more time. \
This page says, for each function of this robot's dynamics, how far off the result is and how long a call takes at each <em>level</em> of accuracy, so that you can choose. \
In the diagrams every mark is a level: further left is faster, further down is more accurate. Red marks are worth choosing: nothing else is both faster and more accurate.</p>\n\
<p>Errors are measured against REFERENCE. They are relative to the sum of the magnitudes of the \
terms that are added up: 1e-16 is the rounding of one operation in double precision, 1e-7 in single precision.</p>\n";

const CHOICE: &str = "<h2>What to choose when</h2><ul>\
<li><b>Control at 1 kHz</b>: <code>f64</code>, the default. A sensor tells three to five digits, and more digits cost more.CYCLE</li>\
<li><b>Many states on few bits</b> (learning, sampling): batches of <code>f32</code>; check with this page that the error is below what you can tell apart.</li>\
<li><b>The same bits on every machine</b> (replays, lockstep simulation): <code>f64+no_fma</code>.</li>\
<li><b>Identification and calibration</b>: <code>f64</code>; least squares square the condition, so where residuals are of 1e-8 of the terms take <code>compensated+two</code>.</li>\
<li><b>Long orbits</b> of conservative systems: <code>compensated</code> for the right-hand side only if the integrator's own error is below 1e-13; see the report of the integrators.</li>\
<li><b>Checking other code</b>: <code>double_double</code>; it is right to the last bit of its result save for constants.</li></ul>\n";

/// The part of a cycle of 1 ms for the longest call of plain doubles; empty if none was measured.
fn cycle(report: &Report) -> String {
    let calls = report.functions.iter().flat_map(|f| f.points.iter().filter(|p| p.level == "f64").map(|p| (f.function, p.time.median)));
    let longest = calls.max_by(|a, b| a.1.total_cmp(&b.1));
    longest.map_or_else(String::new, |(function, ns)| {
        format!(" The longest call measured here ({function}, {ns:.0} ns) takes {:.2} % of the cycle.", 1e-4 * ns)
    })
}

const COLUMNS: &str = "<h2>What the columns say</h2><ul>\
<li><b>ns</b>: the median time of a call; <b>spread</b>: the distance of its quartiles, ns.</li>\
<li><b>median error, 99 %, largest</b>: over the random states, relative to the sum of the magnitudes of the terms; <b>ulps</b>: the largest error in units of the last place of the result itself, large where \
terms cancel.</li>\
<li><b>rounding alone</b>: the largest error against the same formulas with the constants of the generated code; <b>guaranteed</b>: what it can be at most on these states; <b>backward</b>: how far the torques \
that a solution needs are from those given.</li>\
<li><b>hardest state</b>: the largest error on states chosen to be hard, overflow if one has no result: a number on the way is beyond the largest of the level; <b>operations</b>: additions, multiplications, divisions and roots of a call, a multiply-add as two, without sines and cosines; \
<b>bytes</b>: machine code of the function alone. Bold rows are the red marks.</li></ul>\n";

fn function(out: &mut String, f: &FunctionReport, drawing: &Drawing) {
    let _ = writeln!(out, "<h2>{}</h2><p>{}.</p>\n{}", f.function, escaped(f.summary), drawing.svg());
    *out += "<div class=\"scroll\"><table><tr><th>level</th><th>ns</th><th>spread</th><th>median error</th><th>99 %</th><th>largest</th><th>ulps</th><th>rounding alone</th><th>guaranteed</th>\
             <th>backward</th><th>hardest state</th><th>operations</th><th>bytes</th></tr>\n";
    f.points.iter().for_each(|p| row(out, p));
    *out += "</table></div>\n<ul>";
    f.surprises.iter().for_each(|s| {
        let _ = writeln!(out, "<li>{}</li>", escaped(s));
    });
    *out += "</ul>\n";
}

fn row(out: &mut String, p: &Point) {
    let optional = |x: Option<f64>| x.map_or_else(|| "–".into(), text::number);
    let count = |n: Option<u64>| n.map_or_else(|| "–".into(), |n| n.to_string());
    let hard = p.hard.map_or_else(|| "–".into(), |(error, name)| format!("{} ({name})", text::hardest(error)));
    let cells = [
        escaped(&p.level),
        format!("{:.1}", p.time.median),
        format!("{:.1}", p.time.upper_quartile - p.time.lower_quartile),
        text::number(p.relative.median),
        text::number(p.relative.most),
        text::number(p.relative.largest),
        text::number(p.ulps.largest),
        optional(p.rounding.map(|r| r.largest)),
        optional(p.bound),
        optional(p.backward.map(|b| b.largest)),
        hard,
        count(p.operations),
        count(p.code_bytes),
    ];
    let _ = writeln!(out, "<tr{}><td>{}</td></tr>", if p.front { " class=\"front\"" } else { "" }, cells.join("</td><td>"));
}

/// The contract of each level.
fn contracts(out: &mut String, report: &Report) {
    *out += "<h2>What each level promises</h2>\n<dl>";
    let mut seen: Vec<&str> = Vec::new();
    for p in report.functions.iter().flat_map(|f| &f.points).filter(|p| !p.peer) {
        if let (false, Ok(level)) = (seen.contains(&p.level.as_str()), p.level.parse::<Precision>()) {
            seen.push(&p.level);
            let _ = writeln!(out, "<dt><code>{level}</code></dt><dd>{}</dd>", escaped(&level.contract().join(" ")));
        }
    }
    *out += "</dl>\n";
}

#[cfg(test)]
mod tests {
    use super::super::{plot, report::example};

    #[test]
    fn the_page_needs_nothing_else_and_escapes_names() {
        let report = example();
        let page = super::html(&report, &plot::diagrams(&report));
        assert!(!page.contains("src=") && !page.contains("href="));
        assert!(page.contains("<b>ulps</b>") && page.contains("<b>operations</b>"));
        assert!(page.contains("an &lt;arm&gt; &amp; more") && page.contains("<svg") && page.contains("a surprise"));
    }
}
