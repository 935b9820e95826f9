//! Against another program's answers, which were derived another way: energies, differentiated (see
//! `tests/oracles/README.md`).

use std::collections::BTreeSet;

use articulated_core::description::Base;
use articulated_models::ROBOTS as BUNDLED;
use articulated_tests::case::{Case, State, placements};
use articulated_tests::fixture::{Fixture, Reference, fixture};

use crate::interpreted;
use crate::robots::ROBOTS;

/// Error allowed relative to the fixture's own scale, and, of placements, to a metre. The fixtures
/// are good to the last bit.
const TOLERANCE: f64 = 4e-15;

/// The oracle knows no ball joints: the engines of `tests/fixtures` do, and the top has closed
/// forms.
const WITHOUT: &str = "spinning_top";

fn each(law: impl Fn(&Case, &Fixture)) {
    for robot in BUNDLED.iter().filter(|r| r.name != WITHOUT) {
        let (case, reference) = (Case::bundled(robot), fixture(robot.name));
        law(&case.with_gravity(reference.gravity), &reference);
    }
}

fn state(reference: &Reference) -> State {
    State::new(reference.q.clone(), reference.v.clone(), reference.a.clone())
}

fn torques_hold(name: &str, found: &[f64], reference: &Reference) {
    for (k, (f, e)) in found.iter().zip(&reference.inverse_dynamics).enumerate() {
        let scale = reference.torque_scale[k];
        assert!((f - e).abs() <= TOLERANCE * scale, "{name}, torque {k}: {f} instead of {e}, scale {scale}");
    }
    assert_eq!(found.len(), reference.inverse_dynamics.len());
}

/// The fixture lists links in an order of its own, so they are found by name; the case has all of
/// them as frames, or some.
fn placements_hold(case: &Case, links: &[String], found: &[f64], reference: &Reference) {
    let Some(expected) = &reference.placements else { return };
    assert_eq!((found.len(), links.len()), (12 * case.model.frames().len(), expected.len()));
    for (frame, found) in case.model.frames().iter().zip(found.chunks_exact(12)) {
        let link = links.iter().position(|l| *l == frame.name).unwrap();
        for (f, e) in found.iter().zip(&expected[link]) {
            assert!((f - e).abs() <= TOLERANCE, "{}, {}: {f} instead of {e}", case.name, frame.name);
        }
    }
}

#[test]
fn every_bundled_robot_has_a_reference_of_its_own() {
    each(|case, reference| {
        assert_eq!(reference.robot, case.name);
        assert_eq!(reference.base, if case.base == Base::Fixed { "fixed" } else { "floating" });
        assert_eq!((reference.nq, reference.nv), (case.model.nq(), case.model.nv()));
        let joints: Vec<&String> = case.model.joints().iter().map(|j| &j.name).collect();
        assert_eq!(reference.joints.iter().collect::<Vec<_>>(), joints);
        let links = |of: &mut dyn Iterator<Item = &String>| of.cloned().collect::<BTreeSet<String>>();
        assert_eq!(links(&mut reference.links.iter()), links(&mut case.model.frames().iter().map(|f| &f.name)));
        assert!(reference.states.len() >= 4 && reference.states.iter().any(|s| s.placements.is_some()));
    });
}

#[test]
fn generic_torques_and_placements_are_the_oracles() {
    each(|case, reference| {
        for s in &reference.states {
            torques_hold(&case.name, &case.inverse_dynamics(&state(s)), s);
            placements_hold(case, &reference.links, &placements(&case.model, &s.q), s);
        }
    });
}

#[test]
fn generated_torques_and_placements_are_the_oracles() {
    each(|case, reference| {
        let torques: Vec<Vec<&[f64]>> = reference.states.iter().map(|s| vec![&s.q[..], &s.v, &s.a]).collect();
        let poses: Vec<Vec<&[f64]>> = reference.states.iter().map(|s| vec![&s.q[..]]).collect();
        let generated = ROBOTS.iter().find(|r| r.name == case.name).unwrap();
        let robot = &generated.case;
        let found = interpreted::run(generated, "inverse_dynamics", &torques);
        let found = found.into_iter().zip(interpreted::run(generated, "placements", &poses));
        for (s, (tau, placed)) in reference.states.iter().zip(found) {
            torques_hold(&case.name, &tau, s);
            placements_hold(robot, &reference.links, &placed, s);
        }
        // The robot that was generated is the one of the fixture.
        assert_eq!(reference.gravity, robot.gravity);
    });
}

/// The tests' own form of energy, which other laws lean on, is the oracle's too.
#[test]
fn energies_are_the_oracles() {
    each(|case, reference| {
        // Links that cannot move do not count in the oracle's energies.
        let still = held(case).energy(&reference.states[0]);
        for s in &reference.states {
            let energy = case.motions().energy(&s.q, &s.v, &s.a);
            let size = 1.0 + s.kinetic_energy.abs() + s.potential_energy.abs() + still.abs();
            assert!((energy.kinetic - s.kinetic_energy).abs() <= 1e-13 * size, "{}: T = {}", case.name, energy.kinetic);
            let moving = energy.potential - still;
            assert!((moving - s.potential_energy).abs() <= 1e-13 * size, "{}: U = {moving}", case.name);
        }
    });
}

/// The links that are fixed to a fixed base.
struct Held(Case);

fn held(case: &Case) -> Held {
    let mut case = case.clone();
    for (link, frame) in case.description.links.iter_mut().zip(case.model.frames()) {
        if !frame.body.is_base() {
            link.inertial = None;
        }
    }
    Held(case)
}

impl Held {
    fn energy(&self, at: &Reference) -> f64 {
        self.0.motions().energy(&at.q, &at.v, &at.a).potential
    }
}
