//! Any bytes are a scene or a list of mistakes.
#![no_main]

use articulated_scene::Scene;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    if let Err(errors) = Scene::read_bytes("scene.toml", bytes) {
        assert!(!errors.errors.is_empty() && !errors.to_string().is_empty());
    }
});
