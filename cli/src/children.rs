//! Programs that the command calls, which end when it does: also when it is interrupted.

use std::io::{self, Read};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Those that run.
static CHILDREN: Mutex<Vec<Child>> = Mutex::new(Vec::new());

/// Runs a program to its end: how it ended, and what it wrote as errors. Its output is nobody's.
pub(crate) fn run(command: &mut Command) -> io::Result<(ExitStatus, String)> {
    let (id, mut errors) = {
        // Nothing can come between a child and its place in the list.
        let mut children = children();
        let mut child = command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::piped()).spawn()?;
        let errors = child.stderr.take();
        children.push(child);
        (children[children.len() - 1].id(), errors)
    };
    let mut said = Vec::new();
    // To its end, which comes with the child's: it can be killed meanwhile.
    let read = errors.as_mut().map_or(Ok(0), |errors| errors.read_to_end(&mut said));
    let mut ended = {
        let mut children = children();
        let at = children.iter().position(|child| child.id() == id).ok_or(io::ErrorKind::NotFound)?;
        children.swap_remove(at)
    };
    let status = ended.wait()?;
    read?;
    Ok((status, String::from_utf8_lossy(&said).into_owned()))
}

/// Ends all that run. The list stays locked for as long as the guard lives, so that nobody starts another.
pub(crate) fn kill() -> MutexGuard<'static, Vec<Child>> {
    let mut children = children();
    for child in children.iter_mut() {
        // One that has ended by itself cannot be killed, and need not be.
        let _ = child.kill().and_then(|()| child.wait());
    }
    children
}

fn children() -> MutexGuard<'static, Vec<Child>> {
    CHILDREN.lock().unwrap_or_else(PoisonError::into_inner)
}
