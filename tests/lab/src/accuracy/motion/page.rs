//! The report of integrators as one self-contained page.

use std::fmt::Write;

use super::{Motion, text};
use crate::plot::{Drawing, escaped};

/// The page.
pub(super) fn html(m: &Motion, diagrams: &[(String, Drawing)]) -> String {
    let mut out = format!(
        "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>What accuracy of a motion costs: {0}</title><style>body{{font:15px/1.5 sans-serif;max-width:76em;margin:2em auto;\
         padding:0 1em;color:#222}}svg{{max-width:100%;height:auto}}p,li{{max-width:62em}}pre{{background:#f5f5f5;padding:.6em;overflow-x:auto;font-size:12px}}</style></head><body>\n<h1>What accuracy of a motion costs: {0}</h1>\n",
        escaped(&m.scene)
    );
    out += INTRODUCTION;
    for (_, drawing) in diagrams {
        out += &drawing.svg();
    }
    let _ = write!(out, "<h2>What to choose</h2><ul>{}</ul>", choices(m));
    let _ = writeln!(out, "<h2>All numbers</h2><pre>{}</pre>\n</body></html>", escaped(&text::text(m)));
    out
}

const INTRODUCTION: &str = "<p>A motion is computed in small steps, and each step is a little wrong. Smaller steps are less wrong and take more of them. Each line is a method (an integrator); its marks are \
runs with finer and finer steps, or with smaller and smaller tolerances. Lower is more accurate, further left is cheaper: take the line that is lowest at the cost you can pay, or leftmost at the error you can \
bear. A method of order p gains p digits for a tenth of the step: the steeper the line, the higher the order.</p>\n\
<p>The truth that errors are measured against is what two different methods agree on with very small tolerances; errors that it cannot tell are not drawn.</p>\n";

/// The cheapest for some wishes.
fn choices(m: &Motion) -> String {
    let mut out = String::new();
    for wish in [1e-2, 1e-4, 1e-6, 1e-8, 1e-10] {
        let _ = write!(out, "<li>Error {wish:e}: <pre>{}</pre></li>", escaped(&text::advice(m, wish)));
    }
    out
}
