//! Entries of the lists that the generator reads: each mistake at its entry.

articulated::robot! {
    mod arm {
        urdf = "urdf/arm.urdf",
        functions = [
            mass_matrix,
            mass_matrix + placements,
            twice = mass_matrix + mass_matrix,
            inverse_dynamics(b = 0),
            bias = inverse_dynamics(a = [0, 0, 0]),
            again = operational_space_inertia,
        ],
        parameters = [payload(four), weight(upper)],
    }
}

fn main() {}
