//! A scene in a file, and effects in the invocation.
#![deny(warnings)]

articulated::robot! {
    mod with_scene { scene = "scenes/three.toml" }
}

articulated::robot! {
    mod with_effects {
        urdf = "urdf/three.urdf",
        functions = [effect_forces, forward_dynamics],
        effects = { damping = { "*" = 0.5, wrist = off }, spring = { elbow = { stiffness = 2.0, rest = -0.25 } } },
    }
}

fn main() {
    assert_eq!(with_scene::NV, 3 + 4);
    let forces = with_effects::effect_forces(&[0.0; 3], &[1.0, 2.0, 3.0]);
    assert_eq!(forces, [-0.5, -1.5, 0.0]);
}
