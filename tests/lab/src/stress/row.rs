//! A row of the report: a measurement of a hard case, and its limit.

use serde::Serialize;

/// One measurement.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    /// The topic of the case.
    pub chapter: &'static str,
    /// The case.
    pub case: String,
    /// Why it is hard, in a sentence.
    pub why: &'static str,
    /// The measured quantity.
    pub what: String,
    /// The measured value; NaN if the result is not measurable.
    #[serde(serialize_with = "number")]
    pub measured: f64,
    /// The allowed maximum; `None` for a value that is only shown.
    pub limit: Option<f64>,
    /// The unit of both.
    pub unit: &'static str,
    /// Whether it is right.
    pub pass: bool,
}

/// JSON has no infinity and no NaN.
fn number<S: serde::Serializer>(x: &f64, to: S) -> Result<S::Ok, S::Error> {
    if x.is_finite() { to.serialize_f64(*x) } else { to.serialize_str(&x.to_string()) }
}

/// A case: the common data of its rows.
#[derive(Clone, Debug)]
pub struct Case {
    /// As [`Row::chapter`].
    pub chapter: &'static str,
    /// As [`Row::case`].
    pub name: String,
    /// As [`Row::why`].
    pub why: &'static str,
    /// Whether |M| and |h| of η are the sums of the magnitudes of their terms in any case.
    pub by_terms: bool,
}

impl Case {
    /// A case of a chapter.
    pub fn new(chapter: &'static str, name: impl Into<String>, why: &'static str) -> Self {
        Self { chapter, name: name.into(), why, by_terms: false }
    }

    /// For a robot whose numbers of h may cancel to the last digit, as for a round tool about its
    /// own axis.
    pub fn by_terms(self) -> Self {
        Self { by_terms: true, ..self }
    }

    /// Right up to the limit.
    pub fn row(&self, what: impl Into<String>, measured: f64, limit: f64, unit: &'static str) -> Row {
        // NaN fails.
        let pass = measured <= limit;
        self.of(what.into(), measured, Some(limit), unit, pass)
    }

    /// Passes between two limits; the upper one is shown.
    pub fn between(&self, what: impl Into<String>, measured: f64, [least, most]: [f64; 2], unit: &'static str) -> Row {
        self.of(what.into(), measured, Some(most), unit, (least..=most).contains(&measured))
    }

    /// Right or wrong.
    pub fn holds(&self, what: impl Into<String>, holds: bool) -> Row {
        self.of(what.into(), f64::from(u8::from(!holds)), Some(0.0), "wrong", holds)
    }

    /// Shown with the value from which on it is notable.
    pub fn remark(&self, what: impl Into<String>, measured: f64, limit: f64, unit: &'static str) -> Row {
        self.of(what.into(), measured, Some(limit), unit, true)
    }

    /// To be seen, not judged.
    pub fn shown(&self, what: impl Into<String>, measured: f64, unit: &'static str) -> Row {
        self.of(what.into(), measured, None, unit, true)
    }

    fn of(&self, what: String, measured: f64, limit: Option<f64>, unit: &'static str, pass: bool) -> Row {
        Row { chapter: self.chapter, case: self.name.clone(), why: self.why, what, measured, limit, unit, pass }
    }
}
