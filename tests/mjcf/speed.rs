//! Times rollouts of generated steps beside MuJoCo's `mj_step`, in one process and in turns.
//!
//! speed.py compiles this file with the path of generated code in `GENERATED`: a function `step`
//! with controls and h, and the translation of states. Arguments: a compiled model (mjb), states,
//! the file to write, the number of states, steps, rounds, the length of a step, and what a state
//! of MuJoCo contains (mjtState). With `--cfg constrained` the step has constraints.

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
    fn mj_getState(model: *const c_void, data: *const c_void, state: *mut f64, parts: c_int);
    fn mj_step(model: *const c_void, data: *mut c_void);
}

/// MuJoCo with one model.
struct Theirs {
    model: *mut c_void,
    data: *mut c_void,
    parts: c_int,
    size: usize,
}

impl Theirs {
    fn new(file: &str, parts: c_int) -> Self {
        let file = CString::new(file).expect("a path without zeros");
        // SAFETY: the path ends with a zero; the model is checked before it is used.
        unsafe {
            let model = mj_loadModel(file.as_ptr(), std::ptr::null());
            assert!(!model.is_null(), "MuJoCo does not load the model");
            let size = mj_stateSize(model, parts);
            Self { model, data: mj_makeData(model), parts, size: usize::try_from(size).expect("a size") }
        }
    }

    fn roll(&mut self, start: &[f64], steps: usize, end: &mut [f64]) {
        assert!(start.len() == self.size && end.len() == self.size);
        // SAFETY: model and data are MuJoCo's, and the states have their size.
        unsafe {
            mj_setState(self.model, self.data, start.as_ptr(), self.parts);
            (0..steps).for_each(|_| mj_step(self.model, self.data));
            mj_getState(self.model, self.data, end.as_mut_ptr(), self.parts);
        }
    }
}

#[derive(Clone)]
struct State {
    q: [f64; NQ],
    v: [f64; NV],
    act: [f64; NA],
    ctrl: [f64; NU],
    /// The last acceleration, of steps with constraints.
    warm: [f64; NV],
}

fn array<const N: usize>(numbers: Vec<f64>) -> [f64; N] {
    numbers.try_into().expect("as many numbers as the robot has")
}

fn alone(start: &State, steps: usize, h: f64) -> State {
    let mut state = start.clone();
    for _ in 0..steps {
        #[cfg(not(constrained))]
        let next = robot::step(&state.q, &state.v, &state.act, &state.ctrl, &h);
        #[cfg(constrained)]
        let next = robot::step(&state.q, &state.v, &state.act, &state.ctrl, &state.warm, &h);
        (state.q, state.v, state.act) = (next.q_next, next.v_next, next.act_next);
        #[cfg(constrained)]
        {
            state.warm = next.warm_next;
        }
    }
    state
}

macro_rules! lanes {
    ($name:ident, $batch:ident, $real:ty) => {
        /// Each block is stepped to its end before the next.
        fn $name(starts: &[State], steps: usize, h: f64) -> Vec<State> {
            use robot::$batch::{Lanes, step_blocks};
            fn packed<const N: usize>(states: &[State], part: fn(&State) -> &[f64; N]) -> [[Lanes; N]; 1] {
                let rows: Vec<[$real; N]> = states.iter().map(|state| part(state).map(|x| x as $real)).collect();
                let mut blocks = [[Lanes::ZERO; N]];
                Lanes::pack(&rows, &mut blocks).expect("a block");
                blocks
            }
            fn unpacked<const N: usize>(blocks: &[[Lanes; N]; 1], count: usize) -> Vec<[f64; N]> {
                let mut rows = vec![[0.0; N]; count];
                Lanes::unpack(blocks, &mut rows).expect("a block");
                rows.iter().map(|row| row.map(f64::from)).collect()
            }
            let h = [Lanes([h as $real; Lanes::LEN])];
            let mut ends = Vec::with_capacity(starts.len());
            for states in starts.chunks(Lanes::LEN) {
                let (mut q, mut v) = (packed(states, |s| &s.q), packed(states, |s| &s.v));
                let (mut act, ctrl) = (packed(states, |s| &s.act), packed(states, |s| &s.ctrl));
                // Two places take turns, so that nothing is copied.
                let (mut q_next, mut v_next, mut act_next) = (q, v, act);
                #[cfg(constrained)]
                let (mut warm, mut warm_next) = (packed(states, |s| &s.warm), packed(states, |s| &s.warm));
                for step in 0..steps {
                    #[cfg(not(constrained))]
                    let done = if step % 2 == 0 {
                        step_blocks(&q, &v, &act, &ctrl, &h, &mut q_next, &mut v_next, &mut act_next)
                    } else {
                        step_blocks(&q_next, &v_next, &act_next, &ctrl, &h, &mut q, &mut v, &mut act)
                    };
                    #[cfg(constrained)]
                    let done = if step % 2 == 0 {
                        step_blocks(&q, &v, &act, &ctrl, &warm, &h, &mut q_next, &mut v_next, &mut act_next, &mut warm_next)
                    } else {
                        step_blocks(&q_next, &v_next, &act_next, &ctrl, &warm_next, &h, &mut q, &mut v, &mut act, &mut warm)
                    };
                    done.expect("blocks of one length");
                }
                if steps % 2 == 1 {
                    (q, v, act) = (q_next, v_next, act_next);
                }
                let (q, v, act) = (unpacked(&q, states.len()), unpacked(&v, states.len()), unpacked(&act, states.len()));
                ends.extend((0..states.len()).map(|k| State { q: q[k], v: v[k], act: act[k], ctrl: states[k].ctrl, warm: [0.0; NV] }));
            }
            ends
        }
    };
}

lanes!(in_f64, batch_f64, f64);
lanes!(in_f32, batch_f32, f32);

fn main() {
    let words: Vec<String> = std::env::args().collect();
    let number = |k: usize| words[k].parse::<usize>().expect("a number");
    let (states, steps, rounds, parts) = (number(4), number(5), number(6), number(8));
    let h: f64 = words[7].parse().expect("a length");
    let mut theirs = Theirs::new(&words[1], c_int::try_from(parts).expect("few bits"));
    let bytes = std::fs::read(&words[2]).expect("states");
    let mut numbers = bytes.chunks_exact(8).map(|x| f64::from_le_bytes(x.try_into().expect("eight bytes")));
    let mut take = |count: usize| numbers.by_ref().take(count).collect::<Vec<f64>>();
    let (mut their_starts, mut starts) = (Vec::new(), Vec::new());
    for _ in 0..states {
        their_starts.push(take(theirs.size));
        let robot::StateOfMujoco { q, v } = robot::state_of_mujoco(&array(take(NQ)), &array(take(NV)));
        starts.push(State { q, v, act: array(take(NA)), ctrl: array(take(NU)), warm: [0.0; NV] });
    }

    let mut their_ends = their_starts.clone();
    let mut ends = [starts.clone(), starts.clone(), starts.clone()];
    let mut times: [Vec<f64>; 4] = Default::default();
    for _ in 0..rounds {
        let clock = |times: &mut Vec<f64>, run: &mut dyn FnMut()| {
            let start = Instant::now();
            run();
            times.push(start.elapsed().as_secs_f64() * 1e9 / (states * steps) as f64);
        };
        clock(&mut times[0], &mut || {
            their_starts.iter().zip(&mut their_ends).for_each(|(start, end)| theirs.roll(start, steps, end));
        });
        clock(&mut times[1], &mut || ends[0] = black_box(&starts).iter().map(|start| alone(start, steps, h)).collect());
        clock(&mut times[2], &mut || ends[1] = in_f64(black_box(&starts), steps, h));
        clock(&mut times[3], &mut || ends[2] = in_f32(black_box(&starts), steps, h));
    }
    let medians = times.map(|mut times| {
        times.sort_by(f64::total_cmp);
        times[times.len() / 2]
    });
    println!("{medians:?}");
    let own = ends.iter().flatten().flat_map(|s| {
        let robot::MujocoState { qpos, qvel } = robot::mujoco_state(&s.q, &s.v);
        qpos.into_iter().chain(qvel).chain(s.act)
    });
    let bytes: Vec<u8> = their_ends.iter().flatten().copied().chain(own).flat_map(f64::to_le_bytes).collect();
    std::fs::write(&words[3], bytes).expect("the ends can be written");
}
