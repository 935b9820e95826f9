//! Edits that cannot be made, and mistakes inside their tables: each at its word.

articulated::robot! {
    pub mod arm {
        urdf = "urdf/three.urdf",
        frames = [tol, fore, "fore"],
        wrenches_in = base,
        lock = { elbo = 0.5, wrist = [0.0, 1.0], yaw = 0.1, "yaw" = 0.2 },
        payload = [{ link = hand, mass = 1.2 }, { link = tool, mass = -1 }, { mas = 3, link = tool, mass = 1, inertia = [1, 2] }, { link = fore }],
    }
}

articulated::robot! {
    pub mod with_nothing {
        urdf = "urdf/three.urdf",
        append = { urdf = "urdf/none.urdf", at = tool },
        lock = { close = 0.0 },
    }
}

articulated::robot! {
    pub mod with_itself {
        urdf = "urdf/three.urdf",
        append = [{ urdf = "urdf/three.urdf", at = tool }, { urdf = "urdf/gripper.urdf", at = toll }, { urdf = "urdf/broken.urdf", at = tool }],
        lock = { close = 0.0 },
        payload = { link = fore, mass = 1, inertia = [1, 0, 0, 1, 0, -3] },
    }
}

articulated::robot! {
    pub mod no_table {
        urdf = "urdf/three.urdf",
        append = "urdf/gripper.urdf",
        lock = elbow,
        frames = tool,
        payload = { "link" = tool },
    }
}

fn main() {}
