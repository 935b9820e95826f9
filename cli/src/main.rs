//! The command `articulated`.

use std::process::ExitCode;

fn main() -> ExitCode {
    articulated_cli::run(std::env::args_os()).into()
}
