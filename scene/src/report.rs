//! Active and inactive effects of a scene, and unused content of the robot's file.

use articulated_core::diagnostic::{At, Unused};
use std::fmt;

use articulated_core::effect::{EffectId, On};

/// What of a scene is on, what is off, and what of the robot's file is not used.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Report {
    /// Effects that are on, in the order in which they are applied.
    pub on: Vec<EffectOn>,
    /// Effects that are off, and why.
    pub off: Vec<EffectOff>,
    /// Unused content of the robot's file.
    pub ignored: Vec<Unused>,
}

/// An effect on a joint or link.
#[derive(Clone, Debug, PartialEq)]
pub struct EffectOn {
    /// Which.
    pub effect: EffectId,
    /// The joint or link.
    pub on: String,
    /// Its numbers.
    pub numbers: Vec<Number>,
    /// Where the scene says so.
    pub place: At,
}

/// A parameter of an effect.
#[derive(Clone, Debug, PartialEq)]
pub struct Number {
    /// Its name.
    pub name: &'static str,
    /// One number or several.
    pub values: Vec<f64>,
    /// Their unit.
    pub unit: &'static str,
    /// The tag of the file that it is from.
    pub from: Option<&'static str>,
}

/// An inactive effect.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct EffectOff {
    /// Its name.
    pub effect: &'static str,
    /// Why.
    pub why: Why,
}

/// Why an effect is off.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Why {
    /// The scene does not mention it.
    NotAsked,
    /// The scene says that it is off, or gives it zeros.
    SaidSo,
    /// Its numbers should come from the file, which has none.
    NotInUrdf,
    /// It is requested for all joints or links, and there are none that it can act on.
    Nowhere,
}

impl fmt::Display for Why {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::NotAsked => "the scene does not mention it",
            Self::SaidSo => "the scene says so",
            Self::NotInUrdf => "the robot's file has no numbers for it",
            Self::Nowhere => "there is nothing that it could act on",
        })
    }
}

impl fmt::Display for EffectOn {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let kind = if self.effect.row().on == On::Joint { "joint" } else { "link" };
        write!(f, "{} on {kind} {:?}:", self.effect.name(), self.on)?;
        for (i, number) in self.numbers.iter().enumerate() {
            write!(f, "{} {number}", if i == 0 { "" } else { "," })?;
        }
        Ok(())
    }
}

impl fmt::Display for Number {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} ", self.name)?;
        match self.values.as_slice() {
            [x] => write!(f, "{x:?}")?,
            values => write!(f, "{values:?}")?,
        }
        if self.unit != "1" {
            write!(f, " {}", self.unit)?;
        }
        self.from.map_or(Ok(()), |tag| write!(f, " (file: {tag})"))
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        heading(f, "on", self.on.len())?;
        self.on.iter().try_for_each(|on| writeln!(f, "  {on}"))?;
        heading(f, "off", self.off.len())?;
        self.off.iter().try_for_each(|off| writeln!(f, "  {}: {}", off.effect, off.why))?;
        heading(f, "in the robot's file and not used", self.ignored.len())?;
        self.ignored.iter().try_for_each(|ignored| writeln!(f, "  {ignored}"))
    }
}

fn heading(f: &mut fmt::Formatter<'_>, what: &str, count: usize) -> fmt::Result {
    if count == 0 { writeln!(f, "{what}: nothing") } else { writeln!(f, "{what}:") }
}
