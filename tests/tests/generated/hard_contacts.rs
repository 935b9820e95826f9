//! Accelerations with constraints in hard cases: how far what `f64` and `f32` find is from the
//! optimum, bounded in 96 digits.

use articulated_codegen::Request;
use articulated_core::Scalar;
use articulated_core::algorithm::{Workspace, function};
use articulated_core::model::Model;
use articulated_core::step::{State, rollout, step};
use articulated_reference::Big;

struct Case {
    name: &'static str,
    world: &'static str,
    /// Velocities of the first free joint, [ω; v], rad/s and m/s.
    v: [f64; 6],
    /// Steps to the state, by MuJoCo's Euler.
    steps: usize,
    /// No more of the bound of the error in `f64` and in `f32`, over ‖a₀‖_M: with elliptic cones,
    /// and with pyramids.
    most: [[f64; 2]; 2],
}

const STILL: [f64; 6] = [0.0; 6];

const CASES: [Case; 9] = [
    Case {
        name: "a crate in a corner: twelve contacts, three would do",
        world: "<geom type='plane' size='1 1 1'/><geom type='plane' size='1 1 1' zaxis='1 0 0'/><geom type='plane' size='1 1 1' zaxis='0 1 0'/>\
                <body pos='0.1 0.15 0.2'><freejoint/><geom type='box' size='0.1001 0.1501 0.2001'/></body>",
        v: [0.0, 0.0, 0.0, -0.1, -0.2, -0.3],
        steps: 1,
        most: [[5e-12, 5e-3]; 2],
    },
    Case {
        name: "a table on four feet",
        world: "<geom type='plane' size='1 1 1'/><body pos='0 0 0.5'><freejoint/><geom type='box' size='0.4 0.3 0.02'/>\
                <geom type='sphere' size='0.02' pos='0.35 0.25 -0.4805'/><geom type='sphere' size='0.02' pos='-0.35 0.25 -0.4805'/>\
                <geom type='sphere' size='0.02' pos='0.35 -0.25 -0.4805'/><geom type='sphere' size='0.02' pos='-0.35 -0.25 -0.4805'/></body>",
        v: STILL,
        steps: 2,
        most: [[1e-13, 1e-4]; 2],
    },
    Case {
        name: "a million kg on one kg",
        world: "<geom type='plane' size='1 1 1'/><body pos='0 0 0.1'><freejoint/><geom size='0.1' mass='1'/></body>\
                <body pos='0 0 1.1999'><joint type='slide' axis='0 0 1'/><geom size='1' mass='1e6'/></body>",
        v: STILL,
        steps: 3,
        most: [[2e-15, 1e-6]; 2],
    },
    Case {
        name: "no friction",
        world: "<geom type='plane' size='1 1 1' friction='0 0 0'/><body pos='0 0 0.09'><freejoint/><geom type='box' size='0.1 0.1 0.1' friction='0 0 0' condim='6'/></body>",
        v: [1.0, 2.0, 3.0, 4.0, 5.0, -6.0],
        steps: 2,
        most: [[5e-12, 2e-3], [5e-2, 1e3]],
    },
    Case {
        name: "friction of a thousand",
        world: "<geom type='plane' size='1 1 1' friction='1000 1 1'/><body pos='0 0 0.09'><freejoint/><geom type='box' size='0.1 0.1 0.1' friction='1000 1 1' condim='6'/></body>",
        v: [1.0, 2.0, 3.0, 4.0, 5.0, -6.0],
        steps: 2,
        most: [[1e-11, 1e-2], [2e-15, 1e-6]],
    },
    Case {
        name: "limits exceeded by three radians",
        world: "<body pos='0 0 0'><freejoint/><geom size='0.1'/><body><joint axis='0 1 0' range='170 180'/><geom type='capsule' fromto='0 0 0 0.3 0 0' size='0.02'/>\
                <body pos='0.3 0 0'><joint axis='0 0 1' range='170 180'/><geom type='capsule' fromto='0 0 0 0.3 0 0' size='0.02'/></body></body></body>",
        v: STILL,
        steps: 0,
        most: [[1e-12, 1e-3]; 2],
    },
    Case {
        name: "half a metre under the floor",
        world: "<geom type='plane' size='1 1 1'/><body pos='0 0 -0.5'><freejoint/><geom type='box' size='0.1 0.2 0.1'/></body>",
        v: STILL,
        steps: 0,
        most: [[1e-12, 1e-3]; 2],
    },
    Case {
        name: "a chain at 100 m/s",
        world: "<geom type='plane' size='1 1 1'/><body pos='0 0 0.11' euler='20 30 0'><freejoint/><geom type='capsule' fromto='0 0 0 0.2 0 0' size='0.03'/>\
                <body pos='0.2 0 0'><joint axis='0 1 0'/><geom type='capsule' fromto='0 0 0 0.2 0 0' size='0.03'/>\
                <body pos='0.2 0 0'><joint axis='0 0 1'/><geom type='capsule' fromto='0 0 0 0.2 0 0' size='0.03'/>\
                <body pos='0.2 0 0'><joint axis='0 1 0'/><geom type='capsule' fromto='0 0 0 0.2 0 0' size='0.03'/></body></body></body></body>",
        v: [0.0, 0.0, 5.0, 0.0, 0.0, -100.0],
        steps: 2,
        most: [[5e-11, 0.5]; 2],
    },
    Case {
        name: "a link of a microgram",
        world: "<geom type='plane' size='1 1 1'/><body pos='0 0 0.3'><freejoint/><geom size='0.1'/><body pos='0 0 -0.2'><joint axis='0 1 0'/>\
                <geom size='0.1005' pos='0.01 0 0' mass='1e-9'/></body></body>",
        v: STILL,
        steps: 2,
        most: [[1e-12, 1e-4]; 2],
    },
];

/// What the search finds, and after how many steps.
fn searched<S: Scalar>(model: &Model<S>, q: &[S], v: &[S]) -> (Vec<S>, S) {
    let row = step::<S>("constrained_search").unwrap();
    let (zeros, mut out) = (vec![S::zero(); v.len()], vec![S::zero(); v.len() + 3]);
    row.call(model, &mut Workspace::new(model), &[q, v, &[], &[], &zeros], &mut out).unwrap();
    let steps = out[v.len() + 2];
    out.truncate(v.len());
    (out, steps)
}

/// The bound of an acceleration's error over ‖a₀‖_M, in 96 digits.
fn error(model: &Model<f64>, q: &[f64], v: &[f64], found: &[f64]) -> f64 {
    let big = |x: &[f64]| x.iter().map(|x| Big::from_f64(*x)).collect::<Vec<Big>>();
    let model = model.map(Big::from_f64);
    let mut out = [Big::from_f64(0.0); 2];
    let row = step::<Big>("constrained_error").unwrap();
    row.call(&model, &mut Workspace::new(&model), &[&big(q), &big(v), &[], &[], &big(found)], &mut out).unwrap();
    (out[0] / out[1]).to_f64()
}

/// The distance to the optimum over the size of the acceleration without constraints, both by M, in
/// 96 digits.
fn distance(model: &Model<f64>, q: &[f64], v: &[f64], found: &[f64]) -> f64 {
    let big = |x: &[f64]| x.iter().map(|x| Big::from_f64(*x)).collect::<Vec<Big>>();
    let (wide, q, v) = (model.map(Big::from_f64), big(q), big(v));
    let row = step::<Big>("constrained_search").unwrap();
    let mut ws = Workspace::new(&wide);
    let mut out = vec![Big::from_f64(0.0); v.len() + 3];
    // From beside the optimum: a step of Newton's method squares its distance, and ends far below
    // the roundings of f64.
    let start: Vec<Big> = found.iter().map(|x| Big::from_f64(x * (1.0 + 1e-5))).collect();
    row.call(&wide, &mut ws, &[&q, &v, &[], &[], &start], &mut out).unwrap();
    let best = &out[..v.len()];
    let apart: Vec<Big> = best.iter().zip(big(found)).map(|(a, b)| *a - b).collect();
    let mut mass = vec![Big::from_f64(0.0); v.len() * v.len()];
    function::<Big>("mass_matrix").unwrap().call(&wide, &mut ws, &[&q], &mut mass).unwrap();
    let square =
        (0..v.len()).fold(Big::from_f64(0.0), |sum, i| (0..v.len()).fold(sum, |sum, j| sum + apart[i] * mass[i * v.len() + j] * apart[j]));
    (Scalar::sqrt(square) / out[v.len() + 1]).to_f64()
}

#[test]
fn hard_cases_are_solved() {
    let mut failed = Vec::new();
    for Case { name, world, v, steps, most } in &CASES {
        for (cone, most) in ["elliptic", "pyramidal"].into_iter().zip(most) {
            let text = format!("<mujoco><option cone='{cone}' timestep='0.001'/><worldbody>{world}</worldbody></mujoco>");
            let model = Request::new("hard.xml", text.clone()).build_robot().unwrap().model;
            let mut state = State::neutral(&model);
            let world = Request::new("hard.xml", text).build_robot().unwrap().reading.world;
            for (joint, q) in world.home.iter().flat_map(|home| &home.q) {
                let own = model.joints().iter().find(|own| own.name == *joint).unwrap();
                state.q[own.q.0..][..own.q.1].copy_from_slice(q);
            }
            state.v[..6].copy_from_slice(v);
            let euler = step::<f64>("constrained_step_implicit_damping").unwrap();
            rollout(euler, (&model, &mut Workspace::new(&model)), &mut state, 1e-3, (0..*steps).map(|_| [].as_slice()), |_, _| {}).unwrap();
            let (found, turns) = searched(&model, &state.q, &state.v);
            let of_f64 = error(&model, &state.q, &state.v, &found);
            let single = |x: &[f64]| x.iter().map(|x| *x as f32).collect::<Vec<f32>>();
            let narrow = model.map(|x| x as f32);
            let (q, v) = (single(&state.q), single(&state.v));
            let (in_f32, turns_32) = searched(&narrow, &q, &v);
            // The same numbers in both: roundings of the state are no error of the search.
            let wide = |x: &[f32]| x.iter().map(|x| f64::from(*x)).collect::<Vec<f64>>();
            let of_f32 = error(&narrow.map(f64::from), &wide(&q), &wide(&v), &wide(&in_f32));
            let apart = distance(&model, &state.q, &state.v, &found);
            println!("{name:52} {cone:9} {apart:6.0e} f64 {of_f64:6.0e} in {turns:2} steps, f32 {of_f32:6.0e} in {turns_32:2}");
            // The bound is one.
            if !(apart <= of_f64 * (1.0 + 1e-9) && apart < 1e-13 && of_f64 <= most[0] && of_f32 <= most[1] && turns < 50.0) {
                failed.push(format!("{name}, {cone}: {of_f64:e} {of_f32:e} {turns} {turns_32}"));
            }
        }
    }
    assert!(failed.is_empty(), "{failed:#?}");
}
