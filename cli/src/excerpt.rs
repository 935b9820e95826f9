//! The line of a file that a finding refers to, with a caret below.

use std::collections::BTreeMap;
use std::path::Path;

use annotate_snippets::{AnnotationKind, Group, Level, Renderer, Snippet};
use articulated_formats::{MOST_BYTES, read_file};

use crate::diagnostic::Diagnostic;

/// Number of findings shown with source lines; others are shown without.
const MOST: usize = 20;

/// Excerpts of files, each of which is read once.
#[derive(Default)]
pub(crate) struct Excerpts {
    texts: BTreeMap<String, Option<String>>,
    shown: usize,
}

impl Excerpts {
    /// The excerpt for a finding. `None`: it has no line, or its file is unreadable.
    pub(crate) fn of(&mut self, finding: &Diagnostic) -> Option<String> {
        let (file, line) = (finding.file.as_ref()?, finding.line? as usize);
        if self.shown >= MOST {
            return None;
        }
        let text = self.texts.entry(file.clone()).or_insert_with(|| text(file)).as_deref()?;
        let source = text.lines().nth(line.checked_sub(1)?)?;
        self.shown += 1;
        Some(excerpt(source, line, finding.column.map(|column| column as usize)))
    }
}

fn text(file: &str) -> Option<String> {
    String::from_utf8(read_file(Path::new(file), MOST_BYTES).ok()?).ok()
}

/// A line with its number; below, carets from the column on to the end of a word, or below the
/// whole line.
fn excerpt(source: &str, line: usize, column: Option<usize>) -> String {
    let byte = |column: usize| source.char_indices().nth(column).map_or(source.len(), |(at, _)| at);
    let start = column.map_or_else(|| source.len() - source.trim_start().len(), |column| byte(column - 1));
    let rest = &source[start..];
    let is_end = |(at, c): &(usize, char)| *at > 0 && (c.is_whitespace() || matches!(c, '>' | '=' | '/' | ','));
    let length = match column {
        Some(_) => rest.char_indices().find(is_end).map_or(rest.len(), |(at, _)| at),
        None => rest.trim_end().len(),
    };
    let snippet = Snippet::source(source).line_start(line).annotation(AnnotationKind::Primary.span(start..start + length));
    let text = Renderer::plain().render(&[Group::with_level(Level::ERROR).element(snippet)]).to_string();
    text.lines().map(str::trim_end).filter(|line| !line.trim_matches([' ', '|']).is_empty()).map(|line| format!("{line}\n")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn carets_are_below_the_word() {
        let source = "\t<mass value=\"one\"/> <!-- é -->";
        let shown = excerpt(source, 12, Some(8));
        let [line, carets] = shown.lines().collect::<Vec<_>>()[..] else { panic!("{shown}") };
        assert!(line.starts_with("12 | ") && line.ends_with("<mass value=\"one\"/> <!-- é -->"), "{shown}");
        let at = |text: &str, part: &str| text[..text.find(part).unwrap()].chars().count();
        assert_eq!((at(line, "value"), carets.matches('^').count()), (at(carets, "^"), 5), "{shown}");
    }

    #[test]
    fn without_a_column_the_line_is_marked() {
        let shown = excerpt("  mass = -1  ", 3, None);
        assert!(shown.contains("3 |   mass = -1") && shown.ends_with("^^^^^^^^^\n"), "{shown}");
    }
}
