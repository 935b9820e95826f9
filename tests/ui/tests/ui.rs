//! Inputs that the macro `robot!` accepts, and its messages for others.
//!
//! The expected messages are in `fail/*.stderr`;
//! `TRYBUILD=overwrite cargo test -p articulated-tests-ui` writes them anew.

use std::fs;
use std::path::Path;

#[test]
fn every_mistake_is_named_at_its_word() {
    copy_robots();
    let cases = trybuild::TestCases::new();
    cases.pass("pass/*.rs");
    cases.compile_fail("fail/*.rs");
}

/// The cases are compiled as a package of their own below the target folder, and paths in `robot!`
/// start at the package's folder.
fn copy_robots() {
    let target = Path::new(env!("CARGO_TARGET_TMPDIR")).parent().unwrap();
    let package = target.join("tests/trybuild").join(env!("CARGO_PKG_NAME"));
    for folder in ["urdf", "scenes"] {
        fs::create_dir_all(package.join(folder)).unwrap();
        for entry in fs::read_dir(folder).unwrap() {
            let file = entry.unwrap();
            fs::copy(file.path(), package.join(folder).join(file.file_name())).unwrap();
        }
    }
}
