//! Robots and states for tests.

use articulated_core::algorithm::{Argument, Function, Workspace, random_configuration};
use articulated_core::model::Model;

/// A robot that comes with the project, with the base that it is meant for.
pub(crate) fn bundled(name: &str) -> Model<f64> {
    let robot = articulated_models::robot(name).expect("a bundled robot");
    let reading = articulated_formats::read(robot.urdf.as_bytes(), &articulated_formats::Options::default()).expect("its URDF");
    Model::new(&reading.description, robot.base).expect("a model")
}

/// Arguments of a function, different for each number: configurations as the table draws them, all
/// others in ±2.
pub(crate) fn arguments(model: &Model<f64>, row: &Function<f64>, number: u64) -> Vec<Vec<f64>> {
    let mut state = number;
    // Knuth's constants, as musl and newlib have them.
    let mut unit = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    let one = |argument: &Argument| {
        let mut numbers: Vec<f64> = (0..argument.len(model.shape())).map(|_| unit()).collect();
        if argument.is_configuration() {
            let uniform = numbers;
            numbers = vec![0.0; model.nq()];
            random_configuration(model, &mut Workspace::new(model), &uniform[..Argument::Uniform.len(model.shape())], &mut numbers);
        } else if *argument != Argument::Uniform {
            numbers.iter_mut().for_each(|x| *x = 4.0 * *x - 2.0);
        }
        numbers
    };
    row.takes.iter().map(one).collect()
}
