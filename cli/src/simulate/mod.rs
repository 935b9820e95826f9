//! `articulated simulate`.

pub(crate) mod against;
mod all;
pub(crate) mod arguments;
mod columns;
mod csv;
pub(crate) mod motion;
mod page;
mod parquet;
pub(crate) mod plot;
mod recording;
mod settings;
pub(crate) mod stage;
mod straight;
mod summary;
mod text;
mod watch;

use std::path::Path;

use articulated::simulate::Settings;
use articulated_core::effect::EffectId;
use articulated_motion::{Begin, field};

use crate::arguments::Format;
use crate::compiled::Rustc;
use crate::console::{self, Progress};
use crate::failure::{Failure, INPUT, OK, OUT_OF_TOLERANCE};
use crate::output;
use crate::robot::has_room;
use arguments::SimulateArguments;
use motion::Motion;
use page::Setting;
use stage::Stage;
use straight::Straight;
use summary::Summary;

/// Simulates and writes.
pub(crate) fn run(arguments: &SimulateArguments, format: Format) -> Result<u8, Failure> {
    let Some(scene) = &arguments.scene else { return all::run(arguments, format).map(|()| OK) };
    let stage = Stage::find(scene)?;
    has_room(&stage.scene.file, stage.model.nv)?;
    let settings = settings::of(&stage, arguments);
    let (settings, begin) = Failure::both(settings, motion::begin(&stage))?;
    if let Some(file) = &arguments.against {
        return against::run(&stage, &begin, &settings, file, format).map(|()| OK);
    }
    motion::solvable(&stage)?;
    arguments.output.as_deref().map_or(Ok(()), |folder| output::folder("--output", folder))?;
    let progress = Progress::of_whole(format!("{}: motion", stage.name));
    let (motion, code) = match arguments.generated {
        true => (by_generated_code(&stage, &begin, &settings, &progress)?, "generated"),
        false => (by_generic_code(&stage, &begin, &settings, &progress)?, "generic"),
    };
    let mut summary = Summary::new(&stage, &motion, &settings, code);
    if let Some(folder) = &arguments.output {
        progress.doing(format!("{}: files", stage.name));
        write(&stage, &motion, &mut summary, folder)?;
    }
    drop(progress);
    console::print(&match format {
        Format::Text => text::text(&summary),
        Format::Json => crate::json(&summary),
    })?;
    if let Some(odd) = summary.out_of_balance() {
        console::warn(&format!("{}: {odd}", stage.scene.file));
    }
    Ok(match &motion.error {
        None if summary.status == "ok" => OK,
        None => OUT_OF_TOLERANCE,
        Some(error) => {
            console::error(&format!("{}: {error}", stage.scene.file));
            INPUT
        }
    })
}

fn by_generated_code(stage: &Stage, begin: &Begin, settings: &Settings, progress: &Progress) -> Result<Motion, Failure> {
    let (generated, frames) = motion::generate(stage, settings.integrator)?;
    progress.doing(format!("{}: rustc", stage.name));
    let rustc = Rustc::find().map_err(|e| Failure::tool(&e))?;
    let robot = Straight::build(&rustc, &generated).map_err(|e| Failure::tool(&e))?;
    progress.doing(format!("{}: motion", stage.name));
    motion::run(stage, begin, (&robot, &frames), settings, progress)
}

fn by_generic_code(stage: &Stage, begin: &Begin, settings: &Settings, progress: &Progress) -> Result<Motion, Failure> {
    if cfg!(debug_assertions) {
        console::warn("this command was built without optimisation: its speed means little");
    }
    motion::run(stage, begin, (&stage.model, &stage.frame_names()), settings, progress)
}

/// All files of a motion; their names go into the summary, which is the last of them.
fn write(stage: &Stage, motion: &Motion, summary: &mut Summary, folder: &Path) -> Result<(), Failure> {
    let recording = &motion.recording;
    let page = page::html(recording, &setting(stage, summary)).map_err(|e| Failure::tool(&e))?;
    let pictures = plot::pictures(recording, &stage.name).map_err(|e| Failure::tool(&e))?;
    summary.pictures_left_out = plot::PICTURES.into_iter().filter(|name| pictures.iter().all(|p| p.name != *name)).collect();
    clear(folder, &summary.pictures_left_out)?;
    let mut save = |name: &str, bytes: &[u8]| {
        summary.files.push(name.to_owned());
        output::write(&folder.join(name), bytes)
    };
    let columns = columns::columns(recording);
    let csv = csv::text(&columns).map_err(|e| Failure::tool(&e))?;
    save("recording.csv", csv.as_bytes())?;
    save("recording.parquet", &parquet::bytes(&columns))?;
    for picture in &pictures {
        save(&format!("{}.svg", picture.name), picture.svg.as_bytes())?;
        save(&format!("{}.png", picture.name), &picture.png)?;
    }
    save("motion.html", page.as_bytes())?;
    summary.files.push("summary.json".to_owned());
    output::write(&folder.join("summary.json"), crate::json(summary))
}

/// Removes pictures that are of an earlier motion.
fn clear(folder: &Path, pictures: &[&str]) -> Result<(), Failure> {
    for path in pictures.iter().flat_map(|name| ["svg", "png"].map(|ending| folder.join(format!("{name}.{ending}")))) {
        match std::fs::remove_file(&path) {
            Err(e) if e.kind() != std::io::ErrorKind::NotFound => return Err(Failure::input([format!("{}: {e}", path.display())])),
            _ => {}
        }
    }
    Ok(())
}

/// What the page shows of a scene.
fn setting<'a>(stage: &'a Stage, summary: &Summary) -> Setting<'a> {
    let contacts = || stage.effects_of(EffectId::contact);
    let ball = |a: &articulated_core::effect::Applied| (a.on.clone(), a.at.xyz, field(a, "radius").first().copied().unwrap_or(0.0));
    let plane = |a: &articulated_core::effect::Applied| {
        let normal: [f64; 3] = field(a, "normal").try_into().ok()?;
        Some((normal, *field(a, "height").first()?))
    };
    Setting {
        title: &stage.name,
        note: format!("{}, {} base; {}", summary.robot, summary.base, summary.integrator.name),
        description: &stage.description,
        model: &stage.model,
        base: stage.base(),
        balls: contacts().map(ball).collect(),
        ground: contacts().next().and_then(plane),
    }
}
