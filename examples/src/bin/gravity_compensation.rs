//! Gravity compensation of an arm whose payload is known only when the program runs.
//!
//! The key `parameters` leaves the payload's ten inertial parameters an input of the generated
//! code: m, m·c (three), and the six moments about the origin of the link's frame, in its axes.
//!
//! ```text
//! cargo run --release -p articulated-examples --bin gravity_compensation
//! ```

articulated::robot! {
    /// A six-axis arm with a gripper that picks up things.
    pub mod arm {
        urdf = "../models/urdf/ur5_like.urdf",
        functions = [gravity_torque, forward_dynamics],
        parameters = [payload(flange)],
    }
}

/// A point mass, kg, at a place in the flange's frame, m.
fn point_mass(m: f64, [x, y, z]: [f64; 3]) -> [f64; arm::PARAMETERS.len()] {
    // I = m (|c|² 1 − c cᵀ), in the order xx, xy, xz, yy, yz, zz.
    let moments = [y * y + z * z, -x * y, -x * z, x * x + z * z, -y * z, x * x + y * y].map(|i| m * i);
    let mut parameters = [0.0; 10];
    parameters[..4].copy_from_slice(&[m, m * x, m * y, m * z]);
    parameters[4..].copy_from_slice(&moments);
    parameters
}

fn main() {
    let (q, still) = ([0.3, -1.2, 1.4, -0.8, 0.5, 0.0], [0.0; arm::NV]);
    let empty = point_mass(0.0, [0.0; 3]);
    println!("payload kg   shoulder N·m   acceleration with it known, rad/s²   with it unknown, rad/s²");
    for mass in [0.0, 1.0, 3.0, 5.0] {
        let load = point_mass(mass, [0.0, 0.0, 0.1]);
        let largest = |torques: &[f64; arm::NV]| {
            let a = arm::forward_dynamics(&q, &still, torques, &load);
            a.iter().fold(0.0, |most: f64, a| most.max(a.abs()))
        };
        let (known, unknown) = (arm::gravity_torque(&q, &load), arm::gravity_torque(&q, &empty));
        println!("{mass:10.1} {:14.2} {:36.1e} {:25.2}", known[1], largest(&known), largest(&unknown));
    }
}
