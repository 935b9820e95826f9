use alloc::vec;
use alloc::vec::Vec;

use super::*;

fn at(line: u32) -> At {
    At::Text { line, column: 3 }
}

#[test]
fn a_finding_says_place_subject_field_found_expected_and_hint() {
    let subject = Subject::Link("arm".into());
    let place = Place { at: at(7), subject: &subject, field: "mass" };
    let error = Diagnostic::error("r.urdf", place, Code::NegativeMass, "-1 kg", "at least 0").with_nearest(Some("1"));
    assert_eq!(error.to_string(), "r.urdf:7: link \"arm\": mass: found -1 kg, expected at least 0; did you mean \"1\"?");
    assert_eq!((error.line(), error.span.at.column(), error.code.name()), (Some(7), Some(3), "negative_mass"));
    let refusal = Diagnostic::refusal("", (At::Word(2), "lock"), Code::Edit, "joint \"a\" is fixed");
    assert_eq!(refusal.to_string(), "lock: joint \"a\" is fixed");
}

#[test]
fn an_entry_that_a_file_gives_has_the_finding_at_its_place() {
    let finding = || Diagnostic::refusal("robot.urdf", (At::Nowhere, "functions"), Code::FunctionSpec, "wrong");
    assert_eq!(finding().at(&Spanned::new((), "scene.toml", at(2))).to_string(), "scene.toml:2: functions: wrong");
    assert_eq!(finding().at(&Spanned::from(())).to_string(), "robot.urdf: functions: wrong");
}

#[test]
fn errors_are_sorted_by_file_and_line_and_those_of_a_line_stay() {
    let mut log = Diagnostics::new("a.toml");
    for (file, line, field) in [("b.toml", 1, "b"), ("a.toml", 9, "x"), ("a.toml", 2, "y"), ("a.toml", 9, "c")] {
        log.push(Diagnostic::error(file, (at(line), field), Code::Number, "1", "2"));
    }
    let sorted = log.result(()).unwrap_err();
    assert_eq!(sorted.errors.iter().map(|e| e.field.as_str()).collect::<Vec<_>>(), vec!["y", "x", "c", "b"]);
}

#[test]
fn findings_are_bounded_and_the_rest_is_counted() {
    let mut log = Diagnostics::new("a.toml");
    for k in 0..1500 {
        log.error((at(k), "x"), Code::Number, "1", "2");
        log.warning((at(k), "x"), Code::Number, "1", "2");
    }
    assert_eq!((log.count(), log.is_ok()), (1500, false));
    let all = log.finished();
    for list in [&all.errors, &all.warnings] {
        assert_eq!((list.len(), list[1000].message().as_str()), (1001, "found 500 more that are not listed"));
    }
}

#[test]
fn errors_of_a_part_may_be_warnings_of_the_whole() {
    let mut log = Diagnostics::new("a.urdf");
    let mut part = log.apart();
    part.error((at(4), "radius"), Code::Negative, "-1", "at least 0");
    log.take_as_warnings(part, "; the shape makes no contact");
    assert!(log.is_ok());
    assert_eq!(log.warnings[0].severity, Severity::Warning);
    assert_eq!(log.warnings[0].to_string(), "a.urdf:4: radius: found -1, expected at least 0; the shape makes no contact");
}

#[test]
fn the_nearest_name_is_the_hint_for_one_that_does_not_exist() {
    let mut log = Diagnostics::new("s.toml");
    log.unknown(((at(1), "lock.elbo"), Code::UnknownName), ("no such joint".into(), "elbo"), "a joint", ["wrist", "elbow"]);
    assert_eq!(log.errors[0].hint.as_deref(), Some("did you mean \"elbow\"?"));
}

#[test]
fn every_code_has_a_name_of_its_own_in_snake_case() {
    let mut names: Vec<&str> = Code::ALL.iter().map(|code| code.name()).collect();
    assert!(names.iter().all(|name| name.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_')));
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), Code::ALL.len());
}
