//! The machine that generated programs are compiled for and run on: this one, or a 64-bit Arm that
//! is emulated (`tests/arm.sh`).

use std::path::Path;
use std::process::Command;

/// Set, programs are for the emulated machine; it names the emulator.
const EMULATOR: &str = "ARTICULATED_ARM_EMULATOR";

fn emulator() -> Option<std::ffi::OsString> {
    std::env::var_os(EMULATOR)
}

/// Whether it is a 64-bit Arm.
pub fn is_arm() -> bool {
    cfg!(target_arch = "aarch64") || emulator().is_some()
}

/// Whether it has vector instructions of x86-64.
pub fn is_x86_64() -> bool {
    cfg!(target_arch = "x86_64") && emulator().is_none()
}

/// A compiler with these flags; its output for another machine needs no linker and no library of
/// that machine.
pub(crate) fn compiler(flags: &[&str]) -> Command {
    let mut command = Command::new(std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into()));
    if emulator().is_none() {
        command.args(flags);
        return command;
    }
    command.args(["--target", "aarch64-unknown-linux-musl", "-C", "linker=rust-lld"]);
    let pairs = flags.iter().copied().filter(|flag| *flag != "-C");
    pairs.filter(|flag| *flag != "target-cpu=native").for_each(|flag| {
        command.args((!flag.starts_with('-')).then_some("-C")).arg(flag);
    });
    command
}

/// The command that runs a program.
pub(crate) fn run(program: &Path) -> Command {
    match emulator() {
        Some(emulator) => {
            let mut command = Command::new(emulator);
            command.arg(program);
            command
        }
        None => Command::new(program),
    }
}
