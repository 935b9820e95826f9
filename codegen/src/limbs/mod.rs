//! Limbs in lanes: isomorphic branches of a robot become one program on vectors, one branch per
//! lane.
//!
//! ```text
//! Model → (alike branches) → Model of symbols, one for each constant that differs → trace → pack → Graph of vectors
//! ```
//!
//! The whole robot is traced, so the algorithms are unaware of lanes. Branches differ only in
//! inputs and constants, which stay symbols while tracing, so each branch has the same trace;
//! [`pack`] merges them.

mod branches;
mod isomorphic;
mod vectorize;

pub(crate) use branches::completed;
pub(crate) use isomorphic::{Constants, IsomorphicLimbs};
pub(crate) use vectorize::pack;

#[cfg(test)]
mod tests {
    use std::fmt::Write;

    use articulated_core::Scalar;
    use articulated_core::actuator::{Activation, ActuatorLaw, Actuators, Filter, Transmission};
    use articulated_core::algorithm::{Argument, Needs, functions};
    use articulated_core::description::Base;
    use articulated_core::index::BodyId;
    use articulated_core::model::Model;
    use articulated_core::step;
    use num_traits::One;

    use super::*;
    use crate::graph::{Counts, Op};
    use crate::pass::run_all_unchecked as passed;
    use crate::program::Strategy;
    use crate::trace::{trace, trace_in_lanes, ways};
    use crate::{FunctionSpec, Request, Sym, sym};

    /// A number that looks random, in (−1, 1).
    fn number(seed: &mut u64) -> f64 {
        *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (*seed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    fn numbers(seed: &mut u64) -> String {
        [number(seed), number(seed), number(seed)].map(|x| x.to_string()).join(" ")
    }

    fn link(urdf: &mut String, name: &str, seed: &mut u64) {
        let com = numbers(seed);
        let _ = writeln!(
            urdf,
            "<link name='{name}'><inertial><origin xyz='{com}'/><mass value='{}'/>\
             <inertia ixx='0.31' ixy='{}' ixz='0.02' iyy='0.42' iyz='-0.01' izz='0.53'/></inertial></link>",
            1.5 + number(seed),
            0.05 * number(seed)
        );
    }

    fn joint(urdf: &mut String, name: &str, kind: &str, parent: &str, seed: &mut u64) {
        let (xyz, rpy, axis) = (numbers(seed), numbers(seed), numbers(seed));
        let _ = writeln!(
            urdf,
            "<joint name='{name}' type='{kind}'><parent link='{parent}'/><child link='{name}'/><origin xyz='{xyz}' rpy='{rpy}'/>\
             <axis xyz='{axis}'/><limit lower='-1' upper='1' effort='1' velocity='1'/></joint>"
        );
        link(urdf, name, seed);
    }

    /// A trunk with this many legs, each with a knee and a slide, one finger, and an arm that is
    /// like no leg.
    fn walker(legs: usize, seed: &mut u64) -> Model<f64> {
        let mut urdf = String::from("<robot name='walker'>\n");
        link(&mut urdf, "trunk", seed);
        for k in 0..legs {
            joint(&mut urdf, &format!("hip_{k}"), "revolute", "trunk", seed);
            joint(&mut urdf, &format!("knee_{k}"), "continuous", &format!("hip_{k}"), seed);
            joint(&mut urdf, &format!("slide_{k}"), "prismatic", &format!("knee_{k}"), seed);
            joint(&mut urdf, &format!("toe_{k}"), "revolute", &format!("hip_{k}"), seed);
        }
        joint(&mut urdf, "arm", "revolute", "trunk", seed);
        joint(&mut urdf, "hand", "revolute", "arm", seed);
        urdf += "</robot>";
        let mut request = Request::new("walker", urdf);
        request.options.robot.base = if legs == 2 { Base::Fixed } else { Base::Floating };
        request.build_robot().unwrap().model
    }

    fn input(argument: usize, k: usize) -> f64 {
        ((argument * 7919 + k * 104_729 + 13) as f64 * 0.754_877_666_246_692_7).fract() - 0.4
    }

    /// Every function that any robot has, in every way: (name, counts of the plain graph, counts in
    /// lanes); values must agree.
    fn all(model: &Model<f64>, width: usize) -> Vec<(&'static str, Counts, Counts)> {
        let alike = IsomorphicLimbs::of(model, width).unwrap();
        let mut counts = Vec::new();
        let all = functions::<Sym>().iter().filter(|f| f.needs != Needs::FreeFrames).map(|f| (f.name, f.name));
        for (name, text) in all.chain([("inverse_dynamics", "quick = inverse_dynamics(q = sin_cos)")]) {
            let spec = FunctionSpec::parse(text).unwrap();
            for (way, _) in ways(&spec.parts[0], model) {
                let strategy = [Strategy::plain(way, usize::MAX)];
                let plain = passed(trace(&spec, &strategy, model, &[]));
                let lanes = passed(trace_in_lanes(&spec, &strategy, model, &alike));
                lanes.verify().unwrap();
                for (k, (a, b)) in plain.evaluate(input).into_iter().zip(lanes.evaluate(input)).enumerate() {
                    // Solves amplify roundings; a wrong lane or sign is off by far more.
                    assert!((a - b).abs() <= 1e-8 * (1.0 + a.abs()), "{name} {}, output {k}: {a} {b}", way.name);
                }
                counts.push((name, plain.counts(), lanes.counts()));
            }
        }
        counts
    }

    #[test]
    fn lanes_compute_what_each_limb_for_itself_does() {
        let mut seed = 7;
        let four = all(&walker(4, &mut seed), 4);
        for (name, plain, lanes) in four.iter().filter(|(name, ..)| matches!(*name, "inverse_dynamics" | "inverse_dynamics_derivatives")) {
            assert!(lanes.instructions() * 2 < plain.instructions(), "{name}: {} {}", lanes.instructions(), plain.instructions());
        }
        all(&walker(5, &mut seed), 2);
    }

    #[test]
    fn where_one_leg_lacks_a_frame_the_others_stand_for_themselves() {
        let model = walker(4, &mut 7);
        let third = branches::isomorphic_branches(&model, 4)[0].roots[2];
        let model = model.changed(|parts| parts.frames = parts.frames.iter().filter(|frame| frame.body != third).cloned().collect());
        let (alike, spec) = (IsomorphicLimbs::of(&model, 4).unwrap(), FunctionSpec::parse("placements").unwrap());
        let strategy = [Strategy::plain(ways(&spec.parts[0], &model)[0].0, usize::MAX)];
        let [plain, lanes] = [trace(&spec, &strategy, &model, &[]), trace_in_lanes(&spec, &strategy, &model, &alike)];
        for (a, b) in plain.evaluate(input).into_iter().zip(lanes.evaluate(input)) {
            assert!((a - b).abs() <= 1e-12 * (1.0 + a.abs()), "{a} {b}");
        }
    }

    /// Actuators on each leg with numbers of its own: a servo on the hip, with bounds and an
    /// activation, a motor on the knee whose torque is bounded, and a damper.
    fn actuated(model: Model<f64>, seed: &mut u64) -> Model<f64> {
        let legs = branches::isomorphic_branches(&model, 4)[0].roots.clone();
        let drive = |body: BodyId, gear: f64| {
            let at = &model.bodies()[body].coordinates;
            vec![Transmission { q: at.q, v: at.v, gear: vec![gear], ..Transmission::default() }]
        };
        let mut all = Actuators::default();
        for &hip in &legs {
            let knee = BodyId(hip.0 + 1);
            all.laws.push(ActuatorLaw {
                drives: drive(hip, 2.0 + number(seed)),
                gain: [10.0 + number(seed), 0.0, 0.0],
                bias: [0.0, -10.0 + number(seed), -1.0 + 0.5 * number(seed)],
                control_range: Some([-0.2 + 0.1 * number(seed), 0.3]),
                force_range: Some([-3.0 + number(seed), 3.0 + number(seed)]),
                activation: Some(Activation { filter: Filter::Euler(0.05 + 0.01 * number(seed)), range: None, is_early: false }),
                ..ActuatorLaw::default()
            });
            all.laws.push(ActuatorLaw { drives: drive(knee, number(seed)), gain: [5.0, 0.0, 0.0], ..ActuatorLaw::default() });
            all.bounds.push((model.bodies()[knee].coordinates.v, [-0.3 + 0.1 * number(seed), 0.3]));
            all.passive.push(ActuatorLaw {
                drives: drive(knee, 1.0),
                bias: [0.0, 0.0, -0.7 + 0.1 * number(seed)],
                ..ActuatorLaw::default()
            });
        }
        model.changed(|parts| parts.actuators = all)
    }

    #[test]
    fn actuators_of_limbs_are_in_lanes() {
        let model = actuated(walker(4, &mut 7), &mut 11);
        // One leg has a motor more: then those on hips are by themselves.
        let first = model.actuators().laws[0].clone();
        let odd = model.clone().changed(|parts| parts.actuators.laws.push(first));
        for (model, has_one_more) in [(&model, false), (&odd, true)] {
            let alike = IsomorphicLimbs::of(model, 4).unwrap();
            let hips: Vec<usize> = (0..4).map(|leg| 2 * leg).collect();
            assert_eq!(alike.lanes(step::CTRL, 2), (!has_one_more).then_some((hips, 1)));
            assert_eq!(alike.lanes(step::ACT, 3), (!has_one_more).then(|| (vec![0, 1, 2, 3], 3)));
            assert_eq!(alike.lanes(step::CTRL, 3), Some((vec![1, 3, 5, 7], 1)));
            for name in ["actuator_torques", "actuated_step_implicit_damping", "actuated_step_implicit_velocity", "actuated_step_rk4"] {
                let spec = FunctionSpec::parse(name).unwrap();
                for (way, _) in ways(&spec.parts[0], model) {
                    let strategy = [Strategy::plain(way, usize::MAX)];
                    let plain = passed(trace(&spec, &strategy, model, &[]));
                    let lanes = passed(trace_in_lanes(&spec, &strategy, model, &alike));
                    lanes.verify().unwrap();
                    let of = |argument, k| if argument == 4 { 2e-3 } else { input(argument, k) };
                    for (k, (a, b)) in plain.evaluate(of).into_iter().zip(lanes.evaluate(of)).enumerate() {
                        assert!((a - b).abs() <= 1e-9 * (1.0 + a.abs()), "{name} {}, output {k}: {a} {b}", way.name);
                    }
                    let [plain, lanes] = [plain, lanes].map(|graph| graph.counts().instructions());
                    assert!(has_one_more || lanes * 2 < plain + 50, "{name} {}: {lanes} {plain}", way.name);
                }
            }
        }
    }

    /// As after a factorisation: the terms of one limb are already added up when they meet those of
    /// the others, each of which is a separate term.
    #[test]
    fn limbs_whose_terms_were_added_before_are_one_sum_over_lanes_with_the_others() {
        let model = walker(4, &mut 7);
        let alike = IsomorphicLimbs::of(&model, 4).unwrap();
        let hips: Vec<usize> = branches::isomorphic_branches(&model, 4)[0].roots.iter().map(|&i| model.bodies()[i].coordinates.q).collect();
        for before in 0..16 {
            let plain = sym::trace(|| {
                let terms = |lane: usize| {
                    let x = Sym::input(0, hips[lane]);
                    [x, -(x * x), x * x * x * Sym::from_f64(0.5)]
                };
                let one_by_one = |sum: Sym, lane: usize| terms(lane).into_iter().fold(sum, |sum, term| sum - term);
                let together = |sum: Sym, lane: usize| sum - (terms(lane)[0] + (terms(lane)[2] + terms(lane)[1]));
                let start = Sym::input(0, 0) * Sym::input(0, 1);
                vec![(0..4).fold(start, |sum, lane| if before >> lane & 1 == 1 { together(sum, lane) } else { one_by_one(sum, lane) })]
            });
            let lanes = pack(&plain, &[Argument::Q], &alike, &Constants::new(1));
            assert!((plain.evaluate(input)[0] - lanes.evaluate(input)[0]).abs() < 1e-15, "{before:b}");
            let counts = lanes.counts();
            assert_eq!((counts.of(Op::ReduceAdd), counts.of(Op::Broadcast)), (1, 0), "{before:b}");
        }
    }

    #[test]
    fn a_sum_over_the_lanes_keeps_the_sign_of_each() {
        let model = walker(4, &mut 7);
        let alike = IsomorphicLimbs::of(&model, 4).unwrap();
        let hips: Vec<usize> = branches::isomorphic_branches(&model, 4)[0].roots.iter().map(|&i| model.bodies()[i].coordinates.q).collect();
        for signs in 0..16 {
            let plain = sym::trace(|| {
                let term = |lane: usize| Sym::input(0, hips[lane]) * if signs >> lane & 1 == 1 { -Sym::one() } else { Sym::one() };
                vec![(1..4).fold(term(0), |sum, lane| sum + term(lane)) + Sym::from_f64(0.25)]
            });
            let lanes = pack(&plain, &[Argument::Q], &alike, &Constants::new(1));
            assert!((plain.evaluate(input)[0] - lanes.evaluate(input)[0]).abs() < 1e-15, "signs {signs:b}");
        }
    }
}
