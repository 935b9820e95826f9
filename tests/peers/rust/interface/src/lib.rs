//! The C interface of a peer (`tests/peers/README.md`) around an engine in Rust: [`export!`] writes
//! it out for a type.

use std::ffi::{CStr, CString, c_char, c_int};
use std::path::Path;

/// A joint, with the first places and the numbers of its coordinates and rates.
#[derive(Debug)]
pub struct Joint {
    name: CString,
    q: (c_int, c_int),
    v: (c_int, c_int),
}

/// All joints, in the engine's order.
#[derive(Debug, Default)]
pub struct Joints {
    all: Vec<Joint>,
    nq: c_int,
    nv: c_int,
}

impl Joints {
    /// Adds a joint behind the others.
    pub fn add(&mut self, name: &str, nq: c_int, nv: c_int) {
        let name = CString::new(name).unwrap_or_default();
        self.all.push(Joint { name, q: (self.nq, nq), v: (self.nv, nv) });
        (self.nq, self.nv) = (self.nq + nq, self.nv + nv);
    }

    /// The free base: position and quaternion (x y z w); (linear; angular) in body axes.
    pub fn add_floating_base(&mut self) {
        self.add("__floating_base__", 7, 6);
    }

    pub fn nq(&self) -> usize {
        self.nq as usize
    }

    pub fn nv(&self) -> usize {
        self.nv as usize
    }
}

/// An engine with one robot open. The lengths of arrays are those of the robot's joints.
pub trait Engine: Sized {
    /// Reads a URDF. Gravity in m/s².
    fn open(urdf: &Path, floating: bool, gravity: [f64; 3]) -> Result<Self, String>;
    fn joints(&self) -> &Joints;
    fn inverse_dynamics(&mut self, q: &[f64], v: &[f64], a: &[f64], tau: &mut [f64]);
    fn forward_dynamics(&mut self, q: &[f64], v: &[f64], tau: &[f64], a: &mut [f64]);
    /// Row by row.
    fn mass_matrix(&mut self, q: &[f64], out: &mut [f64]);
}

/// # Safety
/// The string ends in a zero.
pub unsafe fn open<E: Engine>(urdf: *const c_char, floating: c_int, gravity: [f64; 3]) -> *mut E {
    let path = unsafe { CStr::from_ptr(urdf) }.to_string_lossy().into_owned();
    match E::open(Path::new(&path), floating != 0, gravity) {
        Ok(engine) => Box::into_raw(Box::new(engine)),
        Err(reason) => {
            eprintln!("{path}: {reason}");
            std::ptr::null_mut()
        }
    }
}

/// A number of a joint: places and numbers of its coordinates and rates.
pub fn numbers(joints: &Joints, i: c_int) -> [c_int; 4] {
    joints.all.get(i as usize).map_or([-1; 4], |j| [j.q.0, j.q.1, j.v.0, j.v.1])
}

pub fn count(joints: &Joints) -> c_int {
    joints.all.len() as c_int
}

pub fn name(joints: &Joints, i: c_int) -> *const c_char {
    joints.all.get(i as usize).map_or(std::ptr::null(), |j| j.name.as_ptr())
}

/// The C interface of the engine `$engine`, which calls itself `$title` (a C string).
#[macro_export]
macro_rules! export {
    ($engine:ty, $title:expr) => {
        use std::ffi::{c_char as C, c_int as I};
        use std::slice::{from_raw_parts as numbers, from_raw_parts_mut as place};
        use $crate::Engine as _;

        type H = *mut $engine;

        #[unsafe(no_mangle)]
        pub extern "C" fn peer_name() -> *const C {
            $title.as_ptr()
        }
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn peer_open(urdf: *const C, floating: I, gx: f64, gy: f64, gz: f64) -> H {
            unsafe { $crate::open(urdf, floating, [gx, gy, gz]) }
        }
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn peer_close(h: H) {
            drop(unsafe { Box::from_raw(h) });
        }
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn peer_nq(h: H) -> I {
            unsafe { &*h }.joints().nq() as I
        }
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn peer_nv(h: H) -> I {
            unsafe { &*h }.joints().nv() as I
        }
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn peer_joint_count(h: H) -> I {
            $crate::count(unsafe { &*h }.joints())
        }
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn peer_joint_name(h: H, i: I) -> *const C {
            $crate::name(unsafe { &*h }.joints(), i)
        }
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn peer_joint_iq(h: H, i: I) -> I {
            $crate::numbers(unsafe { &*h }.joints(), i)[0]
        }
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn peer_joint_nq(h: H, i: I) -> I {
            $crate::numbers(unsafe { &*h }.joints(), i)[1]
        }
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn peer_joint_iv(h: H, i: I) -> I {
            $crate::numbers(unsafe { &*h }.joints(), i)[2]
        }
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn peer_joint_nv(h: H, i: I) -> I {
            $crate::numbers(unsafe { &*h }.joints(), i)[3]
        }
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn peer_inverse_dynamics(h: H, q: *const f64, v: *const f64, a: *const f64, tau: *mut f64) {
            let engine = unsafe { &mut *h };
            let (nq, nv) = (engine.joints().nq(), engine.joints().nv());
            unsafe { engine.inverse_dynamics(numbers(q, nq), numbers(v, nv), numbers(a, nv), place(tau, nv)) }
        }
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn peer_forward_dynamics(h: H, q: *const f64, v: *const f64, tau: *const f64, a: *mut f64) {
            let engine = unsafe { &mut *h };
            let (nq, nv) = (engine.joints().nq(), engine.joints().nv());
            unsafe { engine.forward_dynamics(numbers(q, nq), numbers(v, nv), numbers(tau, nv), place(a, nv)) }
        }
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn peer_mass_matrix(h: H, q: *const f64, out: *mut f64) {
            let engine = unsafe { &mut *h };
            let (nq, nv) = (engine.joints().nq(), engine.joints().nv());
            unsafe { engine.mass_matrix(numbers(q, nq), place(out, nv * nv)) }
        }
    };
}
