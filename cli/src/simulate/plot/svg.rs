//! A picture as SVG.

use std::fmt::Write;

use super::drawing::{Anchor, Drawing, Mark, Point};
use super::font;

/// The file's text.
pub(crate) fn text(drawing: &Drawing) -> String {
    let (w, h) = (drawing.width, drawing.height);
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{w:.0}\" height=\"{h:.0}\" viewBox=\"0 0 {w:.0} {h:.0}\" font-family=\"{}\">\n\
         <rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n",
        font::FAMILY
    );
    drawing.marks.iter().for_each(|m| mark(&mut out, m));
    out + "</svg>\n"
}

fn mark(out: &mut String, mark: &Mark) {
    let _ = match mark {
        Mark::Path { points, colour, width, dash } => {
            let dashes = dash.map_or_else(String::new, |[on, off]| format!(" stroke-dasharray=\"{on} {off}\""));
            let places: Vec<String> = points.iter().map(|p| format!("{:.1},{:.1}", p[0], p[1])).collect();
            writeln!(
                out,
                "<polyline points=\"{}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"{width}\" stroke-linejoin=\"round\"{dashes}/>",
                places.join(" ")
            )
        }
        Mark::Text { at, content, size, anchor, colour, turned } => {
            let place = place(*at, *turned);
            writeln!(
                out,
                "<text {place} font-size=\"{size}\" text-anchor=\"{}\" fill=\"{colour}\">{}</text>",
                side(*anchor),
                escaped(content)
            )
        }
    };
}

fn place([x, y]: Point, turned: bool) -> String {
    let turn = if turned { format!(" transform=\"rotate(-90 {x:.1} {y:.1})\"") } else { String::new() };
    format!("x=\"{x:.1}\" y=\"{y:.1}\"{turn}")
}

fn side(anchor: Anchor) -> &'static str {
    match anchor {
        Anchor::Start => "start",
        Anchor::Middle => "middle",
        Anchor::End => "end",
    }
}

/// Text between tags.
pub(crate) fn escaped(text: &str) -> String {
    text.chars().fold(String::with_capacity(text.len()), |mut out, c| {
        match c {
            '&' => out += "&amp;",
            '<' => out += "&lt;",
            '>' => out += "&gt;",
            '"' => out += "&quot;",
            c => out.push(c),
        }
        out
    })
}
