//! The grammar of expressions: a part of Python's.

use std::rc::Rc;

use super::value::{Result, Value, wrong};

/// Maximum length of an expression, bytes, and maximum depth.
const MOST_BYTES: usize = 64 << 10;
const MOST_DEPTH: usize = 48;

#[derive(Clone, Debug)]
pub(super) enum Expression {
    Constant(Value),
    Name(Rc<str>),
    List(Vec<Expression>),
    Tuple(Vec<Expression>),
    Table(Vec<(Expression, Expression)>),
    /// A list with an expression for each value of others.
    Each(Box<Each>),
    Unary(Unary, Box<Expression>),
    Binary(Binary, Box<[Expression; 2]>),
    /// The first one, and further ones, each with its comparison to the previous one.
    Compare(Box<Expression>, Vec<(Compare, Expression)>),
    And(Vec<Expression>),
    Or(Vec<Expression>),
    /// Condition, value if it holds, value if not.
    If(Box<[Expression; 3]>),
    Attribute(Box<Expression>, Rc<str>),
    Index(Box<[Expression; 2]>),
    Slice(Box<Expression>, [Option<Box<Expression>>; 3]),
    /// The function, its arguments, and those with names.
    Call(Box<Expression>, Vec<Expression>, Vec<(Rc<str>, Expression)>),
}

/// `item for names in source if condition`.
#[derive(Clone, Debug)]
pub(super) struct Each {
    pub(super) item: Expression,
    /// In a dictionary the value; the item is the key.
    pub(super) value: Option<Expression>,
    pub(super) names: Vec<Rc<str>>,
    pub(super) source: Expression,
    pub(super) conditions: Vec<Expression>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Unary {
    Minus,
    Plus,
    Not,
    Invert,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Binary {
    Add,
    Subtract,
    Multiply,
    Divide,
    FloorDivide,
    Remainder,
    Power,
    BitAnd,
    BitOr,
    BitXor,
    ShiftLeft,
    ShiftRight,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Compare {
    Equal,
    NotEqual,
    Less,
    LessEqual,
    Greater,
    GreaterEqual,
    In,
    NotIn,
    Is,
    IsNot,
}

#[derive(Clone, Debug, PartialEq)]
enum Token {
    Int(i128),
    Float(f64),
    Text(String),
    Name(String),
    Sign(&'static str),
}

/// Signs, longer ones first.
const SIGNS: [&str; 35] = [
    "**", "//", "<<", ">>", "<=", ">=", "==", "!=", "->", ":=", "+", "-", "*", "/", "%", "(", ")", "[", "]", "{", "}", ",", ":", ".", "<",
    ">", "&", "|", "^", "~", "=", "@", ";", "!", "?",
];

pub(super) const KEYWORDS: [&str; 12] = ["and", "or", "not", "if", "else", "in", "is", "for", "lambda", "True", "False", "None"];

/// The expression that a text spells.
pub(super) fn parse(text: &str) -> Result<Expression> {
    if text.len() > MOST_BYTES {
        return wrong(format!("an expression of {} bytes", text.len()), format!("at most {MOST_BYTES}"));
    }
    let mut parser = Parser { tokens: tokens(text)?, at: 0, depth: 0, terms: 0 };
    let all = parser.tuple()?;
    match parser.peek() {
        None => Ok(all),
        Some(token) => wrong(shown(token), "an operator, or the end of the expression"),
    }
}

fn shown(token: &Token) -> String {
    match token {
        Token::Int(value) => format!("the number {value}"),
        Token::Float(value) => format!("the number {value}"),
        Token::Text(text) => format!("the text {text:?}"),
        Token::Name(name) => format!("the word {name:?}"),
        Token::Sign(sign) => format!("the sign {sign:?}"),
    }
}

fn tokens(text: &str) -> Result<Vec<Token>> {
    let mut out = Vec::new();
    let mut rest = text.trim();
    while let Some(first) = rest.chars().next() {
        if first.is_whitespace() {
            rest = &rest[first.len_utf8()..];
        } else if first.is_ascii_digit() || first == '.' && rest[1..].starts_with(|c: char| c.is_ascii_digit()) {
            let length = number_length(rest);
            out.push(number(&rest[..length])?);
            rest = &rest[length..];
        } else if first == '"' || first == '\'' {
            let (token, length) = string(rest, first, false)?;
            out.push(Token::Text(token));
            rest = &rest[length..];
        } else if let Some(mark) = rest[first.len_utf8()..].chars().next().filter(|c| matches!(c, '"' | '\'') && "uUrRbBfF".contains(first))
        {
            let is_raw = match first {
                'u' | 'U' => false,
                'r' | 'R' => true,
                _ => return wrong(format!("the text {first}{mark}…{mark}"), "a text in quotation marks, with u, r or nothing before it"),
            };
            let (token, length) = string(&rest[1..], mark, is_raw)?;
            out.push(Token::Text(token));
            rest = &rest[1 + length..];
        } else if first.is_alphabetic() || first == '_' {
            let length = rest.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(rest.len());
            out.push(Token::Name(rest[..length].to_owned()));
            rest = &rest[length..];
        } else if let Some(sign) = SIGNS.iter().find(|sign| rest.starts_with(**sign)) {
            out.push(Token::Sign(sign));
            rest = &rest[sign.len()..];
        } else {
            return wrong(format!("the sign {first:?}"), "an expression of Python");
        }
    }
    Ok(out)
}

fn number_length(text: &str) -> usize {
    let bytes = text.as_bytes();
    let mut end = 0;
    while let Some(byte) = bytes.get(end) {
        let is_sign = matches!(byte, b'+' | b'-') && end > 0 && matches!(bytes[end - 1], b'e' | b'E') && !text.starts_with("0x");
        if !(byte.is_ascii_alphanumeric() || matches!(byte, b'.' | b'_') || is_sign) {
            break;
        }
        end += 1;
    }
    end
}

fn number(word: &str) -> Result<Token> {
    let radix = |digits: &str, radix| i128::from_str_radix(&digits.replace('_', ""), radix).ok().map(Token::Int);
    let token = match word.get(..2) {
        Some("0x" | "0X") => radix(&word[2..], 16),
        Some("0o" | "0O") => radix(&word[2..], 8),
        Some("0b" | "0B") => radix(&word[2..], 2),
        _ => {
            let has_zero = word.len() > 1 && word.starts_with('0') && word.bytes().any(|b| b != b'0' && b != b'_');
            let integer = super::value::read_integer(word).filter(|_| !has_zero).map(Token::Int);
            integer
                .or_else(|| super::value::read_float(&word.replace('_', "")).filter(|_| word.contains(['.', 'e', 'E'])).map(Token::Float))
        }
    };
    match token {
        Some(token) => Ok(token),
        None => wrong(format!("{word:?}"), "a number as Python writes it"),
    }
}

/// A text in quotation marks, and its number of bytes. In a raw text, backslashes are plain
/// characters.
fn string(rest: &str, mark: char, is_raw: bool) -> Result<(String, usize)> {
    let mut out = String::new();
    let mut at = mark.len_utf8();
    while let Some(c) = rest[at..].chars().next() {
        at += c.len_utf8();
        if c == mark {
            return Ok((out, at));
        }
        match (c, rest[at..].chars().next()) {
            ('\\', Some(next)) if is_raw => {
                out.extend(['\\', next]);
                at += next.len_utf8();
            }
            ('\\', Some(_)) => at += escape(&rest[at..], &mut out)?,
            _ => out.push(c),
        }
    }
    wrong("a text without its closing quotation mark", format!("the sign {mark}"))
}

/// The escape after a backslash, as in Python, and its number of bytes in `rest`.
fn escape(rest: &str, out: &mut String) -> Result<usize> {
    let Some(first) = rest.chars().next() else { return Ok(0) };
    let plain = match first {
        '\n' => None,
        '\\' | '\'' | '"' => Some(first),
        'a' => Some('\u{7}'),
        'b' => Some('\u{8}'),
        'f' => Some('\u{c}'),
        'n' => Some('\n'),
        'r' => Some('\r'),
        't' => Some('\t'),
        'v' => Some('\u{b}'),
        'x' => return coded(rest, 1, (2, 16), out),
        'u' => return coded(rest, 1, (4, 16), out),
        'U' => return coded(rest, 1, (8, 16), out),
        '0'..='7' => {
            let length = rest.bytes().take(3).take_while(|b| (b'0'..=b'7').contains(b)).count();
            return coded(rest, 0, (length, 8), out);
        }
        'N' => return wrong("\\N, the name of a character", "the character, or its number: \\u and four digits"),
        other => {
            out.extend(['\\', other]);
            return Ok(other.len_utf8());
        }
    };
    out.extend(plain);
    Ok(first.len_utf8())
}

/// The character of a number of `count` digits, after `before` bytes.
pub(super) fn coded(rest: &str, before: usize, (count, radix): (usize, u32), out: &mut String) -> Result<usize> {
    let digits = rest.get(before..before + count).filter(|digits| digits.bytes().all(|b| char::from(b).is_digit(radix)));
    match digits.and_then(|digits| char::from_u32(u32::from_str_radix(digits, radix).ok()?)) {
        Some(c) => {
            out.push(c);
            Ok(before + count)
        }
        None => {
            let found: String = rest.chars().take(before + count).collect();
            wrong(format!("the text \\{found}"), format!("the number of a character, of {count} digits"))
        }
    }
}

struct Parser {
    tokens: Vec<Token>,
    at: usize,
    depth: usize,
    terms: usize,
}

impl Parser {
    fn peek(&self) -> Option<&Token> {
        self.tokens.get(self.at)
    }

    fn is_sign(&self, sign: &str) -> bool {
        matches!(self.peek(), Some(Token::Sign(own)) if *own == sign)
    }

    fn is_word(&self, word: &str) -> bool {
        matches!(self.peek(), Some(Token::Name(own)) if own == word)
    }

    fn take(&mut self, sign: &str) -> bool {
        let is_it = self.is_sign(sign);
        self.at += usize::from(is_it);
        is_it
    }

    fn take_word(&mut self, word: &str) -> bool {
        let is_it = self.is_word(word);
        self.at += usize::from(is_it);
        is_it
    }

    fn expect(&mut self, sign: &str) -> Result<()> {
        if self.take(sign) {
            return Ok(());
        }
        wrong(self.peek().map_or_else(|| "the end of the expression".to_owned(), shown), format!("the sign {sign:?}"))
    }

    /// One expression, or several with commas between them.
    fn tuple(&mut self) -> Result<Expression> {
        let first = self.expression()?;
        if !self.is_sign(",") {
            return Ok(first);
        }
        let mut all = vec![first];
        while self.take(",") {
            if self.peek().is_none() || self.is_sign(")") || self.is_sign("]") {
                break;
            }
            all.push(self.expression()?);
        }
        Ok(Expression::Tuple(all))
    }

    fn expression(&mut self) -> Result<Expression> {
        self.depth += 1;
        if self.depth > MOST_DEPTH {
            return wrong("an expression nested very deeply", format!("at most {MOST_DEPTH} levels"));
        }
        let value = self.disjunction()?;
        let result = if self.take_word("if") {
            let condition = self.disjunction()?;
            if !self.take_word("else") {
                return wrong("a condition without else", "VALUE if CONDITION else VALUE");
            }
            Expression::If(Box::new([condition, value, self.expression()?]))
        } else {
            value
        };
        self.depth -= 1;
        Ok(result)
    }

    fn disjunction(&mut self) -> Result<Expression> {
        let mut all = vec![self.conjunction()?];
        while self.take_word("or") {
            all.push(self.conjunction()?);
        }
        Ok(if all.len() == 1 { all.remove(0) } else { Expression::Or(all) })
    }

    fn conjunction(&mut self) -> Result<Expression> {
        let mut all = vec![self.negation()?];
        while self.take_word("and") {
            all.push(self.negation()?);
        }
        Ok(if all.len() == 1 { all.remove(0) } else { Expression::And(all) })
    }

    fn negation(&mut self) -> Result<Expression> {
        let mut count = 0;
        while self.take_word("not") {
            count += 1;
        }
        let mut result = self.comparison()?;
        // Two negations give a truth value, as one does.
        for _ in 0..if count > 2 { 2 - count % 2 } else { count } {
            result = Expression::Unary(Unary::Not, Box::new(result));
        }
        Ok(result)
    }

    fn comparison(&mut self) -> Result<Expression> {
        let first = self.binary(0)?;
        let mut rest = Vec::new();
        while let Some(how) = self.comparator() {
            rest.push((how, self.binary(0)?));
        }
        Ok(if rest.is_empty() { first } else { Expression::Compare(Box::new(first), rest) })
    }

    fn comparator(&mut self) -> Option<Compare> {
        const SIGNS: [(&str, Compare); 6] = [
            ("==", Compare::Equal),
            ("!=", Compare::NotEqual),
            ("<=", Compare::LessEqual),
            (">=", Compare::GreaterEqual),
            ("<", Compare::Less),
            (">", Compare::Greater),
        ];
        if let Some((_, how)) = SIGNS.iter().find(|(sign, _)| self.take(sign)) {
            return Some(*how);
        }
        if self.take_word("in") {
            return Some(Compare::In);
        }
        if self.take_word("is") {
            return Some(if self.take_word("not") { Compare::IsNot } else { Compare::Is });
        }
        let is_next = matches!(self.tokens.get(self.at + 1), Some(Token::Name(word)) if word == "in");
        if is_next && self.take_word("not") {
            self.at += 1;
            return Some(Compare::NotIn);
        }
        None
    }

    /// Operators from a level of [`LEVELS`] on, from left to right.
    fn binary(&mut self, level: usize) -> Result<Expression> {
        let Some(operators) = LEVELS.get(level) else { return self.unary() };
        let mut result = self.binary(level + 1)?;
        while let Some((_, operator)) = operators.iter().find(|(sign, _)| self.take(sign)) {
            self.terms += 1;
            if self.terms > MOST_TERMS {
                return wrong("an expression of very many terms", format!("at most {MOST_TERMS}"));
            }
            let right = self.binary(level + 1)?;
            result = Expression::Binary(*operator, Box::new([result, right]));
        }
        Ok(result)
    }

    fn unary(&mut self) -> Result<Expression> {
        const SIGNS: [(&str, Unary); 3] = [("-", Unary::Minus), ("+", Unary::Plus), ("~", Unary::Invert)];
        let mut signs = Vec::new();
        while let Some((_, sign)) = SIGNS.iter().find(|(sign, _)| self.take(sign)) {
            signs.push(*sign);
            if signs.len() > MOST_DEPTH {
                return wrong("very many signs before a value", format!("at most {MOST_DEPTH}"));
            }
        }
        let mut result = self.power()?;
        for sign in signs.into_iter().rev() {
            result = Expression::Unary(sign, Box::new(result));
        }
        Ok(result)
    }

    fn power(&mut self) -> Result<Expression> {
        let base = self.postfix()?;
        if !self.take("**") {
            return Ok(base);
        }
        self.depth += 1;
        if self.depth > MOST_DEPTH {
            return wrong("an expression nested very deeply", format!("at most {MOST_DEPTH} levels"));
        }
        let exponent = self.unary()?;
        self.depth -= 1;
        Ok(Expression::Binary(Binary::Power, Box::new([base, exponent])))
    }

    fn postfix(&mut self) -> Result<Expression> {
        let mut result = self.atom()?;
        let mut count = 0;
        loop {
            count += 1;
            if count > MOST_DEPTH {
                return wrong("very many calls, indices and attributes of one value", format!("at most {MOST_DEPTH}"));
            }
            if self.take(".") {
                let Some(Token::Name(name)) = self.peek() else {
                    return wrong("a point without a name behind it", "the name of an attribute");
                };
                result = Expression::Attribute(Box::new(result), name.as_str().into());
                self.at += 1;
            } else if self.take("(") {
                result = self.call(result)?;
            } else if self.take("[") {
                result = self.index(result)?;
            } else {
                return Ok(result);
            }
        }
    }

    fn call(&mut self, function: Expression) -> Result<Expression> {
        let (mut arguments, mut named) = (Vec::new(), Vec::new());
        while !self.take(")") {
            let name = match (self.peek(), self.tokens.get(self.at + 1)) {
                (Some(Token::Name(name)), Some(Token::Sign("="))) => Some(Rc::from(name.as_str())),
                _ => None,
            };
            match name {
                Some(name) => {
                    self.at += 2;
                    named.push((name, self.expression()?));
                }
                None => {
                    let argument = self.expression()?;
                    arguments.push(self.each(argument, None)?);
                }
            }
            if !self.is_sign(")") {
                self.expect(",")?;
            }
        }
        Ok(Expression::Call(Box::new(function), arguments, named))
    }

    fn index(&mut self, list: Expression) -> Result<Expression> {
        let mut parts: [Option<Box<Expression>>; 3] = [None, None, None];
        let mut part = 0;
        loop {
            if self.take("]") {
                break;
            }
            if self.take(":") {
                part += 1;
                if part > 2 {
                    return wrong("a slice of more than three parts", "[FROM:TO:STEP]");
                }
            } else if parts[part].is_none() {
                parts[part] = Some(Box::new(self.tuple()?));
            } else {
                self.expect("]")?;
                break;
            }
        }
        match (part, parts) {
            (0, [Some(index), ..]) => Ok(Expression::Index(Box::new([list, *index]))),
            (0, _) => wrong("an empty pair of brackets", "an index"),
            (_, parts) => Ok(Expression::Slice(Box::new(list), parts)),
        }
    }

    /// An expression for each value of others, where `for` follows the item.
    fn each(&mut self, item: Expression, value: Option<Expression>) -> Result<Expression> {
        if !self.take_word("for") {
            return Ok(item);
        }
        let mut names = Vec::new();
        loop {
            let Some(Token::Name(name)) = self.peek() else { return wrong("for without a name", "for NAME in LIST") };
            names.push(Rc::from(name.as_str()));
            self.at += 1;
            if !self.take(",") {
                break;
            }
        }
        if !self.take_word("in") {
            return wrong("for without in", "for NAME in LIST");
        }
        let source = self.disjunction()?;
        let mut conditions = Vec::new();
        while self.take_word("if") {
            conditions.push(self.disjunction()?);
        }
        if self.is_word("for") {
            return wrong("a second for", "one for");
        }
        Ok(Expression::Each(Box::new(Each { item, value, names, source, conditions })))
    }

    fn atom(&mut self) -> Result<Expression> {
        let Some(token) = self.peek().cloned() else { return wrong("the end of the expression", "a value") };
        self.at += 1;
        match token {
            Token::Int(value) => Ok(Expression::Constant(Value::Int(value))),
            Token::Float(value) => Ok(Expression::Constant(Value::Float(value))),
            Token::Text(mut text) => {
                while let Some(Token::Text(more)) = self.peek() {
                    text.push_str(more);
                    self.at += 1;
                }
                Ok(Expression::Constant(Value::text(&text)))
            }
            Token::Name(name) => match name.as_str() {
                "True" => Ok(Expression::Constant(Value::Bool(true))),
                "False" => Ok(Expression::Constant(Value::Bool(false))),
                "None" => Ok(Expression::Constant(Value::None)),
                word if KEYWORDS.contains(&word) => wrong(format!("the word {word:?}"), "a value"),
                _ => Ok(Expression::Name(name.into())),
            },
            Token::Sign("(") => {
                if self.take(")") {
                    return Ok(Expression::Tuple(Vec::new()));
                }
                let inner = self.tuple()?;
                let inner = self.each(inner, None)?;
                self.expect(")")?;
                Ok(inner)
            }
            Token::Sign("[") => self.list(),
            Token::Sign("{") => self.table(),
            token => wrong(shown(&token), "a value"),
        }
    }

    fn list(&mut self) -> Result<Expression> {
        let mut items = Vec::new();
        while !self.take("]") {
            let item = self.expression()?;
            if items.is_empty() && self.is_word("for") {
                let each = self.each(item, None)?;
                self.expect("]")?;
                return Ok(each);
            }
            items.push(item);
            if !self.is_sign("]") {
                self.expect(",")?;
            }
        }
        Ok(Expression::List(items))
    }

    fn table(&mut self) -> Result<Expression> {
        let mut entries = Vec::new();
        while !self.take("}") {
            let key = self.expression()?;
            self.expect(":")?;
            let value = self.expression()?;
            if entries.is_empty() && self.is_word("for") {
                let each = self.each(key, Some(value))?;
                self.expect("}")?;
                return Ok(each);
            }
            entries.push((key, value));
            if !self.is_sign("}") {
                self.expect(",")?;
            }
        }
        Ok(Expression::Table(entries))
    }
}

/// Maximum number of binary operators of an expression: each may be one level of the tree.
const MOST_TERMS: usize = 1000;

/// Binary operators, from the lowest precedence to the highest.
const LEVELS: [&[(&str, Binary)]; 6] = [
    &[("|", Binary::BitOr)],
    &[("^", Binary::BitXor)],
    &[("&", Binary::BitAnd)],
    &[("<<", Binary::ShiftLeft), (">>", Binary::ShiftRight)],
    &[("+", Binary::Add), ("-", Binary::Subtract)],
    &[("*", Binary::Multiply), ("/", Binary::Divide), ("//", Binary::FloorDivide), ("%", Binary::Remainder)],
];
