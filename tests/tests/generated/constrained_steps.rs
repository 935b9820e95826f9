//! Steps with limits, dry friction and contacts: generated code against the library, which
//! tests/mjcf/contact.py compares with MuJoCo, and their derivatives.

use articulated_codegen::bound::bounds;
use articulated_codegen::lir::interpret::interpret;
use articulated_codegen::{Generated, Options, Request, generate};
use articulated_core::algorithm::Workspace;
use articulated_core::model::Model;
use articulated_core::step::{of_constraints, step};
use articulated_formats::world::GivenContact;
use articulated_tests::random::Random;

/// Two legs under a trunk that floats: contacts with the floor and of the legs, limits, friction.
const STANDING: &str = include_str!("../../mjcf/models/standing.xml");
/// A ball that rolls and slides on a floor.
const BALL: &str = "<mujoco><option cone='elliptic'/><worldbody><geom type='plane' size='1 1 1'/>\
    <body><freejoint/><geom size='0.1' friction='0.4' condim='4'/></body></worldbody></mujoco>";
const NAMES: [&str; 2] = ["constrained_acceleration", "constrained_step_implicit_damping"];
/// q, v, act, ctrl, warm, h.
type Given = [Vec<f64>; 6];

fn generated(text: &str, functions: &[&str]) -> Generated {
    let mut request = Request::new("standing.xml", text);
    request.options = Options { functions: functions.iter().map(|f| (*f).into()).collect(), ..Options::default() };
    generate(&request).unwrap()
}

/// States at this height, most of them in contact, and one in the air.
fn given(model: &Model<f64>, height: f64, count: usize) -> Vec<Given> {
    let mut random = Random::new(5);
    let mut state = |k: usize| {
        let mut q = model.neutral();
        let tilt = random.vector(3, -0.05, 0.05);
        q[2] = if k == 0 { 2.0 } else { height };
        q[3..6].copy_from_slice(&tilt);
        q[6] = (1.0 - tilt.iter().map(|x| x * x).sum::<f64>()).sqrt();
        let rest = q.len() - 7;
        q[7..].copy_from_slice(&random.vector(rest, -0.5, 0.5));
        let (nv, nu) = (model.nv(), model.actuators().laws.len());
        [q, random.vector(nv, -0.5, 0.5), Vec::new(), random.vector(nu, -1.0, 1.0), vec![0.0; nv], vec![2e-3]]
    };
    (0..count).map(&mut state).collect()
}

fn called(name: &str, model: &Model<f64>, given: &Given) -> Vec<f64> {
    let row = step(name).unwrap();
    let all: Vec<&[f64]> = given.iter().map(Vec::as_slice).collect();
    let is_step = row.takes.len() == 6;
    let mut out = vec![0.0; if is_step { model.nq() + 2 * model.nv() } else { model.nv() }];
    row.call(model, &mut Workspace::new(model), &all[..row.takes.len()], &mut out).unwrap();
    out
}

fn assert_close(what: &str, found: &[f64], expected: &[f64], bound: f64) {
    let scale = expected.iter().fold(1.0_f64, |most, x| most.max(x.abs()));
    let far = found.iter().zip(expected).fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
    assert!(found.len() == expected.len() && far <= bound * scale, "{what}: {far:e} of {scale:e}");
}

#[test]
fn generated_steps_are_those_of_the_library() {
    assert!(NAMES.iter().all(|name| of_constraints::<f64>().iter().any(|row| row.name == *name)));
    let generated = generated(STANDING, &NAMES);
    let model = &generated.model;
    let mut pushes = 0;
    for (k, name) in NAMES.iter().enumerate() {
        for given in given(model, 0.44, 6) {
            let (expected, input) = (called(name, model, &given), |argument: usize, k: usize| given[argument][k]);
            assert_close(name, &generated.graphs[k].evaluate(input), &expected, 1e-9);
            for (_, body) in generated.bodies[k].all() {
                assert_close(name, &interpret(body, input), &expected, 1e-9);
            }
            // In the air the trunk falls freely; on the floor it does not.
            pushes += usize::from(k == 0 && expected[5] > 0.0);
        }
    }
    assert!(pushes >= 2, "some states are in contact");
}

/// What a step found, how exact it is, and the forces of its contacts: generated code against the
/// library.
#[test]
fn certificates_and_forces_are_those_of_the_library() {
    const NAMES: [&str; 3] = ["constrained_search", "constrained_error", "contact_forces"];
    let generated = generated(STANDING, &NAMES);
    let (model, mut touching) = (&generated.model, 0);
    let (nv, count) = (model.nv(), model.shape().contacts);
    for given in given(model, 0.44, 6) {
        let [q, v, act, ctrl, warm, _] = &given;
        let called = |k: usize, inputs: &[&[f64]], length: usize| {
            let row = step(NAMES[k]).unwrap();
            let mut expected = vec![0.0; length];
            row.call(model, &mut Workspace::new(model), inputs, &mut expected).unwrap();
            (generated.graphs[k].evaluate(|argument, k| inputs[argument][k]), expected)
        };
        // The last step of a search depends on roundings.
        let (own, found) = called(0, &[q, v, act, ctrl, warm], nv + 3);
        assert_close(NAMES[0], &own[..nv], &found[..nv], 1e-9);
        let mut last = 0.0;
        for found in [&own, &found] {
            let [error, size, steps] = [found[nv], found[nv + 1], found[nv + 2]];
            assert!(error < 1e-11 * size && (1.0..12.0).contains(&steps), "{error} {size} {steps}");
            last = error.max(last);
        }
        // Accelerations further off have larger bounds.
        for far in [1e-6, 1e-3, 1.0] {
            let moved: Vec<f64> = found[..nv].iter().map(|x| x + far).collect();
            let (own, expected) = called(1, &[q, v, act, ctrl, &moved], 2);
            assert_close(NAMES[1], &own, &expected, 1e-9);
            assert!(own[0] > last, "{far}: {own:?} {last}");
            last = own[0];
        }
        let (own, forces) = called(2, &[q, v, &found[..nv]], 13 * count);
        for (own, place) in own.chunks(13).zip(forces.chunks(13)) {
            // The legs touch at a distance of exactly 0, without force: roundings decide.
            let pushes = [own, place].iter().any(|place| place[7..10].iter().any(|x| x.abs() > 1e-9));
            if pushes {
                assert_close(NAMES[2], own, place, 1e-9);
            }
        }
        // Contacts push, and what they push is within their cone.
        for place in forces.chunks(13).filter(|place| place[0] == 1.0) {
            let (normal, force) = (&place[4..7], &place[7..10]);
            let along: f64 = normal.iter().zip(force).map(|(n, f)| n * f).sum();
            let across: f64 = normal.iter().zip(force).map(|(n, f)| (f - along * n).powi(2)).sum();
            assert!(along > -1e-9 && across.sqrt() <= along * (1.0 + 1e-6) + 1e-9, "{place:?}");
            touching += usize::from(along > 1.0);
        }
    }
    assert!(touching >= 4, "{touching} places touch");
}

/// The error of an acceleration and its roundings have bounds, but where it is uncertain what
/// touches.
#[test]
fn certificates_have_bounds_of_their_own_roundings() {
    let generated = generated(BALL, &["constrained_error"]);
    let (model, mut certain) = (&generated.model, 0);
    for given in given(model, 0.095, 8) {
        let found = called(NAMES[0], model, &given);
        let mut inputs = given.clone();
        inputs[4].copy_from_slice(&found);
        // ω × v of a floating joint is the difference of d²p/dt² and of v̇.
        let (w, v) = (&given[1][..3], &given[1][3..6]);
        (0..3).for_each(|k| inputs[4][3 + k] += w[(k + 1) % 3] * v[(k + 2) % 3] - w[(k + 2) % 3] * v[(k + 1) % 3]);
        let [error, size] = generated.graphs[0].evaluate(|argument, k| inputs[argument][k])[..] else { panic!("two numbers") };
        let roundings = bounds(&generated.graphs[0], generated.level, &|argument, k| (inputs[argument][k], 0.0)).unwrap();
        assert!(error <= roundings[0] && error < 1e-11 * size, "{error} {size} {roundings:?}");
        certain += usize::from(roundings[0] < 1e-6 * size);
    }
    assert!(certain >= 6, "{certain} states are certain");
}

/// Derivatives are those of the optimum.
#[test]
fn derivatives_are_those_of_differences() {
    let generated = generated(BALL, &["slope = jacobian(constrained_acceleration, v)"]);
    let (model, h) = (&generated.model, 1e-7);
    let n = model.nv();
    let mut compared = 0;
    for given in given(model, 0.095, 8) {
        let at = |k: usize, by: f64| {
            let mut moved = given.clone();
            moved[1][k] += by;
            called(NAMES[0], model, &moved)
        };
        let jacobian = generated.graphs[0].evaluate(|argument, k| given[argument][k]);
        for k in 0..n {
            let [near, far] = [h, 2.0 * h].map(|h| {
                let (after, before) = (at(k, h), at(k, -h));
                after.iter().zip(before).map(|(a, b)| (a - b) / (2.0 * h)).collect::<Vec<f64>>()
            });
            // Not across a switch
            let scale = near.iter().fold(1.0_f64, |most, x| most.max(x.abs()));
            if near.iter().zip(&far).all(|(a, b)| (a - b).abs() < 1e-5 * scale) {
                let own: Vec<f64> = (0..n).map(|i| jacobian[i * n + k]).collect();
                assert_close("jacobian", &own, &near, 1e-4);
                compared += 1;
            }
        }
    }
    assert!(compared > 30, "{compared} columns were compared");
}

/// λᵀ ∂²a/∂v² dv is the difference of λᵀ ∂a/∂v along dv.
#[test]
fn second_derivatives_are_those_of_differences() {
    let generated = generated(BALL, &["slope = vjp(constrained_acceleration, v)", "bend = hvp(constrained_acceleration, v)"]);
    let (model, h, mut random) = (&generated.model, 1e-6, Random::new(8));
    let (n, mut compared, mut largest) = (model.nv(), 0, 0.0_f64);
    for given in given(model, 0.095, 12) {
        let (weights, along) = (random.vector(n, -1.0, 1.0), random.vector(n, -1.0, 1.0));
        let slope = |by: f64| {
            let v: Vec<f64> = given[1].iter().zip(&along).map(|(v, dv)| v + by * dv).collect();
            let more: Vec<&[f64]> = vec![&given[0], &v, &given[2], &given[3], &given[4], &weights];
            generated.graphs[0].evaluate(|argument, k| more[argument][k])
        };
        let [near, far] = [h, 2.0 * h].map(|h| {
            let (after, before) = (slope(h), slope(-h));
            after.iter().zip(before).map(|(a, b)| (a - b) / (2.0 * h)).collect::<Vec<f64>>()
        });
        let scale = near.iter().fold(1.0_f64, |most, x| most.max(x.abs()));
        if near.iter().zip(&far).all(|(a, b)| (a - b).abs() < 1e-4 * scale) {
            let more: Vec<&[f64]> = vec![&given[0], &given[1], &given[2], &given[3], &given[4], &weights, &along];
            assert_close("hvp", &generated.graphs[1].evaluate(|argument, k| more[argument][k]), &near, 1e-3);
            (compared, largest) = (compared + 1, largest.max(scale));
        }
    }
    assert!(compared > 6 && largest > 2.0, "{compared} states were compared, of slopes up to {largest}");
}

/// A contact that a caller finds is the one that is computed.
#[test]
fn given_contacts_are_those_that_are_computed() {
    let names =
        ["constrained_acceleration_with_contacts", "constrained_step_implicit_damping_with_contacts", "contact_forces_with_contacts"];
    let text =
        BALL.replace("<geom type='plane'", "<geom name='floor' type='plane'").replace("<geom size='0.1'", "<geom name='ball' size='0.1'");
    for (shapes, sign) in [(["floor", "ball"], 1.0), (["ball", "floor"], -1.0)] {
        let mut request = Request::new("ball.xml", text.clone());
        request.options = Options { functions: names.iter().map(|f| (*f).into()).collect(), ..Options::default() };
        let pair = GivenContact { shapes: shapes.map(str::to_owned), places: 2 };
        request.options.robot.given_contacts = vec![pair.into()];
        let generated = generate(&request).unwrap();
        let plain = Request::new("ball.xml", text.clone()).build_robot().unwrap().model;
        assert_eq!((generated.model.shape().given, generated.model.shape().contacts, plain.shape().contacts), (2, 0, 1));
        for given in given(&plain, 0.095, 6) {
            let [q, v, act, ctrl, warm, h] = &given;
            // The second place does not exist, and the third number of a place is its point.
            let low = q[2] - 0.1;
            let contact = [1.0, low, q[0], q[1], 0.5 * low, 0.0, 0.0, sign];
            let contacts = [contact, [0.0, -1.0, 9.0, 9.0, 9.0, 1.0, 0.0, 0.0]].concat();
            for (k, name) in names[..2].iter().enumerate() {
                let expected = called(NAMES[k], &plain, &given);
                let all: [&[f64]; 7] = [q, v, act, ctrl, &contacts, warm, h];
                assert_close(name, &generated.graphs[k].evaluate(|argument, k| all[argument][k]), &expected, 1e-12);
                let mut out = vec![0.0; expected.len()];
                let row = step(name).unwrap();
                row.call(&generated.model, &mut Workspace::new(&generated.model), &all[..row.takes.len()], &mut out).unwrap();
                assert_close(name, &out, &expected, 1e-12);
            }
            // Forces of the contact are those of the one that is computed; the second one has none.
            let found = called(NAMES[1], &plain, &given).split_off(plain.nq() + plain.nv());
            let mut expected = [0.0; 26];
            step("contact_forces").unwrap().call(&plain, &mut Workspace::new(&plain), &[q, v, &found], &mut expected[..13]).unwrap();
            let all: [&[f64]; 4] = [q, v, &contacts, &found];
            assert_close(names[2], &generated.graphs[2].evaluate(|argument, k| all[argument][k]), &expected, 1e-12);
        }
    }
    // Functions that would leave given contacts out are errors.
    let mut request = Request::new("ball.xml", text.clone());
    request.options = Options { functions: vec!["contact_forces".into()], ..Options::default() };
    request.options.robot.given_contacts = vec![GivenContact { shapes: ["floor", "ball"].map(str::to_owned), places: 2 }.into()];
    assert!(generate(&request).unwrap_err().to_string().contains("2 contacts that a caller gives"));
    // Without such pairs there is no function; unknown names are errors.
    let mut request = Request::new("ball.xml", text);
    request.options = Options { functions: vec![names[0].into()], ..Options::default() };
    assert!(generate(&request).unwrap_err().to_string().contains("no contact that a caller gives"));
    let pair = GivenContact { shapes: ["floor", "bal"].map(str::to_owned), places: 1 };
    request.options.robot.given_contacts = vec![pair.into()];
    assert!(generate(&request).unwrap_err().to_string().contains("no pair of the geoms \"floor\" and \"bal\" that may touch"));
}
