//! Small robots with closed forms, and the means to run them.

use articulated::simulate::{IntegratorId, NoTorque, Output, Recording, Settings, SimulateError, Simulation};
use articulated::{Base, Dynamics, Model, load_bytes};

/// A link of this mass and these moments of inertia (xx, yy, zz) about a centre at `xyz`.
pub(crate) fn link(name: &str, mass: f64, xyz: [f64; 3], inertia: [f64; 3]) -> String {
    let ([x, y, z], [xx, yy, zz]) = (xyz, inertia);
    format!(
        r#"<link name="{name}"><inertial><origin xyz="{x} {y} {z}"/><mass value="{mass}"/>
        <inertia ixx="{xx}" ixy="0" ixz="0" iyy="{yy}" iyz="0" izz="{zz}"/></inertial></link>"#
    )
}

/// A joint about or along an axis.
pub(crate) fn joint(kind: &str, parent: &str, child: &str, xyz: [f64; 3], axis: [f64; 3]) -> String {
    let ([x, y, z], [a, b, c]) = (xyz, axis);
    format!(
        r#"<joint name="{child}_joint" type="{kind}"><parent link="{parent}"/><child link="{child}"/><origin xyz="{x} {y} {z}"/><axis xyz="{a} {b} {c}"/></joint>"#
    )
}

pub(crate) fn robot(name: &str, base: Base, parts: &[String]) -> Model<f64> {
    let text = format!("<robot name=\"{name}\">{}</robot>", parts.concat());
    load_bytes(name, text.as_bytes(), base).unwrap_or_else(|e| panic!("{e}"))
}

/// A point mass on a massless rod of one metre about y.
pub(crate) fn pendulum() -> Model<f64> {
    let bob = link("bob", 1.0, [0.0, 0.0, -1.0], [0.0; 3]);
    robot("pendulum", Base::Fixed, &["<link name=\"base\"/>".into(), bob, joint("continuous", "base", "bob", [0.0; 3], [0.0, 1.0, 0.0])])
}

/// `n` equal rods hanging on each other, about axes that alternate.
pub(crate) fn chain(n: usize, axes: &[[f64; 3]]) -> Model<f64> {
    let mut parts = vec!["<link name=\"link_0\"/>".to_string()];
    for i in 1..=n {
        parts.push(link(&format!("link_{i}"), 1.0, [0.0, 0.0, -0.25], [0.02, 0.03, 0.01]));
        let at = [0.0, 0.0, if i > 1 { -0.5 } else { 0.0 }];
        parts.push(joint("continuous", &format!("link_{}", i - 1), &format!("link_{i}"), at, axes[(i - 1) % axes.len()]));
    }
    robot("chain", Base::Fixed, &parts)
}

/// A free rigid body with these principal moments, its centre at `xyz` of its frame.
pub(crate) fn free_body(mass: f64, xyz: [f64; 3], inertia: [f64; 3]) -> Model<f64> {
    robot("body", Base::Floating, &[link("body", mass, xyz, inertia)])
}

/// Settings with both tolerances alike and no output but the ends.
pub(crate) fn to(integrator: IntegratorId, end: f64, tolerance: f64) -> Settings {
    Settings { integrator, end, rtol: tolerance, atol: tolerance, output: Output::Ends, ..Settings::default() }
}

/// Settings with a fixed step.
pub(crate) fn stepping(integrator: IntegratorId, end: f64, step: f64) -> Settings {
    Settings { step: Some(step), ..to(integrator, end, 1e-6) }
}

pub(crate) fn free<R: Dynamics<f64>>(robot: &R, settings: &Settings, q: &[f64], v: &[f64]) -> Result<Recording, SimulateError> {
    Simulation::new(robot, settings.clone())?.run(q, v, &mut NoTorque, &mut [])
}
