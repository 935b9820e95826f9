//! From an invocation to a module.

use std::env;
use std::path::{Path, PathBuf};

use articulated_codegen::diagnostic::{At, Code, Diagnostic, Diagnostics, Span, summary};
use articulated_codegen::scene::articulated_scene::{Loader, Robot, Scene, beside, folder_of};
use articulated_codegen::{Generated, Request, check_words, scene};
use proc_macro2::{Span as Word, TokenStream};
use quote::{quote, quote_spanned};

use crate::errors::Errors;
use crate::invocation::Invocation;
use crate::settings::Settings;

/// The module, or one with as much as could be made and the errors.
pub(crate) fn expand(input: TokenStream) -> TokenStream {
    match syn::parse2(input) {
        Ok(invocation) => module(invocation),
        Err(error) => error.into_compile_error(),
    }
}

fn module(invocation: Invocation) -> TokenStream {
    let Invocation { attributes, visibility, module, name, settings, mut errors } = invocation;
    let contents = contents(&settings, &mut errors);
    let errors = errors.into_items();
    let doc = "\n\nThe module has the functions that its invocation lists. To get another function of `articulated::algorithm`, add it to `functions`.";
    // Lints about style are for code that somebody writes. First, so that the user's attributes have the last word.
    let allow = quote! { #[allow(clippy::all, clippy::pedantic, clippy::nursery, clippy::restriction)] };
    quote! { #allow #(#attributes)* #[doc = #doc] #visibility #module #name { #errors #contents } }
}

/// The generated source and a mention of every file, by which the compiler knows that the module depends on them.
fn contents(settings: &Settings, errors: &mut Errors) -> TokenStream {
    let mut reader = Reader { settings, log: Diagnostics::default(), loader: loader() };
    let (scene, request) = reader.request();
    let Reader { mut log, loader, .. } = reader;
    let source = request.map(|request| source(&request, &scene, settings, &mut log));
    log.sort();
    log.errors.iter().for_each(|finding| errors.push(settings.error(finding, &scene)));
    let paths: Vec<String> = loader.files.iter().map(|path| path.display().to_string()).collect();
    quote! { #source #(const _: &[u8] = ::core::include_bytes!(#paths);)* }
}

/// Files of the user's crate.
fn loader() -> Loader<'static> {
    let root = env::var_os("CARGO_MANIFEST_DIR").map(PathBuf::from).unwrap_or_default();
    Loader { root, seen_from: ", seen from the folder of Cargo.toml", ..Loader::default() }
}

/// The generated source, or nothing and every error.
fn source(request: &Request, scene: &Scene, settings: &Settings, log: &mut Diagnostics) -> TokenStream {
    match articulated_codegen::generate(request) {
        Ok(generated) => {
            let (code, warnings) = (generated.tokens(), warnings(&generated, settings.places.span(settings.at_robot(scene))));
            quote! { #code #warnings }
        }
        Err(findings) => {
            log.take(findings);
            TokenStream::new()
        }
    }
}

/// Items of which the compiler warns, one for each sort of warning: a macro has no other way to warn. `#[allow(deprecated)]` on the module silences them.
fn warnings(generated: &Generated, at: Word) -> TokenStream {
    let items = summary(&generated.warnings).into_iter().map(|line| {
        quote_spanned! {at=>
            const _: () = {
                #[deprecated(note = #line)]
                const ROBOT_WARNING: () = ();
                ROBOT_WARNING
            };
        }
    });
    items.collect()
}

/// Reads the files of an invocation.
struct Reader<'a> {
    settings: &'a Settings,
    log: Diagnostics,
    loader: Loader<'static>,
}

impl Reader<'_> {
    /// The scene, with what the invocation says in the place of what it says itself, and the
    /// request. No request if a file is missing or the scene is wrong.
    fn request(&mut self) -> (Scene, Option<Request>) {
        let settings = self.settings;
        let folder = folder_of(settings.macro_keys.scene.as_ref().map_or("", |(name, _)| name).as_ref());
        let from_file = match &settings.macro_keys.scene {
            Some((name, at)) => self.loader.scene(name.as_ref(), &Span { file: name.clone(), at: *at }, &mut self.log),
            None => Some(Scene::default()),
        };
        let is_whole = from_file.is_some();
        let (scene, wrong) = from_file.unwrap_or_default().overlaid(&settings.rest, &Settings::own_names());
        self.log.extend(wrong);
        let mut options = settings.macro_keys.options();
        scene::fill(&mut options, &scene);
        if !is_whole {
            return (scene, None);
        }
        let robot = self.robot(folder, &scene);
        let appended = self.loader.append(folder, &mut options.robot.append, &mut self.log);
        let is_complete = robot.is_some() && appended;
        let (file, document) = robot.unwrap_or_default();
        let request = Request { document, file, scene: Some(scene.clone()), options };
        if !is_complete {
            // Mistakes in the words of the invocation are mistakes without the robot too.
            check_words(&request, &mut self.log);
        }
        (scene, is_complete.then_some(request))
    }

    /// The name of the robot's file and its bytes.
    fn robot(&mut self, folder: &Path, scene: &Scene) -> Option<(String, Vec<u8>)> {
        let settings = self.settings;
        if scene.robot != Robot::Given {
            return self.loader.robot(folder, scene, &mut self.log).map(|(file, document, _)| (file, document));
        }
        // A value that is wrong is reported already.
        if !settings.has("urdf") {
            self.log.push(match &settings.macro_keys.scene {
                Some(_) => scene.without_robot("no robot", "urdf, here or in the scene"),
                None if settings.has("scene") => return None,
                None => Diagnostic::error(
                    "",
                    (At::Nowhere, "urdf"),
                    Code::MissingKey,
                    "nothing",
                    "the path of a URDF from the folder of Cargo.toml, as \"robots/arm.urdf\", here or in a `scene`",
                ),
            });
        }
        None
    }
}

impl Settings {
    /// A finding at the word of the invocation that it is about; of a scene's file, where that is
    /// named; of another file, where the robot is named.
    fn error(&self, finding: &Diagnostic, scene: &Scene) -> syn::Error {
        match finding.span.at {
            At::Word(_) => self.places.error(finding.span.at, finding.message()),
            _ if finding.file() == scene.file => self.places.error(self.at_scene(), finding),
            _ => self.places.error(self.at_append(finding.file(), scene).unwrap_or_else(|| self.at_robot(scene)), finding),
        }
    }

    /// Where the robot's file is named: in the invocation, or in the scene.
    fn at_robot(&self, scene: &Scene) -> At {
        let at = scene.code.places.robot;
        if matches!(at, At::Word(_)) { at } else { self.at_scene() }
    }

    /// Where a robot to append is named, in the invocation or in the scene.
    fn at_append(&self, file: &str, scene: &Scene) -> Option<At> {
        let is_named = |at: At, name: &str| file == name || !matches!(at, At::Word(_)) && file == beside(&scene.file, name);
        let at = scene.code.append.iter().find(|other| is_named(other.place, &other.file))?.place;
        Some(if matches!(at, At::Word(_)) { at } else { self.at_scene() })
    }

    fn at_scene(&self) -> At {
        self.macro_keys.scene.as_ref().map_or(At::Nowhere, |(_, at)| *at)
    }
}
