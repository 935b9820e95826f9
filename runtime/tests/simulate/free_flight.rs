//! Laws of bodies and robots that fly: constant velocity, and Galilean invariance.

use articulated::simulate::{IntegratorId, Recording, Simulation, integrators};
use articulated::spatial::{Vector3, from_quaternion};
use articulated::{Base, Model, load_bytes};

use crate::robots::{free, model, stepping};

/// A body of 2 kg about its centre, with these moments of inertia.
fn body(moments: [f64; 3]) -> Model<f64> {
    let [x, y, z] = moments;
    let text = format!(
        r#"<robot name="body"><link name="body"><inertial><mass value="2"/>
        <inertia ixx="{x}" ixy="0" ixz="0" iyy="{y}" iyz="0" izz="{z}"/></inertial></link></robot>"#
    );
    load_bytes("body", text.as_bytes(), Base::Floating).unwrap()
}

/// Velocity of the base's origin in world axes, m/s.
fn velocity(motion: &Recording, i: usize) -> Vector3<f64> {
    let (q, v) = (motion.q_at(i), motion.v_at(i));
    from_quaternion([q[3], q[4], q[5], q[6]]) * Vector3::new(v[3], v[4], v[5])
}

/// 3 m/s and 6 rad/s for 10 s, in steps up to a tenth of a rotation: 30 m, whatever the step; a
/// body that tumbles too.
#[test]
fn a_body_without_forces_keeps_its_velocity_whatever_the_step() {
    for (moments, omega) in [([0.02; 3], [0.0, 0.0, 6.0]), ([0.02, 0.03, 0.04], [0.3, 6.0, 0.2])] {
        let robot = body(moments).with_gravity([0.0; 3]);
        for step in [0.001, 0.005, 0.01, 0.1] {
            if moments[0] != moments[1] && step > 0.001 {
                continue; // explicit steps of its rotation are not stable over 10 s
            }
            let (q, v) = ([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0], [omega[0], omega[1], omega[2], 3.0, 0.0, 0.0]);
            let motion = free(&robot, &stepping(IntegratorId::semi_implicit_euler, 10.0, step), &q, &v).unwrap();
            let last = motion.len() - 1;
            let way = Vector3::from_column_slice(&motion.q_at(last)[..3]) - Vector3::new(30.0, 0.0, 0.0);
            let change = velocity(&motion, last) - Vector3::new(3.0, 0.0, 0.0);
            assert!(way.amax() < 1e-10 && change.amax() < 1e-11, "{moments:?}, {step} s: {way:?} {change:?}");
            if moments[0] == moments[1] {
                assert!((motion.kinetic[last] - 9.36).abs() < 1e-10, "{step} s: {} J", motion.kinetic[last]);
            }
        }
    }
}

/// A projectile that spins: after n steps it has fallen by g h² n (n + 1)/2, the sum of the method,
/// and its velocity is exact.
#[test]
fn a_body_that_spins_falls_as_one_that_does_not() {
    let (h, n) = (0.01, 100.0);
    let q = [1.0, -2.0, 3.0, 0.5, -0.5, 0.5, 0.5];
    let v = [4.0, -7.0, 2.0, 1.0, -2.0, 0.5];
    let robot = body([0.02; 3]);
    let motion = free(&robot, &stepping(IntegratorId::semi_implicit_euler, h * n, h), &q, &v).unwrap();
    let last = motion.len() - 1;
    let start = velocity(&motion, 0);
    let fallen = Vector3::new(0.0, 0.0, -9.81 * h * h * n * (n + 1.0) / 2.0);
    let expected = Vector3::new(1.0, -2.0, 3.0) + start * (h * n) + fallen;
    let found = Vector3::from_column_slice(&motion.q_at(last)[..3]);
    assert!((found - expected).amax() < 1e-12, "{:?}", found - expected);
    assert!((velocity(&motion, last) - start - Vector3::new(0.0, 0.0, -9.81 * h * n)).amax() < 1e-12);
}

/// The satellite without gravity, its arm driven, in a frame that moves at this velocity, m/s.
fn flown(id: IntegratorId, step: f64, frame: Vector3<f64>) -> Recording {
    let robot = model("satellite", Base::Floating).with_gravity([0.0; 3]);
    let q = [0.3, -0.2, 0.5, 0.5, -0.5, 0.5, 0.5, 0.7, 0.1, 0.7, -0.1, 0.7];
    let mut v = [1.8, -1.5, 2.0, 0.3, -0.2, 0.5, 0.4, 0.1, -0.1, 0.1];
    let moved = from_quaternion([q[3], q[4], q[5], q[6]]).transpose() * frame;
    (0..3).for_each(|k| v[3 + k] += moved[k]);
    let mut control = |t: f64, _: &[f64], _: &[f64], tau: &mut [f64]| {
        (tau[6], tau[7]) = (0.1 * (5.0 * t).sin(), 0.02);
    };
    Simulation::new(&robot, stepping(id, 1.0, step)).unwrap().run(&q, &v, &mut control, &mut []).unwrap()
}

/// Largest difference between a motion in a frame at rest and one in a frame that moves, the
/// velocity of the frame taken out.
fn difference(rest: &Recording, moving: &Recording, frame: Vector3<f64>) -> f64 {
    let (i, j) = (rest.len() - 1, moving.len() - 1);
    let largest = |x: &[f64], y: &[f64]| x.iter().zip(y).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max);
    let way = Vector3::from_column_slice(&moving.q_at(j)[..3]) - Vector3::from_column_slice(&rest.q_at(i)[..3]) - frame * rest.t[i];
    let linear = velocity(moving, j) - velocity(rest, i) - frame;
    // Momentum of 5.7 kg.
    let momentum = |k: usize| Vector3::from_column_slice(&[rest, moving][k].momentum_at([i, j][k]).unwrap()[3..]);
    let momentum = momentum(1) - momentum(0) - frame * 5.7;
    let angular = largest(&rest.momentum_at(i).unwrap()[..3], &moving.momentum_at(j).unwrap()[..3]);
    [largest(&rest.q_at(i)[3..], &moving.q_at(j)[3..]), largest(&rest.v_at(i)[..3], &moving.v_at(j)[..3])]
        .into_iter()
        .chain([largest(&rest.v_at(i)[6..], &moving.v_at(j)[6..]), way.amax(), linear.amax(), momentum.amax(), angular])
        .fold(0.0, f64::max)
}

/// Galilean invariance: a constant velocity of the frame changes no relative motion, and momentum
/// only by m times itself. `semi_implicit_euler` keeps it to rounding, every other method to its
/// order.
#[test]
fn the_speed_of_the_frame_changes_no_motion() {
    let frame = Vector3::new(40.0, -25.0, 15.0);
    for row in integrators() {
        let at = |step: f64| difference(&flown(row.id, step, Vector3::zeros()), &flown(row.id, step, frame), frame);
        if row.id == IntegratorId::semi_implicit_euler {
            let all = [0.02, 0.002].map(at);
            println!("{}: {all:?}", row.name);
            assert!(all.iter().all(|d| *d < 1e-11), "{all:?}");
            continue;
        }
        let h = if row.order == 8 { 0.1 } else { 0.02 };
        let [coarse, fine] = [h, h / 2.0].map(at);
        let order = (coarse / fine).log2();
        println!("{}: {coarse:e} {fine:e}, order {order:.2}", row.name);
        assert!(fine < 1e-11 || order > f64::from(row.order) - 0.4, "{}: {coarse:e} {fine:e}", row.name);
    }
}
