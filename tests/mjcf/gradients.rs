//! Times the exact derivatives of a generated step with constraints beside MuJoCo's finite
//! differences, `mjd_transitionFD`, in one process and in turns.
//!
//! gradients.py compiles this file with the path of generated code in `GENERATED`: `step`, its
//! Jacobian `slopes` by q, v and ctrl, and its vector-Jacobian product `pull`. Arguments: see
//! beside.rs; then rounds, the length of a step, and what a state of MuJoCo contains (mjtState).

use std::ffi::c_void;
use std::hint::black_box;

#[allow(dead_code)]
mod robot {
    include!(env!("GENERATED"));
}
mod beside;

use beside::{State, Theirs, clock, medians, states, write};
use robot::{NA, NU, NV};

unsafe extern "C" {
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

fn main() {
    let words: Vec<String> = std::env::args().collect();
    let rounds: usize = words[5].parse().expect("a number");
    let h: f64 = words[6].parse().expect("a length");
    let mut theirs = Theirs::new(&words[1], &words[7]);
    let (their_states, ours) = states(&words[2], &words[4], theirs.size);
    let count = ours.len();
    let n = 2 * NV + NA;
    let (mut a, mut b) = (vec![0.0; n * n * count], vec![0.0; n * NU * count]);
    let (mut ends, mut times): (Vec<robot::Slopes>, [Vec<f64>; 4]) = (Vec::new(), Default::default());
    // The search begins where that of the last step ended, as in a motion.
    let warm: Vec<[f64; NV]> = ours.iter().map(|s| robot::step(&s.q, &s.v, &s.act, &s.ctrl, &[0.0; NV], &h).warm_next).collect();
    for _ in 0..rounds {
        clock(&mut times[0], count, &mut || {
            for (k, state) in their_states.iter().enumerate() {
                let null = std::ptr::null_mut();
                theirs.set(state);
                // SAFETY: model and data are MuJoCo's, and the matrices have as many numbers as it
                // writes.
                unsafe {
                    mjd_transitionFD(theirs.model, theirs.data, WIDTH, 1, a[k * n * n..].as_mut_ptr(), b[k * n * NU..].as_mut_ptr(), null, null);
                }
            }
        });
        clock(&mut times[1], count, &mut || {
            for (s, warm) in black_box(&ours).iter().zip(&warm) {
                black_box(robot::step(&s.q, &s.v, &s.act, &s.ctrl, warm, &h));
            }
        });
        clock(&mut times[2], count, &mut || {
            for (s, warm) in black_box(&ours).iter().zip(&warm) {
                black_box(robot::pull(&s.q, &s.v, &s.act, &s.ctrl, warm, &h, &[0.1; NV], &[1.0; NV], &[0.0; NA], &[0.0; NV]));
            }
        });
        clock(&mut times[3], count, &mut || {
            let slopes = |(s, warm): (&State, &[f64; NV])| robot::slopes(&s.q, &s.v, &s.act, &s.ctrl, warm, &h);
            ends = black_box(&ours).iter().zip(&warm).map(slopes).collect();
        });
    }
    println!("{:?}", medians(times));
    // ∂v_next/∂(q, v, ctrl), then MuJoCo's A and B
    let own = ends.iter().flat_map(|end| {
        let by = [end.jac_v_next_q.as_flattened(), end.jac_v_next_v.as_flattened(), end.jac_v_next_ctrl.as_flattened()];
        by.into_iter().flatten().copied().collect::<Vec<f64>>()
    });
    write(&words[3], own.chain(a).chain(b));
}
