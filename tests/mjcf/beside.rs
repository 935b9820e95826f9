//! MuJoCo's library beside generated code, in one process: for the programs of this folder.
//!
//! The first arguments of each: a compiled model (mjb), states, the file to write, and the number
//! of states. A state is one of MuJoCo, and the same for the generated code.

use std::ffi::{CString, c_char, c_int, c_void};
use std::time::Instant;

use crate::robot::{NA, NQ, NU, NV};

unsafe extern "C" {
    fn mj_loadModel(file: *const c_char, vfs: *const c_void) -> *mut c_void;
    fn mj_makeData(model: *const c_void) -> *mut c_void;
    fn mj_stateSize(model: *const c_void, parts: c_int) -> c_int;
    fn mj_setState(model: *const c_void, data: *mut c_void, state: *const f64, parts: c_int);
}

/// MuJoCo with one model.
pub struct Theirs {
    pub model: *mut c_void,
    pub data: *mut c_void,
    /// What a state contains (mjtState).
    pub parts: c_int,
    /// How many numbers that are.
    pub size: usize,
}

impl Theirs {
    pub fn new(file: &str, parts: &str) -> Self {
        let (file, parts) = (CString::new(file).expect("a path without zeros"), parts.parse().expect("a number"));
        // SAFETY: the path ends with a zero; the model is checked before it is used.
        unsafe {
            let model = mj_loadModel(file.as_ptr(), std::ptr::null());
            assert!(!model.is_null(), "MuJoCo does not load the model");
            let size = usize::try_from(mj_stateSize(model, parts)).expect("a size");
            Self { model, data: mj_makeData(model), parts, size }
        }
    }

    pub fn set(&mut self, state: &[f64]) {
        assert_eq!(state.len(), self.size);
        // SAFETY: model and data are MuJoCo's, and the state has its size.
        unsafe { mj_setState(self.model, self.data, state.as_ptr(), self.parts) }
    }
}

/// A state for generated code.
#[derive(Clone)]
pub struct State {
    pub q: [f64; NQ],
    pub v: [f64; NV],
    pub act: [f64; NA],
    pub ctrl: [f64; NU],
    /// The last acceleration, of steps with constraints.
    pub warm: [f64; NV],
}

fn array<const N: usize>(numbers: Vec<f64>) -> [f64; N] {
    numbers.try_into().expect("as many numbers as the robot has")
}

/// The states of a file, of MuJoCo and for generated code.
pub fn states(file: &str, count: &str, size: usize) -> (Vec<Vec<f64>>, Vec<State>) {
    let bytes = std::fs::read(file).expect("states");
    let mut numbers = bytes.chunks_exact(8).map(|x| f64::from_le_bytes(x.try_into().expect("eight bytes")));
    let mut take = |count: usize| numbers.by_ref().take(count).collect::<Vec<f64>>();
    let one = |_| {
        let theirs = take(size);
        let crate::robot::StateOfMujoco { q, v } = crate::robot::state_of_mujoco(&array(take(NQ)), &array(take(NV)));
        (theirs, State { q, v, act: array(take(NA)), ctrl: array(take(NU)), warm: [0.0; NV] })
    };
    (0..count.parse::<usize>().expect("a number")).map(one).unzip()
}

/// Adds the time of a run, ns for each of `count`.
pub fn clock(times: &mut Vec<f64>, count: usize, run: &mut dyn FnMut()) {
    let start = Instant::now();
    run();
    times.push(start.elapsed().as_secs_f64() * 1e9 / count as f64);
}

/// The median of each.
pub fn medians<const N: usize>(times: [Vec<f64>; N]) -> [f64; N] {
    times.map(|mut times| {
        times.sort_by(f64::total_cmp);
        times[times.len() / 2]
    })
}

/// Writes numbers to a file.
pub fn write(file: &str, numbers: impl Iterator<Item = f64>) {
    let bytes: Vec<u8> = numbers.flat_map(f64::to_le_bytes).collect();
    std::fs::write(file, bytes).expect("the ends can be written");
}
