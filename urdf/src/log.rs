//! Where everything that is said about a file is gathered.

use articulated_core::description::Description;

use crate::problem::{Kind, Problem, Problems, Subject};
use crate::{Reading, Unused};

/// More than these of one sort are counted, not listed.
const MOST: usize = 1000;
/// The same, for what is not used.
const MOST_UNUSED: usize = 100_000;

/// Where in the file something stands.
#[derive(Clone, Copy)]
pub(crate) struct Place<'a> {
    pub(crate) line: Option<u32>,
    pub(crate) subject: &'a Subject,
    pub(crate) field: &'a str,
}

impl Place<'_> {
    /// The whole document.
    pub(crate) const DOCUMENT: Place<'static> = Place { line: None, subject: &Subject::Document, field: "" };
}

/// All that was found out about a file so far.
#[derive(Default)]
pub(crate) struct Log {
    file: String,
    pub(crate) errors: Vec<Problem>,
    warnings: Vec<Problem>,
    unused: Vec<Unused>,
    snapped: Vec<Problem>,
    more_errors: usize,
    more_warnings: usize,
    more_unused: usize,
}

impl Log {
    pub(crate) fn new(file: String) -> Self {
        Self { file, ..Self::default() }
    }

    /// An empty one for a part of the same file.
    pub(crate) fn apart(&self) -> Self {
        Self::new(self.file.clone())
    }

    /// Takes what was found of a part. What are errors there are warnings here, each with `rest`
    /// behind what is expected.
    pub(crate) fn take_as_warnings(&mut self, part: Self, rest: &str) {
        let errors = part.errors.into_iter().map(|mut error| {
            error.expected.push_str(rest);
            error
        });
        for warning in errors.chain(part.warnings) {
            if self.warnings.len() < MOST {
                self.warnings.push(warning);
            } else {
                self.more_warnings += 1;
            }
        }
        for unused in part.unused {
            if self.unused.len() < MOST_UNUSED {
                self.unused.push(unused);
            } else {
                self.more_unused += 1;
            }
        }
        self.more_warnings += part.more_errors + part.more_warnings;
        self.more_unused += part.more_unused;
        self.snapped.extend(part.snapped);
    }

    fn problem(&self, place: &Place<'_>, kind: Kind, found: String, expected: String) -> Problem {
        Problem {
            file: self.file.clone(),
            line: place.line,
            subject: place.subject.clone(),
            kind,
            field: place.field.to_owned(),
            found,
            expected,
        }
    }

    pub(crate) fn error(&mut self, place: &Place<'_>, kind: Kind, found: impl Into<String>, expected: impl Into<String>) {
        if self.errors.len() < MOST {
            self.errors.push(self.problem(place, kind, found.into(), expected.into()));
        } else {
            self.more_errors += 1;
        }
    }

    pub(crate) fn warning(&mut self, place: &Place<'_>, kind: Kind, found: impl Into<String>, expected: impl Into<String>) {
        if self.warnings.len() < MOST {
            self.warnings.push(self.problem(place, kind, found.into(), expected.into()));
        } else {
            self.more_warnings += 1;
        }
    }

    pub(crate) fn snapped(&mut self, place: &Place<'_>, found: f64, replaced_by: &str) {
        let problem = self.problem(place, Kind::Snapped, format!("{found}"), format!("{replaced_by}, which was used"));
        self.snapped.push(problem);
    }

    pub(crate) fn unused_at(&mut self, line: Option<u32>, subject: &Subject, tag: String, why: impl Into<String>) {
        if self.unused.len() < MOST_UNUSED {
            self.unused.push(Unused { line, subject: subject.clone(), tag, why: why.into() });
        } else {
            self.more_unused += 1;
        }
    }

    fn count_the_rest(&mut self) {
        for (list, more) in [(&mut self.errors, self.more_errors), (&mut self.warnings, self.more_warnings)] {
            if more > 0 {
                list.push(Problem {
                    file: self.file.clone(),
                    line: None,
                    subject: Subject::Document,
                    kind: Kind::More,
                    field: String::new(),
                    found: format!("{more} more that are not listed"),
                    expected: String::new(),
                });
            }
        }
    }

    pub(crate) fn reading(mut self, description: Description) -> Reading {
        self.count_the_rest();
        if self.more_unused > 0 {
            let tag = format!("{} more", self.more_unused);
            self.unused.push(Unused { line: None, subject: Subject::Document, tag, why: "not listed".to_owned() });
        }
        Reading { description, warnings: self.warnings, unused: self.unused, snapped: self.snapped }
    }

    pub(crate) fn problems(mut self) -> Problems {
        self.count_the_rest();
        Problems { errors: self.errors, warnings: self.warnings }
    }
}
