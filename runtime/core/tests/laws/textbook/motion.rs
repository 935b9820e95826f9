//! Placements and their motion.

use articulated_core::algorithm::Argument;
use articulated_core::description::LinkId;
use articulated_reference::Big;
use num_traits::{One, Zero};

use super::{EXACT, NEARLY, REFERENCES, SMALL, STEP, apply, call, dot, for_each_scene, minus, named, plus, same, times};

#[test]
fn twists_are_jacobians_times_rates_and_accelerations_their_rates() {
    for_each_scene(12, SMALL, |_, scene| {
        let ([q, v, a, _], rows) = (scene.motion(), 6 * scene.size[2]);
        for reference in REFERENCES {
            let call = |name: &str, given: &[&[Big]]| scene.call(&named(name, reference), given);
            let (jacobian, rate) = (call("jacobians", &[q]), call("jacobian_rates", &[q, v]));
            let bias = apply(&rate, v, rows);
            same("twists", &call("twists", &[q, v]), &apply(&jacobian, v, rows), EXACT);
            same("bias", &call("bias_accelerations", &[q, v]), &bias, EXACT);
            same("accelerations", &call("accelerations", &[q, v, a]), &plus(&apply(&jacobian, a, rows), &bias), EXACT);
        }
    });
}

#[test]
fn slopes_of_placements_twists_and_jacobians_are_those_of_differences() {
    for_each_scene(8, SMALL, |_, scene| {
        let ([q, v, a, _], [_, nv, frames]) = (scene.motion(), scene.size);
        let placed = scene.slope(v, |q, _| scene.call("placements", &[q]));
        same("placements", &apply(&scene.call("placement_derivatives", &[q]), v, 12 * frames), &placed, NEARLY);
        let twists = scene.call("twists_world_aligned", &[q, v]);
        for frame in 0..frames {
            same("ṗ", &twists[6 * frame + 3..][..3], &placed[12 * frame + 9..][..3], NEARLY);
        }
        for reference in REFERENCES {
            let call = |name: &str, given: &[&[Big]]| scene.call(&named(name, reference), given);
            let found = scene.slope(v, |q, h| call("twists", &[q, &plus(v, &times(h, a))]));
            same("twists", &call("accelerations", &[q, v, a]), &found, NEARLY);
            let found = scene.slope(v, |q, _| call("jacobians", &[q]));
            assert_eq!(found.len(), 6 * frames * nv);
            same("jacobians", &call("jacobian_rates", &[q, v]), &found, NEARLY);
        }
    });
}

#[test]
fn chosen_frames_are_rows_of_all() {
    for_each_scene(10, SMALL, |case, scene| {
        let (links, [q, v, ..]) = (&case.description.links, scene.motion());
        let chosen = [links.len() - 1, 0];
        let names = chosen.map(|l| links[LinkId(l)].name.as_str());
        let book = case.textbook::<Big>().with_frames(&names).unwrap();
        for (name, given) in [("placements", &[q][..]), ("twists_body", &[q, v]), ("jacobians_world", &[q])] {
            let (all, found) = (scene.call(name, given), call(&book, name, given));
            let rows = all.len() / links.len();
            let expected: Vec<Big> = chosen.iter().flat_map(|l| all[l * rows..][..rows].to_vec()).collect();
            same(name, &found, &expected, 0.0);
        }
        assert_eq!(case.textbook::<Big>().with_frames(&["nobody"]).map(|_| ()), Err("nobody".into()));
    });
}

#[test]
fn a_step_and_a_difference_undo_each_other() {
    for_each_scene(25, SMALL, |case, scene| {
        let (book, [q, target, step]) = (&scene.book, [Argument::Q, Argument::Target, Argument::Step].map(|a| scene.given(a)));
        let mut found = book.integrate(q, &book.difference(q, target));
        for joint in case.model.joints().iter().filter(|j| matches!(j.q.1, 4 | 7)) {
            let at = joint.q.0 + joint.q.1 - 4..joint.q.0 + joint.q.1;
            if dot(&found[at.clone()], &target[at.clone()]).to_f64() < 0.0 {
                found[at].iter_mut().for_each(|x| *x = -*x);
            }
        }
        same("q ⊕ (t ⊖ q)", &found, target, EXACT);
        let stepped = book.integrate(q, step);
        same("(q ⊕ s) ⊖ q", &book.difference(q, &stepped), step, EXACT);
        same("q ⊖ q", &book.difference(q, q), &vec![Big::zero(); step.len()], EXACT);
        // Two halves along one line are the whole.
        let half = times(0.5, step);
        let twice = book.integrate(&book.integrate(q, &half), &half);
        same("q ⊕ s/2 ⊕ s/2", &twice, &stepped, EXACT);
    });
}

/// Effect of a small change δ of an argument on a step's end e, as the step δ' with e ⊕ δ' at the
/// new end; and on a difference.
#[test]
fn derivatives_of_steps_and_differences_are_those_of_differences() {
    for_each_scene(25, SMALL, |_, scene| {
        let book = &scene.book;
        let [q, target, step, v] = [Argument::Q, Argument::Target, Argument::Step, Argument::V].map(|a| scene.given(a));
        let end = book.integrate(q, step);
        let moved = |q: &[Big], h: f64| book.integrate(q, &times(h, v));
        let slope = |f: &dyn Fn(f64) -> Vec<Big>| times(0.5 / STEP, &minus(&f(STEP), &f(-STEP)));
        let by_q = slope(&|h| book.difference(&end, &book.integrate(&moved(q, h), step)));
        let by_step = slope(&|h| book.difference(&end, &book.integrate(q, &plus(step, &times(h, v)))));
        let [found_q, found_step] = both(&scene.call("integrate_derivatives", &[step]), v);
        same("∂(q ⊕ s)/∂q", &found_q, &by_q, NEARLY);
        same("∂(q ⊕ s)/∂s", &found_step, &by_step, NEARLY);
        let by_q = slope(&|h| book.difference(&moved(q, h), target));
        let by_target = slope(&|h| book.difference(q, &moved(target, h)));
        let [found_q, found_target] = both(&scene.call("difference_derivatives", &[q, target]), v);
        same("∂(t ⊖ q)/∂q", &found_q, &by_q, NEARLY);
        same("∂(t ⊖ q)/∂t", &found_target, &by_target, NEARLY);
    });
}

/// Two matrices times a direction.
fn both(matrices: &[Big], v: &[Big]) -> [Vec<Big>; 2] {
    let (first, second) = matrices.split_at(v.len() * v.len());
    [first, second].map(|matrix| apply(matrix, v, v.len()))
}

#[test]
fn a_configuration_at_random_is_one() {
    for_each_scene(20, SMALL, |case, scene| {
        let q = scene.book.random_configuration(scene.given(Argument::Uniform));
        for joint in case.model.joints() {
            let own: Vec<f64> = q[joint.q.0..][..joint.q.1].iter().map(|x| x.to_f64()).collect();
            let (lower, upper) = joint.limit.map_or((-std::f64::consts::PI, std::f64::consts::PI), |l| (l.lower, l.upper));
            assert!(own.iter().all(|x| (lower..=upper).contains(x)), "{}: {own:?}", joint.name);
            if matches!(joint.q.1, 4 | 7) {
                let x = &q[joint.q.0 + joint.q.1 - 4..][..4];
                same("norm", &[dot(x, x)], &[Big::one()], EXACT);
            }
        }
    });
}
