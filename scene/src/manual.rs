//! The tables of `docs/scenes.md` and `docs/effects.md`, generated from the tables of the reader.

use std::fmt::Write;

use crate::table::Row;
use crate::{control, edits, impact, initial, scene, shaft, simulation};
use articulated_core::effect::{Effect, On, effects};

/// All tables, each under its name: Markdown.
pub fn tables() -> Vec<(&'static str, String)> {
    let mut tables = vec![
        ("top", keys(scene::KEYS)),
        ("payload", keys(edits::LOAD)),
        ("append", keys(edits::APPEND)),
        ("effects", list()),
        ("fields", fields()),
        ("shaft", keys(shaft::KEYS)),
        ("simulation", keys(simulation::KEYS)),
        ("initial", keys(initial::KEYS)),
        ("initial.base", keys(initial::BASE)),
        ("control", keys(control::KEYS)),
        ("impact", keys(impact::KEYS)),
    ];
    tables.iter_mut().for_each(|(_, text)| text.truncate(text.trim_end().len()));
    tables
}

fn keys<T>(rows: &[Row<T>]) -> String {
    let mut out = String::from("| key | value | default | |\n|---|---|---|---|\n");
    for row in rows {
        let default = if row.required { "has to be given" } else { row.default };
        let _ = writeln!(out, "| `{}` | {} | {} | {} |", row.name, row.value, default, row.what);
    }
    out
}

/// One line an effect.
fn list() -> String {
    let mut out = String::from("| effect | on | law | source | by itself |\n|---|---|---|---|---|\n");
    for effect in effects() {
        let on = if effect.on == On::Joint { "joints" } else { "links" };
        let _ = writeln!(out, "| `{}` | {on} | {} | {} | {} |", effect.name, effect.what.replace('|', "\\|"), effect.source, ways(effect));
    }
    out
}

/// The short forms that replace a table.
fn ways(effect: &Effect) -> String {
    let mut ways = Vec::new();
    if crate::effects::shorthand(effect) {
        ways.push(format!("number: `{}`", effect.fields[0].name));
    }
    ways.extend(crate::effects::sources(effect).map(|word| format!("`\"{word}\"`")));
    ways.push("`\"off\"`".to_owned());
    ways.join(", ")
}

/// One line a field.
fn fields() -> String {
    let mut out = String::from("| effect | key | numbers | unit | default | |\n|---|---|--:|---|---|---|\n");
    let fields = |effect: &'static Effect| {
        let ball = effect.ball_fields.unwrap_or_default().iter().map(move |field| (format!("{}, on balls", effect.name), effect, field));
        effect.fields.iter().map(move |field| (effect.name.to_owned(), effect, field)).chain(ball)
    };
    for effect in effects() {
        for (name, effect, field) in fields(effect) {
            let default = match field.default {
                None if crate::effects::is_of_shape(effect, field.name) => "has to be given; `\"collision\"`: that of the shape".to_owned(),
                None if field.unless.is_some() => {
                    format!("has to be given, but where `{}` is", field.unless.unwrap_or_default())
                }
                None => crate::effects::tag(effect.id, field.name)
                    .map_or("has to be given".to_owned(), |tag| format!("has to be given; `\"urdf\"`: {tag}")),
                Some([x]) => format!("{x:?}"),
                Some(x) if x.iter().all(|x| *x == 0.0) => "zeros".to_owned(),
                Some(x) => format!("{x:?}"),
            };
            let bounds = Some(field.range.bounds()).filter(|bounds| !bounds.is_empty());
            let rule = field.rule.map(|rule| rule.expected.to_owned());
            let has_to_be: String = bounds.into_iter().chain(rule).map(|what| format!(", {what}")).collect();
            let unit = field.unit.replace('|', " or ");
            let _ = writeln!(out, "| {name} | `{}` | {} | {unit} | {default} | {}{has_to_be} |", field.name, field.len, field.what);
        }
    }
    out
}
