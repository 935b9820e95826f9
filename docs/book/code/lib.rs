//! What the examples of the book share: the bundled robots, states, and the laws that results keep.
//!
//! The chapters are in `docs/book/src`. `cargo test -p articulated-book` compiles and runs every
//! code block, and compares every quotation with the file that it quotes.

use articulated::algorithm::textbook::Textbook;
use articulated::description::Description;
use articulated::{Base, Model};

mod counted;
mod expanded;
mod formula;
mod screws;
pub use counted::{Counted, count};
pub use expanded::{Expanded, unit_links};
pub use formula::formulas;
pub use screws::{exponential, pose, screw, screw_matrix, space_screws};

/// A robot in all forms that the book uses.
#[derive(Clone, Debug)]
pub struct Robot {
    /// What the file says.
    pub description: Description,
    /// What the library computes with.
    pub model: Model<f64>,
    /// The textbook's matrices.
    pub textbook: Textbook<f64>,
}

/// A configuration, rates, accelerations and torques.
#[derive(Clone, Debug)]
pub struct State {
    /// `[nq]`, rad, m, or a unit quaternion (x, y, z, w).
    pub q: Vec<f64>,
    /// `[nv]`, rad/s or m/s.
    pub v: Vec<f64>,
    /// `[nv]`, rad/s² or m/s².
    pub a: Vec<f64>,
    /// `[nv]`, N·m or N.
    pub tau: Vec<f64>,
}

/// A robot that comes with the library.
///
/// # Panics
/// If there is none of this name.
pub fn robot(name: &str) -> Robot {
    let bundled = articulated_models::robot(name).unwrap_or_else(|| panic!("no robot {name}"));
    read(&format!("{name}.urdf"), bundled.urdf, bundled.base)
}

/// A robot of a file's text.
///
/// # Panics
/// If the text is not a robot.
pub fn read(file: &str, text: &str, base: Base) -> Robot {
    let description = articulated::describe_bytes(file, text.as_bytes()).expect("a robot");
    let model = Model::new(&description, base).expect("a robot that moves");
    let textbook = Textbook::new(&description, base, [0.0, 0.0, -9.81]).expect("as the model");
    Robot { description, model, textbook }
}

impl Robot {
    /// Some state: the same for the same `seed`, and no number in it is zero.
    pub fn state(&self, seed: u32) -> State {
        let numbers = |of: u32| -> Vec<f64> {
            (0..self.model.nv()).map(|k| (f64::from(seed) * 0.7 + f64::from(of) * 1.9 + k as f64 * 2.3 + 0.4).sin()).collect()
        };
        let q = self.textbook.integrate(&self.model.neutral(), &numbers(0));
        State { q, v: numbers(1), a: numbers(2), tau: numbers(3) }
    }

    /// |τ·v − dE/dt| over the sum of |τ_k v_k|, with E = T + U along the motion: zero for the
    /// torques of that motion. Central differences leave about 1e-8.
    pub fn power_gap(&self, state: &State, tau: &[f64]) -> f64 {
        let h = 1e-5;
        let energy = |h: f64| {
            let scaled = |x: &[f64]| x.iter().map(|x| h * x).collect::<Vec<_>>();
            let middle: Vec<f64> = state.v.iter().zip(scaled(&state.a)).map(|(v, a)| v + 0.5 * a).collect();
            let q = self.textbook.integrate(&state.q, &scaled(&middle));
            let v: Vec<f64> = state.v.iter().zip(scaled(&state.a)).map(|(v, a)| v + a).collect();
            self.textbook.kinetic_energy(&q, &v) + self.textbook.potential_energy(&q)
        };
        let power: f64 = tau.iter().zip(&state.v).map(|(t, v)| t * v).sum();
        let scale: f64 = tau.iter().zip(&state.v).map(|(t, v)| (t * v).abs()).sum();
        ((energy(h) - energy(-h)) / (2.0 * h) - power).abs() / scale
    }
}

/// The largest difference of two vectors over the largest entry.
///
/// # Panics
/// If the lengths differ.
pub fn distance(found: &[f64], expected: &[f64]) -> f64 {
    assert_eq!(found.len(), expected.len());
    let largest = expected.iter().fold(f64::MIN_POSITIVE, |most, x| most.max(x.abs()));
    found.iter().zip(expected).fold(0.0_f64, |most, (f, e)| most.max((f - e).abs())) / largest
}

/// A serial arm of `joints` revolute joints; the axes and the inertias change from joint to joint.
pub fn chain(joints: usize) -> Robot {
    let mut text = String::from("<robot name=\"chain\"><link name=\"l0\"/>");
    for k in 1..=joints {
        let axis = ["0 0 1", "0 1 0", "1 0 0"][k % 3];
        let (tilt, below) = (0.1 * (k % 5) as f64, k - 1);
        text += &format!(
            "<link name=\"l{k}\"><inertial><origin xyz=\"0.01 0.02 0.1\"/><mass value=\"1\"/>\
             <inertia ixx=\"0.02\" ixy=\"0.001\" ixz=\"0\" iyy=\"0.02\" iyz=\"0.002\" izz=\"0.01\"/></inertial></link>\
             <joint name=\"j{k}\" type=\"continuous\"><parent link=\"l{below}\"/><child link=\"l{k}\"/>\
             <origin xyz=\"0.02 0.01 0.2\" rpy=\"{tilt} 0.2 0\"/><axis xyz=\"{axis}\"/></joint>"
        );
    }
    read("chain.urdf", &(text + "</robot>"), Base::Fixed)
}

/// The chapters, each a test of its code blocks.
#[cfg(doctest)]
mod chapters {
    macro_rules! chapters {
        ($($name:ident: $file:literal),+ $(,)?) => { $(#[doc = include_str!(concat!("../src/", $file))] mod $name {})+ };
    }
    chapters! {
        introduction: "introduction.md",
        kinematics: "kinematics.md",
        exponentials: "exponentials.md",
        adjoints: "adjoints.md",
        rnea: "rnea.md",
        crba: "crba.md",
        aba: "aba.md",
        numpy: "numpy.md",
        quaternions: "quaternions.md",
        small_angles: "small-angles.md",
        conditioning: "conditioning.md",
        linear_time: "linear-time.md",
        expanded: "expanded.md",
        pendulum: "pendulum.md",
        golfer: "golfer.md",
        humanoid: "humanoid.md",
        pitfalls: "pitfalls.md",
        mended: "mended.md",
        exercises: "exercises.md",
        solutions: "solutions.md",
        bibliography: "bibliography.md",
    }
}
