//! Any bytes are a robot or a list of mistakes.
#![no_main]

use articulated_formats::{Options, read};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    for snap_angles in [None, Some(1e-3)] {
        match read(bytes, &Options { snap_angles, ..Options::default() }) {
            Ok(reading) => assert!(reading.description.root().is_some()),
            Err(problems) => assert!(!problems.errors.is_empty()),
        }
    }
});
