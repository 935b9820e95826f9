//! From an invocation to a module.

use std::collections::BTreeMap;
use std::env;
use std::path::{Path, PathBuf};

use articulated_codegen::diagnostic::{At, Code, Diagnostic, Diagnostics, Span, summary};
use articulated_codegen::scene::articulated_scene::{Loader, Robot, Scene, beside, folder_of};
use articulated_codegen::{FunctionSpec, Generated, Request, scene};
use proc_macro2::{Delimiter, Group, Span as Word, TokenStream, TokenTree};
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
    let contents = contents(&settings, module.span, &mut errors);
    let errors = errors.into_items();
    let doc = "\n\nThe module has the functions that its invocation lists. To get another function of `articulated::algorithm`, add it to `functions`.";
    // Style lints are for handwritten code. First, so that the user's attributes override it.
    let allow = quote! { #[allow(clippy::all, clippy::pedantic, clippy::nursery, clippy::restriction)] };
    quote! { #allow #(#attributes)* #[doc = #doc] #visibility #module #name { #errors #contents } }
}

/// The generated source and a mention of every file, by which the compiler knows that the module
/// depends on them.
fn contents(settings: &Settings, module: Word, errors: &mut Errors) -> TokenStream {
    let mut reader = Reader { settings, log: Diagnostics::default(), loader: loader() };
    let (scene, request) = reader.request();
    let Reader { mut log, loader, .. } = reader;
    let source = request.map(|request| source(&request, &scene, settings, module, &mut log));
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

/// The generated source; empty if there are errors, which are all reported.
fn source(request: &Request, scene: &Scene, settings: &Settings, module: Word, log: &mut Diagnostics) -> TokenStream {
    match articulated_codegen::generate(request) {
        Ok(generated) => {
            let code = Words { module, functions: settings.functions(scene) }.place(generated.tokens(), true);
            let warnings = warnings(&generated, settings.places.span(settings.at_robot(scene)));
            quote! { #code #warnings }
        }
        Err(findings) => {
            log.take(findings);
            TokenStream::new()
        }
    }
}

/// Items of which the compiler warns, one for each sort of warning: a macro has no other way to
/// warn. `#[allow(deprecated)]` on the module silences them.
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
    /// The scene with its keys replaced by those of the invocation, and the request. No request if
    /// a file is missing or the scene is wrong.
    fn request(&mut self) -> (Scene, Option<Request>) {
        let settings = self.settings;
        let folder = folder_of(settings.macro_keys.scene.as_ref().map_or("", |(name, _)| name).as_ref());
        let from_file = match &settings.macro_keys.scene {
            Some((name, at)) => self.loader.scene(name.as_ref(), &Span { file: name.clone(), at: *at }, &mut self.log),
            None => Some(Scene::default()),
        };
        let is_read = from_file.is_some();
        let is_whole = from_file.as_ref().is_some_and(|scene| scene.left_out.is_empty());
        let (scene, wrong) = from_file.unwrap_or_default().overlaid(&settings.rest, &Settings::own_names());
        self.log.extend(wrong);
        let mut options = settings.macro_keys.options();
        scene::fill(&mut options, &scene);
        if !is_read {
            return (scene, None);
        }
        let robot = self.robot(folder, &scene);
        let appended = self.loader.append(folder, &mut options.robot, &mut self.log);
        options.robot.included = self.loader.included.clone();
        let is_complete = robot.is_some() && appended;
        let (file, document) = robot.unwrap_or_default();
        let request = Request { document, file, scene: Some(scene.clone()), options };
        if !is_complete || !is_whole {
            // Other errors of the invocation; without the robot only those of its words.
            scene::check_rest(&request, is_complete, &mut self.log);
        }
        (scene, (is_complete && is_whole).then_some(request))
    }

    /// The name of the robot's file and its bytes.
    fn robot(&mut self, folder: &Path, scene: &Scene) -> Option<(String, Vec<u8>)> {
        let settings = self.settings;
        if scene.robot != Robot::Given {
            return self.loader.robot(folder, scene, &mut self.log).map(|(file, document, _)| (file, document));
        }
        // A value that is wrong is reported already.
        if !settings.has("urdf") && !settings.has("file") && !scene.doubts_robot() {
            self.log.push(match &settings.macro_keys.scene {
                Some(_) => scene.without_robot("no robot", "urdf, here or in the scene"),
                None if settings.has("scene") => return None,
                None => Diagnostic::error(
                    "",
                    (At::Nowhere, "urdf"),
                    Code::MissingKey,
                    "nothing",
                    "the path of a robot file from the folder of Cargo.toml, as \"robots/arm.urdf\", here or in a `scene`",
                ),
            });
        }
        None
    }
}

/// Where editors find the definitions of generated names.
struct Words {
    /// The word `mod`. (At the module's name, editors would show all definitions as its meaning.)
    module: Word,
    /// The words that name the functions.
    functions: BTreeMap<String, Word>,
}

impl Words {
    /// The word for a name after a keyword; `None` if the keyword defines nothing.
    fn of(&self, keyword: &str, name: &str) -> Option<Word> {
        let form = |end: &str| self.functions.get(name.strip_suffix(end)?);
        match keyword {
            "fn" => Some(*form("").or_else(|| form("_into")).or_else(|| form("_blocks")).unwrap_or(&self.module)),
            "const" | "mod" | "struct" => Some(self.module),
            _ => None,
        }
    }

    /// The code with its public names at their words. Private names keep their spans, which lead
    /// editors nowhere.
    fn place(&self, code: TokenStream, is_public: bool) -> TokenStream {
        let mut last: [String; 3] = Default::default();
        let placed = code.into_iter().map(|mut token| {
            let mut word = None;
            match &token {
                TokenTree::Group(group) if last[1] == "mod" && group.delimiter() == Delimiter::Brace => {
                    token = Group::new(Delimiter::Brace, self.place(group.stream(), last[0] == "pub")).into();
                }
                TokenTree::Ident(ident) => {
                    last.rotate_left(1);
                    last[2] = ident.to_string();
                    word = self.of(&last[1], &last[2]);
                }
                _ => {}
            }
            if is_public {
                // The name stays the macro's, and lints see a macro's code.
                token.set_span(word.map_or(Word::call_site(), |word| Word::call_site().located_at(word)));
            }
            token
        });
        placed.collect()
    }
}

impl Settings {
    /// The words that name the functions.
    fn functions(&self, scene: &Scene) -> BTreeMap<String, Word> {
        let entries = scene.code.functions.iter().flatten().zip(&scene.code.places.functions);
        let specs = entries.filter_map(|(entry, at)| Some((FunctionSpec::parse(entry).ok()?.name, self.places.span(*at))));
        specs.collect()
    }

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
