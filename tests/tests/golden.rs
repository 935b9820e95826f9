//! Generation is reproducible, and its costs are recorded.
//!
//! `UPDATE_GOLDEN=1 cargo test -p articulated-tests --test golden` writes `tests/golden` anew.

use std::fmt::Write;

use articulated_codegen::{Build, Generated, Request, checked_cost, generate};
use articulated_core::algorithm::{Function, Needs, functions};
use articulated_core::description::Base;
use articulated_core::diagnostic::values;
use articulated_models::ROBOTS;
use articulated_tests::case::Case;
use articulated_tests::golden;

fn request(name: &str) -> Request {
    let robot = articulated_models::robot(name).unwrap();
    let mut request = Request::new(format!("../models/urdf/{name}.urdf"), robot.urdf);
    request.options.robot.base = robot.base;
    let model = &Case::bundled(robot).model;
    let tip = model.frames().last().expect("it has links");
    request.options.robot.set_frames([tip.name.clone()]);
    let has = |f: &&Function<f64>| f.needs != Needs::FreeFrames || model.freedoms_of(tip.body).len() >= 6;
    request.options.functions = functions::<f64>().iter().filter(has).map(|f| f.name.into()).collect();
    request
}

fn generated(name: &str) -> Generated {
    generate(&request(name)).unwrap()
}

#[test]
fn the_module_of_a_pendulum() {
    let mut request = Request::new("simple_pendulum.urdf", articulated_models::robot("simple_pendulum").unwrap().urdf);
    request.options.rust_mut().runtime = Some("::articulated".into());
    golden::check("simple_pendulum.rs", &generate(&request).unwrap().source);
}

/// Operations of every function of every bundled robot, functions of frames for its last link. A
/// rise needs a reason, in the message of the commit that renews the file.
#[test]
fn the_ledger_of_operations() {
    let mut out = String::from(
        "# Operations of the generated functions. mul, add: multiplications and additions; ins: instructions, multiply-adds counted\n\
         # once; trig: sines and cosines; depth: longest chain of operations; lanes: limbs that are computed at once, an operation being one on vectors of so\n\
         # many numbers. A rise needs a reason.\n",
    );
    let _ = writeln!(out, "{:<18}{:<44}{:>6}{:>6}{:>6}{:>6}{:>6}{:>6}", "robot", "function", "mul", "add", "ins", "trig", "depth", "lanes");
    for robot in ROBOTS {
        let generated = generated(robot.name);
        // Costs of functions that are not generated: forward dynamics that checks its pivots, next
        // to the same without checks.
        let checked = checked_cost(&generated.model);
        for entry in generated.ledger.functions.iter().chain(&checked) {
            let c = entry.emitted();
            let _ = writeln!(
                out,
                "{:<18}{:<44}{:>6}{:>6}{:>6}{:>6}{:>6}{:>6}",
                robot.name,
                entry.function,
                c.multiplications(),
                c.additions(),
                c.instructions(),
                c.trigonometric(),
                entry.depth,
                entry.lanes
            );
        }
    }
    golden::check("ledger.txt", &out);
}

/// Operations of derivatives by transforms, beside those of their function, without lanes. A rise
/// needs a reason, as above.
#[test]
fn the_ledger_of_derivatives() {
    const OF: [&str; 10] = [
        "vjp(inverse_dynamics)",
        "jvp(inverse_dynamics)",
        "hvp(inverse_dynamics)",
        "vjp(forward_dynamics)",
        "jvp(forward_dynamics)",
        "gradient(kinetic_energy)",
        "gradient(potential_energy)",
        "jacobian(center_of_mass)",
        // A semi-implicit step, over forward dynamics alone.
        "step",
        "vjp(step)",
    ];
    let function = |text: &str| {
        let inner = text.split(['(', ')']).nth(1).unwrap_or(text);
        if inner == "step" { "forward_dynamics".to_owned() } else { inner.to_owned() }
    };
    let derivative = |text: &str| text.replace("step", "step_semi_implicit_euler(h = 0.001)");
    let mut out = String::from(
        "# Operations of derivatives. mul, add: multiplications and additions;\n\
         # ins: instructions, multiply-adds counted once;\n\
         # over: ins of the derivative over those of its function, both without lanes;\n\
         # of a semi-implicit step over those of forward dynamics. A rise needs a reason.\n",
    );
    let _ = writeln!(out, "{:<18}{:<28}{:>7}{:>7}{:>7}{:>7}", "robot", "derivative", "mul", "add", "ins", "over");
    for name in ["ur5_like", "panda_like", "quadruped", "humanoid"] {
        let mut request = request(name);
        request.options.limbs = false;
        let derivatives = OF.iter().enumerate().map(|(k, text)| format!("d{k} = {}", derivative(text)));
        let functions = OF.iter().enumerate().map(|(k, text)| format!("f{k} = {}", function(text)));
        request.options.functions = derivatives.chain(functions).map(|text| text.into()).collect();
        let generated = generate(&request).unwrap();
        let (derivatives, functions) = generated.ledger.functions.split_at(OF.len());
        for ((text, own), of) in OF.iter().zip(derivatives).zip(functions) {
            let (c, of) = (own.emitted(), of.emitted());
            let over = c.instructions() as f64 / of.instructions() as f64;
            let (mul, add, ins) = (c.multiplications(), c.additions(), c.instructions());
            let _ = writeln!(out, "{name:<18}{text:<28}{mul:>7}{add:>7}{ins:>7}{over:>7.2}");
        }
    }
    golden::check("derivatives.txt", &out);
}

#[test]
fn the_same_request_gives_the_same_bytes() {
    for name in ["panda_like", "gripper_arm", "quadruped"] {
        assert_eq!(generated(name).source, generated(name).source, "{name}");
    }
}

/// A build script's interface, on the file, returns the same as the library on its bytes.
#[test]
fn a_build_script_gives_the_same_source() {
    for name in ["simple_pendulum", "quadruped"] {
        let mut request = request(name);
        request.options.rust_mut().runtime = Some("::articulated".into());
        let mut build = Build::new(format!("../models/urdf/{name}.urdf")).functions(values(&request.options.functions));
        build = build.frames(values(&request.options.robot.frames.clone().expect("one")));
        if request.options.robot.base == Base::Floating {
            build = build.floating();
        }
        assert_eq!(build.generate().unwrap().source, generate(&request).unwrap().source, "{name}");
        request.options.rust_mut().runtime = None;
        assert_eq!(build.standalone().generate().unwrap().source, generate(&request).unwrap().source, "{name}");
    }
}

#[test]
fn source_is_a_file_of_rust_and_the_same_as_its_tokens() {
    for robot in ROBOTS {
        let generated = generated(robot.name);
        let file = syn::parse_file(&generated.source).unwrap_or_else(|e| panic!("{}: {e}", robot.name));
        let names: Vec<String> =
            file.items.iter().filter_map(|i| if let syn::Item::Fn(f) = i { Some(f.sig.ident.to_string()) } else { None }).collect();
        let wanted = request(robot.name).options.functions;
        assert!(wanted.iter().all(|f| names.contains(&f.value)), "{}: {names:?}", robot.name);
        syn::parse2::<syn::File>(generated.tokens()).unwrap_or_else(|e| panic!("{}: {e}", robot.name));
    }
}

/// A pass never raises the cost, and each stage is in the ledger.
#[test]
fn no_stage_of_the_ledger_costs_more_than_the_one_before() {
    for robot in ROBOTS {
        for entry in generated(robot.name).ledger.functions {
            let costs: Vec<(&str, u64)> = entry.stages.iter().map(|(stage, c)| (*stage, c.instructions())).collect();
            // After a model pass dead code is still there, so that the count may rise.
            let passes = costs.windows(2).filter(|w| {
                !["turn", "regroup", "slide", "drop_symmetric_rotation", "axis_rates", "fold_rotations", "unit"].contains(&w[1].0)
            });
            assert!(passes.into_iter().all(|w| w[1].1 <= w[0].1), "{} {}: {costs:?}", robot.name, entry.function);
        }
    }
}
