//! Times the stages of a step with constraints, generated and MuJoCo's, in one process and in
//! turns.
//!
//! stages.py compiles this file with the path of generated code in `GENERATED`. Arguments: see
//! beside.rs; then rounds, the length of a step, and what a state of MuJoCo contains (mjtState).

use std::ffi::c_void;
use std::hint::black_box;

#[allow(dead_code)]
mod robot {
    include!(env!("GENERATED"));
}
mod beside;

use beside::{State, Theirs, clock, medians, states, write};
use robot::NV;

/// A stage of MuJoCo.
type Stage = unsafe extern "C" fn(*const c_void, *mut c_void);

unsafe extern "C" {
    fn mj_kinematics(model: *const c_void, data: *mut c_void);
    fn mj_comPos(model: *const c_void, data: *mut c_void);
    fn mj_tendon(model: *const c_void, data: *mut c_void);
    fn mj_makeM(model: *const c_void, data: *mut c_void);
    fn mj_factorM(model: *const c_void, data: *mut c_void);
    fn mj_transmission(model: *const c_void, data: *mut c_void);
    fn mj_collision(model: *const c_void, data: *mut c_void);
    fn mj_makeConstraint(model: *const c_void, data: *mut c_void);
    fn mj_projectConstraint(model: *const c_void, data: *mut c_void);
    fn mj_fwdVelocity(model: *const c_void, data: *mut c_void);
    fn mj_fwdActuation(model: *const c_void, data: *mut c_void);
    fn mj_fwdAcceleration(model: *const c_void, data: *mut c_void);
    fn mj_fwdConstraint(model: *const c_void, data: *mut c_void);
    fn mj_Euler(model: *const c_void, data: *mut c_void);
    fn mj_step(model: *const c_void, data: *mut c_void);
}

/// Stages of MuJoCo, in the order in which a step runs them.
const STAGES: [&[Stage]; 7] = [
    &[mj_kinematics, mj_comPos, mj_tendon, mj_makeM, mj_factorM],
    &[mj_collision],
    &[mj_makeConstraint],
    &[mj_transmission, mj_projectConstraint],
    &[mj_fwdVelocity, mj_fwdActuation, mj_fwdAcceleration],
    &[mj_fwdConstraint],
    &[mj_Euler],
];
/// How often a stage of a state runs, so that the clock counts.
const AGAIN: usize = 20;

fn main() {
    let words: Vec<String> = std::env::args().collect();
    let (rounds, h) = (words[5].parse::<usize>().expect("a number"), words[6].parse::<f64>().expect("a length"));
    let mut theirs = Theirs::new(&words[1], &words[7]);
    let (their_states, mut ours) = states(&words[2], &words[4], theirs.size);
    let count = ours.len();
    // The search begins where that of the last step ended: the states are those after a step.
    for s in &mut ours {
        let next = robot::step(&s.q, &s.v, &s.act, &s.ctrl, &[0.0; NV], &h);
        *s = State { q: next.q_next, v: next.v_next, act: next.act_next, ctrl: s.ctrl, warm: next.warm_next };
    }
    let search = |s: &State| robot::constrained_search(&s.q, &s.v, &s.act, &s.ctrl, &s.warm);
    let (found, steps): (Vec<[f64; NV]>, Vec<f64>) = ours.iter().map(search).map(|own| (own.found, own.steps)).unzip();
    let mut times: [Vec<f64>; 11] = Default::default();
    for _ in 0..rounds {
        let mut own = |k: usize, run: &dyn Fn(&State, &[f64; NV])| {
            clock(&mut times[k], count, &mut || black_box(&ours).iter().zip(&found).for_each(|(s, found)| run(s, found)));
        };
        own(0, &|s, _| drop(black_box(robot::smooth(&s.q, &s.v, &s.act, &s.ctrl, &h))));
        own(1, &|s, found| drop(black_box(robot::constrained_error(&s.q, &s.v, &s.act, &s.ctrl, found))));
        own(2, &|s, _| drop(black_box(robot::step(&s.q, &s.v, &s.act, &s.ctrl, &s.warm, &h))));
        let mut sums = [0.0; 8];
        for state in &their_states {
            theirs.set(state);
            // SAFETY: model and data are MuJoCo's, and stages run in the order of a step. Each may
            // run several times.
            unsafe {
                mj_step(theirs.model, theirs.data);
                for (sum, stage) in sums.iter_mut().zip(STAGES) {
                    let start = std::time::Instant::now();
                    for _ in 0..AGAIN {
                        stage.iter().for_each(|run| run(theirs.model, theirs.data));
                    }
                    *sum += start.elapsed().as_secs_f64() * 1e9 / (AGAIN * count) as f64;
                }
                theirs.set(state);
                mj_step(theirs.model, theirs.data);
                let start = std::time::Instant::now();
                mj_step(theirs.model, theirs.data);
                sums[7] += start.elapsed().as_secs_f64() * 1e9 / count as f64;
            }
        }
        times[3..].iter_mut().zip(sums).for_each(|(times, sum)| times.push(sum));
    }
    println!("{:?}", medians(times));
    write(&words[3], steps.into_iter());
}
