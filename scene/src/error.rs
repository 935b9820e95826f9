//! What is wrong with a scene: data first, then a sentence.

use std::fmt;

pub(crate) use articulated_urdf::quote;

use crate::tree::At;

/// All that is wrong with a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneErrors {
    /// In the order in which they were found; never empty.
    pub errors: Vec<SceneError>,
}

/// One thing that is wrong with a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneError {
    /// The scene's file, as it was called when it was read.
    pub file: String,
    /// Its place.
    pub at: At,
    /// The way to the key, as `effects.damping.elbow`; empty for the file as a whole.
    pub key: String,
    /// The sort of mistake.
    pub kind: Kind,
    /// What stands there.
    pub found: String,
    /// What would be right.
    pub expected: String,
    /// The known name most like the one found.
    pub nearest: Option<String>,
}

/// The sorts of mistakes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Kind {
    /// Not UTF-8, not TOML, or larger than any scene.
    Syntax,
    /// A key that there is not.
    UnknownKey,
    /// A key that has to be there.
    MissingKey,
    /// A value of another type.
    Type,
    /// A word that is not one of those that may stand there.
    Word,
    /// A number that may not stand there: not finite, too small, too large.
    Number,
    /// Numbers or keys that do not go together.
    Together,
    /// A joint, link, function or file that there is not.
    UnknownName,
    /// What the robot does not allow.
    Robot,
    /// What the robot's model does not take: `found` is a sentence.
    Refused,
    /// More than are listed.
    More,
}

impl fmt::Display for SceneErrors {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, error) in self.errors.iter().enumerate() {
            write!(f, "{}{error}", if i == 0 { "" } else { "\n" })?;
        }
        Ok(())
    }
}

impl std::error::Error for SceneErrors {}

impl fmt::Display for SceneError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:", self.file)?;
        if let Some(line) = self.at.line() {
            write!(f, "{line}:")?;
        }
        write!(f, " {}", self.message())
    }
}

impl SceneError {
    /// All but the file and the line.
    pub fn message(&self) -> String {
        let key = if self.key.is_empty() { String::new() } else { format!("{}: ", self.key) };
        let found = if self.kind == Kind::Refused { "" } else { "found " };
        let expected = if self.expected.is_empty() { String::new() } else { format!(", expected {}", self.expected) };
        let nearest = self.nearest.as_ref().map(|near| format!("; did you mean {near:?}?")).unwrap_or_default();
        format!("{key}{found}{}{expected}{nearest}", self.found)
    }
}

impl std::error::Error for SceneError {}

/// A name as it stands in the way to a key.
pub(crate) fn bare(name: &str) -> String {
    let plain = !name.is_empty() && name.len() <= 80 && name.chars().all(|c| c.is_alphanumeric() || c == '_' || c == '-');
    if plain { name.to_owned() } else { quote(name) }
}
