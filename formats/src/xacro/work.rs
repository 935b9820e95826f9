//! References of expressions, and the bounds of their work.

use super::value::{Fault, Result, Value, wrong};

/// Bounds of all expressions together: steps of evaluation, and bytes of texts and lists.
const MOST_STEPS: usize = 4 << 20;
const MOST_BYTES: usize = 64 << 20;
/// Evaluations inside evaluations: levels of expressions, and of properties that refer to others.
const MOST_DEPTH: usize = 200;

/// The work that expressions have taken.
#[derive(Default)]
pub(super) struct Work {
    steps: usize,
    bytes: usize,
    depth: usize,
}

impl Work {
    pub(super) fn steps(&mut self, count: usize) -> Result<()> {
        self.steps = self.steps.saturating_add(count);
        if self.steps > MOST_STEPS { Err(Fault::TooLarge { found: "very many steps of evaluation", most: MOST_STEPS }) } else { Ok(()) }
    }

    pub(super) fn bytes(&mut self, count: usize) -> Result<()> {
        self.bytes = self.bytes.saturating_add(count);
        if self.bytes > MOST_BYTES { Err(Fault::TooLarge { found: "very long texts and lists", most: MOST_BYTES }) } else { Ok(()) }
    }

    /// Enters a level; [`Self::leave`] leaves it.
    pub(super) fn enter(&mut self) -> Result<()> {
        self.steps(1)?;
        if self.depth >= MOST_DEPTH {
            return wrong("expressions and properties nested very deeply", format!("at most {MOST_DEPTH} levels"));
        }
        self.depth += 1;
        Ok(())
    }

    pub(super) fn leave(&mut self) {
        self.depth -= 1;
    }
}

/// References of an expression.
pub(super) trait Names {
    /// A property.
    fn property(&mut self, name: &str) -> Result<Option<Value>>;

    /// Names of properties, for suggestions.
    fn suggestion(&mut self, name: &str) -> Option<String>;

    /// A property of an included file, by its scope.
    fn member(&mut self, scope: usize, name: &str) -> Result<Option<Value>>;

    /// The value of `$(arg name)`.
    fn argument(&mut self, name: &str) -> Result<Value>;

    /// The name of a file, relative to the expanded file.
    fn file_name(&self, name: &str) -> String;

    /// The content of a YAML file.
    fn load_yaml(&mut self, name: &str) -> Result<Value>;

    /// Reports a message of the file.
    fn message(&mut self, text: String, is_warning: bool);

    fn work(&mut self) -> &mut Work;
}
