//! Programs that the command calls, which end when it does: also when it is interrupted.

use std::io::{self, Read};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::Duration;

use crate::folder;

/// Those that run.
static CHILDREN: Mutex<Vec<Child>> = Mutex::new(Vec::new());

/// How a program ended, and what it wrote to its two streams.
pub(crate) struct Ended {
    pub(crate) status: ExitStatus,
    pub(crate) output: String,
    pub(crate) errors: String,
}

/// Runs a program to its end. Errors: it cannot be started, or takes longer than `limit` and is
/// ended with all that it started.
pub(crate) fn run(command: &mut Command, limit: Duration) -> io::Result<Ended> {
    folder::watch();
    in_own_group(command);
    let (id, output, errors) = {
        // Nothing can come between a child and its place in the list.
        let mut children = children();
        let mut child = command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn()?;
        let (output, errors) = (child.stdout.take(), child.stderr.take());
        children.push(child);
        (children[children.len() - 1].id(), output, errors)
    };
    let (done, is_done) = channel::<()>();
    let (read, is_late) = thread::scope(|scope| {
        let late = scope.spawn(move || {
            let is_late = is_done.recv_timeout(limit) == Err(RecvTimeoutError::Timeout);
            if is_late {
                children().iter_mut().filter(|child| child.id() == id).for_each(end);
            }
            is_late
        });
        // To their ends, which come with the child's: it can be killed meanwhile.
        let output = scope.spawn(move || read(output));
        let errors = read(errors);
        let output = output.join().unwrap_or_else(|_| Err(io::ErrorKind::Other.into()));
        drop(done);
        ((output, errors), late.join().unwrap_or(false))
    });
    let mut ended = {
        let mut children = children();
        let at = children.iter().position(|child| child.id() == id).ok_or(io::ErrorKind::NotFound)?;
        children.swap_remove(at)
    };
    let status = ended.wait()?;
    if is_late {
        return Err(io::Error::new(io::ErrorKind::TimedOut, format!("found no end within {} s", limit.as_secs())));
    }
    Ok(Ended { status, output: read.0?, errors: read.1? })
}

fn read(from: Option<impl Read>) -> io::Result<String> {
    let mut said = Vec::new();
    from.map_or(Ok(0), |mut from| from.read_to_end(&mut said))?;
    Ok(String::from_utf8_lossy(&said).into_owned())
}

/// Ends all that run. The list stays locked for as long as the guard lives, so that nobody starts another.
pub(crate) fn kill() -> MutexGuard<'static, Vec<Child>> {
    let mut children = children();
    children.iter_mut().for_each(end);
    children
}

/// Ends a program and all that it started. One that has ended by itself cannot be killed, and need not be.
fn end(child: &mut Child) {
    end_group(child);
    let _ = child.kill().and_then(|()| child.wait());
}

/// Has a program start a group of processes, which is ended as one.
#[cfg(unix)]
fn in_own_group(command: &mut Command) {
    std::os::unix::process::CommandExt::process_group(command, 0);
}

#[cfg(unix)]
#[allow(unsafe_code)]
fn end_group(child: &Child) {
    unsafe extern "C" {
        fn kill(process: i32, signal: i32) -> i32;
    }
    if let Ok(group) = i32::try_from(child.id()) {
        // SAFETY: the call has no conditions. The child leads the group and has not been waited
        // for, so that no other group has its number.
        unsafe { kill(-group, 9) };
    }
}

#[cfg(not(unix))]
fn in_own_group(_: &mut Command) {}

#[cfg(not(unix))]
fn end_group(_: &Child) {}

fn children() -> MutexGuard<'static, Vec<Child>> {
    CHILDREN.lock().unwrap_or_else(PoisonError::into_inner)
}
