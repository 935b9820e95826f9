//! TOML to a tree.

use articulated_core::diagnostic::{At, Code, Diagnostics};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::tree::{Entry, Node, Value};

/// Maximum size of a scene, bytes: tables of torques included.
const LARGEST: usize = 16 << 20;

/// The file's table; `None` if it is not TOML.
pub(crate) fn parse(text: &str, log: &mut Diagnostics) -> Option<Node> {
    if text.len() > LARGEST {
        log.error((At::Nowhere, ""), Code::Syntax, format!("{} bytes", text.len()), format!("a scene, of {LARGEST} bytes at most"));
        return None;
    }
    let lines = Lines::of(text);
    let (table, errors) = DeTable::parse_recoverable(text);
    let told = errors.iter().map(|error| {
        let at = error.span().map_or(At::Nowhere, |span| lines.at(span.start));
        (at, error.message().lines().next().unwrap_or_default())
    });
    let mut told: Vec<(At, &str)> = told.collect();
    told.dedup();
    for (at, message) in told {
        log.error((at, ""), Code::Syntax, format!("what is not TOML ({message})"), "");
    }
    errors.is_empty().then(|| Node { at: At::line_of(1), value: Value::Table(entries(table.get_ref(), &lines)) })
}

fn entries(table: &DeTable<'_>, lines: &Lines<'_>) -> Vec<Entry> {
    let mut entries: Vec<(usize, Entry)> = table
        .iter()
        .map(|(name, value)| {
            let at = lines.at(name.span().start);
            (name.span().start, Entry { name: name.get_ref().to_string(), at, node: node(value, at, lines) })
        })
        .collect();
    entries.sort_by_key(|(start, _)| *start);
    entries.into_iter().map(|(_, entry)| entry).collect()
}

/// `at`: the place of the key; a value on another line has its own.
fn node(value: &Spanned<DeValue<'_>>, at: At, lines: &Lines<'_>) -> Node {
    let own = lines.at(value.span().start);
    let value = match value.get_ref() {
        DeValue::String(text) => Value::Text(text.to_string()),
        DeValue::Integer(n) => Value::Number(integer(n.as_str(), n.radix())),
        DeValue::Float(x) => Value::Number(x.as_str().replace('_', "").parse().unwrap_or(f64::NAN)),
        DeValue::Boolean(b) => Value::Bool(*b),
        DeValue::Datetime(date) => Value::Other(format!("the date {date}")),
        DeValue::Array(list) => {
            return Node { at: own, value: Value::List(list.iter().map(|one| node(one, item(one, own, lines), lines)).collect()) };
        }
        // A table under a header has its header's place, or that of its first key.
        DeValue::Table(table) => return Node { at, value: Value::Table(entries(table, lines)) },
    };
    Node { at: own, value }
}

/// The place of an item of a list that begins at `list`.
fn item(value: &Spanned<DeValue<'_>>, list: At, lines: &Lines<'_>) -> At {
    lines.at(value.span().start).max(list)
}

/// The double nearest to an integer of any length.
fn integer(digits: &str, radix: u32) -> f64 {
    let digits = digits.replace('_', "");
    match radix {
        10 => digits.parse().unwrap_or(f64::NAN),
        _ => i128::from_str_radix(&digits, radix).map_or(f64::NAN, |n| n as f64),
    }
}

/// Starts of the lines of a text.
struct Lines<'a> {
    text: &'a str,
    starts: Vec<usize>,
}

impl<'a> Lines<'a> {
    fn of(text: &'a str) -> Self {
        let breaks = text.bytes().enumerate().filter(|(_, b)| *b == b'\n').map(|(i, _)| i + 1);
        Self { text, starts: std::iter::once(0).chain(breaks).collect() }
    }

    /// The place of a byte.
    fn at(&self, offset: usize) -> At {
        let line = self.starts.partition_point(|start| *start <= offset).max(1);
        let start = self.starts[line - 1];
        // A long line is not counted again for each of its numbers.
        let column = match offset - start {
            0..MOST_COLUMNS => self.text.get(start..offset).map_or(0, |text| text.chars().count() + 1),
            _ => 0,
        };
        At::Text { line: u32::try_from(line).unwrap_or(u32::MAX), column: column as u32 }
    }
}

/// Columns beyond this are not counted, bytes.
const MOST_COLUMNS: usize = 1000;

#[cfg(test)]
mod tests {
    use super::*;

    /// 10⁵ doubles of any size, each in the shortest spelling and in 17 digits.
    #[test]
    fn toml_is_read_to_the_nearest_double() {
        let mut bits = 0x9e37_79b9_7f4a_7c15_u64;
        let doubles = std::iter::repeat_with(|| {
            bits = bits.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            f64::from_bits(bits)
        });
        let doubles: Vec<f64> = doubles.filter(|x| x.is_finite()).take(100_000).collect();
        let list = |spelling: fn(&f64) -> String| doubles.iter().map(spelling).collect::<Vec<_>>().join(",");
        let text = format!("a = [{}]\nb = [{}]", list(|x| format!("{x:?}")), list(|x| format!("{x:.16e}")));
        let mut log = Diagnostics::new("s.toml");
        let Some(Node { value: Value::Table(entries), .. }) = parse(&text, &mut log) else { panic!("no table") };
        for entry in entries {
            let Value::List(list) = entry.node.value else { panic!("no list") };
            assert_eq!(list.len(), doubles.len());
            for (node, x) in list.iter().zip(&doubles) {
                assert!(matches!(node.value, Value::Number(y) if y.to_bits() == x.to_bits()), "{x:e}: {:?}", node.value);
            }
        }
        // Integers beyond 2⁵³ too, rounded to the nearest double.
        let Some(Node { value: Value::Table(entries), .. }) = parse("a = 9007199254740993", &mut log) else { panic!("no table") };
        assert_eq!(entries[0].node.value, Value::Number(9_007_199_254_740_992.0));
    }
}
