//! Temporary folders and child programs: both end with the process, also after an interruption
//! (Ctrl-C, or a signal), when no destructor runs.

use std::hash::{BuildHasher, RandomState};
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Mutex, MutexGuard, Once, PoisonError};
use std::thread;
use std::time::Duration;

/// The exit status after Ctrl-C, as shells have it.
pub const INTERRUPTED: u8 = 130;

/// Those there are.
static FOLDERS: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// A folder that is removed with this.
#[derive(Debug)]
pub(crate) struct Folder(PathBuf);

impl Folder {
    /// An empty folder where temporary files belong.
    pub(crate) fn new() -> io::Result<Self> {
        watch();
        // No interruption is possible between a folder and its entry in the list.
        let mut folders = folders();
        let folder = create_folder(&std::env::temp_dir())?;
        folders.push(folder.clone());
        Ok(Self(folder))
    }

    pub(crate) fn path(&self) -> &Path {
        &self.0
    }
}

/// A folder with a free name, for this user alone. It cannot contain earlier files: a taken name is
/// an error, also for a link.
fn create_folder(parent: &Path) -> io::Result<PathBuf> {
    static COUNT: AtomicU64 = AtomicU64::new(0);
    let mut builder = std::fs::DirBuilder::new();
    #[cfg(unix)]
    std::os::unix::fs::DirBuilderExt::mode(&mut builder, 0o700);
    loop {
        // Keys of hashes are random in each process, and one apart for each of its hashers.
        let number = RandomState::new().hash_one(COUNT.fetch_add(1, Ordering::Relaxed));
        let folder = parent.join(format!("articulated{number:016x}"));
        match builder.create(&folder) {
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
            made => return made.map(|()| folder),
        }
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
        folders().retain(|path| *path != self.0);
    }
}

/// Installs the signal handler that removes temporary folders and ends child programs.
pub(crate) fn watch() {
    static WATCH: Once = Once::new();
    WATCH.call_once(|| watch_signals(interrupted));
}

fn folders() -> MutexGuard<'static, Vec<PathBuf>> {
    FOLDERS.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Ends compilers, removes the folders and ends the process. The lists stay locked, so that no
/// other thread makes another of either.
fn interrupted(status: i32) {
    let _children = kill();
    let folders = folders();
    for folder in folders.iter() {
        // A file that is still being written can keep a folder for a moment.
        let _ = (0..20).any(|_| std::fs::remove_dir_all(folder).is_ok() || !folder.exists() || wait());
    }
    std::process::exit(status);
}

/// Waits a moment; false.
fn wait() -> bool {
    thread::sleep(Duration::from_millis(10));
    false
}

/// Those that run.
static CHILDREN: Mutex<Vec<Child>> = Mutex::new(Vec::new());

/// A program's exit status, and the texts of its two streams.
pub(crate) struct Ended {
    pub(crate) status: ExitStatus,
    pub(crate) output: String,
    pub(crate) errors: String,
}

/// Runs a program to its end. Errors: it cannot be started, or takes longer than `limit` and is
/// ended with all that it started.
pub(crate) fn run(command: &mut Command, limit: Duration) -> io::Result<Ended> {
    watch();
    in_own_group(command);
    let (id, output, errors) = {
        // No interruption is possible between a child and its entry in the list.
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

/// Ends all running processes. The guard keeps the list locked, so that no thread starts
/// another.
pub(crate) fn kill() -> MutexGuard<'static, Vec<Child>> {
    let mut children = children();
    children.iter_mut().for_each(end);
    children
}

/// Ends a program and all that it started. One that has ended by itself cannot be killed, and need
/// not be.
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

/// Calls `end` with the exit status, in a thread of its own, once a signal ends the process. A
/// signal that is ignored from the start, as by `nohup` or in a script's background, stays ignored.
/// Where no signal can be watched, an interrupted process leaves its folders behind.
#[cfg(unix)]
pub(crate) fn watch_signals(end: fn(i32)) {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGQUIT, SIGTERM};
    let heard = [SIGINT, SIGQUIT, SIGTERM, SIGHUP].into_iter().filter(|signal| !is_ignored(*signal));
    let Ok(mut signals) = signal_hook::iterator::Signals::new(heard) else { return };
    thread::spawn(move || signals.forever().next().into_iter().for_each(|signal| end(i32::from(INTERRUPTED) - SIGINT + signal)));
}

/// Whether a signal was ignored from the start, if the system shows it.
#[cfg(unix)]
fn is_ignored(signal: i32) -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| u64::from_str_radix(line.strip_prefix("SigIgn:")?.trim(), 16).ok());
    mask.is_some_and(|mask| mask >> (signal - 1) & 1 == 1)
}

#[cfg(not(unix))]
pub(crate) fn watch_signals(end: fn(i32)) {
    // Ctrl-C is all that there is.
    drop(ctrlc::set_handler(move || end(INTERRUPTED.into())));
}

#[cfg(test)]
mod tests {
    use super::Folder;

    #[test]
    fn folders_are_empty_each_by_itself_and_go_with_their_values() {
        let [a, b] = [(); 2].map(|()| Folder::new().unwrap());
        assert!(a.path() != b.path() && std::fs::read_dir(a.path()).unwrap().next().is_none());
        std::fs::write(a.path().join("file"), "").unwrap();
        let path = a.path().to_owned();
        drop(a);
        assert!(!path.exists() && b.path().is_dir());
    }
}
