//! Everything that is wrong with what is asked, not only the first of it: what was refused is left out, and the rest tried again.

use super::error::RobotError;
use super::error::{Edit, Refusal};
use super::options::RobotOptions;

/// More than these are not looked for.
const MOST: usize = 100;

/// What came of an attempt, and of those after it.
#[derive(Clone, Debug)]
pub struct Tried<R, T, E> {
    /// What the last attempt gave; `None` where there was nothing more to leave out.
    pub value: Option<T>,
    /// What was refused, in the order in which it was found.
    pub errors: Vec<E>,
    /// What was asked without it.
    pub rest: R,
}

/// Attempts what is asked, and again without what was refused, until nothing is or nothing can be left out. `leave_out` takes what an error is about out of what is asked, and says
/// whether there was such a thing.
pub fn tried<R: Clone, T, E>(asked: &R, attempt: impl Fn(&R) -> Result<T, E>, leave_out: impl Fn(&E, &mut R) -> bool) -> Tried<R, T, E> {
    let mut tried = Tried { value: None, errors: Vec::new(), rest: asked.clone() };
    while tried.errors.len() < MOST {
        match attempt(&tried.rest) {
            Ok(value) => {
                tried.value = Some(value);
                break;
            }
            Err(error) => {
                let goes_on = leave_out(&error, &mut tried.rest);
                tried.errors.push(error);
                if !goes_on {
                    break;
                }
            }
        }
    }
    tried
}

/// Takes out of the options what `error` is about; whether there was such a thing.
pub fn leave_out(error: &RobotError, options: &mut RobotOptions) -> bool {
    let before = options.clone();
    match error {
        RobotError::Number { key: "gravity", .. } => options.gravity = [0.0; 3],
        RobotError::Number { .. } => options.snap_angles = None,
        RobotError::Edits { refusals } => leave_out_edits(refusals, options),
        RobotError::Several { errors } => errors.iter().for_each(|error| {
            leave_out(error, options);
        }),
        RobotError::Effects { errors, .. } => retain(&mut options.effects, |i| errors.iter().all(|e| e.index != i)),
        _ => {}
    }
    *options != before
}

/// All those that were refused. Without a robot that was to be appended there is no going on: others may name what it has.
fn leave_out_edits(refusals: &[Refusal], options: &mut RobotOptions) {
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
