//! `robot.toml` of a new crate: a scene with the robot's file, and everything that the command line
//! says about reading and editing it.

use std::fmt::{Debug, Write};
use std::path::Path;

use articulated_codegen::Options;
use articulated_core::description::Base;

use crate::arguments::RobotArguments;
use crate::edits::CouplingArgument;
use crate::robot_scene::quoted;

/// The text. `file`: the robot's file, as the scene names it.
pub(super) fn text(file: &str, arguments: &RobotArguments, options: &Options) -> String {
    let mut out = format!("# The robot of this crate. Edit it as you like: docs/scenes.md lists the keys.\nfile = {}\n", quoted(file));
    let mut line = |key: &str, value: &str| _ = writeln!(out, "{key} = {value}");
    if options.robot.base == Base::Floating {
        line("base", "\"floating\"");
    }
    if let Some(gravity) = &arguments.gravity {
        line("gravity", &list(gravity.0));
    }
    for (key, is_on) in [
        ("allow_unphysical_inertia", arguments.allow_unphysical_inertia),
        ("first_of_duplicates", arguments.first_of_duplicates),
        ("allow_unknown_version", arguments.allow_unknown_version),
    ] {
        if is_on {
            line(key, "true");
        }
    }
    if !arguments.leave_out.is_empty() {
        let kinds: Vec<String> = arguments.leave_out.iter().map(|kind| quoted(kind.name())).collect();
        line("leave_out", &format!("[{}]", kinds.join(", ")));
    }
    if let Some(tolerance) = arguments.snap_angles {
        line("snap_angles", &format!("{tolerance:?}"));
    }
    if let Some(most) = arguments.max_code_size {
        line("max_code_size", &most.to_string());
    }
    let edits = &arguments.edits;
    let is_of_file = |coupling: &CouplingArgument| matches!(coupling, CouplingArgument::File);
    if edits.coupling.iter().any(is_of_file) {
        line("coupling", "\"file\"");
    }
    tables(&mut out, arguments);
    out
}

/// Tables, which come after all other keys.
fn tables(out: &mut String, arguments: &RobotArguments) {
    let edits = &arguments.edits;
    let mut table = |name: &str, rows: Vec<(String, String)>| {
        if !rows.is_empty() {
            let _ = writeln!(out, "\n[{name}]");
            rows.iter().for_each(|(key, value)| _ = writeln!(out, "{} = {value}", quoted(key)));
        }
    };
    table("args", arguments.arg.iter().map(|(name, value)| (name.clone(), quoted(value))).collect());
    table("packages", arguments.package.iter().map(|package| (package.name.clone(), quoted(&absolute(&package.folder)))).collect());
    table("rename", arguments.rename.iter().map(|(from, to)| (from.clone(), quoted(to))).collect());
    table("lock", edits.lock.iter().map(|lock| (lock.joint.clone(), list(lock.at.iter()))).collect());
    let follower = |coupling: &CouplingArgument| match coupling {
        CouplingArgument::File => None,
        CouplingArgument::Joint(c) => {
            let joints: Vec<String> = c.leaders.iter().map(|(name, _)| quoted(name)).collect();
            let coefficients = list(c.leaders.iter().map(|(_, coefficient)| coefficient));
            let value = format!("{{ joint = [{}], coefficients = {coefficients}, offset = {:?} }}", joints.join(", "), c.offset);
            Some((c.joint.clone(), value))
        }
    };
    table("coupling", edits.coupling.iter().filter_map(follower).collect());
    for load in &edits.payload {
        let _ = write!(out, "\n[[payload]]\nlink = {}\nmass = {:?}\n", quoted(&load.link), load.mass);
        let _ = write!(out, "center_of_mass = {}\ninertia = {}\n", list(load.center_of_mass), list(load.inertia));
    }
    for other in &edits.append {
        let file = if other.file.exists() { absolute(&other.file) } else { other.file.display().to_string() };
        let _ = write!(out, "\n[[append]]\nfile = {}\nat = {}\n", quoted(&file), quoted(&other.at));
        let _ = write!(
            out,
            "prefix = {}\nxyz = {}\nrpy = {}\n",
            quoted(&other.prefix),
            list(other.origin.xyz),
            list(other.origin.rotation.rpy())
        );
    }
}

fn list(numbers: impl IntoIterator<Item = impl Debug>) -> String {
    format!("[{}]", numbers.into_iter().map(|x| format!("{x:?}")).collect::<Vec<_>>().join(", "))
}

/// The path of a file or folder from anywhere.
pub(super) fn absolute(path: &Path) -> String {
    path.canonicalize().unwrap_or_else(|_| path.to_owned()).display().to_string()
}
