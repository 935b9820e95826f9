//! Functions and methods that expressions may call.

use std::rc::Rc;

use super::operators::length;
use super::value::{Result, Value, read_float, read_integer, wrong};
use super::work::Names;

/// The arguments of a call.
pub(super) struct Arguments {
    pub(super) values: Vec<Value>,
    pub(super) named: Vec<(Rc<str>, Value)>,
}

/// Functions of Python, also of the module `python`.
const PYTHON: [&str; 23] = [
    "abs",
    "all",
    "any",
    "bool",
    "dict",
    "divmod",
    "enumerate",
    "float",
    "int",
    "isinstance",
    "len",
    "list",
    "map",
    "max",
    "min",
    "range",
    "repr",
    "reversed",
    "round",
    "sorted",
    "str",
    "sum",
    "tuple",
];

/// One more of Python: it does not fit into the line above.
const ZIP: &str = "zip";

/// Functions of xacro, also of the module `xacro`; those after the first four only there.
const XACRO: [&str; 10] =
    ["load_yaml", "abs_filename", "dotify", "tokenize", "arg", "message", "warning", "error", "fatal", "print_location"];

type Real = fn(f64) -> f64;

/// Functions of the module `math` of one number.
const MATH: [(&str, Real); 22] = [
    ("sin", f64::sin),
    ("cos", f64::cos),
    ("tan", f64::tan),
    ("asin", f64::asin),
    ("acos", f64::acos),
    ("atan", f64::atan),
    ("sinh", f64::sinh),
    ("cosh", f64::cosh),
    ("tanh", f64::tanh),
    ("asinh", f64::asinh),
    ("acosh", f64::acosh),
    ("atanh", f64::atanh),
    ("sqrt", f64::sqrt),
    ("cbrt", f64::cbrt),
    ("exp", f64::exp),
    ("expm1", f64::exp_m1),
    ("log10", f64::log10),
    ("log2", f64::log2),
    ("log1p", f64::ln_1p),
    ("fabs", f64::abs),
    ("radians", |x| x * (std::f64::consts::PI / 180.0)),
    ("degrees", |x| x * (180.0 / std::f64::consts::PI)),
];

/// Further ones.
const MATH_OTHER: [&str; 13] =
    ["atan2", "hypot", "pow", "log", "floor", "ceil", "trunc", "fmod", "copysign", "isnan", "isinf", "isfinite", "fsum"];

const CONSTANTS: [(&str, f64); 5] =
    [("pi", std::f64::consts::PI), ("e", std::f64::consts::E), ("tau", std::f64::consts::TAU), ("inf", f64::INFINITY), ("nan", f64::NAN)];

const MODULES: [&str; 3] = ["math", "python", "xacro"];

/// Names of Python that every file has without a module.
const GLOBAL: [&str; 15] =
    ["list", "dict", "map", "len", "str", "float", "int", "True", "False", "min", "max", "round", "sorted", "range", "python"];

/// Names of the module `math` that are not implemented, but reserved.
const MATH_UNREAD: [&str; 23] = [
    "comb",
    "dist",
    "erf",
    "erfc",
    "exp2",
    "factorial",
    "fma",
    "frexp",
    "gamma",
    "gcd",
    "isclose",
    "isqrt",
    "lcm",
    "ldexp",
    "lgamma",
    "modf",
    "nextafter",
    "perm",
    "prod",
    "remainder",
    "sumprod",
    "ulp",
    "math",
];

/// Whether the name is built in, so that a property of this name replaces it: builtins, all of the
/// module `math`, and some of xacro's own.
pub(super) fn is_of_every_file(name: &str) -> bool {
    let own = || name == "xacro" || XACRO[..3].contains(&name);
    GLOBAL.contains(&name) || MATH_UNREAD.contains(&name) || of_module("math", name).is_some() || own()
}

/// The built-in meaning of a name, without a property of this name.
pub(super) fn global(name: &str) -> Option<Value> {
    let module = MODULES.iter().find(|module| **module == name).map(|module| Value::Builtin(module));
    module.or_else(|| of_module("python", name)).or_else(|| of_module("math", name)).or_else(|| {
        let own = XACRO[..4].contains(&name);
        own.then(|| of_module("xacro", name)).flatten()
    })
}

/// A function or a constant of a module.
pub(super) fn of_module(module: &str, name: &str) -> Option<Value> {
    let find = |names: &[&'static str]| names.iter().find(|own| **own == name).map(|own| Value::Builtin(own));
    match module {
        "python" => find(&PYTHON).or_else(|| find(&[ZIP])),
        "xacro" => find(&XACRO),
        "math" => {
            let constant = CONSTANTS.iter().find(|(own, _)| *own == name).map(|(_, value)| Value::Float(*value));
            constant.or_else(|| MATH.iter().find(|(own, _)| *own == name).map(|(own, _)| Value::Builtin(own))).or_else(|| find(&MATH_OTHER))
        }
        _ => None,
    }
}

const TEXT_METHODS: [&str; 13] =
    ["lower", "upper", "strip", "lstrip", "rstrip", "split", "replace", "startswith", "endswith", "join", "capitalize", "title", "count"];
const TABLE_METHODS: [&str; 4] = ["get", "keys", "values", "items"];
const LIST_METHODS: [&str; 2] = ["index", "count"];

/// A method of a value.
pub(super) fn method(value: &Value, name: &Rc<str>) -> Result<Value> {
    let known: &[&str] = match value {
        Value::Text(_) => &TEXT_METHODS,
        Value::Table(_) => &TABLE_METHODS,
        Value::List(_) | Value::Tuple(_) => &LIST_METHODS,
        _ => &[],
    };
    if known.contains(&&**name) {
        return Ok(Value::Method(Rc::new(value.clone()), name.clone()));
    }
    let expected = match (value, known) {
        (Value::Table(_), _) => "a key of the dictionary".to_owned(),
        (_, []) => "a dictionary, a list or a text before the point".to_owned(),
        _ => format!("one of {}", known.join(", ")),
    };
    wrong(format!("the unknown name {name:?} of {}", value.kind()), expected)
}

/// The items of a list, the keys of a dictionary, or the characters of a text.
pub(super) fn items(list: &Value) -> Result<Vec<Value>> {
    match list {
        Value::List(items) | Value::Tuple(items) => Ok(items.to_vec()),
        Value::Table(entries) => Ok(entries.iter().map(|(key, _)| key.clone()).collect()),
        Value::Text(text) => Ok(text.chars().map(|c| Value::text(c.encode_utf8(&mut [0; 4]))).collect()),
        other => wrong(format!("{} in the place of a list", other.shown()), "a list, a dictionary or a text"),
    }
}

/// The result of a call.
pub(super) fn call(function: &Value, arguments: Arguments, names: &mut dyn Names) -> Result<Value> {
    let work: usize = arguments.values.iter().map(Value::size).sum();
    names.work().steps(work)?;
    names.work().bytes(arguments.values.iter().map(weight).sum())?;
    match function {
        Value::Builtin(name) if *name == "dict" => dictionary(&arguments),
        Value::Method(value, name) => {
            no_names(name, &arguments)?;
            names.work().steps(value.size())?;
            call_method(value, name, &arguments.values, names)
        }
        Value::Builtin(name) => {
            let mut arguments = arguments;
            // The location in a message is always printed.
            arguments.named.retain(|(key, _)| !(matches!(&**key, "print_location" | "file") && XACRO.contains(name)));
            if *name != "sorted" {
                no_names(name, &arguments)?;
            }
            call_builtin(name, &arguments, names)
        }
        other => wrong(format!("a call of {}", other.shown()), "a function before the brackets"),
    }
}

/// Upper bound on the bytes of a list of a value's items.
pub(super) fn weight(value: &Value) -> usize {
    match value {
        // Each character is a text of its own.
        Value::Text(text) => text.len() * 64,
        value => value.size() * size_of::<(Value, Value)>(),
    }
}

fn no_names(function: &str, arguments: &Arguments) -> Result<()> {
    match arguments.named.first() {
        None => Ok(()),
        Some((name, _)) => wrong(format!("the argument {name} = of {function}"), "arguments without names"),
    }
}

fn dictionary(arguments: &Arguments) -> Result<Value> {
    let mut entries: Vec<(Value, Value)> = Vec::new();
    if let Some(first) = arguments.values.first() {
        if let Value::Table(own) = first {
            entries.extend(own.iter().cloned());
        } else {
            for pair in items(first)? {
                let pair = items(&pair)?;
                let [key, value] = pair.as_slice() else { return wrong("dict of a list of other than pairs", "pairs of key and value") };
                entries.push((key.clone(), value.clone()));
            }
        }
    }
    for (name, value) in &arguments.named {
        let key = Value::Text(name.clone());
        entries.retain(|(known, _)| !known.equals(&key));
        entries.push((key, value.clone()));
    }
    Value::table(entries)
}

fn call_builtin(name: &'static str, arguments: &Arguments, names: &mut dyn Names) -> Result<Value> {
    let values = arguments.values.as_slice();
    if let Some((_, function)) = MATH.iter().find(|(own, _)| *own == name) {
        let [x] = numbers(name, values)?;
        return result_of_math(name, &[x], function(x));
    }
    if MATH_OTHER.contains(&name) {
        return call_math(name, values);
    }
    if XACRO.contains(&name) {
        return call_xacro(name, values, names);
    }
    call_python(name, arguments, names)
}

fn numbers<const N: usize>(function: &str, values: &[Value]) -> Result<[f64; N]> {
    let numbers: Vec<f64> = values.iter().filter_map(Value::number).collect();
    match numbers.try_into() {
        Ok(numbers) if values.len() == N => Ok(numbers),
        _ => wrong(called(function, values), format!("{N} number{}", if N == 1 { "" } else { "s" })),
    }
}

fn called(function: &str, values: &[Value]) -> String {
    let shown: Vec<String> = values.iter().take(4).map(Value::shown).collect();
    let more = if values.len() > 4 { ", …" } else { "" };
    format!("{function} of {}{more}", if shown.is_empty() { "nothing".to_owned() } else { shown.join(", ") })
}

/// As in Python, undefined results are errors.
fn result_of_math(name: &str, arguments: &[f64], value: f64) -> Result<Value> {
    if !value.is_finite() && arguments.iter().all(|x| x.is_finite()) {
        let shown: Vec<String> = arguments.iter().map(f64::to_string).collect();
        return wrong(format!("{name}({})", shown.join(", ")), "an argument for which the function has a finite value");
    }
    Ok(Value::Float(value))
}

fn call_math(name: &str, values: &[Value]) -> Result<Value> {
    let two = |function: fn(f64, f64) -> f64| {
        let [x, y] = numbers(name, values)?;
        result_of_math(name, &[x, y], function(x, y))
    };
    let rounded = |function: fn(f64) -> f64| {
        if let [Value::Int(value)] = values {
            return Ok(Value::Int(*value));
        }
        let [x] = numbers(name, values)?;
        integer_of(name, function(x))
    };
    let test = |function: fn(f64) -> bool| numbers(name, values).map(|[x]| Value::Bool(function(x)));
    match name {
        "atan2" => two(f64::atan2),
        "pow" => two(f64::powf),
        "fmod" => two(|x, y| x % y),
        "copysign" => two(f64::copysign),
        "hypot" => {
            let all: Option<Vec<f64>> = values.iter().map(Value::number).collect();
            match all.as_deref() {
                Some([x, y]) => result_of_math(name, &[*x, *y], x.hypot(*y)),
                Some(all) => result_of_math(name, all, all.iter().fold(0.0, |sum: f64, x| sum.hypot(*x))),
                None => wrong(called(name, values), "numbers"),
            }
        }
        "log" if values.len() == 1 => {
            let [x] = numbers(name, values)?;
            result_of_math(name, &[x], x.ln())
        }
        "log" => two(|x, base| x.ln() / base.ln()),
        "floor" => rounded(f64::floor),
        "ceil" => rounded(f64::ceil),
        "trunc" => rounded(f64::trunc),
        "isnan" => test(f64::is_nan),
        "isinf" => test(f64::is_infinite),
        "isfinite" => test(f64::is_finite),
        _ => sum(name, values, Value::Float(0.0)),
    }
}

fn sum(name: &str, values: &[Value], start: Value) -> Result<Value> {
    let [list] = values else { return wrong(called(name, values), "one list of numbers") };
    let mut total = start;
    for item in items(list)? {
        total = match (total.integer(), item.integer(), total.number(), item.number()) {
            (Some(a), Some(b), ..) => match a.checked_add(b) {
                Some(total) => Value::Int(total),
                None => return wrong("a sum of very large integers", "at most 127 bits"),
            },
            (_, _, Some(a), Some(b)) => Value::Float(a + b),
            _ => return wrong(called(name, values), "a list of numbers"),
        };
    }
    Ok(total)
}

/// The integer equal to a number without a fractional part.
fn integer_of(name: &str, value: f64) -> Result<Value> {
    const MOST: f64 = 1e36;
    if value.abs() < MOST { Ok(Value::Int(value as i128)) } else { wrong(format!("{name} of {value}"), "a number below 1e36") }
}

fn call_python(name: &'static str, arguments: &Arguments, names: &mut dyn Names) -> Result<Value> {
    let values = arguments.values.as_slice();
    match (name, values) {
        ("bool", [value]) => Ok(Value::Bool(value.is_true())),
        ("str", []) => Ok(Value::text("")),
        ("str", [value]) => written(&value.written(), names),
        ("repr", [value]) => written(&value.literal(), names),
        ("len", [value]) => Ok(Value::Int(length(value)? as i128)),
        ("list", []) => Value::list(Vec::new()),
        ("list", [value]) => Value::list(items(value)?),
        ("tuple", [value]) => Value::tuple(items(value)?),
        ("reversed", [value]) => Value::list(items(value)?.into_iter().rev().collect()),
        ("all", [value]) => Ok(Value::Bool(items(value)?.iter().all(Value::is_true))),
        ("any", [value]) => Ok(Value::Bool(items(value)?.iter().any(Value::is_true))),
        ("sum", _) => sum(name, values, Value::Int(0)),
        ("int" | "float", [value]) => number(name, value),
        ("abs", [Value::Float(value)]) => Ok(Value::Float(value.abs())),
        ("abs", [value]) if value.integer().is_some() => match value.integer().and_then(i128::checked_abs) {
            Some(value) => Ok(Value::Int(value)),
            None => wrong("abs of a very large integer", "at most 127 bits"),
        },
        ("round", [value]) => match value {
            Value::Float(value) => integer_of(name, value.round_ties_even()),
            _ => value.integer().map_or_else(|| wrong(called(name, values), "a number"), |value| Ok(Value::Int(value))),
        },
        ("round", [value, digits]) => match (value.number(), digits.integer()) {
            (Some(_), Some(_)) if value.integer().is_some() => Ok(value.clone()),
            (Some(value), Some(digits @ 0..=300)) => Ok(Value::Float(format!("{value:.*}", digits as usize).parse().unwrap_or(value))),
            _ => wrong(called(name, values), "a number, and at most 300 digits"),
        },
        ("min" | "max", [list]) => extreme(name, &items(list)?),
        ("min" | "max", all) => extreme(name, all),
        ("range", _) => range(values, names),
        ("sorted", [list]) => sorted(&items(list)?, &arguments.named, names),
        ("map", [function, list]) => {
            let mut out = Vec::new();
            for item in items(list)? {
                names.work().steps(1)?;
                let arguments = Arguments { values: vec![item], named: Vec::new() };
                // A function that calls others again would nest endlessly.
                if matches!(function, Value::Builtin("map")) {
                    return wrong("map of map", "a function of one value");
                }
                out.push(call(function, arguments, names)?);
            }
            Value::list(out)
        }
        ("enumerate", [list]) => {
            let pairs = items(list)?.into_iter().enumerate().map(|(i, item)| Value::tuple(vec![Value::Int(i as i128), item]));
            Value::list(pairs.collect::<Result<_>>()?)
        }
        ("zip", lists) => zip(lists),
        ("divmod", [a, b]) => {
            use super::syntax::Binary;
            let quotient = super::operators::binary(Binary::FloorDivide, a, b, names.work())?;
            let rest = super::operators::binary(Binary::Remainder, a, b, names.work())?;
            Value::tuple(vec![quotient, rest])
        }
        ("isinstance", [value, Value::Builtin(kind)]) => Ok(Value::Bool(match *kind {
            "str" => matches!(value, Value::Text(_)),
            "int" => matches!(value, Value::Int(_) | Value::Bool(_)),
            "float" => matches!(value, Value::Float(_)),
            "bool" => matches!(value, Value::Bool(_)),
            "list" => matches!(value, Value::List(_)),
            "tuple" => matches!(value, Value::Tuple(_)),
            "dict" => matches!(value, Value::Table(_)),
            _ => false,
        })),
        _ => wrong(called(name, values), "arguments as in Python"),
    }
}

fn written(text: &str, names: &mut dyn Names) -> Result<Value> {
    names.work().bytes(text.len())?;
    Ok(Value::text(text))
}

fn number(name: &str, value: &Value) -> Result<Value> {
    let number = match (name, value) {
        ("int", Value::Text(text)) => read_integer(text).map(Value::Int),
        ("int", Value::Float(value)) if value.is_finite() => return integer_of(name, value.trunc()),
        ("int", value) => value.integer().map(Value::Int),
        (_, Value::Text(text)) => read_float(&text.replace('_', "")).map(Value::Float),
        (_, value) => value.number().map(Value::Float),
    };
    number.map_or_else(|| wrong(format!("{name} of {}", value.shown()), "a number"), Ok)
}

fn extreme(name: &str, all: &[Value]) -> Result<Value> {
    let Some(mut best) = all.first() else { return wrong(format!("{name} of nothing"), "at least one value") };
    let wanted = if name == "min" { std::cmp::Ordering::Less } else { std::cmp::Ordering::Greater };
    for one in &all[1..] {
        if one.order(best)? == Some(wanted) {
            best = one;
        }
    }
    Ok(best.clone())
}

fn range(values: &[Value], names: &mut dyn Names) -> Result<Value> {
    const MOST: usize = 100_000;
    let bounds: Option<Vec<i128>> = values.iter().map(Value::integer).collect();
    let (from, to, step) = match bounds.as_deref() {
        Some([to]) => (0, *to, 1),
        Some([from, to]) => (*from, *to, 1),
        Some([from, to, step]) if *step != 0 => (*from, *to, *step),
        _ => return wrong(called("range", values), "one to three integers, with a step other than zero"),
    };
    let (mut at, mut out) = (from, Vec::new());
    while if step > 0 { at < to } else { at > to } {
        if out.len() >= MOST {
            return wrong("a range of very many integers", format!("at most {MOST}"));
        }
        out.push(Value::Int(at));
        at = at.saturating_add(step);
    }
    names.work().bytes(out.len() * size_of::<Value>())?;
    Value::list(out)
}

fn sorted(all: &[Value], named: &[(Rc<str>, Value)], names: &mut dyn Names) -> Result<Value> {
    let mut is_reversed = false;
    for (name, value) in named {
        match &**name {
            "reverse" => is_reversed = value.is_true(),
            other => return wrong(format!("the argument {other} = of sorted"), "reverse ="),
        }
    }
    names.work().steps(all.iter().map(|one| 1 + one.size()).sum::<usize>() * 20)?;
    // All comparisons in advance: a comparison cannot fail inside a sort.
    for pair in all.windows(2) {
        pair[0].order(&pair[1])?;
    }
    let mut all = all.to_vec();
    all.sort_by(|a, b| a.order(b).ok().flatten().unwrap_or(std::cmp::Ordering::Equal));
    if is_reversed {
        all.reverse();
    }
    Value::list(all)
}

fn zip(lists: &[Value]) -> Result<Value> {
    let lists: Vec<Vec<Value>> = lists.iter().map(items).collect::<Result<_>>()?;
    let length = lists.iter().map(Vec::len).min().unwrap_or_default();
    let row = |i: usize| Value::tuple(lists.iter().filter_map(|list| list.get(i).cloned()).collect());
    Value::list((0..length).map(row).collect::<Result<_>>()?)
}

fn call_xacro(name: &str, values: &[Value], names: &mut dyn Names) -> Result<Value> {
    let words = || values.iter().map(Value::written).collect::<Vec<_>>().join(" ");
    match (name, values) {
        ("load_yaml", [Value::Text(file)]) => names.load_yaml(file),
        ("abs_filename", [Value::Text(file)]) => written(&names.file_name(file), names),
        ("dotify", [table @ Value::Table(_)]) => Ok(table.clone()),
        ("arg", [Value::Text(argument)]) => names.argument(argument),
        ("tokenize", [Value::Text(text)]) => tokens(text, &[',', ';', ' ']),
        ("tokenize", [Value::Text(text), Value::Text(signs)]) => tokens(text, &signs.chars().collect::<Vec<_>>()),
        ("fatal", _) => wrong(format!("the message of the file: {}", words()), "a file that accepts its arguments"),
        ("warning" | "error" | "message", _) => {
            names.message(words(), name != "message");
            Ok(Value::text(""))
        }
        ("print_location", _) => Ok(Value::text("")),
        _ => wrong(called(name, values), "arguments as in xacro"),
    }
}

fn tokens(text: &str, signs: &[char]) -> Result<Value> {
    Value::list(text.split(signs).filter(|word| !word.is_empty()).map(Value::text).collect())
}

fn call_method(value: &Value, name: &str, arguments: &[Value], names: &mut dyn Names) -> Result<Value> {
    match (value, name, arguments) {
        (Value::Table(_), "get", [key]) => Ok(value.entry(key).cloned().unwrap_or(Value::None)),
        (Value::Table(_), "get", [key, default]) => Ok(value.entry(key).unwrap_or(default).clone()),
        (Value::Table(_), "keys", []) => Value::list(items(value)?),
        (Value::Table(entries), "values", []) => Value::list(entries.iter().map(|(_, value)| value.clone()).collect()),
        (Value::Table(entries), "items", []) => {
            let pairs = entries.iter().map(|(key, value)| Value::tuple(vec![key.clone(), value.clone()]));
            Value::list(pairs.collect::<Result<_>>()?)
        }
        (Value::List(items) | Value::Tuple(items), "index", [one]) => {
            let mut count = 0;
            let at = items.iter().position(|item| item.equals_within(one, &mut count));
            names.work().steps(count)?;
            match at {
                Some(at) => Ok(Value::Int(at as i128)),
                None => wrong(format!("{}, which is not in the list", one.shown()), "an item of the list"),
            }
        }
        (Value::List(items) | Value::Tuple(items), "count", [one]) => {
            let mut count = 0;
            let equal = items.iter().filter(|item| item.equals_within(one, &mut count)).count();
            names.work().steps(count)?;
            Ok(Value::Int(equal as i128))
        }
        (Value::Text(text), ..) => text_method(text, name, arguments, names),
        _ => wrong(called(name, arguments), "arguments as in Python"),
    }
}

fn text_method(text: &str, name: &str, arguments: &[Value], names: &mut dyn Names) -> Result<Value> {
    let signs = |arguments: &[Value]| match arguments {
        [Value::Text(signs)] => Some(signs.chars().collect::<Vec<_>>()),
        _ => None,
    };
    let result = match (name, arguments) {
        ("lower", []) => text.to_lowercase(),
        ("upper", []) => text.to_uppercase(),
        ("capitalize", []) => {
            let mut characters = text.chars();
            characters.next().map_or(String::new(), |c| c.to_uppercase().collect::<String>() + &characters.as_str().to_lowercase())
        }
        ("strip", []) => text.trim().to_owned(),
        ("lstrip", []) => text.trim_start().to_owned(),
        ("rstrip", []) => text.trim_end().to_owned(),
        ("strip" | "lstrip" | "rstrip", other) => match signs(other).as_deref() {
            Some(signs) if name == "strip" => text.trim_matches(signs).to_owned(),
            Some(signs) if name == "lstrip" => text.trim_start_matches(signs).to_owned(),
            Some(signs) => text.trim_end_matches(signs).to_owned(),
            None => return wrong(called(name, other), "a text"),
        },
        ("replace", [Value::Text(from), Value::Text(to)]) => {
            let count = if from.is_empty() { text.chars().count() + 1 } else { text.matches(&**from).count() };
            names.work().bytes(count.saturating_mul(to.len()))?;
            text.replace(&**from, to)
        }
        ("join", [list]) => {
            let mut out = String::new();
            for (i, item) in items(list)?.iter().enumerate() {
                let Value::Text(item) = item else { return wrong(called(name, arguments), "a list of texts") };
                names.work().bytes(text.len() + item.len())?;
                out.push_str(if i == 0 { "" } else { text });
                out.push_str(item);
            }
            out
        }
        ("startswith", [Value::Text(start)]) => return Ok(Value::Bool(text.starts_with(&**start))),
        ("endswith", [Value::Text(end)]) => return Ok(Value::Bool(text.ends_with(&**end))),
        ("count", [Value::Text(part)]) if !part.is_empty() => return Ok(Value::Int(text.matches(&**part).count() as i128)),
        ("split", []) => {
            names.work().bytes(text.len() * 32)?;
            return Value::list(text.split_whitespace().map(Value::text).collect());
        }
        ("split", [Value::Text(sign)]) if !sign.is_empty() => {
            names.work().bytes(text.matches(&**sign).count() * 64)?;
            return Value::list(text.split(&**sign).map(Value::text).collect());
        }
        _ => return wrong(called(name, arguments), "arguments as in Python"),
    };
    written(&result, names)
}
