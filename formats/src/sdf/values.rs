//! Numbers, words and poses inside tags.

use articulated_core::diagnostic::{Code, Diagnostics, Subject, quote};

use crate::pose::{IDENTITY, Pose, Quaternion, about, multiply, radians};
use crate::urdf::right_angle;
use crate::xml::element::FIRST_OF_DUPLICATES;
use crate::xml::number::{self, Fault};
use crate::xml::tree::Element;

/// Limits of this size or more mean no limit: the default of older versions.
const UNLIMITED: f64 = 1e16;

/// The only child of this name. A second one is an error, or a warning if it has the same content.
pub(crate) fn only<'a>(parent: &'a Element, name: &str, subject: &Subject, log: &mut Diagnostics) -> Option<&'a Element> {
    let mut all = parent.children.iter().filter(|child| child.is(name));
    let first = all.next()?;
    for again in all {
        let (code, line) = (Code::DuplicateTag, first.at.line().unwrap_or_default());
        let expected = format!("one <{name}> inside <{}>", parent.name);
        if again.says_the_same(first) {
            let found = format!("a second <{name}>, equal to the first in line {line}");
            again.warning((subject, name), code, found, format!("{expected}; used once"), log);
            continue;
        }
        let found = format!("a second <{name}> (the first is in line {line})");
        match again.file.first_of_duplicates {
            true => again.warning((subject, name), code, found, format!("{expected}; the first is used"), log),
            false => again.error((subject, name), code, found, format!("{expected}; {FIRST_OF_DUPLICATES} takes the first"), log),
        }
    }
    Some(first)
}

/// The text of a tag; empty if it has none.
pub(crate) fn text(element: &Element) -> &str {
    element.content.as_deref().unwrap_or_default()
}

/// A required, non-empty name in a child tag.
pub(crate) fn name<'a>(parent: &'a Element, tag: &str, subject: &Subject, log: &mut Diagnostics) -> Option<(&'a Element, &'a str)> {
    let Some(element) = only(parent, tag, subject, log) else {
        parent.error((subject, tag), Code::MissingTag, "none", format!("<{tag}> inside <{}>", parent.name), log);
        return None;
    };
    let name = text(element);
    if name.is_empty() {
        element.error((subject, tag), Code::EmptyName, "an empty name", "a name", log);
        return None;
    }
    Some((element, name))
}

fn numbers(element: &Element, may_be_infinite: bool, subject: &Subject, log: &mut Diagnostics) -> Option<Vec<f64>> {
    let mut all = Vec::new();
    for word in text(element).split_ascii_whitespace() {
        match number::parse(word) {
            Ok(number) => all.push(number),
            // Numbers too small for a double are zero.
            Err(Fault::Vanishes) => all.push(0.0),
            Err(Fault::NotFinite) if may_be_infinite && !word.to_ascii_lowercase().contains("nan") => {
                all.push(if word.starts_with('-') { f64::NEG_INFINITY } else { f64::INFINITY });
            }
            Err(fault) => {
                let (code, expected) = match fault {
                    Fault::NotFinite => (Code::NotFinite, "a finite number"),
                    _ => (Code::NotANumber, "a decimal number"),
                };
                element.error((subject, &element.name), code, quote(word), expected, log);
                return None;
            }
        }
    }
    Some(all)
}

fn counted<const N: usize>(element: &Element, may_be_infinite: bool, subject: &Subject, log: &mut Diagnostics) -> Option<[f64; N]> {
    let numbers = numbers(element, may_be_infinite, subject, log)?;
    let exact = numbers.as_slice().try_into().ok();
    if exact.is_none() {
        let found = format!("{} numbers in {}", numbers.len(), quote(text(element)));
        let expected = if N == 1 { "one number".to_owned() } else { format!("{N} numbers") };
        element.error((subject, &element.name), Code::WrongCount, found, expected, log);
    }
    exact
}

/// Exactly `N` numbers.
pub(crate) fn exactly<const N: usize>(element: &Element, subject: &Subject, log: &mut Diagnostics) -> Option<[f64; N]> {
    counted(element, false, subject, log)
}

/// The number in a child, if there is a valid one.
pub(crate) fn number(parent: &Element, name: &str, subject: &Subject, log: &mut Diagnostics) -> Option<f64> {
    counted::<1>(only(parent, name, subject, log)?, false, subject, log).map(|[number]| number)
}

/// As [`number`], for a bound; infinite if it is the format's default for no bound.
pub(crate) fn bound(parent: &Element, name: &str, subject: &Subject, log: &mut Diagnostics) -> Option<f64> {
    let [number] = counted::<1>(only(parent, name, subject, log)?, true, subject, log)?;
    Some(if number.abs() >= UNLIMITED { f64::INFINITY.copysign(number) } else { number })
}

fn truth(word: &str) -> Option<bool> {
    match word.to_ascii_lowercase().as_str() {
        "true" | "1" => Some(true),
        "false" | "0" => Some(false),
        _ => None,
    }
}

/// The truth value of a child; `None` if there is none.
pub(crate) fn yes(parent: &Element, name: &str, subject: &Subject, log: &mut Diagnostics) -> Option<bool> {
    let element = only(parent, name, subject, log)?;
    let found = truth(text(element));
    if found.is_none() {
        element.error((subject, name), Code::Word, quote(text(element)), "true or false", log);
    }
    found
}

/// The truth value of an attribute; false without it.
pub(crate) fn flag(element: &Element, name: &str, subject: &Subject, log: &mut Diagnostics) -> bool {
    let Some(word) = element.text(name) else { return false };
    let found = truth(word.trim());
    if found.is_none() {
        element.error((subject, name), Code::Word, quote(word), "true or false", log);
    }
    found.unwrap_or(false)
}

/// A quaternion with a norm further from 1 is a warning.
const ROUNDED: f64 = 1e-3;

/// The pose in a `<pose>`; an empty text means zero.
pub(crate) fn pose(element: &Element, snap: Option<f64>, subject: &Subject, log: &mut Diagnostics) -> Pose {
    let degrees = flag(element, "degrees", subject, log);
    if text(element).is_empty() {
        return Pose::default();
    }
    match element.text("rotation_format").map_or("euler_rpy", str::trim) {
        "euler_rpy" => {
            let Some([x, y, z, rpy @ ..]) = exactly::<6>(element, subject, log) else { return Pose::default() };
            let [roll, pitch, yaw] = rpy.map(|angle| snapped(if degrees { radians(angle) } else { angle }, snap, element, log));
            Pose { position: [x, y, z], rotation: of_rpy([roll, pitch, yaw]) }
        }
        "quat_xyzw" => {
            let Some([x, y, z, qx, qy, qz, qw]) = exactly::<7>(element, subject, log) else { return Pose::default() };
            let size = [qx, qy, qz, qw].iter().fold(0.0_f64, |most, q| most.max(q.abs()));
            let norm = size * [qx, qy, qz, qw].iter().map(|q| (q / size.max(f64::MIN_POSITIVE)).powi(2)).sum::<f64>().sqrt();
            if norm == 0.0 || !norm.is_finite() {
                element.error((subject, "pose"), Code::QuaternionNorm, format!("the norm {norm}"), "1", log);
                return Pose::default();
            }
            if (norm - 1.0).abs() > ROUNDED {
                let expected = "1; used as if it were 1";
                element.warning((subject, "pose"), Code::QuaternionNorm, format!("the norm {norm}"), expected, log);
            }
            Pose { position: [x, y, z], rotation: [qw, qx, qy, qz] }
        }
        other => {
            element.error((subject, "rotation_format"), Code::Word, quote(other), "euler_rpy or quat_xyzw", log);
            Pose::default()
        }
    }
}

fn snapped(angle: f64, snap: Option<f64>, element: &Element, log: &mut Diagnostics) -> f64 {
    match snap.and_then(|tolerance| right_angle(angle, tolerance)) {
        Some((quarters, exact)) => {
            let mut own = Diagnostics::new(&element.file.name);
            own.replaced((element.at, "pose"), Code::Snapped, angle, &format!("{quarters}·π/2"));
            log.take(own);
            exact
        }
        None => angle,
    }
}

/// R = Rz(yaw)·Ry(pitch)·Rx(roll).
fn of_rpy([roll, pitch, yaw]: [f64; 3]) -> Quaternion {
    let turns = [([0.0, 0.0, 1.0], yaw), ([0.0, 1.0, 0.0], pitch), ([1.0, 0.0, 0.0], roll)];
    turns.iter().filter(|(_, angle)| *angle != 0.0).fold(IDENTITY, |turn, (axis, angle)| multiply(turn, about(*axis, *angle)))
}
