//! Reads a robot at run time and says what it is: no code is generated.
//!
//! ```text
//! cargo run --release -p articulated-examples --bin read_a_robot -- robot.urdf
//! ```

use articulated::{Base, Dynamics, JointKind, Model};

const DEFAULT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../models/urdf/gripper_arm.urdf");

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let file = std::env::args().nth(1).unwrap_or_else(|| DEFAULT.to_owned());
    let model: Model = articulated::load(&file, Base::Fixed)?;
    println!("{}: {} degrees of freedom, {:.3} kg that move", model.name(), model.nv(), model.moving_mass());

    // What holds it still where all coordinates are in the middle of their limits.
    let mut q = model.neutral();
    for joint in model.joints() {
        if let (Some(limit), JointKind::Revolute | JointKind::Prismatic) = (joint.limit, joint.kind) {
            q[joint.q.0] = (limit.lower + limit.upper) / 2.0;
        }
    }
    let (mut workspace, mut tau) = (model.workspace(), vec![0.0; model.nv()]);
    model.gravity_torque(&mut workspace, &q, &mut tau)?;
    println!("{:24} {:>12} {:>12} {:>12}", "joint", "kind", "q", "holds with");
    for joint in model.joints() {
        println!("{:24} {:>12} {:12.4} {:12.4}", joint.name, joint.kind.name(), q[joint.q.0], tau[joint.v.0]);
    }

    let mut places = vec![0.0; 12 * model.frames().len()];
    model.placements(&mut workspace, &q, &mut places)?;
    if let (Some(frame), Some(at)) = (model.frames().last(), places.chunks_exact(12).next_back()) {
        println!("{} is at ({:.4}, {:.4}, {:.4}) m", frame.name, at[9], at[10], at[11]);
    }
    Ok(())
}
