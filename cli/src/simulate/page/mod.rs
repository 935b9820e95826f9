//! A motion as one page that plays it in three dimensions: the file contains all data, and loads
//! none.

mod animation;
mod clock;
mod collapse;
mod figure;
mod geometry;
mod mesh;
mod track;

use articulated_core::algorithm::FunctionError;
use articulated_core::description::{Base, Description};
use articulated_core::dynamics::Dynamics;
use articulated_core::effect::unit;
use articulated_core::model::Model;
use articulated_core::spatial::Placement;
use articulated_lab::plot::escaped;
use nalgebra::Vector3;
use serde::Serialize;

use super::recording::{EventRecord, Recording};
use animation::Room;
use figure::Figure;
pub(crate) use mesh::Meshes;
pub(crate) use track::placement;
use track::{Track, base64};

const PAGE: &str = include_str!("page.html");
const STYLE: &str = include_str!("page.css");
const PLAYER: &str = include_str!("player.js");

/// Contents of the page besides the motion.
pub(super) struct Setting<'a> {
    pub(super) title: &'a str,
    /// Under the title.
    pub(super) note: String,
    pub(super) description: &'a Description,
    /// With a frame for each link.
    pub(super) model: &'a Model<f64>,
    pub(super) base: Base,
    /// Spheres of contacts: link, place in it, radius.
    pub(super) balls: Vec<(String, [f64; 3], f64)>,
    /// The plane that they touch: its normal, and its height along that.
    pub(super) ground: Option<([f64; 3], f64)>,
    /// The ball that is hit.
    pub(super) projectile: Option<Projectile>,
    /// A page without a clock, which the program that serves it feeds with placements.
    pub(super) is_live: bool,
}

/// A ball that flies through one point: with one velocity before a time, and with another after it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub(super) struct Projectile {
    /// m.
    pub(super) place: [f64; 3],
    /// m.
    pub(super) radius: f64,
    /// The time of its hit, s from the start on; `None` if it is not hit and rests.
    pub(super) time: Option<f64>,
    /// m/s.
    pub(super) before: [f64; 3],
    /// m/s.
    pub(super) after: [f64; 3],
    /// m/s², after it was hit.
    pub(super) gravity: [f64; 3],
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Motion<'a> {
    note: &'a str,
    is_live: bool,
    /// The link whose placement is that of the body, for each body that moves.
    bodies: &'a [String],
    up: [f64; 3],
    /// Height of the grid along `up`, m.
    ground: f64,
    /// A sphere that holds the whole motion.
    center: [f64; 3],
    radius: f64,
    /// The robot's own size, m.
    size: f64,
    #[serde(flatten)]
    figure: &'a Figure,
    /// Playing speeds, seconds of the motion per second, and the initial one.
    speeds: Vec<f64>,
    speed: f64,
    /// Decimal places of the clock.
    places: usize,
    /// Number of bodies that move.
    moving: usize,
    low: [f64; 3],
    quantum: [f64; 3],
    placements: String,
    /// s.
    start: f64,
    /// Of frames, from the start on: doubles.
    times: String,
    energy_names: Vec<&'static str>,
    energies: String,
    events: &'a [EventRecord],
    projectile: Option<Projectile>,
    /// Number of contacts of each frame: 16 bits.
    contact_counts: String,
    /// Their points and forces, m and N: floats.
    contacts: String,
    /// Length of a drawn newton, m.
    newton: f64,
}

/// The page's text. `meshes` gets a warning for anything that cannot be drawn.
pub(super) fn html(r: &Recording, setting: &Setting<'_>, meshes: &Meshes<'_>) -> Result<String, FunctionError> {
    let mut figure = Figure::of(setting.description, setting.model, setting.base, Some(meshes));
    for (link, center, radius) in &setting.balls {
        figure.ball(setting.description, setting.model, link, *center, *radius);
    }
    let (start, length) = r.t.first().zip(r.t.last()).map_or((0.0, 0.0), |(first, last)| (*first, last - first));
    let speeds = clock::speeds(length);
    let speed = clock::speed(length, &speeds);
    let chosen = track::chosen(&r.t, figure.frames.len(), speed);
    let placements = placements(r, &chosen, setting.model, &figure.frames)?;
    let track = Track::of(&placements);
    let space = Space::of(&figure, &placements, setting);
    let floats = |all: &mut dyn Iterator<Item = f64>| base64(&all.flat_map(|x| (x as f32).to_le_bytes()).collect::<Vec<u8>>());
    let imbalance = r.imbalance();
    let energies: [(&str, &[f64]); 6] = [
        ("kinetic T", &r.kinetic),
        ("potential U", &r.potential),
        ("work", &r.work),
        ("dissipated", &r.dissipated),
        ("from events", &r.from_events),
        ("imbalance", &imbalance),
    ];
    let touching = chosen.iter().filter_map(|&k| r.contacts.get(k));
    let motion = Motion {
        note: &setting.note,
        is_live: setting.is_live,
        bodies: &figure.frames,
        up: space.up.into(),
        ground: space.ground,
        center: space.center.into(),
        radius: space.radius,
        size: space.size,
        figure: &figure,
        speeds,
        speed,
        places: clock::places(&r.t),
        moving: figure.frames.len(),
        low: track.low,
        quantum: track.quantum,
        placements: base64(&track.bytes),
        start,
        times: base64(&chosen.iter().flat_map(|&k| (r.t[k] - start).to_le_bytes()).collect::<Vec<u8>>()),
        energy_names: energies.iter().map(|e| e.0).collect(),
        energies: floats(&mut chosen.iter().flat_map(|&k| energies.map(|e| e.1.get(k).copied().unwrap_or(0.0)))),
        events: &r.events,
        projectile: setting.projectile,
        contact_counts: base64(&touching.clone().flat_map(|own| (own.len() as u16).to_le_bytes()).collect::<Vec<u8>>()),
        contacts: floats(&mut touching.flatten().flatten().flatten().copied()),
        newton: newton(setting.model, space.size),
    };
    // A name cannot end the script that contains it.
    let data = serde_json::to_string(&motion).unwrap_or_default().replace('<', "\\u003c");
    let parts = [("title", escaped(setting.title)), ("style", STYLE.to_owned()), ("data", data), ("script", PLAYER.to_owned())];
    Ok(filled(PAGE, &parts))
}

/// The motion as a picture that moves.
pub(super) fn svg(r: &Recording, setting: &Setting<'_>) -> Result<String, FunctionError> {
    let figure = Figure::of(setting.description, setting.model, setting.base, None);
    let length = r.t.first().zip(r.t.last()).map_or(0.0, |(first, last)| last - first);
    let speed = clock::speed(length, &clock::speeds(length));
    let chosen = animation::chosen(&r.t, speed);
    let placements = placements(r, &chosen, setting.model, &figure.frames)?;
    let space = Space::of(&figure, &placements, setting);
    let times: Vec<f64> = chosen.iter().map(|&k| r.t[k]).collect();
    let room = Room { up: space.up, ground: space.ground, center: space.center, radius: space.radius };
    Ok(animation::svg(&figure, &placements, &room, &times, setting.title, speed))
}

/// The length at which a newton is drawn, m: the weight of all that moves is half as long as the
/// robot.
fn newton(model: &Model<f64>, size: f64) -> f64 {
    let weight = model.moving_mass() * Vector3::from(model.gravity()).norm();
    if weight > 0.0 { 0.5 * size / weight } else { 0.0 }
}

/// The template with its places filled, each text as it is.
fn filled(template: &str, parts: &[(&str, String)]) -> String {
    let mut pieces = template.split("{{");
    let mut out = pieces.next().unwrap_or_default().to_owned();
    for piece in pieces {
        let (name, rest) = piece.split_once("}}").unwrap_or(("", piece));
        out += parts.iter().find(|p| p.0 == name).map_or("", |p| &p.1);
        out += rest;
    }
    out
}

/// Of all bodies that move in each frame.
fn placements(r: &Recording, chosen: &[usize], model: &Model<f64>, frames: &[String]) -> Result<Vec<Placement<f64>>, FunctionError> {
    let nq = r.q_names.len();
    let Ok(model) = model.clone().with_frames(frames) else { return Ok(Vec::new()) };
    let (mut ws, mut out) = (Dynamics::workspace(&model), vec![0.0; 12 * frames.len()]);
    let mut all = Vec::with_capacity(chosen.len() * frames.len());
    for &k in chosen {
        model.placements(&mut ws, &r.q[k * nq..][..nq], &mut out)?;
        all.extend(out.chunks_exact(12).map(track::placement));
    }
    Ok(all)
}

/// The space of the motion, and the upward direction.
struct Space {
    up: Vector3<f64>,
    ground: f64,
    center: Vector3<f64>,
    radius: f64,
    size: f64,
}

impl Space {
    fn of(figure: &Figure, placements: &[Placement<f64>], setting: &Setting<'_>) -> Self {
        let gravity = setting.model.gravity();
        let up = match setting.ground {
            Some((normal, _)) => unit(normal),
            None => unit((-gravity).into()),
        };
        let up = up.map_or_else(Vector3::z, Vector3::from);
        let moving = figure.frames.len();
        let points: Vec<_> = (0..=moving).map(|body| figure.points(body)).collect();
        let still = points[0].iter().map(|(p, r)| (*p, *r));
        let placed = placements.iter().enumerate().flat_map(|(k, x)| points[k % moving + 1].iter().map(|(p, r)| (x.transform(*p), *r)));
        let all = || still.clone().chain(placed.clone()).filter(|(p, _)| p.iter().all(|x| x.is_finite()));
        let (low, high) = bounds(all());
        let lowest = all().map(|(p, r)| up.dot(&p) - r).fold(0.0, f64::min);
        let (from, to) = bounds(still.clone().chain(placed.clone().take(points[1..].iter().map(Vec::len).sum())));
        let radius = (0.5 * (high - low).norm()).max(1e-3);
        let size = (to - from).norm().clamp(1e-3, 2.0 * radius);
        Self { up, ground: setting.ground.map_or(lowest, |g| g.1), center: 0.5 * (low + high), radius, size }
    }
}

/// The box around all of these.
fn bounds(all: impl Iterator<Item = (Vector3<f64>, f64)>) -> (Vector3<f64>, Vector3<f64>) {
    let mut ends: Option<(Vector3<f64>, Vector3<f64>)> = None;
    for (p, r) in all {
        let (low, high) = (p.add_scalar(-r), p.add_scalar(r));
        ends = Some(ends.map_or((low, high), |(a, b)| (a.inf(&low), b.sup(&high))));
    }
    ends.unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::super::recording::example;
    use super::*;
    use crate::robot::bundled_model;

    fn page(robot: &str, times: usize) -> String {
        page_of(robot, &example(&bundled_model(robot), times))
    }

    fn page_of(robot: &str, recording: &Recording) -> String {
        let bundled = articulated_models::robot(robot).unwrap();
        let options = articulated_formats::Options { base: bundled.base, ..articulated_formats::Options::default() };
        let description = articulated_formats::read(bundled.urdf.as_bytes(), &options).unwrap().description;
        let model = bundled_model(robot);
        let setting = Setting {
            title: "</script><b>",
            note: "a note".into(),
            description: &description,
            model: &model,
            base: bundled.base,
            balls: Vec::new(),
            ground: None,
            projectile: None,
            is_live: false,
        };
        html(recording, &setting, &Meshes::new(Vec::new(), &[], "robot")).unwrap()
    }

    fn data(page: &str) -> serde_json::Value {
        serde_json::from_str(page.split("application/json\">").nth(1).unwrap().split("</script>").next().unwrap()).unwrap()
    }

    #[test]
    fn nothing_is_fetched_and_no_name_ends_the_page() {
        let page = page("quadruped", 20);
        assert!(!page.contains("http") && !page.contains("src=") && !page.contains("{{"));
        assert_eq!(page.matches("</script>").count(), 2);
        assert!(page.contains("<title>&lt;/script&gt;&lt;b&gt;</title>"));
    }

    #[test]
    fn the_data_are_json_with_every_frame() {
        let motion = data(&page("quadruped", 20));
        assert_eq!(motion["moving"], 13);
        // All of them: 0.2 s are played slowly.
        let frames = motion["times"].as_str().unwrap().len() * 3 / 4 / 8;
        assert_eq!(frames, 20);
        assert_eq!(motion["placements"].as_str().unwrap().len(), (14 * 13 * frames).div_ceil(3) * 4);
    }

    /// Frames are distinguished by a clock that has run for years.
    #[test]
    fn times_are_kept_from_the_start_on() {
        let early = example(&bundled_model("quadruped"), 20);
        let late = Recording { t: early.t.iter().map(|t| 1e9 + t).collect(), ..early.clone() };
        let (early, late) = (data(&page_of("quadruped", &early)), data(&page_of("quadruped", &late)));
        assert_eq!((&late["start"], &late["speeds"], &late["places"]), (&1e9.into(), &early["speeds"], &3.into()));
        let shifted: Vec<u8> = (0..20).flat_map(|k| ((1e9 + f64::from(k) * 0.01) - 1e9).to_le_bytes()).collect();
        assert_eq!(late["times"], base64(&shifted));
    }
}
