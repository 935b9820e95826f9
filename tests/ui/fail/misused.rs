// The compiler shows a function's definition where `functions` names it.
articulated::robot! {
    mod arm {
        urdf = "urdf/arm.urdf",
        functions = [
            gravity_torque,
            home = placements(q = 0),
        ],
    }
}

fn main() {
    arm::gravity_torque();
    arm::home(0.0);
}
