//! What derivatives by transforms cost beside their function: products with vectors, and whole
//! matrices.
//!
//! ```text
//! cargo run --release -p articulated-examples --bin gradients
//! ```

use std::hint::black_box;
use std::time::Instant;

articulated::robot! {
    pub mod arm {
        urdf = "../models/urdf/panda_like.urdf",
        functions = [
            inverse_dynamics, forward_dynamics, inverse_dynamics_derivatives, forward_dynamics_derivatives,
            vjp_id = vjp(inverse_dynamics), jvp_id = jvp(inverse_dynamics), hvp_id = hvp(inverse_dynamics),
            vjp_fd = vjp(forward_dynamics), jvp_fd = jvp(forward_dynamics),
        ],
    }
}

articulated::robot! {
    pub mod legs {
        urdf = "../models/urdf/quadruped.urdf",
        base = floating,
        functions = [
            inverse_dynamics, forward_dynamics, inverse_dynamics_derivatives, forward_dynamics_derivatives,
            vjp_id = vjp(inverse_dynamics), jvp_id = jvp(inverse_dynamics), hvp_id = hvp(inverse_dynamics),
            vjp_fd = vjp(forward_dynamics), jvp_fd = jvp(forward_dynamics),
        ],
    }
}

/// The median time of a call, ns, in rounds of a thousand. The result is written to the same place.
fn time<T>(mut out: T, mut call: impl FnMut(&mut T)) -> f64 {
    let mut round = || {
        let start = Instant::now();
        for _ in 0..1000 {
            call(black_box(&mut out));
        }
        start.elapsed().as_secs_f64() * 1e6
    };
    let mut rounds: Vec<f64> = (0..51).map(|_| round()).collect();
    rounds.sort_by(f64::total_cmp);
    rounds[25]
}

/// The time of a function of q and more.
macro_rules! timed {
    ($of:ident, $into:ident, $q:ident $(, $argument:ident)*) => {
        time($of(&$q $(, &$argument)*), |out| $into(black_box(&$q) $(, &$argument)*, out))
    };
}

/// Prints the table of a robot; λᵀ(J s) from both sides as a check.
macro_rules! table {
    ($robot:ident) => {{
        use $robot::*;
        let number = |k: usize| 0.3 + 0.7 * (k as f64).sin();
        let q: [f64; NQ] = std::array::from_fn(|k| NEUTRAL[k] + if NQ > NV && k < 7 { 0.0 } else { 0.4 * number(k) });
        let [v, a, s, r, t, w]: [[f64; NV]; 6] = std::array::from_fn(|i| std::array::from_fn(|k| number(k + 20 * i)));
        let (pulled, pushed) = (vjp_id(&q, &v, &a, &w), jvp_id(&q, &v, &a, &s, &r, &t));
        let dot = |x: &[f64; NV], y: &[f64; NV]| x.iter().zip(y).map(|(x, y)| x * y).sum::<f64>();
        let (left, right) = (dot(&w, &pushed), dot(&pulled.grad_q, &s) + dot(&pulled.grad_v, &r) + dot(&pulled.grad_a, &t));
        println!("{}: λᵀ(J s) and (λᵀJ) s differ by {:.1e}", stringify!($robot), ((left - right) / left).abs());
        let id = timed!(inverse_dynamics, inverse_dynamics_into, q, v, a);
        let fd = timed!(forward_dynamics, forward_dynamics_into, q, v, a);
        let rows = [
            ("inverse_dynamics", id, id),
            ("vjp(inverse_dynamics)", timed!(vjp_id, vjp_id_into, q, v, a, w), id),
            ("jvp(inverse_dynamics)", timed!(jvp_id, jvp_id_into, q, v, a, s, r, t), id),
            ("hvp(inverse_dynamics)", timed!(hvp_id, hvp_id_into, q, v, a, w, s, r, t), id),
            ("inverse_dynamics_derivatives", timed!(inverse_dynamics_derivatives, inverse_dynamics_derivatives_into, q, v, a), id),
            ("forward_dynamics", fd, fd),
            ("vjp(forward_dynamics)", timed!(vjp_fd, vjp_fd_into, q, v, a, w), fd),
            ("jvp(forward_dynamics)", timed!(jvp_fd, jvp_fd_into, q, v, a, s, r, t), fd),
            ("forward_dynamics_derivatives", timed!(forward_dynamics_derivatives, forward_dynamics_derivatives_into, q, v, a), fd),
        ];
        for (name, own, of) in rows {
            println!("  {name:<30}{own:9.1} ns{:8.2} of the function", own / of);
        }
    }};
}

fn main() {
    table!(arm);
    table!(legs);
}
