//! `[effects]`: the effects that a scene requests besides rigid bodies and gravity.
//!
//! ```toml
//! [effects.damping]
//! "*" = "urdf"                # every joint, by its <dynamics>
//! elbow = 0.5                 # but this one
//! [effects.contact.left_foot] # a frame in a link
//! xyz = [0.0, 0.0, -0.02]
//! radius = 0.02
//! stiffness = 1e5
//! ```

use articulated_core::diagnostic::{At, Code, Diagnostics, quote};
mod collision;
mod file;
mod index;
mod placed;
mod plane;
mod resolve;
mod still;

use std::ops::Range;

use articulated_core::description::{Origin, Rotation};

use crate::scene::Scene;
use crate::shaft;
use crate::table::Cursor;
use crate::tree::Value;
use articulated_core::effect::{Effect, EffectId, Field, On, effect, effects};

pub(crate) use collision::is_of_shape;
pub use file::smooth_in_file;
pub(crate) use file::{sources, tag};
pub(crate) use index::indices;
pub use resolve::{Edited, Resolved};
pub use still::still;

/// A request of an effect.
#[derive(Clone, Debug, PartialEq)]
pub struct EffectRequest {
    /// The effect.
    pub effect: EffectId,
    /// The joints or links that it acts on.
    pub on: Selector,
    /// The numbers; `None`: the effect is off there.
    pub says: Option<Numbers>,
    /// Its key path.
    pub key: String,
    /// Its place in the scene.
    pub place: At,
}

/// The joints or links of a request.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Selector {
    /// `*`: all moving joints, or all moving links with mass, except the named ones.
    All,
    /// The joint, link or frame of this name.
    Named(String),
}

/// The given numbers of an effect.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Numbers {
    /// Missing numbers are taken from the robot's file, if it has them.
    pub from_urdf: bool,
    /// Points and radii are those of the link's collision geometry.
    pub from_collision: bool,
    /// The planes are those of the robot's file.
    pub from_file_planes: bool,
    /// The file may have no such numbers: there is no warning then.
    pub if_any: bool,
    /// The effect's frame, in the frame of its link or in a frame of the robot.
    pub at: Option<Origin>,
    /// One for each of the effect's fields.
    pub fields: Vec<Option<Vec<f64>>>,
}

/// The keys of an effect on a link that place its frame.
const FRAME: [&str; 2] = ["xyz", "rpy"];
/// The key for the source of numbers.
const FROM: &str = "from";
/// The selector of all unnamed joints or links.
const ALL: &str = "*";

/// Reads the table `effects` into the scene.
pub(crate) fn read(scene: &mut Scene, spot: &Cursor<'_>, log: &mut Diagnostics) {
    (scene.effects, scene.shafts) = (Vec::new(), Vec::new());
    if is_file(spot) {
        scene.add_file_effects(&spot.key, spot.at);
        return;
    }
    let mut of_file = None;
    for entry in spot.entries(log, "a table of effects, or \"file\"") {
        let value = spot.of(entry);
        if entry.name == shaft::NAME {
            scene.shafts = shaft::read(&value, log);
        } else if entry.name == ALL {
            match is_file(&value) {
                true => of_file = Some((value.key.clone(), value.at)),
                false => value.wrong(log, "\"file\": the smooth effects of the robot's file that have no entry of their own"),
            }
        } else if let Some(row) = effect(&entry.name) {
            scene.effects.extend(requests(row, &value, log));
        } else {
            value.unknown_key(log, effects().iter().map(|e| e.name).chain([shaft::NAME, ALL]));
        }
    }
    if let Some((key, place)) = of_file {
        scene.add_file_effects(&key, place);
    }
}

fn is_file(spot: &Cursor<'_>) -> bool {
    matches!(&spot.node.value, Value::Text(word) if word == "file")
}

impl Scene {
    /// A scene of the smooth effects of a robot's file, and nothing else.
    pub fn of_file_effects(file: &str) -> Self {
        let mut scene = Self { file: file.to_owned(), ..Self::default() };
        scene.add_file_effects("effects", At::default());
        scene
    }

    /// Requests the smooth effects of the robot's file that the scene does not name: damping,
    /// springs and armature of joints, and all effects on links. As `effects."*" = "file"`.
    pub fn add_file_effects(&mut self, key: &str, place: At) {
        let named = |row: &Effect| self.effects.iter().any(|one| one.effect == row.id);
        let request = |row: &'static Effect| EffectRequest {
            effect: row.id,
            on: Selector::All,
            says: Some(Numbers { from_urdf: true, if_any: true, ..empty(row) }),
            key: key.to_owned(),
            place,
        };
        let missing: Vec<EffectRequest> = effects().iter().filter(|row| file::is_smooth(row.id) && !named(row)).map(request).collect();
        self.effects.extend(missing);
    }
}

/// All requests of one effect.
fn requests(row: &'static Effect, spot: &Cursor<'_>, log: &mut Diagnostics) -> Vec<EffectRequest> {
    let Value::Table(entries) = &spot.node.value else { return on(row, &Selector::All, spot, log) };
    // A table with a source of numbers applies to all joints.
    if spot.get(FROM).is_some_and(|from| matches!(from.node.value, Value::Text(_))) {
        return on(row, &Selector::All, spot, log);
    }
    let selector = |name: &str| if name == ALL { Selector::All } else { Selector::Named(name.to_owned()) };
    entries.iter().flat_map(|entry| on(row, &selector(&entry.name), &spot.of(entry), log)).collect()
}

/// The request for one joint or link: a number, a word, a table, or a list of tables for a link.
fn on(row: &'static Effect, selector: &Selector, spot: &Cursor<'_>, log: &mut Diagnostics) -> Vec<EffectRequest> {
    let asked =
        |says, spot: &Cursor<'_>| EffectRequest { effect: row.id, on: selector.clone(), says, key: spot.key.clone(), place: spot.at };
    let before = log.count();
    let says = match &spot.node.value {
        Value::Text(word) if word == "off" => vec![asked(None, spot)],
        Value::Text(word) if file::source(word) == "urdf" && file::offers(row) => {
            vec![asked(Some(Numbers { from_urdf: true, ..empty(row) }), spot)]
        }
        Value::Text(word) if word == collision::WORD && collision::offers(row) => {
            vec![asked(Some(Numbers { from_collision: true, ..empty(row) }), spot)]
        }
        Value::Text(word) => {
            wrong_word(row, word, spot, log);
            Vec::new()
        }
        Value::Number(_) if shorthand(row) => {
            let first = row.fields.first().and_then(|field| number(field, spot, log));
            let mut numbers = empty(row);
            numbers.fields[0] = first.map(|x| vec![x]);
            vec![asked(Some(numbers), spot)]
        }
        Value::Table(_) => vec![asked(Some(table(row, spot, log)), spot)],
        Value::List(items) if row.on == On::Link => {
            let tables = spot.list().unwrap_or_default();
            if items.is_empty() {
                spot.wrong(log, "one table or several");
            }
            tables.iter().map(|item| asked(Some(table(row, item, log)), item)).collect()
        }
        _ => {
            spot.wrong(log, expected(row));
            Vec::new()
        }
    };
    if log.count() > before { Vec::new() } else { says }
}

fn empty(row: &Effect) -> Numbers {
    Numbers { fields: vec![None; row.fields.len()], ..Numbers::default() }
}

/// Whether one number, the first field's, is enough.
pub(crate) fn shorthand(row: &Effect) -> bool {
    row.fields.first().is_some_and(|f| f.len == 1) && row.fields.iter().skip(1).all(|f| f.default.is_some())
}

/// Words accepted in place of an effect's numbers.
fn expected(row: &Effect) -> String {
    let mut ways: Vec<String> = Vec::new();
    if shorthand(row) {
        ways.push(format!("a number ({}, {})", row.fields[0].name, row.fields[0].unit));
    }
    let name = |f: &Field| f.unless.map_or_else(|| f.name.to_owned(), |other| format!("{} or {other}", f.name));
    let required: Vec<String> = row.fields.iter().filter(|f| f.default.is_none()).map(name).collect();
    ways.push(format!("a table with {}", required.join(", ")));
    ways.extend(sources(row).map(|word| format!("\"{word}\"")));
    format!("{} or \"off\"", ways.join(", "))
}

fn wrong_word(row: &Effect, word: &str, spot: &Cursor<'_>, log: &mut Diagnostics) {
    let words = ["off"].into_iter().chain(sources(row));
    log.unknown(((spot.node.at, &spot.key), Code::Word), (quoted_with_reason(word), word), expected(row), words);
}

/// The numbers of a table.
fn table(row: &'static Effect, spot: &Cursor<'_>, log: &mut Diagnostics) -> Numbers {
    let mut numbers = empty(row);
    let before = log.count();
    for entry in spot.entries(log, &expected(row)) {
        let value = spot.of(entry);
        let field = row.fields.iter().position(|f| f.name == entry.name);
        match (field, entry.name.as_str()) {
            (Some(i), _) => numbers.fields[i] = field_of(as_written(row, &row.fields[i], &value), &value, log),
            (None, FROM) => match from(row, &value, log) {
                Some(collision::WORD) => numbers.from_collision = true,
                word => numbers.from_urdf = word.is_some(),
            },
            (None, "xyz") if row.on == On::Link => numbers.at.get_or_insert_default().xyz = value.numbers(log).unwrap_or_default(),
            (None, "rpy") if row.on == On::Link => {
                numbers.at.get_or_insert_default().rotation = Rotation::RollPitchYaw(value.numbers(log).unwrap_or_default());
            }
            (None, plane::KEY) if plane::offers(row) => numbers.from_file_planes = plane::is_of_file(&value, log),
            _ => value.unknown_key(log, keys(row)),
        }
    }
    if numbers.from_collision {
        collision::refuse_own_points(spot, log);
    }
    if numbers.from_file_planes {
        plane::refuse_own_plane(spot, log);
    }
    if log.count() == before {
        check(row, &numbers, spot, log);
    }
    numbers
}

/// The keys of an effect's table.
fn keys(row: &'static Effect) -> impl Iterator<Item = &'static str> {
    let own = row.fields.iter().map(|f| f.name);
    let frame = FRAME.into_iter().filter(|_| row.on == On::Link);
    let plane = Some(plane::KEY).filter(|_| plane::offers(row));
    own.chain(frame).chain(Some(FROM).filter(|_| sources(row).next().is_some())).chain(plane)
}

/// The source of numbers that are not given.
fn from(row: &Effect, spot: &Cursor<'_>, log: &mut Diagnostics) -> Option<&'static str> {
    let expected = sources(row).next().map_or("numbers".into(), |word| format!("\"{word}\""));
    let Value::Text(word) = &spot.node.value else {
        spot.wrong(log, expected);
        return None;
    };
    let source = sources(row).find(|source| *source == file::source(word));
    if source.is_none() {
        log.error((spot.node.at, &spot.key), Code::Word, quoted_with_reason(word), expected);
    }
    source
}

/// A word for a source of numbers that an effect does not have.
fn quoted_with_reason(word: &str) -> String {
    let why = match file::source(word) {
        "urdf" => ", which has no numbers for it",
        collision::WORD => ", which has no geometry for it",
        _ => "",
    };
    format!("{}{why}", quote(word))
}

/// The field on a ball joint, if its length is that of the written numbers: the kind of the joint
/// is unknown here.
fn as_written(row: &'static Effect, field: &'static Field, spot: &Cursor<'_>) -> &'static Field {
    let Some(count) = spot.list().map(|list| list.len()) else { return field };
    let on_ball = row.ball_fields.unwrap_or_default().iter().find(|other| other.name == field.name && other.len == count);
    on_ball.filter(|other| other.len > 1).unwrap_or(field)
}

fn field_of(field: &Field, spot: &Cursor<'_>, log: &mut Diagnostics) -> Option<Vec<f64>> {
    if field.len == 1 {
        return number(field, spot, log).map(|x| vec![x]);
    }
    let unit = if field.unit == "1" { String::new() } else { format!(", {}", field.unit) };
    let expected = format!("{} finite numbers{unit}", field.len);
    let Some(items) = spot.list().filter(|list| list.len() == field.len) else {
        spot.wrong(log, expected);
        return None;
    };
    items.iter().map(|item| number(field, item, log)).collect()
}

fn number(field: &Field, spot: &Cursor<'_>, log: &mut Diagnostics) -> Option<f64> {
    spot.within(log, field.range)
}

/// Checks the joint constraint of the numbers. If a number comes from the file or from `*`, the
/// model checks it.
fn check(row: &'static Effect, numbers: &Numbers, spot: &Cursor<'_>, log: &mut Diagnostics) {
    let default = |field: &Field| resolve::default_of(row, field, std::iter::once(numbers));
    let given = |(i, field): (usize, &'static Field)| numbers.fields[i].clone().or_else(|| default(field));
    let Some(all) = row.fields.iter().enumerate().map(given).collect::<Option<Vec<Vec<f64>>>>().filter(|_| !numbers.from_urdf) else {
        return;
    };
    let all = all.concat();
    let Some((broken, _)) = row.broken(&all) else { return };
    let expected = broken.rule.map_or("", |rule| rule.expected);
    for (field, own) in blamed(row, numbers, broken, &all) {
        let at = spot.get(field.name).unwrap_or(Cursor { node: spot.node, key: spot.key.clone(), at: spot.at });
        let found = own.iter().map(|x| format!("{x:?}")).collect::<Vec<_>>().join(", ");
        // The rule names its own field; the message names this one.
        at.clash(log, found, expected.replace(field.name, broken.name));
    }
}

/// The fields that break a rule, with their part of `all`: the rule's own field if it is written,
/// else written fields that break it with zeros for the others.
fn blamed<'a>(row: &'static Effect, numbers: &Numbers, broken: &'static Field, all: &'a [f64]) -> Vec<(&'static Field, &'a [f64])> {
    let parts = row.fields_of(all.len()).iter().zip(&numbers.fields).scan(0, |end, (field, said)| {
        let start = *end;
        *end += field.len;
        Some((field, said.is_some(), start..*end))
    });
    let own_is_written = parts.clone().any(|(field, said, _)| said && field.name == broken.name);
    let alone = |part: &Range<usize>| {
        let mut others = vec![0.0; all.len()];
        others[part.clone()].copy_from_slice(&all[part.clone()]);
        row.broken(&others).is_some()
    };
    let is = |field: &Field, part: &Range<usize>| if own_is_written { field.name == broken.name } else { alone(part) };
    parts.filter(|(field, said, part)| *said && is(field, part)).map(|(field, _, part)| (field, &all[part])).collect()
}
