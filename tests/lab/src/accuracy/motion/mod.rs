//! The cost of a motion's accuracy, for each integrator.

mod advise;
#[cfg(test)]
mod dop853_digits;
#[cfg(test)]
mod orders;
mod page;
mod peers;
mod plot;
mod scene;
mod subject;
mod sweep;
mod text;

use crate::compare::manifest;
use crate::error::Error;
use crate::json::json;
use crate::process::Folder;
use crate::session::Session;
use sweep::Sample;
pub use sweep::{Motion, Settings};

/// Measures all integrators on the motion of a scene.
pub fn measure(session: &Session, settings: &Settings) -> Result<Motion, Error> {
    let subject = scene::subject(session)?;
    let folder = Folder::new().map_err(|e| Error::tool(&e))?;
    let libraries = manifest::named(&settings.peer, settings.peers_manifest.as_deref())?;
    let peers = peers::Peers::open(session, &subject, &libraries, folder.path())?;
    sweep::all(&session.name, &subject, &peers, settings)
}

impl Motion {
    /// As tables.
    pub fn text(&self) -> String {
        text::text(self)
    }

    /// The cheapest runs with an error of at most `wish`.
    pub fn advice(&self, wish: f64) -> advise::Advice<'_> {
        advise::all(self, wish)
    }

    /// The same in sentences.
    pub fn advice_in_text(&self, wish: f64) -> String {
        text::advice(self, wish)
    }

    /// A sentence if no run is accurate enough.
    pub fn short_of(&self, wish: f64) -> Option<String> {
        self.advice(wish).runs.is_empty().then(|| format!("{}: no run is accurate to {wish:e}", self.scene))
    }

    /// All files of the report: their names and contents.
    pub fn files(&self) -> Vec<(String, String)> {
        let diagrams = plot::diagrams(self);
        let mut files: Vec<(String, String)> = diagrams.iter().map(|(name, drawing)| (format!("{name}.svg"), drawing.svg())).collect();
        files.push(("integrators.csv".to_owned(), text::csv(self)));
        files.push(("integrators.json".to_owned(), json(self)));
        files.push(("integrators.html".to_owned(), page::html(self, &diagrams)));
        files
    }
}
