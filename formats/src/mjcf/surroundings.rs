//! Effects on bodies: compensated weight, the medium, and armature and stiffness of free joints.

use std::collections::BTreeMap;

use articulated_core::description::Origin;
use articulated_core::diagnostic::{At, Code, Diagnostics, Subject};
use articulated_core::effect::{Applied, EffectId};

use super::bodies::{Kind, Tree};
use super::mass::Mass;
use super::mesh::Meshes;
use super::scope::{Scope, reference};
use super::simulation::Simulation;

/// The effects of all bodies, with their places. `links`: the name of the link of each body.
pub(crate) fn effects(
    scope: &Scope<'_>,
    (tree, inertials, meshes): (&Tree<'_>, &[Option<Mass>], &mut Meshes<'_>),
    links: &[&str],
    simulation: &Simulation<'_>,
    log: &mut Diagnostics,
) -> Vec<(Applied, At)> {
    let has_passive = !simulation.flags().no_passive_force();
    let medium = simulation.medium.filter(|_| has_passive);
    let mut all = Vec::new();
    for ((body, own), link) in tree.bodies.iter().zip(inertials).zip(links).skip(1) {
        let mut put = |effect: EffectId, at: Origin, parameters: Vec<f64>| {
            all.push((Applied { effect, on: (*link).to_owned(), at, parameters }, scope.place(body.element)));
        };
        if let Some(joint) = body.joints.iter().find(|joint| joint.kind == Kind::Free && joint.armature != 0.0) {
            // The same inertia in all directions, on which gravity does not act
            let isotropic = [1.0, 0.0, 0.0, 1.0, 0.0, 1.0].map(|x| x * joint.armature);
            put(EffectId::added_mass, Origin::default(), [&isotropic[..], &isotropic, &[0.0; 9]].concat());
        }
        let Some(own) = own.filter(|own| own.mass > 0.0) else { continue };
        if body.compensated != 0.0 && has_passive {
            put(EffectId::gravity_compensation, own.pose.origin(), vec![body.compensated * own.mass]);
        }
        let Some(medium) = medium else { continue };
        // One ellipsoid turns off the box of the whole body, as in MuJoCo.
        if body.geoms.iter().all(|geom| geom.in_fluid.is_none()) {
            let (frame, drag) = medium.drag(&own);
            put(EffectId::box_drag, frame.origin(), drag);
        }
        for (geom, coefficients) in body.geoms.iter().filter_map(|geom| Some((geom, geom.in_fluid?))) {
            match geom.ellipsoid(meshes, log) {
                Some((frame, semi_axes)) => put(EffectId::ellipsoid_drag, frame.origin(), medium.ellipsoid(semi_axes, coefficients)),
                None => {
                    let expected = "a shape with an extent along each axis: the medium does not act on this one";
                    let about = Subject::Link((*link).to_owned());
                    geom.element.warning((&about, "fluidshape"), Code::LostDynamics, "a flat ellipsoid in the medium", expected, log);
                }
            }
        }
    }
    all
}

/// Springs of free joints, between the reference pose and the body. `stiffnesses`: those of
/// `springdamper`, by the index of the joint.
pub(crate) fn tethers(scope: &Scope<'_>, stiffnesses: &BTreeMap<usize, f64>, links: &[String]) -> Vec<(Applied, At)> {
    let mut all = Vec::new();
    for (index, known) in scope.joints.iter().enumerate().filter(|(_, known)| known.joint.kind == Kind::Free) {
        let [first, second, third] = known.joint.tether;
        let stiffness = [stiffnesses.get(&index).copied().unwrap_or(first), second, third];
        if stiffness == [0.0; 3] {
            continue;
        }
        // The same for translation and rotation, as in MuJoCo
        let parameters = [&stiffness[..], &stiffness, &reference(scope, known)].concat();
        let on = links[known.body].clone();
        all.push((Applied { effect: EffectId::tether, on, at: Origin::default(), parameters }, scope.place(known.joint.element)));
    }
    all
}
