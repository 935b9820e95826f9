//! Effects on bodies: compensated weight, the medium, and armature of free joints.

use articulated_core::description::Origin;
use articulated_core::diagnostic::{At, Code, Diagnostics, Subject};
use articulated_core::effect::{Applied, EffectId};

use super::bodies::{Kind, Tree};
use super::mass::Mass;
use super::scope::Scope;
use super::simulation::Simulation;

/// The effects of all bodies, with their places. `links`: the name of the link of each body.
pub(crate) fn effects(
    scope: &Scope<'_>,
    (tree, inertials): (&Tree<'_>, &[Option<Mass>]),
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
        if let Some(geom) = body.geoms.iter().find(|geom| geom.is_ellipsoid_in_fluid) {
            let expected = "`fluidshape` none: the forces of the medium on this body are not read";
            let found = "an ellipsoid in the medium";
            geom.element.warning((&Subject::Link((*link).to_owned()), "fluidshape"), Code::LostDynamics, found, expected, log);
            continue;
        }
        let (frame, drag) = medium.drag(&own);
        put(EffectId::box_drag, frame.origin(), drag);
    }
    all
}
