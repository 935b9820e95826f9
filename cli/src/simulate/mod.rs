//! `articulated simulate`.

pub(crate) mod arguments;
#[cfg_attr(not(feature = "measure"), path = "uncompiled.rs")]
mod compiled;
mod constrained;
mod files;
pub mod in_process;
mod label;
pub(crate) mod look_over;
mod mcap;
mod method;
mod monitor;
pub(crate) mod motion;
mod of_file;
mod page;
mod plot;
mod recording;
mod settings;
mod size;
pub mod still;
mod summary;
mod table;
mod text;

use articulated::simulate::Settings;
use articulated_formats::world::Touching;
use articulated_lab::session::{Generic, Session};
use articulated_motion::InitialState;
use serde::Serialize;

use crate::arguments::Format;
use crate::console::{self, Progress};
use crate::failure::{Failure, INPUT, OK, OUT_OF_TOLERANCE};
use crate::robot::has_room;
use crate::{named_scene, output, robot_scene};
use arguments::SimulateArguments;
use compiled::Compiler;
use files::Files;
use motion::Motion;
use of_file::OfFile;
use size::Size;
use summary::Summary;

/// Output of `--print-scene` as JSON.
#[derive(Serialize)]
struct PrintedScene<'a> {
    /// The scene, as TOML.
    scene: &'a str,
}

/// Simulates and writes.
pub(crate) fn run(arguments: &SimulateArguments, format: Format) -> Result<u8, Failure> {
    let Some(scene) = &arguments.scene else { return compiled::all(arguments, format) };
    if arguments.print_scene {
        if !named_scene::is_robot(scene) {
            return Err(Failure::input([format!(
                "{}: --print-scene: found no file of a robot, expected a URDF, xacro, MJCF or SDF",
                scene.display()
            )]));
        }
        let text = match arguments.smooth {
            true => robot_scene::text(scene, &arguments.leave_out)?,
            false => robot_scene::printed(scene, &arguments.leave_out)?,
        };
        console::report(format, || text.clone(), || crate::json(&PrintedScene { scene: &text }))?;
        return Ok(OK);
    }
    let of_file = match (arguments.smooth, arguments.constraints) {
        (true, _) => Some((false, "--smooth")),
        (_, true) => Some((true, "--constraints")),
        _ => None,
    };
    if let Some((_, option)) = of_file.filter(|_| !named_scene::is_robot(scene)) {
        let expected = "a URDF, xacro, MJCF or SDF: a scene has its own integrator";
        return Err(Failure::usage(format!("{}: {option}: found no file of a robot, expected {expected}", scene.display())));
    }
    let session = named_scene::session_without(scene, &arguments.leave_out)?;
    let law = session.scene.law();
    if let (Some(_), Some(option)) = (law, beside_law(arguments)) {
        let expected = "no such option: its steps are those of the robot's file";
        return Err(Failure::usage(format!("{}: {option}: found simulation.law in the scene, expected {expected}", scene.display())));
    }
    let of_file = match of_file {
        _ if law.is_some() => None,
        Some((constraints, _)) => Some(constraints),
        None => (named_scene::is_robot(scene) && is_of_file(arguments, &session)).then_some(true),
    };
    if of_file == Some(true) && !arguments.constraints {
        let file = &session.scene.file;
        console::note(&format!("{file}: with limits, dry friction, equations and contacts; `--smooth` is the motion without them"));
    }
    if let (None, Some(name)) = (of_file, &arguments.keyframe) {
        let expected = "--smooth, or an MJCF with constraints and no --integrator; a scene has its own `keyframe`";
        return Err(Failure::usage(format!("{}: --keyframe {name}: found no motion of a file, expected {expected}", scene.display())));
    }
    if named_scene::is_robot(scene) && of_file != Some(true) {
        robot_scene::note(scene)?.iter().for_each(|line| console::note(line));
    }
    has_room(&session.scene.file, session.model.nv())?;
    let settings = settings::of(&session, arguments);
    // The start of a file is not that of its scene.
    let initial = if of_file.is_some() { session.initial_state().map_err(Failure::from) } else { session.start().map_err(Failure::from) };
    let (mut settings, initial) = Failure::both(settings, initial)?;
    if let Some(file) = &arguments.against {
        return compiled::against(&session, &initial, &settings, file, format);
    }
    motion::solvable(&session)?;
    let keyframe = arguments.keyframe.as_deref();
    let of_file = match (law, of_file) {
        (Some(_), _) => Some(OfFile::of_scene(&session, &initial, &mut settings)?),
        (None, Some(constraints)) => Some(OfFile::of(&session, constraints, keyframe, arguments.step, &mut settings)?),
        (None, None) => None,
    };
    let compiler = arguments.generated.then(Compiler::find).transpose()?;
    let size = Size::look_ahead(session.model.shape(), &mut settings, arguments)?;
    let files = arguments.output.as_deref().map(|path| Files::at(path, &arguments.package, &settings, files::OPTIONS)).transpose()?;
    arguments.mcap.as_deref().map_or(Ok(()), |path| output::file("--mcap", path))?;
    let progress = Progress::of_whole(format!("{}: motion", session.name));
    let (mut motion, code) = match (&compiler, &of_file) {
        (_, Some(of_file)) => (of_file.run(&session, &settings, &progress, &mut || true)?, "generic"),
        (Some(compiler), None) => (compiler.run(&session, &initial, &settings, &progress)?, "generated"),
        (None, None) => (by_generic_code(&session, &initial, &settings, &progress)?, "generic"),
    };
    if let (Some(error), Some(full)) = (&mut motion.error, size.and_then(|size| size.ended(motion.recording.len()))) {
        *error += &format!("; {full}");
    }
    let mut summary = Summary::new(&session, &motion, &settings, code);
    if let Some(files) = &files {
        progress.doing(format!("{}: files", session.name));
        files.write(&session, &motion, &mut summary)?;
    }
    if let Some(path) = &arguments.mcap {
        files::write_mcap(&session, &motion, &mut summary, path, size::allowed(arguments))?;
    }
    drop(progress);
    console::report(format, || text::text(&summary), || crate::json(&summary))?;
    if let Some(warning) = summary.out_of_balance() {
        console::warn(&format!("{}: {warning}", session.scene.file));
    }
    Ok(match &motion.error {
        None if summary.status == "ok" => OK,
        None => OUT_OF_TOLERANCE,
        Some(error) => {
            console::error(&format!("{}: {error}", session.scene.file));
            INPUT
        }
    })
}

/// Whether a file without `--smooth` and `--constraints` moves with its constraints: it has some,
/// and no option asks for an integrator of a scene.
fn is_of_file(arguments: &SimulateArguments, session: &Session) -> bool {
    let SimulateArguments { integrator, rtol, atol, generated, against, .. } = arguments;
    let is_asked = integrator.is_none() && rtol.is_none() && atol.is_none() && !generated && against.is_none();
    is_asked && session.world.touching.as_ref().is_some_and(Touching::has_some)
}

/// The first option that says something else than a scene with a law.
fn beside_law(arguments: &SimulateArguments) -> Option<&'static str> {
    let SimulateArguments { integrator, rtol, atol, generated, against, .. } = arguments;
    let given = [
        (integrator.is_some(), "--integrator"),
        (rtol.is_some(), "--rtol"),
        (atol.is_some(), "--atol"),
        (*generated, "--generated"),
        (against.is_some(), "--against"),
    ];
    given.into_iter().find_map(|(is_given, option)| is_given.then_some(option))
}

fn by_generic_code(session: &Session, initial: &InitialState, settings: &Settings, progress: &Progress) -> Result<Motion, Failure> {
    if cfg!(debug_assertions) {
        console::warn("this command was built without optimisation: its speed means little");
    }
    motion::run(session, initial, &Generic, settings, progress, &mut || true)
}
