//! Properties and macros, by the scope that they are defined in.

use std::collections::BTreeMap;
use std::rc::Rc;

use articulated_core::diagnostic::At;
use articulated_core::suggest::Suggester;

use super::source::Element;
use super::value::Value;

/// The meaning of a name in a scope.
#[derive(Clone)]
pub(super) enum Symbol {
    Value(Value),
    /// A text that is evaluated at its first use.
    Lazy(Rc<str>, At),
    /// One that is being evaluated.
    Pending,
    /// One with an error that was reported.
    Failed,
    /// Tags; names of blocks begin with `*` or `**`.
    Block(Rc<Element>),
}

/// A macro.
pub(super) struct Macro {
    pub(super) body: Rc<Element>,
    pub(super) parameters: Rc<str>,
}

#[derive(Default)]
struct Scope {
    parent: Option<usize>,
    /// Whether it is the scope of an included file with a namespace.
    is_namespace: bool,
    symbols: BTreeMap<Rc<str>, Symbol>,
    macros: BTreeMap<Rc<str>, Rc<Macro>>,
    /// Scopes of included files by their names.
    namespaces: BTreeMap<Rc<str>, usize>,
    /// The scope where macros are looked up next. Macros of a namespace do not see others.
    macro_parent: Option<usize>,
}

/// All scopes. The first is that of the document.
pub(super) struct Scopes {
    all: Vec<Scope>,
}

pub(super) const GLOBAL: usize = 0;

impl Scopes {
    pub(super) fn new() -> Self {
        Self { all: vec![Scope::default()] }
    }

    /// A scope of a macro that sees properties and macros of another one.
    pub(super) fn inner(&mut self, parent: usize) -> usize {
        self.all.push(Scope { parent: Some(parent), macro_parent: Some(parent), ..Scope::default() });
        self.all.len() - 1
    }

    /// The scope of an included file with a name.
    pub(super) fn namespace(&mut self, parent: usize, name: &str) -> usize {
        self.all.push(Scope { parent: Some(parent), is_namespace: true, ..Scope::default() });
        let new = self.all.len() - 1;
        self.all[parent].namespaces.insert(name.into(), new);
        self.set(parent, name, Symbol::Value(Value::Scope(new)));
        new
    }

    /// Removes the contents of a scope that was left.
    pub(super) fn clear(&mut self, scope: usize) {
        if scope + 1 == self.all.len() {
            self.all.pop();
        } else {
            self.all[scope] = Scope::default();
        }
    }

    /// A scope, and those around it.
    fn around(&self, scope: usize) -> impl Iterator<Item = usize> + '_ {
        std::iter::successors(Some(scope), |scope| self.all.get(*scope)?.parent)
    }

    /// The scope that has a symbol of this name, and how many were searched.
    pub(super) fn find(&self, scope: usize, name: &str) -> (Option<usize>, usize) {
        let mut count = 0;
        let found = self.around(scope).inspect(|_| count += 1).find(|scope| self.get(*scope, name).is_some());
        (found, count)
    }

    /// The symbol in a scope itself.
    pub(super) fn get(&self, scope: usize, name: &str) -> Option<&Symbol> {
        self.all.get(scope)?.symbols.get(name)
    }

    pub(super) fn set(&mut self, scope: usize, name: &str, symbol: Symbol) {
        if let Some(scope) = self.all.get_mut(scope) {
            scope.symbols.insert(name.into(), symbol);
        }
    }

    /// Removes a name from a scope and from those around it.
    pub(super) fn remove(&mut self, scope: usize, name: &str) {
        let around: Vec<usize> = self.around(scope).collect();
        for scope in around {
            self.all[scope].symbols.remove(name);
        }
    }

    /// The scope that `scope="parent"` means.
    pub(super) fn parent(&self, scope: usize) -> Option<usize> {
        let own = self.all.get(scope)?;
        let mut parent = own.parent?;
        while !own.is_namespace && self.all[parent].is_namespace {
            parent = self.all[parent].parent?;
        }
        Some(parent)
    }

    pub(super) fn define(&mut self, scope: usize, name: &str, new: Macro) {
        self.all[scope].macros.insert(name.into(), Rc::new(new));
    }

    /// A macro by its name, with the names of namespaces before it, and the parent scope of its
    /// own.
    pub(super) fn find_macro(&self, scope: usize, name: &str) -> Option<(usize, Rc<Macro>)> {
        if let Some(found) = self.own_macro(scope, name) {
            return Some((scope, found));
        }
        let (namespaces, name) = name.rsplit_once('.')?;
        let mut scope = scope;
        for namespace in namespaces.split('.') {
            scope = self.macro_scopes(scope).find_map(|scope| self.all[scope].namespaces.get(namespace))?.to_owned();
        }
        Some((scope, self.own_macro(scope, name)?))
    }

    fn macro_scopes(&self, scope: usize) -> impl Iterator<Item = usize> + '_ {
        std::iter::successors(Some(scope), |scope| self.all.get(*scope)?.macro_parent)
    }

    fn own_macro(&self, scope: usize, name: &str) -> Option<Rc<Macro>> {
        self.macro_scopes(scope).find_map(|scope| self.all[scope].macros.get(name)).cloned()
    }

    /// The property most like a name.
    pub(super) fn nearest(&self, scope: usize, name: &str, suggester: &mut Suggester) -> Option<String> {
        let names =
            self.around(scope).flat_map(|scope| self.all[scope].symbols.keys()).filter(|name| !name.starts_with('*')).take(MOST_NAMES);
        suggester.nearest(name, names.map(|name| &**name)).map(str::to_owned)
    }

    /// The macro most like a name.
    pub(super) fn nearest_macro(&self, scope: usize, name: &str, suggester: &mut Suggester) -> Option<String> {
        let names = self.macro_scopes(scope).flat_map(|scope| self.all[scope].macros.keys()).take(MOST_NAMES);
        suggester.nearest(name, names.map(|name| &**name)).map(str::to_owned)
    }
}

/// Maximum number of names for a suggestion.
const MOST_NAMES: usize = 2000;
