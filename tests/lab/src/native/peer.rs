//! Peers: libraries that compute the same, with the interface of `tests/peers/README.md`.

use std::ffi::{CStr, CString, c_char, c_double, c_int, c_void};
use std::path::Path;
use std::rc::Rc;

use super::Native;

/// A robot, as the peer has it.
pub(super) type H = *mut c_void;

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
pub(crate) struct NativePeer(pub(super) Rc<Opened>);

#[derive(Debug)]
pub(super) struct Opened {
    pub(super) native: Native,
    pub(super) handle: H,
}

impl Opened {
    /// The peer's function `peer_<name>`.
    ///
    /// # Safety
    /// T is its type in the interface.
    pub(super) unsafe fn function<T: Copy>(&self, name: &str) -> Option<T> {
        // SAFETY: the caller's condition is the peer's promise.
        unsafe { self.native.symbol(&format!("peer_{name}")) }
    }

    /// The number `peer_<name>` of the robot.
    fn ask(&self, name: &str) -> Option<c_int> {
        // SAFETY: numbers of a robot have this type in the interface.
        let ask: extern "C" fn(H) -> c_int = unsafe { self.function(name)? };
        Some(ask(self.handle))
    }

    /// The name, by `peer_<name>`, of the k-th of its robot's joints or frames.
    fn name(&self, name: &str, k: usize) -> Option<String> {
        // SAFETY: names of the parts of a robot have this type in the interface.
        let ask: extern "C" fn(H, c_int) -> *const c_char = unsafe { self.function(name)? };
        text(ask(self.handle, c_int::try_from(k).ok()?))
    }
}

impl Drop for Opened {
    fn drop(&mut self) {
        // SAFETY: the type of the interface.
        if let Some(close) = unsafe { self.function::<extern "C" fn(H)>("close") } {
            close(self.handle);
        }
    }
}

/// A C string's text.
fn text(pointer: *const c_char) -> Option<String> {
    // SAFETY: the interface promises a string that lives as long as its library or robot, and it is
    // copied here and now.
    (!pointer.is_null()).then(|| unsafe { CStr::from_ptr(pointer) }.to_string_lossy().into_owned())
}

impl Native {
    /// Whether a peer takes steps by itself.
    pub(crate) fn simulates(&self) -> bool {
        // SAFETY: the type of the interface.
        unsafe { self.symbol::<extern "C" fn(c_int) -> *const c_char>("peer_method_name") }.is_some()
    }

    /// A peer's name for itself.
    pub(crate) fn peer_name(&self) -> Option<String> {
        // SAFETY: the type of the interface.
        let name: extern "C" fn() -> *const c_char = unsafe { self.symbol("peer_name")? };
        text(name())
    }
}

impl NativePeer {
    /// Has the peer read a URDF. Gravity in m/s².
    pub(crate) fn open(native: &Native, urdf: &Path, floating: bool, gravity: [f64; 3]) -> Result<Self, String> {
        type Open = extern "C" fn(*const c_char, c_int, c_double, c_double, c_double) -> H;
        // SAFETY: the type of the interface.
        let open: Open = unsafe { native.symbol("peer_open") }.ok_or("it has no function peer_open")?;
        let path = CString::new(urdf.to_string_lossy().as_bytes()).map_err(|e| e.to_string())?;
        let [x, y, z] = gravity;
        let handle = open(path.as_ptr(), c_int::from(floating), x, y, z);
        if handle.is_null() {
            Err("it does not read this robot".into())
        } else {
            Ok(Self(Rc::new(Opened { native: native.clone(), handle })))
        }
    }

    /// A number of the peer's robot: `nq`, `nv`, `joint_count`.
    pub(crate) fn number(&self, what: &str) -> Option<usize> {
        usize::try_from(self.0.ask(what)?).ok()
    }

    /// A number of the peer's joint: `iq`, `iv`, `nq`, `nv`.
    pub(crate) fn joint_number(&self, what: &str, joint: usize) -> Option<usize> {
        // SAFETY: numbers of joints have this type in the interface.
        let ask: extern "C" fn(H, c_int) -> c_int = unsafe { self.0.function(&format!("joint_{what}"))? };
        usize::try_from(ask(self.0.handle, c_int::try_from(joint).ok()?)).ok()
    }

    /// A joint's name.
    pub(crate) fn joint_name(&self, joint: usize) -> Option<String> {
        self.0.name("joint_name", joint)
    }

    /// Names of the peer's frames, in its order; empty if it does not return them.
    pub(crate) fn frames(&self) -> Vec<String> {
        (0..self.number("frame_count").unwrap_or(0)).filter_map(|k| self.0.name("frame_name", k)).collect()
    }

    /// Makes the peer compute functions of frames for these links only, in this order; `false` if
    /// it cannot.
    pub(crate) fn choose_frames(&self, names: &[&str]) -> bool {
        type Choose = extern "C" fn(H, c_int, *const *const c_char) -> c_int;
        // SAFETY: the type of the interface.
        let Some(choose) = (unsafe { self.0.function::<Choose>("choose_frames") }) else { return false };
        let Ok(names) = names.iter().map(|n| CString::new(*n)).collect::<Result<Vec<_>, _>>() else { return false };
        let pointers: Vec<*const c_char> = names.iter().map(|n| n.as_ptr()).collect();
        c_int::try_from(pointers.len()).is_ok_and(|n| choose(self.0.handle, n, pointers.as_ptr()) != 0)
    }

    /// The peer's methods for steps: their names, orders, and evaluations of forward dynamics per
    /// step. Empty if it makes no steps or does not list them.
    pub(crate) fn methods(&self) -> Vec<Stepping> {
        // SAFETY: the type of the interface.
        let name: Option<extern "C" fn(c_int) -> *const c_char> = unsafe { self.0.function("method_name") };
        let number = |what: &str, k: c_int| {
            // SAFETY: numbers of methods have this type in the interface.
            let ask: extern "C" fn(c_int) -> c_int = unsafe { self.0.function(&format!("method_{what}"))? };
            u32::try_from(ask(k)).ok()
        };
        let one = |k: c_int| {
            Some(Stepping { number: k, name: text(name?(k))?, order: number("order", k)?, evaluations: number("evaluations", k)? })
        };
        (0..).map_while(one).collect()
    }

    /// Makes the peer compute this number of steps from the state (q, v), which the last state
    /// replaces; `None` if it cannot or if it diverged.
    pub(crate) fn simulate(&self, method: &Stepping, q: &mut [f64], v: &mut [f64], step: f64, steps: usize) -> Option<()> {
        type Simulate =
            unsafe extern "C" fn(H, c_int, *const c_double, *const c_double, c_double, c_int, *mut c_double, *mut c_double) -> c_int;
        // SAFETY: the type of the interface.
        let simulate: Simulate = unsafe { self.0.function("simulate")? };
        if self.number("nq") != Some(q.len()) || self.number("nv") != Some(v.len()) {
            return None;
        }
        let (from_q, from_v) = (q.to_vec(), v.to_vec());
        let (number, steps) = (method.number, c_int::try_from(steps).ok()?);
        // SAFETY: the arrays have the peer's lengths, and the robot is open.
        let right =
            unsafe { simulate(self.0.handle, number, from_q.as_ptr(), from_v.as_ptr(), step, steps, q.as_mut_ptr(), v.as_mut_ptr()) };
        (right != 0).then_some(())
    }
}
