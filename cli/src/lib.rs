//! The command `articulated`, as a library: arguments, loading and reports. Its measurements are in
//! the library `articulated_lab`.

mod arguments;
mod check;
mod command_line;
mod console;
mod diagnostic;
mod edits;
mod effects;
mod eval;
mod excerpt;
pub mod failure;
mod file_motion;
mod functions;
mod generate;
#[cfg_attr(not(feature = "measure"), path = "unmeasured.rs")]
mod measure;
mod named_scene;
mod names;
mod new;
mod output;
mod robot;
mod robot_scene;
mod rollout;
mod shape;
mod simulate;
mod touching;

use std::ffi::OsString;

use articulated_lab::json::json;
use articulated_lab::{ledger, parallel, states, table, tips};
use clap::Parser;

use arguments::Format;
use command_line::{Arguments, Command};
use failure::{Failure, OK, USAGE};

pub use simulate::in_process as scene;
pub use simulate::still;

/// Runs the command with these words, the program's own name first. The exit status: see
/// [`failure`].
pub fn run(words: impl IntoIterator<Item = OsString>) -> u8 {
    let words: Vec<OsString> = words.into_iter().collect();
    let arguments = match Arguments::try_parse_from(&words) {
        Ok(arguments) => arguments,
        Err(error) => {
            if !error.use_stderr() {
                return match console::print(&error.render().to_string()) {
                    Ok(()) => OK,
                    Err(failure) => {
                        console::failed(&failure);
                        failure.status
                    }
                };
            }
            match with_plain_words(&error.render().to_string(), &words) {
                Some(text) => console::refuse(&text),
                None => drop(error.print()),
            }
            let status = u8::try_from(error.exit_code()).unwrap_or(USAGE);
            if status == USAGE && asks_for_json(&words) {
                let _ = console::print(&json(&Failure::usage(sentence(&error.render().to_string()))));
            }
            return status;
        }
    };
    match dispatch(&arguments) {
        Ok(status) => status,
        Err(failure) => {
            console::failed(&failure);
            // Words of a refused command are not read.
            let is_json = arguments.format == Format::Json || failure.status == USAGE && asks_for_json(&words);
            if is_json && !failure.reported {
                // If the reader has closed the pipe, there is no one to report to.
                let _ = console::print(&json(&failure));
            }
            failure.status
        }
    }
}

/// A command's output, in both formats: from one run, so that they can be compared.
#[derive(Clone, Debug)]
pub struct Answer {
    /// The exit status: see [`failure`].
    pub status: u8,
    /// The report as text; empty if there is none.
    pub text: String,
    /// The report as JSON, or the errors if there is no report.
    pub json: String,
    /// A line for each error; empty if the status is 0.
    pub errors: Vec<String>,
    /// Warnings and notes, a line each.
    pub warnings: Vec<String>,
}

/// Runs the command with these words, starting with the program's name, and returns its output
/// instead of printing it. `--format` is ignored. Files that the words name are written.
///
/// # Errors
/// The parser's message about refused words.
pub fn answer(words: impl IntoIterator<Item = OsString>) -> Result<Answer, String> {
    let arguments = Arguments::try_parse_from(words).map_err(|error| error.render().to_string())?;
    let ((ended, reports), warnings) = articulated_lab::console::collect(|| console::capture(|| dispatch(&arguments)));
    let console::Reports { text, mut json } = reports;
    let (status, errors) = match ended {
        Ok(status) => (status, Vec::new()),
        Err(failure) => {
            if !failure.reported {
                json = crate::json(&failure);
            }
            (failure.status, failure.errors.into_iter().map(|error| error.message).collect())
        }
    };
    Ok(Answer { status, text, json, errors, warnings })
}

/// The error of the command line, with control characters in its words escaped; `None` if the words
/// have no such characters.
fn with_plain_words(text: &str, words: &[OsString]) -> Option<String> {
    let words: Vec<_> = words.iter().map(|word| word.to_string_lossy()).filter(|word| word.contains(table::is_obeyed)).collect();
    // The message contains only the value of a word such as `--option=value`.
    let values = words.iter().flat_map(|word| [Some(&**word), word.split_once('=').map(|(_, value)| value)]).flatten();
    (!words.is_empty()).then(|| values.fold(text.to_owned(), |text, word| text.replace(word, &table::plain(word))))
}

/// Whether unread words request JSON.
fn asks_for_json(words: &[OsString]) -> bool {
    words.iter().any(|word| word == "--format=json") || words.windows(2).any(|w| w[0] == "--format" && w[1] == "json")
}

/// The error of the command line, on one line and without the advice below it; a list under it is
/// included.
fn sentence(text: &str) -> String {
    let mut lines = text.lines().take_while(|line| !line.trim().is_empty()).map(str::trim);
    let first = lines.next().unwrap_or_default();
    let first = first.strip_prefix("error: ").unwrap_or(first);
    let rest = lines.collect::<Vec<_>>().join(if first.ends_with(':') { ", " } else { " " });
    if rest.is_empty() { first.to_owned() } else { format!("{first} {rest}") }
}

fn dispatch(arguments: &Arguments) -> Result<u8, Failure> {
    let format = arguments.format;
    match &arguments.command {
        Command::Check(a) => check::run(a, format),
        Command::Generate(a) => generate::run(a, format).map(|()| OK),
        Command::Eval(a) => eval::run(a, format),
        Command::Measure(a) => measure::run(a, format),
        Command::Functions(a) => functions::run(a, format).map(|()| OK),
        Command::Simulate(a) => simulate::run(a, format),
        Command::Rollout(a) => rollout::run(a, format),
        Command::New(a) => new::run(a, format).map(|()| OK),
        Command::Effects(a) => effects::run(a, format).map(|()| OK),
    }
}

#[cfg(test)]
mod tests {
    use super::{sentence, with_plain_words};

    #[test]
    fn words_of_the_command_line_end_no_lines() {
        let words = ["articulated", "--level=a\nb\u{202e}", "c\td"].map(Into::into);
        let told = with_plain_words("error: 'a\nb\u{202e}' and c\td\nUsage\n", &words);
        assert_eq!(told.as_deref(), Some("error: 'a\\nb\\u{202e}' and c\\td\nUsage\n"));
        assert_eq!(with_plain_words("error\n", &["check".into()]), None);
    }

    #[test]
    fn a_sentence_has_its_list_and_no_advice() {
        let missing = "error: these were not provided:\n  <ROBOT>\n  --function <NAMES>\n\nUsage: articulated eval\n";
        assert_eq!(sentence(missing), "these were not provided: <ROBOT>, --function <NAMES>");
        let odd = "error: invalid value 'x' for '--format'\n  [possible values: text, json]\n\n  tip: json\n";
        assert_eq!(sentence(odd), "invalid value 'x' for '--format' [possible values: text, json]");
        assert_eq!(sentence(""), "");
    }
}
