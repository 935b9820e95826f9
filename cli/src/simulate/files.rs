//! What `articulated simulate` writes: a folder with every file of a motion, or its page alone.

use std::path::Path;

use articulated::simulate::{Output, Settings};
use articulated_core::effect::EffectId;
use articulated_lab::session::Session;
use articulated_motion::field;

use super::motion::Motion;
use super::page::{self, Setting};
use super::summary::{Summary, Unit};
use super::{plot, table};
use crate::failure::Failure;
use crate::output;

/// Where the motion goes.
pub(super) struct Files<'a> {
    place: Place<'a>,
    /// Only the ends of the motion are recorded.
    ends: bool,
}

enum Place<'a> {
    Folder(&'a Path),
    Page(&'a Path),
}

impl<'a> Files<'a> {
    /// The folder of `--output`, made if it is not there, or the page, if the name ends with
    /// `.html`. Errors: the name of a Parquet file; a page of the motion's ends.
    pub(super) fn at(path: &'a Path, settings: &Settings) -> Result<Self, Failure> {
        let ends = settings.output == Output::Ends;
        let named = |ending: &str| path.extension().is_some_and(|e| e.eq_ignore_ascii_case(ending));
        let refused =
            |found: &str, expected: &str| Err(Failure::usage(format!("--output {}: found {found}, expected {expected}", path.display())));
        if named("parquet") {
            let expected = "a folder: recording.csv is written into it, and pandas or polars make Parquet of that";
            return refused("the name of a Parquet file", expected);
        }
        if !is_page(path) {
            output::folder("--output", path)?;
            return Ok(Self { place: Place::Folder(path), ends });
        }
        if ends {
            return refused("the name of a page", "a folder, as only the motion's ends are recorded; --every SECONDS records it all");
        }
        output::file("--output", path)?;
        Ok(Self { place: Place::Page(path), ends })
    }

    /// Writes them; their names go into the summary.
    pub(super) fn write(&self, session: &Session, motion: &Motion, summary: &mut Summary) -> Result<(), Failure> {
        match self.place {
            Place::Folder(folder) => write_all(session, motion, summary, (folder, self.ends)),
            Place::Page(path) => {
                let page = page::html(&motion.recording, &setting(session, summary)).map_err(|e| Failure::tool(&e))?;
                summary.files.push(path.display().to_string());
                output::write(path, page)
            }
        }
    }
}

/// Whether `--output` names a page instead of a folder.
pub(super) fn is_page(path: &Path) -> bool {
    path.extension().is_some_and(|e| e.eq_ignore_ascii_case("html")) && !path.is_dir()
}

/// All files of a motion, of its ends alone without what draws it; their names go into the summary,
/// which is the last of them.
fn write_all(session: &Session, motion: &Motion, summary: &mut Summary, (folder, ends): (&Path, bool)) -> Result<(), Failure> {
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
