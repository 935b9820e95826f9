//! The collector of findings.

use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;
use core::fmt;

use super::{At, Code, Diagnostic, Place, Severity, Subject, Unused};
use crate::suggest::Suggester;

/// More findings of one severity are counted, not listed.
const MOST: usize = 1000;
/// The same, for content that is not used.
const MOST_UNUSED: usize = 100_000;

/// All findings about an input, of bounded number. As the error of a call it contains at least one
/// error, and prints all of them, one per line.
#[derive(Clone, Debug, Default)]
pub struct Diagnostics {
    /// Why the input is refused.
    pub errors: Vec<Diagnostic>,
    /// Suspicious input that is used as it is.
    pub warnings: Vec<Diagnostic>,
    /// Numbers that were replaced, as requested.
    pub notes: Vec<Diagnostic>,
    /// Content that is not used.
    pub unused: Vec<Unused>,
    file: String,
    /// Files that the document includes, by their numbers in [`At::Included`].
    included: Vec<String>,
    more_errors: usize,
    more_warnings: usize,
    more_unused: usize,
    suggester: Suggester,
}

impl Diagnostics {
    /// Empty findings of this file.
    #[must_use]
    pub fn new(file: &str) -> Self {
        Self { file: file.to_string(), ..Self::default() }
    }

    /// Empty findings of the same file.
    #[must_use]
    pub fn apart(&self) -> Self {
        Self { included: self.included.clone(), ..Self::new(&self.file) }
    }

    /// The number of a file that the document includes, for [`At::Included`]; `None` beyond 65 536
    /// files.
    pub fn include(&mut self, file: &str) -> Option<u16> {
        let index = self.included.iter().position(|known| known == file).unwrap_or_else(|| {
            self.included.push(file.to_string());
            self.included.len() - 1
        });
        u16::try_from(index).ok()
    }

    /// The file of a place, and the place in it.
    fn resolve(&self, at: At) -> (&str, At) {
        match at {
            At::Included { file, line, column } => {
                (self.included.get(usize::from(file)).map_or(&self.file, |name| name), At::Text { line, column })
            }
            at => (&self.file, at),
        }
    }

    /// An error at a place of the file, which is not reported.
    pub fn finding<'a>(
        &self,
        place: impl Into<Place<'a>>,
        code: Code,
        found: impl Into<String>,
        expected: impl Into<String>,
    ) -> Diagnostic {
        let place = place.into();
        let (file, at) = self.resolve(place.at);
        Diagnostic::error(file, Place { at, ..place }, code, found, expected)
    }

    /// The file that reports are about.
    #[must_use]
    pub fn file(&self) -> &str {
        &self.file
    }

    /// Reports an error at a place of the file.
    pub fn error<'a>(&mut self, place: impl Into<Place<'a>>, code: Code, found: impl Into<String>, expected: impl Into<String>) {
        if self.errors.len() < MOST {
            self.errors.push(self.finding(place, code, found, expected));
        } else {
            self.more_errors += 1;
        }
    }

    /// Reports a warning at a place of the file.
    pub fn warning<'a>(&mut self, place: impl Into<Place<'a>>, code: Code, found: impl Into<String>, expected: impl Into<String>) {
        if self.warnings.len() < MOST {
            self.warnings.push(self.finding(place, code, found, expected).into_warning());
        } else {
            self.more_warnings += 1;
        }
    }

    /// Reports a name that does not exist, with the nearest of the names that do.
    pub fn unknown<'a, 'n>(
        &mut self,
        (place, code): (impl Into<Place<'a>>, Code),
        (found, name): (String, &str),
        expected: impl Into<String>,
        names: impl IntoIterator<Item = &'n str>,
    ) {
        let nearest = self.suggester.nearest(name, names).map(str::to_string);
        self.push(self.finding(place, code, found, expected).with_nearest(nearest));
    }

    /// Reports a number that was replaced, as requested.
    pub fn replaced<'a>(&mut self, place: impl Into<Place<'a>>, code: Code, found: f64, replaced_by: &str) {
        let note = self.finding(place, code, format!("{found}"), format!("{replaced_by}, which was used"));
        self.notes.push(Diagnostic { severity: Severity::Note, ..note });
    }

    /// Reports content that is not used; of an included file with the name of that file.
    pub fn unused_at(&mut self, at: At, subject: &Subject, tag: String, why: impl Into<String>) {
        let tag = if let At::Included { .. } = at { format!("{tag} of {}", self.resolve(at).0) } else { tag };
        self.push_unused(Unused { line: at.line(), subject: subject.clone(), tag, why: why.into() });
    }

    /// Takes content that is not used, of any file.
    pub fn push_unused(&mut self, unused: Unused) {
        if self.unused.len() < MOST_UNUSED {
            self.unused.push(unused);
        } else {
            self.more_unused += 1;
        }
    }

    /// Takes a finding, of any file.
    pub fn push(&mut self, finding: Diagnostic) {
        let (list, more) = match finding.severity {
            Severity::Error => (&mut self.errors, &mut self.more_errors),
            Severity::Warning => (&mut self.warnings, &mut self.more_warnings),
            Severity::Note => return self.notes.push(finding),
        };
        if list.len() < MOST {
            list.push(finding);
        } else {
            *more += 1;
        }
    }

    /// Takes findings, of any file.
    pub fn extend(&mut self, findings: impl IntoIterator<Item = Diagnostic>) {
        findings.into_iter().for_each(|finding| self.push(finding));
    }

    /// Takes all findings of another collector.
    pub fn take(&mut self, other: Self) {
        self.extend(other.errors.into_iter().chain(other.warnings).chain(other.notes));
        other.unused.into_iter().for_each(|unused| self.push_unused(unused));
        self.more_errors += other.more_errors;
        self.more_warnings += other.more_warnings;
        self.more_unused += other.more_unused;
    }

    /// Takes the findings about a part of the file. Its errors become warnings, with `rest`
    /// appended to their `expected`.
    pub fn take_as_warnings(&mut self, mut part: Self, rest: &str) {
        let errors = core::mem::take(&mut part.errors).into_iter().map(|mut error| {
            error.expected.push_str(rest);
            error.into_warning()
        });
        part.warnings.splice(..0, errors);
        part.more_warnings += core::mem::take(&mut part.more_errors);
        self.take(part);
    }

    /// Whether there is no error.
    #[must_use]
    pub fn is_ok(&self) -> bool {
        self.errors.is_empty()
    }

    /// How many errors there are.
    #[must_use]
    pub fn count(&self) -> usize {
        self.errors.len() + self.more_errors
    }

    /// Whether there are unknown keys among the errors from number `before` on.
    #[must_use]
    pub fn has_unknown_key(&self, before: usize) -> bool {
        self.errors.get(before..).unwrap_or_default().iter().any(|e| e.code == Code::UnknownKey)
    }

    /// The keys of a table without errors, among the errors from number `before` on.
    pub fn right<'k>(&self, table: &str, keys: impl IntoIterator<Item = &'k str>, before: usize) -> Vec<&'k str> {
        let errors = self.errors.get(before..).unwrap_or_default();
        let is_of = |found: &str, key: &str| {
            let below = found.strip_prefix(table).and_then(|rest| rest.strip_prefix('.')?.strip_prefix(key));
            below.is_some_and(|rest| rest.is_empty() || rest.starts_with(['.', '[']))
        };
        keys.into_iter().filter(|key| self.more_errors == 0 && !errors.iter().any(|e| is_of(&e.field, key))).collect()
    }

    /// Sorts errors: first those of the file, in its order, then those of other files. Errors of
    /// one line keep their order.
    pub fn sort(&mut self) {
        let (file, errors) = (&self.file, &mut self.errors);
        errors.sort_by_key(|e| (e.span.file != *file, e.line(), if let At::Word(word) = e.span.at { Some(word) } else { None }));
    }

    /// Lists how many findings are counted only.
    #[must_use]
    pub fn finished(mut self) -> Self {
        let file = core::mem::take(&mut self.file);
        let more = |count: usize| {
            let found = format!("{count} more that are not listed");
            (count > 0).then(|| Diagnostic::error(&file, Place::DOCUMENT, Code::More, found, ""))
        };
        self.errors.extend(more(core::mem::take(&mut self.more_errors)));
        self.warnings.extend(more(core::mem::take(&mut self.more_warnings)).map(Diagnostic::into_warning));
        let unused = core::mem::take(&mut self.more_unused);
        if unused > 0 {
            self.unused.push(Unused {
                line: None,
                subject: Subject::Document,
                tag: format!("{unused} more"),
                why: "not listed".to_string(),
            });
        }
        Self { file, ..self }
    }

    /// The value, or all findings if there is an error.
    ///
    /// # Errors
    /// If there is an error.
    pub fn result<T>(mut self, value: T) -> Result<T, Self> {
        if self.is_ok() {
            return Ok(value);
        }
        self.sort();
        Err(self.finished())
    }
}

impl PartialEq for Diagnostics {
    fn eq(&self, other: &Self) -> bool {
        (&self.errors, &self.warnings, &self.notes, &self.unused) == (&other.errors, &other.warnings, &other.notes, &other.unused)
    }
}

impl From<Diagnostic> for Diagnostics {
    fn from(finding: Diagnostic) -> Self {
        let mut all = Self::new(&finding.span.file);
        all.push(finding);
        all
    }
}

impl fmt::Display for Diagnostics {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, error) in self.errors.iter().enumerate() {
            write!(f, "{}{error}", if i == 0 { "" } else { "\n" })?;
        }
        Ok(())
    }
}

impl core::error::Error for Diagnostics {}
