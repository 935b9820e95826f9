//! Values of attributes: of the tag itself, or else of its default class.

use articulated_core::diagnostic::{Code, Diagnostics, Subject, quote};
use articulated_core::suggest::nearest;

use super::element::{Attribute, Element};
use crate::pose::{
    IDENTITY, Pose, Quaternion, TINY, about, cross, dot, multiply, norm, of_axes, of_z_axis, radians, scale, subtract, unit,
};
use crate::xml::number;

/// A tag and the tags of its default class, the nearest first.
pub(crate) struct Values<'a> {
    pub(crate) element: &'a Element,
    layers: Vec<&'a Element>,
    pub(crate) subject: Subject,
}

impl<'a> Values<'a> {
    /// `defaults`: the nearest first.
    pub(crate) fn new(element: &'a Element, defaults: Vec<&'a Element>, subject: &Subject) -> Self {
        let layers = std::iter::once(element).chain(defaults).collect();
        Self { element, layers, subject: subject.clone() }
    }

    /// The values of a tag without a default class.
    pub(crate) fn alone(element: &'a Element, subject: &Subject) -> Self {
        Self::new(element, Vec::new(), subject)
    }

    fn nearest(&self, name: &str) -> Option<(&'a Element, &'a Attribute)> {
        self.layers.iter().find_map(|layer| Some((*layer, layer.attribute(name)?)))
    }

    /// As [`Self::nearest`], for lists of numbers: an empty one counts as missing.
    fn nearest_list(&self, name: &str) -> Option<(&'a Element, &'a Attribute)> {
        self.layers.iter().find_map(|layer| Some((*layer, list(layer, name)?)))
    }

    /// Whether there are numbers.
    pub(crate) fn has_numbers(&self, name: &str) -> bool {
        self.nearest_list(name).is_some()
    }

    pub(crate) fn has(&self, name: &str) -> bool {
        self.nearest(name).is_some()
    }

    pub(crate) fn text(&self, name: &str) -> Option<&'a str> {
        self.nearest(name).map(|(_, attribute)| attribute.value.as_str())
    }

    pub(crate) fn error(&self, field: &str, code: Code, found: impl Into<String>, expected: impl Into<String>, log: &mut Diagnostics) {
        let element = self.nearest(field).map_or(self.element, |(element, _)| element);
        element.error((&self.subject, field), code, found, expected, log);
    }

    /// Exactly `N` numbers.
    pub(crate) fn exactly<const N: usize>(&self, name: &str, log: &mut Diagnostics) -> Option<[f64; N]> {
        let (element, attribute) = self.nearest_list(name)?;
        let numbers = numbers(element, attribute, &self.subject, log)?;
        let exact = numbers.as_slice().try_into().ok();
        if exact.is_none() {
            let found = format!("{} numbers in {}", numbers.len(), quote(&attribute.value));
            element.error((&self.subject, name), Code::WrongCount, found, format!("{N} numbers"), log);
        }
        exact
    }

    /// At most `N` numbers: missing numbers of a tag come from the next class, and from `base`.
    pub(crate) fn at_most<const N: usize>(&self, name: &str, base: [f64; N], log: &mut Diagnostics) -> [f64; N] {
        let mut all = base;
        for layer in self.layers.iter().rev() {
            let Some(attribute) = list(layer, name) else { continue };
            let Some(numbers) = numbers(layer, attribute, &self.subject, log) else { continue };
            if numbers.len() > N {
                let found = format!("{} numbers in {}", numbers.len(), quote(&attribute.value));
                layer.error((&self.subject, name), Code::WrongCount, found, format!("1 to {N} numbers"), log);
                continue;
            }
            all[..numbers.len()].copy_from_slice(&numbers);
        }
        all
    }

    /// All numbers of an attribute.
    pub(crate) fn list(&self, name: &str, log: &mut Diagnostics) -> Option<Vec<f64>> {
        let (element, attribute) = self.nearest_list(name)?;
        numbers(element, attribute, &self.subject, log)
    }

    pub(crate) fn number(&self, name: &str, log: &mut Diagnostics) -> Option<f64> {
        self.exactly::<1>(name, log).map(|[number]| number)
    }

    /// A whole number.
    pub(crate) fn integer(&self, name: &str, log: &mut Diagnostics) -> Option<i64> {
        let number = self.number(name, log)?;
        if number.fract() == 0.0 && number.abs() < 1e15 {
            return Some(number as i64);
        }
        self.error(name, Code::Number, format!("{number}"), "a whole number", log);
        None
    }

    /// One of some words.
    pub(crate) fn word<T: Copy>(&self, name: &str, words: &[(&str, T)], log: &mut Diagnostics) -> Option<T> {
        let text = self.text(name)?.trim();
        let found = words.iter().find(|(word, _)| *word == text).map(|(_, value)| *value);
        if found.is_none() {
            let all: Vec<&str> = words.iter().map(|(word, _)| *word).collect();
            let hint = nearest(text, all.iter().copied()).map(|near| format!(" (did you mean {near:?}?)")).unwrap_or_default();
            self.error(name, Code::Word, quote(text), format!("one of {}{hint}", all.join(", ")), log);
        }
        found
    }

    pub(crate) fn yes(&self, name: &str, log: &mut Diagnostics) -> Option<bool> {
        self.word(name, &[("true", true), ("false", false)], log)
    }

    /// True, false, or `None` for `auto` and if it is missing.
    pub(crate) fn yes_or_auto(&self, name: &str, log: &mut Diagnostics) -> Option<bool> {
        self.word(name, &[("true", Some(true)), ("false", Some(false)), ("auto", None)], log)?
    }

    /// `pos` and the orientation.
    pub(crate) fn pose(&self, angles: &Angles, log: &mut Diagnostics) -> Pose {
        Pose { position: self.exactly("pos", log).unwrap_or_default(), rotation: self.orientation(angles, log) }
    }

    /// The orientation, of the nearest class that has one.
    pub(crate) fn orientation(&self, angles: &Angles, log: &mut Diagnostics) -> Quaternion {
        const FORMS: [&str; 5] = ["quat", "axisangle", "xyaxes", "zaxis", "euler"];
        let forms = |layer: &&Element| -> Vec<&str> { FORMS.into_iter().filter(|name| list(layer, name).is_some()).collect() };
        let with = self.layers.iter().map(|layer| (*layer, forms(layer))).find(|(_, forms)| !forms.is_empty());
        let with = match with {
            None => return IDENTITY,
            Some((_, forms)) if forms.len() == 1 => forms.first().copied(),
            Some((layer, forms)) => {
                layer.error((&self.subject, "orientation"), Code::TwoRotations, forms.join(" and "), "one of them", log);
                return IDENTITY;
            }
        };
        let found = match with {
            Some("axisangle") => self.exactly("axisangle", log).map(|[x, y, z, angle]| {
                unit([x, y, z]).map(|axis| about(axis, angles.radians(angle))).ok_or(("axisangle", "an axis that is not zero"))
            }),
            Some("xyaxes") => self.exactly("xyaxes", log).map(|[a, b, c, x, y, z]| {
                let axes = unit([a, b, c]).and_then(|first| {
                    let second = unit(subtract([x, y, z], scale(first, dot(first, [x, y, z]))))?;
                    Some(of_axes(first, second, unit(cross(first, second))?))
                });
                axes.ok_or(("xyaxes", "two axes that are not zero and not parallel"))
            }),
            Some("zaxis") => self.exactly("zaxis", log).map(|z| unit(z).map(of_z_axis).ok_or(("zaxis", "an axis that is not zero"))),
            Some("euler") => self.exactly("euler", log).map(|euler| Ok(angles.euler(euler))),
            _ => self.exactly::<4>("quat", log).map(|quat| {
                let length = norm([norm([quat[0], quat[1], quat[2]]), quat[3], 0.0]);
                if length > TINY && length.is_finite() { Ok(quat) } else { Err(("quat", "a quaternion that is not zero")) }
            }),
        };
        match found {
            Some(Ok(quaternion)) => quaternion,
            Some(Err((name, expected))) => {
                self.error(name, Code::ZeroAxis, quote(self.text(name).unwrap_or_default()), expected, log);
                IDENTITY
            }
            None => IDENTITY,
        }
    }
}

/// The attribute of a tag, unless it is an empty list.
fn list<'a>(element: &'a Element, name: &str) -> Option<&'a Attribute> {
    element.attribute(name).filter(|attribute| !attribute.value.trim().is_empty())
}

fn numbers(element: &Element, attribute: &Attribute, subject: &Subject, log: &mut Diagnostics) -> Option<Vec<f64>> {
    let mut all = Vec::new();
    for word in attribute.value.split_ascii_whitespace() {
        match number::parse(word) {
            Ok(number) => all.push(number),
            // Numbers too small for a double are zero.
            Err(number::Fault::Vanishes) => all.push(0.0),
            Err(fault) => {
                let expected = if fault == number::Fault::NotFinite { "a finite number" } else { "a decimal number" };
                let code = if fault == number::Fault::NotFinite { Code::NotFinite } else { Code::NotANumber };
                element.error((subject, &attribute.name), code, quote(word), expected, log);
                return None;
            }
        }
    }
    Some(all)
}

/// How a file writes angles.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Angles {
    pub(crate) degrees: bool,
    /// The axes of three angles: small letters turn with the frame, capitals do not.
    pub(crate) sequence: [u8; 3],
}

impl Angles {
    pub(crate) fn radians(&self, angle: f64) -> f64 {
        if self.degrees { radians(angle) } else { angle }
    }

    pub(crate) fn euler(&self, angles: [f64; 3]) -> Quaternion {
        self.sequence.iter().zip(angles).fold(IDENTITY, |before, (axis, angle)| {
            let unit = match axis.to_ascii_lowercase() {
                b'x' => [1.0, 0.0, 0.0],
                b'y' => [0.0, 1.0, 0.0],
                _ => [0.0, 0.0, 1.0],
            };
            let turn = about(unit, self.radians(angle));
            if axis.is_ascii_lowercase() { multiply(before, turn) } else { multiply(turn, before) }
        })
    }
}
