//! τ = Y π, T = yᵀπ and U = yᵀπ on bundled robots and on the files that oracles read, with π of the
//! inertial data of the file.

use std::path::{Path, PathBuf};

use articulated_core::description::Base;
use articulated_formats::{Disk, Options, read_with};
use articulated_test_support::case::{Case, for_each_bundled};
use articulated_test_support::random::Random;
use articulated_test_support::regressors::broken_laws;

/// The law in some states, whatever effects have numbers in the file: the model has none.
fn check(case: &Case, random: &mut Random) {
    for _ in 0..3 {
        let broken = broken_laws(&case.description, &case.model, &case.state(random));
        assert!(broken.is_empty(), "{}: {}", case.name, broken.join("\n"));
    }
}

#[test]
fn regressors_of_bundled_robots_times_the_parameters_of_their_links_are_torques_and_energies() {
    for_each_bundled(check);
}

/// Robots of `tests/mjcf/models` and `tests/sdf/models`: several joints on a body, joints away from
/// the origin of their body.
#[test]
fn regressors_of_robots_of_other_formats_times_the_parameters_of_their_links_are_torques_and_energies() {
    let tests = Path::new(env!("CARGO_MANIFEST_DIR"));
    let (mut files, mut beside) = (0, 0);
    for folder in ["mjcf/models", "sdf/models"] {
        let entries = std::fs::read_dir(tests.join(folder)).unwrap();
        let mut paths: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).filter(|path| path.is_file()).collect();
        paths.sort();
        for path in paths {
            let options = Options { file: path.display().to_string(), ..Options::default() };
            let description = read_with(&Disk, &std::fs::read(&path).unwrap(), &options).unwrap().description;
            let case = Case::new(options.file, description, Base::Fixed);
            check(&case, &mut Random::new(1));
            files += 1;
            let links = case.model.links().filter_map(|i| case.model.bodies()[i].link.as_ref());
            beside += links.filter(|link| link.placement.position.norm() > 0.0).count();
        }
    }
    assert!(files >= 7 && beside > 0, "{files} files, {beside} links beside their joints");
}
