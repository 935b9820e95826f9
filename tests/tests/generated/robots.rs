//! The robots that are compiled, once, for all tests of this binary.

use std::sync::LazyLock;

use articulated_codegen::{Generated, Options, Request, generate};
use articulated_core::algorithm::{Function, Needs, functions};
use articulated_core::description::Base;
use articulated_core::index::FrameId;
use articulated_core::model::{Frame, Model};
use articulated_tests::case::{Case, State, read};
use articulated_tests::program::Program;
use articulated_tests::random::Random;
use articulated_tests::random_tree::{Flavour, random_tree};
use articulated_tests::urdf_text;

/// A robot, generic and generated.
pub(crate) struct Robot {
    pub(crate) name: String,
    pub(crate) case: Case,
    pub(crate) generated: Generated,
}

impl Robot {
    /// Names of the functions that it was generated with.
    pub(crate) fn functions(&self) -> impl Iterator<Item = &str> {
        self.generated.ledger.functions.iter().map(|f| f.function.as_str())
    }
}

/// How many random trees.
const TREES: u64 = 10;

/// All bundled robots, random trees on both bases, and a link alone.
pub(crate) static ROBOTS: LazyLock<Vec<Robot>> = LazyLock::new(|| {
    let bundled = articulated_models::ROBOTS.iter().map(|r| robot(r.name.into(), r.urdf, r.base, false));
    let trees = (0..TREES).map(|seed| {
        let base = if seed % 2 == 0 { Base::Fixed } else { Base::Floating };
        // Forward dynamics needs a mass matrix that is regular.
        let flavour = if seed % 4 < 2 { Flavour::WRITTEN } else { Flavour { massless: false, ..Flavour::WRITTEN } };
        robot(format!("tree_{seed}"), &urdf_text(&random_tree(100 + seed, flavour)), base, flavour.massless)
    });
    let stone = "<robot name='stone'><link name='stone'/></robot>";
    let walker = robot("walker".into(), include_str!("../../robots/walker.urdf"), Base::Floating, false);
    let strider = robot("strider".into(), include_str!("../../robots/strider.urdf"), Base::Floating, false);
    let humanoid = articulated_models::robot("humanoid").expect("it is bundled");
    let humanoid = only_derivatives("humanoid_derivatives", humanoid.urdf, humanoid.base);
    // Functions with kinds of statements that the other robots that are compiled do not have.
    let some = |name: &str, of: &str, wanted: &'static [&str]| {
        let bundled = articulated_models::robot(of).expect("it is bundled");
        with(name.into(), bundled.urdf, bundled.base, false, Options::default(), |name| wanted.contains(&name))
    };
    let six_axes = some("six_axes", "ur5_like", &["center_of_mass", "inverse_dynamics"]);
    let four_legs = some("four_legs", "quadruped", &["mass_matrix", "bias_forces"]);
    let stone = robot("stone".into(), stone, Base::Fixed, false);
    bundled.chain(trees).chain([humanoid, walker, strider, six_axes, four_legs, stone]).collect()
});

fn only_derivatives(name: &str, urdf: &str, base: Base) -> Robot {
    with(name.into(), urdf, base, true, Options::default(), |name| name == "inverse_dynamics_derivatives")
}

/// With every function, except those that need a missing property of the robot, on one or two
/// frames.
fn robot(name: String, urdf: &str, base: Base, singular: bool) -> Robot {
    let small = Case::new(name.clone(), read(urdf), base).model.nv() < 18;
    with(name, urdf, base, singular, Options::default(), |name| small || !LONG.contains(&name))
}

/// The same with further choices, and of the functions those that are `wanted`.
pub(crate) fn with(name: String, urdf: &str, base: Base, singular: bool, options: Options, wanted: impl Fn(&str) -> bool) -> Robot {
    let mut description = read(urdf);
    options.robot.coupling.iter().for_each(|own| description.couple(own).expect("a joint that can follow"));
    let mut case = Case::new(name.clone(), description, base);
    let frames = frames(&case.model);
    case.model = case.model.with_effects(&options.robot.effects).expect("effects that can be had");
    let mut request = Request::new(format!("{name}.urdf"), urdf);
    request.options = options;
    request.options.robot.base = base;
    request.options.functions =
        functions::<f64>().iter().filter(|f| wanted(f.name) && has(&case.model, &frames, f, singular)).map(|f| f.name.into()).collect();
    request.options.robot.set_frames(frames.iter().cloned());
    let generated = generate(&request).unwrap_or_else(|e| panic!("{name}: {e}"));
    case.model = case.model.with_frames(&frames).expect("its own frames");
    Robot { case, generated, name }
}

/// `count` random states with numbers that are exactly `f32`.
pub(crate) fn single_states(robot: &Robot, count: usize) -> Vec<State> {
    let mut random = Random::new(29);
    let short = |x: &mut Vec<f64>| x.iter_mut().for_each(|x| *x = f64::from(*x as f32));
    let one = |_| {
        let mut s = robot.case.state(&mut random);
        [&mut s.q, &mut s.v, &mut s.a, &mut s.tau, &mut s.wrenches, &mut s.step, &mut s.target, &mut s.uniform].into_iter().for_each(short);
        s
    };
    (0..count).map(one).collect()
}

/// The last frame, and the one in the middle.
fn frames(model: &Model<f64>) -> Vec<String> {
    let n = model.frames().len();
    let mut chosen = vec![model.frames()[FrameId(n - 1)].name.clone(), model.frames()[FrameId(n / 2)].name.clone()];
    chosen.dedup();
    chosen
}

/// Functions that compile slowly for large robots are generated there only with wrenches: without
/// them they are the same with fewer terms.
const LONG: [&str; 2] = ["inverse_dynamics_derivatives", "forward_dynamics_derivatives"];

fn has(model: &Model<f64>, frames: &[String], function: &Function<f64>, singular: bool) -> bool {
    let freedoms = |f: &Frame<f64>| model.freedoms_of(f.body).len();
    let free = model.frames().iter().filter(|f| frames.contains(&f.name)).all(|f| freedoms(f) >= 6);
    match function.needs {
        Needs::Mass => model.moving_mass() > 0.0,
        Needs::Nothing => true,
        Needs::MassMatrix => !singular,
        Needs::FreeFrames => !singular && free,
    }
}

/// Some of them for this machine.
pub(crate) static NATIVE: LazyLock<Program> = LazyLock::new(|| native(ROBOTS.iter().filter(is_compiled)));

/// Robots as one program for this machine.
pub(crate) fn native<'a>(robots: impl Iterator<Item = &'a Robot>) -> Program {
    let all: Vec<(&str, &Generated)> = robots.map(|r| (r.name.as_str(), &r.generated)).collect();
    let program = Program::build(&all, &["-C", "opt-level=1", "-C", "target-cpu=native"]);
    println!("compiled {} robots in {:.1?}", all.len(), program.time);
    program
}

/// The same as `cargo build` compiles for anybody, with every check that the compiler knows:
/// vector instructions and multiply-adds are chosen when it runs.
pub(crate) static CHOSEN: LazyLock<Program> = LazyLock::new(|| {
    let asked = "::std::is_x86_feature_detected!(\"avx2\")";
    anybodys(&COMPILED, "with the instructions that there are", "opt-level=3", |source| source.replace(asked, "crate::has_avx2()"))
});

/// The same program as on a processor without AVX2 and fused multiply-add: a variable of the
/// environment turns them off.
pub(crate) static PORTABLE: LazyLock<Program> = LazyLock::new(|| CHOSEN.with_variable("WITHOUT_AVX2"));

/// The same on a processor that is neither x86-64 nor Arm: its lanes are arrays.
pub(crate) static ELSEWHERE: LazyLock<Program> = LazyLock::new(|| {
    let [asked, other] = ["x86_64", "none"].map(|arch| format!("target_arch = \"{arch}\""));
    anybodys(&LANES.map(|l| l.0), "for another processor", "opt-level=1", |source| source.replace(&asked, &other))
});

/// The robots that are compiled: together they have every kind of statement, which
/// `interpreted.rs` tests.
pub(crate) const COMPILED: [&str; 9] =
    ["panda_like", "gripper_arm", "tree_1", "stone", "six_axes", "four_legs", LANES[0].0, LANES[1].0, LANES[2].0];

pub(crate) fn is_compiled(robot: &&Robot) -> bool {
    COMPILED.contains(&robot.name.as_str())
}

/// Those with limbs in lanes, and how many.
pub(crate) const LANES: [(&str, usize); 3] = [("walker", 4), ("strider", 2), ("humanoid_derivatives", 2)];

fn anybodys(robots: &[&str], how: &str, level: &str, change: impl Fn(String) -> String) -> Program {
    let find = |name: &&str| ROBOTS.iter().find(|r| r.name == *name).expect("one of them");
    let some: Vec<&Robot> = robots.iter().map(find).collect();
    let changed: Vec<Generated> =
        some.iter().map(|r| Generated { source: change(r.generated.source.clone()), ..r.generated.clone() }).collect();
    let named: Vec<(&str, &Generated)> = some.iter().map(|r| r.name.as_str()).zip(&changed).collect();
    let program = Program::build(&named, &["-C", level, "-C", "debug-assertions=on"]);
    println!("compiled {} robots {how} in {:.1?}", named.len(), program.time);
    program
}
