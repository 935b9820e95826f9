//! Generates, compiles, judges and times every function at every level.

use std::time::Duration;

use articulated_codegen::{Generated, Precision};
use articulated_core::algorithm::{Function, function};
use articulated_core::model::Model;
use articulated_reference::{BITS, Big};

use super::contender::Contender;
use super::judge::{self, Found, Verdict};
use super::report::{FunctionReport, Point, Report, Settings, Spread, mark_front, processor};
use super::states::{Case, cases};
use super::words;
use crate::compare::accuracy::Reference;
use crate::compare::manifest;
use crate::compare::peer::{self, Peer};
use crate::compiled::{Compiled, Rustc, Target};
use crate::console::Progress;
use crate::error::Error;
use crate::parallel;
use crate::process::Folder;
use crate::robot::Robot;
use crate::timing::{self, Run};

/// A level's library.
struct BuiltRobot {
    level: Precision,
    generated: Generated,
    compiled: Compiled,
}

/// Everything.
pub(super) fn all(
    robot: &Robot,
    reference: &Reference,
    rustc: &Rustc,
    functions: &[&'static str],
    levels: &[Precision],
    settings: &Settings,
) -> Result<Report, Error> {
    let progress = Progress::new(levels.len() + 2 * functions.len());
    let make = |level: &Precision| {
        progress.doing(format!("{level}: generation and rustc"));
        let made = build(robot, rustc, functions, *level);
        progress.step();
        made
    };
    let made: Vec<BuiltRobot> = parallel::map(levels, make).into_iter().collect::<Result<_, _>>()?;
    let Some(first) = made.first() else { return Err(Error::input(["no level to measure".to_owned()])) };
    let model = &first.generated.model;
    let mut report = report(robot, reference, model, rustc, settings);
    let folder = Folder::new().map_err(|e| Error::tool(&e))?;
    let libraries = manifest::named(&settings.peer, settings.peers_manifest.as_deref())?;
    let peers = peer::open_all(libraries, robot, model, folder.path(), &mut report.notes)?;
    let sets = [false, true].map(|single| cases(model, settings.states as usize, settings.seed, single));
    report.hard_states = sets[0].iter().filter(|c| c.hard.is_some()).count();
    for name in functions {
        let Some(f) = function::<f64>(name) else { continue };
        progress.doing(format!("{name}: errors and times"));
        let one = One { f, model, reference, made: &made, peers: &peers, sets: &sets, repetitions: settings.repetitions as usize };
        report.functions.push(one.report());
        progress.step();
    }
    Ok(report)
}

fn build(robot: &Robot, rustc: &Rustc, functions: &[&'static str], level: Precision) -> Result<BuiltRobot, Error> {
    let names: Vec<String> = functions.iter().map(|f| (*f).to_owned()).collect();
    let mut request = robot.request(&names);
    request.options.level = level;
    let generated = articulated_codegen::generate(&request)?;
    let compiled = Compiled::build(rustc, &generated).map_err(|e| Error::tool(&e))?;
    Ok(BuiltRobot { level, generated, compiled })
}

fn report(robot: &Robot, reference: &Reference, model: &Model<f64>, rustc: &Rustc, settings: &Settings) -> Report {
    Report {
        robot: robot.file.clone(),
        scene: robot.scene.clone(),
        base: robot.base(),
        joints: model.joints().len(),
        degrees_of_freedom: model.nv(),
        frames: model.frames().iter().map(|f| f.name.clone()).collect(),
        states: settings.states as usize,
        hard_states: 0,
        seed: settings.seed,
        repetitions: settings.repetitions,
        reference: reference.against(),
        reference_bits: BITS,
        processor: processor(),
        compiler: rustc.version.clone(),
        flags: Rustc::flags(Target::Own).join(" "),
        version: env!("CARGO_PKG_VERSION"),
        commit: settings.commit,
        units: super::report::UNITS,
        notes: reference.note().into_iter().collect(),
        functions: Vec::new(),
    }
}

/// One function and the objects that it is measured on.
struct One<'a> {
    f: &'static Function<f64>,
    model: &'a Model<f64>,
    reference: &'a Reference,
    made: &'a [BuiltRobot],
    peers: &'a [Peer],
    /// For `f64`, and for `f32`.
    sets: &'a [Vec<Case>; 2],
    repetitions: usize,
}

/// A contender and its measurements so far.
struct Entry {
    point: Point,
    verdicts: Vec<(Option<&'static str>, Verdict)>,
}

impl One<'_> {
    fn report(&self) -> FunctionReport {
        let arguments =
            self.sets.each_ref().map(|set| set.iter().map(|c| c.state.arguments(self.f).unwrap_or_default()).collect::<Vec<_>>());
        let set = |level: Precision| usize::from(level.is_single());
        let ours: Vec<(&BuiltRobot, Contender)> =
            self.made.iter().filter_map(|m| Some((m, Contender::new(&m.compiled, m.level, self.f, &arguments[set(m.level)])?))).collect();
        let theirs: Vec<(&Peer, Theirs)> =
            self.peers.iter().filter_map(|p| Some((p, Theirs::of(p, self.f, self.model, &arguments[0])?))).collect();
        let times = self.times(&ours, &theirs);
        let mut entries: Vec<Entry> =
            ours.iter().zip(&times).map(|((made, _), t)| self.entry(Some(made), &made.level.to_string(), t)).collect();
        entries.extend(theirs.iter().zip(&times[ours.len()..]).map(|((peer, _), t)| self.entry(None, &peer.name, t)));
        for single in [false, true] {
            self.judge(single, &arguments[usize::from(single)], &ours, &theirs, &mut entries);
        }
        let mut points: Vec<Point> = entries.into_iter().map(Entry::done).collect();
        mark_front(&mut points);
        let surprises = words::surprises(&points);
        FunctionReport { function: self.f.name, summary: self.f.summary, points, surprises }
    }

    /// ns per call on the random states, of ours and then of theirs, in turns.
    fn times(&self, ours: &[(&BuiltRobot, Contender)], theirs: &[(&Peer, Theirs)]) -> Vec<Vec<f64>> {
        let random = self.sets[0].iter().filter(|c| c.hard.is_none()).count();
        let slices: Vec<Vec<Vec<&[f64]>>> = ours.iter().map(|(_, c)| c.slices(random)).collect();
        let their_slices: Vec<Vec<Vec<&[f64]>>> = theirs.iter().map(|(_, t)| t.slices(random)).collect();
        let mut runs: Vec<Run<'_>> = ours.iter().zip(&slices).map(|((_, c), x)| c.run(x)).collect();
        runs.extend(theirs.iter().zip(&their_slices).map(|((_, t), x)| t.contender.run(x)));
        timing::interleaved(&mut runs, self.repetitions)
    }

    fn entry(&self, made: Option<&BuiltRobot>, name: &str, times: &[f64]) -> Entry {
        let ledger = made.and_then(|m| m.generated.ledger.functions.iter().find(|e| e.function == self.f.name));
        let point = Point {
            level: name.to_owned(),
            peer: made.is_none(),
            time: timing::summary(times),
            relative: Spread::default(),
            ulps: Spread::default(),
            rounding: None,
            backward: None,
            hard: None,
            bound: None,
            reached: None,
            instructions: ledger.map(|e| e.emitted().instructions()),
            operations: ledger.map(|e| e.emitted().operations()),
            code_bytes: made.and_then(|m| m.compiled.code_bytes(self.f.name)),
            compilation_seconds: made.map(|m| m.compiled.time).as_ref().map(Duration::as_secs_f64),
            front: false,
        };
        Entry { point, verdicts: Vec::new() }
    }

    /// The errors of all contenders for these states. Threads share the states.
    fn judge(
        &self,
        single: bool,
        arguments: &[Vec<&[f64]>],
        ours: &[(&BuiltRobot, Contender)],
        theirs: &[(&Peer, Theirs)],
        entries: &mut [Entry],
    ) {
        let own: Vec<usize> = (0..ours.len()).filter(|k| ours[*k].0.level.is_single() == single).collect();
        let others: Vec<usize> = if single { Vec::new() } else { (0..theirs.len()).collect() };
        if own.is_empty() && others.is_empty() {
            return;
        }
        // Peers are bound to their thread: all are called here.
        let results: Vec<Vec<Vec<f64>>> = (0..arguments.len())
            .map(|s| {
                let ours: Vec<Vec<f64>> = own.iter().map(|k| ours[*k].1.call(s)).collect();
                let generic = ours.first().cloned().unwrap_or_default();
                let theirs = others.iter().map(|k| theirs[*k].1.call(s, theirs[*k].0, &generic, self.f, self.model));
                ours.iter().cloned().chain(theirs).collect()
            })
            .collect();
        let graphs: Vec<_> = own.iter().map(|k| judge::graph(&ours[*k].0.generated, self.f.name).map(|g| (g, ours[*k].0.level))).collect();
        let parts: Vec<Vec<usize>> =
            (0..parallel::threads()).map(|t| (t..arguments.len()).step_by(parallel::threads()).collect()).collect();
        let judged = {
            let (reference, place) = (self.reference, (self.model, self.f));
            parallel::map(&parts, |states| judge_some(states, reference, place, arguments, &results, &graphs))
        };
        for (s, verdicts) in judged.into_iter().flatten() {
            let hard = self.sets[usize::from(single)][s].hard;
            let places = own.iter().copied().chain(others.iter().map(|k| ours.len() + k));
            for (place, verdict) in places.zip(verdicts) {
                entries[place].verdicts.push((hard, verdict));
            }
        }
    }
}

/// The verdicts on some of the states, with their numbers.
fn judge_some(
    states: &[usize],
    reference: &Reference,
    (model, f): (&Model<f64>, &'static Function<f64>),
    arguments: &[Vec<&[f64]>],
    results: &[Vec<Vec<f64>>],
    graphs: &[Option<(&articulated_codegen::graph::Graph, Precision)>],
) -> Vec<(usize, Vec<Verdict>)> {
    Big::scope(|| {
        let Some(exact) = reference.exact(model) else { return Vec::new() };
        let one = |s: &usize| {
            let own = graphs.iter().copied().chain(std::iter::repeat(None));
            let found: Vec<Found<'_>> = results[*s].iter().zip(own).map(|(r, own)| Found { result: r.clone(), own }).collect();
            Some((*s, judge::verdicts(&exact, model, f, &arguments[*s], &found)?))
        };
        states.iter().filter_map(one).collect()
    })
}

impl Entry {
    /// The point with its errors.
    fn done(self) -> Point {
        let mut point = self.point;
        let random = || self.verdicts.iter().filter(|(hard, _)| hard.is_none()).map(|(_, v)| v);
        let some = |what: fn(&Verdict) -> Option<f64>| {
            let all: Option<Vec<f64>> = random().map(what).collect();
            all.filter(|all| !all.is_empty())
        };
        point.relative = Spread::of(random().map(|v| v.relative).collect());
        point.ulps = Spread::of(random().map(|v| v.ulps).collect());
        point.rounding = some(|v| v.rounding).map(Spread::of);
        point.backward = some(|v| v.backward).map(Spread::of);
        point.bound = some(|v| v.bound).map(|all| Spread::of(all).largest);
        let reached: Option<Vec<f64>> = self.verdicts.iter().map(|(_, v)| v.reached).collect();
        point.reached = reached.filter(|all| !all.is_empty()).map(|all| Spread::of(all).largest);
        let hard = self.verdicts.iter().filter_map(|(hard, v)| Some((v.relative, (*hard)?)));
        point.hard = hard.reduce(|a, b| if a.0.is_nan() || a.0 >= b.0 { a } else { b });
        point
    }
}

/// A peer's function with its arguments.
struct Theirs {
    contender: crate::compare::contender::Contender<'static>,
    arguments: Vec<Vec<Vec<f64>>>,
}

impl Theirs {
    fn of(peer: &Peer, f: &'static Function<f64>, model: &Model<f64>, states: &[Vec<&[f64]>]) -> Option<Self> {
        let contender = peer.contender(f, model)?;
        Some(Self { contender, arguments: states.iter().map(|x| peer.arguments(f, model, x)).collect() })
    }

    fn slices(&self, states: usize) -> Vec<Vec<&[f64]>> {
        self.arguments.iter().take(states).map(|x| x.iter().map(Vec::as_slice).collect()).collect()
    }

    /// The result in our order; NaN if the peer does not return it.
    fn call(&self, k: usize, peer: &Peer, ours: &[f64], f: &Function<f64>, model: &Model<f64>) -> Vec<f64> {
        let arguments: Vec<&[f64]> = self.arguments[k].iter().map(Vec::as_slice).collect();
        let result = self.contender.call(&arguments);
        peer.in_our_order(&result, ours, f, model)
    }
}
