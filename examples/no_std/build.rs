//! Writes the robot's code when the crate is built.

fn main() {
    articulated_codegen::Build::new("../../models/urdf/ur5_like.urdf")
        .no_std()
        .functions(["hold = gravity_torque", "quick = inverse_dynamics(q = sin_cos)"])
        .write("arm");
}
