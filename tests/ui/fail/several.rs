//! Many errors: all of them at once; those that only the robot shows come last.

articulated::robot! {
    pub mod clash {
        urdf = "urdf/clash.urdf",
        base = 3,
        gravity = "down",
        functions = [fly, placements, inverse_dynamiks],
        rename = { "tool" = TOOL, "tool" = TIP },
        allow_unphysical_inertia = yes,
        snap_angles = -1e-9,
        crate = ,
        standalone = 1,
        "base" = fixed,
        scale = 2.0,
    }
}

fn main() {}
