//! Tracing: algorithms run on symbols.

use std::ops::RangeInclusive;

use articulated_core::Scalar;
use articulated_core::algorithm::{Argument, Variant, divide_by_length};
use articulated_core::model::Model;
use articulated_core::step::CTRL;
use num_traits::Zero;

use crate::differentiate::Steps;
use crate::function_spec::{FunctionSpec, FunctionTerm};
use crate::graph::{Graph, Op};
use crate::limbs::{Constants, IsomorphicLimbs, pack};
use crate::model_pass::{FoldedRotations, View, model_passes, no_joint_moves_origin};
use crate::parameters::Parameter;
use crate::pass::{self, copy, dce, rebuild};
use crate::program::Strategy;
use crate::sym::{self, Sym};

/// The graph of a function on `model`: its argument k is argument k of the graph, parameters come
/// after the last; the results of the parts one after the other.
pub(crate) fn trace(spec: &FunctionSpec, strategies: &[Strategy], model: &Model<f64>, parameters: &[Parameter]) -> Graph {
    let arguments = spec.arguments();
    let view = |part: &FunctionTerm, strategy: &Strategy| {
        let with_inputs = (!parameters.is_empty()).then(|| {
            let input = |k| Sym::input(arguments.len(), k);
            model.cast::<Sym>().changed(|parts| parameters.iter().for_each(|p| p.put(parts, input)))
        });
        // If all inputs are numbers, passes run on numbers, which is faster.
        with_inputs.as_ref().map_or_else(|| passed(part, strategy, model).cast(), |m| passed(part, strategy, m))
    };
    sines_given(traced(spec, strategies, model, &arguments, view), &arguments)
}

/// Takes the sines and cosines of q from their own argument, if there is one.
fn sines_given(graph: Graph, arguments: &[Argument]) -> Graph {
    let place = |argument| arguments.iter().position(|a| *a == argument);
    let (Some(q), Some(sines)) = (place(Argument::Q), place(Argument::SinCos)) else { return graph };
    let given = rebuild(
        &graph,
        |_| true,
        |new, node, operands| {
            let angle = new.node(operands[0]);
            let is_coordinate = angle.op == Op::Input && angle.args[0] as usize == q;
            match node.op {
                Op::Sin if is_coordinate => new.input(sines, 2 * angle.args[1] as usize),
                Op::Cos if is_coordinate => new.input(sines, 2 * angle.args[1] as usize + 1),
                _ => copy(new, node, operands),
            }
        },
    );
    given.requested_as(&graph)
}

/// The same with isomorphic branches in lanes.
pub(crate) fn trace_in_lanes(spec: &FunctionSpec, strategies: &[Strategy], model: &Model<f64>, alike: &IsomorphicLimbs) -> Graph {
    let arguments = spec.arguments();
    let mut constants = Constants::new(arguments.len());
    let view = |part: &FunctionTerm, strategy: &Strategy| alike.symbolic(&passed(part, strategy, model), &mut constants);
    let graph = sines_given(traced(spec, strategies, model, &arguments, view), &arguments);
    pack(&dce(&graph), &arguments, alike, &constants).requested_as(&graph)
}

/// The view of the model after the passes of the strategy.
fn passed<S: Scalar>(part: &FunctionTerm, strategy: &Strategy, model: &Model<S>) -> View<S> {
    let model = if part.function.asks_for_frames() { model.clone() } else { model.clone().without_frames() };
    let (passes, shifted) = if part.function.regrouped { (strategy.passes, strategy.shifted) } else { (0, false) };
    let carried = model.carried();
    let view = model_passes::<S>().iter().take(passes).fold(View::new(model), |view, (_, pass, _)| pass(view));
    let view = if shifted { view.with_shifted_masses(&carried) } else { view };
    strategy.unit.map(|metres| view.in_unit_of(S::from_f64(metres))).unwrap_or(view)
}

/// The rotations that may be folded into constants after all passes, for functions independent of
/// body poses: the constants are those at the argument q.
pub(crate) fn foldable_rotations(part: &FunctionTerm, model: &Model<f64>) -> Vec<FoldedRotations> {
    let fits = indifferent(part, model) && part.function.is_at_one_configuration();
    if fits { finished(part, model).foldable_rotations() } else { Vec::new() }
}

/// Units of other sizes, m, are not tried: constants would be far from one.
const UNITS: RangeInclusive<f64> = 1e-3..=1e3;

/// Units of length that may save multiplications on the chosen model, for functions independent of
/// the unit: without frames and prismatic joints.
pub(crate) fn units(part: &FunctionTerm, strategy: &Strategy, model: &Model<f64>) -> Vec<f64> {
    let fits = indifferent(part, model) && no_joint_moves_origin(model);
    let mut units = if fits { passed(part, &Strategy { unit: None, ..*strategy }, model).units() } else { Vec::new() };
    units.retain(|metres| UNITS.contains(metres) && *metres != 1.0);
    units
}

/// Whether a function is independent of the axes and units of bodies: neither it nor an effect or
/// an actuator depends on their poses.
fn indifferent(part: &FunctionTerm, model: &Model<f64>) -> bool {
    let free = part.function.regrouped && !part.function.asks_for_frames() && part.function.takes.contains(&Argument::Q);
    let pushes = part.function.takes.contains(&CTRL) && model.actuators().has_frames();
    free && !pushes && model.bodies().iter().all(|b| b.effects.body.is_empty())
}

/// The model after all passes.
fn finished(part: &FunctionTerm, model: &Model<f64>) -> View<f64> {
    passed(part, &Strategy::plain(&part.function.ways[0], usize::MAX), model)
}

/// The graph of a function, or of its derivative; `view`: the model of symbols for a term.
fn traced(
    spec: &FunctionSpec,
    strategies: &[Strategy],
    model: &Model<f64>,
    arguments: &[Argument],
    mut view: impl FnMut(&FunctionTerm, &Strategy) -> View<Sym>,
) -> Graph {
    let place = |argument: Argument| arguments.iter().position(|a| *a == argument);
    let mut graph_of = |terms: &[FunctionTerm], steps: Option<&Steps<'_>>| {
        let mut one = |(term, strategy): (&FunctionTerm, &Strategy)| {
            let strategy = strategy.for_function(term.function);
            let view = view(term, &strategy);
            let moved = |argument: Argument, mut given: Vec<Sym>| match steps {
                Some(steps) => steps.moved(argument, given, &view.model),
                None if spec.normalises && argument.is_configuration() => {
                    divide_by_length(&view.model, &mut given);
                    given
                }
                None => given,
            };
            let out = run(term, &strategy, &view, &place, &moved);
            match steps {
                Some(steps) => steps.charted(term, out, &view.model),
                None => out,
            }
        };
        let all = || terms.iter().zip(strategies).flat_map(&mut one).collect();
        match &steps {
            Some(steps) => sym::trace_with_equations(steps.orders(), all),
            None => sym::trace(all),
        }
    };
    let Some(steps) = Steps::of(spec, arguments, model) else { return graph_of(&spec.parts, None) };
    let graph = graph_of(&spec.parts, Some(&steps));
    let derivative = steps.derivative(&graph).requested_as(&graph);
    match steps.own_algorithm(&spec.parts[0]) {
        Some((term, blocks)) => cheaper(derivative, steps.blocks(graph_of(&[term], None), &blocks)),
        None => derivative,
    }
}

/// The graph that costs less after all passes.
fn cheaper(one: Graph, other: Graph) -> Graph {
    let [first, second] = [&one, &other].map(|graph| pass::cost(&pass::run_all_unchecked(graph.clone())));
    if second < first { other } else { one }
}

fn run(
    part: &FunctionTerm,
    strategy: &Strategy,
    view: &View<Sym>,
    place: &dyn Fn(Argument) -> Option<usize>,
    moved: &dyn Fn(Argument, Vec<Sym>) -> Vec<Sym>,
) -> Vec<Sym> {
    let shape = view.model.shape();
    let vector = |argument: &Argument| -> Vec<Sym> {
        let place = place(*argument);
        let symbol = |k: usize| match (part.constant(*argument), place) {
            (Some(constant), _) => Sym::from_f64(constant.at(k)),
            (None, Some(place)) => Sym::input(place, k),
            (None, None) => Sym::zero(),
        };
        moved(*argument, (0..argument.len(shape)).map(symbol).collect())
    };
    let vectors: Vec<Vec<Sym>> = part.function.takes.iter().map(vector).collect();
    let slices: Vec<&[Sym]> = vectors.iter().map(Vec::as_slice).collect();
    let mut out = vec![Sym::zero(); part.function.len(shape)];
    let q = part.function.takes.iter().position(|a| *a == Argument::Q);
    let folded = q.zip(strategy.folded).map(|(k, which)| view.fold_rotations_into_constants(slices[k], which));
    let view = folded.as_ref().unwrap_or(view);
    let by_axes = strategy.axes.then(|| view.clone().with_axis_accelerations());
    let view = by_axes.as_ref().unwrap_or(view);
    let called = view.call_by(part.function, strategy.way, &slices, &mut out);
    debug_assert!(called.is_ok(), "arguments were made to measure");
    out
}

/// Whether a way applies to the model.
pub(crate) fn applies(way: &Variant<Sym>, model: &Model<f64>) -> bool {
    let mut applies = false;
    let _ = sym::trace(|| {
        applies = (way.applies)(&model.cast());
        Vec::new()
    });
    applies
}

/// The ways of a function that apply to the model, with a lower bound of each cost, the cheapest
/// first.
pub(crate) fn ways(part: &FunctionTerm, model: &Model<f64>) -> Vec<(&'static Variant<Sym>, u64)> {
    if let [one] = part.function.ways {
        return vec![(one, 0)];
    }
    let mut ways: Vec<(&'static Variant<Sym>, u64)> = Vec::new();
    let _ = sym::trace(|| {
        let symbolic = model.cast();
        let applies = part.function.ways.iter().filter(|w| (w.applies)(&symbolic));
        ways = applies.map(|w| (w, (w.least)(&symbolic))).collect();
        Vec::new()
    });
    ways.sort_by_key(|(_, least)| *least);
    ways
}

#[cfg(test)]
mod tests {
    use std::iter::once;

    use articulated_core::algorithm::{Needs, functions};
    use articulated_core::description::Origin;
    use articulated_core::effect::{Applied, EffectId};
    use articulated_core::step::steps;

    use super::*;
    use crate::Request;

    /// An arm on a track: its last two joints are parallel, and hold a fixed tool.
    const ARM: &str = "<link name='ground'/>
        <joint name='track' type='prismatic'><parent link='ground'/><child link='cart'/><axis xyz='1 0 0'/></joint>
        <joint name='yaw' type='revolute'><parent link='cart'/><child link='upper'/><origin xyz='0.1 0 0.3' rpy='0.2 0 0'/><axis xyz='0 0 1'/></joint>
        <joint name='pitch' type='revolute'><parent link='upper'/><child link='fore'/><origin xyz='0 0.2 0.3' rpy='0 0 0.4'/><axis xyz='0 1 0'/></joint>
        <joint name='bend' type='continuous'><parent link='fore'/><child link='hand'/><origin xyz='0.4 0 0.1'/><axis xyz='0 1 0'/></joint>
        <joint name='grip' type='fixed'><parent link='hand'/><child link='tool'/><origin xyz='0.1 0 0.2' rpy='0.3 0.1 0'/></joint>";

    /// A joint that follows another.
    const FOLLOWER: &str = "<link name='finger'><inertial><origin xyz='0.1 0 0'/><mass value='0.3'/>\
        <inertia ixx='0.1' ixy='0' ixz='0' iyy='0.1' iyz='0' izz='0.1'/></inertial></link>
        <joint name='finger' type='revolute'><parent link='hand'/><child link='finger'/><axis xyz='1 0 0'/><mimic joint='yaw' multiplier='-0.5'/></joint>";

    /// With drag on the tool or without.
    fn arm(more: &str, drag: bool) -> Model<f64> {
        made(&format!("{ARM}{more}"), drag)
    }

    /// The same on a turntable.
    fn turning(more: &str) -> Model<f64> {
        made(&format!("{ARM}{more}").replace("prismatic", "revolute"), false)
    }

    fn made(joints: &str, drag: bool) -> Model<f64> {
        let link = |name: &str, com: &str| {
            format!(
                "<link name='{name}'><inertial><origin xyz='{com}' rpy='0.3 0.1 -0.2'/><mass value='1.5'/>\
                 <inertia ixx='0.3' ixy='0.01' ixz='0.02' iyy='0.4' iyz='-0.01' izz='0.5'/></inertial></link>"
            )
        };
        let links: String =
            [("cart", "0 0 0.1"), ("upper", "0.1 0 0.2"), ("fore", "0.2 0.1 0"), ("hand", "0 0.1 0.2"), ("tool", "0.1 0 0")]
                .map(|(name, com)| link(name, com))
                .concat();
        let limited = joints.replace("type='revolute'>", "type='revolute'><limit effort='1' velocity='1' lower='-1' upper='1'/>");
        let mut request = Request::new("arm", format!("<robot name='arm'>{links}{limited}</robot>"));
        let drag = drag.then(|| Applied { effect: EffectId::drag, on: "tool".into(), at: Origin::default(), parameters: vec![0.7] });
        request.options.robot.effects.extend(drag);
        request.build_robot().unwrap().model
    }

    fn input(argument: usize, k: usize) -> f64 {
        ((argument * 7919 + k * 104_729 + 13) as f64 * 0.754_877_666_246_692_7).fract() - 0.4
    }

    fn close(a: &[f64], b: &[f64], what: &str) {
        assert!(a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).abs() <= 1e-9 * (1.0 + a.abs())), "{what}: {a:?} {b:?}");
    }

    /// The functions that a model without a free frame has, by themselves.
    fn all() -> impl Iterator<Item = FunctionSpec> {
        functions::<Sym>().iter().filter(|f| f.needs != Needs::FreeFrames).map(FunctionSpec::plain)
    }

    /// These, and steps.
    fn all_and_steps() -> impl Iterator<Item = FunctionSpec> {
        all().chain(steps::<Sym>().iter().map(FunctionSpec::plain))
    }

    #[test]
    fn whatever_is_chosen_the_values_are_the_same() {
        let mut seen = 0;
        for (model, turns) in [(arm("", false), false), (arm("", true), false), (arm(FOLLOWER, false), false), (turning(FOLLOWER), true)] {
            assert_eq!(no_joint_moves_origin(&model), turns);
            for spec in all_and_steps() {
                let part = &spec.parts[0];
                let all = ways(part, &model);
                let values = |strategy| trace(&spec, &[strategy], &model, &[]).evaluate(input);
                let expected = values(Strategy::plain(all[0].0, 0));
                let folded: Vec<Option<FoldedRotations>> =
                    [None].into_iter().chain(foldable_rotations(part, &model).into_iter().map(Some)).collect();
                for (way, _) in all {
                    for passes in 1..=model_passes::<Sym>().len() {
                        close(&values(Strategy::plain(way, passes)), &expected, &format!("{} by {}, {passes} passes", spec.name, way.name));
                    }
                    let inertias_and_rates = [(false, false), (true, false), (false, true), (true, true)];
                    for (&folded, (shifted, axes)) in folded.iter().flat_map(|folded| inertias_and_rates.map(|both| (folded, both))) {
                        let strategy = Strategy { folded, shifted, axes, ..Strategy::plain(way, usize::MAX) };
                        for unit in once(None).chain(units(part, &strategy, &model).into_iter().map(Some)) {
                            let strategy = Strategy { unit, ..strategy };
                            close(
                                &values(strategy),
                                &expected,
                                &format!("{} by {}, {folded:?}, {unit:?}, shifted: {shifted}, by axes: {axes}", spec.name, way.name),
                            );
                            seen += usize::from(unit.is_some());
                        }
                    }
                }
            }
        }
        assert!(seen > 100, "{seen} with another unit");
    }

    #[test]
    fn sines_of_what_is_no_coordinate_are_computed() {
        let mut graph = Graph::default();
        let (q, v, twice) = (graph.input(0, 1), graph.input(1, 1), graph.input(0, 0));
        let twice = graph.apply(Op::Add, &[twice, q]);
        let angles = [q, v, twice];
        graph.outputs = angles.iter().flat_map(|&a| [Op::Sin, Op::Cos].map(|op| (op, a))).map(|(op, a)| graph.exactly(op, &[a])).collect();
        let given = sines_given(graph.clone(), &[Argument::Q, Argument::V, Argument::SinCos]);
        let counts = given.counts();
        assert_eq!((counts.of(Op::Sin), counts.of(Op::Cos)), (2, 2));
        let sines = |k: usize| if k.is_multiple_of(2) { input(0, k / 2).sin() } else { input(0, k / 2).cos() };
        let with = |argument: usize, k: usize| if argument == 2 { sines(k) } else { input(argument, k) };
        assert_eq!(given.evaluate(with), graph.evaluate(input));
    }

    #[test]
    fn sines_that_are_given_are_those_of_q_alone() {
        let model = arm("", false);
        let plain = all().filter(|spec| spec.arguments().contains(&Argument::Q));
        for spec in plain {
            let given = FunctionSpec::parse(&format!("{}(q = sin_cos)", spec.name)).unwrap();
            let strategy = [Strategy::plain(ways(&spec.parts[0], &model)[0].0, usize::MAX)];
            let sines = given.arguments().len() - 1;
            let with = |argument: usize, k: usize| {
                let (sin, cos) = input(0, k / 2).sin_cos();
                if argument == sines { [sin, cos][k % 2] } else { input(argument, k) }
            };
            assert_eq!(given.arguments()[0], Argument::Q);
            let graph = trace(&given, &strategy, &model, &[]);
            close(&graph.evaluate(with), &trace(&spec, &strategy, &model, &[]).evaluate(input), &spec.name);
        }
    }
}
