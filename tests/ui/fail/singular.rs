// A robot with a joint that has no inertia of its own has inverse but no forward dynamics.
articulated::robot! {
    mod arm {
        urdf = "urdf/massless.urdf",
        functions = [inverse_dynamics, forward_dynamics],
    }
}

fn main() {}
