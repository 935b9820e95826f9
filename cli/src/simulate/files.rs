//! Output of `articulated simulate`: a folder with every file of a motion, or its page alone.

use std::path::Path;

use articulated::simulate::{Output, Settings};
use articulated_core::diagnostic::summary as lines;
use articulated_core::dynamics::Dynamics;
use articulated_core::effect::{EffectId, unit};
use articulated_lab::session::Session;
use articulated_motion::field;
use articulated_scene::When;

use super::motion::Motion;
use super::page::{self, Meshes, Projectile, Setting};
use super::recording::Recording;
use super::summary::{Summary, Unit};
use super::{mcap, plot, table};
use crate::arguments::Package;
use crate::failure::Failure;
use crate::{console, output};

/// Destination of the motion.
pub(super) struct Files<'a> {
    place: Place<'a>,
    /// Only the ends of the motion are recorded.
    ends: bool,
    packages: &'a [Package],
}

/// Names of the path and of the time between records in messages.
pub(super) const OPTIONS: [&str; 2] = ["--output", "--every"];
pub(super) const FIELDS: [&str; 2] = ["path", "every"];

enum Place<'a> {
    Folder(&'a Path),
    Page(&'a Path),
}

impl<'a> Files<'a> {
    /// The folder of `--output`, created if missing, or the page, if the name ends with `.html`.
    /// `names`: [`OPTIONS`] or [`FIELDS`]. Errors: the name of a Parquet file; a page of the
    /// motion's ends.
    pub(super) fn at(path: &'a Path, packages: &'a [Package], settings: &Settings, names: [&str; 2]) -> Result<Self, Failure> {
        let ends = settings.output == Output::Ends;
        let [output, every] = names;
        let named = |ending: &str| path.extension().is_some_and(|e| e.eq_ignore_ascii_case(ending));
        let refused =
            |found: &str, expected: &str| Err(Failure::usage(format!("{output} {}: found {found}, expected {expected}", path.display())));
        if named("parquet") {
            let expected = "a folder: recording.csv is written into it, and pandas or polars make Parquet of that";
            return refused("the name of a Parquet file", expected);
        }
        if !is_page(path) {
            output::folder(output, path)?;
            return Ok(Self { place: Place::Folder(path), ends, packages });
        }
        if ends {
            let expected = format!("a folder, as only the motion's ends are recorded; {every} SECONDS records it all");
            return refused("the name of a page", &expected);
        }
        output::file(output, path)?;
        Ok(Self { place: Place::Page(path), ends, packages })
    }

    /// Writes them; their names go into the summary.
    pub(super) fn write(&self, session: &Session, motion: &Motion, summary: &mut Summary) -> Result<(), Failure> {
        match self.place {
            Place::Folder(folder) => self.write_all(session, motion, summary, folder),
            Place::Page(path) => {
                let page = self.page(session, motion, summary)?;
                summary.files.push(path.display().to_string());
                output::write(path, page)
            }
        }
    }

    /// All files of a motion; without drawings if only its ends are recorded. Their names are added
    /// to the summary, which is written last.
    fn write_all(&self, session: &Session, motion: &Motion, summary: &mut Summary, folder: &Path) -> Result<(), Failure> {
        let recording = &motion.recording;
        let drawn = if self.ends { None } else { Some(self.drawn(session, motion, summary)?) };
        let pictures = drawn.as_ref().map_or(&[][..], |drawn| &drawn.pictures);
        summary.pictures_left_out = plot::PICTURES.into_iter().filter(|name| pictures.iter().all(|p| p.name != *name)).collect();
        summary.page_left_out = self.ends;
        clear(folder, &summary.pictures_left_out, self.ends)?;
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

    /// The page. A warning reports what is not drawn exactly.
    fn page(&self, session: &Session, motion: &Motion, summary: &mut Summary) -> Result<String, Failure> {
        // Packages of the command line come before those of the scene.
        let of_scene =
            session.request.options.robot.packages.iter().map(|(name, folder)| Package { name: name.clone(), folder: folder.clone() });
        let packages: Vec<Package> = self.packages.iter().cloned().chain(of_scene).collect();
        let meshes = Meshes::new(session.folders.clone(), &packages, &session.request.file);
        let setting = setting(session, &motion.recording, summary);
        let page = page::html(&motion.recording, &setting, &meshes).map_err(|e| Failure::tool(&e))?;
        // A line for each kind on the console, and all of them in the summary.
        let warnings = meshes.into_warnings().warnings;
        lines(warnings.iter()).iter().for_each(|line| console::warn(line));
        summary.warnings.extend(warnings.iter().map(ToString::to_string));
        Ok(page)
    }

    fn drawn(&self, session: &Session, motion: &Motion, summary: &mut Summary) -> Result<Drawn, Failure> {
        let page = self.page(session, motion, summary)?;
        let setting = setting(session, &motion.recording, summary);
        let animation = page::svg(&motion.recording, &setting).map_err(|e| Failure::tool(&e))?;
        let pictures = plot::pictures(&motion.recording, &session.name);
        Ok(Drawn { page, animation, pictures })
    }
}

/// Writes the MCAP file of a motion, of at most `most` MB.
pub(super) fn write_mcap(session: &Session, motion: &Motion, summary: &mut Summary, path: &Path, most: u64) -> Result<(), Failure> {
    let bytes = mcap::bytes(&motion.recording, &session.description, &session.model, session.base(), most as usize * 1_000_000);
    let Some(bytes) = bytes.map_err(|e| Failure::tool(&e))? else {
        let expected = "record less often (--every, or `output` in [simulation]), or allow more by --max-output-size";
        return Err(Failure::input([format!(
            "--mcap {}: found more than {most} MB, expected at most {most} MB: {expected}",
            path.display()
        )]));
    };
    summary.files.push(path.display().to_string());
    output::write(path, bytes)
}

/// Whether `--output` names a page instead of a folder.
pub(super) fn is_page(path: &Path) -> bool {
    path.extension().is_some_and(|e| e.eq_ignore_ascii_case("html")) && !path.is_dir()
}

const PAGE: &str = "motion.html";
const ANIMATION: &str = "motion.svg";

/// Drawings of a motion.
struct Drawn {
    page: String,
    animation: String,
    pictures: Vec<plot::Picture>,
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

/// Contents of the page besides the motion.
fn setting<'a>(session: &'a Session, recording: &Recording, summary: &Summary) -> Setting<'a> {
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
        projectile: projectile(session, recording),
        is_live: false,
    }
}

/// Density of a ball with a given mass only, kg/m³: that of a golf ball.
const DENSITY: f64 = 1130.0;

/// The ball of the scene: at rest or at the scene's speed until its event, free after it.
fn projectile(session: &Session, recording: &Recording) -> Option<Projectile> {
    let impact = session.scene.impact.as_ref()?;
    let normal = unit(impact.normal)?;
    let hit = recording.events.iter().find(|e| e.ball_speed_m_per_s.is_some());
    let place = match impact.when {
        When::Ball(place) => place,
        // Where the point is at the record that is next.
        When::Time(at) => {
            let (model, nq) = (session.model.clone().with_frames(&[&impact.link]).ok()?, recording.q_names.len());
            let record = recording.t.iter().position(|t| *t >= at)?;
            let mut row = [0.0; 12];
            model.placements(&mut Dynamics::workspace(&model), &recording.q[record * nq..][..nq], &mut row).ok()?;
            page::placement(&row).transform(impact.point.into()).into()
        }
    };
    let start = recording.t.first().copied().unwrap_or(0.0);
    Some(Projectile {
        place,
        radius: (3.0 * impact.mass / (4.0 * std::f64::consts::PI * DENSITY)).cbrt(),
        time: hit.map(|e| e.time - start),
        before: normal.map(|n| n * impact.ball_speed),
        after: normal.map(|n| n * hit.and_then(|e| e.ball_speed_m_per_s).unwrap_or(0.0)),
        gravity: session.model.gravity().into(),
    })
}
