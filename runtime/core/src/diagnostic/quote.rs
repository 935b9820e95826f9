//! Text of an input, made safe for a message.

use alloc::string::String;

/// Control characters, and those that only change the direction or the joining of letters.
#[must_use]
pub fn is_invisible(c: char) -> bool {
    c.is_control() || matches!(c, '\u{ad}' | '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2060}'..='\u{2069}' | '\u{feff}')
}

/// `text` in quotation marks, on one line, cut where it gets long. Characters that are not visible
/// are escaped.
#[must_use]
pub fn quote(text: &str) -> String {
    quoted(text, 80)
}

/// As [`quote`], for an intended number: cut after as many characters as a double may need.
#[must_use]
pub fn quote_number(text: &str) -> String {
    quoted(text, 24)
}

fn quoted(text: &str, most: usize) -> String {
    let mut out = String::from('"');
    for c in text.chars().take(most) {
        match c {
            c if is_invisible(c) => out.extend(c.escape_default()),
            c => out.push(c),
        }
    }
    out.push_str(if text.chars().nth(most).is_some() { "…\"" } else { "\"" });
    out
}
