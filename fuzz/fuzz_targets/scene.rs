//! Any bytes are a scene or a list of mistakes, and a scene has its robot, or says what is wrong.
#![no_main]

use std::path::Path;

use articulated_core::description::Base;
use articulated_scene::{Bundled, Scene, open_in};
use libfuzzer_sys::fuzz_target;

const ARM: Bundled<'static> = Bundled { name: "ur5_like", document: include_str!("../../models/urdf/ur5_like.urdf"), base: Base::Fixed };

fuzz_target!(|bytes: &[u8]| {
    let scene = match Scene::read_bytes("scene.toml", bytes) {
        Ok(scene) => scene,
        Err(errors) => return assert!(!errors.errors.is_empty() && !errors.to_string().is_empty()),
    };
    // Files that a scene names are nowhere.
    if let Err(error) = open_in(scene, Path::new("nowhere"), &[ARM]).and_then(|opened| opened.build()) {
        assert!(!error.to_string().is_empty());
    }
});
