//! Every bundled scene: generated code is the generic library's.

use articulated_codegen::scene::articulated_scene::Robot;
use articulated_codegen::scene::{Scene, prepare};
use articulated_codegen::{Generated, generate};
use articulated_core::algorithm::{Workspace, function};
use articulated_core::model::Model;
use articulated_tests::program::Program;
use articulated_tests::random::Random;

const FUNCTIONS: [&str; 4] = ["inverse_dynamics", "forward_dynamics", "mass_matrix", "dissipation"];

fn call(model: &Model<f64>, name: &str, arguments: &[&[f64]]) -> Vec<f64> {
    let function = function::<f64>(name).expect("in the table");
    let mut out = vec![0.0; function.len(model.shape())];
    function.call(model, &mut Workspace::new(model), arguments, &mut out).expect("lengths as the table says");
    out
}

/// A scene's robot, subject to its effects, generated and generic.
fn subject(scene: &articulated_models::BundledScene) -> (Generated, Model<f64>) {
    let read_scene = Scene::read(&format!("{}.toml", scene.name), scene.toml).expect("a scene");
    let Robot::Bundled(name) = read_scene.robot.clone() else { panic!("{}: of a bundled robot", scene.name) };
    let robot = articulated_models::robot(&name).expect("a bundled robot");
    let mut request = prepare(read_scene, &format!("{name}.urdf"), robot.urdf.into(), robot.base, Vec::new()).expect("a robot").request;
    request.options.functions = FUNCTIONS.map(Into::into).to_vec();
    let generic = request.build_robot().expect("a robot").model;
    (generate(&request).expect("a module"), generic)
}

#[test]
fn generated_code_of_every_scene_is_the_generic_librarys() {
    let subjects: Vec<(&str, (Generated, Model<f64>))> = articulated_models::SCENES.iter().map(|s| (s.name, subject(s))).collect();
    assert!(subjects.iter().filter(|(_, (_, m))| m.bodies().iter().any(|b| !b.effects.kinds().is_empty())).count() >= 5);
    let named: Vec<(&str, &Generated)> = subjects.iter().map(|(name, (generated, _))| (*name, generated)).collect();
    let program = Program::build(&named, &["-C", "opt-level=1", "-C", "target-cpu=native"]);
    println!("compiled in {:.1?}", program.time);
    let random = &mut Random::new(3);
    for (scene, (_, model)) in &subjects {
        for _ in 0..10 {
            let q = call(model, "random_configuration", &[&random.vector(model.nq(), 0.0, 1.0)]);
            let (v, a) = (random.vector(model.nv(), -2.0, 2.0), random.vector(model.nv(), -2.0, 2.0));
            for name in FUNCTIONS {
                let arguments: Vec<&[f64]> = [&q[..], &v, &a][..function::<f64>(name).expect("in the table").takes.len()].to_vec();
                let (found, expected) = (program.run(scene, name, std::slice::from_ref(&arguments)), call(model, name, &arguments));
                let scale = expected.iter().fold(1.0_f64, |m, x| m.max(x.abs()));
                let far = found[0].iter().zip(&expected).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()));
                assert!(far <= 1e-9 * scale, "{scene}, {name}: {far} of {scale}");
            }
        }
    }
}
