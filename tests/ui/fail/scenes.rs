//! What is wrong with scenes, at the scene; what is wrong with effects, at their words.

articulated::robot! {
    mod wrong { scene = "ui/scenes/wrong.toml" }
}

articulated::robot! {
    mod not_there { scene = "ui/scenes/there_is_none.toml" }
}

articulated::robot! {
    mod bundled { scene = "ui/scenes/other.toml" }
}

articulated::robot! {
    mod other { scene = "ui/scenes/other.toml", urdf = "ui/urdf/three.urdf" }
}

articulated::robot! {
    mod words {
        urdf = "ui/urdf/three.urdf",
        effects = {
            damping = { elbow = -1.0 },
            frction = { elbow = 1.0 },
            limit = { elbow = { lower = 1.0, upper = 1.0, stiffness = 1e4 } },
        },
    }
}

articulated::robot! {
    mod names {
        urdf = "ui/urdf/three.urdf",
        effects = { damping = { wirst = 1.0 }, drag = { base = 1.0 } },
        functions = [no_function],
    }
}

fn main() {}
