//! What people see: lines on the two streams, and progress where somebody watches.

use std::io::{ErrorKind, IsTerminal, Write};
use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};

use crate::failure::Failure;
use crate::table::{escaped, is_obeyed, plain};

/// Writes to the standard output. A reader that has gone away is not an error.
pub(crate) fn print(text: &str) -> Result<(), Failure> {
    let mut out = std::io::stdout().lock();
    match out.write_all(harmless(text).as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(Failure::input([format!("standard output: {error}")])),
        _ => Ok(()),
    }
}

/// A line `warning: …` on the standard error stream.
pub(crate) fn warn(text: &str) {
    say("warning", "33", &plain(text));
}

/// A line `note: …` on the standard error stream.
pub(crate) fn note(text: &str) {
    say("note", "36", &plain(text));
}

/// A line `error: …` on the standard error stream.
pub(crate) fn error(text: &str) {
    say("error", "31", &plain(text));
}

/// The same, of what a tool has said in several lines.
pub(crate) fn error_of_tool(text: &str) {
    say("error", "31", text);
}

/// Each error of a failure.
pub(crate) fn failed(failure: &Failure) {
    let line = if failure.is_of_tool() { error_of_tool } else { error };
    failure.messages().for_each(line);
}

/// What is wrong with the command line, as it is.
pub(crate) fn refuse(text: &str) {
    let _ = std::io::stderr().lock().write_all(harmless(text).as_bytes());
}

fn say(level: &str, colour: &str, text: &str) {
    let mut stream = std::io::stderr().lock();
    let coloured = stream.is_terminal() && std::env::var_os("NO_COLOR").is_none();
    let level = if coloured { format!("\x1b[1;{colour}m{level}\x1b[0m") } else { level.to_owned() };
    let _ = writeln!(stream, "{level}: {}", harmless(text));
}

/// A text without what a terminal would obey: names of files and robots may have such characters.
/// Ends of lines and tabs stay.
pub(crate) fn harmless(text: &str) -> String {
    escaped(text, |c| !matches!(c, '\n' | '\t') && is_obeyed(c))
}

/// A bar on the standard error stream, if that is a terminal; it goes away when dropped.
pub(crate) struct Progress(ProgressBar);

impl Progress {
    /// For this many steps.
    pub(crate) fn new(steps: usize) -> Self {
        let bar = ProgressBar::new(steps as u64);
        if let Ok(style) = ProgressStyle::with_template("{spinner} {msg} {wide_bar} {pos}/{len}") {
            bar.set_style(style);
        }
        bar.enable_steady_tick(Duration::from_millis(200));
        Self(bar)
    }

    /// For something whole, of which parts get done.
    pub(crate) fn of_whole(what: String) -> Self {
        let bar = Self::new(1000);
        if let Ok(style) = ProgressStyle::with_template("{spinner} {msg} {wide_bar} {percent} %") {
            bar.0.set_style(style);
        }
        bar.doing(what);
        bar
    }

    /// For what another bar tells of.
    pub(crate) fn hidden() -> Self {
        Self(ProgressBar::hidden())
    }

    /// This part of the whole is done, from 0 to 1.
    pub(crate) fn at(&self, part: f64) {
        self.0.set_position((part.clamp(0.0, 1.0) * 1000.0) as u64);
    }

    /// What is being done now.
    pub(crate) fn doing(&self, what: String) {
        self.0.set_message(what);
    }

    /// A warning above the bar.
    pub(crate) fn warn(&self, text: &str) {
        self.0.suspend(|| warn(text));
    }

    /// One more step is done.
    pub(crate) fn step(&self) {
        self.0.inc(1);
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.0.finish_and_clear();
    }
}

#[cfg(test)]
mod tests {
    use super::harmless;

    #[test]
    fn what_moves_the_cursor_or_turns_the_direction_is_escaped() {
        assert_eq!(harmless("a\u{9b}31m\u{1b}[2J\u{202e}é\r\nб"), "a\\u{9b}31m\\u{1b}[2J\\u{202e}é\\r\nб");
    }
}
