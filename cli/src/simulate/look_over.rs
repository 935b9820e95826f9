//! What `articulated check` finds about the motion of a scene.

use std::path::Path;

use articulated_lab::session::Session;

use super::motion::solvable;
use super::of_file::OfFile;
use crate::failure::Failure;
use crate::named_scene;
use crate::robot::has_room;

/// The warnings about a scene's motion. Errors: everything that keeps the motion from starting, or
/// else the error of its first step.
pub(crate) fn look_over(scene: &Path) -> Result<Vec<String>, Failure> {
    let session = named_scene::quiet_session(scene)?;
    let (initial, unavailable) = Failure::both(session.initial_state().map_err(Failure::from), requested_events(&session))?;
    if session.scene.law().is_some() {
        let mut settings = session.settings()?;
        OfFile::of_scene(&session, &initial, &mut settings)?;
    } else if session.scene.simulation.is_some() {
        let mut motion = session.motion(&session.model, &session.frame_names(), session.settings()?)?;
        if let Some(error) = motion.first_step(&initial)? {
            return Err(Failure::input([format!("{}: the motion ends with its first step: {error}", session.scene.file)]));
        }
    }
    Ok(session.warnings(&initial).into_iter().chain(unavailable).collect())
}

/// Requested events that cannot occur. Errors: everything that would keep the motion from starting,
/// except its initial state and a missing end time, which an option may set.
fn requested_events(session: &Session) -> Result<Vec<String>, Failure> {
    if session.scene.simulation.is_none() || session.scene.law().is_some() {
        return Ok(Vec::new());
    }
    has_room(&session.scene.file, session.model.nv())?;
    let motion = session.settings().and_then(|settings| session.motion(&session.model, &session.frame_names(), settings));
    let (motion, ()) = Failure::both(motion.map_err(Failure::from), solvable(session))?;
    Ok(motion.unavailable_events().iter().map(ToString::to_string).collect())
}
