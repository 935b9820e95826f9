//! The frames for lists of all functions.
//!
//! A robot has a frame for each link, and the cost of a function of frames grows with them. Such
//! lists use the tips: moving links that carry no other.

use articulated_core::algorithm::{Function, Needs};
use articulated_core::description::Description;
use articulated_core::model::Model;

/// Why a function is not defined on any tip.
pub const FEW: &str = "fewer than six degrees of freedom carry each tip";

/// Names of the links at the tips.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Tips {
    all: Vec<String>,
    /// Those that six or more degrees of freedom carry.
    free: Vec<String>,
}

impl Tips {
    /// Those of a robot; `model` has a frame for each link.
    pub fn of(description: &Description, model: &Model<f64>) -> Self {
        let bare = |name: &str| description.link(name).is_some_and(|l| description.joints.iter().all(|j| j.parent != l));
        let with = |least: usize| {
            let moved = model.frames().iter().filter(|f| bare(&f.name) && model.freedoms_of(f.body).len() >= least);
            moved.map(|f| f.name.clone()).collect::<Vec<_>>()
        };
        Self { all: with(1), free: with(6) }
    }

    /// The tips.
    pub fn all(&self) -> &[String] {
        &self.all
    }

    /// The frames that a function is defined on; `None` if it needs some and there are none.
    pub fn of_function<S>(&self, function: &Function<S>) -> Option<&[String]> {
        match function.needs {
            Needs::FreeFrames => Some(self.free.as_slice()).filter(|f| !f.is_empty()),
            _ => Some(&self.all),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tips(name: &str) -> Tips {
        let robot = articulated_models::robot(name).unwrap();
        let options = articulated_formats::Options { base: robot.base, ..articulated_formats::Options::default() };
        let description = articulated_formats::read(robot.urdf.as_bytes(), &options).unwrap().description;
        Tips::of(&description, &Model::new(&description, robot.base).unwrap())
    }

    #[test]
    fn a_quadruped_has_four_feet_and_a_sensor_and_a_cart_no_free_tip() {
        assert_eq!((tips("quadruped").all.len(), tips("quadruped").free.len()), (5, 5));
        assert_eq!((tips("cart_pole").all.len(), tips("cart_pole").free.len()), (1, 0));
    }
}
