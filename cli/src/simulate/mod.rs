//! `articulated simulate`.

mod all;
pub(crate) mod arguments;
mod label;
mod monitor;
pub(crate) mod motion;
mod page;
mod plot;
mod recording;
mod settings;
mod size;
mod summary;
mod table;
mod text;

use std::path::Path;

use articulated::simulate::{Output, Settings};
use articulated_core::effect::EffectId;
use articulated_lab::against;
use articulated_lab::compiled::Rustc;
use articulated_lab::session::{Code, Session};
use articulated_lab::straight::Straight;
use articulated_motion::{InitialState, field};

use crate::arguments::Format;
use crate::console::{self, Progress};
use crate::failure::{Failure, INPUT, OK, OUT_OF_TOLERANCE};
use crate::robot::has_room;
use crate::{named_scene, output};
use arguments::SimulateArguments;
use motion::Motion;
use page::Setting;
use size::Size;
use summary::{Summary, Unit};

/// Simulates and writes.
pub(crate) fn run(arguments: &SimulateArguments, format: Format) -> Result<u8, Failure> {
    let Some(scene) = &arguments.scene else { return all::run(arguments, format) };
    let session = named_scene::session(scene)?;
    has_room(&session.scene.file, session.model.nv())?;
    let settings = settings::of(&session, arguments);
    let (mut settings, initial) = Failure::both(settings, session.start().map_err(Failure::from))?;
    if let Some(file) = &arguments.against {
        let report = against::measure(&session, &initial, &settings, file)?;
        console::print(&match format {
            Format::Text => report.text(),
            Format::Json => crate::json(&report),
        })?;
        return Ok(OK);
    }
    motion::solvable(&session)?;
    let size = Size::look_ahead(session.model.shape(), &mut settings, arguments)?;
    arguments.output.as_deref().map_or(Ok(()), folder)?;
    let progress = Progress::of_whole(format!("{}: motion", session.name));
    let (mut motion, code) = match arguments.generated {
        true => (by_generated_code(&session, &initial, &settings, &progress)?, "generated"),
        false => (by_generic_code(&session, &initial, &settings, &progress)?, "generic"),
    };
    if let (Some(error), Some(full)) = (&mut motion.error, size.and_then(|size| size.ended(motion.recording.len()))) {
        *error += &format!("; {full}");
    }
    let mut summary = Summary::new(&session, &motion, &settings, code);
    if let Some(folder) = &arguments.output {
        progress.doing(format!("{}: files", session.name));
        write(&session, &motion, &mut summary, (folder, settings.output == Output::Ends))?;
    }
    drop(progress);
    console::print(&match format {
        Format::Text => text::text(&summary),
        Format::Json => crate::json(&summary),
    })?;
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

/// The folder of `--output`, made if it is not there. Errors: the name of a Parquet file.
fn folder(path: &Path) -> Result<(), Failure> {
    if path.extension().is_none_or(|e| !e.eq_ignore_ascii_case("parquet")) {
        return output::folder("--output", path);
    }
    Err(Failure::usage(format!(
        "--output {}: found the name of a Parquet file, expected a folder: recording.csv is written into it, and pandas or polars make Parquet of that",
        path.display()
    )))
}

fn by_generated_code(session: &Session, initial: &InitialState, settings: &Settings, progress: &Progress) -> Result<Motion, Failure> {
    let (generated, frames) = session.generate(settings.integrator)?;
    progress.doing(format!("{}: rustc", session.name));
    let rustc = Rustc::find().map_err(|e| Failure::tool(&e))?;
    let robot = Straight::build(&rustc, &generated).map_err(|e| Failure::tool(&e))?;
    progress.doing(format!("{}: motion", session.name));
    motion::run(session, initial, Code::Generated(&robot, &frames), settings, progress)
}

fn by_generic_code(session: &Session, initial: &InitialState, settings: &Settings, progress: &Progress) -> Result<Motion, Failure> {
    if cfg!(debug_assertions) {
        console::warn("this command was built without optimisation: its speed means little");
    }
    motion::run(session, initial, Code::Generic, settings, progress)
}

/// All files of a motion, of its ends alone without what draws it; their names go into the summary,
/// which is the last of them.
fn write(session: &Session, motion: &Motion, summary: &mut Summary, (folder, ends): (&Path, bool)) -> Result<(), Failure> {
    let recording = &motion.recording;
    let drawn = if ends { None } else { Some(Drawn::of(session, motion, summary)?) };
    let pictures = drawn.as_ref().map_or(&[][..], |drawn| &drawn.pictures);
    summary.pictures_left_out = plot::PICTURES.into_iter().filter(|name| pictures.iter().all(|p| p.name != *name)).collect();
    summary.page_left_out = ends;
    clear(folder, &summary.pictures_left_out, ends)?;
    let mut save = |name: &str, bytes: &[u8]| {
        summary.files.push(name.to_owned());
        output::write(&folder.join(name), bytes)
    };
    let columns = table::columns(recording);
    summary.columns = columns.iter().map(|c| Unit { column: c.title.clone(), unit: c.unit.clone() }).collect();
    save("recording.csv", table::csv(&columns).as_bytes())?;
    for picture in pictures {
        save(&format!("{}.svg", picture.name), picture.svg.as_bytes())?;
    }
    if let Some(drawn) = &drawn {
        save(PAGE, drawn.page.as_bytes())?;
        save(ANIMATION, drawn.animation.as_bytes())?;
    }
    summary.files.push("summary.json".to_owned());
    output::write(&folder.join("summary.json"), crate::json(summary))
}

const PAGE: &str = "motion.html";
const ANIMATION: &str = "motion.svg";

/// What draws a motion.
struct Drawn {
    page: String,
    animation: String,
    pictures: Vec<plot::Picture>,
}

impl Drawn {
    fn of(session: &Session, motion: &Motion, summary: &Summary) -> Result<Self, Failure> {
        let setting = setting(session, summary);
        let page = page::html(&motion.recording, &setting).map_err(|e| Failure::tool(&e))?;
        let animation = page::svg(&motion.recording, &setting).map_err(|e| Failure::tool(&e))?;
        let pictures = plot::pictures(&motion.recording, &session.name);
        Ok(Self { page, animation, pictures })
    }
}

/// Removes pictures of an earlier motion, and its page and animation.
fn clear(folder: &Path, pictures: &[&str], page: bool) -> Result<(), Failure> {
    let pictures = pictures.iter().map(|name| format!("{name}.svg"));
    for path in pictures.chain([PAGE, ANIMATION].into_iter().filter(|_| page).map(str::to_owned)).map(|name| folder.join(name)) {
        match std::fs::remove_file(&path) {
            Err(e) if e.kind() != std::io::ErrorKind::NotFound => return Err(Failure::input([format!("{}: {e}", path.display())])),
            _ => {}
        }
    }
    Ok(())
}

/// What the page shows of a scene.
fn setting<'a>(session: &'a Session, summary: &Summary) -> Setting<'a> {
    let contacts = || session.effects_of(EffectId::contact);
    let ball = |a: &articulated_core::effect::Applied| (a.on.clone(), a.at.xyz, field(a, "radius").first().copied().unwrap_or(0.0));
    let plane = |a: &articulated_core::effect::Applied| {
        let normal: [f64; 3] = field(a, "normal").try_into().ok()?;
        Some((normal, *field(a, "height").first()?))
    };
    Setting {
        title: &session.name,
        note: format!("{}, {} base; {}", summary.robot, summary.base, summary.integrator.name),
        description: &session.description,
        model: &session.model,
        base: session.base(),
        balls: contacts().map(ball).collect(),
        ground: contacts().next().and_then(plane),
    }
}
