//! Active and inactive effects of a scene, and unused content of the robot's file.

use articulated_core::diagnostic::{At, Unused};
use std::collections::HashSet;
use std::fmt;

use articulated_core::effect::{EffectId, On};

/// The source of numbers that come from collision geometry.
pub(crate) const COLLISION: &str = "collision";

/// Active effects, inactive effects and unused content of the robot's file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Report {
    /// Effects that are on, in the order in which they are applied.
    pub on: Vec<EffectOn>,
    /// Effects that are off, and why.
    pub off: Vec<EffectOff>,
    /// Unused content of the robot's file.
    pub ignored: Vec<Unused>,
    /// Number of joints that move.
    pub joints: usize,
    /// Number of links that move.
    pub links: usize,
}

/// Number of joints or links of an effect, and the source of its numbers. An effect with any number
/// from the robot's file counts as one from the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct EffectCount {
    /// Which.
    pub effect: EffectId,
    /// Number of joints or links that have it.
    pub on: usize,
    /// Number of joints or links that move.
    pub of: usize,
    /// Number of those with numbers from the robot's file.
    pub from_file: usize,
    /// Number of those with points from collision geometry.
    pub from_collision: usize,
    /// Number of those with numbers from the scene.
    pub from_scene: usize,
}

impl Report {
    /// One for each effect that is on, in their order.
    #[must_use]
    pub fn counts(&self) -> Vec<EffectCount> {
        let mut effects: Vec<EffectId> = self.on.iter().map(|on| on.effect).collect();
        effects.dedup();
        let count = |effect: EffectId| {
            let names = |source: Option<Source>| {
                let own = self.on.iter().filter(|on| on.effect == effect && source.is_none_or(|source| source == on.source()));
                own.map(|on| on.on.as_str()).collect::<HashSet<&str>>().len()
            };
            EffectCount {
                effect,
                on: names(None),
                of: if effect.row().on == On::Joint { self.joints } else { self.links },
                from_file: names(Some(Source::File)),
                from_collision: names(Some(Source::Collision)),
                from_scene: names(Some(Source::Scene)),
            }
        };
        effects.into_iter().map(count).collect()
    }
}

/// Source of an effect's numbers.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Source {
    File,
    Collision,
    Scene,
}

impl EffectOn {
    fn source(&self) -> Source {
        let tags: Vec<&str> = self.numbers.iter().filter_map(|number| number.from).collect();
        match tags.as_slice() {
            [] => Source::Scene,
            tags if tags.contains(&COLLISION) => Source::Collision,
            _ => Source::File,
        }
    }
}

impl fmt::Display for EffectCount {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let kind = if self.effect.row().on == On::Joint { "joint" } else { "link" };
        write!(f, "{} of {} {kind}{}", self.on, self.of, if self.of == 1 { "" } else { "s" })?;
        let all = [(self.from_file, "the file"), (self.from_collision, "collision geometry"), (self.from_scene, "the scene")];
        let sources: Vec<(usize, &str)> = all.into_iter().filter(|(count, _)| *count > 0).collect();
        if let [(_, source)] = *sources {
            return write!(f, ", from {source}");
        }
        let listed: Vec<String> = sources.iter().map(|(count, source)| format!("{count} from {source}")).collect();
        write!(f, ": {}", listed.join(", "))
    }
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
    /// Place in the scene.
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
    /// The scene turns it off or sets it to zero.
    SaidSo,
    /// Its numbers are requested from the file, which does not contain them.
    NotInUrdf,
    /// It is requested for all joints or links, and it applies to none of them.
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
