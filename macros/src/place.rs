//! Errors of the generator: where they show, and how to go on.

use articulated_codegen::core::description::EditError;
use articulated_codegen::scene::articulated_scene::SceneError;
use articulated_codegen::{Edit, Error, Options, Reason, Refusal};
use proc_macro2::Span;
use syn::LitStr;

use crate::errors::Errors;
use crate::settings::Settings;

/// The error at the word of the invocation that it is about: a function, a new name, otherwise the robot's file.
pub(crate) fn at_its_word(error: &Error, settings: &Settings, robot: Span) -> syn::Error {
    let renamed = |name: &String| settings.rename.iter().find(|r| r.from.value() == *name);
    let span = match error {
        Error::Scene(errors) => return all(errors.errors.iter().map(|error| in_scene(error, settings, robot)), errors, robot),
        Error::Urdf(problems) => return each(problems, robot),
        Error::Edits { refusals } => return all(refusals.iter().map(|refusal| refused(refusal, settings, robot)), error, robot),
        Error::UnknownFunction { found: function, .. }
        | Error::Singular { function, .. }
        | Error::BoundFrames { function, .. }
        | Error::NoMass { function, .. }
        | Error::Wanted { found: function, .. }
        | Error::SameName { name: function } => settings.functions.iter().flatten().rfind(|e| names(&e.text, function)).map(|e| e.span),
        Error::Parameter { found, .. } => settings.parameters.iter().rfind(|e| e.text.trim() == *found).map(|e| e.span),
        Error::Rename { from, .. } => renamed(from).map(|r| r.from.span()),
        Error::NameClash { first, second, .. } => renamed(second).or_else(|| renamed(first)).map(|r| r.to.span()),
        _ => None,
    };
    syn::Error::new(span.unwrap_or(robot), error)
}

/// Whether an entry is the function, or has it in it.
fn names(entry: &str, function: &str) -> bool {
    entry.trim() == function || entry.split(|c: char| !c.is_alphanumeric() && c != '_').any(|word| word == function)
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
        Edit::Append(i) => settings.append.get(i).and_then(|other| match refusal.reason {
            Reason::Edit(EditError::UnknownLink { .. }) => other.at.as_ref().map(|name| name.span),
            _ => other.urdf.as_ref().map(LitStr::span),
        }),
        Edit::Payload(i) => settings.payloads.get(i).and_then(|load| load.link.as_ref()).map(|name| name.span),
        Edit::Shaft(_) => None,
        Edit::Lock(i) => settings.lock.get(i).map(|lock| lock.joint.span),
        Edit::Frame(i) => settings.frames.as_ref().and_then(|names| names.get(i)).map(|name| name.span),
    };
    let span = span.unwrap_or(robot);
    match &refusal.reason {
        Reason::Urdf(problems) => each(problems, span),
        _ => syn::Error::new(span, refusal),
    }
}

/// Takes out of the options what `error` is about, or names it otherwise; whether there was such a thing.
pub(crate) fn leave_out(error: &Error, options: &mut Options) -> bool {
    let before = options.clone();
    match error {
        Error::UnknownFunction { found: function, .. }
        | Error::Singular { function, .. }
        | Error::BoundFrames { function, .. }
        | Error::NoMass { function, .. }
        | Error::Wanted { found: function, .. }
        | Error::SameName { name: function } => {
            if let Some(at) = options.functions.iter().rposition(|f| names(f, function)) {
                options.functions.remove(at);
            }
        }
        Error::Parameter { found, .. } => options.parameters.retain(|p| p.trim() != found),
        Error::Rename { from, to, .. } => options.rename.retain(|(f, t)| (f, t) != (from, to)),
        Error::NameClash { second, ident, .. } => {
            let count = options.rename.len();
            options.rename.retain(|(from, _)| from != second);
            options.rename.push((second.clone(), format!("{ident}__{count}")));
        }
        Error::Edits { refusals } => leave_out_edits(refusals, options),
        _ => {}
    }
    *options != before
}

/// All those that were refused. Without a robot that was to be appended there is no going on: others may name what it has.
fn leave_out_edits(refusals: &[Refusal], options: &mut Options) {
    let refused = |edit: Edit| refusals.iter().any(|refusal| refusal.edit == edit);
    if refusals.iter().any(|refusal| matches!(refusal.edit, Edit::Append(_))) {
        return;
    }
    retain(&mut options.payloads, |i| !refused(Edit::Payload(i)));
    retain(&mut options.shafts, |i| !refused(Edit::Shaft(i)));
    retain(&mut options.lock, |i| !refused(Edit::Lock(i)));
    options.frames.iter_mut().for_each(|frames| retain(frames, |i| !refused(Edit::Frame(i))));
}

fn retain<T>(list: &mut Vec<T>, keep: impl Fn(usize) -> bool) {
    let mut index = 0..;
    list.retain(|_| index.next().is_some_and(&keep));
}
