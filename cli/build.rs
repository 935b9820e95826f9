//! The built commit: reports of measurements name it.
//!
//! `ARTICULATED_COMMIT` if it is set; else the commit recorded in a package; else git's, if this
//! folder is part of a checkout; else none. Builds without optimisation have no commit: they would
//! be rebuilt after every commit, and are not used for measurements.

use std::path::Path;
use std::process::Command;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-env-changed=ARTICULATED_COMMIT");
    // The variable reaches the compiler unchanged.
    if std::env::var_os("ARTICULATED_COMMIT").is_some() || std::env::var("PROFILE").as_deref() != Ok("release") {
        return;
    }
    if let Some(commit) = packaged().or_else(checked_out) {
        println!("cargo::rustc-env=ARTICULATED_COMMIT={commit}");
    }
}

/// `cargo package` leaves it in a file.
fn packaged() -> Option<String> {
    let text = std::fs::read_to_string(".cargo_vcs_info.json").ok()?;
    let commit = text.split('"').skip_while(|word| *word != "sha1").nth(2)?;
    is_commit(commit).then(|| short(commit))
}

fn checked_out() -> Option<String> {
    // A copy inside another repository is not part of it.
    git(&["ls-files", "--error-unmatch", "Cargo.toml"])?;
    let commit = git(&["rev-parse", "HEAD"])?;
    // Files that change with every commit and every change of branch. A missing path would cause a
    // run every time.
    let watched = ["HEAD", "logs/HEAD", "packed-refs"].map(str::to_owned).into_iter().chain(git(&["symbolic-ref", "--quiet", "HEAD"]));
    for path in watched.filter_map(|name| git(&["rev-parse", "--git-path", &name])).filter(|path| Path::new(path).exists()) {
        println!("cargo::rerun-if-changed={path}");
    }
    is_commit(&commit).then(|| short(&commit))
}

fn is_commit(text: &str) -> bool {
    text.len() >= 40 && text.bytes().all(|b| b.is_ascii_hexdigit())
}

fn short(commit: &str) -> String {
    commit[..12].to_owned()
}

/// The first line of git's output; `None` if git is missing or fails.
fn git(words: &[&str]) -> Option<String> {
    let output = Command::new("git").args(words).output().ok()?;
    let line = String::from_utf8(output.stdout).ok()?.lines().next()?.to_owned();
    output.status.success().then_some(line)
}
