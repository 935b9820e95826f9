//! The command line.

use articulated_codegen::function_groups::Group;
use articulated_core::algorithm::{Function, function};
use articulated_core::step::of_group;
use clap::{Parser, Subcommand};

use crate::arguments::{CheckArguments, EvalArguments, Format, FunctionsArguments, GenerateArguments, examples};
use crate::effects::EffectsArguments;
use crate::failure::STATUSES;
use crate::measure::Measurement;
use crate::new::NewArguments;
use crate::rollout::RolloutArguments;
use crate::simulate::arguments::SimulateArguments;

/// Robot dynamics, spelled out: checks a robot file (URDF, xacro, MJCF or SDF), generates its
/// straight-line code, evaluates it, compares it, and simulates it.
#[derive(Debug, Parser)]
#[command(name = "articulated", version, after_help = overview())]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub(crate) command: Command,
    /// How to print results
    #[arg(long, global = true, value_enum, default_value_t = Format::Text)]
    pub(crate) format: Format,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Says all that is wrong with a robot, and what it is made of
    #[command(after_help = examples(&[
        "articulated check arm.urdf",
        "articulated check --floating walker.urdf",
        "articulated check arm.urdf --function inverse_dynamics",
        "articulated check arm.urdf --append gripper.urdf@tool:left_ --payload left_palm=0.5@0,0,0.1 --lock elbow=0.5",
        "articulated check panda_like --format json",
    ]))]
    Check(CheckArguments),
    /// Writes a robot's dynamics out as Rust or C
    #[command(after_help = examples(&[
        "articulated generate panda_like",
        "articulated generate arm.urdf --functions placements,inverse_dynamics -o src/arm.rs",
        "articulated generate arm.urdf --runtime ::articulated -o src/arm.rs",
        "articulated generate arm.urdf --functions inverse_dynamics,forward_dynamics --batch f64,f32 -o src/arm.rs",
        "articulated generate arm.urdf --functions 'hold = gravity_torque + jacobians_body, bias = inverse_dynamics(a = 0)'",
        "articulated generate arm.urdf --functions 'still=inverse_dynamics(v=0,a=0)' --parameters 'payload(tool)'",
        "articulated generate arm.urdf --functions 'pull = vjp(inverse_dynamics, q v), slope = gradient(potential_energy)'",
        "articulated generate arm.toml --functions motion --runtime ::articulated -o src/arm.rs",
        "articulated generate arm.urdf --level double_double -o src/arm_exact.rs",
        "articulated generate arm.urdf --language c -o arm.h",
        "articulated generate arm.urdf --language c --functions mass_matrix -o firmware/arm",
        "articulated generate arm.urdf --language c --abi casadi --functions inverse_dynamics,inverse_dynamics_derivatives -o arm",
        "articulated generate arm.urdf --frames tool,camera --lock wrist=0 --payload tool=1.2@0,0,0.1:1e-3,0,0,1e-3,0,1e-3",
        "articulated generate arm.urdf --append gripper.urdf@tool --append gripper.urdf@tool:second_:0,0,0.2,0,0,1.5",
    ]))]
    Generate(GenerateArguments),
    /// Writes a new crate: a robot, a controller, a simulation and a plot
    #[command(after_help = examples(&[
        "articulated new arm --file arm.urdf",
        "articulated new walker --file walker.urdf --floating --controller pd",
        "articulated new try --file panda_like",
    ]))]
    New(NewArguments),
    /// Evaluates functions on a file of states, by generic and by generated code
    #[command(after_help = examples(&[
        "articulated eval simple_pendulum --function inverse_dynamics --states states.json",
        "articulated eval simple_pendulum --function gravity_torque,placements --states states.csv --generic --format json",
        "",
        "states.json:  {\"states\": [{\"q\": [0.1], \"v\": {\"swing\": 0.2}, \"a\": [0], \"wrenches\": {\"bob\": [0, 0, 0, 0, 0, -5]}}]}",
        "states.csv:   q.swing,v.swing,a.swing",
        "              0.1,0.2,0",
        "",
        "Columns of a joint that has several numbers: q.hip[0],q.hip[1],…; a floating base is the joint __floating_base__",
    ]))]
    Eval(EvalArguments),
    #[command(flatten)]
    Measure(Measurement),
    /// Lists all functions, and what they cost on some robots, on the frames of their tips
    #[command(after_help = examples(&[
        "articulated functions",
        "articulated functions panda_like arm.urdf --format json",
        "articulated functions --markdown > docs/functions.md",
    ]))]
    Functions(FunctionsArguments),
    /// Simulates a scene: a table of the motion, pictures, a page that plays it, and what became of
    /// energy and momentum
    #[command(after_help = examples(&[
        "articulated simulate double_pendulum",
        "articulated simulate quadruped_drop -o drop              (then open drop/motion.html)",
        "articulated simulate arm.toml -o arm.html --package arm_description=../arm_description",
        "articulated simulate model.xml -o motion                 (an MJCF: its smooth motion)",
        "articulated simulate model.xml --print-scene > arm.toml  (a scene to begin with)",
        "articulated simulate arm.toml --mcap arm.mcap            (for Foxglove)",
        "articulated simulate arm.toml -o arm --end 5 --integrator dop853 --rtol 1e-10",
        "articulated simulate arm.toml --generated --format json",
        "articulated simulate --all",
        "articulated simulate chain --against target/peers/peers.json",
    ]))]
    Simulate(SimulateArguments),
    /// Steps many states many times by the library, and prints their time, a hash, and with
    /// --format json where they end
    #[command(after_help = examples(&[
        "articulated rollout quadruped --steps 1000 --states 64",
        "articulated rollout arm.toml --steps 500 --states states.json --method rk4 --format json",
        "articulated rollout model.xml --steps 10000 --hash",
    ]))]
    Rollout(RolloutArguments),
    /// Says which effects of a scene are on and off, what of the robot's file is not used, and what
    /// each effect costs
    #[command(after_help = examples(&[
        "articulated effects golf_swing",
        "articulated effects arm.toml --time",
        "articulated effects arm.toml --functions forward_dynamics,mass_matrix --format json",
    ]))]
    Effects(EffectsArguments),
}

fn overview() -> String {
    let robots: String =
        articulated_models::ROBOTS.iter().chain(articulated_models::MJCF).map(|r| format!("  {:18} {}\n", r.name, r.summary)).collect();
    let group = |g: Group| format!("  {}: {}\n", g.name(), g.title());
    let one = |name: &'static str| function::<f64>(name).map(|f| format!("    {name:42} {}\n", f.summary)).unwrap_or_default();
    let functions: String = Group::ALL.into_iter().map(|g| group(g) + &g.functions().map(one).collect::<String>()).collect();
    let step = |f: &Function<f64>| format!("    {:42} {}\n", f.name, f.summary);
    let beside = Group::BESIDE.into_iter().map(|g| group(g) + &of_group(g).iter().map(step).collect::<String>());
    let functions = functions + &beside.collect::<String>();
    let scenes: String = articulated_models::SCENES
        .iter()
        .chain(articulated_models::LAW_SCENES)
        .map(|s| format!("  {:18} {}\n", s.name, s.summary()))
        .collect();
    let functions = format!("Functions, in groups whose names stand for all of them:\n{functions}");
    format!("Bundled robots:\n{robots}\nBundled scenes:\n{scenes}\n{functions}\n{STATUSES}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_line_is_well_formed() {
        use clap::CommandFactory;
        Arguments::command().debug_assert();
    }
}
