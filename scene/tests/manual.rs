//! The tables of `docs/scenes.md` are those that scenes are read by. `UPDATE_DOCS=1 cargo test -p articulated-scene --test manual` writes them anew.

use std::fs;

const FILE: &str = "../docs/scenes.md";

#[test]
fn the_manual_has_every_key() {
    let text = fs::read_to_string(FILE).unwrap();
    let mut renewed = text.clone();
    for (name, table) in articulated_scene::manual::tables() {
        let (begin, end) = (format!("<!-- {name} -->\n"), "<!-- end -->");
        let from = renewed.find(&begin).unwrap_or_else(|| panic!("no table {name}")) + begin.len();
        let to = from + renewed[from..].find(end).unwrap_or_else(|| panic!("table {name} has no end"));
        renewed.replace_range(from..to, &format!("{table}\n"));
    }
    if std::env::var_os("UPDATE_DOCS").is_some() {
        fs::write(FILE, &renewed).unwrap();
    } else {
        assert!(renewed == text, "{FILE} is out of date: UPDATE_DOCS=1 cargo test -p articulated-scene --test manual");
    }
}

/// What the manual shows reads.
#[test]
fn examples_of_the_manual_are_scenes() {
    let text = fs::read_to_string(FILE).unwrap();
    let examples: Vec<&str> = text.split("```toml\n").skip(1).filter_map(|rest| rest.split("```").next()).collect();
    assert!(examples.len() >= 4);
    for example in examples {
        articulated_scene::Scene::read("example", example).unwrap_or_else(|errors| panic!("{errors}\n{example}"));
    }
}
