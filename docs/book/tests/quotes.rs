//! Blocks of the book that quote a file, or generated code, quote it verbatim.
//!
//! A quotation is a code block after a line `<!-- quote: path from the repository's root -->` or
//! `<!-- generated: robot function -->`. Indentation and blank lines are free; `…` on a line of its
//! own leaves lines out.
//!
//! A line `<!-- player: scene -->` or `<!-- sliders: robot -->` asks `docs/book/build.py` for a
//! motion, or for sliders; the scene or the robot is bundled.

use std::path::Path;

use articulated_codegen::{Base, Request, generate};

/// The lines of a text, without indentation and without blank ones.
fn lines(text: &str) -> Vec<&str> {
    text.lines().map(str::trim).filter(|line| !line.is_empty()).collect()
}

/// The source that the command writes for one function of a bundled robot.
fn generated(robot: &str, function: &str) -> String {
    let bundled = articulated_models::robot(robot).unwrap_or_else(|| panic!("no robot {robot}"));
    let mut request = Request::new(format!("{robot}.urdf"), bundled.urdf);
    request.options.robot.base = if bundled.base == Base::Floating { Base::Floating } else { Base::Fixed };
    request.options.functions = vec![function.to_owned().into()];
    generate(&request).expect("a robot").source
}

/// What is wrong with one quotation, if anything.
fn check(kind: &str, what: &str, block: &str) -> Result<(), String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let text = match (kind, what.split_once(' ')) {
        ("quote", _) => std::fs::read_to_string(root.join(what)).map_err(|e| format!("{what}: {e}"))?,
        ("generated", Some((robot, function))) => generated(robot, function),
        _ => return Err(format!("not a quotation: {kind}: {what}")),
    };
    let source = lines(&text);
    let mut from = 0;
    for part in lines(block).split(|line| *line == "…").filter(|part| !part.is_empty()) {
        let at = (from..source.len()).find(|&at| source[at..].starts_with(part));
        from = at.ok_or_else(|| format!("{what} does not contain, in this order:\n{}", part.join("\n")))? + part.len();
    }
    Ok(())
}

#[test]
fn quotations_are_what_the_files_say() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let (mut count, mut wrong) = (0, Vec::new());
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|e| e != "md") {
            continue;
        }
        let text = std::fs::read_to_string(&path).unwrap();
        let mut rest = text.as_str();
        while let Some((_, after)) = rest.split_once("<!-- ") {
            let (comment, after) = after.split_once(" -->").expect("a comment ends");
            rest = after;
            let Some((kind, what)) = comment.split_once(": ") else { continue };
            let bundled = match kind {
                "player" => Some(articulated_models::scene(what).is_some()),
                "sliders" => Some(articulated_models::robot(what).is_some()),
                _ => None,
            };
            if let Some(found) = bundled {
                wrong.extend((!found).then(|| format!("{}: {kind} of {what}, which is not bundled", path.display())));
                continue;
            }
            let block = after.split("```").nth(1).and_then(|b| b.split_once('\n')).expect("a block follows").1;
            count += 1;
            wrong.extend(check(kind, what, block).err().map(|e| format!("{}: {e}", path.display())));
        }
    }
    assert!(count > 5, "{count} quotations found");
    assert!(wrong.is_empty(), "{}", wrong.join("\n\n"));
}

/// Every chapter is in the table of contents and among the tests, and no page links to a missing
/// one.
#[test]
fn every_page_is_listed_tested_and_linked() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    let summary = std::fs::read_to_string(folder.join("src/SUMMARY.md")).unwrap();
    let tests = std::fs::read_to_string(folder.join("code/lib.rs")).unwrap();
    for entry in std::fs::read_dir(folder.join("src")).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_str().unwrap().to_owned();
        if !name.ends_with(".md") {
            continue;
        }
        let text = std::fs::read_to_string(&path).unwrap();
        if name != "SUMMARY.md" {
            assert!(summary.contains(&format!("({name})")), "{name} is not in SUMMARY.md");
            assert!(tests.contains(&format!("\"{name}\"")), "{name} is not among the tests");
        }
        for target in text.split("](").skip(1).filter_map(|t| t.split_once(')')).map(|(t, _)| t) {
            let file = target.split('#').next().unwrap();
            assert!(target.starts_with("http") || file.is_empty() || folder.join("src").join(file).exists(), "{name}: no {target}");
        }
    }
}
