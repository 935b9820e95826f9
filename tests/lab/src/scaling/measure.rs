//! One function on one chain.

use std::hint::black_box;
use std::time::Instant;

use articulated_codegen::{Request, generate};
use articulated_core::algorithm::{Dim, Function};

use super::chain::chain;
use super::report::Point;
use crate::compare::contender::Contender;
use crate::compiled::{CompileError, Compiled, Filler, Rustc};
use crate::error::Error;
use crate::states::{self, State};
use crate::table::counted;
use crate::timing::{self, Run};

/// Random states of the evaluations: enough that branches are not predicted from memory, few enough
/// that those of a long chain stay in the cache.
pub(super) const STATES: usize = 8;

/// Generated and generic results may differ by this much of the largest.
const AGREE: f64 = 1e-6;

pub(super) fn point(
    function: &'static Function<f64>,
    joints: usize,
    repetitions: usize,
    rustc: &Rustc,
    cold: &mut Cold,
) -> Result<Point, Error> {
    let mut request = Request::new(format!("chain_{joints}.urdf"), chain(joints));
    request.options.functions = vec![function.name.into()];
    // Of functions of frames, the tip's.
    if function.takes.iter().flat_map(|a| a.dims()).chain(function.gives).any(|dim| *dim == Dim::Frames) {
        request.options.robot.set_frames([format!("link_{joints}")]);
    }
    let start = Instant::now();
    let generated = generate(&request)?;
    let generation = start.elapsed();
    let compiled = Compiled::build(rustc, &generated).map_err(|e| Error::tool(&e))?;
    let states = states::random(&generated.model, STATES, 1);
    let arguments: Vec<Vec<&[f64]>> = states.iter().map(|s: &State| s.arguments(function).unwrap_or_default()).collect();
    let contenders = [Contender::generated(&compiled, function), Contender::generic(&generated.model, function)];
    let difference = difference(&contenders, &arguments[0]);
    if difference.is_nan() || difference > AGREE {
        let name = function.name;
        return Err(Error::bound(format!(
            "{name}, {}: generated and generic results differ by {difference:.1e} of the largest",
            counted(joints, "joint")
        )));
    }
    let mut runs: Vec<Run<'_>> = contenders.iter().map(|c| c.run(&arguments)).collect();
    let hot = timing::interleaved(&mut runs, repetitions);
    let chilled = chilled(&contenders, &arguments, repetitions, cold);
    let entry = &generated.ledger.functions[0];
    Ok(Point {
        function: function.name,
        joints,
        ways: entry.ways.clone(),
        instructions: entry.emitted().instructions(),
        source_bytes: generated.source.len(),
        code_bytes: compiled.code_bytes(function.name),
        generation_seconds: generation.as_secs_f64(),
        compilation_seconds: compiled.time.as_secs_f64(),
        difference,
        generated_hot: timing::summary(&hot[0]),
        generic_hot: timing::summary(&hot[1]),
        generated_cold: timing::summary(&chilled[0]),
        generic_cold: timing::summary(&chilled[1]),
    })
}

/// The largest difference of the results, relative to the largest result.
fn difference(contenders: &[Contender<'_>; 2], arguments: &[&[f64]]) -> f64 {
    let [a, b] = contenders.each_ref().map(|c| c.call(arguments));
    let largest = b.iter().map(|x| x.abs()).fold(f64::MIN_POSITIVE, f64::max);
    // A maximum that lets no NaN slip by.
    a.iter().zip(&b).map(|(a, b)| (a - b).abs() / largest).fold(0.0, |most, x| if x <= most { most } else { x })
}

/// ns of single evaluations, each after everything was driven out of the caches.
fn chilled(contenders: &[Contender<'_>; 2], arguments: &[Vec<&[f64]>], repetitions: usize, cold: &mut Cold) -> [Vec<f64>; 2] {
    let mut times = [Vec::new(), Vec::new()];
    for repetition in 0..repetitions {
        for turn in 0..2 {
            let k = (turn + repetition) % 2;
            let mut run = contenders[k].run(std::slice::from_ref(&arguments[repetition % arguments.len()]));
            cold.chill();
            times[k].push(run.go(1).as_secs_f64() * 1e9);
        }
    }
    times
}

/// More than the private and the shared caches of a core.
pub(super) const BUFFER: usize = 64 << 20;

const LINE: usize = 64;

/// Data and code that replace the contents of the caches.
pub(super) struct Cold {
    buffer: Vec<u8>,
    filler: Filler,
}

impl Cold {
    pub(super) fn new(rustc: &Rustc) -> Result<Self, CompileError> {
        Ok(Self { buffer: vec![1; BUFFER], filler: Filler::build(rustc)? })
    }

    /// Writes to every line of the buffer, then runs the code.
    pub(super) fn chill(&mut self) {
        self.buffer.iter_mut().step_by(LINE).for_each(|x| *x = x.wrapping_add(1));
        black_box(&mut self.buffer);
        self.filler.run();
    }
}
