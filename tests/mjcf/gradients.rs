//! Times the exact derivatives of a generated step with constraints beside MuJoCo's finite
//! differences, `mjd_transitionFD`, in one process and in turns.
//!
//! gradients.py compiles this file with the path of generated code in `GENERATED`: `step`, its
//! Jacobian `slopes` by q, v and ctrl, and its vector-Jacobian product `pull`. Arguments: a
//! compiled model (mjb), states, the file to write, the number of states, rounds, the length of a
//! step, and what a state of MuJoCo contains (mjtState).

use std::ffi::{CString, c_char, c_int, c_void};
use std::hint::black_box;
use std::time::Instant;

#[allow(dead_code)]
mod robot {
    include!(env!("GENERATED"));
}

use robot::{NA, NQ, NU, NV};

unsafe extern "C" {
    fn mj_loadModel(file: *const c_char, vfs: *const c_void) -> *mut c_void;
    fn mj_makeData(model: *const c_void) -> *mut c_void;
    fn mj_stateSize(model: *const c_void, parts: c_int) -> c_int;
    fn mj_setState(model: *const c_void, data: *mut c_void, state: *const f64, parts: c_int);
    fn mjd_transitionFD(
        model: *const c_void,
        data: *mut c_void,
        eps: f64,
        centered: u8,
        a: *mut f64,
        b: *mut f64,
        c: *mut f64,
        d: *mut f64,
    );
}

/// A width of differences at which MuJoCo's error is about the least.
const WIDTH: f64 = 1e-6;

struct State {
    q: [f64; NQ],
    v: [f64; NV],
    act: [f64; NA],
    ctrl: [f64; NU],
}

fn array<const N: usize>(numbers: Vec<f64>) -> [f64; N] {
    numbers.try_into().expect("as many numbers as the robot has")
}

fn main() {
    let words: Vec<String> = std::env::args().collect();
    let number = |k: usize| words[k].parse::<usize>().expect("a number");
    let (states, rounds, parts) = (number(4), number(5), c_int::try_from(number(7)).expect("few bits"));
    let h: f64 = words[6].parse().expect("a length");
    let file = CString::new(words[1].as_str()).expect("a path without zeros");
    // SAFETY: the path ends with a zero; the model is checked before it is used.
    let (model, data, size) = unsafe {
        let model = mj_loadModel(file.as_ptr(), std::ptr::null());
        assert!(!model.is_null(), "MuJoCo does not load the model");
        (model, mj_makeData(model), usize::try_from(mj_stateSize(model, parts)).expect("a size"))
    };
    let bytes = std::fs::read(&words[2]).expect("states");
    let mut numbers = bytes.chunks_exact(8).map(|x| f64::from_le_bytes(x.try_into().expect("eight bytes")));
    let mut take = |count: usize| numbers.by_ref().take(count).collect::<Vec<f64>>();
    let (mut theirs, mut ours) = (Vec::new(), Vec::new());
    for _ in 0..states {
        theirs.push(take(size));
        let robot::StateOfMujoco { q, v } = robot::state_of_mujoco(&array(take(NQ)), &array(take(NV)));
        ours.push(State { q, v, act: array(take(NA)), ctrl: array(take(NU)) });
    }
    let n = 2 * NV + NA;
    let (mut a, mut b) = (vec![0.0; n * n * states], vec![0.0; n * NU * states]);
    let (mut ends, mut times): (Vec<robot::Slopes>, [Vec<f64>; 4]) = (Vec::new(), Default::default());
    // The search begins where that of the last step ended, as in a motion.
    let warm: Vec<[f64; NV]> = ours.iter().map(|s| robot::step(&s.q, &s.v, &s.act, &s.ctrl, &[0.0; NV], &h).warm_next).collect();
    for _ in 0..rounds {
        let clock = |times: &mut Vec<f64>, run: &mut dyn FnMut()| {
            let start = Instant::now();
            run();
            times.push(start.elapsed().as_secs_f64() * 1e9 / states as f64);
        };
        clock(&mut times[0], &mut || {
            for (k, state) in theirs.iter().enumerate() {
                let null = std::ptr::null_mut();
                // SAFETY: model and data are MuJoCo's, the state has its size, and the matrices
                // have as many numbers as it writes.
                unsafe {
                    mj_setState(model, data, state.as_ptr(), parts);
                    mjd_transitionFD(model, data, WIDTH, 1, a[k * n * n..].as_mut_ptr(), b[k * n * NU..].as_mut_ptr(), null, null);
                }
            }
        });
        clock(&mut times[1], &mut || {
            for (s, warm) in black_box(&ours).iter().zip(&warm) {
                black_box(robot::step(&s.q, &s.v, &s.act, &s.ctrl, warm, &h));
            }
        });
        clock(&mut times[2], &mut || {
            for (s, warm) in black_box(&ours).iter().zip(&warm) {
                black_box(robot::pull(&s.q, &s.v, &s.act, &s.ctrl, warm, &h, &[0.1; NV], &[1.0; NV], &[0.0; NA], &[0.0; NV]));
            }
        });
        clock(&mut times[3], &mut || {
            let slopes = |(s, warm): (&State, &[f64; NV])| robot::slopes(&s.q, &s.v, &s.act, &s.ctrl, warm, &h);
            ends = black_box(&ours).iter().zip(&warm).map(slopes).collect();
        });
    }
    let medians = times.map(|mut times| {
        times.sort_by(f64::total_cmp);
        times[times.len() / 2]
    });
    println!("{medians:?}");
    // ∂v_next/∂(q, v, ctrl), then MuJoCo's A and B
    let own = ends.iter().flat_map(|end| {
        let by = [end.jac_v_next_q.as_flattened(), end.jac_v_next_v.as_flattened(), end.jac_v_next_ctrl.as_flattened()];
        by.into_iter().flatten().copied().collect::<Vec<f64>>()
    });
    let bytes: Vec<u8> = own.chain(a).chain(b).flat_map(f64::to_le_bytes).collect();
    std::fs::write(&words[3], bytes).expect("the ends can be written");
}
