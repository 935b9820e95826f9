//! From an expression to its value.

use std::rc::Rc;

use super::functions::{self, Arguments};
use super::operators;
use super::syntax::{Compare, Each, Expression, Unary};
use super::value::{Result, Value, wrong};
use super::work::Names;

/// The value of an expression.
pub(super) fn evaluate(expression: &Expression, names: &mut dyn Names) -> Result<Value> {
    Evaluator { names, locals: Vec::new() }.value(expression)
}

struct Evaluator<'a> {
    names: &'a mut dyn Names,
    /// Names of `for`.
    locals: Vec<(Rc<str>, Value)>,
}

impl Evaluator<'_> {
    fn value(&mut self, expression: &Expression) -> Result<Value> {
        self.names.work().enter()?;
        let value = self.inner(expression);
        self.names.work().leave();
        value
    }

    fn inner(&mut self, expression: &Expression) -> Result<Value> {
        match expression {
            Expression::Constant(value) => Ok(value.clone()),
            Expression::Name(name) => self.name(name),
            Expression::List(items) => Value::list(self.values(items)?),
            Expression::Tuple(items) => Value::tuple(self.values(items)?),
            Expression::Table(entries) => self.table(entries),
            Expression::Each(each) => self.each(each),
            Expression::Unary(Unary::Not, value) => Ok(Value::Bool(!self.value(value)?.is_true())),
            Expression::Unary(sign, value) => operators::unary(*sign, &self.value(value)?),
            Expression::Binary(operator, operands) => self.binary(*operator, operands),
            Expression::Compare(first, rest) => self.comparison(first, rest),
            Expression::And(all) => self.first(all, false),
            Expression::Or(all) => self.first(all, true),
            Expression::If(parts) => {
                let [condition, yes, no] = &**parts;
                let holds = self.value(condition)?.is_true();
                self.value(if holds { yes } else { no })
            }
            Expression::Attribute(value, name) => self.attribute(value, name),
            Expression::Index(parts) => {
                let [list, index] = &**parts;
                let (list, index) = (self.value(list)?, self.value(index)?);
                self.names.work().steps(list.size())?;
                operators::index(&list, &index)
            }
            Expression::Slice(list, parts) => self.slice(list, parts),
            Expression::Call(function, arguments, named) => self.call(function, arguments, named),
        }
    }

    fn values(&mut self, all: &[Expression]) -> Result<Vec<Value>> {
        self.names.work().bytes(std::mem::size_of_val(all))?;
        all.iter().map(|one| self.value(one)).collect()
    }

    fn name(&mut self, name: &Rc<str>) -> Result<Value> {
        if let Some((_, value)) = self.locals.iter().rev().find(|(local, _)| local == name) {
            return Ok(value.clone());
        }
        if let Some(value) = self.names.property(name)? {
            return Ok(value);
        }
        if let Some(value) = functions::global(name) {
            return Ok(value);
        }
        let near = self.names.suggestion(name).map(|near| format!(" (did you mean {near:?}?)")).unwrap_or_default();
        wrong(format!("the unknown name {name:?}"), format!("a property, a parameter or a function{near}"))
    }

    fn table(&mut self, entries: &[(Expression, Expression)]) -> Result<Value> {
        let mut out = Vec::new();
        for (key, value) in entries {
            let entry = (self.value(key)?, self.value(value)?);
            self.put(&mut out, entry)?;
        }
        Value::table(out)
    }

    fn put(&mut self, out: &mut Vec<(Value, Value)>, (key, value): (Value, Value)) -> Result<()> {
        self.names.work().bytes(std::mem::size_of::<(Value, Value)>())?;
        self.names.work().steps(out.len())?;
        match out.iter_mut().find(|(known, _)| known.equals(&key)) {
            Some(entry) => entry.1 = value,
            None => out.push((key, value)),
        }
        Ok(())
    }

    fn each(&mut self, each: &Each) -> Result<Value> {
        let source = self.value(&each.source)?;
        let (mut items, mut entries) = (Vec::new(), Vec::new());
        self.names.work().bytes(functions::weight(&source))?;
        for one in functions::items(&source)? {
            self.names.work().steps(1)?;
            let depth = self.locals.len();
            match each.names.as_slice() {
                [name] => self.locals.push((name.clone(), one)),
                names => {
                    let parts = functions::items(&one)?;
                    if parts.len() != names.len() {
                        return wrong(format!("{} values for {} names of for", parts.len(), names.len()), "as many values as names");
                    }
                    self.locals.extend(names.iter().cloned().zip(parts));
                }
            }
            let mut holds = true;
            for condition in &each.conditions {
                holds = holds && self.value(condition)?.is_true();
            }
            if holds {
                self.names.work().bytes(std::mem::size_of::<Value>())?;
                let item = self.value(&each.item)?;
                match &each.value {
                    Some(value) => {
                        let value = self.value(value)?;
                        self.put(&mut entries, (item, value))?;
                    }
                    None => items.push(item),
                }
            }
            self.locals.truncate(depth);
        }
        if each.value.is_some() { Value::table(entries) } else { Value::list(items) }
    }

    fn binary(&mut self, operator: super::syntax::Binary, operands: &[Expression; 2]) -> Result<Value> {
        let (left, right) = (self.value(&operands[0])?, self.value(&operands[1])?);
        operators::binary(operator, &left, &right, self.names.work())
    }

    /// The first value with this truth; otherwise the last.
    fn first(&mut self, all: &[Expression], is_true: bool) -> Result<Value> {
        let mut last = Value::None;
        for one in all {
            last = self.value(one)?;
            if last.is_true() == is_true {
                break;
            }
        }
        Ok(last)
    }

    fn comparison(&mut self, first: &Expression, rest: &[(Compare, Expression)]) -> Result<Value> {
        let mut left = self.value(first)?;
        for (how, right) in rest {
            let right = self.value(right)?;
            if !operators::compare(*how, &left, &right, self.names.work())? {
                return Ok(Value::Bool(false));
            }
            left = right;
        }
        Ok(Value::Bool(true))
    }

    fn attribute(&mut self, value: &Expression, name: &Rc<str>) -> Result<Value> {
        let value = self.value(value)?;
        self.names.work().steps(value.size())?;
        match &value {
            Value::Scope(scope) => match self.names.member(*scope, name)? {
                Some(value) => Ok(value),
                None => wrong(format!("the unknown name {name:?} of a namespace"), "a property of the included file"),
            },
            Value::Builtin(module) => match functions::of_module(module, name) {
                Some(value) => Ok(value),
                None => wrong(format!("the unknown name {name:?} of {module}"), "a function of this module"),
            },
            // As in xacro, an entry comes before a method of its name.
            Value::Table(_) => match value.entry(&Value::Text(name.clone())) {
                Some(value) => Ok(value.clone()),
                None => functions::method(&value, name),
            },
            _ => functions::method(&value, name),
        }
    }

    fn slice(&mut self, list: &Expression, parts: &[Option<Box<Expression>>; 3]) -> Result<Value> {
        let list = self.value(list)?;
        let mut bounds = [None; 3];
        for (bound, part) in bounds.iter_mut().zip(parts) {
            let Some(part) = part else { continue };
            let value = self.value(part)?;
            *bound = match (&value, value.integer()) {
                (Value::None, _) => None,
                (_, Some(value)) => Some(value),
                _ => return wrong(format!("{} in a slice", value.shown()), "an integer"),
            };
        }
        operators::slice(&list, bounds, self.names.work())
    }

    fn call(&mut self, function: &Expression, arguments: &[Expression], named: &[(Rc<str>, Expression)]) -> Result<Value> {
        let function = self.value(function)?;
        let mut own = Arguments { values: self.values(arguments)?, named: Vec::new() };
        for (name, value) in named {
            let value = self.value(value)?;
            own.named.push((name.clone(), value));
        }
        functions::call(&function, own, self.names)
    }
}
