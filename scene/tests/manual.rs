//! The tables of `docs/scenes.md` and `docs/effects.md` are those that scenes are read by.
//! `UPDATE_DOCS=1 cargo test -p articulated-scene --test manual` writes them anew.

use std::fs;

const FILES: [&str; 2] = ["../docs/scenes.md", "../docs/effects.md"];

fn text(file: &str) -> String {
    fs::read_to_string(file).unwrap()
}

#[test]
fn the_manual_has_every_key() {
    let mut tables = articulated_scene::manual::tables();
    for file in FILES {
        let text = text(file);
        let mut renewed = text.clone();
        tables.retain(|(name, table)| {
            let (begin, end) = (format!("<!-- {name} -->\n"), "<!-- end -->");
            let Some(at) = renewed.find(&begin) else { return true };
            let from = at + begin.len();
            let to = from + renewed[from..].find(end).unwrap_or_else(|| panic!("table {name} has no end"));
            renewed.replace_range(from..to, &format!("{table}\n"));
            false
        });
        if std::env::var_os("UPDATE_DOCS").is_some() {
            fs::write(file, &renewed).unwrap();
        } else {
            assert!(renewed == text, "{file} is out of date: UPDATE_DOCS=1 cargo test -p articulated-scene --test manual");
        }
    }
    let missing: Vec<&str> = tables.iter().map(|(name, _)| *name).collect();
    assert!(missing.is_empty(), "no page has the tables {missing:?}");
}

/// The page of the macro has all keys that concern the code.
#[test]
fn the_page_of_the_macro_has_every_key_of_a_scene() {
    let page = text("../docs/macro.md");
    let of_motion = ["summary", "robot", "simulation", "initial", "control", "impact"];
    let tables = articulated_scene::manual::tables();
    let (_, top) = tables.iter().find(|(name, _)| *name == "top").unwrap();
    let keys: Vec<&str> = top.lines().filter_map(|line| line.strip_prefix("| `")?.split('`').next()).collect();
    assert!(keys.len() > 20);
    for key in keys.into_iter().filter(|key| !of_motion.contains(key)) {
        assert!(page.contains(&format!("\n| `{key} = ")), "docs/macro.md has no row for {key}");
    }
}

/// Examples of the manual are readable.
#[test]
fn examples_of_the_manual_are_scenes() {
    let text = FILES.map(text).concat();
    let examples: Vec<&str> = text.split("```toml\n").skip(1).filter_map(|rest| rest.split("```").next()).collect();
    assert!(examples.len() >= 4);
    for example in examples {
        articulated_scene::Scene::read("example", example).unwrap_or_else(|errors| panic!("{errors}\n{example}"));
    }
}

/// The manual also documents the range of each number.
#[test]
fn the_manual_says_where_numbers_have_to_be() {
    let headers = [
        ("top", ""),
        ("payload", "payload"),
        ("shaft", "effects.shaft.x"),
        ("simulation", "simulation"),
        ("control", "control"),
        ("impact", "impact"),
    ];
    let mut bounded = 0;
    for (name, table) in articulated_scene::manual::tables() {
        let Some((_, header)) = headers.iter().find(|(table, _)| *table == name) else { continue };
        for line in table.lines() {
            let cells: Vec<&str> = line.split(" | ").collect();
            let [key, value, _, what] = cells[..] else { continue };
            if !value.starts_with("number") || value.starts_with("numbers") {
                continue;
            }
            let key = key.trim_matches(['|', ' ', '`']);
            let text = if header.is_empty() { format!("{key} = nan") } else { format!("[{header}]\n{key} = nan") };
            let errors = articulated_scene::Scene::read("s", &text).unwrap_err().errors;
            let error =
                errors.iter().find(|e| e.field == format!("{header}.{key}").trim_start_matches('.')).unwrap_or_else(|| panic!("{text}"));
            let bounds = error.expected.trim_end_matches(", s").trim_start_matches("a finite number").trim_start_matches([',', ' ']);
            assert!(what.contains(bounds), "{text}: {} is not in {what}", error.expected);
            bounded += usize::from(!bounds.is_empty());
        }
    }
    assert!(bounded >= 15, "{bounded}");
}
