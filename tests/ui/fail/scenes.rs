//! Errors of scenes, at the scene; errors of effects, at their words.

articulated::robot! {
    mod wrong { scene = "scenes/wrong.toml" }
}

articulated::robot! {
    mod not_there { scene = "scenes/there_is_none.toml" }
}

articulated::robot! {
    mod bundled { scene = "scenes/other.toml" }
}

articulated::robot! {
    mod other { scene = "scenes/other.toml", urdf = "urdf/three.urdf" }
}

articulated::robot! {
    mod words {
        urdf = "urdf/three.urdf",
        effects = {
            damping = { elbow = -1.0 },
            frction = { elbow = 1.0 },
            limit = { elbow = { lower = 1.0, upper = 1.0, stiffness = 1e4 } },
        },
    }
}

articulated::robot! {
    mod names {
        urdf = "urdf/three.urdf",
        effects = { damping = { wirst = 1.0 }, drag = { base = 1.0 } },
        functions = [no_function],
    }
}

fn main() {}
