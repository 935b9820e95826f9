//! Where everything that is wrong with a scene is gathered.

use articulated_core::suggest::Suggester;

use crate::error::{Kind, SceneError, SceneErrors};
use crate::tree::At;

/// More than these are counted, not listed.
const MOST: usize = 1000;

/// What was found out so far.
#[derive(Debug)]
pub(crate) struct Log {
    file: String,
    errors: Vec<SceneError>,
    more: usize,
    suggester: Suggester,
}

impl Log {
    pub(crate) fn new(file: &str) -> Self {
        Self { file: file.to_owned(), errors: Vec::new(), more: 0, suggester: Suggester::default() }
    }

    /// The file, as it was called when it was read.
    pub(crate) fn file(&self) -> &str {
        &self.file
    }

    /// What was found of another file.
    pub(crate) fn take(&mut self, other: Self) {
        self.more += other.more;
        other.errors.into_iter().for_each(|error| self.push(error));
    }

    /// One error more.
    pub(crate) fn error(&mut self, at: At, key: &str, kind: Kind, found: impl Into<String>, expected: impl Into<String>) {
        self.push(SceneError {
            file: self.file.clone(),
            at,
            key: key.to_owned(),
            kind,
            found: found.into(),
            expected: expected.into(),
            nearest: None,
        });
    }

    /// A name that there is not, and what names there are.
    pub(crate) fn unknown<'a>(
        &mut self,
        (at, key, kind): (At, &str, Kind),
        (found, name): (String, &str),
        expected: impl Into<String>,
        names: impl IntoIterator<Item = &'a str>,
    ) {
        let nearest = self.suggester.nearest(name, names).map(str::to_owned);
        self.error(at, key, kind, found, expected);
        if let Some(last) = self.errors.last_mut().filter(|_| self.more == 0) {
            last.nearest = nearest;
        }
    }

    pub(crate) fn push(&mut self, error: SceneError) {
        if self.errors.len() < MOST {
            self.errors.push(error);
        } else {
            self.more += 1;
        }
    }

    /// Whether keys that there are not are among the errors from number `before` on.
    pub(crate) fn has_unknown_key(&self, before: usize) -> bool {
        self.errors.get(before..).unwrap_or_default().iter().any(|e| e.kind == Kind::UnknownKey)
    }

    /// Of these keys of a table those of which nothing is wrong, by the errors from number `before` on.
    pub(crate) fn right<'k>(&self, table: &str, keys: impl IntoIterator<Item = &'k str>, before: usize) -> Vec<&'k str> {
        let errors = self.errors.get(before..).unwrap_or_default();
        let is_of = |found: &str, key: &str| {
            let below = found.strip_prefix(table).and_then(|rest| rest.strip_prefix('.')?.strip_prefix(key));
            below.is_some_and(|rest| rest.is_empty() || rest.starts_with(['.', '[']))
        };
        keys.into_iter().filter(|key| self.more == 0 && !errors.iter().any(|e| is_of(&e.key, key))).collect()
    }

    /// How many errors there are.
    pub(crate) fn count(&self) -> usize {
        self.errors.len() + self.more
    }

    /// The value, or all errors.
    pub(crate) fn result<T>(mut self, value: T) -> Result<T, SceneErrors> {
        if self.errors.is_empty() {
            return Ok(value);
        }
        // As they stand in the file, and then in files that it names; those of one line as they were found.
        self.errors.sort_by_key(|e| (e.file != self.file, e.at));
        if self.more > 0 {
            let (more, file) = (self.more, self.file.clone());
            let found = format!("{more} more errors, not listed");
            self.errors.push(SceneError {
                file,
                at: At::Nowhere,
                key: String::new(),
                kind: Kind::More,
                found,
                expected: String::new(),
                nearest: None,
            });
        }
        Err(SceneErrors { errors: self.errors })
    }
}
