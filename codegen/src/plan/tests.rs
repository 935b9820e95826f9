//! All findings about a request, each once.

use articulated_core::diagnostic::Spanned;

use crate::{Options, Request, generate};

const ARM: &str = "<robot name='arm'><link name='base'/><link name='tip-1'><inertial><mass value='1'/>\
    <inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial></link><link name='tip 1'/><link name='tip.1'/>\
    <joint name='hinge' type='continuous'><parent link='base'/><child link='tip-1'/></joint>\
    <joint name='one' type='fixed'><parent link='base'/><child link='tip 1'/></joint>\
    <joint name='two' type='fixed'><parent link='base'/><child link='tip.1'/></joint></robot>";

/// Names for code.
fn renamings(all: &[(&str, &str)]) -> Vec<Spanned<(String, String)>> {
    all.iter().map(|(from, to)| ((*from).to_owned(), (*to).to_owned()).into()).collect()
}

fn error_of(change: impl Fn(&mut Options)) -> String {
    let mut request = Request::new("arm.urdf", ARM);
    request.options.rename = renamings(&[("tip-1", "A"), ("tip 1", "B"), ("tip.1", "C")]);
    change(&mut request.options);
    generate(&request).map(|_| String::new()).unwrap_or_else(|e| e.to_string())
}

fn each_once(told: &str, words: &[&str]) {
    assert!(words.iter().all(|word| told.lines().filter(|line| line.contains(word)).count() == 1), "{told}");
    assert_eq!(told.lines().count(), words.len(), "{told}");
}

#[test]
fn every_function_that_cannot_be_is_told_once() {
    let list = [
        "mass_matrix",
        "no_such",
        "other = inverse_dynamics(b = 0)",
        "x = no_such_2 + mass_matrix",
        "placements",
        "mass_matrix = placements",
        "placements = placements(q = 0)",
    ];
    let told = error_of(|o| o.functions = list.map(Into::into).to_vec());
    each_once(
        &told,
        &["function `no_such`", "b = 0", "function `no_such_2`", "what another function is called", "two are called `placements`"],
    );
}

/// Whatever other entries have the name in them, as a part of a sum or an argument.
#[test]
fn each_entry_s_own_mistake_is_told_once() {
    let constant = |name: &str| format!("`{name}`: constant q");
    for (list, names) in [
        (["placements(q = [0, 1])", "x = gravity_torque(q = [0, 1]) + placements"], ["placements", "x"]),
        (["v = placements(q = [0, 1])", "x = bias_forces(v = [0], q = [0, 1])"], ["v", "x"]),
        (["placements(q = [0, 1])", "x = placements(q = [1, 2, 3])"], ["placements", "x"]),
    ] {
        let told = error_of(|o| o.functions = list.map(Into::into).to_vec());
        each_once(&told, &[&constant(names[0]), &constant(names[1])]);
    }
}

#[test]
fn functions_that_nobody_knows_are_told_of_a_robot_that_cannot_be_read_too() {
    let mut request = Request::new("arm.urdf", ARM.replace("mass value='1'", "mass value='one'"));
    request.options.functions = ["no_such", "mass_matrix", "x = inverse_dynamics(b = 0)"].map(Into::into).to_vec();
    each_once(&generate(&request).unwrap_err().to_string(), &["`no_such`", "b = 0", "mass value"]);
}

#[test]
fn numbers_that_cannot_be_are_told_once_and_with_all_else() {
    let told = error_of(|o| {
        o.robot.gravity = Some([0.0, f64::NAN, 0.0]);
        o.robot.snap_angles = Some(2.0);
        o.functions = vec!["no_such".into()];
    });
    each_once(&told, &["gravity: found [0.0, NaN, 0.0], expected", "snap_angles: found 2, expected", "`no_such`"]);
}

#[test]
fn a_type_of_numbers_that_is_there_twice_is_told_once_and_with_all_else() {
    let told = error_of(|o| {
        o.batch = [crate::Real::F32, crate::Real::F64, crate::Real::F32, crate::Real::F32].to_vec();
        o.functions = vec!["no_such".into()];
    });
    each_once(&told, &["batch: found a type that is there twice, f32, expected each once", "`no_such`"]);
}

#[test]
fn of_a_function_and_a_form_of_another_the_name_that_both_have_is_told() {
    let list = ["gravity_torque_into = placements", "gravity_torque"];
    for list in [list, [list[1], list[0]]] {
        let told = error_of(|o| o.functions = list.map(Into::into).to_vec());
        assert!(told.contains("two are called `gravity_torque_into`"), "{told}");
    }
}

#[test]
fn every_name_that_two_have_is_told_and_every_renaming_that_cannot_be() {
    let told_of = |rename: &[(&str, &str)]| error_of(|o| o.rename = renamings(rename));
    assert_eq!(told_of(&[("tip 1", "B"), ("tip.1", "C")]), "");
    each_once(&told_of(&[]), &["\"tip 1\"", "\"tip.1\""]);
    each_once(&told_of(&[("tip 1", "B"), ("tip.1", "B"), ("nobody", "C"), ("hinge", "fn")]), &["nobody", "\"hinge\"", "`B`"]);
    each_once(&told_of(&[("tip 1", "B"), ("tip.1", "C"), ("tip 1", "D")]), &["rename \"tip 1\" to `D`: it is renamed twice"]);
}

#[test]
fn every_parameter_and_every_edit_that_cannot_be_is_told_once() {
    each_once(&error_of(|o| o.parameters = [" payload(x)", "origin(hinge)", "inertia(y) "].map(Into::into).to_vec()), &["\"x\"", "\"y\""]);
    let edits = error_of(|o| {
        o.robot.lock = [("a", 0.0), ("hinge", 0.0), ("b", 0.0)].map(|(name, at)| (name.to_owned(), vec![at]).into()).to_vec();
        o.robot.frames = Some(["tip-1", "c", "tip-1"].map(Into::into).to_vec());
        o.functions = vec!["no_such".into()];
        o.robot.shafts =
            ["d", "e"].map(|joint| crate::Shaft { joint: joint.into(), segments: 1, stiffness: 1.0, ..Default::default() }.into()).to_vec();
        o.rename.clear();
    });
    each_once(&edits, &["\"d\"", "\"e\"", "\"a\"", "\"b\"", "\"c\"", "listed twice", "no_such"]);
}

#[test]
fn every_effect_that_cannot_be_is_told_once_and_without_a_robot_nothing_that_needs_it() {
    let damping = |on: &str| crate::Applied {
        effect: articulated_core::effect::EffectId::damping,
        on: on.into(),
        at: crate::Origin::default(),
        parameters: vec![0.1],
    };
    let effects = error_of(|o| {
        o.robot.effects = ["hinge", "a", "hinge", "b"].map(damping).to_vec();
        o.functions = vec!["no_such".into()];
    });
    each_once(&effects, &["\"a\"", "given twice", "\"b\"", "`no_such`"]);
    let appended = error_of(|o| {
        let document = ARM.replace("'tip", "'top").into_bytes();
        o.robot.append.push(crate::Appended { document, file: "hand.urdf".into(), at: "nowhere".into(), ..Default::default() });
        o.robot.payloads.push(crate::Payload { link: "tip-1".into(), mass: -1.0, ..Default::default() }.into());
    });
    each_once(&appended, &["append: ", "payload: "]);
}
