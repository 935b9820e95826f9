//! What was refused of a request, at the places of the scene that asks for it.

use articulated_core::description::EditError;
use articulated_scene::{At, Kind, Robot, Scene, SceneError, SceneErrors};

use crate::faults::mentions;
use crate::{Edit, Error, Reason, Refusal};

/// What the scene asks for and was refused, by its places in the scene; other errors as they are, after it.
pub fn placed(error: Error, scene: &Scene) -> Error {
    let (mut in_scene, mut others) = (Vec::new(), Vec::new());
    for error in error.into_each() {
        match error {
            Error::Scene(SceneErrors { errors }) => in_scene.extend(errors),
            error => match in_its_place(&error, scene) {
                Some(placed) => in_scene.extend(placed),
                None => others.push(error),
            },
        }
    }
    in_scene.sort_by_key(|error| error.at);
    let in_scene = Some(SceneErrors { errors: in_scene }).filter(|all| !all.errors.is_empty());
    others.splice(..0, in_scene.map(Error::from));
    Error::of(others).expect("as many errors as there were")
}

/// `None`: it is not the scene's.
pub(super) fn in_its_place(error: &Error, scene: &Scene) -> Option<Vec<SceneError>> {
    let (code, places) = (&scene.code, &scene.code.places);
    let entry = |list: &Option<Vec<String>>, at: &[At], is: &dyn Fn(&str) -> bool| {
        list.as_ref()?.iter().rposition(|entry| is(entry)).map(|i| place_of(at, i))
    };
    let function = |name: &str| entry(&code.functions, &places.functions, &|entry| mentions(entry, name));
    let renaming = |from: &str| code.rename.iter().rposition(|(name, _)| name == from).map(|i| place_of(&places.rename, i));
    let refused = |at, key: &str, found| vec![refused(scene, at, key.to_owned(), found)];
    let whole = error.to_string();
    match error {
        Error::Edits { refusals } => {
            refusals.iter().map(|refusal| place(refusal, scene)).collect::<Option<Vec<_>>>().map(|each| each.concat())
        }
        Error::UnknownFunction { found, .. } => function(found).map(|at| refused(at, "functions", whole)),
        // They begin with their key.
        Error::Wanted { found: name, .. } | Error::SameName { name } => function(name).map(|at| refused(at, "", whole)),
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

fn refused(scene: &Scene, at: At, key: String, found: String) -> SceneError {
    SceneError { file: scene.file.clone(), at, key, kind: Kind::Refused, found, expected: String::new(), nearest: None }
}

/// `None`: it is not the scene's.
fn place(refusal: &Refusal, scene: &Scene) -> Option<Vec<SceneError>> {
    let code = &scene.code;
    let (at, key) = match refusal.edit {
        Edit::Append(i) => (code.append.get(i)?.place, "append".to_owned()),
        Edit::Payload(i) => (code.payload.get(i)?.place, "payload".to_owned()),
        Edit::Shaft(i) => scene.shafts.get(i).map(|asked| (asked.place, format!("effects.shaft.{}", asked.shaft.joint)))?,
        Edit::Lock(i) => code.lock.get(i).map(|lock| (lock.place, format!("lock.{}", lock.joint)))?,
        Edit::Frame(i) => {
            let named = code.frames.as_ref()?.get(i)?;
            is_about(&refusal.reason, named).then(|| (place_of(&code.places.frames, i), "frames".to_owned()))?
        }
    };
    let found = match &refusal.reason {
        Reason::Edit(error) => vec![error.to_string()],
        Reason::Urdf(problems) => problems.errors.iter().map(ToString::to_string).collect(),
        Reason::FrameTwice(name) => vec![format!("{name:?} is listed twice")],
    };
    Some(found.into_iter().map(|found| refused(scene, at, key.clone(), found)).collect())
}

/// Whether a frame was refused because of this link: others may stand in place of the scene's.
fn is_about(reason: &Reason, link: &str) -> bool {
    match reason {
        Reason::Edit(EditError::UnknownLink { name, .. }) | Reason::FrameTwice(name) => name == link,
        _ => false,
    }
}

/// A file that the scene names cannot be had.
pub(crate) fn unreadable(scene: &Scene, at: At, key: &str, error: &Error) -> Error {
    SceneErrors { errors: vec![refused(scene, at, key.to_owned(), error.to_string())] }.into()
}

/// The scene has no robot that could be had.
pub(crate) fn no_robot(scene: &Scene, found: &str, expected: &str) -> Error {
    let (found, expected) = (found.to_owned(), expected.to_owned());
    let key = if scene.robot == Robot::Given { String::new() } else { "robot".to_owned() };
    let at = scene.code.places.robot;
    let error = SceneError { file: scene.file.clone(), at, key, kind: Kind::UnknownName, found, expected, nearest: None };
    SceneErrors { errors: vec![error] }.into()
}
