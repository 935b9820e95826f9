//! A linear-quadratic regulator from generated derivatives: a cart balances a pole.
//!
//! Around the upright equilibrium ẋ = A x + B u with x = (q, v). A and B come from the derivatives
//! of forward dynamics, ∂a/∂q, ∂a/∂v and ∂a/∂τ, without differences of any kind.
//!
//! ```text
//! cargo run --release -p articulated-examples --bin lqr
//! ```

use nalgebra::{Matrix4, RowVector4, Vector4};

articulated::robot! {
    /// Joints: `slide`, m, which is driven, and `pole`, rad, which is not. Upright is q = 0.
    pub mod cart {
        urdf = "../models/urdf/cart_pole.urdf",
        functions = [forward_dynamics, forward_dynamics_derivatives],
    }
}

/// The controller's period, s.
const PERIOD: f64 = 0.01;

/// A and B over one period, to the second order in it: x' = A x + B u.
fn linearized() -> (Matrix4<f64>, Vector4<f64>) {
    let zero = [0.0; 2];
    let [by_q, by_v, by_tau] = cart::forward_dynamics_derivatives(&zero, &zero, &zero);
    let mut a = Matrix4::zeros();
    let mut b = Vector4::zeros();
    for row in 0..2 {
        a[(row, 2 + row)] = 1.0; // q̇ = v
        for column in 0..2 {
            a[(2 + row, column)] = by_q[row][column];
            a[(2 + row, 2 + column)] = by_v[row][column];
        }
        b[2 + row] = by_tau[row][cart::v_index::SLIDE];
    }
    let half = Matrix4::identity() + a * (PERIOD / 2.0);
    (Matrix4::identity() + a * half * PERIOD, half * b * PERIOD)
}

/// The gain K with u = −K x: the fixed point of the discrete Riccati equation.
fn gain(a: &Matrix4<f64>, b: &Vector4<f64>) -> RowVector4<f64> {
    let (state, input) = (Matrix4::from_diagonal(&Vector4::new(10.0, 10.0, 1.0, 1.0)), 0.1);
    let mut p = state;
    loop {
        let k = (b.transpose() * p * a) / (input + (b.transpose() * p * b)[0]);
        let next = state + a.transpose() * p * (a - b * k);
        if (next - p).norm() < 1e-10 * p.norm() {
            return k;
        }
        p = next;
    }
}

/// One step of a fourth-order Runge–Kutta method for (q, v).
fn step(x: &Vector4<f64>, force: f64, h: f64) -> Vector4<f64> {
    let rate = |x: Vector4<f64>| {
        let a = cart::forward_dynamics(&[x[0], x[1]], &[x[2], x[3]], &[force, 0.0]);
        Vector4::new(x[2], x[3], a[0], a[1])
    };
    let k1 = rate(*x);
    let k2 = rate(x + k1 * (h / 2.0));
    let k3 = rate(x + k2 * (h / 2.0));
    let k4 = rate(x + k3 * h);
    x + (k1 + k2 * 2.0 + k3 * 2.0 + k4) * (h / 6.0)
}

fn main() {
    let (a, b) = linearized();
    let k = gain(&a, &b);
    println!("gain: {:.2} {:.2} {:.2} {:.2}", k[0], k[1], k[2], k[3]);
    println!("time, s   cart, m   pole, rad   force, N");
    let mut x = Vector4::new(0.5, 0.3, 0.0, 0.0);
    for n in 0..=600 {
        let force = (-(k * x)[0]).clamp(-10.0, 10.0);
        if n % 60 == 0 {
            println!("{:7.2} {:9.4} {:11.4} {force:10.3}", f64::from(n) * PERIOD, x[0], x[1]);
        }
        x = (0..10).fold(x, |x, _| step(&x, force, PERIOD / 10.0));
    }
    println!("distance from the equilibrium after 6 s: {:.1e}", x.norm());
}
