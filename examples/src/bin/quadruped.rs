//! A floating quadruped falls on the ground and stands under proportional and derivative control.
//!
//! The key `effects` gives the feet contact with the ground; the solver is the linearly implicit
//! `rodas4`, since contact is stiff. The plot of the trunk's height is one line of characters per
//! 0.05 s.
//!
//! ```text
//! cargo run --release -p articulated-examples --bin quadruped
//! ```

use articulated::Dynamics;
use articulated::simulate::{IntegratorId, Output, Pd, Settings, Simulation};

articulated::robot! {
    /// Twelve joints on a floating trunk; feet are balls of 2 cm on the plane z = 0.
    pub mod walker {
        urdf = "../models/urdf/quadruped.urdf",
        base = floating,
        functions = [forward_dynamics, forward_dynamics_derivatives, integrate, difference],
        effects = { contact = {
            front_left_foot = { radius = 0.02, stiffness = 1e5, damping_time = 0.03, friction = 0.8 },
            front_right_foot = { radius = 0.02, stiffness = 1e5, damping_time = 0.03, friction = 0.8 },
            hind_left_foot = { radius = 0.02, stiffness = 1e5, damping_time = 0.03, friction = 0.8 },
            hind_right_foot = { radius = 0.02, stiffness = 1e5, damping_time = 0.03, friction = 0.8 },
        } },
    }
}

/// The coordinates of the stance, with the trunk at this height, m.
fn stance(height: f64) -> [f64; walker::NQ] {
    let mut q = walker::NEUTRAL;
    q[2] = height;
    for joint in walker::JOINT_NAMES.iter().filter_map(|name| walker::Robot.joint_named(name)) {
        // Knees bend towards the trunk's middle.
        let side = if joint.name.starts_with("front") { 1.0 } else { -1.0 };
        if joint.name.ends_with("hip_flexion") {
            q[joint.q.0] = 0.6 * side;
        } else if joint.name.ends_with("knee") {
            q[joint.q.0] = -1.2 * side;
        }
    }
    q
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let robot = walker::Robot;
    // Six zeros: nothing drives the trunk.
    let gains = |gain: f64| (0..walker::NV).map(|k| if k < 6 { 0.0 } else { gain }).collect::<Vec<f64>>();
    let mut control = Pd::new(&robot, stance(0.0).to_vec(), gains(600.0), gains(25.0))?;
    let settings = Settings { end: 2.0, integrator: IntegratorId::rodas4, output: Output::Every(0.05), ..Settings::default() };
    let motion = Simulation::new(&robot, settings)?.run(&stance(0.9), &[0.0; walker::NV], &mut control, &mut [])?;
    println!("time, s   height of the trunk, m");
    for (i, t) in motion.t.iter().enumerate() {
        let height = motion.q_at(i)[2];
        println!("{t:7.2} {height:9.4} {:>width$}", "o", width = (60.0 * height) as usize);
    }
    let last = motion.len() - 1;
    let speed = motion.v_at(last).iter().fold(0.0, |most: f64, v| most.max(v.abs()));
    println!("it stands at {:.3} m; the largest rate is {speed:.1e}", motion.q_at(last)[2]);
    Ok(())
}
