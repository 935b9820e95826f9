//! Costs of effects: code is generated without effects, with each of them, and with all of them,
//! and counted.

use articulated_codegen::graph::{Counts, Op};
use articulated_codegen::{Generated, defined, generate as generate_code, massless};
use articulated_core::diagnostic::Code;
use articulated_core::effect::{Applied, EffectId};

use super::report::{Added, Cost, Counted, OnlyWith, Operations};
use crate::console::Progress;
use crate::failure::Failure;
use crate::parallel;
use articulated_lab::session::Session;

/// The scene with some of its effects.
struct Variant {
    /// Its addition relative to the variant `against`.
    what: String,
    places: usize,
    effects: Vec<Applied>,
    gravity: [f64; 3],
    against: usize,
}

/// Functions, and the variants of the scene for which all of them exist.
pub(super) struct Part {
    variants: Vec<Variant>,
    functions: Vec<String>,
    /// The reason why a function is not defined without effects.
    why: Vec<Option<String>>,
}

/// Index of the variant that others are compared with.
pub(super) const FIRST: usize = 0;

/// The functions that are defined without effects, and those that are not.
pub(super) fn parts(session: &Session, functions: &[String]) -> Result<Vec<Part>, Failure> {
    let mut bare = session.request.clone();
    bare.options.robot.effects.clear();
    let model = bare.build_robot()?.model;
    let massless = massless(&model);
    let part = |variants| Part { variants, functions: Vec::new(), why: Vec::new() };
    let mut parts = [part(variants(session)), part(vec![variant(session, "", session.effects.clone())])];
    for name in functions {
        let why = match defined(&bare.file, &model, &massless, articulated_codegen::function(name)?) {
            Err(error) if error.code == Code::SingularMassMatrix => Some(error.found),
            _ => None,
        };
        let part = &mut parts[usize::from(why.is_some())];
        part.functions.push(name.clone());
        part.why.push(why);
    }
    Ok(parts.into_iter().filter(|part| !part.functions.is_empty()).collect())
}

fn variant(session: &Session, what: &str, effects: Vec<Applied>) -> Variant {
    let gravity = session.model.gravity().into();
    Variant { what: what.to_owned(), places: effects.len(), effects, gravity, against: FIRST }
}

/// The scene without effects, the same without gravity, with each effect, and with all.
fn variants(session: &Session) -> Vec<Variant> {
    let (all, gravity) = (&session.effects, session.model.gravity());
    let variant = |what: &str, effects: Vec<Applied>| variant(session, what, effects);
    let mut variants = vec![variant("", Vec::new())];
    if gravity.norm() > 0.0 {
        variants.push(Variant { gravity: [0.0; 3], ..variant("gravity", Vec::new()) });
    }
    let mut kinds: Vec<EffectId> = all.iter().map(|a| a.effect).collect();
    kinds.sort_unstable();
    kinds.dedup();
    for kind in &kinds {
        variants.push(variant(kind.name(), all.iter().filter(|a| a.effect == *kind).cloned().collect()));
    }
    if kinds.len() > 1 {
        variants.push(variant("all together", all.to_vec()));
    }
    variants
}

impl Part {
    /// How many steps of progress it takes.
    pub(super) fn steps(&self, timed: bool) -> usize {
        self.variants.len() + self.functions.len() * usize::from(timed)
    }

    /// The code of all functions, of each variant.
    pub(super) fn generate(&self, session: &Session, progress: &Progress) -> Result<Vec<Generated>, Failure> {
        let made = parallel::map(&self.variants, |variant| {
            let mut request = session.request.clone();
            let o = &mut request.options;
            (o.robot.effects, o.robot.gravity) = (variant.effects.clone(), Some(variant.gravity));
            (o.functions, o.robot.frames, o.rust_mut().runtime, o.stages) =
                (self.functions.iter().cloned().map(Into::into).collect(), None, None, false);
            (o.parameters, o.batch) = (Vec::new(), Vec::new());
            progress.doing(format!("generation: {}", variant.what));
            let made = generate_code(&request);
            progress.step();
            made
        });
        made.into_iter().map(|made| made.map_err(Failure::from)).collect()
    }

    /// The cost of each function by its ledger.
    pub(super) fn counted(&self, made: &[Generated]) -> Vec<Cost> {
        let operations = |k: usize, f: usize| Operations::of(made[k].ledger.functions[f].emitted());
        let cost = |(f, name): (usize, &String)| {
            let first = Counted { operations: operations(FIRST, f), ns: None };
            let (without, only_with) = match self.why[f].clone() {
                Some(why) => (None, Some(OnlyWith { why, cost: first })),
                None => (Some(first), None),
            };
            let others = self.variants.iter().enumerate().skip(1);
            let adds = others.map(|(k, variant)| added(variant, operations(k, f), operations(variant.against, f))).collect();
            Cost { function: name.clone(), without, only_with, adds }
        };
        self.functions.iter().enumerate().map(cost).collect()
    }
}

fn added(variant: &Variant, with: Operations, against: Operations) -> Added {
    // The variant is the code without gravity, so the difference has the opposite sign.
    let operations = if variant.what == "gravity" { against.less(with) } else { with.less(against) };
    Added { what: variant.what.clone(), places: variant.places, operations, ns: None }
}

impl Operations {
    fn of(counts: &Counts) -> Self {
        let number = |n: u64| i64::try_from(n).unwrap_or(i64::MAX);
        Self {
            multiplications: number(counts.multiplications()),
            additions: number(counts.additions()),
            divisions_and_roots: number(counts.of(Op::Div) + counts.of(Op::Sqrt)),
            instructions: number(counts.instructions()),
        }
    }

    fn less(self, other: Self) -> Self {
        Self {
            multiplications: self.multiplications - other.multiplications,
            additions: self.additions - other.additions,
            divisions_and_roots: self.divisions_and_roots - other.divisions_and_roots,
            instructions: self.instructions - other.instructions,
        }
    }
}
