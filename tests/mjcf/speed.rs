//! Times rollouts of generated steps beside MuJoCo's `mj_step`, in one process and in turns.
//!
//! speed.py compiles this file with the path of generated code in `GENERATED`: a function `step`
//! with controls and h, and the translation of states. Arguments: see beside.rs; then steps,
//! rounds, the length of a step, and what a state of MuJoCo contains (mjtState). With
//! `--cfg constrained` the step has constraints.

use std::ffi::{c_int, c_void};
use std::hint::black_box;

#[allow(dead_code)]
mod robot {
    include!(env!("GENERATED"));
}
mod beside;

use beside::{State, Theirs, clock, medians, states, write};
use robot::NV;

unsafe extern "C" {
    fn mj_getState(model: *const c_void, data: *const c_void, state: *mut f64, parts: c_int);
    fn mj_step(model: *const c_void, data: *mut c_void);
}

fn rolled(theirs: &mut Theirs, start: &[f64], steps: usize, end: &mut [f64]) {
    assert_eq!(end.len(), theirs.size);
    theirs.set(start);
    // SAFETY: model and data are MuJoCo's, and the state has its size.
    unsafe {
        (0..steps).for_each(|_| mj_step(theirs.model, theirs.data));
        mj_getState(theirs.model, theirs.data, end.as_mut_ptr(), theirs.parts);
    }
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
    let (steps, rounds) = (number(5), number(6));
    let h: f64 = words[7].parse().expect("a length");
    let mut theirs = Theirs::new(&words[1], &words[8]);
    let (their_starts, starts) = states(&words[2], &words[4], theirs.size);
    let count = starts.len() * steps;
    let mut their_ends = their_starts.clone();
    let mut ends = [starts.clone(), starts.clone(), starts.clone()];
    let mut times: [Vec<f64>; 4] = Default::default();
    for _ in 0..rounds {
        clock(&mut times[0], count, &mut || {
            their_starts.iter().zip(&mut their_ends).for_each(|(start, end)| rolled(&mut theirs, start, steps, end));
        });
        clock(&mut times[1], count, &mut || ends[0] = black_box(&starts).iter().map(|start| alone(start, steps, h)).collect());
        clock(&mut times[2], count, &mut || ends[1] = in_f64(black_box(&starts), steps, h));
        clock(&mut times[3], count, &mut || ends[2] = in_f32(black_box(&starts), steps, h));
    }
    println!("{:?}", medians(times));
    let own = ends.iter().flatten().flat_map(|s| {
        let robot::MujocoState { qpos, qvel } = robot::mujoco_state(&s.q, &s.v);
        qpos.into_iter().chain(qvel).chain(s.act)
    });
    write(&words[3], their_ends.iter().flatten().copied().chain(own));
}
