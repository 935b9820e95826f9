//! Temporary folders, which go when the command does: also when it is interrupted (Ctrl-C), where nothing that lives is dropped.

use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, Once, PoisonError};

use tempfile::TempDir;

use crate::children;
use crate::interrupt;

/// Those there are.
static FOLDERS: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// A folder that is removed with this.
#[derive(Debug)]
pub(crate) struct Folder(TempDir);

impl Folder {
    /// An empty folder where temporary files belong.
    pub(crate) fn new() -> io::Result<Self> {
        watch();
        // Nothing can come between a folder and its place in the list.
        let mut folders = folders();
        let folder = tempfile::Builder::new().prefix("articulated").tempdir()?;
        folders.push(folder.path().to_owned());
        Ok(Self(folder))
    }

    pub(crate) fn path(&self) -> &Path {
        self.0.path()
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        folders().retain(|path| path != self.0.path());
    }
}

/// Installs the signal handler that removes temporary folders and ends child programs.
pub(crate) fn watch() {
    static WATCH: Once = Once::new();
    WATCH.call_once(|| interrupt::watch(interrupted));
}

fn folders() -> MutexGuard<'static, Vec<PathBuf>> {
    FOLDERS.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Ends compilers, removes the folders and ends the process. The lists stay locked, so that no other thread makes another of either.
fn interrupted(status: i32) {
    let _children = children::kill();
    let folders = folders();
    for folder in folders.iter() {
        // A file that is still being written can keep a folder for a moment.
        let _ = (0..20).any(|_| std::fs::remove_dir_all(folder).is_ok() || !folder.exists() || wait());
    }
    std::process::exit(status);
}

/// Waits a moment; false.
fn wait() -> bool {
    std::thread::sleep(std::time::Duration::from_millis(10));
    false
}
