//! Errors of the generator: where they show, and how to go on.

use articulated_codegen::core::description::EditError;
use articulated_codegen::scene::articulated_scene::SceneError;
use articulated_codegen::{Edit, Error, Reason, Refusal, RobotError, entry_of};
use proc_macro2::Span;
use syn::LitStr;

use crate::errors::Errors;
use crate::settings::Settings;

/// The error at the word of the invocation that it is about: a function, a new name, otherwise the robot's file.
pub(crate) fn at_its_word(error: &Error, settings: &Settings, robot: Span) -> syn::Error {
    let renamed = |name: &String| settings.rename.iter().flatten().find(|r| r.from.text == *name);
    let span = match error {
        Error::Several { errors } => return all(errors.iter().map(|error| at_its_word(error, settings, robot)), error, robot),
        Error::Robot(error) => return of_the_robot(error, settings, robot),
        Error::UnknownFunction { found: function, .. }
        | Error::Singular { function, .. }
        | Error::BoundFrames { function, .. }
        | Error::NoMass { function, .. }
        | Error::Wanted { found: function, .. }
        | Error::SameName { name: function } => {
            let entries: Vec<_> = settings.functions.iter().flatten().collect();
            entry_of(entries.iter().map(|e| e.text.as_str()), function).map(|at| entries[at].span)
        }
        Error::Parameter { found, .. } => settings.parameters.iter().flatten().rfind(|e| e.text.trim() == *found).map(|e| e.span),
        Error::Rename { from, .. } => renamed(from).map(|r| r.from.span),
        Error::NameClash { first, second, .. } => renamed(second).or_else(|| renamed(first)).map(|r| r.to.span()),
        _ => None,
    };
    syn::Error::new(span.unwrap_or(robot), error)
}

/// The same of the robot as it is asked for.
fn of_the_robot(error: &RobotError, settings: &Settings, robot: Span) -> syn::Error {
    match error {
        RobotError::Several { errors } => all(errors.iter().map(|error| of_the_robot(error, settings, robot)), error, robot),
        RobotError::Scene(errors) => all(errors.errors.iter().map(|error| in_scene(error, settings, robot)), errors, robot),
        RobotError::Urdf(problems) => each(problems, robot),
        RobotError::Edits { refusals } => all(refusals.iter().map(|refusal| refused(refusal, settings, robot)), error, robot),
        _ => syn::Error::new(robot, error),
    }
}

/// A mistake in the scene, at the scene; one in `effects`, at its word.
pub(crate) fn in_scene(error: &SceneError, settings: &Settings, robot: Span) -> syn::Error {
    match settings.spans.of(error.at) {
        Some(span) => syn::Error::new(span, error.message()),
        None => syn::Error::new(settings.scene.as_ref().map_or(robot, LitStr::span), error),
    }
}

/// One error for each mistake in the document.
fn each(problems: &articulated_codegen::urdf::Problems, span: Span) -> syn::Error {
    all(problems.errors.iter().map(|problem| syn::Error::new(span, problem)), problems, span)
}

/// Several errors as one; there is one at least.
fn all(errors: impl Iterator<Item = syn::Error>, whole: impl std::fmt::Display, span: Span) -> syn::Error {
    let mut together = Errors::default();
    errors.for_each(|error| together.push(error));
    together.into_error().unwrap_or_else(|| syn::Error::new(span, whole))
}

/// An edit that cannot be made, at its name or file.
fn refused(refusal: &Refusal, settings: &Settings, robot: Span) -> syn::Error {
    let span = match refusal.edit {
        Edit::Append(i) => settings.append.as_ref().and_then(|all| all.get(i)).and_then(|other| match refusal.reason {
            Reason::Edit(EditError::UnknownLink { .. }) => other.at.as_ref().map(|name| name.span),
            _ => other.urdf.as_ref().map(LitStr::span),
        }),
        Edit::Payload(i) => settings.payloads.as_ref().and_then(|all| all.get(i)?.link.as_ref()).map(|name| name.span),
        Edit::Shaft(_) => None,
        Edit::Lock(i) => settings.lock.as_ref().and_then(|all| all.get(i)).map(|lock| lock.joint.span),
        Edit::Frame(i) => settings.frames.as_ref().and_then(|names| names.get(i)).map(|name| name.span),
    };
    let span = span.unwrap_or(robot);
    match &refusal.reason {
        Reason::Urdf(problems) => each(problems, span),
        _ => syn::Error::new(span, refusal),
    }
}
