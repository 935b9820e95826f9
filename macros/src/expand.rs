//! From an invocation to a module.

use std::env;
use std::io::ErrorKind;
use std::path::PathBuf;

use articulated_codegen::scene::articulated_scene::{At, Robot, Scene, SceneErrors, nearest_file};
use articulated_codegen::urdf::{MOST_BYTES, read_file, summary};
use articulated_codegen::{Generated, Request, check_words, scene};
use proc_macro2::{Span, TokenStream};
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
    let mut reader = Reader { settings, errors, paths: Vec::new() };
    let asked = reader.asked();
    let paths = reader.paths;
    let source = asked.map(|asked| source(asked, settings, errors));
    quote! { #source #(const _: &[u8] = ::core::include_bytes!(#paths);)* }
}

/// What is to be generated.
struct Asked {
    request: Request,
    /// The scene, with what the invocation says in the place of what it says itself.
    scene: Scene,
}

/// The generated source, or nothing and every error.
fn source(Asked { mut request, scene }: Asked, settings: &Settings, errors: &mut Errors) -> TokenStream {
    let effects = if scene.has_effects() { scene::settle(&mut request, &scene).map(drop) } else { Ok(()) };
    match effects.and_then(|()| articulated_codegen::generate(&request)) {
        Ok(generated) => {
            let (code, warnings) = (generated.tokens(), warnings(&generated, settings.places.span(settings.at_robot(&scene))));
            quote! { #code #warnings }
        }
        Err(error) => {
            settings.at_their_words(error, &scene).into_iter().for_each(|error| errors.push(error));
            TokenStream::new()
        }
    }
}

/// Items of which the compiler warns, one for each sort of warning: a macro has no other way to warn. `#[allow(deprecated)]` on the module silences them.
fn warnings(generated: &Generated, at: Span) -> TokenStream {
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
    errors: &'a mut Errors,
    /// The files that were read.
    paths: Vec<String>,
}

impl Reader<'_> {
    /// Nothing, if a file is missing or the scene's file is broken.
    fn asked(&mut self) -> Option<Asked> {
        let settings = self.settings;
        let seen_from = settings.own.scene.as_ref().map_or("", |(name, _)| name);
        let from_file = if settings.own.scene.is_some() { self.scene() } else { Some(Scene::default()) };
        let is_whole = from_file.is_some();
        let (scene, wrong) = from_file.unwrap_or_default().overlaid(&settings.rest, &Settings::own_names());
        wrong.iter().for_each(|error| self.errors.push(settings.in_scene(error)));
        let mut options = settings.own.options();
        scene::fill(&mut options, &scene);
        let file = if is_whole { self.robot(&scene).unwrap_or_default() } else { return None };
        let urdf = if file.is_empty() { None } else { self.file(&file, settings.at_robot(&scene)) };
        let mut is_complete = urdf.is_some();
        for (other, said) in options.robot.append.iter_mut().zip(&scene.code.append) {
            other.file = from_cargo(seen_from, &said.urdf, said.place);
            let bytes = self.file(&other.file, settings.here(said.place));
            is_complete &= bytes.is_some();
            other.urdf = bytes.unwrap_or_default();
        }
        let request = Request { urdf: urdf.unwrap_or_default(), file, options };
        if !is_complete {
            // Mistakes in the words of the invocation are mistakes without the robot too.
            let wrong = check_words(&request).err().map(|error| settings.at_their_words(error, &scene));
            wrong.into_iter().flatten().for_each(|error| self.errors.push(error));
        }
        is_complete.then_some(Asked { request, scene })
    }

    /// The scene that is named.
    fn scene(&mut self) -> Option<Scene> {
        let (name, at) = self.settings.own.scene.as_ref()?;
        let bytes = self.file(name, *at)?;
        let wrong = |SceneErrors { errors }: SceneErrors| errors.iter().for_each(|error| self.errors.push(self.settings.in_scene(error)));
        Scene::read_bytes(name, &bytes).map_err(wrong).ok()
    }

    /// The robot's file.
    fn robot(&mut self, scene: &Scene) -> Option<String> {
        let (places, seen_from) = (&self.settings.places, self.settings.own.scene.as_ref());
        match (&scene.robot, seen_from) {
            (Robot::Urdf(urdf), _) => {
                let seen_from = seen_from.map_or("", |(name, _)| name);
                return Some(from_cargo(seen_from, urdf, scene.code.places.robot));
            }
            // Its value is wrong, which was told.
            _ if self.settings.has("urdf") => {}
            (_, Some((name, at))) => {
                let known = "a bundled robot is known to the command line alone";
                self.errors.push(places.error(*at, format!("{name}: the scene names no URDF ({known}): give its path as `urdf`")));
            }
            // So was a scene's name that cannot be read.
            _ if self.settings.has("scene") => {}
            (_, None) => {
                let expected = "the path of a URDF from the folder of Cargo.toml, as \"robots/arm.urdf\", here or in a `scene`";
                self.errors.push(places.error(At::Nowhere, format!("`urdf` is missing: expected {expected}")));
            }
        }
        None
    }

    /// The bytes of the file that `name`, which stands at `at`, names from the folder of the user's Cargo.toml.
    fn file(&mut self, name: &str, at: At) -> Option<Vec<u8>> {
        let bytes = self.read(name).map_err(|reason| self.settings.places.error(at, format!("{name}: {reason}")));
        self.errors.take(bytes)
    }

    fn read(&mut self, name: &str) -> Result<Vec<u8>, String> {
        let root = env::var_os("CARGO_MANIFEST_DIR").map(PathBuf::from).unwrap_or_default();
        let path = root.join(name);
        let bytes = read_file(&path, MOST_BYTES).map_err(|error| match error.kind() {
            ErrorKind::NotFound => {
                let near = nearest_file(&path).map(|name| format!("; did you mean {name:?}?")).unwrap_or_default();
                format!("there is no such file, seen from the folder of Cargo.toml{near}")
            }
            _ => error.to_string(),
        })?;
        self.paths.push(path.into_os_string().into_string().map_err(|_| "the path of the package is not UTF-8")?);
        Ok(bytes)
    }
}

/// A file as seen from the folder of Cargo.toml: what the invocation names as it is, what the scene names from the scene's folder.
fn from_cargo(scene: &str, name: &str, at: At) -> String {
    if matches!(at, At::Word(_)) { name.to_owned() } else { scene::beside(scene, name) }
}
