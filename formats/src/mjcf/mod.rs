//! MJCF, the format of MuJoCo: a strict reader.
//!
//! A file goes from elements (tags with their places, included files in place) to bodies (frames,
//! copies, attached models and default classes resolved), then to a [`Description`]. No input makes
//! it panic, hang or overflow its stack.
//!
//! # What becomes of it
//!
//! * The world is the root link `world`; a body is a link. A body without joints hangs on a fixed
//!   joint, one with several joints on a sequence with intermediate links. A body whose last joint
//!   is not at its origin is fixed to an intermediate link at the anchor.
//! * A coordinate is that of the file: at `ref` the body is where its `pos` says. A free joint is a
//!   floating joint on the world: its coordinates are the pose of the body in the world, whatever
//!   `pos` says.
//! * A site is a frame. Names that the file leaves out are made: `body_3`, `arm_hinge`.
//! * Masses are those of `<inertial>` or of the geoms, as `<compiler>` says.
//! * Limits, damping, friction, armature and springs of joints are kept in the description, unless
//!   a flag of `<option>` turns them off.
//! * The frame of a free body without children is that of its inertia, where `align` says so.
//! * Gravity, step, integrator, states, actuators, springs of tendons, equations of joints and
//!   planes become a [`World`](crate::world::World).
//!
//! The rest of the file is listed as unused, with its line. An unknown tag or attribute is an
//! error.

mod actuators;
mod align;
mod anchors;
mod axes;
mod bodies;
mod contact;
mod documents;
mod element;
mod ellipsoid;
mod equalities;
mod geometry;
mod grammar;
mod hull;
mod inertia;
mod left_out;
mod lower;
mod mass;
mod medium;
mod mesh;
mod paths;
mod reflected;
mod scope;
mod settings;
mod simulation;
mod states;
mod surroundings;
mod tendons;
mod touching;
mod values;
mod world;

use std::collections::BTreeSet;

#[cfg(doc)]
use articulated_core::description::Description;
use articulated_core::diagnostic::Diagnostics;

use crate::world::Document;
use crate::xml::markup;
use crate::{Format, Input};

/// The format of MJCF files.
#[derive(Clone, Copy, Debug)]
pub struct Mjcf;

impl Format for Mjcf {
    fn name(&self) -> &'static str {
        "mjcf"
    }

    fn extensions(&self) -> &'static [&'static str] {
        &["xml", "mjcf"]
    }

    fn recognizes(&self, bytes: &[u8]) -> bool {
        markup::root(bytes).is_some_and(|name| name.eq_ignore_ascii_case(b"mujoco"))
    }

    fn includes_files(&self) -> bool {
        true
    }

    fn read(&self, input: &Input<'_>, diagnostics: &mut Diagnostics) -> Option<Document> {
        input.options.warn_of_arguments(&BTreeSet::new(), diagnostics);
        let documents = documents::Documents::read(input, diagnostics)?;
        let name = documents.root(0).text("model").filter(|name| !name.trim().is_empty()).unwrap_or("robot");
        let simulation = simulation::Simulation::of(&documents, diagnostics);
        let mut tree = bodies::tree(&documents, simulation.flags(), &input.options.leave_out, diagnostics);
        let mut meshes = mesh::Meshes::new(input.sources);
        let mut inertials = inertia::of_bodies(&tree.bodies, &mut meshes, diagnostics);
        align::align(&mut tree.bodies, &mut inertials);
        let mut lowered = lower::lower(name, &tree.bodies, &inertials, input.options, diagnostics);
        let world =
            world::world(&documents, (&tree, &inertials, &mut meshes), &simulation, (&mut lowered, &input.options.leave_out), diagnostics);
        Some(Document { description: lowered.description, world })
    }
}
