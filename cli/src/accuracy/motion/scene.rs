//! A scene as a motion to be measured.

use std::path::Path;

use articulated::simulate::Settings;
use articulated_codegen::scene::{self, Bundled, Prepared, Scene};
use articulated_codegen::{Error, nearest};

use super::Subject;
use crate::failure::Failure;

const BUNDLED: Bundled<'static> = &|name| articulated_models::robot(name).map(|r| (r.urdf, r.base));

/// The scene that a word of the command line names, a file or a bundled one: its name, and what moves.
pub(super) fn find(name: &str) -> Result<(String, Subject), Failure> {
    let path = Path::new(name);
    let bundled = articulated_models::scene(name).filter(|_| !path.is_file());
    let prepared = match bundled {
        Some(bundled) => {
            let scene = Scene::read(&format!("{name}.toml"), bundled.toml).map_err(Error::from)?;
            scene::open_in(scene, Path::new(""), BUNDLED)?
        }
        None if path.is_file() => scene::open(path, BUNDLED)?,
        None => return Err(unknown(name)),
    };
    let stem = path.file_stem().map_or_else(|| name.to_owned(), |stem| stem.to_string_lossy().into_owned());
    Ok((stem, subject(prepared)?))
}

fn subject(mut prepared: Prepared) -> Result<Subject, Failure> {
    prepared.request.options.frames = None;
    let reading = articulated_codegen::read(&prepared.request)?;
    let model = articulated_codegen::model(&prepared.request, &reading.description)?;
    let told = |e: scene::articulated_scene::SceneErrors| Failure::input(e.errors.iter().map(ToString::to_string));
    let (q, v) = prepared.scene.start(&model).map_err(told)?;
    let torque = match prepared.scene.controller(&model, &mut |_| Err("tables are not read here".to_owned())).map_err(told)? {
        scene::articulated_scene::Controller::None => vec![0.0; model.nv],
        scene::articulated_scene::Controller::Torque(tau) => tau,
        _ => {
            let line = format!(
                "{}: integrators are measured on motions without a controller: found a table or a PD law, expected kind \"none\" or \"torque\"",
                prepared.scene.file
            );
            return Err(Failure::input([line]));
        }
    };
    let seconds = prepared.scene.simulation.as_ref().map_or(Settings::default().end, |s| s.end - s.start);
    let options = &prepared.request.options;
    let free = options.base == articulated_core::description::Base::Floating && options.gravity == [0.0; 3] && options.effects.is_empty();
    Ok(Subject { model, q, v, torque, seconds, free })
}

fn unknown(name: &str) -> Failure {
    let names = || articulated_models::SCENES.iter().map(|s| s.name);
    let near = nearest(name, names()).map(|n| format!("; did you mean {n:?}?")).unwrap_or_default();
    Failure::input([format!(
        "{name}: found neither a file nor a bundled scene{near} (bundled: {})",
        names().collect::<Vec<_>>().join(", ")
    )])
}
