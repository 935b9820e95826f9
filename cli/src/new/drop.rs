//! `drop.toml` of a new crate with a floating base: the robot falls by a hand's breadth on its
//! tips.

use std::fmt::Write;

use articulated_core::algorithm::neutral;
use articulated_core::dynamics::Dynamics;
use articulated_core::index::BodyId;
use articulated_core::model::Model;

use crate::robot_scene::{quoted, resting};

/// Radius of the spheres at the tips, and the height that the robot falls, m.
const RADIUS: f64 = 0.02;
const HEIGHT: f64 = 0.05;
/// Depth of a contact at rest, m.
const DEPTH: f64 = 2e-3;
/// Maximum number of tips with a sphere, the lowest first: fingers touch nothing.
const MOST: usize = 8;

/// The text; `None` if no tip of the robot has a frame. `robot`: the lines with its file and edits.
pub(super) fn text(robot: &str, model: &Model<f64>) -> Option<String> {
    let mut q = vec![0.0; model.nq()];
    neutral(model, &mut q);
    let (mut ws, mut places) = (model.workspace(), vec![0.0; 12 * model.frames().len()]);
    model.placements(&mut ws, &q, &mut places).ok()?;
    let heights = places.chunks_exact(12).map(|place| place[11]);
    // The lowest frame of each body that carries no other body.
    let is_tip = |body: BodyId| !body.is_base() && model.outward().all(|other| model.bodies()[other].parent != body);
    let mut tips: Vec<(&str, BodyId, f64)> = Vec::new();
    for (frame, height) in model.frames().iter().zip(heights).filter(|(frame, _)| is_tip(frame.body)) {
        match tips.iter_mut().find(|(_, body, _)| *body == frame.body) {
            Some(tip) if tip.2 <= height => {}
            Some(tip) => *tip = (&frame.name, frame.body, height),
            None => tips.push((&frame.name, frame.body, height)),
        }
    }
    tips.sort_by(|a, b| a.2.total_cmp(&b.2));
    let lowest = tips.first()?.2;
    tips.truncate(MOST);
    let (mass, gravity) = (model.moving_mass(), model.gravity().norm());
    let (mass, gravity) = (if mass > 0.0 { mass } else { 1.0 }, if gravity > 0.0 { gravity } else { 9.81 });
    // Four tips, or as many as there are, carry the robot.
    let (stiffness, damping_time) = resting(mass, gravity, tips.len().min(4), DEPTH);
    let mut out = robot.to_owned();
    let _ = write!(
        out,
        "\n[initial]\nbase = {{ xyz = [0.0, 0.0, {:.3}] }}  # m: the lowest tip {HEIGHT} m over the ground\n\n\
         # Holds the posture of q = 0: τ = kp (target ⊖ q) − kd v.\n\
         # Choose the gains for your robot.\n\
         [control]\nkind = \"pd\"\nkp = {:.0}.0  # N·m/rad\nkd = {:.0}.0  # N·m·s/rad\n\n\
         # Spheres at the tips against the plane z = 0.\n\
         # They sink in by {:.0} mm at rest.\n[effects.contact]\n",
        HEIGHT + RADIUS - lowest,
        (10.0 * mass).max(1.0),
        (0.4 * mass).max(1.0),
        1e3 * DEPTH
    );
    for (name, ..) in &tips {
        let _ = writeln!(
            out,
            "{} = {{ radius = {RADIUS}, stiffness = {stiffness:.1e}, damping_time = {damping_time:.1e}, friction = 0.8 }}",
            quoted(name)
        );
    }
    out += "\n[simulation]\nend = 2.0  # s\nintegrator = \"rodas4\"  # contact is stiff\nevents = [\"contacts\"]\n";
    Some(out)
}
