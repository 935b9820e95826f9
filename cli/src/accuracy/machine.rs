//! Where and with what something was measured.

/// The commit that this command was built from; see `build.rs`.
pub(super) const COMMIT: &str = match option_env!("ARTICULATED_COMMIT") {
    Some(commit) => commit,
    None => "commit not told when this was built",
};

/// The processor's name for itself.
pub(super) fn processor() -> String {
    let told = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let name = told.lines().find_map(|l| l.strip_prefix("model name")?.split_once(": ").map(|(_, name)| name.to_owned()));
    name.unwrap_or_else(|| std::env::consts::ARCH.to_owned())
}
