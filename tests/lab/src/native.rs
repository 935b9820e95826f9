//! Functions of libraries that are opened at run time: the only module of the command that needs
//! `unsafe`.
//!
//! A library runs any code that it contains. Two kinds are opened here: one that the command has
//! just compiled from its own source ([`kernel`], [`batch`]), and peers that the user names
//! ([`peer`], [`peer_kernel`]). The signatures there are the contracts of both; they cannot be
//! checked.
#![allow(unsafe_code)]
// Why: calls across a C interface have no safe form. The lengths of arrays, which can be checked,
// are checked before every call.

mod batch;
mod entry;
mod kernel;
mod peer;
mod peer_kernel;

use std::ffi::c_void;
use std::hint::black_box;
use std::path::Path;
use std::sync::Arc;

use crate::process::Folder;

pub(crate) use batch::{BatchKernel, Numbers};
pub(crate) use kernel::Kernel;
pub(crate) use peer::{NativePeer, Stepping};
pub(crate) use peer_kernel::PeerKernel;

/// An open library.
#[derive(Clone, Debug)]
pub(crate) struct Native {
    library: Arc<libloading::Library>,
    /// Where the copy is that was opened.
    _copy: Arc<Folder>,
}

impl Native {
    /// Opens a copy of the library at `path`. A file that a linker has written piece by piece is
    /// scattered in memory, and code that fills the instruction cache then sometimes takes up to a
    /// third longer; a copy is written at once.
    pub(crate) fn open(path: &Path) -> Result<Self, String> {
        let failed = |e: &dyn std::fmt::Display| format!("{}: {e}", path.display());
        let folder = Folder::new().map_err(|e| failed(&e))?;
        let copy = folder.path().join(path.file_name().unwrap_or_default());
        std::fs::copy(path, &copy).map_err(|e| failed(&e))?;
        // SAFETY: initialisers of the library run: ours has none, and a peer is a library that the
        // user requested to run.
        let library = unsafe { libloading::Library::new(&copy) }.map_err(|e| failed(&e))?;
        Ok(Self { library: Arc::new(library), _copy: Arc::new(folder) })
    }

    /// The function `name`, if there is one. It may be called while the library is open.
    ///
    /// # Safety
    /// T is the type of a pointer to that function: a function pointer with the C interface, and
    /// the library's arguments and result of the function.
    unsafe fn symbol<T: Copy>(&self, name: &str) -> Option<T> {
        // SAFETY: the caller satisfies the same conditions.
        unsafe { self.library.get::<T>(name.as_bytes()) }.ok().map(|s| *s)
    }
}

/// Where an array all_pointers that is read.
type P = *const c_void;
/// Where one all_pointers that is written.
type O = *mut c_void;

/// How long the arrays are that a function reads and the one that it writes.
#[derive(Clone, Debug)]
struct Lengths {
    arguments: Vec<usize>,
    out: usize,
}

impl Lengths {
    /// Whether these are arguments and a result of the lengths promised.
    #[inline]
    fn fit(&self, x: &[&[f64]], out: &[f64]) -> bool {
        out.len() == self.out && x.len() == self.arguments.len() && x.iter().zip(&self.arguments).all(|(x, n)| x.len() == *n)
    }
}

/// Where up to four arrays begin.
fn pointers(x: &[&[f64]]) -> [P; 4] {
    std::array::from_fn(|k| x.get(k).map_or(std::ptr::null(), |x| x.as_ptr().cast()))
}

/// The start of each state's arrays, found once, so that the loop contains only calls: the lookup
/// is not part of a function, and a short one would wait for it.
fn all_pointers(states: &[Vec<&[f64]>]) -> Vec<[P; 4]> {
    black_box(states.iter().map(|state| pointers(state)).collect())
}
