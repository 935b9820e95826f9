//! Contact of collision geometry, and links that fall through the ground.

use articulated::Dynamics;
use articulated_core::effect::EffectId;

use super::{Outcome, Session, moved, session};

const G: f64 = 9.81;

/// A body of 2 kg with this geometry.
fn body(collision: &str) -> String {
    format!(
        "<robot name='r'><link name='body'><inertial><mass value='2'/><inertia ixx='0.01' ixy='0' ixz='0' iyy='0.02' iyz='0' izz='0.03'/></inertial>
         {collision}</link></robot>"
    )
}

/// A scene in which a body falls from rest.
fn fall(from: &str, effects: &str) -> String {
    format!("base = 'floating'\n[initial]\nbase = {{ {from} }}\n[simulation]\nend = 4.0\nintegrator = 'rodas4'\noutput = 0.1\n{effects}")
}

const CONTACT: &str = "[effects.contact]\nfrom = 'collision'\nstiffness = 1e4\ndamping = 1.0\nfriction = 0.5\n";

/// Height of the body at the end, m.
fn height(outcome: &Outcome) -> f64 {
    assert_eq!(outcome.error, None);
    outcome.recording.q_at(outcome.recording.len() - 1)[2]
}

fn rest(collision: &str, from: &str) -> f64 {
    let session = session(&fall(from, CONTACT), &body(collision));
    let outcome = moved(&session);
    assert_eq!(session.warning_of_penetrations_at_start(outcome.recording.q_at(0)), None);
    assert_eq!(session.warning_of_penetrations(&outcome.penetrations), None);
    height(&outcome)
}

/// m g = n k x: four corners of a box, two ends of a lying capsule, one sphere, eight points of a
/// rim, two edges of a lying cylinder.
#[test]
fn a_body_at_rest_sinks_in_by_its_weight_over_the_stiffness_of_what_it_stands_on() {
    let sunk = |points: f64| 2.0 * G / (points * 1e4);
    let shape = |shape: &str| format!("<collision><geometry>{shape}</geometry></collision>");
    let cases = [
        (shape("<box size='0.4 0.3 0.2'/>"), "xyz = [0, 0, 0.15]", 0.1 - sunk(4.0)),
        (shape("<sphere radius='0.1'/>"), "xyz = [0, 0, 0.15]", 0.1 - sunk(1.0)),
        (shape("<cylinder radius='0.1' length='0.2'/>"), "xyz = [0, 0, 0.15]", 0.1 - sunk(8.0)),
        (shape("<capsule radius='0.05' length='0.3'/>"), "xyz = [0, 0, 0.1], rpy = [0, 1.5707963267948966, 0]", 0.05 - sunk(2.0)),
        (shape("<cylinder radius='0.1' length='0.3'/>"), "xyz = [0, 0, 0.15], rpy = [0, 1.5707963267948966, 0]", 0.1 - sunk(2.0)),
        // A box that rests on its side, with an offset in the link.
        (
            "<collision><origin xyz='0 0 -0.2' rpy='0 1.5707963267948966 0'/><geometry><box size='0.4 0.3 0.2'/></geometry></collision>"
                .to_owned(),
            "xyz = [0, 0, 0.45]",
            0.4 - sunk(4.0),
        ),
    ];
    for (collision, from, expected) in cases {
        let found = rest(&collision, from);
        assert!((found - expected).abs() < 1e-6, "{collision}: {found} {expected}");
    }
}

/// The same points written out by hand move the body in the same way, to the last bit.
#[test]
fn points_of_geometry_are_those_that_could_be_written_out() {
    let capsule = "<collision><origin xyz='0.1 0 0'/><geometry><capsule radius='0.05' length='0.5'/></geometry></collision>";
    let from = "xyz = [0, 0, 0.4], rpy = [0.3, 0.2, 0.1]";
    let by_hand =
        |z: f64| format!("[[effects.contact.body]]\nxyz = [0.1, 0, {z}]\nradius = 0.05\nstiffness = 1e4\ndamping = 1.0\nfriction = 0.5\n");
    let [shapes, points] =
        [CONTACT.to_owned(), [by_hand(-0.25), by_hand(0.25)].concat()].map(|effects| session(&fall(from, &effects), &body(capsule)));
    assert_eq!(shapes.effects, points.effects);
    assert_eq!(moved(&shapes).recording.q, moved(&points).recording.q);
}

articulated::robot! {
    mod crawler {
        scene = "tests/laws/crawler.toml",
        functions = [motion],
    }
}

articulated::robot! {
    mod inline {
        urdf = "tests/laws/crawler.urdf",
        base = floating,
        effects = { contact = { from = collision, stiffness = 1e4, damping = 0.5, friction = 0.6 } },
        functions = [forward_dynamics],
    }
}

/// Generated code has the same contact, from a scene's file and from the macro's own words: 8
/// corners, a capsule and a ball fixed to its link, 16 points on rims.
#[test]
fn a_generated_robot_touches_the_ground_as_the_generic_one_does() {
    let session = session(include_str!("crawler.toml"), include_str!("crawler.urdf"));
    let of = |link: &str| session.effects_of(EffectId::contact).filter(|a| a.on == link).count();
    assert_eq!(["trunk", "arm", "nose", "wheel"].map(of), [8, 2, 1, 16]);
    let (generic, generated) = (moved(&session), session.run(&crawler::Robot, &crawler::FRAME_NAMES).unwrap());
    let (a, b) = (&generic.recording, &generated.recording);
    assert_eq!((a.len(), &a.t), (21, &b.t));
    let apart = |a: &[f64], b: &[f64]| a.iter().zip(b).fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
    // A hundred tolerances for places and ten thousand for rates: steps over contacts that begin
    // are not smooth.
    assert!(apart(&a.q, &b.q) < 1e-7 && apart(&a.v, &b.v) < 1e-5, "{:e} {:e}", apart(&a.q, &b.q), apart(&a.v, &b.v));
    // Deep in the ground, with speed, where most of the points push.
    let (q, v) = (a.q_at(20), a.v_at(20));
    let mut low = q.to_vec();
    low[2] -= 0.1;
    let (mut of_model, mut ws) = (vec![0.0; v.len()], session.model.workspace());
    session.model.forward_dynamics(&mut ws, &low, v, &vec![0.0; v.len()], &mut of_model).unwrap();
    let taken = inline::forward_dynamics(low[..].try_into().unwrap(), v.try_into().unwrap(), &[0.0; inline::NV]);
    let scale = of_model.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    assert!(scale > 100.0 && apart(&of_model, &taken) < 1e-11 * scale, "{:e} of {scale:e}", apart(&of_model, &taken));
}

/// A point that rests on the plane is below it by no more than the depth due to its weight; then
/// there is no warning.
#[test]
fn a_point_that_rests_in_the_plane_is_not_odd() {
    let plate = body("<collision><geometry><box size='0.4 0.3 0.2'/></geometry></collision>");
    let sunk = |z: f64| {
        let session = session(&fall(&format!("xyz = [0, 0, {z}]"), CONTACT), &plate);
        session.sunk(&session.initial_state().unwrap().q).len()
    };
    let one = 2.0 * G / 1e4;
    assert_eq!((sunk(0.1 - 0.25 * one), sunk(0.1 - 0.99 * one), sunk(0.1 - 1.01 * one)), (0, 0, 4));
}

/// A leg whose foot alone has contact, under a trunk held only by springs: a trunk of 0.4 m, a foot
/// of 0.2 m, a shin of 0.5 m.
fn hopper(trunk: &str) -> String {
    format!(
        "<robot name='r'><link name='trunk'><inertial><mass value='5'/><inertia ixx='0.1' ixy='0' ixz='0' iyy='0.1' iyz='0' izz='0.1'/></inertial>
           <collision><geometry>{trunk}</geometry></collision></link>
         <link name='shin'><inertial><mass value='1'/><inertia ixx='0.01' ixy='0' ixz='0' iyy='0.01' iyz='0' izz='0.01'/></inertial>
           <collision><origin xyz='0 0 -0.25'/><geometry><capsule radius='0.03' length='0.44'/></geometry></collision></link>
         <link name='foot'><inertial><mass value='0.5'/><inertia ixx='0.01' ixy='0' ixz='0' iyy='0.01' iyz='0' izz='0.01'/></inertial>
           <collision><origin xyz='0 0 -0.02'/><geometry><box size='0.2 0.1 0.04'/></geometry></collision></link>
         <joint name='hip' type='continuous'><parent link='trunk'/><child link='shin'/><axis xyz='0 1 0'/></joint>
         <joint name='ankle' type='fixed'><parent link='shin'/><child link='foot'/><origin xyz='0 0 -0.5'/></joint></robot>"
    )
}

const BOX: &str = "<box size='0.4 0.2 0.2'/>";

const FEET: &str = "[[effects.contact.foot]]\nxyz = [0.1, 0, -0.04]\nradius = 0.0\nstiffness = 1e5\ndamping = 1.0\nfriction = 0.5\n
    [[effects.contact.foot]]\nxyz = [-0.1, 0, -0.04]\nradius = 0.0\nstiffness = 1e5\ndamping = 1.0\nfriction = 0.5\n";

/// A leg on a line of two points falls to its side, and its trunk goes through the floor.
#[test]
fn a_link_that_falls_through_is_named_with_its_depth_and_time() {
    let scene =
        fall("xyz = [0, 0, 0.545], rpy = [0.2, 0, 0]", FEET).replace("end = 4.0", "end = 1.5").replace("output = 0.1", "output = 'steps'");
    for trunk in [BOX, "<mesh filename='trunk.stl'/>"] {
        let session = session(&scene, &hopper(trunk));
        let Outcome { recording, error, penetrations: found, .. } = moved(&session);
        assert_eq!(error, None);
        assert_eq!(session.warning_of_penetrations_at_start(recording.q_at(0)), None);
        let trunk_is_box = trunk == BOX;
        let deep = found.iter().find(|p| p.link == "trunk").unwrap_or_else(|| panic!("{found:?}"));
        // By hand, from the recorded states.
        let corner = |k: usize| {
            let q = recording.q_at(k);
            let [x, y, z, w] = [q[3], q[4], q[5], q[6]];
            let down = [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)];
            let half = if trunk_is_box { [0.2, 0.1, 0.1] } else { [0.0; 3] };
            (0..3).map(|k| half[k] * down[k].abs()).sum::<f64>() - q[2]
        };
        let diagonal = if trunk_is_box { (0.16_f64 + 0.04 + 0.04).sqrt() } else { 0.0 };
        let first = (0..recording.len()).find(|k| corner(*k) > 0.05 * diagonal).unwrap();
        let deepest = (0..recording.len()).max_by(|a, b| corner(*a).total_cmp(&corner(*b))).unwrap();
        assert_eq!((deep.from, deep.at), (recording.t[first], recording.t[deepest]));
        assert!((deep.depth - corner(deepest)).abs() < 1e-12 && deep.depth > 0.1, "{deep:?}");
        let told = session.warning_of_penetrations(&found).unwrap();
        let line = format!("\"trunk\" from t = {} s on, ", recording.t[first]);
        assert!(told.starts_with("s.toml: effects.contact: found ") && told.contains(&line), "{told}");
        assert!(told.contains("below a contact plane") && told.contains("`from = \"collision\"`"), "{told}");
    }
}

/// With contact of all geometry no link penetrates a plane, and there is no warning.
#[test]
fn with_contact_of_its_geometry_nothing_falls_through() {
    let scene = fall("xyz = [0, 0, 0.545], rpy = [0.2, 0, 0]", CONTACT).replace("end = 4.0", "end = 1.5");
    let session = session(&scene.replace("1e4", "1e5"), &hopper(BOX));
    assert_eq!(session.effects_of(EffectId::contact).count(), 8 + 2 + 8);
    let outcome = moved(&session);
    assert!(height(&outcome) > 0.05, "{}", height(&outcome));
    assert_eq!(session.warning_of_penetrations(&outcome.penetrations), None);
}

fn told_at(session: &Session) -> Option<String> {
    session.warning_of_penetrations_at_start(&session.initial_state().unwrap().q)
}

#[test]
fn a_start_below_the_plane_is_told() {
    let at = |z: f64, effects: &str| told_at(&session(&fall(&format!("xyz = [0, 0, {z}]"), effects), &hopper(BOX)));
    // The foot rests on the plane; its shin ends 0.01 m above the foot's sole.
    assert_eq!(at(0.54, FEET), None);
    assert_eq!(at(0.539, FEET), None);
    // Without contact there are no planes.
    assert_eq!(at(-3.0, ""), None);
    // Deep below, contacts explain the depth of the foot, but not of other parts of its body.
    let told = at(-1.0, FEET).unwrap();
    assert!(told.starts_with("s.toml: effects.contact: found 1 link below a contact plane at the start where no contact holds it: \"trunk\" (1.1 m deep), expected"), "{told}");
    let told = at(-1.0, &FEET.replace("effects.contact.foot", "effects.contact.trunk").replace("-0.04", "-0.1")).unwrap();
    assert!(
        told.contains("found 2 links below") && told.contains("\"foot\" (1.54 m deep); \"shin\" (1.5 m deep), expected them"),
        "{told}"
    );
}

/// Links fixed to the base do not fall.
#[test]
fn what_does_not_move_is_not_told() {
    // The trunk is the base, which reaches 0.1 m below the world frame; the plane is above all of
    // the robot.
    let scene = format!("[simulation]\nend = 1.0\n{FEET}").replace("friction = 0.5", "friction = 0.5\nheight = 0.3");
    assert_eq!(told_at(&session(&scene, &hopper(BOX))), None);
    let scene = scene.replace("effects.contact.foot", "effects.contact.shin").replace("-0.04", "-0.54");
    assert_eq!(told_at(&session(&scene, &hopper(BOX))), None);
}
