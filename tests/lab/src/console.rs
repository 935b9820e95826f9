//! Console output: lines on the two streams, and progress on a terminal.

use std::cell::RefCell;
use std::io::{self, ErrorKind, IsTerminal, Write};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::Duration;

use crate::table::{escaped, is_obeyed, plain};

/// Writes to the standard output. A closed pipe is not an error.
pub fn print(text: &str) -> io::Result<()> {
    let mut out = io::stdout().lock();
    match out.write_all(harmless(text).as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(error),
        _ => Ok(()),
    }
}

/// A line `warning: …` on the standard error stream.
pub fn warn(text: &str) {
    say("warning", "33", &plain(text));
}

/// A line `note: …` on the standard error stream.
pub fn note(text: &str) {
    say("note", "36", &plain(text));
}

/// A line `error: …` on the standard error stream.
pub fn error(text: &str) {
    say("error", "31", &plain(text));
}

/// The same, for a tool's message of several lines.
pub fn error_of_tool(text: &str) {
    say("error", "31", text);
}

/// The error of the command line, unchanged.
pub fn refuse(text: &str) {
    let _ = io::stderr().lock().write_all(harmless(text).as_bytes());
}

thread_local! {
    /// Where this thread's lines go instead of the standard error stream.
    static COLLECTED: RefCell<Option<Vec<String>>> = const { RefCell::new(None) };
}

/// Runs, and returns the warnings and notes that this thread would have written meanwhile, without
/// their level. For programs that are not a command.
pub fn collect<T>(run: impl FnOnce() -> T) -> (T, Vec<String>) {
    let before = COLLECTED.replace(Some(Vec::new()));
    let out = run();
    (out, COLLECTED.replace(before).unwrap_or_default())
}

/// Whether a line was collected.
fn is_collected(text: &str) -> bool {
    COLLECTED.with_borrow_mut(|lines| lines.as_mut().map(|lines| lines.push(text.to_owned())).is_some())
}

fn say(level: &str, colour: &str, text: &str) {
    if is_collected(text) {
        return;
    }
    let mut stream = io::stderr().lock();
    let coloured = stream.is_terminal() && std::env::var_os("NO_COLOR").is_none();
    let level = if coloured { format!("\x1b[1;{colour}m{level}\x1b[0m") } else { level.to_owned() };
    let _ = writeln!(stream, "{level}: {}", harmless(text));
}

/// A text without control characters, which names of files and robots may contain. Ends of lines
/// and tabs stay.
pub fn harmless(text: &str) -> String {
    escaped(text, |c| !matches!(c, '\n' | '\t') && is_obeyed(c))
}

/// A bar on the standard error stream, if that is a terminal; it goes away when dropped.
#[derive(Debug)]
pub struct Progress {
    shown: Option<(Arc<Mutex<Bar>>, JoinHandle<()>)>,
}

/// Contents of a bar.
#[derive(Debug, Default)]
struct Bar {
    message: String,
    done: u64,
    steps: u64,
    /// Whether parts are shown in percent instead of counts.
    whole: bool,
    turns: usize,
    over: bool,
}

/// Between two drawings of a bar.
const TICK: Duration = Duration::from_millis(200);

/// How many characters a full bar has.
const BAR: usize = 30;

impl Bar {
    fn line(&self) -> String {
        let turn = ['|', '/', '-', '\\'][self.turns % 4];
        let full = (BAR as u64 * self.done / self.steps.max(1)) as usize;
        let bar: String = (0..BAR).map(|k| if k < full { '█' } else { '░' }).collect();
        let end = if self.whole { format!("{} %", 100 * self.done / self.steps.max(1)) } else { format!("{}/{}", self.done, self.steps) };
        format!("{turn} {} {bar} {end}", plain(&self.message))
    }
}

impl Progress {
    /// For this many steps.
    pub fn new(steps: usize) -> Self {
        Self::start(Bar { steps: steps as u64, ..Bar::default() })
    }

    /// For a whole whose parts get done.
    pub fn of_whole(what: String) -> Self {
        Self::start(Bar { message: what, steps: 1000, whole: true, ..Bar::default() })
    }

    /// For work that another bar shows.
    pub fn hidden() -> Self {
        Self { shown: None }
    }

    fn start(bar: Bar) -> Self {
        if !io::stderr().is_terminal() {
            return Self::hidden();
        }
        let bar = Arc::new(Mutex::new(bar));
        let seen = Arc::clone(&bar);
        let drawing = move || {
            loop {
                let Ok(mut bar) = seen.lock() else { return };
                if bar.over {
                    return;
                }
                bar.turns += 1;
                // Cut where the terminal ends, and drawn over again.
                let _ = write!(io::stderr().lock(), "\r\x1b[K\x1b[?7l{}\x1b[?7h", bar.line());
                drop(bar);
                thread::park_timeout(TICK);
            }
        };
        Self { shown: thread::Builder::new().spawn(drawing).ok().map(|thread| (bar, thread)) }
    }

    fn change(&self, what: impl FnOnce(&mut Bar)) {
        if let Some((bar, _)) = &self.shown {
            what(&mut bar.lock().unwrap_or_else(PoisonError::into_inner));
        }
    }

    /// This part of the whole is done, from 0 to 1.
    pub fn at(&self, part: f64) {
        self.change(|bar| bar.done = (part.clamp(0.0, 1.0) * 1000.0) as u64);
    }

    /// The current work.
    pub fn doing(&self, what: String) {
        self.change(|bar| bar.message = what);
    }

    /// A warning above the bar.
    pub fn warn(&self, text: &str) {
        let _still = self.shown.as_ref().map(|(bar, _)| {
            let still = bar.lock();
            clear();
            still
        });
        warn(text);
    }

    /// One more step is done.
    pub fn step(&self) {
        self.change(|bar| bar.done += 1);
    }
}

/// Removes the line that the bar is in.
fn clear() {
    let _ = write!(io::stderr().lock(), "\r\x1b[K");
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.change(|bar| bar.over = true);
        if let Some((_, thread)) = self.shown.take() {
            thread.thread().unpark();
            let _ = thread.join();
            clear();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Bar, collect, harmless, warn};

    #[test]
    fn lines_of_a_program_are_collected() {
        assert_eq!(collect(|| warn("a\nb")), ((), vec!["a\\nb".to_owned()]));
        assert_eq!(collect(|| collect(|| warn("inner")).1.len()), (1, vec![]));
    }

    #[test]
    fn what_moves_the_cursor_or_turns_the_direction_is_escaped() {
        assert_eq!(harmless("a\u{9b}31m\u{1b}[2J\u{202e}é\r\nб"), "a\\u{9b}31m\\u{1b}[2J\\u{202e}é\\r\nб");
    }

    #[test]
    fn a_bar_shows_its_part() {
        let bar = Bar { message: "mass_matrix\n".into(), done: 1, steps: 2, ..Bar::default() };
        assert_eq!(bar.line(), format!("| mass_matrix\\n {}{} 1/2", "█".repeat(15), "░".repeat(15)));
        assert!(Bar { done: 0, steps: 0, whole: true, ..Bar::default() }.line().ends_with(" 0 %"));
    }
}
