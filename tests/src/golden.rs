//! Golden files: results that only change on purpose.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::{env, fs};

/// The command that writes them anew.
pub const RENEW: &str = "UPDATE_GOLDEN=1 cargo test -p articulated-tests --test golden";

/// Compares with `tests/golden/<name>`, or writes it if `UPDATE_GOLDEN` is set.
///
/// # Panics
/// If they differ; the message shows where, and how to renew.
pub fn check(name: &str, text: &str) {
    let path = folder().join(name);
    if env::var_os("UPDATE_GOLDEN").is_some() {
        fs::write(&path, text).expect("a folder that can be written");
        return;
    }
    let golden = fs::read_to_string(&path).unwrap_or_default();
    if golden != text {
        panic!("{name} is not what it was; renew it with `{RENEW}` if it should change.\n{}", difference(&golden, text));
    }
}

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("golden")
}

/// Lines that are in one and not in the other, the first twenty of each.
fn difference(old: &str, new: &str) -> String {
    let only = |sign: &str, here: &str, there: &str| {
        let there: BTreeSet<&str> = there.lines().collect();
        here.lines().filter(|l| !there.contains(l)).take(20).map(|l| format!("{sign} {l}\n")).collect::<String>()
    };
    only("-", old, new) + &only("+", new, old)
}
