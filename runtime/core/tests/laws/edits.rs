//! Effects of locking a joint, attaching a payload and appending a robot on the dynamics; and
//! refused edits.

use articulated_core::description::{Base, Description, EditError, Inertial, JointId, JointKind, Link, LinkId, Origin, Payload};
use articulated_core::model::{FLOATING_BASE, JointInfo, Model};
use articulated_test_support::case::{Case, State, for_each_bundled, inverse_dynamics, mass_matrix, placements, read};
use articulated_test_support::measure::{distance, scale, torque_scale};
use articulated_test_support::random::Random;
use articulated_test_support::random_tree::Flavour;
use articulated_test_support::virtual_power::Motions;

use crate::trees::for_each_tree;

/// Errors allowed, in units of u times the magnitude of the terms.
const FEW: f64 = 16.0;

/// All but those from `at` on, `n` of them.
fn without(x: &[f64], (at, n): (usize, usize)) -> Vec<f64> {
    [&x[..at], &x[at + n..]].concat()
}

/// Some joint of the file that is a coordinate.
fn some_joint(case: &Case, random: &mut Random) -> Option<JointInfo> {
    let joints: Vec<&JointInfo> = case.model.joints().iter().filter(|j| j.name != FLOATING_BASE).collect();
    (!joints.is_empty()).then(|| (*random.choose(&joints)).clone())
}

fn locked_is_at_rest(case: &Case, random: &mut Random) {
    let Some(joint) = some_joint(case, random) else { return };
    let mut state = case.state(random);
    for x in [&mut state.v, &mut state.a] {
        x[joint.v.0..joint.v.0 + joint.v.1].fill(0.0);
    }
    let mut description = case.description.clone();
    description.lock(&joint.name, &state.q[joint.q.0..joint.q.0 + joint.q.1]).unwrap();
    let locked = Model::new(&description, case.base).unwrap();
    assert_eq!((locked.nq(), locked.nv()), (case.model.nq() - joint.q.1, case.model.nv() - joint.v.1));
    let q = without(&state.q, joint.q);
    let tau = inverse_dynamics(&locked, &q, &without(&state.v, joint.v), &without(&state.a, joint.v));
    let far = distance(&tau, &without(&case.inverse_dynamics(&state), joint.v), &without(&torque_scale(case, &state), joint.v));
    assert!(far <= FEW, "{}: torque: {far} units of roundoff", joint.name);
    let m = mass_matrix(&case.model, &state.q).remove_rows(joint.v.0, joint.v.1).remove_columns(joint.v.0, joint.v.1);
    let off = (mass_matrix(&locked, &q) - &m).amax();
    assert!(off <= 1e-13 * m.amax(), "{}: mass matrix: {off}", joint.name);
    let far = distance(&placements(&locked, &q), &placements(&case.model, &state.q), &scale(case, "placements", &state));
    assert!(far <= FEW, "{}: placements: {far} units of roundoff", joint.name);
}

#[test]
fn a_locked_joint_leaves_the_other_rows_and_columns() {
    for_each_tree(150, Flavour::ANY, locked_is_at_rest);
    for_each_bundled(locked_is_at_rest);
}

/// The robot with no mass but that of one body on one link.
fn only(description: &Description, link: usize, body: Inertial) -> Description {
    let mut bare = description.clone();
    bare.links.iter_mut().for_each(|l| l.inertial = None);
    bare.links[LinkId(link)].inertial = Some(body);
    bare
}

fn payload_adds_its_own_forces(case: &Case, random: &mut Random) {
    let state = case.state(random);
    let link = random.below(case.description.links.len());
    let inertia = *random.choose(&[[0.0; 6], [0.02, 0.001, 0.0, 0.03, -0.002, 0.015]]);
    let body = Inertial { origin: Origin::at(random.three(0.4)), mass: random.within(0.1, 3.0), inertia };
    let mut loaded = case.description.clone();
    let name = case.description.links[LinkId(link)].name.clone();
    let payload = Payload { link: name, mass: body.mass, center_of_mass: body.origin.xyz, inertia, name: None };
    let payload = loaded.attach(&payload).unwrap();
    let loaded = Case::new("loaded", loaded, case.base);
    assert_eq!(loaded.model.frames().last().unwrap().name, payload);
    let bare = only(&case.description, link, body);
    let own = Motions::new(&bare, case.base, case.gravity).inverse_dynamics(&state.q, &state.v, &state.a);
    let expected: Vec<f64> = case.inverse_dynamics(&state).iter().zip(own).map(|(tau, own)| tau + own).collect();
    let far = distance(&loaded.inverse_dynamics(&state), &expected, &torque_scale(&loaded, &state));
    assert!(far <= FEW, "{far} units of roundoff");
}

#[test]
fn a_payload_adds_the_forces_of_its_own_mass() {
    for_each_tree(150, Flavour::ANY, payload_adds_its_own_forces);
    for_each_bundled(payload_adds_its_own_forces);
}

#[test]
fn a_payloads_frame_is_at_its_centre() {
    let mut arm = read(ARM);
    let payload = Payload { link: "fore".into(), mass: 1.0, center_of_mass: [0.0, 0.2, 0.1], ..Payload::default() };
    arm.attach(&payload).unwrap();
    let at = placements(&Model::new(&arm, Base::Fixed).unwrap(), &[0.0]);
    assert_eq!(at[at.len() - 3..], [0.3, 0.2, 0.1]);
}

const ARM: &str = r#"<robot name="arm">
  <link name="base"/>
  <link name="fore"><inertial><origin xyz="0.1 0 0"/><mass value="2"/>
    <inertia ixx="0.1" ixy="0" ixz="0" iyy="0.2" iyz="0" izz="0.2"/></inertial></link>
  <joint name="elbow" type="continuous"><parent link="base"/><child link="fore"/><origin xyz="0.3 0 0"/><axis xyz="0 1 0"/></joint>
</robot>"#;

const GRIPPER: &str = r#"<robot name="gripper">
  <link name="finger"><inertial><mass value="0.1"/><inertia ixx="1e-4" ixy="0" ixz="0" iyy="1e-4" iyz="0" izz="1e-4"/></inertial></link>
  <link name="thumb"><inertial><mass value="0.2"/><inertia ixx="2e-4" ixy="0" ixz="0" iyy="2e-4" iyz="0" izz="2e-4"/></inertial></link>
  <link name="palm"/>
  <joint name="oppose" type="prismatic"><parent link="palm"/><child link="thumb"/><axis xyz="0 -1 0"/>
    <limit lower="0" upper="1" effort="1" velocity="1"/><mimic joint="close" multiplier="-1" offset="0.1"/></joint>
  <joint name="close" type="prismatic"><parent link="palm"/><child link="finger"/><origin rpy="0 0 1"/><axis xyz="0 1 0"/>
    <limit lower="0" upper="1" effort="1" velocity="1"/></joint>
</robot>"#;

/// Both, as somebody would write them into one file.
const BOTH: &str = r#"<robot name="arm">
  <link name="base"/>
  <link name="fore"><inertial><origin xyz="0.1 0 0"/><mass value="2"/>
    <inertia ixx="0.1" ixy="0" ixz="0" iyy="0.2" iyz="0" izz="0.2"/></inertial></link>
  <link name="left_finger"><inertial><mass value="0.1"/><inertia ixx="1e-4" ixy="0" ixz="0" iyy="1e-4" iyz="0" izz="1e-4"/></inertial></link>
  <link name="left_thumb"><inertial><mass value="0.2"/><inertia ixx="2e-4" ixy="0" ixz="0" iyy="2e-4" iyz="0" izz="2e-4"/></inertial></link>
  <link name="left_palm"/>
  <joint name="elbow" type="continuous"><parent link="base"/><child link="fore"/><origin xyz="0.3 0 0"/><axis xyz="0 1 0"/></joint>
  <joint name="left_oppose" type="prismatic"><parent link="left_palm"/><child link="left_thumb"/><axis xyz="0 -1 0"/>
    <limit lower="0" upper="1" effort="1" velocity="1"/><mimic joint="left_close" multiplier="-1" offset="0.1"/></joint>
  <joint name="left_close" type="prismatic"><parent link="left_palm"/><child link="left_finger"/><origin rpy="0 0 1"/><axis xyz="0 1 0"/>
    <limit lower="0" upper="1" effort="1" velocity="1"/></joint>
  <joint name="left_palm_mount" type="fixed"><parent link="fore"/><child link="left_palm"/><origin xyz="0.2 0 0.05" rpy="0.1 0 0.4"/></joint>
</robot>"#;

const MOUNT: Origin = Origin::new([0.2, 0.0, 0.05], [0.1, 0.0, 0.4]);

#[test]
fn an_appended_robot_is_the_combined_file() {
    let mut arm = read(ARM);
    arm.append("fore", &read(GRIPPER), "left_", MOUNT).unwrap();
    assert_eq!(arm, read(BOTH));
    // A second one of another prefix, and one without.
    arm.append("fore", &read(GRIPPER), "right_", MOUNT).unwrap();
    arm.append("right_palm", &read(GRIPPER), "", Origin::default()).unwrap();
    let model = Model::new(&arm, Base::Floating).unwrap();
    let names: Vec<&str> = model.joints().iter().map(|j| j.name.as_str()).collect();
    assert_eq!(names, [FLOATING_BASE, "elbow", "left_close", "right_close", "close"]);
}

/// With the first robot's joints locked, the second is by itself, on a base at the mount.
#[test]
fn an_appended_robot_moves_as_it_does_alone() {
    let mut both = read(ARM);
    both.append("fore", &read(GRIPPER), "", MOUNT).unwrap();
    both.lock("elbow", &[0.7]).unwrap();
    let both = Case::new("both", both, Base::Fixed);
    let turned = {
        let at = placements(&both.model, &[0.0]);
        let palm = both.description.link("palm").unwrap();
        // Gravity in axes of the palm: Rᵀ g.
        [6, 7, 8].map(|k| at[12 * palm.0 + k] * -9.81)
    };
    let alone = Case::new("alone", read(GRIPPER), Base::Fixed).with_gravity(turned);
    let state = both.state(&mut Random::new(3));
    let far = distance(&both.inverse_dynamics(&state), &alone.inverse_dynamics(&state), &torque_scale(&both, &state));
    assert!(far <= FEW, "{far} units of roundoff");
}

/// A refusal, and the description as it was.
fn refused<T: std::fmt::Debug>(description: &mut Description, edit: impl FnOnce(&mut Description) -> Result<T, EditError>) -> EditError {
    let before = description.clone();
    let error = edit(description).unwrap_err();
    assert_eq!(*description, before);
    error
}

#[test]
fn locks_that_mean_nothing_are_refused() {
    let mut robot = read(BOTH);
    let mut lock = |joint: &str, at: &[f64]| refused(&mut robot, |r| r.lock(joint, at)).to_string();
    assert_eq!(lock("elbo", &[0.0]), "the robot has no joint \"elbo\", did you mean \"elbow\"?");
    assert_eq!(lock("hip", &[0.0]), "the robot has no joint \"hip\"");
    assert_eq!(lock("left_palm_mount", &[]), "joint \"left_palm_mount\" is fixed: there is nothing to lock");
    assert_eq!(lock("left_oppose", &[0.0]), "joint \"left_oppose\" follows \"left_close\": lock that one");
    assert_eq!(lock(FLOATING_BASE, &[0.0; 7]), "the floating base cannot be locked: say that the base is fixed");
    assert!(lock("elbow", &[0.0, 1.0]).contains("locked at [0.0, 1.0], expected one finite number for a continuous joint"));
    assert!(lock("elbow", &[f64::NAN]).contains("finite"));
    robot.lock("elbow", &[0.1]).unwrap();
    assert_eq!(refused(&mut robot, |r| r.lock("elbow", &[0.2])), EditError::LockedTwice { joint: "elbow".into() });
}

#[test]
fn a_quaternion_is_normalised_if_it_nearly_is_one() {
    let mut robot = read(ARM);
    robot.joints[JointId(0)].kind = JointKind::Spherical;
    let error = refused(&mut robot, |r| r.lock("elbow", &[0.0, 0.0, 1.0, 1.0]));
    assert!(matches!(error, EditError::Quaternion { norm, .. } if (norm - 2.0_f64.sqrt()).abs() < 1e-15));
    robot.lock("elbow", &[0.0, 0.0, 0.6, 0.8001]).unwrap();
    let [_, _, z, w] = robot.joints[JointId(0)].locked.as_deref().unwrap() else { panic!("four numbers") };
    assert!((z.hypot(*w) - 1.0).abs() < 1e-15 && (z / w - 0.6 / 0.8001).abs() < 1e-15);
}

/// A norm that is off by the fourth digit is a matter of writing, one that is off by the third is
/// not.
#[test]
fn a_quaternion_may_be_off_by_a_thousandth() {
    for (by, right) in [(9e-4, true), (-9e-4, true), (1.1e-3, false), (-1.1e-3, false)] {
        let mut robot = read(ARM);
        robot.joints[JointId(0)].kind = JointKind::Spherical;
        let found = robot.lock("elbow", &[0.0, 0.6 * (1.0 + by), 0.0, 0.8 * (1.0 + by)]);
        assert_eq!(found.is_ok(), right, "{by}: {found:?}");
    }
}

/// c = 3 b + 0.7 and b = 2 a + 0.3, with a locked at 0.5: where the robot that is not locked has
/// them there.
#[test]
fn who_follows_a_locked_joint_through_another_stops_where_they_put_it() {
    let joint = |name: &str, parent: &str, child: &str, follows: &str| {
        format!(
            r#"<link name="{child}"><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
            <joint name="{name}" type="continuous"><parent link="{parent}"/><child link="{child}"/><origin xyz="0.3 0.1 0"/><axis xyz="0 1 0"/>{follows}</joint>"#
        )
    };
    let text = [
        joint("a", "base", "upper", ""),
        joint("b", "upper", "fore", r#"<mimic joint="a" multiplier="2" offset="0.3"/>"#),
        joint("c", "fore", "hand", r#"<mimic joint="b" multiplier="3" offset="0.7"/>"#),
    ];
    let mut robot = read(&format!(r#"<robot name="chain"><link name="base"/>{}</robot>"#, text.concat()));
    let free = Model::new(&robot, Base::Fixed).unwrap();
    robot.lock("a", &[0.5]).unwrap();
    let locked = Model::new(&robot, Base::Fixed).unwrap();
    assert_eq!((free.nq(), locked.nq()), (1, 0));
    let (found, expected) = (placements(&locked, &[]), placements(&free, &[0.5]));
    assert!(found.iter().zip(&expected).all(|(a, b)| (a - b).abs() < 1e-15), "{found:?} {expected:?}");
    // The hand is turned by a + b + c = 0.5 + 1.3 + 4.6.
    assert!((found[found.len() - 12] - 6.4_f64.cos()).abs() < 1e-15);
}

#[test]
fn payloads_that_cannot_be_are_refused() {
    let mut arm = read(ARM);
    let good = Payload { link: "fore".into(), mass: 1.0, ..Payload::default() };
    let bad = [
        (Payload { link: "for".into(), ..good.clone() }, "no link or frame \"for\", did you mean \"fore\"?"),
        (Payload { name: Some("elbow".into()), ..good.clone() }, "taken: \"elbow\""),
        (Payload { mass: -1.0, ..good.clone() }, "found -1 kg"),
        (Payload { mass: f64::INFINITY, ..good.clone() }, "mass"),
        (Payload { center_of_mass: [0.0, f64::NAN, 0.0], ..good.clone() }, "centre of mass"),
        (Payload { inertia: [1.0, 0.0, 0.0, 1.0, 0.0, -3.0], ..good.clone() }, "inertia: found [1.0"),
        (Payload { inertia: [1.0, 0.0, 0.0, 1.0, 0.0, 1.0], mass: 0.0, ..good.clone() }, "with mass"),
    ];
    for (payload, words) in bad {
        let message = refused(&mut arm, |r| r.attach(&payload)).to_string();
        assert!(message.contains(words), "{message}");
    }
    let names: Vec<String> = (0..3).map(|_| arm.attach(&good).unwrap()).collect();
    assert_eq!(names, ["fore_payload", "fore_payload_2", "fore_payload_3"]);
}

#[test]
fn robots_that_clash_are_refused_with_every_name() {
    let mut arm = read(ARM);
    let message = refused(&mut arm, |r| r.append("fore", &read(ARM), "", MOUNT)).to_string();
    assert_eq!(message, "names are taken: \"base\", \"fore\", \"elbow\"; give another name or prefix");
    assert!(matches!(refused(&mut arm, |r| r.append("tip", &read(GRIPPER), "", MOUNT)), EditError::UnknownLink { .. }));
    let nothing = Description { name: "nothing".into(), ..Description::default() };
    assert!(matches!(refused(&mut arm, |r| r.append("fore", &nothing, "", MOUNT)), EditError::NoRoot { .. }));
    let tool = Description { links: [Link { name: "tool".into(), ..Link::default() }].into(), ..Description::default() };
    arm.append("fore", &tool, "", MOUNT).unwrap();
}

/// The state of a locked robot differs from that of the whole one by its length alone.
#[test]
fn a_locked_spherical_joint_takes_four_coordinates_and_three_rates_away() {
    let mut robot = read(ARM);
    robot.joints[JointId(0)].kind = JointKind::Spherical;
    let whole = Case::new("whole", robot.clone(), Base::Floating);
    robot.lock("elbow", &[0.5, 0.5, -0.5, 0.5]).unwrap();
    let locked = Case::new("locked", robot, Base::Floating);
    assert_eq!((whole.model.nq() - locked.model.nq(), whole.model.nv() - locked.model.nv()), (4, 3));
    let State { q, .. } = locked.state(&mut Random::new(1));
    let turned: Vec<f64> = [&q[..], &[0.5, 0.5, -0.5, 0.5]].concat();
    assert_eq!(placements(&locked.model, &q), placements(&whole.model, &turned));
}
