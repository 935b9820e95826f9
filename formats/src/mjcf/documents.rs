//! The main document and the models that it attaches.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use articulated_core::diagnostic::{Code, Diagnostics, Subject, quote};

use super::element::{Element, Loader};
use super::grammar;
use crate::Input;

/// Maximum number of models that a file attaches.
const MOST_MODELS: usize = 100;

pub(crate) struct Documents {
    all: Vec<Document>,
}

struct Document {
    root: Element,
    path: PathBuf,
    /// Indices of other documents by their names in this one.
    models: BTreeMap<String, usize>,
}

impl Documents {
    pub(crate) fn read(input: &Input<'_>, log: &mut Diagnostics) -> Option<Self> {
        let file = &input.options.file;
        let root = Loader::new(input.sources, file).root(input.bytes, file, log)?;
        let mut all = Self { all: vec![Document { root, path: file.into(), models: BTreeMap::new() }] };
        let mut next = 0;
        while next < all.all.len() {
            grammar::check(&all.all[next].root, log);
            all.load_models(next, input, log);
            next += 1;
        }
        Some(all)
    }

    /// Reads the models that a document names.
    fn load_models(&mut self, index: usize, input: &Input<'_>, log: &mut Diagnostics) {
        let folder = Path::new(&input.options.file).parent().unwrap_or(Path::new(""));
        let mut found = BTreeMap::new();
        let mut loaded = Vec::new();
        let document = &self.all[index];
        for model in document.root.all("asset").flat_map(|section| section.all("model")) {
            let Some(file) = model.text("file") else {
                model.error((&Subject::Document, "file"), Code::MissingAttribute, "none", "the file of the model", log);
                continue;
            };
            let path = folder.join(file);
            let known = self.all.iter().chain(&loaded).position(|document| document.path == path);
            let position = match known {
                Some(position) => position,
                None if self.all.len() + loaded.len() >= MOST_MODELS => {
                    let found = format!("more than {MOST_MODELS} models");
                    model.error((&Subject::Document, "file"), Code::TooLarge, found, "fewer", log);
                    return;
                }
                None => match input.sources.read(&path) {
                    Ok(bytes) => {
                        let name = path.to_string_lossy().into_owned();
                        let Some(root) = Loader::new(input.sources, &name).root(&bytes, &name, log) else { continue };
                        loaded.push(Document { root, path, models: BTreeMap::new() });
                        self.all.len() + loaded.len() - 1
                    }
                    Err(error) => {
                        let found = format!("{}: {error}", quote(file));
                        model.error((&Subject::Document, "file"), Code::File, found, "a file, from the folder of the main file", log);
                        continue;
                    }
                },
            };
            let name = model.text("name").or(self.all.iter().chain(&loaded).nth(position).and_then(|document| document.root.text("model")));
            found.insert(name.unwrap_or_default().to_owned(), position);
        }
        self.all[index].models = found;
        self.all.extend(loaded);
    }

    pub(crate) fn roots(&self) -> impl Iterator<Item = &Element> {
        self.all.iter().map(|document| &document.root)
    }

    pub(crate) fn root(&self, index: usize) -> &Element {
        &self.all[index].root
    }

    /// The document with this name in another one.
    pub(crate) fn model(&self, document: usize, name: &str) -> Option<usize> {
        self.all[document].models.get(name).copied()
    }
}
