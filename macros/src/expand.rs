//! From an invocation to a module.

use std::env;
use std::io::ErrorKind;
use std::path::PathBuf;

use articulated_codegen::scene::articulated_scene::{Robot, Scene, SceneErrors};
use articulated_codegen::urdf::{MOST_BYTES, read_file};
use articulated_codegen::{Options, Request, scene};
use proc_macro2::{Span, TokenStream};
use quote::quote;
use syn::{Error, LitStr, Result};

use crate::errors::Errors;
use crate::invocation::Invocation;
use crate::place;
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
    // Lints about style are for code that somebody writes. First, so that the user's attributes have the last word.
    let allow = quote! { #[allow(clippy::all, clippy::pedantic, clippy::nursery, clippy::restriction)] };
    quote! { #allow #(#attributes)* #visibility #module #name { #errors #contents } }
}

/// The generated source and a mention of every file, by which the compiler knows that the module depends on them.
fn contents(settings: &Settings, errors: &mut Errors) -> TokenStream {
    let mut files = Files::default();
    let asked = Asked::of(settings, &mut files, errors);
    let source = asked.map(|asked| source(asked, settings, errors));
    let paths = files.paths;
    quote! { #source #(const _: &[u8] = ::core::include_bytes!(#paths);)* }
}

/// What is to be generated.
struct Asked {
    request: Request,
    /// The scene, with the effects of the invocation in place of its own, if there are any.
    scene: Scene,
    /// Where the robot's file is named.
    robot: Span,
}

impl Asked {
    /// Nothing, if a file is missing or the scene is broken.
    fn of(settings: &Settings, files: &mut Files, errors: &mut Errors) -> Option<Self> {
        let scene = match &settings.scene {
            Some(name) => scene(name, settings, files, errors),
            None => Some(Scene::default()),
        };
        let scene = with_effects(scene, settings, errors);
        let mut options = Options::default();
        scene.iter().for_each(|scene| scene::fill(&mut options, scene));
        let seen_from = settings.scene.as_ref().map(LitStr::value).unwrap_or_default();
        options.robot.append.iter_mut().for_each(|other| other.file = scene::beside(&seen_from, &other.file));
        let mut options = settings.options(options);
        let (file, robot) = robot(settings, scene.as_ref(), &seen_from, errors)?;
        let urdf = errors.take(files.read(&file, robot));
        let mut complete = urdf.is_some();
        for (i, other) in options.robot.append.iter_mut().enumerate() {
            let span = settings.append.as_ref().and_then(|all| all.get(i)?.urdf.as_ref()).map_or(robot, LitStr::span);
            let bytes = errors.take(files.read(&other.file, span));
            complete &= bytes.is_some();
            other.urdf = bytes.unwrap_or_default();
        }
        let request = Request { urdf: urdf?, file, options };
        Some(Self { request, scene: scene?, robot }).filter(|_| complete)
    }
}

/// The scene that is named.
fn scene(name: &LitStr, settings: &Settings, files: &mut Files, errors: &mut Errors) -> Option<Scene> {
    let bytes = errors.take(files.read(&name.value(), name.span()))?;
    scene_or_errors(Scene::read_bytes(&name.value(), &bytes), settings, name.span(), errors)
}

/// The scene with the effects that stand in the invocation.
fn with_effects(scene: Option<Scene>, settings: &Settings, errors: &mut Errors) -> Option<Scene> {
    let Some(effects) = &settings.effects else { return scene };
    let own = scene_or_errors(Scene::of_effects("effects", effects), settings, Span::call_site(), errors)?;
    scene.map(|scene| Scene { effects: own.effects, shafts: own.shafts, ..scene })
}

fn scene_or_errors(result: std::result::Result<Scene, SceneErrors>, settings: &Settings, span: Span, errors: &mut Errors) -> Option<Scene> {
    let wrong = |SceneErrors { errors: all }: SceneErrors| all.iter().for_each(|error| errors.push(place::in_scene(error, settings, span)));
    result.map_err(wrong).ok()
}

/// The robot's file, and where it is named.
fn robot(settings: &Settings, scene: Option<&Scene>, seen_from: &str, errors: &mut Errors) -> Option<(String, Span)> {
    if let Some(urdf) = &settings.urdf {
        return Some((urdf.value(), urdf.span()));
    }
    let (named, scene) = (settings.scene.as_ref()?, scene?);
    if let Robot::Urdf(urdf) = &scene.robot {
        return Some((scene::beside(seen_from, urdf), named.span()));
    }
    let known = "a bundled robot is known to the command line alone";
    errors.push(Error::new(named.span(), format!("{seen_from}: the scene names no URDF ({known}): give its path as `urdf`")));
    None
}

/// The generated source, or nothing and every error.
fn source(asked: Asked, settings: &Settings, errors: &mut Errors) -> TokenStream {
    let Asked { mut request, scene, robot } = asked;
    let effects = if scene.has_effects() { scene::settle(&mut request, &scene).map(drop) } else { Ok(()) };
    match effects.and_then(|()| articulated_codegen::generate(&request)) {
        Ok(generated) => generated.tokens(),
        Err(error) => {
            let error = scene::placed(error, &without_what_is_replaced(scene, settings));
            errors.push(place::at_its_word(&error, settings, robot));
            TokenStream::new()
        }
    }
}

/// The scene without lists in whose place the invocation has its own: what is wrong with those is not the scene's.
fn without_what_is_replaced(mut scene: Scene, settings: &Settings) -> Scene {
    let code = &mut scene.code;
    code.functions.take_if(|_| settings.functions.is_some());
    code.parameters.take_if(|_| settings.parameters.is_some());
    code.frames.take_if(|_| settings.frames.is_some());
    code.lock.retain(|_| settings.lock.is_none());
    code.payload.retain(|_| settings.payloads.is_none());
    code.append.retain(|_| settings.append.is_none());
    code.rename.retain(|_| settings.rename.is_none());
    scene
}

/// Files that were read.
#[derive(Default)]
struct Files {
    paths: Vec<String>,
}

impl Files {
    /// The bytes of the file that `name`, which stands at `span`, names from the folder of the user's Cargo.toml.
    fn read(&mut self, name: &str, span: Span) -> Result<Vec<u8>> {
        let wrong = |reason: &str| Error::new(span, format!("{name}: {reason}"));
        let root = env::var_os("CARGO_MANIFEST_DIR").map(PathBuf::from).unwrap_or_default();
        let path = root.join(name);
        let bytes = read_file(&path, MOST_BYTES).map_err(|error| match error.kind() {
            ErrorKind::NotFound => wrong("there is no such file, seen from the folder of Cargo.toml"),
            _ => wrong(&error.to_string()),
        })?;
        self.paths.push(path.into_os_string().into_string().map_err(|_| wrong("the path of the package is not UTF-8"))?);
        Ok(bytes)
    }
}
