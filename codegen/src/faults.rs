//! Everything that is wrong with a request, not only the first of it: what was refused is left out, and the rest tried again.

use crate::{Edit, Error, Options, Refusal, Request};

/// More than these are not looked for.
const MOST: usize = 100;

/// What came of an attempt, and of those after it.
pub(crate) struct Tried<T> {
    /// What the last attempt gave; `None` where there was nothing more to leave out.
    pub(crate) value: Option<T>,
    /// What was refused, in the order in which it was found.
    pub(crate) errors: Vec<Error>,
    /// The request without it.
    pub(crate) rest: Request,
}

/// Attempts the request, and again without what was refused, until nothing is or nothing can be left out.
pub(crate) fn tried<T>(request: &Request, attempt: impl Fn(&Request) -> Result<T, Error>) -> Tried<T> {
    let mut tried = Tried { value: None, errors: Vec::new(), rest: request.clone() };
    while tried.errors.len() < MOST {
        match attempt(&tried.rest) {
            Ok(value) => {
                tried.value = Some(value);
                break;
            }
            Err(error) => {
                let goes_on = leave_out(&error, &mut tried.rest.options);
                tried.errors.push(error);
                if !goes_on {
                    break;
                }
            }
        }
    }
    tried
}

/// The value of an attempt of which nothing was refused, or all that was.
pub(crate) fn all<T>(request: &Request, attempt: impl Fn(&Request) -> Result<T, Error>) -> Result<T, Error> {
    // Nothing is copied where nothing is wrong.
    attempt(request).map_err(|first| {
        let Tried { errors, .. } = tried(request, attempt);
        Error::of(errors).unwrap_or(first)
    })
}

/// Whether an entry is the function, or has it in it.
pub fn mentions(entry: &str, function: &str) -> bool {
    entry.trim() == function || entry.split(|c: char| !c.is_alphanumeric() && c != '_').any(|word| word == function)
}

/// Takes out of the options what `error` is about, or names it otherwise; whether there was such a thing.
fn leave_out(error: &Error, options: &mut Options) -> bool {
    let before = options.clone();
    match error {
        Error::UnknownFunction { found: function, .. }
        | Error::Singular { function, .. }
        | Error::BoundFrames { function, .. }
        | Error::NoMass { function, .. }
        | Error::Wanted { found: function, .. }
        | Error::SameName { name: function } => {
            if let Some(at) = options.functions.iter().rposition(|f| mentions(f, function)) {
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
        Error::Several { errors } => errors.iter().for_each(|error| {
            leave_out(error, options);
        }),
        Error::Effects { errors, .. } => retain(&mut options.effects, |i| errors.iter().all(|e| e.index != i)),
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
