//! Effects on bodies: compensated weight, the medium, and armature of free joints.
//!
//! ```text
//! box of the inertia:   s_i² = 6 (I_j + I_k − I_i)/m,   d = (s₁ + s₂ + s₃)/3
//! drag:                 c_i = ½ ρ s_j s_k,   C_i = ρ s_i (s_j⁴ + s_k⁴)/64,   b = 3 π d β,   B = π d³ β
//! ```
//!
//! Source: MuJoCo documentation, Fluid forces, Inertia model.

use core::f64::consts::PI;

use articulated_core::description::Origin;
use articulated_core::diagnostic::{At, Code, Diagnostics, Subject};
use articulated_core::effect::{Applied, EffectId};

use super::axes::{in_axes, principal};
use super::bodies::{Kind, Tree};
use super::mass::Mass;
use super::scope::Scope;
use super::simulation::Simulation;
use crate::pose::{IDENTITY, Pose, conjugate, multiply, turned};

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

/// A medium at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Medium {
    /// ρ, kg/m³.
    pub(crate) density: f64,
    /// β, Pa·s.
    pub(crate) viscosity: f64,
}

impl Medium {
    /// The frame and the parameters of the drag on the box of a body's inertia.
    fn drag(&self, body: &Mass) -> (Pose, Vec<f64>) {
        // Axes of the smallest bodies too: precisions of `principal` are absolute.
        let size = body.inertia.iter().fold(0.0_f64, |most, x| most.max(x.abs())).max(f64::MIN_POSITIVE);
        let first = body.axes.unwrap_or(IDENTITY);
        let axes = multiply(first, principal(turned(conjugate(first), body.inertia.map(|x| x / size))).1);
        let [x, _, _, y, _, z] = in_axes(axes, body.inertia);
        let frame = body.pose.then(&Pose { rotation: axes, ..Pose::default() });
        let side = |own: f64, one: f64, other: f64| (6.0 * (one + other - own).max(LEAST) / body.mass).sqrt();
        let sides = [side(x, y, z), side(y, z, x), side(z, x, y)];
        let diameter = sides.iter().sum::<f64>() / 3.0;
        let around = |k: usize| (sides[k], sides[(k + 1) % 3], sides[(k + 2) % 3]);
        let along = [0, 1, 2].map(|k| 0.5 * self.density * around(k).1 * around(k).2);
        let about = [0, 1, 2].map(|k| {
            let (own, one, other) = around(k);
            self.density * own * (one.powi(4) + other.powi(4)) / 64.0
        });
        let viscous = [3.0 * PI * diameter * self.viscosity, PI * diameter.powi(3) * self.viscosity];
        (frame, [&along[..], &about, &viscous].concat())
    }
}

/// MuJoCo's least number, kg·m².
const LEAST: f64 = 1e-15;
