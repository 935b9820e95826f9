//! What was refused of a robot, at the places of the scene that asks for it.

use articulated_core::description::EditError;
use articulated_core::suggest::nearest;

use super::error::RobotError;
use super::error::{Edit, Reason, Refusal};
use super::open::Bundled;
use crate::error::{Kind, SceneError, SceneErrors};
use crate::scene::{Robot, Scene};
use crate::tree::At;

impl RobotError {
    /// What the scene asks for and was refused, by its places in the scene; other errors as they are, after it.
    pub fn placed(self, scene: &Scene) -> Self {
        let placed = by_places(self.into_each(), |error| error.in_scene(scene));
        Self::of(placed).expect("as many errors as there were")
    }

    /// The error, or each of several, at its place in the scene. `None`: it is not the scene's.
    pub fn in_scene(&self, scene: &Scene) -> Option<Vec<SceneError>> {
        match self {
            Self::Scene(SceneErrors { errors }) => Some(errors.clone()),
            Self::Edits { refusals } => {
                refusals.iter().map(|refusal| place(refusal, scene)).collect::<Option<Vec<_>>>().map(|each| each.concat())
            }
            _ => None,
        }
    }
}

/// Those of the scene, which `in_scene` finds, as one and in the order of its lines; others as they are, after it.
pub fn by_places<E: From<SceneErrors>>(errors: Vec<E>, in_scene: impl Fn(&E) -> Option<Vec<SceneError>>) -> Vec<E> {
    let (mut placed, mut all) = (Vec::new(), Vec::new());
    for error in errors {
        match in_scene(&error) {
            Some(found) => placed.extend(found),
            None => all.push(error),
        }
    }
    placed.sort_by_key(|error| error.at);
    let placed = Some(SceneErrors { errors: placed }).filter(|placed| !placed.errors.is_empty());
    all.splice(..0, placed.map(E::from));
    all
}

/// `None`: it is not the scene's.
fn place(refusal: &Refusal, scene: &Scene) -> Option<Vec<SceneError>> {
    let code = &scene.code;
    let (at, key) = match refusal.edit {
        Edit::Append(i) => {
            let is_about_link = matches!(refusal.reason, Reason::Edit(EditError::UnknownLink { .. }));
            let other = code.append.get(i)?;
            (if is_about_link { other.link_place } else { other.place }, "append".to_owned())
        }
        Edit::Payload(i) => (code.payload.get(i)?.place, "payload".to_owned()),
        Edit::Shaft(i) => scene.shafts.get(i).map(|asked| (asked.place, format!("effects.shaft.{}", asked.shaft.joint)))?,
        Edit::Lock(i) => code.lock.get(i).map(|lock| (lock.place, format!("lock.{}", lock.joint)))?,
        Edit::Frame(i) => {
            let named = code.frames.as_ref()?.get(i)?;
            let at = code.places.frames.get(i).copied().unwrap_or_default();
            is_about(&refusal.reason, named).then(|| (at, "frames".to_owned()))?
        }
    };
    let found = match &refusal.reason {
        Reason::Edit(error) => vec![error.to_string()],
        Reason::Urdf(problems) => problems.errors.iter().map(ToString::to_string).collect(),
        Reason::FrameTwice(name) => vec![format!("{name:?} is listed twice")],
    };
    Some(found.into_iter().map(|found| scene.refused(at, &key, found)).collect())
}

/// Whether a frame was refused because of this link: others may stand in place of the scene's.
fn is_about(reason: &Reason, link: &str) -> bool {
    match reason {
        Reason::Edit(EditError::UnknownLink { name, .. }) | Reason::FrameTwice(name) => name == link,
        _ => false,
    }
}

impl Scene {
    /// What `found` says, at a place of the scene.
    pub fn refused(&self, at: At, key: &str, found: String) -> SceneError {
        SceneError { file: self.file.clone(), at, key: key.to_owned(), kind: Kind::Refused, found, expected: String::new(), nearest: None }
    }

    /// A file that the scene names cannot be had.
    pub(super) fn unreadable(&self, at: At, key: &str, error: &RobotError) -> RobotError {
        SceneErrors { errors: vec![self.refused(at, key, error.to_string())] }.into()
    }

    /// The scene calls its robot by a name that nobody knows.
    pub(super) fn unknown_robot(&self, name: &str, bundled: &[Bundled<'_>]) -> SceneErrors {
        let names: Vec<&str> = bundled.iter().map(|one| one.name).collect();
        let expected =
            if names.is_empty() { "urdf: no robot is known by name here".to_owned() } else { format!("one of {}", names.join(", ")) };
        let mut all = self.without_robot(&format!("{name:?}, no such robot"), &expected);
        all.errors[0].nearest = nearest(name, names);
        all
    }

    /// The scene has no robot that could be had.
    pub fn without_robot(&self, found: &str, expected: &str) -> SceneErrors {
        let (found, expected) = (found.to_owned(), expected.to_owned());
        let key = if self.robot == Robot::Given { String::new() } else { "robot".to_owned() };
        let at = self.code.places.robot;
        let error = SceneError { file: self.file.clone(), at, key, kind: Kind::UnknownName, found, expected, nearest: None };
        SceneErrors { errors: vec![error] }
    }
}
