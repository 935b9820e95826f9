//! What was refused of a request, at the places of the scene that asks for it.

use articulated_scene::{At, Scene, SceneError, by_places};

use crate::Error;
use crate::faults::entry_of;

/// What the scene asks for and was refused, by its places in the scene; other errors as they are, after it.
pub fn placed(error: Error, scene: &Scene) -> Error {
    let placed = by_places(error.into_each(), |error| in_its_place(error, scene));
    Error::of(placed).expect("as many errors as there were")
}

/// `None`: it is not the scene's.
pub(super) fn in_its_place(error: &Error, scene: &Scene) -> Option<Vec<SceneError>> {
    let (code, places) = (&scene.code, &scene.code.places);
    let entry = |list: &Option<Vec<String>>, at: &[At], is: &dyn Fn(&str) -> bool| {
        list.as_ref()?.iter().rposition(|entry| is(entry)).map(|i| place_of(at, i))
    };
    let function = |name: &str| {
        let at = entry_of(code.functions.as_ref()?.iter().map(String::as_str), name)?;
        Some(place_of(&places.functions, at))
    };
    let renaming = |from: &str| code.rename.iter().rposition(|(name, _)| name == from).map(|i| place_of(&places.rename, i));
    let refused = |at, key: &str, found| vec![scene.refused(at, key, found)];
    let whole = error.to_string();
    match error {
        Error::Robot(error) => error.in_scene(scene),
        Error::UnknownFunction { found: name, .. }
        | Error::Singular { function: name, .. }
        | Error::BoundFrames { function: name, .. }
        | Error::NoMass { function: name, .. }
        | Error::TooMuchCode { function: name, .. } => function(name).map(|at| refused(at, "functions", whole)),
        // They begin with their key.
        Error::FunctionSpec { found: name, .. } | Error::SameName { name } => function(name).map(|at| refused(at, "", whole)),
        Error::Parameter { found, .. } => {
            entry(&code.parameters, &places.parameters, &|entry| entry.trim() == found).map(|at| refused(at, "", whole))
        }
        Error::Rename { from, to, reason, .. } => {
            renaming(from).map(|at| refused(at, &format!("rename.{from}"), format!("to `{to}`: {reason}")))
        }
        Error::NameClash { kind, first, second, ident, .. } => {
            let (at, name) = [second, first].into_iter().find_map(|name| Some((renaming(name)?, name)))?;
            let found = format!("{kind}s {first:?} and {second:?} are both `{ident}` in Rust; give one another name");
            Some(refused(at, &format!("rename.{name}"), found))
        }
        _ => None,
    }
}

/// The place of one of a list.
fn place_of(places: &[At], i: usize) -> At {
    places.get(i).copied().unwrap_or_default()
}
