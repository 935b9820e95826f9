//! Generates a step whose contacts are an argument.

use articulated_codegen::Build;

fn main() {
    Build::new("gems.xml")
        .standalone()
        .file_effects()
        .given_contact("floor", "lower", 4)
        .given_contact("floor", "upper", 4)
        .given_contact("lower", "upper", 4)
        .functions(["constrained_step_implicit_damping_with_contacts", "placements", "kinetic_energy"])
        .write("gems");
}
