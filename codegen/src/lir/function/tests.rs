//! Every body of every function of the bundled robots computes what its graph does.

use articulated_core::algorithm::functions;
use articulated_core::description::Base;
use articulated_core::model::Model;

use super::*;
use crate::lir::interpret::interpret;
use crate::lir::verify;
use crate::{Options, Request, defined, massless, program};

/// The robots: an arm, legs in lanes of four, arms in lanes of two, and a long function.
const ROBOTS: [(&str, Base); 4] =
    [("ur5_like", Base::Fixed), ("quadruped", Base::Floating), ("gripper_arm", Base::Fixed), ("humanoid", Base::Floating)];

fn model(robot: &str, base: Base) -> Model<f64> {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../models/urdf");
    let mut request = Request::new(robot, std::fs::read(format!("{folder}/{robot}.urdf")).unwrap());
    request.options.robot.base = base;
    let whole = request.build_robot().unwrap().model;
    let tip = whole.frames().last().map(|frame| frame.name.clone());
    whole.with_frames(&tip.into_iter().collect::<Vec<_>>()).unwrap()
}

/// A number for each element of an argument; quaternions of length one where there are any.
fn input(argument: usize, k: usize) -> f64 {
    const QUATERNION: [f64; 4] = [0.1, 0.5, -0.1, 0.854_400_374_531_753_1];
    if (3..7).contains(&k) && argument == 0 { QUATERNION[k - 3] } else { 0.3 - 0.7 * (k as f64 * 1.3 + argument as f64).sin() }
}

/// The largest difference of the numbers that a body stores, relative to the largest of them.
fn difference(body: &Body, graph: &Graph) -> f64 {
    assert_eq!(verify(body), Ok(()));
    let (found, expected) = (interpret(body, input), graph.evaluate(input));
    let scale = expected.iter().fold(1e-300, |max: f64, x| max.max(x.abs()));
    found.iter().zip(&expected).filter(|(a, _)| !a.is_nan()).map(|(a, b)| (a - b).abs() / scale).fold(0.0, f64::max)
}

#[test]
fn every_body_computes_what_its_graph_does() {
    let (mut bodies, mut spilled, mut outlined, mut rows) = (0, 0, 0, 0);
    for (robot, base) in ROBOTS {
        let model = model(robot, base);
        for function in functions::<crate::Sym>() {
            // Of a humanoid one long function, which is cut into pieces, and two that are spilled.
            let long = ["coriolis_matrix", "mass_matrix", "forward_dynamics"].contains(&function.name);
            if defined(robot, &model, &massless(&model), function).is_err() || robot == "humanoid" && !long {
                continue;
            }
            for (limbs, level, raw_memory) in
                [(true, Precision::default(), true), (false, "f32".parse().unwrap(), true), (false, "compensated".parse().unwrap(), false)]
            {
                let options = Options { limbs, level, stages: false, ..Options::default() };
                let vectors = raw_memory && level.has_lanes();
                let can = Capabilities { level, vectors, raw_memory, scalar_too: true, loops: vectors, spills: raw_memory, states: true };
                let program = program::program(FunctionSpec::plain(function), &model, &[], &options, can);
                let lowered = Function::of(&program, model.shape(), false, can);
                let mut all = vec![(&lowered.body, &program.graph)];
                all.extend(lowered.few_registers.as_ref().map(|body| (body, &program.graph)));
                all.extend(lowered.scalar.as_ref().map(|(body, _)| (body, &program.scalar)));
                let states = lowered.states.as_ref().unwrap();
                all.extend([Some(&states.body), states.few_registers.as_ref()].into_iter().flatten().map(|body| (body, &program.plain)));
                for (body, graph) in all {
                    // Sums over lanes may be added up in another order.
                    let far = difference(body, graph);
                    assert!(far < 1e-13, "{} of {robot}, {:?}: {far:e}", function.name, body.ty);
                    bodies += 1;
                    spilled += usize::from(body.slots.is_some());
                    outlined += usize::from(body.pieces.len() > 1);
                    rows += usize::from(body.pieces.iter().flatten().any(|s| matches!(s, Stmt::Store(crate::lir::Store::Rows(..)))));
                }
            }
        }
    }
    println!("{bodies} bodies: {spilled} spilled, {outlined} in pieces, {rows} in rows");
    assert!(spilled > 3 && outlined > 3 && rows > 3, "{spilled} spilled, {outlined} in pieces, {rows} in rows");
}
