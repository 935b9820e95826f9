//! The robots that are compiled, once, for all tests of this binary.

use std::sync::LazyLock;

use articulated_codegen::{Generated, Request, generate};
use articulated_core::algorithm::functions;
use articulated_core::description::Base;
use articulated_tests::case::{Case, read};
use articulated_tests::program::Program;
use articulated_tests::random_tree::{Flavour, random_tree};
use articulated_tests::urdf_text::urdf_text;

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
    bundled.chain(trees).chain([robot("stone".into(), stone, Base::Fixed, false)]).collect()
});

/// With every function, save those that need a regular mass matrix where it may be singular.
fn robot(name: String, urdf: &str, base: Base, singular: bool) -> Robot {
    let mut request = Request::new(format!("{name}.urdf"), urdf);
    request.options.base = base;
    request.options.functions =
        functions::<f64>().iter().filter(|f| !singular || !f.inverts_mass_matrix()).map(|f| f.name.into()).collect();
    let generated = generate(&request).unwrap_or_else(|e| panic!("{name}: {e}"));
    Robot { case: Case::new(name.clone(), read(urdf), base), generated, name }
}

/// All of them for this machine.
pub(crate) static NATIVE: LazyLock<Program> = LazyLock::new(|| {
    let all: Vec<(&str, &Generated)> = ROBOTS.iter().map(|r| (r.name.as_str(), &r.generated)).collect();
    let program = Program::build(&all, &["-C", "opt-level=3", "-C", "target-cpu=native"]);
    println!("compiled {} robots in {:.1?}", all.len(), program.time);
    program
});

/// Some of them as `cargo build` compiles for anybody: no fused multiply-add; and with every check that the compiler knows.
pub(crate) static PORTABLE: LazyLock<Program> = LazyLock::new(|| {
    let some: Vec<(&str, &Generated)> = ["panda_like", "gripper_arm", "tree_1", "stone"]
        .iter()
        .map(|name| ROBOTS.iter().find(|r| r.name == *name).expect("one of them"))
        .map(|r| (r.name.as_str(), &r.generated))
        .collect();
    let program = Program::build(&some, &["-O", "-C", "debug-assertions=on"]);
    println!("compiled {} robots without multiply-add in {:.1?}", some.len(), program.time);
    program
});
