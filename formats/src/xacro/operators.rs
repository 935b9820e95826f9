//! Operators, with their meaning in Python.

use std::cmp::Ordering;

use super::syntax::{Binary, Compare, Unary};
use super::value::{Result, Value, wrong};
use super::work::Work;

/// Maximum number of items of texts and lists.
const MOST_ITEMS: usize = 1 << 20;

pub(super) fn unary(sign: Unary, value: &Value) -> Result<Value> {
    let result = match (sign, value) {
        (Unary::Not, value) => Some(Value::Bool(!value.is_true())),
        (Unary::Minus, Value::Float(value)) => Some(Value::Float(-value)),
        (Unary::Plus, Value::Float(value)) => Some(Value::Float(*value)),
        (sign, value) => value
            .integer()
            .and_then(|value| match sign {
                Unary::Minus => value.checked_neg(),
                Unary::Invert => Some(!value),
                _ => Some(value),
            })
            .map(Value::Int),
    };
    match result {
        Some(value) => Ok(value),
        None => wrong(format!("a sign before {}", value.shown()), "a number"),
    }
}

pub(super) fn binary(operator: Binary, left: &Value, right: &Value, work: &mut Work) -> Result<Value> {
    if let (Some(a), Some(b)) = (left.integer(), right.integer()) {
        return integers(operator, a, b, (left, right));
    }
    if let (Some(a), Some(b)) = (left.number(), right.number()) {
        return numbers(operator, a, b);
    }
    match (operator, left, right) {
        (Binary::Add, Value::Text(a), Value::Text(b)) => {
            work.bytes(a.len() + b.len())?;
            Ok(Value::text(&format!("{a}{b}")))
        }
        (Binary::Add, Value::List(a), Value::List(b)) => {
            work.bytes((a.len() + b.len()) * size_of::<Value>())?;
            Value::list(a.iter().chain(b.iter()).cloned().collect())
        }
        (Binary::Add, Value::Tuple(a), Value::Tuple(b)) => {
            work.bytes((a.len() + b.len()) * size_of::<Value>())?;
            Value::tuple(a.iter().chain(b.iter()).cloned().collect())
        }
        (Binary::Multiply, list, count) if count.integer().is_some() => repeat(list, count, work),
        (Binary::Multiply, count, list) if count.integer().is_some() => repeat(list, count, work),
        (Binary::Remainder, Value::Text(format), values) => {
            let text = formatted(format, values)?;
            work.bytes(text.len())?;
            Ok(Value::text(&text))
        }
        _ => refused(operator, left, right),
    }
}

fn refused<T>(operator: Binary, left: &Value, right: &Value) -> Result<T> {
    wrong(format!("{} {} {}", left.shown(), sign(operator), right.shown()), "operands that Python accepts, as two numbers")
}

fn sign(operator: Binary) -> &'static str {
    match operator {
        Binary::Add => "+",
        Binary::Subtract => "-",
        Binary::Multiply => "*",
        Binary::Divide => "/",
        Binary::FloorDivide => "//",
        Binary::Remainder => "%",
        Binary::Power => "**",
        Binary::BitAnd => "&",
        Binary::BitOr => "|",
        Binary::BitXor => "^",
        Binary::ShiftLeft => "<<",
        Binary::ShiftRight => ">>",
    }
}

fn integers(operator: Binary, a: i128, b: i128, (left, right): (&Value, &Value)) -> Result<Value> {
    let is_truth = matches!((left, right), (Value::Bool(_), Value::Bool(_)));
    let result = match operator {
        Binary::Add => a.checked_add(b),
        Binary::Subtract => a.checked_sub(b),
        Binary::Multiply => a.checked_mul(b),
        Binary::Divide if b != 0 => return Ok(Value::Float(a as f64 / b as f64)),
        Binary::Divide | Binary::FloorDivide | Binary::Remainder if b == 0 => return by_zero(),
        // The quotient is rounded down, and the remainder has the sign of the divisor.
        Binary::FloorDivide => a.checked_div(b).map(|quotient| if a % b != 0 && (a < 0) != (b < 0) { quotient - 1 } else { quotient }),
        Binary::Remainder => a.checked_rem(b).map(|rest| if rest != 0 && (rest < 0) != (b < 0) { rest + b } else { rest }),
        Binary::Power if b < 0 => return numbers(operator, a as f64, b as f64),
        Binary::Power => u32::try_from(b).ok().and_then(|b| a.checked_pow(b)),
        Binary::BitAnd if is_truth => return Ok(Value::Bool(a & b != 0)),
        Binary::BitOr if is_truth => return Ok(Value::Bool(a | b != 0)),
        Binary::BitXor if is_truth => return Ok(Value::Bool(a ^ b != 0)),
        Binary::BitAnd => Some(a & b),
        Binary::BitOr => Some(a | b),
        Binary::BitXor => Some(a ^ b),
        Binary::ShiftLeft => u32::try_from(b).ok().and_then(|b| 1i128.checked_shl(b)).filter(|f| *f > 0).and_then(|f| a.checked_mul(f)),
        Binary::ShiftRight => u32::try_from(b).ok().map(|b| a >> b.min(127)),
        Binary::Divide => None,
    };
    match result {
        Some(value) => Ok(Value::Int(value)),
        None => wrong(format!("{a} {} {b}", sign(operator)), "an integer of at most 127 bits"),
    }
}

fn by_zero<T>() -> Result<T> {
    wrong("a division by zero", "a divisor other than zero")
}

fn numbers(operator: Binary, a: f64, b: f64) -> Result<Value> {
    let result = match operator {
        Binary::Add => a + b,
        Binary::Subtract => a - b,
        Binary::Multiply => a * b,
        Binary::Divide | Binary::FloorDivide | Binary::Remainder if b == 0.0 => return by_zero(),
        Binary::Divide => a / b,
        Binary::FloorDivide => divided(a, b).0,
        Binary::Remainder => divided(a, b).1,
        Binary::Power if a == 0.0 && b < 0.0 => return by_zero(),
        Binary::Power => {
            let value = a.powf(b);
            if a.is_finite() && b.is_finite() && !value.is_finite() {
                return wrong(format!("{a} ** {b}"), "a real number in double precision");
            }
            value
        }
        _ => return refused(operator, &Value::Float(a), &Value::Float(b)),
    };
    Ok(Value::Float(result))
}

/// The quotient, rounded down, and the remainder, with the sign of the divisor.
fn divided(a: f64, b: f64) -> (f64, f64) {
    let mut rest = a % b;
    let mut quotient = (a - rest) / b;
    if rest == 0.0 {
        rest = 0f64.copysign(b);
    } else if (b < 0.0) != (rest < 0.0) {
        rest += b;
        quotient -= 1.0;
    }
    let floor = quotient.floor();
    let rounded = if quotient - floor > 0.5 { floor + 1.0 } else { floor };
    (if quotient == 0.0 { 0f64.copysign(a / b) } else { rounded }, rest)
}

fn repeat(list: &Value, count: &Value, work: &mut Work) -> Result<Value> {
    let times = usize::try_from(count.integer().unwrap_or_default().clamp(0, MOST_ITEMS as i128 + 1)).unwrap_or_default();
    let (length, size) = match list {
        Value::Text(text) => (text.len(), 1),
        Value::List(items) | Value::Tuple(items) => (items.len(), size_of::<Value>()),
        _ => return refused(Binary::Multiply, list, count),
    };
    let total = length.saturating_mul(times);
    if total > MOST_ITEMS {
        return wrong(format!("a repetition of {times} times {length}"), format!("at most {MOST_ITEMS} altogether"));
    }
    work.bytes(total * size)?;
    let items = |items: &[Value]| items.iter().cycle().take(total).cloned().collect();
    match list {
        Value::Text(text) => Ok(Value::text(&text.repeat(times))),
        Value::List(all) => Value::list(items(all)),
        Value::Tuple(all) => Value::tuple(items(all)),
        other => Ok(other.clone()),
    }
}

/// `format % values`, with `%s`, `%r`, `%d`, `%f`, `%e` and `%g`.
fn formatted(format: &str, values: &Value) -> Result<String> {
    let single = [values.clone()];
    let mut values = if let Value::Tuple(all) = values { all.iter() } else { single.iter() };
    let mut out = String::new();
    let mut rest = format;
    while let Some(at) = rest.find('%') {
        out.push_str(&rest[..at]);
        rest = &rest[at + 1..];
        if let Some(after) = rest.strip_prefix('%') {
            out.push('%');
            rest = after;
            continue;
        }
        let end = rest.find(|c: char| !matches!(c, '0'..='9' | '.' | '-' | '+' | ' ')).unwrap_or(rest.len());
        let (flags, letter) = (&rest[..end], rest[end..].chars().next());
        let Some(value) = values.next() else { return wrong("more places than values in a format", "a value for each %") };
        let (Some(letter), Some(spec)) = (letter, Spec::of(flags)) else {
            return wrong(format!("the format %{flags}"), FORMATS);
        };
        out.push_str(&spec.written(letter, value)?);
        rest = &rest[end + letter.len_utf8()..];
    }
    out.push_str(rest);
    match values.next() {
        None => Ok(out),
        Some(_) => wrong("more values than places in a format", "a % for each value"),
    }
}

const FORMATS: &str = "%s, %r, %d, %i, %f or %e, with a width and digits of at most 99";

struct Spec {
    is_left: bool,
    has_zeros: bool,
    has_plus: bool,
    width: usize,
    digits: Option<usize>,
}

impl Spec {
    fn of(flags: &str) -> Option<Self> {
        let numbers = flags.trim_start_matches(['-', '+', ' ', '0']);
        let signs = &flags[..flags.len() - numbers.len()];
        let (width, digits) = numbers.split_once('.').map_or((numbers, None), |(width, digits)| (width, Some(digits)));
        let number = |text: &str| if text.is_empty() { Some(0) } else { text.parse().ok().filter(|n| *n < 100) };
        Some(Self {
            is_left: signs.contains('-'),
            has_zeros: signs.contains('0'),
            has_plus: signs.contains('+'),
            width: number(width)?,
            digits: digits.map(number).map_or(Some(None), |n| n.map(Some))?,
        })
    }

    fn written(&self, letter: char, value: &Value) -> Result<String> {
        let sign = |negative: bool| if negative || !self.has_plus { "" } else { "+" };
        let text = match (letter, value.number()) {
            ('s', _) => value.written(),
            ('r', _) => value.literal(),
            ('d' | 'i', Some(number)) if number.is_finite() => {
                let integer = value.integer().unwrap_or(number.trunc() as i128);
                format!("{}{integer}", sign(integer < 0))
            }
            ('f' | 'F', Some(number)) => format!("{}{number:.*}", sign(number < 0.0), self.digits.unwrap_or(6)),
            ('e', Some(number)) if number.is_finite() => {
                let text = format!("{number:.*e}", self.digits.unwrap_or(6));
                let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
                let exponent: i32 = exponent.parse().unwrap_or_default();
                format!("{}{mantissa}e{}{:02}", sign(number < 0.0), if exponent < 0 { '-' } else { '+' }, exponent.abs())
            }
            _ => return wrong(format!("%{letter} of {}", value.shown()), FORMATS),
        };
        let missing = self.width.saturating_sub(text.chars().count());
        Ok(match (self.is_left, self.has_zeros && value.number().is_some() && letter != 's') {
            (true, _) => text + &" ".repeat(missing),
            (false, false) => " ".repeat(missing) + &text,
            (false, true) => {
                let digits = text.trim_start_matches(['-', '+']);
                format!("{}{}{digits}", &text[..text.len() - digits.len()], "0".repeat(missing))
            }
        })
    }
}

pub(super) fn compare(how: Compare, left: &Value, right: &Value, work: &mut Work) -> Result<bool> {
    work.steps(left.size() + right.size())?;
    let mut count = 0;
    let mut equal = || left.equals_within(right, &mut count);
    let order = || left.order(right);
    let is = || std::mem::discriminant(left) == std::mem::discriminant(right);
    let result = match how {
        Compare::Equal => equal(),
        Compare::NotEqual => !equal(),
        Compare::Less => order()? == Some(Ordering::Less),
        Compare::LessEqual => order()?.is_some_and(Ordering::is_le),
        Compare::Greater => order()? == Some(Ordering::Greater),
        Compare::GreaterEqual => order()?.is_some_and(Ordering::is_ge),
        Compare::In => contains(right, left, work)?,
        Compare::NotIn => !contains(right, left, work)?,
        Compare::Is => is() && equal(),
        Compare::IsNot => !is() || !equal(),
    };
    work.steps(count)?;
    Ok(result)
}

fn contains(all: &Value, one: &Value, work: &mut Work) -> Result<bool> {
    let mut count = 0;
    let result = match (all, one) {
        (Value::Text(all), Value::Text(one)) => Ok(all.contains(&**one)),
        (Value::List(all) | Value::Tuple(all), one) => Ok(all.iter().any(|item| item.equals_within(one, &mut count))),
        (Value::Table(_), key) => Ok(all.entry(key).is_some()),
        _ => wrong(format!("{} in {}", one.shown(), all.shown()), "a list, a dictionary or a text behind in"),
    };
    work.steps(count)?;
    result
}

pub(super) fn index(list: &Value, index: &Value) -> Result<Value> {
    if let Value::Table(_) = list {
        return match list.entry(index) {
            Some(value) => Ok(value.clone()),
            None => wrong(format!("the unknown key {}", index.literal()), "a key of the dictionary"),
        };
    }
    let length = length(list)?;
    let Some(at) = index.integer() else {
        return wrong(format!("{} as an index", index.shown()), "an integer");
    };
    let from_start = if at < 0 { at.saturating_add(length as i128) } else { at };
    let item = usize::try_from(from_start).ok().and_then(|at| match list {
        Value::List(items) | Value::Tuple(items) => items.get(at).cloned(),
        Value::Text(text) => text.chars().nth(at).map(|c| Value::text(c.encode_utf8(&mut [0; 4]))),
        _ => None,
    });
    match item {
        Some(item) => Ok(item),
        None => wrong(format!("the index {at} of {length} items"), "an index below their number"),
    }
}

/// The number of items.
pub(super) fn length(list: &Value) -> Result<usize> {
    match list {
        Value::Text(text) => Ok(text.chars().count()),
        Value::List(items) | Value::Tuple(items) => Ok(items.len()),
        Value::Table(entries) => Ok(entries.len()),
        other => wrong(format!("{} in the place of a list", other.shown()), "a list, a dictionary or a text"),
    }
}

pub(super) fn slice(list: &Value, [from, to, step]: [Option<i128>; 3], work: &mut Work) -> Result<Value> {
    let length = length(list)? as i128;
    work.bytes(length as usize * size_of::<Value>())?;
    let step = step.unwrap_or(1);
    if step == 0 || list.entry(&Value::None).is_some() {
        return wrong("a slice with the step 0", "a step other than zero");
    }
    let (least, most) = if step > 0 { (0, length) } else { (-1, length - 1) };
    let bound = |given: Option<i128>, default: i128| {
        given.map_or(default, |at| if at < 0 { at.saturating_add(length) } else { at }.clamp(least, most))
    };
    let (mut at, end) = if step > 0 { (bound(from, 0), bound(to, length)) } else { (bound(from, length - 1), bound(to, -1)) };
    let mut places = Vec::new();
    while if step > 0 { at < end } else { at > end } {
        places.push(at as usize);
        at = at.saturating_add(step);
    }
    match list {
        Value::Text(text) => {
            let all: Vec<char> = text.chars().collect();
            Ok(Value::text(&places.iter().filter_map(|at| all.get(*at)).collect::<String>()))
        }
        Value::List(items) => Value::list(places.iter().filter_map(|at| items.get(*at).cloned()).collect()),
        Value::Tuple(items) => Value::tuple(places.iter().filter_map(|at| items.get(*at).cloned()).collect()),
        other => wrong(format!("a slice of {}", other.shown()), "a list or a text"),
    }
}
