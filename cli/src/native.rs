//! Functions of libraries that are opened at run time: with [`batch`], the one module of the command that needs `unsafe`.
//!
//! A library runs whatever is in it. Two kinds are opened here: one that the command has just compiled from its own
//! source, and peers that the user names. The signatures below are what both promise; nothing can check them.
#![allow(unsafe_code)]
// Why: calling across a C interface has no safe form. What can be checked, the lengths of arrays, is checked before every call.

mod batch;

use std::ffi::{CStr, CString, c_char, c_double, c_int, c_void};
use std::hint::black_box;
use std::path::Path;
use std::rc::Rc;
use std::sync::Arc;

use crate::folder::Folder;

pub(crate) use batch::{BatchKernel, Numbers};

/// An open library.
#[derive(Clone, Debug)]
pub(crate) struct Native {
    library: Arc<libloading::Library>,
    /// Where the copy is that was opened.
    _copy: Arc<Folder>,
}

/// A function on arrays of doubles, with the lengths it was promised to have. Keeps its library open.
#[derive(Clone, Debug)]
pub(crate) struct Kernel {
    entry: Entry,
    arguments: Vec<usize>,
    out: usize,
    _library: Native,
}

/// A peer's function of its robot, in the same way.
#[derive(Clone, Debug)]
pub(crate) struct PeerKernel {
    entry: PeerEntry,
    /// The function's name, where it keeps its result until it is asked for.
    kept: Option<CString>,
    arguments: Vec<usize>,
    out: usize,
    robot: Rc<Opened>,
}

type P = *const c_double;
type O = *mut c_double;
type H = *mut c_void;

#[derive(Clone, Copy, Debug)]
enum Entry {
    One(unsafe extern "C" fn(P, O)),
    Two(unsafe extern "C" fn(P, P, O)),
    Three(unsafe extern "C" fn(P, P, P, O)),
    Four(unsafe extern "C" fn(P, P, P, P, O)),
}

/// With an array for the result, and without one.
#[derive(Clone, Copy, Debug)]
enum PeerEntry {
    One(unsafe extern "C" fn(H, P, O)),
    Two(unsafe extern "C" fn(H, P, P, O)),
    Three(unsafe extern "C" fn(H, P, P, P, O)),
    Four(unsafe extern "C" fn(H, P, P, P, P, O)),
    QuietOne(unsafe extern "C" fn(H, P)),
    QuietTwo(unsafe extern "C" fn(H, P, P)),
    QuietThree(unsafe extern "C" fn(H, P, P, P)),
    QuietFour(unsafe extern "C" fn(H, P, P, P, P)),
}

impl PeerEntry {
    /// # Safety
    /// The robot is open, there are as many arrays as the function takes, each as long as it reads, and `out` is as long as it writes.
    #[inline(always)]
    unsafe fn run(self, robot: H, [q, v, a, w]: [P; 4], out: O) {
        // SAFETY: what this function asks for is what they ask for.
        unsafe {
            match self {
                Self::One(f) => f(robot, q, out),
                Self::Two(f) => f(robot, q, v, out),
                Self::Three(f) => f(robot, q, v, a, out),
                Self::Four(f) => f(robot, q, v, a, w, out),
                Self::QuietOne(f) => f(robot, q),
                Self::QuietTwo(f) => f(robot, q, v),
                Self::QuietThree(f) => f(robot, q, v, a),
                Self::QuietFour(f) => f(robot, q, v, a, w),
            }
        }
    }
}

impl Native {
    /// Opens a copy of the library at `path`. What a linker has written piece by piece lies scattered in memory, and code that fills the cache for instructions then takes up to a third
    /// longer, or not, as it happens; a copy is written in one go.
    pub(crate) fn open(path: &Path) -> Result<Self, String> {
        let failed = |e: &dyn std::fmt::Display| format!("{}: {e}", path.display());
        let folder = Folder::new().map_err(|e| failed(&e))?;
        let copy = folder.path().join(path.file_name().unwrap_or_default());
        std::fs::copy(path, &copy).map_err(|e| failed(&e))?;
        // SAFETY: initialisers of the library run: ours has none, and a peer is a library that the user asked to be run.
        let library = unsafe { libloading::Library::new(&copy) }.map_err(|e| failed(&e))?;
        Ok(Self { library: Arc::new(library), _copy: Arc::new(folder) })
    }

    fn symbol<T: Copy>(&self, name: &str) -> Option<T> {
        // SAFETY: T is the type that the library gives the symbol: each caller names the interface that says so.
        unsafe { self.library.get::<T>(name.as_bytes()) }.ok().map(|s| *s)
    }

    /// The function `name`, which takes arrays of these lengths and writes `out` numbers: the interface of [`crate::compiled`].
    pub(crate) fn kernel(&self, name: &str, arguments: &[usize], out: usize) -> Option<Kernel> {
        let entry = match arguments.len() {
            1 => Entry::One(self.symbol(name)?),
            2 => Entry::Two(self.symbol(name)?),
            3 => Entry::Three(self.symbol(name)?),
            4 => Entry::Four(self.symbol(name)?),
            _ => return None,
        };
        Some(Kernel { entry, arguments: arguments.to_vec(), out, _library: self.clone() })
    }

    /// Whether a peer takes steps by itself.
    pub(crate) fn simulates(&self) -> bool {
        self.symbol::<unsafe extern "C" fn()>("peer_method_name").is_some()
    }

    /// A peer's name for itself.
    pub(crate) fn peer_name(&self) -> Option<String> {
        let name: extern "C" fn() -> *const c_char = self.symbol("peer_name")?;
        text(name())
    }
}

/// A C string's text.
fn text(pointer: *const c_char) -> Option<String> {
    // SAFETY: the interface promises a string that lives as long as its library or robot, and it is copied here and now.
    (!pointer.is_null()).then(|| unsafe { CStr::from_ptr(pointer) }.to_string_lossy().into_owned())
}

/// # Panics
/// If a length is not the one promised.
#[inline]
fn check(given: &[&[f64]], promised: &[usize], out: usize, promised_out: usize) {
    assert!(out == promised_out && given.len() == promised.len());
    assert!(given.iter().zip(promised).all(|(x, n)| x.len() == *n));
}

impl Kernel {
    /// Calls the function.
    ///
    /// # Panics
    /// If a length is not the one promised.
    #[inline]
    pub(crate) fn call(&self, x: &[&[f64]], out: &mut [f64]) {
        check(x, &self.arguments, out.len(), self.out);
        let out = out.as_mut_ptr();
        // SAFETY: the arrays have the lengths that the library reads and writes, and it is open as long as the kernel lives.
        unsafe {
            match self.entry {
                Entry::One(f) => f(x[0].as_ptr(), out),
                Entry::Two(f) => f(x[0].as_ptr(), x[1].as_ptr(), out),
                Entry::Three(f) => f(x[0].as_ptr(), x[1].as_ptr(), x[2].as_ptr(), out),
                Entry::Four(f) => f(x[0].as_ptr(), x[1].as_ptr(), x[2].as_ptr(), x[3].as_ptr(), out),
            }
        }
    }

    /// Whether these are arguments and a result of the lengths promised.
    #[inline]
    pub(crate) fn fits(&self, x: &[&[f64]], out: &[f64]) -> bool {
        out.len() == self.out && x.len() == self.arguments.len() && x.iter().zip(&self.arguments).all(|(x, n)| x.len() == *n)
    }

    /// Calls the function on all states, so many rounds: lengths are checked once, and then only called.
    ///
    /// # Panics
    /// If a length is not the one promised.
    pub(crate) fn repeat(&self, rounds: usize, states: &[Vec<&[f64]>], out: &mut [f64]) {
        states.iter().for_each(|x| check(x, &self.arguments, out.len(), self.out));
        let out = out.as_mut_ptr();
        // SAFETY: as in `call`.
        unsafe {
            match self.entry {
                Entry::One(f) => repeat(rounds, states, |[q, ..]| f(q, out)),
                Entry::Two(f) => repeat(rounds, states, |[q, v, ..]| f(q, v, out)),
                Entry::Three(f) => repeat(rounds, states, |[q, v, a, _]| f(q, v, a, out)),
                Entry::Four(f) => repeat(rounds, states, |[q, v, a, w]| f(q, v, a, w, out)),
            }
        }
    }
}

/// Where up to four arrays begin.
fn begin(x: &[&[f64]]) -> [P; 4] {
    std::array::from_fn(|k| x.get(k).map_or(std::ptr::null(), |x| x.as_ptr()))
}

/// So many rounds through all states, with nothing around the calls that the clock would see: to look up where each state's arrays begin is not a part of a function, and a short
/// one would wait for it.
#[inline(always)]
fn repeat(rounds: usize, states: &[Vec<&[f64]>], mut call: impl FnMut([P; 4])) {
    let states: Vec<[P; 4]> = black_box(states.iter().map(|state| begin(state)).collect());
    for _ in 0..rounds {
        for state in &states {
            call(*state);
        }
    }
}

impl PeerKernel {
    /// Calls the function, and asks for its result if it is kept. Whether there is a result.
    ///
    /// # Panics
    /// If a length is not the one promised.
    pub(crate) fn call(&self, x: &[&[f64]], out: &mut [f64]) -> bool {
        check(x, &self.arguments, out.len(), self.out);
        let (robot, out) = (self.robot.handle, out.as_mut_ptr());
        // SAFETY: as above, and the robot is open as long as the kernel lives; it is used by one thread only.
        unsafe { self.entry.run(robot, begin(x), out) };
        let Some(name) = &self.kept else { return true };
        type Read = unsafe extern "C" fn(H, *const c_char, O) -> c_int;
        let read: Option<Read> = self.robot.native.symbol("peer_read");
        // SAFETY: it writes the result of the function, whose length was checked.
        read.is_some_and(|read| unsafe { read(robot, name.as_ptr(), out) } != 0)
    }

    /// Calls the function on all states, so many rounds: lengths are checked once, and then only called.
    ///
    /// # Panics
    /// If a length is not the one promised.
    pub(crate) fn repeat(&self, rounds: usize, states: &[Vec<&[f64]>], out: &mut [f64]) {
        states.iter().for_each(|x| check(x, &self.arguments, out.len(), self.out));
        let (robot, out) = (self.robot.handle, out.as_mut_ptr());
        // One loop for each number of arguments, so that nothing is chosen inside.
        // SAFETY: as in `call`.
        unsafe {
            match self.entry {
                PeerEntry::One(f) => repeat(rounds, states, |[q, ..]| f(robot, q, out)),
                PeerEntry::Two(f) => repeat(rounds, states, |[q, v, ..]| f(robot, q, v, out)),
                PeerEntry::Three(f) => repeat(rounds, states, |[q, v, a, _]| f(robot, q, v, a, out)),
                other => repeat(rounds, states, |x| other.run(robot, x, out)),
            }
        }
    }
}

/// A method by which a peer makes steps.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Stepping {
    number: c_int,
    pub(crate) name: String,
    pub(crate) order: u32,
    /// Of forward dynamics, a step.
    pub(crate) evaluations: u32,
}

/// A robot open in a peer library.
#[derive(Clone, Debug)]
pub(crate) struct NativePeer(Rc<Opened>);

#[derive(Debug)]
struct Opened {
    native: Native,
    handle: H,
}

impl NativePeer {
    /// Has the peer read a URDF. Gravity in m/s².
    pub(crate) fn open(native: &Native, urdf: &Path, floating: bool, gravity: [f64; 3]) -> Result<Self, String> {
        type Open = extern "C" fn(*const c_char, c_int, c_double, c_double, c_double) -> H;
        let open: Open = native.symbol("peer_open").ok_or("it has no function peer_open")?;
        let path = CString::new(urdf.to_string_lossy().as_bytes()).map_err(|e| e.to_string())?;
        let [x, y, z] = gravity;
        let handle = open(path.as_ptr(), c_int::from(floating), x, y, z);
        if handle.is_null() {
            Err("it does not read this robot".into())
        } else {
            Ok(Self(Rc::new(Opened { native: native.clone(), handle })))
        }
    }

    /// A number that the peer says of its robot: `nq`, `nv`, `joint_count`.
    pub(crate) fn number(&self, what: &str) -> Option<usize> {
        let ask: extern "C" fn(H) -> c_int = self.0.native.symbol(&format!("peer_{what}"))?;
        usize::try_from(ask(self.0.handle)).ok()
    }

    /// A number that the peer says of a joint: `iq`, `iv`, `nq`, `nv`.
    pub(crate) fn joint_number(&self, what: &str, joint: usize) -> Option<usize> {
        let ask: extern "C" fn(H, c_int) -> c_int = self.0.native.symbol(&format!("peer_joint_{what}"))?;
        usize::try_from(ask(self.0.handle, c_int::try_from(joint).ok()?)).ok()
    }

    /// A joint's name.
    pub(crate) fn joint_name(&self, joint: usize) -> Option<String> {
        let ask: extern "C" fn(H, c_int) -> *const c_char = self.0.native.symbol("peer_joint_name")?;
        text(ask(self.0.handle, c_int::try_from(joint).ok()?))
    }

    /// Names of the frames that the peer has, in its order; none if it does not tell.
    pub(crate) fn frames(&self) -> Vec<String> {
        let Some(ask) = self.0.native.symbol::<extern "C" fn(H, c_int) -> *const c_char>("peer_frame_name") else { return Vec::new() };
        (0..self.number("frame_count").unwrap_or(0)).filter_map(|k| text(ask(self.0.handle, c_int::try_from(k).ok()?))).collect()
    }

    /// Has the peer give the functions of frames for these links only, in this order; `false` if it cannot.
    pub(crate) fn choose_frames(&self, names: &[&str]) -> bool {
        type Choose = extern "C" fn(H, c_int, *const *const c_char) -> c_int;
        let Some(choose) = self.0.native.symbol::<Choose>("peer_choose_frames") else { return false };
        let Ok(names) = names.iter().map(|n| CString::new(*n)).collect::<Result<Vec<_>, _>>() else { return false };
        let pointers: Vec<*const c_char> = names.iter().map(|n| n.as_ptr()).collect();
        c_int::try_from(pointers.len()).is_ok_and(|n| choose(self.0.handle, n, pointers.as_ptr()) != 0)
    }

    /// The methods by which the peer makes steps: their names, orders, and evaluations of forward dynamics a step. None if it makes no steps or does not tell.
    pub(crate) fn methods(&self) -> Vec<Stepping> {
        let native = &self.0.native;
        let name: Option<extern "C" fn(c_int) -> *const c_char> = native.symbol("peer_method_name");
        let number = |what: &str, k: c_int| {
            let ask: extern "C" fn(c_int) -> c_int = native.symbol(&format!("peer_method_{what}"))?;
            u32::try_from(ask(k)).ok()
        };
        let one = |k: c_int| {
            Some(Stepping { number: k, name: text(name?(k))?, order: number("order", k)?, evaluations: number("evaluations", k)? })
        };
        (0..).map_while(one).collect()
    }

    /// Has the peer make so many steps from the state (q, v), which it replaces by the last one; `None` if it cannot or if it went astray.
    pub(crate) fn simulate(&self, method: &Stepping, q: &mut [f64], v: &mut [f64], step: f64, steps: usize) -> Option<()> {
        type Simulate = unsafe extern "C" fn(H, c_int, P, P, c_double, c_int, O, O) -> c_int;
        let simulate: Simulate = self.0.native.symbol("peer_simulate")?;
        if self.number("nq") != Some(q.len()) || self.number("nv") != Some(v.len()) {
            return None;
        }
        let (from_q, from_v) = (q.to_vec(), v.to_vec());
        let (number, steps) = (method.number, c_int::try_from(steps).ok()?);
        // SAFETY: the arrays are as long as the peer says that they are, and the robot is open.
        let right =
            unsafe { simulate(self.0.handle, number, from_q.as_ptr(), from_v.as_ptr(), step, steps, q.as_mut_ptr(), v.as_mut_ptr()) };
        (right != 0).then_some(())
    }

    /// The peer's function, which takes arrays of these lengths and gives `out` numbers: into an array, or, if `kept`, when asked for them.
    pub(crate) fn kernel(&self, function: &str, arguments: &[usize], out: usize, kept: bool) -> Option<PeerKernel> {
        let native = &self.0.native;
        let name = format!("peer_{function}");
        let told = CString::new(function).ok()?;
        let has: Option<extern "C" fn(H, *const c_char) -> c_int> = native.symbol("peer_has");
        if has.is_some_and(|has| has(self.0.handle, told.as_ptr()) == 0) {
            return None;
        }
        let entry = match (arguments.len(), kept) {
            (1, false) => PeerEntry::One(native.symbol(&name)?),
            (2, false) => PeerEntry::Two(native.symbol(&name)?),
            (3, false) => PeerEntry::Three(native.symbol(&name)?),
            (4, false) => PeerEntry::Four(native.symbol(&name)?),
            (1, true) => PeerEntry::QuietOne(native.symbol(&name)?),
            (2, true) => PeerEntry::QuietTwo(native.symbol(&name)?),
            (3, true) => PeerEntry::QuietThree(native.symbol(&name)?),
            (4, true) => PeerEntry::QuietFour(native.symbol(&name)?),
            _ => return None,
        };
        Some(PeerKernel { entry, kept: kept.then_some(told), arguments: arguments.to_vec(), out, robot: self.0.clone() })
    }
}

impl Drop for Opened {
    fn drop(&mut self) {
        if let Some(close) = self.native.symbol::<extern "C" fn(H)>("peer_close") {
            close(self.handle);
        }
    }
}
