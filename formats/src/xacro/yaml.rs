//! A reader of the part of YAML that files of properties use: block and flow mappings and
//! sequences, plain and quoted scalars, comments, anchors, and the units `!degrees`, `!radians`,
//! `!meters`, `!millimeters`, `!foot` and `!inches`. Scalars have the types of YAML 1.1, which
//! xacro reads. Block scalars, merge keys and several documents are errors with their line.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

use super::syntax::coded;
use super::value::{Result, Value, wrong};

/// Maximum number of values of a file, and their maximum depth.
const MOST_VALUES: usize = 200_000;
const MOST_DEPTH: usize = 24;

/// The error of a document, and its line.
pub(super) struct Fault {
    pub(super) line: u32,
    pub(super) fault: super::value::Fault,
}

/// A number with a unit: its text, and the factor to SI units.
pub(super) type Unit<'a> = &'a mut dyn FnMut(&str) -> Result<f64>;

/// The value of a document, and the lines of duplicate keys of mappings, with the keys. `number`
/// evaluates the expression of a number with a unit.
pub(super) fn read(text: &str, number: Unit<'_>) -> std::result::Result<(Value, Vec<(u32, String)>), Fault> {
    let mut reader = Reader { lines: lines(text), at: 0, values: 0, anchors: BTreeMap::new(), number, line: 0, again: Vec::new() };
    let value = reader.document();
    value.map(|value| (value, reader.again)).map_err(|fault| Fault { line: reader.line, fault })
}

/// A line with something in it.
struct Line<'a> {
    number: u32,
    indent: usize,
    text: &'a str,
}

fn lines(text: &str) -> Vec<Line<'_>> {
    let mut out = Vec::new();
    for (number, line) in (1..).zip(text.lines()) {
        let body = without_comment(line).trim_end();
        let content = body.trim_start_matches(' ');
        if !content.is_empty() {
            out.push(Line { number, indent: body.len() - content.len(), text: content });
        }
    }
    out
}

/// A line up to a `#` that is at its start or after a blank, outside quotation marks.
fn without_comment(line: &str) -> &str {
    let mut quote = None;
    let mut before = ' ';
    for (at, c) in line.char_indices() {
        match quote {
            Some(mark) if c == mark && (mark == '\'' || before != '\\') => quote = None,
            Some(_) => {}
            // A quotation mark within a word is part of it.
            None if matches!(c, '"' | '\'') && matches!(before, ' ' | '[' | '{' | ',' | ':') => quote = Some(c),
            None if c == '#' && before.is_whitespace() => return &line[..at],
            None => {}
        }
        before = c;
    }
    line
}

struct Reader<'a, 'b> {
    lines: Vec<Line<'a>>,
    at: usize,
    values: usize,
    anchors: BTreeMap<&'a str, Value>,
    number: Unit<'b>,
    /// The line that is read.
    line: u32,
    /// Keys that their mappings have already.
    again: Vec<(u32, String)>,
}

impl<'a> Reader<'a, '_> {
    fn document(&mut self) -> Result<Value> {
        if self.lines.first().is_some_and(|line| line.text.starts_with('%')) {
            self.line = self.lines[0].number;
            return wrong("a directive of YAML", "a document without directives");
        }
        if self.lines.first().is_some_and(|line| line.text == "---") {
            self.at = 1;
        }
        let Some(first) = self.lines.get(self.at) else { return Ok(Value::None) };
        let value = self.block(first.indent, 0)?;
        match self.lines.get(self.at) {
            None => Ok(value),
            Some(line) => {
                self.line = line.number;
                match line.text {
                    "..." if self.at + 1 == self.lines.len() => Ok(value),
                    "---" | "..." => wrong("a second document", "one document"),
                    _ => wrong("a line that belongs to nothing before it", "the indentation of the lines before it"),
                }
            }
        }
    }

    fn count(&mut self) -> Result<()> {
        self.values += 1;
        if self.values > MOST_VALUES { wrong("very many values", format!("at most {MOST_VALUES}")) } else { Ok(()) }
    }

    /// The value of the lines from here on that have this indentation.
    fn block(&mut self, indent: usize, depth: usize) -> Result<Value> {
        self.count()?;
        let Some(line) = self.lines.get(self.at) else { return Ok(Value::None) };
        self.line = line.number;
        let text = line.text;
        if depth > MOST_DEPTH {
            return wrong("values nested very deeply", format!("at most {MOST_DEPTH} levels"));
        }
        if text.starts_with('\t') {
            return wrong("a tab before a value", "blanks");
        }
        if text == "-" || text.starts_with("- ") {
            return self.sequence(indent, depth);
        }
        if split_key(text).is_some() {
            return self.mapping(indent, depth);
        }
        self.at += 1;
        self.scalar_or_flow(text, depth)
    }

    fn sequence(&mut self, indent: usize, depth: usize) -> Result<Value> {
        let mut items = Vec::new();
        while let Some(line) = self.lines.get(self.at) {
            if line.indent != indent || !(line.text == "-" || line.text.starts_with("- ")) {
                break;
            }
            self.line = line.number;
            let rest = line.text[1..].trim_start_matches(' ');
            let inner = indent + line.text.len() - rest.len();
            if !rest.is_empty() && (rest.starts_with("- ") || rest == "-" || split_key(rest).is_some()) {
                // The rest of the line begins a block of its own.
                let number = line.number;
                self.lines[self.at] = Line { number, indent: inner, text: rest };
                items.push(self.block(inner, depth + 1)?);
            } else {
                self.at += 1;
                items.push(self.entry(rest, indent, depth)?);
            }
        }
        Value::list(items)
    }

    fn mapping(&mut self, indent: usize, depth: usize) -> Result<Value> {
        let mut entries: Vec<(Value, Value)> = Vec::new();
        let mut known: BTreeMap<String, usize> = BTreeMap::new();
        while let Some(line) = self.lines.get(self.at) {
            if line.indent != indent || line.text == "-" || line.text.starts_with("- ") {
                break;
            }
            self.line = line.number;
            let Some((key, rest)) = split_key(line.text) else {
                return wrong("a line without a key", "KEY: VALUE");
            };
            if key == "<<" {
                return wrong("a merge key", "the keys themselves");
            }
            self.at += 1;
            let key = self.scalar(key)?;
            let line = self.line;
            let value = self.entry(rest, indent, depth)?;
            // The last value counts.
            match known.entry(key.literal()) {
                Entry::Occupied(place) => {
                    self.again.push((line, key.literal()));
                    entries[*place.get()].1 = value;
                }
                Entry::Vacant(place) => {
                    place.insert(entries.len());
                    entries.push((key, value));
                }
            }
        }
        Value::table(entries)
    }

    /// A value behind a key or a dash: on the line, or in the lines below.
    fn entry(&mut self, text: &'a str, indent: usize, depth: usize) -> Result<Value> {
        if depth > MOST_DEPTH {
            return wrong("values nested very deeply", format!("at most {MOST_DEPTH} levels"));
        }
        if let Some(rest) = text.strip_prefix('&') {
            let (name, rest) = rest.split_once(' ').unwrap_or((rest, ""));
            let value = self.entry(rest.trim_start(), indent, depth + 1)?;
            self.anchors.insert(name, value.clone());
            return Ok(value);
        }
        if !text.is_empty() {
            return self.scalar_or_flow(text, depth);
        }
        match self.lines.get(self.at) {
            Some(next) if next.indent > indent => self.block(next.indent, depth + 1),
            // A sequence below a key may have the key's indentation.
            Some(next) if next.indent == indent && (next.text == "-" || next.text.starts_with("- ")) => {
                let is_item = self.at.checked_sub(1).is_some_and(|before| self.lines[before].text.starts_with('-'));
                if is_item { Ok(Value::None) } else { self.block(indent, depth + 1) }
            }
            _ => Ok(Value::None),
        }
    }

    /// A scalar, or a flow value that may continue on the lines below.
    fn scalar_or_flow(&mut self, text: &'a str, depth: usize) -> Result<Value> {
        if text.starts_with(['|', '>']) {
            return wrong("a block scalar", "a text in quotation marks");
        }
        if !text.starts_with(['[', '{']) {
            return self.scalar(text);
        }
        let mut whole = text.to_owned();
        let mut open = Open::default();
        open.read(text);
        while !open.is_closed() {
            let Some(next) = self.lines.get(self.at) else { return wrong("a bracket that is not closed", "its closing bracket") };
            whole.push(' ');
            whole.push_str(next.text);
            open.read(next.text);
            self.at += 1;
        }
        let mut rest = whole.as_str();
        let value = self.flow(&mut rest, depth)?;
        if rest.trim().is_empty() { Ok(value) } else { wrong("text behind a closing bracket", "the end of the line") }
    }

    fn flow(&mut self, rest: &mut &str, depth: usize) -> Result<Value> {
        self.count()?;
        if depth > MOST_DEPTH {
            return wrong("values nested very deeply", format!("at most {MOST_DEPTH} levels"));
        }
        *rest = rest.trim_start();
        let close = match rest.chars().next() {
            Some('[') => ']',
            Some('{') => '}',
            _ => return self.flow_scalar(rest),
        };
        *rest = rest[1..].trim_start();
        let (mut items, mut entries) = (Vec::new(), Vec::new());
        while !rest.starts_with(close) {
            let first = self.flow(rest, depth + 1)?;
            *rest = rest.trim_start();
            if close == '}' {
                let Some(after) = rest.strip_prefix(':') else { return wrong("a key without a value", "KEY: VALUE") };
                *rest = after;
                let value = self.flow(rest, depth + 1)?;
                *rest = rest.trim_start();
                entries.push((first, value));
            } else {
                items.push(first);
            }
            match rest.strip_prefix(',') {
                Some(after) => *rest = after.trim_start(),
                None if rest.starts_with(close) => {}
                None => return wrong("values without a comma between them", "a comma, or the closing bracket"),
            }
        }
        *rest = &rest[1..];
        if close == '}' { Value::table(entries) } else { Value::list(items) }
    }

    fn flow_scalar(&mut self, rest: &mut &str) -> Result<Value> {
        let length = match rest.chars().next() {
            Some(mark @ ('"' | '\'')) => match quoted_length(rest, mark) {
                Some(length) => length,
                None => return wrong("a text without its closing quotation mark", format!("the sign {mark}")),
            },
            _ => {
                let is_end = |(at, c): (usize, char)| {
                    matches!(c, ',' | ']' | '}' | '[' | '{') || c == ':' && rest[at + 1..].starts_with([' ', ',', ']', '}'])
                };
                rest.char_indices().find(|one| is_end(*one)).map_or(rest.len(), |(at, _)| at)
            }
        };
        let (word, after) = rest.split_at(length);
        *rest = after;
        if word.is_empty() && (after.starts_with('[') || after.is_empty()) {
            return wrong("no value", "a value");
        }
        self.scalar(word.trim())
    }

    fn scalar(&mut self, text: &str) -> Result<Value> {
        self.count()?;
        match text.chars().next() {
            Some('!') => self.tagged(text),
            Some('*') => match self.anchors.get(text[1..].trim()) {
                Some(value) => Ok(value.clone()),
                None => wrong(format!("the unknown anchor {text}"), "one that is defined before"),
            },
            Some(mark @ ('"' | '\'')) => match quoted_length(text, mark) {
                Some(length) if length == text.len() => Ok(Value::text(&unquoted(&text[1..length - 1], mark)?)),
                _ => wrong(text, format!("one text between two signs {mark}")),
            },
            Some('%' | '@' | '`') => wrong(text, "a value, or a text in quotation marks"),
            _ if text.contains(": ") => wrong("a second colon in a line", "KEY: VALUE"),
            _ => Ok(plain(text)),
        }
    }

    fn tagged(&mut self, text: &str) -> Result<Value> {
        use std::f64::consts::PI;
        const UNITS: [(&str, f64); 6] = [
            ("!radians", 1.0),
            ("!degrees", PI / 180.0),
            ("!meters", 1.0),
            ("!millimeters", 0.001),
            ("!foot", 0.3048),
            ("!inches", 0.0254),
        ];
        let (tag, rest) = text.split_once(' ').unwrap_or((text, ""));
        let rest = rest.trim();
        if let Some((_, factor)) = UNITS.iter().find(|(name, _)| *name == tag) {
            let inner = match self.scalar(rest)? {
                Value::Text(text) => text.to_string(),
                _ => rest.to_owned(),
            };
            return Ok(Value::Float((self.number)(&inner)? * factor));
        }
        match tag {
            "!!str" => Ok(Value::text(rest)),
            "!!float" => match self.scalar(rest)?.number() {
                Some(value) => Ok(Value::Float(value)),
                None => wrong(rest, "a number"),
            },
            "!!int" => self.scalar(rest),
            _ => wrong(format!("the tag {tag}"), UNITS.map(|(name, _)| name).join(", ")),
        }
    }
}

/// The key of a line, and what follows its colon.
fn split_key(text: &str) -> Option<(&str, &str)> {
    let key = match text.chars().next()? {
        mark @ ('"' | '\'') => quoted_length(text, mark)?,
        '[' | '{' | '&' | '*' | '!' | '|' | '>' => return None,
        _ => text.char_indices().find(|(at, c)| *c == ':' && matches!(text.as_bytes().get(at + 1), None | Some(b' ' | b'\t')))?.0,
    };
    let rest = text[key..].trim_start().strip_prefix(':')?;
    (rest.is_empty() || rest.starts_with([' ', '\t'])).then(|| (text[..key].trim_end(), rest.trim()))
}

/// The length of a quoted text, with its quotation marks.
fn quoted_length(text: &str, mark: char) -> Option<usize> {
    let bytes = text.as_bytes();
    let mut at = 1;
    while at < bytes.len() {
        match bytes[at] {
            b'\\' if mark == '"' => at += 2,
            b'\'' if mark == '\'' && bytes.get(at + 1) == Some(&b'\'') => at += 2,
            byte if byte == mark as u8 => return Some(at + 1),
            _ => at += 1,
        }
    }
    None
}

fn unquoted(text: &str, mark: char) -> Result<String> {
    if mark == '\'' {
        return Ok(text.replace("''", "'"));
    }
    let mut out = String::new();
    let mut rest = text;
    while let Some((before, after)) = rest.split_once('\\') {
        out.push_str(before);
        let Some(first) = after.chars().next() else { break };
        let length = match first {
            'x' => coded(after, 1, (2, 16), &mut out)?,
            'u' => coded(after, 1, (4, 16), &mut out)?,
            'U' => coded(after, 1, (8, 16), &mut out)?,
            _ => {
                let Some((_, c)) = ESCAPES.iter().find(|(own, _)| *own == first) else {
                    return wrong(format!("the text \\{first}"), "a backslash before one of YAML's letters");
                };
                out.push(*c);
                first.len_utf8()
            }
        };
        rest = &after[length..];
    }
    out.push_str(rest);
    Ok(out)
}

/// The character after a backslash, and its meaning.
const ESCAPES: [(char, char); 18] = [
    ('0', '\0'),
    ('a', '\u{7}'),
    ('b', '\u{8}'),
    ('t', '\t'),
    ('\t', '\t'),
    ('n', '\n'),
    ('v', '\u{b}'),
    ('f', '\u{c}'),
    ('r', '\r'),
    ('e', '\u{1b}'),
    (' ', ' '),
    ('"', '"'),
    ('/', '/'),
    ('\\', '\\'),
    ('N', '\u{85}'),
    ('_', '\u{a0}'),
    ('L', '\u{2028}'),
    ('P', '\u{2029}'),
];

/// The open brackets and the open quotation mark of a flow value.
#[derive(Default)]
struct Open {
    depth: usize,
    quote: Option<char>,
}

impl Open {
    fn read(&mut self, text: &str) {
        for c in text.chars() {
            match (self.quote, c) {
                (Some(mark), c) => self.quote = Some(mark).filter(|mark| *mark != c),
                (None, '"' | '\'') => self.quote = Some(c),
                (None, '[' | '{') => self.depth += 1,
                (None, ']' | '}') => self.depth = self.depth.saturating_sub(1),
                _ => {}
            }
        }
    }

    fn is_closed(&self) -> bool {
        self.depth == 0 && self.quote.is_none()
    }
}

/// A plain scalar, with its type in YAML 1.1.
fn plain(text: &str) -> Value {
    match text {
        "" | "~" | "null" | "Null" | "NULL" => return Value::None,
        "yes" | "Yes" | "YES" | "true" | "True" | "TRUE" | "on" | "On" | "ON" => return Value::Bool(true),
        "no" | "No" | "NO" | "false" | "False" | "FALSE" | "off" | "Off" | "OFF" => return Value::Bool(false),
        ".nan" | ".NaN" | ".NAN" => return Value::Float(f64::NAN),
        _ => {}
    }
    let number = integer(text).map(Value::Int).or_else(|| float(text).map(Value::Float)).or_else(|| sexagesimal(text));
    number.unwrap_or_else(|| Value::text(text))
}

/// A number to base 60: 1:30 is 90, and 1:30.5 is 90.5.
fn sexagesimal(text: &str) -> Option<Value> {
    let (sign, digits) = match text.strip_prefix('-') {
        Some(digits) => (-1, digits),
        None => (1, text.strip_prefix('+').unwrap_or(text)),
    };
    let (whole, fraction) = digits.split_once('.').map_or((digits, None), |(whole, fraction)| (whole, Some(fraction)));
    let (first, rest) = whole.split_once(':')?;
    // Digits and `_` after a digit; without a fraction not after a zero.
    let is_first = first.starts_with(|c: char| c.is_ascii_digit() && (c != '0' || fraction.is_some()));
    let all_digits = |text: &str| text.bytes().all(|b| b.is_ascii_digit() || b == b'_');
    if !is_first || !all_digits(first) || !fraction.is_none_or(all_digits) {
        return None;
    }
    let mut sum: i128 = first.replace('_', "").parse().ok()?;
    for part in rest.split(':') {
        let digit: i128 = Some(part).filter(|p| matches!(p.len(), 1..=2) && p.bytes().all(|b| b.is_ascii_digit()))?.parse().ok()?;
        sum = sum.checked_mul(60)?.checked_add(Some(digit).filter(|d| *d < 60)?)?;
    }
    Some(match fraction {
        None => Value::Int(sign * sum),
        Some(fraction) => {
            let rest: f64 = format!("0.{}", fraction.replace('_', "")).parse().ok()?;
            Value::Float(sign as f64 * (sum as f64 + rest))
        }
    })
}

fn integer(text: &str) -> Option<i128> {
    let (sign, digits) = match text.as_bytes().first()? {
        b'-' => (-1, &text[1..]),
        b'+' => (1, &text[1..]),
        _ => (1, text),
    };
    if !digits.starts_with(|c: char| c.is_ascii_digit()) {
        return None;
    }
    let plain = digits.replace('_', "");
    let radix = |digits: &str, radix| if digits.starts_with(['+', '-']) { None } else { i128::from_str_radix(digits, radix).ok() };
    let value = match plain.as_str() {
        "0" => Some(0),
        hexadecimal if hexadecimal.starts_with("0x") => radix(&hexadecimal[2..], 16),
        binary if binary.starts_with("0b") => radix(&binary[2..], 2),
        octal if octal.starts_with('0') => radix(&octal[1..], 8),
        decimal => radix(decimal, 10),
    };
    value.map(|value| sign * value)
}

/// A number with a point; an exponent needs its sign.
fn float(text: &str) -> Option<f64> {
    let digits = text.strip_prefix(['+', '-']).unwrap_or(text);
    if digits.eq_ignore_ascii_case(".inf") {
        return Some(if text.starts_with('-') { f64::NEG_INFINITY } else { f64::INFINITY });
    }
    let is_plain = digits.bytes().all(|b| matches!(b, b'0'..=b'9' | b'_' | b'.' | b'e' | b'E' | b'+' | b'-'));
    let (mantissa, exponent) = digits.split_once(['e', 'E']).map_or((digits, None), |(mantissa, exponent)| (mantissa, Some(exponent)));
    let has_sign = exponent.is_none_or(|exponent| exponent.starts_with(['+', '-']));
    if !is_plain || !mantissa.contains('.') || mantissa.contains(['+', '-']) || mantissa.starts_with('_') || !has_sign {
        return None;
    }
    text.replace('_', "").parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(text: &str) -> String {
        match read(text, &mut |text| super::super::value::read_float(text).map_or_else(|| wrong(text, "a number"), Ok)) {
            Ok((value, again)) => {
                format!("{}{}", value.literal(), again.iter().map(|(line, key)| format!(" {line} {key}")).collect::<String>())
            }
            Err(fault) => format!("line {}: {:?}", fault.line, fault.fault),
        }
    }

    #[test]
    fn blocks_flows_and_scalars_have_the_types_of_yaml_1_1() {
        let text = "# limits\n---\njoint_limits:\n  shoulder: {min: !degrees -180.0, max: 2.5, has: true}\n  'el bow':\n    - 1\n    - 2.\n\
                    \x20   - [a, \"b c\", 'd''e']\nlist:\n- x: 1\n  y: 1e-3\n- ~\n-\n  z: 1.0e+3 # end\nempty:\nanchor: &a 0x1F\nalias: *a\nu: a#b\n";
        let expected = "{'joint_limits': {'shoulder': {'min': -3.141592653589793, 'max': 2.5, 'has': True}, 'el bow': [1, 2.0, ['a', 'b c', \"d'e\"]]}, \
                        'list': [{'x': 1, 'y': '1e-3'}, None, {'z': 1000.0}], 'empty': None, 'anchor': 31, 'alias': 31, 'u': 'a#b'}";
        assert_eq!(value(text), expected);
        assert_eq!(value(""), "None");
        assert_eq!(value("a: 1\nb: 2\na: 3"), "{'a': 3, 'b': 2} 3 'a'");
        assert_eq!(value("[1, [2,\n 3]]"), "[1, [2, 3]]");
        assert_eq!(value("a: 012\nb: 1_000\nc: off\nd: .inf\ne: 1:30"), "{'a': 10, 'b': 1000, 'c': False, 'd': inf, 'e': 90}");
        // As PyYAML reads them.
        assert_eq!(value("[1:30.5, -2:00:01, 1:60, 0:30, a:30]"), "[90.5, -7201, '1:60', '0:30', 'a:30']");
    }

    #[test]
    fn what_is_not_read_is_an_error_with_its_line() {
        for (text, line) in [
            ("a: 1\nb: |\n  text", 2),
            ("a: 1\n  b: 2", 2),
            ("a: [1, 2", 1),
            ("a: !unknown 1", 1),
            ("a:\n  - 1\n b: 2", 3),
            ("a: 'b", 1),
            ("a: *b", 1),
            ("x: {a: 1\nb", 1),
            ("a: 1\n---\nb: 2", 2),
        ] {
            let found = value(text);
            assert!(found.starts_with(&format!("line {line}: ")), "{text}: {found}");
        }
    }

    #[test]
    fn nesting_is_bounded() {
        assert!(value(&"[".repeat(100_000)).starts_with("line 1"));
        assert!(value(&("[".repeat(5000) + &"]".repeat(5000))).contains("deeply"));
        assert!(value(&"- ".repeat(5000)).contains("deeply"));
        assert!(value(&("a: ".to_owned() + &"&a ".repeat(5000))).contains("deeply"));
    }
}
