//! `articulated generate`.

use std::path::Path;

use articulated_codegen::{COptions, Generated, Options, Target, generate};
use serde::Serialize;

use crate::arguments::{Abi, Format, GenerateArguments, Language, types_of_batch};
use crate::console;
use crate::failure::Failure;
use crate::ledger::{Stage, stages};
use crate::output;
use crate::robot::Robot;

#[derive(Serialize)]
struct Report {
    source: String,
    files: Vec<File>,
    warnings: Vec<String>,
    snapped: Vec<String>,
    unused: Vec<String>,
    functions: Vec<Function>,
}

#[derive(Serialize)]
struct File {
    name: String,
    text: String,
}

#[derive(Serialize)]
struct Function {
    function: String,
    stages: Vec<Stage>,
    depth: u32,
}

/// Writes the source to its destination; in JSON the report is printed in any case.
pub(crate) fn run(arguments: &GenerateArguments, format: Format) -> Result<(), Failure> {
    types_of_batch(&arguments.batch)?;
    let robot = Robot::find(&arguments.robot)?.with(&arguments.frames);
    robot.keeps_its_files("--output", arguments.output.as_deref())?;
    match (arguments.language, arguments.output.as_deref()) {
        (Language::Rust, Some(path)) => output::file("--output", path)?,
        (Language::C, Some(path)) if is_header(path) => output::file("--output", path)?,
        (Language::C, Some(path)) => output::folder("--output", path)?,
        (_, None) => {}
    }
    let mut request = robot.whole_request(&crate::names::flat(&arguments.functions));
    if arguments.functions.is_empty() {
        request.options.functions.clone_from(&robot.options.functions);
    }
    // Missing options are the scene's, if there is one.
    if !arguments.parameters.is_empty() {
        request.options.parameters = arguments.parameters.iter().cloned().map(Into::into).collect();
    }
    if !arguments.batch.is_empty() {
        request.options.batch.clone_from(&arguments.batch);
    }
    request.options.limbs &= !arguments.no_limbs;
    request.options.level = arguments.level.unwrap_or(request.options.level);
    target(arguments, &mut request.options)?;
    let generated = generate(&request)?;
    robot.warn_of(generated.warnings.iter().chain(&generated.snapped));
    if let Some(path) = &arguments.output {
        write(arguments.language, path, &generated)?;
    }
    if format == Format::Text && arguments.output.is_some() {
        return Ok(());
    }
    console::report(format, || generated.files.iter().map(|file| file.text.as_str()).collect(), || json(&generated))
}

/// The target language with its options. Errors: options of the other language, from the command
/// line or the scene.
fn target(arguments: &GenerateArguments, options: &mut Options) -> Result<(), Failure> {
    if arguments.language == Language::Rust {
        let rust = options.rust_mut();
        rust.forbid_unsafe |= arguments.forbid_unsafe;
        rust.no_std = arguments.no_std;
        rust.runtime = arguments.runtime.clone().filter(|_| !arguments.standalone);
        let of_c = [
            arguments.prefix.as_ref().map(|prefix| format!("prefix {prefix}")),
            arguments.abi.map(|_| "abi casadi".to_owned()),
            arguments.no_libm.then(|| "no-libm".to_owned()),
        ];
        let refuse = |given| Err(Failure::usage(format!("--{given}: expected --language c beside it, or no --{given}")));
        return of_c.into_iter().flatten().next().map_or(Ok(()), refuse);
    }
    let of_rust = [
        ("--standalone", arguments.standalone),
        ("--forbid-unsafe", arguments.forbid_unsafe),
        ("--no-std", arguments.no_std),
        ("--runtime", arguments.runtime.is_some()),
    ];
    let found: Vec<&str> = of_rust.into_iter().filter_map(|(name, is_there)| is_there.then_some(name)).collect();
    if !found.is_empty() {
        return Err(Failure::usage(format!("--language c: found {}, which are for Rust alone", found.join(", "))));
    }
    let casadi = arguments.abi == Some(Abi::Casadi);
    let header_only = arguments.output.as_deref().map_or(!casadi, is_header);
    options.target = Target::C(COptions {
        prefix: arguments.prefix.clone(),
        header_only,
        casadi,
        derivatives: arguments.derivatives,
        no_libm: arguments.no_libm,
    });
    Ok(())
}

/// Whether C is written to one header, instead of a header and a source in a folder.
fn is_header(path: &Path) -> bool {
    path.extension().is_some_and(|e| e == "h" || e == "hpp")
}

/// Writes the file, or all files into a folder.
fn write(language: Language, path: &Path, generated: &Generated) -> Result<(), Failure> {
    if language == Language::Rust || is_header(path) {
        return output::write(path, &generated.source);
    }
    output::folder("--output", path)?;
    generated.files.iter().try_for_each(|file| output::write(&path.join(&file.name), &file.text))
}

fn json(generated: &Generated) -> String {
    let lines = |problems: &[articulated_core::diagnostic::Diagnostic]| problems.iter().map(ToString::to_string).collect();
    let function = |e: &articulated_codegen::ledger::Entry| Function { function: e.function.clone(), stages: stages(e), depth: e.depth };
    crate::json(&Report {
        source: generated.source.clone(),
        files: generated.files.iter().map(|file| File { name: file.name.clone(), text: file.text.clone() }).collect(),
        warnings: lines(&generated.warnings),
        snapped: lines(&generated.snapped),
        unused: generated.unused.iter().map(ToString::to_string).collect(),
        functions: generated.ledger.functions.iter().map(function).collect(),
    })
}
