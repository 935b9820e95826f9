//! What tells the command to end before it is done: Ctrl-C, or a signal.

use crate::failure::INTERRUPTED;

/// Calls `end` with the exit status, in a thread of its own, once the command is told to end. A signal that is ignored from the start, as by `nohup` or in a script's background, stays
/// ignored. Where nothing can be watched, an interrupted command leaves its folders behind, and nothing else is amiss.
#[cfg(unix)]
pub(crate) fn watch(end: fn(i32)) {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGQUIT, SIGTERM};
    let heard = [SIGINT, SIGQUIT, SIGTERM, SIGHUP].into_iter().filter(|signal| !is_ignored(*signal));
    let Ok(mut signals) = signal_hook::iterator::Signals::new(heard) else { return };
    std::thread::spawn(move || signals.forever().next().into_iter().for_each(|signal| end(i32::from(INTERRUPTED) - SIGINT + signal)));
}

/// Whether who started the command has it ignore a signal, as far as the system tells.
#[cfg(unix)]
fn is_ignored(signal: i32) -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| u64::from_str_radix(line.strip_prefix("SigIgn:")?.trim(), 16).ok());
    mask.is_some_and(|mask| mask >> (signal - 1) & 1 == 1)
}

#[cfg(not(unix))]
pub(crate) fn watch(end: fn(i32)) {
    // Ctrl-C is all that there is.
    drop(ctrlc::set_handler(move || end(INTERRUPTED.into())));
}
