//! The rest of a document besides its bodies, as a [`World`].

use std::collections::BTreeSet;

use articulated_core::description::Description;
use articulated_core::diagnostic::{Code, Diagnostics};

use super::actuators::{actuators, on_one_joint};
use super::bodies::{Kind, Tree};
use super::documents::Documents;
use super::element::Element;
use super::equalities::equalities;
use super::grammar::subject;
use super::lower::Lowered;
use super::mass::Mass;
use super::mesh::Meshes;
use super::reflected::{Rotor, spring_dampers};
use super::scope::Scope;
use super::simulation::Simulation;
use super::states;
use super::surroundings;
use super::tendons::tendons;
use super::touching;
use crate::LeaveOut;
use crate::pose::{Pose, rotate};
use crate::world::{Plane, World};

/// Reads the rest of a model.
pub(crate) fn world(
    documents: &Documents,
    (tree, inertials, meshes): (&Tree<'_>, &[Option<Mass>], &mut Meshes<'_>),
    simulation: &Simulation<'_>,
    (lowered, leave_out): (&mut Lowered, &BTreeSet<LeaveOut>),
    log: &mut Diagnostics,
) -> World {
    let main = documents.root(0);
    let flags = simulation.flags();
    let has_unread_joints = documents.roots().any(has_deformable);
    let names = lowered.joints.clone();
    let mut scope = Scope::new(&main.file.name, tree, &names, log.is_ok() && !has_unread_joints);
    let mut world = World {
        gravity: simulation.gravity(),
        step: simulation.step,
        integrator: simulation.integrator.clone(),
        stepping: Some(simulation.stepping()),
        planes: planes(&scope, log),
        home: states::home(&scope),
        ..World::default()
    };
    let bounds = scope.joints.iter().filter(|known| matches!(known.joint.kind, Kind::Hinge | Kind::Slide));
    world.joint_forces = bounds.filter_map(|known| Some((known.name.to_owned(), known.joint.force_range?))).collect();
    let tendons = tendons(&mut scope, flags, (&lowered.description, &lowered.links), &mut world.passive, log);
    let (controls, armatures) = actuators(&mut scope, &tendons, simulation, (&lowered.description, &lowered.links), &mut world, log);
    let links: Vec<&str> = lowered.links.iter().map(String::as_str).collect();
    world.effects = surroundings::effects(&scope, (tree, inertials, meshes), &links, simulation, log);
    world.contact_masks = std::mem::take(&mut lowered.masks);
    let stiffnesses = spring_dampers(&scope, flags, &mut lowered.description, &armatures, log);
    world.effects.extend(surroundings::tethers(&scope, &stiffnesses, &lowered.links));
    add_armatures(&scope, &mut lowered.description, &armatures);
    let (equations, anchors) = equalities(&mut scope, (&tendons, &links), flags.no_equality, &mut world, log);
    let mut touching = touching::touching(&mut scope, inertials, &links, (simulation, &tendons), log);
    touching.sums.extend(equations);
    touching.anchors = anchors;
    touching.left_out.clone_from(leave_out);
    world.touching = Some(touching);
    states::keyframes(&mut scope, &controls, has_unread_joints, &mut world, log);
    world
}

/// Armatures of actuators on one joint of one degree are that of the joint: I gear².
fn add_armatures(scope: &Scope<'_>, description: &mut Description, rotors: &[Rotor]) {
    for Rotor { armature, row, .. } in rotors.iter().filter(|rotor| rotor.of_joints && rotor.armature != 0.0) {
        let Some((joint, gear)) = row.as_ref().and_then(|row| on_one_joint(row, scope)) else { continue };
        let name = scope.joints[joint].name;
        if let Some(own) = description.joints.iter_mut().find(|own| own.name == name) {
            own.dynamics.armature = Some(own.dynamics.armature.unwrap_or(0.0) + armature * gear * gear);
        }
    }
}

/// Whether a document has joints that MuJoCo makes for deformable bodies.
fn has_deformable(root: &Element) -> bool {
    let mut next = vec![root];
    while let Some(element) = next.pop() {
        if element.is("composite") || element.is("flexcomp") {
            return true;
        }
        next.extend(&element.children);
    }
    false
}

/// The planes of bodies that do not move.
fn planes(scope: &Scope<'_>, log: &mut Diagnostics) -> Vec<Plane> {
    let bodies = &scope.tree.bodies;
    let mut all = Vec::new();
    // The pose in the world, of bodies that do not move
    let mut poses: Vec<Option<Pose>> = Vec::with_capacity(bodies.len());
    for (index, body) in bodies.iter().enumerate() {
        let parent = if index == 0 { Some(Pose::default()) } else { poses[body.parent] };
        let own = parent.filter(|_| body.joints.is_empty()).map(|parent| parent.then(&body.pose));
        poses.push(own);
        for geom in &body.geoms {
            if geom.is_plane() && own.is_none() {
                let expected = "it in a body that does not move, as MuJoCo does";
                geom.element.error((&subject(geom.element), "type"), Code::Misplaced, "a plane of a body that moves", expected, log);
            }
            let Some(frame) = own.zip(geom.plane()).map(|(own, plane)| own.then(&plane)) else { continue };
            all.push(Plane {
                name: geom.element.text("name").unwrap_or_default().to_owned(),
                point: frame.position,
                normal: rotate(frame.rotation, [0.0, 0.0, 1.0]),
                mask: Some(geom.mask),
                place: scope.place(geom.element),
            });
        }
    }
    all
}
