//! Each effect against its formula, on a completely known body.

use articulated_core::algorithm::{Workspace, function};
use articulated_core::description::{Base, Description, Inertial, Joint, JointKind, Link, LinkId, Origin};
use articulated_core::effect::{Applied, EffectId};
use articulated_core::index::BodyId;
use articulated_core::model::Model;

const MASS: f64 = 2.0;
const INERTIA: f64 = 0.3;
const G: f64 = 9.81;

/// A slide along x of 2 kg.
fn slide() -> Model<f64> {
    let link = |name: &str, mass: Option<f64>| Link {
        name: name.into(),
        inertial: mass.map(|mass| Inertial { origin: Origin::default(), mass, inertia: [INERTIA, 0.0, 0.0, INERTIA, 0.0, INERTIA] }),
        ..Link::default()
    };
    let joint = Joint {
        name: "slide".into(),
        kind: JointKind::Prismatic,
        parent: LinkId(0),
        child: LinkId(1),
        axis: [1.0, 0.0, 0.0],
        ..Joint::default()
    };
    let description = Description {
        name: "slide".into(),
        links: [link("base", None), link("cart", Some(MASS))].into(),
        joints: [joint].into(),
        frames: Vec::new(),
    };
    Model::new(&description, Base::Fixed).expect("a slide")
}

/// A ball of 2 kg that moves freely.
fn ball() -> Model<f64> {
    let inertial = Inertial { origin: Origin::default(), mass: MASS, inertia: [INERTIA, 0.0, 0.0, INERTIA, 0.0, INERTIA] };
    let description = Description {
        name: "ball".into(),
        links: [Link { name: "ball".into(), inertial: Some(inertial), ..Link::default() }].into(),
        joints: [].into(),
        frames: Vec::new(),
    };
    Model::new(&description, Base::Floating).expect("a ball")
}

fn on(effect: EffectId, on: &str, parameters: &[f64]) -> Applied {
    Applied { effect, on: on.into(), at: Origin::default(), parameters: parameters.to_vec() }
}

fn call(model: &Model<f64>, name: &str, arguments: &[&[f64]]) -> Vec<f64> {
    let function = function::<f64>(name).expect("in the table");
    let mut out = vec![0.0; function.len(model.shape())];
    function.call(model, &mut Workspace::new(model), arguments, &mut out).expect("lengths as the table says");
    out
}

/// Acceleration of the slide with one effect.
fn slides(effect: EffectId, parameters: &[f64], q: f64, v: f64, tau: f64) -> f64 {
    let model = slide().with_effects(&[on(effect, "slide", parameters)]).expect("an effect on a slide");
    call(&model, "forward_dynamics", &[&[q], &[v], &[tau]])[0]
}

fn assert_near(found: f64, expected: f64) {
    assert!((found - expected).abs() <= 1e-13 * (1.0 + expected.abs()), "{found} instead of {expected}");
}

#[test]
fn armature_is_mass_behind_a_gear() {
    assert_near(slides(EffectId::armature, &[0.01, 20.0], 0.3, 0.7, 5.0), 5.0 / (MASS + 0.01 * 400.0));
}

#[test]
fn damping_is_against_the_rate() {
    assert_near(slides(EffectId::damping, &[3.0], 0.3, 0.7, 5.0), (5.0 - 3.0 * 0.7) / MASS);
}

#[test]
fn friction_is_its_torque_where_it_slides_and_none_at_rest() {
    assert_near(slides(EffectId::friction, &[3.0, 0.3], 0.0, 0.4, 5.0), (5.0 - 3.0 * 0.8) / MASS);
    assert_near(slides(EffectId::friction, &[3.0, 0.3], 0.0, -0.4, 5.0), (5.0 + 3.0 * 0.8) / MASS);
    assert_near(slides(EffectId::friction, &[3.0, 0.3], 0.0, 0.0, 5.0), 5.0 / MASS);
    assert!((slides(EffectId::friction, &[3.0, 1e-3], 0.0, 1e3, 5.0) - 1.0).abs() < 1e-11);
}

#[test]
fn a_spring_pulls_to_its_rest() {
    assert_near(slides(EffectId::spring, &[40.0, 0.1], 0.3, 0.7, 5.0), (5.0 - 40.0 * 0.2) / MASS);
}

#[test]
fn a_stop_pushes_beyond_its_bound_and_never_pulls() {
    let stop = |q: f64, v: f64| slides(EffectId::limit, &[-1.0, 2.0, 100.0, 0.5], q, v, 0.0) * MASS;
    assert_eq!(stop(1.9, 3.0), 0.0);
    assert_eq!(stop(-0.9, -3.0), 0.0);
    assert_near(stop(2.25, 0.4), -100.0 * 0.25 * 1.2);
    assert_near(stop(-1.25, -0.4), 100.0 * 0.25 * 1.2);
    assert_near(stop(2.25, -0.4), -100.0 * 0.25 * 0.8);
    assert_eq!(stop(2.25, -3.0), 0.0);
}

#[test]
fn a_motor_gives_what_its_line_allows_less_its_loss() {
    // 2 N after a gear of 10, 50 m/s: 20 N at a standstill, none at 5 m/s.
    let motor = |v: f64, tau: f64, efficiency: f64| slides(EffectId::motor, &[2.0, 50.0, 10.0, efficiency, 1e-9], 0.0, v, tau) * MASS;
    assert_near(motor(0.0, 7.0, 1.0), 7.0);
    assert_near(motor(0.0, 70.0, 1.0), 20.0);
    assert_near(motor(0.0, -70.0, 1.0), -20.0);
    assert_near(motor(2.0, 70.0, 1.0), 20.0 * 0.6);
    assert_near(motor(-2.0, 70.0, 1.0), 20.0);
    assert_near(motor(2.0, -70.0, 1.0), -20.0);
    assert_near(motor(9.0, 70.0, 1.0), 0.0);
    assert_near(motor(2.0, 5.0, 0.9), 4.5);
    assert_near(motor(-2.0, 5.0, 0.9), 5.5);
    assert_near(motor(-2.0, -5.0, 0.9), -4.5);
}

/// Acceleration [ω̇; v̇] of the ball with its effects, in its frame, standing as the base does at
/// height z and moving with the twist v.
fn moves(effects: &[Applied], z: f64, v: [f64; 6]) -> Vec<f64> {
    let model = ball().with_effects(effects).expect("effects on a ball");
    call(&model, "forward_dynamics", &[&[0.0, 0.0, z, 0.0, 0.0, 0.0, 1.0], &v, &[0.0; 6]])
}

/// ω × v, which the rates of a free body have besides.
fn turned(v: [f64; 6]) -> [f64; 3] {
    let [a, b, c, x, y, z] = v;
    [b * z - c * y, c * x - a * z, a * y - b * x]
}

fn assert_all_near(found: &[f64], expected: &[f64]) {
    found.iter().zip(expected).for_each(|(f, e)| assert_near(*f, *e));
}

#[test]
fn drag_is_the_square_of_the_speed() {
    let v = [0.0, 0.0, 0.0, 3.0, 0.0, 4.0];
    let found = moves(&[on(EffectId::drag, "ball", &[0.2])], 1.0, v);
    assert_all_near(&found, &[0.0, 0.0, 0.0, -0.2 * 5.0 * 3.0 / MASS, 0.0, -0.2 * 5.0 * 4.0 / MASS - G]);
}

#[test]
fn drag_of_a_box_is_along_its_axes() {
    let v = [0.5, -2.0, 0.0, 3.0, 0.0, -4.0];
    let found = moves(&[on(EffectId::box_drag, "ball", &[1.0, 2.0, 3.0, 0.1, 0.2, 0.3, 0.7, 0.05, 0.0, 0.0, 0.0])], 1.0, v);
    let w = turned(v);
    let linear = |c: f64, v: f64| -(c * v.abs() + 0.7) * v / MASS;
    let angular = |c: f64, v: f64| -(c * v.abs() + 0.05) * v / INERTIA;
    let expected = [angular(0.1, 0.5), angular(0.2, -2.0), 0.0, linear(1.0, 3.0) - w[0], -w[1], linear(3.0, -4.0) - w[2] - G];
    assert_all_near(&found, &expected);
}

/// Of a ball of radius r with the virtual mass m: drag c_b ρ π r² |v| v, and (c_m ρ V − ρ m) ω × v
/// of Magnus lift and added momentum; turns are dragged by c_a ρ (8/15 π r⁵) |ω| ω.
#[test]
fn a_ball_in_a_fluid_is_dragged_and_lifted() {
    use std::f64::consts::PI;
    let v = [0.5, -2.0, 0.0, 3.0, 0.0, -4.0];
    let [r, density, mass] = [0.2, 5.0, 0.01];
    let parameters = [&[r, r, r, density, 0.0, 0.4, 0.1, 1.5, 1.0, 0.7], &[mass; 3][..], &[0.0; 6]].concat();
    let found = moves(&[on(EffectId::ellipsoid_drag, "ball", &parameters)], 1.0, v);
    let lift = density * (0.7 * 4.0 / 3.0 * PI * r.powi(3) - mass);
    let (drag, turning) = (0.4 * density * PI * r * r * 5.0, 1.5 * density * 8.0 / 15.0 * PI * r.powi(5) * 4.25_f64.sqrt());
    // ω × v
    let w = turned(v);
    let linear = |k: usize| (lift * w[k] - drag * v[3 + k]) / MASS - w[k] - if k == 2 { G } else { 0.0 };
    let angular = |k: usize| -turning * v[k] / INERTIA;
    assert_all_near(&found, &[angular(0), angular(1), angular(2), linear(0), linear(1), linear(2)]);
}

/// A spring pulls a body back to a place and an orientation in the world.
#[test]
fn a_tether_pulls_to_a_pose() {
    let parameters = [3.0, 0.0, 1.0, 2.0, 0.0, 0.0, 0.1, 0.0, 1.0, 0.0, 0.0, 0.0, 2.0];
    let model = ball().with_effects(&[on(EffectId::tether, "ball", &parameters)]).expect("an effect");
    let q = [0.1, 0.0, 1.5, (0.3_f64).sin(), 0.0, 0.0, (0.3_f64).cos()];
    let energy = call(&model, "potential_energy", &[&q])[0] - MASS * G * 1.5;
    assert_near(energy, 0.5 * 3.0 * 0.25 + 0.25 * 0.0625 + 0.5 * 2.0 * 0.36);
}

#[test]
fn a_body_as_dense_as_water_floats_and_rights_itself() {
    let mut floats = on(EffectId::buoyancy, "ball", &[MASS / 1000.0, 1000.0]);
    assert_all_near(&moves(&[floats.clone()], 1.0, [0.0; 6]), &[0.0; 6]);
    // The centre of the displaced water aside: ρ V g pulls up there.
    floats.at.xyz = [0.1, 0.0, 0.0];
    assert_all_near(&moves(&[floats], 1.0, [0.0; 6]), &[0.0, -0.1 * MASS * G / INERTIA, 0.0, 0.0, 0.0, 0.0]);
}

#[test]
fn a_carried_weight_does_not_fall() {
    let falls = |mass: f64| moves(&[on(EffectId::gravity_compensation, "ball", &[mass])], 1.0, [0.0; 6]);
    assert_all_near(&falls(MASS), &[0.0; 6]);
    assert_all_near(&falls(0.25 * MASS), &[0.0, 0.0, 0.0, 0.0, 0.0, -0.75 * G]);
    assert_all_near(&falls(1.5 * MASS), &[0.0, 0.0, 0.0, 0.0, 0.0, 0.5 * G]);
    // T + U is kept: m g z of the body less that of the carried mass.
    let model = ball().with_effects(&[on(EffectId::gravity_compensation, "ball", &[0.25 * MASS])]).expect("an effect");
    let energy = |z: f64| call(&model, "potential_energy", &[&[0.0, 0.0, z, 0.0, 0.0, 0.0, 1.0]])[0];
    assert_near(energy(2.0) - energy(1.0), 0.75 * MASS * G);
}

#[test]
fn a_sphere_in_water_falls_as_with_half_the_water_more() {
    let (volume, density) = (0.0011, 1000.0);
    let half = 0.5 * density * volume;
    let added = [[0.0; 6].as_slice(), &[half, 0.0, 0.0, half, 0.0, half], &[0.0; 9]].concat();
    let effects = [on(EffectId::buoyancy, "ball", &[volume, density]), on(EffectId::added_mass, "ball", &added)];
    assert_all_near(&moves(&effects, 1.0, [0.0; 6]), &[0.0, 0.0, 0.0, 0.0, 0.0, -G * (MASS - density * volume) / (MASS + half)]);
}

/// Kirchhoff's equations: a long body in water turns broadside on (Munk's moment (m_x − m_z) u w).
#[test]
fn added_mass_turns_a_body_broadside_on() {
    let (x, z) = (0.4, 1.7);
    let added = [[0.0; 6].as_slice(), &[x, 0.0, 0.0, z, 0.0, z], &[0.0; 9]].concat();
    let effects = [on(EffectId::added_mass, "ball", &added)];
    let (u, w) = (1.5, -0.6);
    let found = moves(&effects, 1.0, [0.0, 0.0, 0.0, u, 0.0, w]);
    // I ω̇ = −p × v with p the momentum of the fluid: (v × p)_y = w (x u) − u (z w), and gravity on
    // the ball alone.
    assert_all_near(&found, &[0.0, -(w * x * u - u * z * w) / INERTIA, 0.0, 0.0, 0.0, -G * MASS / (MASS + z)]);
}

/// Kirchhoff's equations with a coupling: rows are moments, columns are accelerations.
#[test]
fn coupling_of_added_mass_takes_accelerations_to_moments() {
    // [[A, C], [Cᵀ, L]], all different.
    let a = [[9.0, 0.3, -0.2], [0.3, 8.0, 0.5], [-0.2, 0.5, 7.0]];
    let l = [[6.0, -0.4, 0.1], [-0.4, 5.0, 0.7], [0.1, 0.7, 4.0]];
    let c = [[0.11, -0.52, 0.33], [0.74, 0.25, -0.86], [0.47, -0.18, 0.69]];
    let upper = |m: [[f64; 3]; 3]| [m[0][0], m[0][1], m[0][2], m[1][1], m[1][2], m[2][2]];
    let added = on(EffectId::added_mass, "ball", &[&upper(a)[..], &upper(l), &c.concat()].concat());
    let model = ball().with_effects(&[added]).expect("added mass on a ball");
    let (v, rates) = ([0.4, -0.7, 0.2, 1.5, 0.3, -0.6], [0.9, 0.8, -0.5, 0.7, -1.1, 0.6]);
    // Momentum of the body, and of body and fluid, of a twist.
    let with = |x: [f64; 6], fluid: f64| {
        let moment: [f64; 3] =
            std::array::from_fn(|i| INERTIA * x[i] + fluid * (0..3).map(|k| a[i][k] * x[k] + c[i][k] * x[3 + k]).sum::<f64>());
        let force: [f64; 3] =
            std::array::from_fn(|i| MASS * x[3 + i] + fluid * (0..3).map(|k| c[k][i] * x[k] + l[i][k] * x[3 + k]).sum::<f64>());
        (moment, force)
    };
    let cross = |a: [f64; 3], b: [f64; 3]| [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    let [angular, linear] = [[v[0], v[1], v[2]], [v[3], v[4], v[5]]];
    let ((moment, force), (m, f)) = (with(rates, 1.0), with(v, 1.0));
    let (turning, carried, pushed) = (cross(angular, m), cross(linear, f), cross(angular, f));
    let expected: Vec<f64> = (0..3)
        .map(|i| moment[i] + turning[i] + carried[i])
        .chain((0..3).map(|i| force[i] + pushed[i] + if i == 2 { MASS * G } else { 0.0 }))
        .collect();
    let tau = call(&model, "inverse_dynamics", &[&[0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0], &v, &rates]);
    assert_all_near(&tau, &expected);
}

#[test]
fn a_ball_on_the_ground_rests_where_its_weight_is_held() {
    let (radius, stiffness) = (0.1, 5e3);
    let ground = |friction: f64| on(EffectId::contact, "ball", &[radius, stiffness, 0.4, friction, 1e-9, 0.0, 0.0, 3.0, 0.5, 0.0]);
    let rest = 0.5 + radius - MASS * G / stiffness;
    assert_all_near(&moves(&[ground(0.6)], rest, [0.0; 6]), &[0.0; 6]);
    let in_the_air = moves(&[ground(0.6)], 0.7, [0.0; 6]);
    assert_all_near(&in_the_air, &[0.0, 0.0, 0.0, 0.0, 0.0, -G]);
    // Falling: k x (1 + c ẋ).
    assert_all_near(&moves(&[ground(0.6)], rest, [0.0, 0.0, 0.0, 0.0, 0.0, -2.0]), &[0.0, 0.0, 0.0, 0.0, 0.0, G * 1.8 - G]);
    // Leaving faster than it springs back: no force holds it.
    assert_all_near(&moves(&[ground(0.6)], rest, [0.0, 0.0, 0.0, 0.0, 0.0, 3.0]), &[0.0, 0.0, 0.0, 0.0, 0.0, -G]);
    // Sliding while it falls: μ of the whole force, damping included.
    let both = moves(&[ground(0.6)], rest, [0.0, 0.0, 0.0, 1.0, 0.0, -2.0]);
    assert_all_near(&both, &[0.0, 0.6 * 1.8 * MASS * G * radius / INERTIA, 0.0, -0.6 * 1.8 * G, 0.0, 1.8 * G - G]);
    // Sliding: μ m g at the lowest point, which turns the ball.
    let sliding = moves(&[ground(0.6)], rest, [0.0, 0.0, 0.0, 1.0, 0.0, 0.0]);
    assert_all_near(&sliding, &[0.0, 0.6 * MASS * G * radius / INERTIA, 0.0, -0.6 * G, 0.0, 0.0]);
    // Rolling: the lowest point stands still.
    let v = [0.0, 2.0, 0.0, 2.0 * radius, 0.0, 0.0];
    let w = turned(v);
    assert_all_near(&moves(&[ground(0.6)], rest, v), &[0.0, 0.0, 0.0, -w[0], -w[1], -w[2]]);
}

/// With a damping time: under its load k (x + T ẋ), twice the spring's force at most, and none
/// where it leaves fast.
#[test]
fn damping_of_a_ball_at_rest_is_that_of_a_damper_and_never_pulls() {
    let (radius, stiffness, time) = (0.1, 5e3, 0.02);
    let parameters = [radius, stiffness, 0.0, 0.6, 1e-9, 0.0, 0.0, 1.0, 0.5, time];
    let x = MASS * G / stiffness;
    let push = |depth: f64, rate: f64| {
        let found = moves(&[on(EffectId::contact, "ball", &parameters)], 0.5 + radius - depth, [0.0, 0.0, 0.0, 0.0, 0.0, -rate]);
        (found[5] + G) * MASS
    };
    // T ẋ small beside x: k (x + T ẋ), to the third power of T ẋ/x.
    for rate in [1e-4, -1e-4] {
        assert!((push(x, rate) - stiffness * (x + time * rate)).abs() < stiffness * x * (time * rate / x).powi(3).abs(), "{rate}");
    }
    // T ẋ = x and −¾ x by hand.
    assert_near(push(x, x / time), stiffness * x * (1.0 + 0.5_f64.sqrt()));
    assert_near(push(x, -0.75 * x / time), stiffness * x * 0.4);
    for (rate, most) in [(1e6, 2.0), (-1e6, 0.0)] {
        let found = push(x, rate) / (stiffness * x);
        assert!(found > -1e-12 && found < 2.0 + 1e-12 && (found - most).abs() < 1e-8, "{rate}: {found}");
    }
    // No jump at the contact, at any speed, and no force beyond.
    assert!(push(1e-12, 3.0) <= 2.0 * stiffness * 1e-12 + 1e-11);
    assert_all_near(&[push(0.0, 3.0), push(-0.1, 3.0), push(-0.1, 0.0)], &[0.0; 3]);
    // Friction is that of the whole force.
    let sliding = moves(&[on(EffectId::contact, "ball", &parameters)], 0.5 + radius - x, [0.0, 0.0, 0.0, 1.0, 0.0, -x / time]);
    assert_near(sliding[3], -0.6 * (sliding[5] + G));
}

/// Kinetic energy of a rotor counts: ½ I n² q̇².
#[test]
fn a_rotor_has_energy() {
    let model = slide().with_effects(&[on(EffectId::armature, "slide", &[0.01, 20.0])]).expect("a rotor");
    assert_near(call(&model, "kinetic_energy", &[&[0.0], &[3.0]])[0], 0.5 * (MASS + 4.0) * 9.0);
}

/// A body on a rotor may have no mass: the joint moves the rotor.
#[test]
fn a_rotor_makes_a_massless_joint_move_something() {
    let mut bare = slide();
    bare.set_inertia(BodyId(1), articulated_core::spatial::SpatialInertia::zero());
    assert_eq!(bare.massless_joints(), [BodyId(1)]);
    let driven = bare.with_effects(&[on(EffectId::armature, "slide", &[0.01, 20.0])]).expect("a rotor");
    assert!(driven.massless_joints().is_empty());
    assert_near(call(&driven, "forward_dynamics", &[&[0.3], &[0.7], &[5.0]])[0], 5.0 / 4.0);
}

/// Water that has to be moved is inertia too: along a slide, and not about an axis through its
/// middle.
#[test]
fn added_mass_makes_a_massless_joint_move_something() {
    let mut bare = slide();
    bare.set_inertia(BodyId(1), articulated_core::spatial::SpatialInertia::zero());
    let added = |linear: f64| [&[0.0; 6][..], &[linear, 0.0, 0.0, linear, 0.0, linear], &[0.0; 9]].concat();
    let link = bare.frames().last().unwrap().name.clone();
    let wet = |linear: f64| bare.clone().with_effects(&[on(EffectId::added_mass, &link, &added(linear))]).expect("added mass");
    assert!(wet(2.0).massless_joints().is_empty());
    assert_near(call(&wet(2.0), "forward_dynamics", &[&[0.3], &[0.7], &[5.0]])[0], 2.5);
    assert_eq!(wet(0.0).massless_joints(), [BodyId(1)]);
}
