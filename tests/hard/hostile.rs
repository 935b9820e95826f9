//! A readable robot is a model, or an error that names the overflow; its results are finite or an
//! error, and nothing panics, whatever the numbers.

use articulated_codegen::model_pass::View;
use articulated_codegen::{Request, generate};
use articulated_core::algorithm::{Workspace, checked_forward_dynamics, integrate, inverse_dynamics, neutral};
use articulated_core::description::Base;
use articulated_core::model::{Model, ModelError};
use articulated_formats::{Options, read};
use articulated_tests::random::Random;

/// Numbers that files should not have, and some have.
const NUMBERS: [&str; 16] = [
    "0",
    "-0",
    "1e308",
    "-1e308",
    "1e-308",
    "5e-324",
    "1e-320",
    "1e200",
    "-1e-200",
    "1e15",
    "3.141592653589793",
    "1.5707963",
    "-1",
    "1e-9",
    "2",
    "0.1",
];

/// The document with some of its numbers replaced.
fn mutated(urdf: &str, random: &mut Random) -> String {
    let quoted: Vec<&str> = urdf.split('"').collect();
    let numeric = |k: &usize| k % 2 == 1 && quoted[*k].split_whitespace().all(|w| w.parse::<f64>().is_ok());
    let places: Vec<usize> = (0..quoted.len()).filter(numeric).collect();
    let mut out: Vec<String> = quoted.iter().map(|s| (*s).to_owned()).collect();
    for _ in 0..=random.below(4) {
        let at = *random.choose(&places);
        let mut words: Vec<&str> = quoted[at].split_whitespace().collect();
        let k = random.below(words.len());
        words[k] = NUMBERS[random.below(NUMBERS.len())];
        out[at] = words.join(" ");
    }
    out.join("\"")
}

/// Factor on the number of cases of a normal run: HOSTILE=100 takes a while.
fn patience() -> u64 {
    std::env::var("HOSTILE").ok().and_then(|n| n.parse().ok()).unwrap_or(1)
}

fn answers(urdf: &str, seed: u64) -> bool {
    let options = Options { allow_unphysical_inertia: true, ..Options::default() };
    let Ok(reading) = read(urdf.as_bytes(), &options) else { return false };
    for base in [Base::Fixed, Base::Floating] {
        let model = match Model::new(&reading.description, base) {
            Ok(model) => model,
            Err(ModelError::TooLarge { .. }) => return false,
            Err(e) => panic!("seed {seed}: {e}"),
        };
        let _ = model.massless_joints();
        let passed = View::new(model.clone()).passed();
        let (mut at, mut q) = (vec![0.0; model.nq()], vec![0.0; model.nq()]);
        neutral(&model, &mut at);
        let (half, mut out) = (vec![0.5; model.nv()], vec![0.0; model.nv()]);
        integrate(&model, &mut Workspace::new(&model), &at, &half, &mut q);
        inverse_dynamics(&passed.model, &mut passed.workspace(), &q, &half, &half, &mut out);
        let solved = checked_forward_dynamics(&model, &mut Workspace::new(&model), &q, &half, &half, &mut out);
        assert!(solved.is_err() || out.iter().all(|x| x.is_finite()), "seed {seed}: {out:?}");
    }
    true
}

#[test]
fn robots_with_any_numbers_are_answered() {
    let mut read = 0;
    for (k, robot) in articulated_models::ROBOTS.iter().enumerate() {
        // Fewer of the large ones.
        let count = patience() * 40_000 / robot.urdf.len().max(400) as u64;
        for seed in 0..count {
            let mut random = Random::new(seed * 16 + k as u64);
            read += usize::from(answers(&mutated(robot.urdf, &mut random), seed));
        }
    }
    assert!(read > 40, "{read}");
}

#[test]
fn code_is_made_of_any_numbers_or_an_error() {
    let mut made = 0;
    for seed in 0..40 * patience() {
        let robot = &articulated_models::ROBOTS[seed as usize % 4];
        let text = mutated(robot.urdf, &mut Random::new(1000 + seed));
        let mut request = Request::new("hostile.urdf", text);
        request.options.functions = vec!["inverse_dynamics".into(), "forward_dynamics".into()];
        request.options.robot.allow_unphysical_inertia = true;
        if let Ok(generated) = generate(&request) {
            let _ = generated.tokens();
            made += 1;
        }
    }
    assert!(made > 10, "{made}");
}
