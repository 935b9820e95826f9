//! The commands that measure. Without the feature `measure`, `unmeasured.rs` is in place of this.

mod accuracy;
mod chart;
mod compare;
mod scaling;
mod stress;

use clap::Subcommand;

use crate::arguments::{Format, examples};
use crate::failure::{Failure, OK};
use accuracy::AccuracyArguments;
use compare::CompareArguments;
use scaling::ScalingArguments;
use stress::StressArguments;

#[derive(Debug, Subcommand)]
pub(crate) enum Measurement {
    /// Measures generated code against generic code: operations, size, time, error
    #[command(after_help = examples(&[
        "articulated compare panda_like",
        "articulated compare humanoid --functions inverse_dynamics --repetitions 101",
        "articulated compare ur5_like --functions kinematics,derivatives --frames flange",
        "articulated compare panda_like --functions inverse_dynamics --batch f64,f32",
        "articulated compare arm.urdf --peer libpeer.so --format json",
        "articulated compare quadruped --peers-manifest target/peers/peers.json --chart quadruped.svg",
    ]))]
    Compare(CompareArguments),
    /// Measures what accuracy costs: error and time of each function at each level, and the
    /// cheapest that is accurate enough
    #[command(after_help = examples(&[
        "articulated accuracy panda_like",
        "articulated accuracy arm.urdf --functions inverse_dynamics,mass_matrix --levels f32,f64,double_double --output accuracy",
        "articulated accuracy panda_like --functions forward_dynamics --advise --error 1e-9",
        "articulated accuracy --simulate pendulum --output integrators",
        "articulated accuracy ur5_like --peers-manifest target/peers/peers.json --output accuracy",
    ]))]
    Accuracy(AccuracyArguments),
    /// Measures how costs grow with the robot: chains of 7 to 125 joints (--all: to 1000),
    /// generated against generic code, hot and cold caches
    #[command(after_help = examples(&[
        "articulated scaling",
        "articulated scaling --joints 7,30,100 --functions inverse_dynamics --chart scaling.svg",
        "articulated scaling --all --markdown --chart docs/scaling.svg > docs/scaling.md",
    ]))]
    Scaling(ScalingArguments),
    /// Measures hard cases: a corpus and the bundled robots, or a robot of yours; each with a limit
    /// that it has to keep
    #[command(after_help = examples(&[
        "articulated stress",
        "articulated stress --chapters chains,screws --rows",
        "articulated stress arm.urdf --states states.json",
        "articulated stress arm.urdf --generated --format json",
    ]))]
    Stress(StressArguments),
}

/// Measures and prints.
pub(crate) fn run(command: &Measurement, format: Format) -> Result<u8, Failure> {
    match command {
        Measurement::Compare(a) => compare::run(a, format),
        Measurement::Accuracy(a) => accuracy::run(a, format).map(|()| OK),
        Measurement::Scaling(a) => scaling::run(a, format).map(|()| OK),
        Measurement::Stress(a) => stress::run(a, format),
    }
}
