//! A row of the report: what was measured of a hard case, and what it may be.

use serde::Serialize;

/// One measurement.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    /// What the case is about.
    pub chapter: &'static str,
    /// The case.
    pub case: String,
    /// Why it is hard, in a sentence.
    pub why: &'static str,
    /// What was measured.
    pub what: String,
    /// What was found; not a number where nothing that can be measured came out.
    #[serde(serialize_with = "number")]
    pub measured: f64,
    /// The most that is right; none of a measurement that is shown only.
    pub limit: Option<f64>,
    /// The unit of both.
    pub unit: &'static str,
    /// Whether it is right.
    pub pass: bool,
}

/// JSON has no infinity and nothing that is not a number.
fn number<S: serde::Serializer>(x: &f64, to: S) -> Result<S::Ok, S::Error> {
    if x.is_finite() { to.serialize_f64(*x) } else { to.serialize_str(&x.to_string()) }
}

/// A case: what its rows have in common.
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

    /// Of a robot that may have numbers of h that cancel to the last digit, as that of a round tool
    /// about its own axis does.
    pub fn by_terms(self) -> Self {
        Self { by_terms: true, ..self }
    }

    /// Right up to the limit.
    pub fn row(&self, what: impl Into<String>, measured: f64, limit: f64, unit: &'static str) -> Row {
        // What is not a number is not right.
        let pass = measured <= limit;
        self.of(what.into(), measured, Some(limit), unit, pass)
    }

    /// Right between two limits, of which the upper is shown.
    pub fn between(&self, what: impl Into<String>, measured: f64, [least, most]: [f64; 2], unit: &'static str) -> Row {
        self.of(what.into(), measured, Some(most), unit, (least..=most).contains(&measured))
    }

    /// Right or wrong.
    pub fn holds(&self, what: impl Into<String>, holds: bool) -> Row {
        self.of(what.into(), f64::from(u8::from(!holds)), Some(0.0), "wrong", holds)
    }

    /// To be seen beside the value from which on it is worth a look.
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
