//! The scene of a robot's file: its smooth motion.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use articulated_core::description::Joint;
use articulated_core::model::GRAVITY;
use articulated_formats::world::Touching;
use articulated_formats::{Environment, LeaveOut, Options, Reading, included, read_file, read_with};
use articulated_scene::{folder_of, smooth_in_file};

use crate::failure::Failure;
use crate::table::number;

/// How long the motion is, s.
const END: f64 = 5.0;

/// A scene, as TOML, with the smooth forces of the file. Its comments list the other forces.
/// Errors: those of the file.
pub(crate) fn text(path: &Path, leave_out: &[LeaveOut]) -> Result<String, Failure> {
    Ok(written(path, &read(path, leave_out)?, leave_out, false))
}

/// The scene of the motion as `simulate` steps it: with constraints, if the file has some.
pub(crate) fn printed(path: &Path, leave_out: &[LeaveOut]) -> Result<String, Failure> {
    let reading = read(path, leave_out)?;
    let has_law = reading.world.touching.as_ref().is_some_and(Touching::has_some);
    Ok(written(path, &reading, leave_out, has_law))
}

/// The keyframe with which a motion starts, if the file has it.
pub(crate) const HOME: &str = "home";

fn written(path: &Path, reading: &Reading, leave_out: &[LeaveOut], has_law: bool) -> String {
    let (joints, world) = (&reading.description.joints, &reading.world);
    let name = quoted(&path.file_name().unwrap_or(path.as_os_str()).to_string_lossy());
    let what = if has_law { "motion" } else { "smooth motion" };
    let mut out = format!("# The {what} of {name}.\nfile = {name}\n");
    if !leave_out.is_empty() {
        let kinds: Vec<String> = leave_out.iter().map(|kind| quoted(kind.name())).collect();
        let _ = writeln!(out, "leave_out = [{}]", kinds.join(", "));
    }
    out += "\n[effects]\n";
    for row in smooth_in_file(joints, world) {
        let _ = writeln!(out, "{} = \"file\"", row.name);
    }
    for (line, what, has) in OTHERS.into_iter().filter(|_| !has_law) {
        if joints.iter().any(has) {
            let _ = writeln!(out, "# {line}  # {what}");
        }
    }
    if !has_law && reading.description.links.iter().any(|link| !link.collision.is_empty()) {
        let (plane, ground) =
            if world.planes.is_empty() { ("", "the ground z = 0") } else { (", plane = \"file\"", "the planes of the file") };
        let Resting { stiffness, damping_time, on } = Resting::of(reading);
        let contact =
            format!("from = \"collision\"{plane}, stiffness = {stiffness:.1e}, damping_time = {damping_time:.1e}, friction = 0.8");
        let _ = writeln!(out, "# contact = {{ \"*\" = {{ {contact} }} }}  # against {ground}; {on}");
    }
    let home = world.keyframes.iter().find(|keyframe| has_law && keyframe.name == HOME);
    let keyframes: Vec<String> = world.keyframes.iter().map(|keyframe| quoted(&keyframe.name)).collect();
    if !keyframes.is_empty() {
        match home {
            Some(home) => {
                let others: Vec<String> = keyframes.iter().filter(|name| **name != quoted(&home.name)).cloned().collect();
                let others = if others.is_empty() { String::new() } else { format!("  # or {}", others.join(", ")) };
                let _ = writeln!(out, "\n[initial]\nkeyframe = {}{others}", quoted(&home.name));
            }
            None => {
                let _ = writeln!(out, "\n[initial]\n# keyframe = {}", keyframes.join("  # or "));
            }
        }
    }
    if !world.actuators.is_empty() || !world.passive.is_empty() {
        out += "\n[control]\nkind = \"actuators\"\n";
        if let Some(home) = home {
            let _ = writeln!(out, "keyframe = {}", quoted(&home.name));
        }
        for actuator in &world.actuators {
            let range = actuator.control_range.map(|[lower, upper]| format!("  # {lower:?} to {upper:?}")).unwrap_or_default();
            // The keyframe has its own.
            let mark = if home.is_some() { "# " } else { "" };
            let _ = writeln!(out, "{mark}ctrl.{} = 0.0{range}", quoted(&actuator.name));
        }
    }
    let _ = writeln!(out, "\n[simulation]\nend = {END:?}");
    if has_law {
        out += "law = \"mujoco\"\n";
        // Without one, the step is that of MuJoCo.
        out += if world.step.is_some() { "step = \"file\"\n" } else { "" };
    } else if let Some(step) = world.step {
        let _ = writeln!(out, "# integrator = \"semi_implicit_euler\"\n# step = \"file\"  # {step:?} s");
    }
    out
}

/// Parameters of contacts on which a robot rests: they sink in by [`SINKS`] and are damped
/// critically.
struct Resting {
    /// N/m.
    stiffness: f64,
    /// s.
    damping_time: f64,
    /// The mass and the number of points, in words.
    on: String,
}

/// Depth of contacts under the robot's weight, m.
const SINKS: f64 = 1e-4;

/// Number of points on which a robot rests, at most.
const POINTS: usize = 4;

impl Resting {
    /// For the mass of the whole robot.
    fn of(reading: &Reading) -> Self {
        let links = &reading.description.links;
        let mass: f64 = links.iter().filter_map(|link| link.inertial).map(|inertial| inertial.mass).sum();
        let mass = if mass > 0.0 && mass.is_finite() { mass } else { 1.0 };
        let gravity = reading.world.gravity.unwrap_or(GRAVITY).iter().map(|g| g * g).sum::<f64>().sqrt();
        let gravity = if gravity > 0.0 && gravity.is_finite() { gravity } else { -GRAVITY[2] };
        let points: usize = links.iter().flat_map(|link| &link.collision).map(|piece| piece.contact_spheres().len()).sum();
        let points = points.clamp(1, POINTS);
        let (stiffness, damping_time) = resting(mass, gravity, points, SINKS);
        let on = format!("{} kg at rest on {points} point{}", number(mass), if points == 1 { "" } else { "s" });
        Self { stiffness, damping_time, on }
    }
}

/// Stiffness, N/m, and damping time, s, of each of some points on which a robot rests. It sinks in
/// by a depth x, m, under its mass, kg, and gravity g, m/s². Each point carries an equal part m:
/// k = m g/x, T = 2 √(m/k) = 2 √(x/g).
pub(crate) fn resting(mass: f64, gravity: f64, points: usize, depth: f64) -> (f64, f64) {
    (mass * gravity / (points as f64 * depth), 2.0 * (depth / gravity).sqrt())
}

/// A text of TOML.
pub(crate) fn quoted(text: &str) -> String {
    let mut out = String::from("\"");
    for c in text.chars() {
        match c {
            '"' | '\\' => out.extend(['\\', c]),
            c if c.is_control() => {
                let _ = write!(out, "\\u{:04X}", u32::from(c));
            }
            c => out.push(c),
        }
    }
    out + "\""
}

/// Forces of the file that such a scene leaves out, in words.
pub(crate) fn left_out(joints: &[Joint], has_collision: bool) -> Vec<&'static str> {
    let others = OTHERS.iter().filter(|(.., has)| joints.iter().any(has)).map(|(_, what, _)| *what);
    others.chain(has_collision.then_some("contacts")).collect()
}

type Has = fn(&Joint) -> bool;

fn is_not_zero(number: Option<f64>) -> bool {
    number.is_some_and(|number| number != 0.0)
}

/// Other effects, which a scene can turn on.
const OTHERS: [(&str, &str, Has); 2] = [
    ("friction = \"file\"", "dry friction", |joint| is_not_zero(joint.dynamics.friction)),
    ("limit = { from = \"file\", stiffness = 1e4, damping = 10 }", "limits", |joint| {
        joint.limit.is_some_and(|limit| limit.lower.is_finite() || limit.upper.is_finite())
    }),
];

fn read(path: &Path, leave_out: &[LeaveOut]) -> Result<Reading, Failure> {
    let file = path.display().to_string();
    let bytes =
        read_file(path, articulated_formats::MOST_BYTES).map_err(|error| Failure::input([format!("{file}: cannot be read: {error}")]))?;
    let options = Options { file, leave_out: leave_out.iter().copied().collect(), ..Options::default() };
    let included = included(&Environment, &PathBuf::new(), &bytes, &options);
    Ok(read_with(&included, &bytes, &options)?)
}

/// A note about the scene made from a robot's file: it lists all that is left out.
pub(crate) fn note(path: &Path) -> Result<Option<String>, Failure> {
    let reading = read(path, &[])?;
    let collides = reading.description.links.iter().any(|link| !link.collision.is_empty());
    let left = left_out(&reading.description.joints, collides);
    let file = path.strip_prefix(folder_of(path)).unwrap_or(path).display();
    Ok((!left.is_empty())
        .then(|| format!("{file}: the smooth motion, without {}; --print-scene prints its scene, to be changed", left.join(", "))))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn any_name_is_a_text_of_toml() {
        for name in ["arm", "a \"b\" \\ c", "\u{1b}[2J\n\t\u{7f}", "größe\u{202e}", ""] {
            let read = articulated_scene::Scene::read("s.toml", &format!("summary = {}", quoted(name))).expect("TOML");
            assert_eq!(read.summary, name);
        }
    }
}
