//! SDF, the format of Gazebo (SDFormat 1.4 to 1.12): a strict reader of models.
//!
//! A file goes from elements (tags with their places, included files in their tags) to a graph of
//! frames, links and joints with their names resolved, then to a [`Description`]. No input makes
//! it panic, hang or overflow its stack.
//!
//! # What becomes of it
//!
//! * The world is the root link `world`. Joints with the parent `world` hang on it. A model without
//!   such a joint floats: its root link has a floating joint `<link>_free` on the world, of which
//!   the coordinates are the pose in the world. The poses of the file are where a motion starts,
//!   the `home` state of the world. The links of a static model are fixed to the world.
//! * Links keep their frames. A joint that is not at the origin of its child link moves an
//!   intermediate link, to which the child is fixed.
//! * The models of a world are one robot with the name of the world. Their links are called
//!   `model::link`.
//! * A universal joint with limits or forces, and a revolute2 joint, are two revolute joints in
//!   sequence: `<joint>` and `<joint>_2`.
//! * A link that is reached from the child of a joint hangs on that joint in reverse: the axis
//!   changes its sign, so that the coordinate stays that of the file.
//! * A joint that closes a loop is an error, unless `must_be_loop_joint` cuts it.
//! * A URDF in an `<include>` is a model: its tags are made of the description.
//! * Links of nested models are called `model::link`, as in the file. A `<frame>` is a frame.
//!
//! The rest of the file is listed as unused, with its line. An unknown tag is a warning.

mod auto;
mod convert;
mod grammar;
mod graph;
mod joints;
mod links;
mod load;
mod lower;
mod names;
mod shapes;
mod values;

#[cfg(doc)]
use articulated_core::description::Description;
use articulated_core::diagnostic::Diagnostics;

use crate::xml::markup;
use crate::{Format, Input, world};

/// The format of SDF files.
#[derive(Clone, Copy, Debug)]
pub struct Sdf;

impl Format for Sdf {
    fn name(&self) -> &'static str {
        "sdf"
    }

    fn extensions(&self) -> &'static [&'static str] {
        &["sdf", "world"]
    }

    fn recognizes(&self, bytes: &[u8]) -> bool {
        markup::root(bytes).is_some_and(|name| name.eq_ignore_ascii_case(b"sdf"))
    }

    fn includes_files(&self) -> bool {
        true
    }

    fn read(&self, input: &Input<'_>, diagnostics: &mut Diagnostics) -> Option<world::Document> {
        let root = load::Loader::new(input).root(diagnostics)?;
        grammar::check(&root, diagnostics);
        let graph = graph::Graph::of(&root, input.options, diagnostics)?;
        lower::lower(&graph, input.options, diagnostics)
    }
}
