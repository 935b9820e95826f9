//! The mass of a body: from `<inertial>` or from its geoms.

use articulated_core::description::PrincipalMoments;
use articulated_core::diagnostic::{Code, Diagnostics};

use super::axes;
use super::bodies::{Body, Explicit};
use super::grammar::subject;
use super::mass::Mass;
use super::mesh::Meshes;
use super::settings::{Compiler, InertiaFromGeom};
use crate::mass::beyond_any_mass;
use crate::pose::{IDENTITY, Pose, Symmetric, add, diagonal, of_point, scale, subtract, turned};

/// The masses of all bodies; `None` for bodies without mass.
pub(crate) fn of_bodies(bodies: &[Body<'_>], meshes: &mut Meshes<'_>, log: &mut Diagnostics) -> Vec<Option<Mass>> {
    let mut all: Vec<Option<Mass>> = Vec::with_capacity(bodies.len());
    // Without its inertia
    let mut points: Vec<Option<&Explicit<'_>>> = vec![None; bodies.len()];
    all.push(None);
    for (body, point) in bodies.iter().zip(&mut points).skip(1) {
        let (own, given) = of_body(body, meshes, log);
        *point = given.filter(|given| !given.has_inertia);
        all.push(own);
    }
    refuse_points(bodies, &all, &points, log);
    set_total_mass(bodies, &mut all);
    warn_of_masses(bodies, &all, log);
    all
}

/// Warns of implausible masses.
fn warn_of_masses(bodies: &[Body<'_>], all: &[Option<Mass>], log: &mut Diagnostics) {
    for (body, own) in bodies.iter().zip(all) {
        if let Some((found, expected)) = own.and_then(|own| beyond_any_mass(own.mass)) {
            body.element.warning((&subject(body.element), "mass"), Code::Units, found, expected, log);
        }
    }
}

/// Refuses masses without inertia that move, unless a body fixed to them has inertia.
fn refuse_points(bodies: &[Body<'_>], all: &[Option<Mass>], points: &[Option<&Explicit<'_>>], log: &mut Diagnostics) {
    // The body with joints that carries each body; the world carries the rest
    let mut carriers = vec![0; bodies.len()];
    let mut can_move = vec![false; bodies.len()];
    for (index, body) in bodies.iter().enumerate().skip(1) {
        carriers[index] = if body.joints.is_empty() { carriers[body.parent] } else { index };
        can_move[carriers[index]] |= all[index].is_some_and(|own| own.can_move());
    }
    for (point, carrier) in points.iter().zip(carriers) {
        if let Some(given) = point.filter(|_| carrier != 0 && !can_move[carrier]) {
            let expected = "diaginertia or fullinertia: MuJoCo refuses a body that moves and has no inertia";
            given.element.error((&subject(given.element), "inertial"), Code::MissingAttribute, "a mass without inertia", expected, log);
        }
    }
}

/// Scales all masses so that they are the `settotalmass` of the main file.
fn set_total_mass(bodies: &[Body<'_>], all: &mut [Option<Mass>]) {
    let Some(wanted) = bodies.first().and_then(|world| world.settings.compiler.total_mass) else { return };
    let total: f64 = all.iter().flatten().map(|own| own.mass).sum();
    if total <= 0.0 {
        return;
    }
    let factor = wanted / total;
    for own in all.iter_mut().flatten() {
        own.mass *= factor;
        own.inertia = own.inertia.map(|moment| moment * factor);
    }
}

/// The mass of a body, bounds included, and its `<inertial>`; `None` for a body without mass.
fn of_body<'b>(body: &'b Body<'_>, meshes: &mut Meshes<'_>, log: &mut Diagnostics) -> (Option<Mass>, Option<&'b Explicit<'b>>) {
    let compiler = &body.settings.compiler;
    let from_geoms = match compiler.inertia_from_geom {
        InertiaFromGeom::Never => false,
        InertiaFromGeom::Always => true,
        InertiaFromGeom::Auto => body.inertial.is_none(),
    };
    let geoms = if from_geoms { of_geoms(body, meshes, log) } else { None };
    let given = body.inertial.as_ref().filter(|_| geoms.is_none());
    let found = geoms.or_else(|| given.map(|given| given.own)).unwrap_or_default();
    let mass = found.mass.max(compiler.bound_mass);
    let own = Mass { mass, ..bounded(body, compiler, found, log) };
    if found.mass < 0.0 {
        let found = format!("a negative mass, {} kg", found.mass);
        body.element.error((&subject(body.element), "mass"), Code::NegativeMass, found, "a mass of zero or more", log);
    }
    ((own.mass != 0.0 || own.inertia != [0.0; 6]).then_some(own), given)
}

/// The total mass of all geoms in the groups that count.
fn of_geoms(body: &Body<'_>, meshes: &mut Meshes<'_>, log: &mut Diagnostics) -> Option<Mass> {
    let [first, last] = body.settings.compiler.groups;
    let counted = body.geoms.iter().filter(|geom| (first..=last).contains(&geom.group));
    let masses: Vec<_> = counted.filter_map(|geom| geom.mass(meshes, log)).collect();
    if let [only] = masses.as_slice() {
        return Some(*only);
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
    Some(Mass { pose: Pose::at(center), mass, inertia, axes: None })
}

/// The inertia with `boundinertia` and `balanceinertia`; reports its errors.
fn bounded(body: &Body<'_>, compiler: &Compiler, own: Mass, log: &mut Diagnostics) -> Mass {
    let Mass { pose, inertia, .. } = own;
    let is_diagonal = inertia[1] == 0.0 && inertia[2] == 0.0 && inertia[4] == 0.0;
    let (mut moments, axes) = if is_diagonal {
        ([inertia[0], inertia[3], inertia[5]], pose)
    } else {
        let (moments, rotation) = axes::principal(inertia);
        (moments, pose.then(&Pose { rotation, ..Pose::default() }))
    };
    let before = moments;
    moments = moments.map(|moment| moment.max(compiler.bound_inertia));
    let balanced = |moments| Mass { pose: axes, inertia: balanced(compiler, moments), axes: Some(IDENTITY), ..own };
    if moments != before && compiler.bound_inertia > 0.0 {
        return balanced(moments);
    }
    let found = PrincipalMoments::of(inertia);
    let [a, b, c] = before;
    if compiler.balance_inertia && (a + b < c || a + c < b || b + c < a) {
        return balanced(before);
    }
    let subject = subject(body.element);
    if found.are_negative() {
        let expected = "an inertia that is positive semi-definite";
        body.element.error((&subject, "inertial"), Code::InertiaNotPositive, found.to_string(), expected, log);
    } else if found.miss_triangle() {
        let expected = format!("{}; `balanceinertia` of <compiler> replaces such an inertia", PrincipalMoments::TRIANGLE);
        body.element.error((&subject, "inertial"), Code::InertiaTriangle, found.to_string(), expected, log);
    }
    own
}

fn balanced(compiler: &Compiler, [a, b, c]: [f64; 3]) -> Symmetric {
    let is_unbalanced = a + b < c || a + c < b || b + c < a;
    diagonal(if compiler.balance_inertia && is_unbalanced { [(a + b + c) / 3.0; 3] } else { [a, b, c] })
}
