//! Generates the arm of the crate by a build script.

fn main() {
    #[cfg(feature = "generated")]
    articulated_codegen::Build::new("urdf/panda_like.urdf")
        .functions(["placements", "inverse_dynamics", "bias_forces", "gravity_torque", "mass_matrix", "forward_dynamics"])
        .write("panda_like");
}
