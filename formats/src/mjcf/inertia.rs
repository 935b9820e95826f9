//! The mass of a body: from `<inertial>` or from its geoms.

use articulated_core::description::{Inertial, PrincipalMoments};
use articulated_core::diagnostic::{Code, Diagnostics};

use super::bodies::Body;
use super::grammar::subject;
use super::mesh::Meshes;
use super::settings::{Compiler, InertiaFromGeom};
use crate::pose::{Pose, Symmetric, add, diagonal, of_point, principal, scale, subtract, turned};

/// The mass of a body, its centre and its inertia, bounds included; `None` for a body without.
pub(crate) fn of_body(body: &Body<'_>, meshes: &mut Meshes<'_>, log: &mut Diagnostics) -> Option<Inertial> {
    let compiler = &body.settings.compiler;
    let from_geoms = match compiler.inertia_from_geom {
        InertiaFromGeom::Never => false,
        InertiaFromGeom::Always => true,
        InertiaFromGeom::Auto => body.inertial.is_none(),
    };
    let geoms = if from_geoms { of_geoms(body, meshes, log) } else { None };
    let found = geoms.or_else(|| body.inertial.map(|given| (given.pose, given.mass, given.inertia)));
    let (pose, mass, inertia) = found.unwrap_or_default();
    let mass_of_file = mass;
    let mass = mass.max(compiler.bound_mass);
    let (pose, inertia) = bounded(body, compiler, pose, inertia, log);
    if mass_of_file < 0.0 {
        let found = format!("a negative mass, {mass_of_file} kg");
        body.element.error((&subject(body.element), "mass"), Code::NegativeMass, found, "a mass of zero or more", log);
    }
    (mass != 0.0 || inertia != [0.0; 6]).then_some(Inertial { origin: pose.origin(), mass, inertia })
}

/// The masses of all geoms of the groups that count, as one.
fn of_geoms(body: &Body<'_>, meshes: &mut Meshes<'_>, log: &mut Diagnostics) -> Option<(Pose, f64, Symmetric)> {
    let [first, last] = body.settings.compiler.groups;
    let counted = body.geoms.iter().filter(|geom| (first..=last).contains(&geom.group));
    let masses: Vec<_> = counted.filter_map(|geom| geom.mass(meshes, log)).collect();
    if let [only] = masses.as_slice() {
        return Some((only.pose, only.mass, only.inertia));
    }
    let mass: f64 = masses.iter().map(|part| part.mass).sum();
    if masses.is_empty() {
        return None;
    }
    let sum = masses.iter().fold([0.0; 3], |sum, part| add(sum, scale(part.pose.position, part.mass)));
    let center = scale(sum, 1.0 / mass);
    let mut inertia = [0.0; 6];
    for part in &masses {
        let own = turned(part.pose.rotation, part.inertia);
        let shifted = of_point(part.mass, subtract(part.pose.position, center));
        inertia.iter_mut().zip(own.iter().zip(shifted)).for_each(|(sum, (own, shifted))| *sum += own + shifted);
    }
    Some((Pose::at(center), mass, inertia))
}

/// The inertia with `boundinertia` and `balanceinertia`, and what is wrong with it.
fn bounded(body: &Body<'_>, compiler: &Compiler, pose: Pose, inertia: Symmetric, log: &mut Diagnostics) -> (Pose, Symmetric) {
    let is_diagonal = inertia[1] == 0.0 && inertia[2] == 0.0 && inertia[4] == 0.0;
    let (mut moments, axes) = if is_diagonal {
        ([inertia[0], inertia[3], inertia[5]], pose)
    } else {
        let (moments, rotation) = principal(inertia);
        (moments, pose.then(&Pose { rotation, ..Pose::default() }))
    };
    let before = moments;
    moments = moments.map(|moment| moment.max(compiler.bound_inertia));
    if moments != before && compiler.bound_inertia > 0.0 {
        return balanced(compiler, axes, moments);
    }
    let found = PrincipalMoments::of(inertia);
    let [a, b, c] = before;
    if compiler.balance_inertia && (a + b < c || a + c < b || b + c < a) {
        return balanced(compiler, axes, before);
    }
    let subject = subject(body.element);
    if found.are_negative() {
        let expected = "an inertia that is positive semi-definite";
        body.element.error((&subject, "inertial"), Code::InertiaNotPositive, found.to_string(), expected, log);
    } else if found.miss_triangle() {
        let expected = format!("{}; `balanceinertia` of <compiler> replaces such an inertia", PrincipalMoments::TRIANGLE);
        body.element.error((&subject, "inertial"), Code::InertiaTriangle, found.to_string(), expected, log);
    }
    (pose, inertia)
}

fn balanced(compiler: &Compiler, axes: Pose, [a, b, c]: [f64; 3]) -> (Pose, Symmetric) {
    let is_unbalanced = a + b < c || a + c < b || b + c < a;
    let moments = if compiler.balance_inertia && is_unbalanced { [(a + b + c) / 3.0; 3] } else { [a, b, c] };
    (axes, diagonal(moments))
}
