//! Small robots, generated and generic, and the means to run them.

use articulated::simulate::{ContactPoint, IntegratorId, NoTorque, Output, Recording, Settings, SimulateError, Simulation};
use articulated::{Base, Dynamics, Model, load_bytes};

macro_rules! generated {
    ($($(#[$doc:meta])* $name:ident, $urdf:literal, $base:ident, $gravity:literal $(, $more:ident)?;)*) => {
        $(articulated::robot! {
            $(#[$doc])*
            // Two have moments that break the triangle inequality, for which the macro gives
            // warnings.
            #[allow(deprecated)]
            pub(crate) mod $name {
                urdf = $urdf,
                base = $base,
                gravity = [0.0, 0.0, $gravity],
                functions = [placements, forward_dynamics, integrate, difference, kinetic_energy, potential_energy, centroidal_momentum
                    $(, $more)?],
            }
        })*
    };
}

generated! {
    /// Three rods whose axes are not parallel.
    chain, "tests/simulate/urdf/chain.urdf", fixed, -9.81, forward_dynamics_derivatives;
    /// A double pendulum.
    planar, "tests/simulate/urdf/planar.urdf", fixed, -9.81;
    /// A free body about its centre, without gravity.
    handle, "tests/simulate/urdf/handle.urdf", floating, 0.0;
    /// A body that floats and has an arm with a ball joint.
    satellite, "tests/simulate/urdf/satellite.urdf", floating, -9.81;
    /// A top on its tip.
    top, "tests/simulate/urdf/top.urdf", fixed, -9.81, forward_dynamics_derivatives;
}

/// The generic model of one of the same files, or of another.
pub(crate) fn model(name: &str, base: Base) -> Model<f64> {
    let path = format!("{}/tests/simulate/urdf/{name}.urdf", env!("CARGO_MANIFEST_DIR"));
    articulated::load(path, base).unwrap_or_else(|e| panic!("{name}: {e}"))
}

/// A turning or sliding body of mass 1 and moment of inertia 1 about the axis z of its joint, its
/// centre `off` from the axis along x.
pub(crate) fn one_joint(kind: &str, off: f64) -> Model<f64> {
    let text = format!(
        r#"<robot name="one"><link name="base"/><link name="body"><inertial><origin xyz="{off} 0 0"/><mass value="1"/>
        <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="{}"/></inertial></link>
        <joint name="joint" type="{kind}"><parent link="base"/><child link="body"/><axis xyz="0 0 1"/>
        <limit lower="-9" upper="9" effort="1" velocity="1"/></joint></robot>"#,
        1.0 - off * off
    );
    load_bytes("one", text.as_bytes(), Base::Fixed).unwrap_or_else(|e| panic!("{e}"))
}

/// A point of a frame, and a normal.
pub(crate) fn at(frame: usize, point: [f64; 3], normal: [f64; 3]) -> ContactPoint {
    ContactPoint { frame, point, normal }
}

/// Settings with both tolerances alike and no output but the ends.
pub(crate) fn to(integrator: IntegratorId, end: f64, tolerance: f64) -> Settings {
    Settings { integrator, end, rtol: tolerance, atol: tolerance, output: Output::Ends, ..Settings::default() }
}

/// Settings with a fixed step.
pub(crate) fn stepping(integrator: IntegratorId, end: f64, step: f64) -> Settings {
    Settings { step: Some(step), ..to(integrator, end, 1e-6) }
}

/// Settings for every integrator, with a fixed step if it has no other.
pub(crate) fn any(integrator: IntegratorId, end: f64) -> Settings {
    if integrator.row().adaptive { to(integrator, end, 1e-10) } else { stepping(integrator, end, 0.03) }
}

/// An undriven motion.
pub(crate) fn free<R: Dynamics<f64>>(robot: &R, settings: &Settings, q: &[f64], v: &[f64]) -> Result<Recording, SimulateError> {
    Simulation::new(robot, settings.clone())?.with_energy_balance().run(q, v, &mut NoTorque, &mut [])
}

/// Largest difference of the last states of two motions of the same robot, along the manifold.
pub(crate) fn apart<R: Dynamics<f64>>(robot: &R, a: &Recording, b: &Recording) -> f64 {
    let (i, j) = (a.len() - 1, b.len() - 1);
    let mut step = vec![0.0; a.nv];
    robot.difference(&mut robot.workspace(), a.q_at(i), b.q_at(j), &mut step).unwrap();
    let rates = a.v_at(i).iter().zip(b.v_at(j)).map(|(a, b)| a - b);
    step.iter().copied().chain(rates).fold(0.0, |most, x| if x.is_nan() { f64::INFINITY } else { most.max(x.abs()) })
}

/// A slide without gravity.
pub(crate) fn slider() -> Model<f64> {
    one_joint("prismatic", 0.0).with_gravity([0.0; 3])
}
