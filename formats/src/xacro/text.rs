//! Texts with expressions in them, and the parameters of macros.

use super::value::{Result, wrong};

/// A part of a text.
#[derive(Debug, PartialEq)]
pub(super) enum Piece<'a> {
    Text(&'a str),
    /// `${…}`, without the signs around it.
    Expression(&'a str),
    /// `$(…)`, without the signs around it.
    Extension(&'a str),
}

/// The parts of a text. `$${` and `$$(` mean `${` and `$(`.
pub(super) fn pieces(text: &str) -> Result<Vec<Piece<'_>>> {
    let mut out = Vec::new();
    let mut rest = text;
    while !rest.is_empty() {
        let dollars = rest.len() - rest.trim_start_matches('$').len();
        let opens = rest[dollars..].chars().next().filter(|c| matches!(c, '{' | '('));
        match (dollars, opens) {
            (0, _) => {
                let (text, after) = rest.split_at(rest.find('$').unwrap_or(rest.len()));
                out.push(Piece::Text(text));
                rest = after;
            }
            (1, Some(open)) => {
                let Some(end) = rest.find(if open == '{' { '}' } else { ')' }) else {
                    return wrong(format!("${open} without its closing bracket"), "the closing bracket");
                };
                let inner = &rest[2..end];
                out.push(if open == '{' { Piece::Expression(inner) } else { Piece::Extension(inner) });
                rest = &rest[end + 1..];
            }
            (_, Some(_)) => {
                out.push(Piece::Text(&rest[1..=dollars]));
                rest = &rest[dollars + 1..];
            }
            (1, None) => {
                let end = rest[1..].find(['$', '{', '(']).map_or(rest.len(), |end| end + 1);
                out.push(Piece::Text(&rest[..end]));
                rest = &rest[end..];
            }
            (_, None) => return wrong("several signs $ in a row", "one sign $, or ${ or $( behind them"),
        }
    }
    Ok(out)
}

/// A parameter of a macro.
#[derive(Debug, PartialEq)]
pub(super) struct Parameter<'a> {
    /// With a prefix `*` or `**` for a block.
    pub(super) name: &'a str,
    /// Whether the default is the property of the same name at the call of the macro: `^`.
    pub(super) forwards: bool,
    pub(super) default: Option<&'a str>,
}

/// The parameters that a list of them declares: `name`, `name:=default`, `name:=^`,
/// `name:=^|default`, `*block`, `**block`.
pub(super) fn parameters(list: &str) -> Vec<Parameter<'_>> {
    let mut out = Vec::new();
    let mut rest = list.trim();
    while !rest.is_empty() {
        let (parameter, after) = with_default(rest).unwrap_or_else(|| {
            let (name, after) = rest.split_once(char::is_whitespace).unwrap_or((rest, ""));
            (Parameter { name, forwards: false, default: None }, after)
        });
        out.push(parameter);
        rest = after.trim_start();
    }
    out
}

fn with_default(text: &str) -> Option<(Parameter<'_>, &str)> {
    let length = text.find(|c: char| c.is_whitespace() || c == ':' || c == '=').filter(|length| *length > 0)?;
    let (name, rest) = text.split_at(length);
    let rest = rest.trim_start();
    let rest = rest.strip_prefix(':').unwrap_or(rest).strip_prefix('=')?.trim_start();
    let (forwards, rest) = match rest.strip_prefix("^|").or_else(|| rest.strip_prefix('^')) {
        Some(rest) => (true, rest),
        None => (false, rest),
    };
    let length = default_length(rest)?;
    let (default, after) = rest.split_at(length);
    Some((Parameter { name, forwards, default: Some(default).filter(|default| !default.is_empty()) }, after))
}

/// The length of a default: one expression, or words and quoted texts without a blank between them.
fn default_length(text: &str) -> Option<usize> {
    let ends = |at: usize| text[at..].chars().next().is_none_or(char::is_whitespace);
    for (open, close) in [("${", '}'), ("$(", ')')] {
        if text.starts_with(open)
            && let Some(end) = text.match_indices(close).map(|(at, _)| at + 1).find(|at| ends(*at))
        {
            return Some(end);
        }
    }
    let mut at = 0;
    while let Some(c) = text[at..].chars().next().filter(|c| !c.is_whitespace()) {
        at += match c {
            '\'' | '"' => text[at + 1..].find(c)? + 2,
            c => c.len_utf8(),
        };
    }
    Some(at)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_are_split_as_xacro_splits_them() {
        use Piece::{Expression, Extension, Text};
        let split = |text| pieces(text).ok();
        assert_eq!(split("a ${b + 'c'}d$(arg e)"), Some(vec![Text("a "), Expression("b + 'c'"), Text("d"), Extension("arg e")]));
        assert_eq!(split("$${a} $$$(b)"), Some(vec![Text("${"), Text("a} "), Text("$$("), Text("b)")]));
        assert_eq!(split("5$ and $x$"), Some(vec![Text("5"), Text("$ and "), Text("$x"), Text("$")]));
        assert_eq!(split("é${ü}"), Some(vec![Text("é"), Expression("ü")]));
        assert_eq!(split(""), Some(vec![]));
        for text in ["${a", "$(a}", "$$", "$$a", "a$${"] {
            assert_eq!(split(text).is_none(), text != "a$${", "{text}");
        }
    }

    #[test]
    fn parameters_are_split_as_xacro_splits_them() {
        let list = |text| {
            let shown = |p: Parameter<'_>| {
                format!("{}{}{}", p.name, if p.forwards { "^" } else { "" }, p.default.map(|d| format!("={d}")).unwrap_or_default())
            };
            parameters(text).into_iter().map(shown).collect::<Vec<_>>().join("|")
        };
        assert_eq!(list(" a  b:=1 c=^ d:=^|${x + 1} *e **f "), "a|b=1|c^|d^=${x + 1}|*e|**f");
        assert_eq!(list("a:='0 0 1' b:=\"x y\"z c:=${p}_${q} d:=$(arg x)"), "a='0 0 1'|b=\"x y\"z|c=${p}_${q}|d=$(arg x)");
        assert_eq!(list("a := 5 b:="), "a=5|b");
        assert_eq!(list(""), "");
        assert_eq!(list("a:='x"), "a:='x");
    }
}
