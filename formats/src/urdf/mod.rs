//! URDF: a strict reader.
//!
//! A file goes from document (bytes → XML) to links and joints (checked numbers with their places),
//! then to a tree (names, cycles, roots, mimics), then to a [`Description`]. With the feature
//! `second-reader`, `urdf-rs` reads a plain copy and has to find the same. With the feature
//! `urdf-rs`, `from_urdf_rs` and `to_urdf_rs` convert from and to `urdf_rs::Robot`. [`write()`] is
//! the reverse of the reader. No input makes it panic, hang or overflow its stack.
//!
//! # What files have that is accepted
//!
//! * `quat_xyzw` of an `<origin>`, from `<robot version="1.1">` on, in place of `rpy`. Its norm is
//!   1 within 1e-3; off by more than 1e-6 it is a warning.
//! * A fixed joint with `<mimic>`, `<axis>` or `<limit>`: not used; `<mimic>` with a warning.
//! * A principal moment of inertia that is negative by rounding, at most 1e-12·m·ℓ², with a
//!   warning: ℓ is the longest distance from one frame of the file to the next, at most 1 m. A
//!   moment further below zero is an error, unless `allow_unphysical_inertia` of
//!   [`Options`](crate::Options) is set.
//! * Joints on a link `world` that the file does not declare, with a warning: the link is added,
//!   without mass.
//! * `<drake:joint>` of type `ball`, `planar`, `screw` and `universal`, and `<drake:mimic>`.
//! * Rotors in `<transmission>`, and springs in `<gazebo reference="joint">`: kept in
//!   `Joint::dynamics`.
//! * `<collision>` that cannot be read, with a warning: a scene that asks for contact of it is
//!   refused.
//! * Expressions of xacro in names of files (meshes, textures), where the file has no others.
//!
//! A file with tags or other expressions of xacro is expanded first: see `docs/xacro.md`.
//!
//! What the file states about closed loops, springs, followers and gravity where it is not read
//! (inside `<gazebo>`, under a prefix, `<loop_joint>`, links inside `<group>`) is a warning of the
//! kind [`Code::LostDynamics`] or [`Code::Misplaced`].
//!
//! # Beyond the format
//!
//! Three types of joints are extensions, which other readers refuse or do not know:
//!
//! * `spherical`: any turn about the joint's origin. It has no axis.
//! * `helical`: a screw. It turns about `<axis>`, within the bounds of `<limit>` in rad, and slides
//!   along it by `<thread pitch="0.005"/>` metres per revolution; negative for a left-handed
//!   thread, which has to be given. Zero is accepted with a warning.
//! * `universal`: Cardan's joint. It turns about `<axis xyz="1 0 0"/>`, then about
//!   `<axis2 xyz="0 1 0"/>`, which the first has turned; both have to be given, in the joint's
//!   frame, and not parallel.
//!
//! A joint mimics and is mimicked if it has one coordinate: `helical` does, the other two do not.

mod ast;
mod base;
#[cfg(feature = "second-reader")]
mod bridge;
mod collision;
mod compiler;
#[cfg(feature = "urdf-rs")]
mod conversion;
mod coupled;
mod frame;
mod inertia;
mod joint_forces;
mod joints;
mod limits;
mod links;
mod lost;
mod lower;
mod mimic;
mod mimic_tag;
#[cfg(feature = "second-reader")]
mod plain;
mod robot;
mod tree;
mod unused;
mod visual;
mod write;

use std::collections::BTreeSet;

use articulated_core::description::Base;
#[cfg(doc)]
use articulated_core::description::Description;
use articulated_core::diagnostic::Code;
use articulated_core::diagnostic::{Diagnostics, Subject, quote};
use roxmltree::Document;

#[cfg(feature = "urdf-rs")]
pub use conversion::{ConversionError, from_urdf_rs, to_urdf_rs};
pub(crate) use frame::right_angle;
pub(crate) use inertia::ALLOW_UNPHYSICAL_INERTIA;
pub use write::write;

use crate::xml::document;
use crate::xml::element::Tag;
use crate::xml::lines::Lines;
use crate::xml::markup;
use crate::{Format, Input, world, xacro};

/// The format of URDF files.
#[derive(Clone, Copy, Debug)]
pub struct Urdf;

impl Format for Urdf {
    fn name(&self) -> &'static str {
        "urdf"
    }

    fn extensions(&self) -> &'static [&'static str] {
        &["urdf"]
    }

    fn recognizes(&self, bytes: &[u8]) -> bool {
        markup::root(bytes) == Some(b"robot")
    }

    fn includes_files(&self) -> bool {
        true
    }

    fn read(&self, input: &Input<'_>, diagnostics: &mut Diagnostics) -> Option<world::Document> {
        let draft = draft(input, diagnostics)?;
        let tree = tree::connect(&draft, diagnostics);
        let leaders = mimic::leaders(&draft.joints, diagnostics);
        let tree = tree.filter(|_| diagnostics.is_ok())?;
        if input.options.base == Base::Fixed {
            base::report(&draft, &tree, diagnostics);
        }
        let description = lower::lower(&draft, &tree, &leaders)?;
        #[cfg(feature = "second-reader")]
        bridge::compare(&description, &draft, &tree, &leaders.first, diagnostics);
        Some(description.into())
    }
}

fn draft(input: &Input<'_>, log: &mut Diagnostics) -> Option<ast::Draft> {
    let text = document::text(input.bytes, log)?;
    let first = input.options.first_of_duplicates;
    let lines = Lines::of(&text).with_first_of_duplicates(first);
    let document = document::parse(&text, &lines, log)?;
    let robot = robot_tag(&document, &lines, log)?;
    if !xacro::is_needed(&document, &input.options.file) {
        input.options.warn_of_arguments(&BTreeSet::new(), log);
        return Some(robot::draft(&robot, input.options, log));
    }
    let expanded = xacro::expand(&document, &lines, input, log)?;
    // A remaining expression has an error of its own, or is intended.
    let lines = Lines::expanded(&expanded.text, expanded.origins, !log.is_ok()).with_first_of_duplicates(first);
    let document = document::parse(&expanded.text, &lines, log)?;
    let robot = robot_tag(&document, &lines, log)?;
    Some(robot::draft(&robot, input.options, log))
}

/// The root element, if it is `<robot>`.
fn robot_tag<'a>(document: &'a Document<'a>, lines: &'a Lines<'a>, log: &mut Diagnostics) -> Option<Tag<'a>> {
    let root = Tag::new(document.root_element(), lines, &Subject::Document);
    if root.is("robot") {
        return Some(root);
    }
    let place = root.place("");
    let found = format!("the root element {}", quote(&root.name()));
    log.error(place, Code::NotARobot, found, "the root element <robot>");
    None
}
