//! Joints that follow others: q_full = G·q + c, so v_full = G·v and τ = Gᵀ·τ_full.

use articulated_core::description::{Base, Coupling, Description, JointId, Origin};
use articulated_core::effect::{Applied, EffectId};
use articulated_core::model::JointInfo;
use articulated_test_support::case::{Case, State, inverse_dynamics, placements, read};
use articulated_test_support::measure::{distance, scale, torque_scale};
use articulated_test_support::random_tree::Flavour;

use crate::effects::{assert_near, by_duals, call};
use crate::trees::{for_each_tree, share};

/// Errors allowed, in units of u times the magnitude of the terms.
const FEW: f64 = 16.0;

/// The joint at the end of the chain, with multiplier and offset of the whole.
fn leader(tree: &Description, joint: usize) -> (usize, f64, f64) {
    match &tree.joints[JointId(joint)].mimic {
        None => (joint, 1.0, 0.0),
        Some(m) => {
            let (end, multiplier, offset) = leader(tree, m.joint.0);
            (end, m.multiplier * multiplier, m.multiplier * offset + m.offset)
        }
    }
}

/// For each joint of the free tree: its joint in the reduced one, multiplier and offset.
fn rows(reduced: &Case, free: &Case) -> Vec<(JointInfo, JointInfo, f64, f64)> {
    let find = |case: &Case, name: &str| case.model.joints().iter().find(|j| j.name == name).unwrap().clone();
    let row = |joint: &JointInfo| {
        let Some(index) = reduced.description.joint(&joint.name) else {
            return (joint.clone(), find(reduced, &joint.name), 1.0, 0.0);
        };
        let (end, multiplier, offset) = leader(&reduced.description, index.0);
        (joint.clone(), find(reduced, &reduced.description.joints[JointId(end)].name), multiplier, offset)
    };
    free.model.joints().iter().map(row).collect()
}

#[test]
fn torque_on_a_leader_is_that_of_equal_power() {
    let mut met = std::cell::Cell::new(0);
    // Who follows a locked joint would be free without.
    for_each_tree(150, Flavour { locked: false, ..Flavour::ANY }, |case, random| {
        let mut tree = case.description.clone();
        tree.joints.iter_mut().for_each(|j| j.mimic = None);
        met.set(met.get() + u64::from(tree != case.description));
        let free = Case::new("", tree, case.base);
        let rows = rows(case, &free);
        let state = case.state(random);
        let (mut q, mut v, mut a) = (vec![], vec![], vec![]);
        for (own, lead, m, c) in &rows {
            q.extend((0..own.q.1).map(|k| m * state.q[lead.q.0 + k] + c));
            v.extend((0..own.v.1).map(|k| m * state.v[lead.v.0 + k]));
            a.extend((0..own.v.1).map(|k| m * state.a[lead.v.0 + k]));
        }
        // τ = Gᵀ τ_full
        let full = inverse_dynamics(&free.model, &q, &v, &a);
        let mut expected = vec![0.0; case.model.nv()];
        for (own, lead, m, _) in &rows {
            (0..own.v.1).for_each(|k| expected[lead.v.0 + k] += m * full[own.v.0 + k]);
        }
        let far = distance(&case.inverse_dynamics(&state), &expected, &torque_scale(case, &state));
        assert!(far <= FEW, "torques: {far} units of roundoff");
        let far = distance(&placements(&case.model, &state.q), &placements(&free.model, &q), &scale(case, "placements", &state));
        assert!(far <= FEW, "placements: {far} units of roundoff");
    });
    assert!(*met.get_mut() > share(50), "only {} trees with followers", met.get());
}

/// Two joints of one axis that follow in opposite directions do not turn the tip.
#[test]
fn a_follower_that_turns_back_keeps_the_tip_level() {
    let robot = articulated_models::robot("double_pendulum").unwrap();
    let urdf = robot
        .urdf
        .replace("<child link=\"lower_rod\"/>", "<child link=\"lower_rod\"/><mimic joint=\"shoulder\" multiplier=\"-1\" offset=\"0\"/>");
    let case = Case::new("parallel", articulated_test_support::case::read(&urdf), robot.base);
    assert_eq!(case.model.nv(), 1);
    let state = State::new(vec![0.7], vec![1.1], vec![-0.4]);
    // The lower rod swings on a circle without turning: τ = (I1 + m1 l1²/4 + m2 l1²) a + (m1 l1/2 +
    // m2 l1) g sin q
    let expected = (0.083_433_333_333_3 + 0.25 + 0.5) * -0.4 + 9.81 * (0.5 + 0.5) * 0.7_f64.sin();
    assert!((case.inverse_dynamics(&state)[0] - expected).abs() < 1e-14);
    let placed = placements(&case.model, &state.q);
    assert!((placed[24] - 1.0).abs() < 1e-15 && placed[26].abs() < 1e-15);
}

/// A tree, and the same where its last joint of one coordinate follows three others.
struct Coupled<'a> {
    free: &'a Case,
    reduced: Case,
    follower: String,
    terms: Vec<(JointInfo, f64)>,
}

/// The offset of the follower.
const OFFSET: f64 = 0.3;

fn info(case: &Case, name: &str) -> JointInfo {
    case.model.joints().iter().find(|j| j.name == name).unwrap().clone()
}

impl<'a> Coupled<'a> {
    fn of(free: &'a Case) -> Option<Self> {
        let joints = &free.description.joints;
        let single: Vec<usize> = (0..joints.len()).filter(|&j| joints[JointId(j)].kind.sizes() == (1, 1)).collect();
        let [.., a, b, c, follower] = single[..] else { return None };
        let (terms, follower) = ([(a, 0.5), (b, -1.25), (c, 2.0)], joints[JointId(follower)].name.clone());
        let mut tree = free.description.clone();
        let leaders = terms.iter().map(|(j, coefficient)| (joints[JointId(*j)].name.clone(), *coefficient)).collect();
        tree.couple(&Coupling { joint: follower.clone(), leaders, offset: OFFSET, ..Coupling::default() }).unwrap();
        let reduced = Case::new("", tree, free.base);
        assert_eq!(reduced.model.nv() + 1, free.model.nv());
        let terms = terms.map(|(j, coefficient)| (info(&reduced, &joints[JointId(j)].name), coefficient)).to_vec();
        Some(Self { free, reduced, follower, terms })
    }

    /// Numbers of all joints of the free tree, of which the follower has Σ cᵢ xᵢ + `offset`.
    fn spread(&self, x: &[f64], of: fn(&JointInfo) -> (usize, usize), offset: f64) -> Vec<f64> {
        let mut all = Vec::new();
        for own in self.free.model.joints() {
            if own.name == self.follower {
                all.push(self.terms.iter().map(|(leader, coefficient)| coefficient * x[of(leader).0]).sum::<f64>() + offset);
            } else {
                let (first, count) = of(&info(&self.reduced, &own.name));
                all.extend(&x[first..first + count]);
            }
        }
        all
    }

    fn state(&self, state: &State) -> [Vec<f64>; 3] {
        [self.spread(&state.q, |j| j.q, OFFSET), self.spread(&state.v, |j| j.v, 0.0), self.spread(&state.a, |j| j.v, 0.0)]
    }

    /// Gᵀ τ: the torques of equal power.
    fn gathered(&self, full: &[f64]) -> Vec<f64> {
        let mut torques = vec![0.0; self.reduced.model.nv()];
        for own in self.free.model.joints() {
            if own.name == self.follower {
                self.terms.iter().for_each(|(leader, coefficient)| torques[leader.v.0] += coefficient * full[own.v.0]);
            } else {
                let at = info(&self.reduced, &own.name);
                (0..own.v.1).for_each(|k| torques[at.v.0 + k] += full[own.v.0 + k]);
            }
        }
        torques
    }
}

/// q = Σ cᵢ qᵢ + o: each leader has its part of the torque, and no other motion changes.
#[test]
fn torque_on_each_of_several_leaders_is_that_of_equal_power() {
    let mut met = std::cell::Cell::new(0);
    for_each_tree(60, Flavour { mimic: false, locked: false, ..Flavour::ANY }, |free, random| {
        let Some(coupled) = Coupled::of(free) else { return };
        met.set(met.get() + 1);
        let reduced = &coupled.reduced;
        let state = reduced.state(random);
        let [q, v, a] = coupled.state(&state);
        let expected = coupled.gathered(&inverse_dynamics(&free.model, &q, &v, &a));
        let far = distance(&reduced.inverse_dynamics(&state), &expected, &torque_scale(reduced, &state));
        assert!(far <= FEW, "torques: {far} units of roundoff");
        let far = distance(&placements(&reduced.model, &state.q), &placements(&free.model, &q), &scale(reduced, "placements", &state));
        assert!(far <= FEW, "placements: {far} units of roundoff");
        crate::reference::textbook_holds(reduced, random);
    });
    assert!(*met.get_mut() > share(15), "only {} trees", met.get());
}

/// Dampers, friction, springs and stops on the follower are those on its own coordinate, Σ cᵢ qᵢ +
/// o.
#[test]
fn effects_on_a_joint_that_follows_several_act_on_each_leader() {
    let mut met = std::cell::Cell::new(0);
    for_each_tree(60, Flavour { mimic: false, locked: false, ..Flavour::REGULAR }, |free, random| {
        let Some(coupled) = Coupled::of(free) else { return };
        met.set(met.get() + 1);
        let on = |effect, parameters: &[f64]| Applied {
            effect,
            on: coupled.follower.clone(),
            at: Origin::default(),
            parameters: parameters.to_vec(),
        };
        let effects = [
            on(EffectId::damping, &[0.7]),
            on(EffectId::friction, &[0.4, 0.3]),
            on(EffectId::spring, &[1.9, 0.4]),
            on(EffectId::limit, &[-0.3, 0.2, 3.0, 0.5]),
        ];
        let with = |case: &Case| case.model.clone().with_effects(&effects).unwrap();
        let (full, model) = (with(free), with(&coupled.reduced));
        let state = coupled.reduced.state(random);
        let [q, v, a] = coupled.state(&state);
        let forces = call(&model, "effect_forces", &[&state.q, &state.v]);
        assert_near(&forces, &coupled.gathered(&call(&full, "effect_forces", &[&q, &v])), 1e-13, "forces");
        assert!(forces.iter().filter(|force| **force != 0.0).count() >= 3);
        for (name, arguments) in [("potential_energy", vec![&state.q]), ("dissipation", vec![&state.q, &state.v])] {
            let [given, expected]: [Vec<&[f64]>; 2] =
                [arguments.iter().map(|x| x.as_slice()).collect(), [&q, &v].iter().take(arguments.len()).map(|x| x.as_slice()).collect()];
            assert_near(&call(&model, name, &given), &call(&full, name, &expected), 1e-13, name);
        }
        let given = [state.q.as_slice(), &state.v, &state.a];
        let torques = call(&model, "inverse_dynamics", &given);
        assert_near(&torques, &coupled.gathered(&call(&full, "inverse_dynamics", &[&q, &v, &a])), 1e-12, "torques");
        let found = call(&model, "inverse_dynamics_derivatives", &given);
        assert_near(&found, &by_duals(&model, "inverse_dynamics", given), 1e-11, "derivatives of torques");
        let found = call(&model, "forward_dynamics", &[given[0], given[1], &torques]);
        assert_near(&found, &state.a, 1e-8, "accelerations");
        let given = [given[0], given[1], torques.as_slice()];
        let found = call(&model, "forward_dynamics_derivatives", &given);
        assert_near(&found, &by_duals(&model, "forward_dynamics", given), 1e-7, "derivatives of accelerations");
        // Between its leaders a rotor would be an inertia, and a motor drives what others follow.
        for effect in [on(EffectId::armature, &[0.1, 2.0]), on(EffectId::motor, &[1.0, 1.0, 1.0, 0.8, 0.1])] {
            let message = coupled.reduced.model.clone().with_effects(&[effect]).unwrap_err().to_string();
            assert!(message.contains("follows"), "{message}");
        }
    });
    assert!(*met.get_mut() > share(10), "only {} trees", met.get());
}

/// A differential drive, by hand: M = 1e-4 + 0.05²·0.01 on the diagonal, −0.05²·0.01 beside it.
#[test]
fn the_mass_matrix_of_a_differential_drive_couples_its_motors() {
    let mut tree = read(DIFFERENTIAL);
    let check = |tree: &Description| {
        let case = Case::new("differential", tree.clone(), Base::Fixed);
        let mass = case.call::<f64>("mass_matrix", &[&[0.4, -0.2]]);
        for (found, expected) in mass.iter().zip([1.25e-4, -2.5e-5, -2.5e-5, 1.25e-4]) {
            assert!((found - expected).abs() < 1e-18, "{mass:?}");
        }
    };
    check(&tree);
    // The same by an edit.
    let pitch = tree.joint("pitch").unwrap();
    (tree.joints[pitch].mimic, tree.joints[pitch].also) = (None, Vec::new());
    let leaders = vec![("m1".to_owned(), 0.05), ("m2".to_owned(), -0.05)];
    let coupling = Coupling { joint: "pitch".into(), leaders, ..Coupling::default() };
    tree.couple(&coupling).unwrap();
    check(&tree);
    let told = tree.lock("pitch", &[0.0]).unwrap_err().to_string();
    assert_eq!(told, "joint \"pitch\" follows \"m1\", \"m2\": lock them");
    // A locked leader is a constant, of which a spring on the follower feels its part.
    tree.lock("m2", &[0.5]).unwrap();
    let case = Case::new("differential", tree.clone(), Base::Fixed);
    let placed = placements(&case.model, &[1.0]);
    let angle: f64 = 0.05 * 1.0 - 0.05 * 0.5;
    assert!(placed.iter().any(|x| (x - angle.sin()).abs() < 1e-15), "{placed:?}");
    let spring = Applied { effect: EffectId::spring, on: "pitch".into(), at: Origin::default(), parameters: vec![8.0, 0.0] };
    let force = call(&case.model.with_effects(&[spring]).unwrap(), "effect_forces", &[&[1.0], &[0.0]]);
    assert!((force[0] + 0.05 * 8.0 * angle).abs() < 1e-16, "{force:?}");
    for (change, what) in [
        (Coupling { joint: "pich".into(), ..coupling.clone() }, "pitch"),
        (coupling.clone(), "follows another already"),
        (Coupling { joint: "m1".into(), leaders: vec![("m1".into(), 1.0)], ..Coupling::default() }, "expected another joint"),
        (Coupling { joint: "m1".into(), leaders: vec![("pitch".into(), 1.0)], ..Coupling::default() }, "which does not follow several"),
        (Coupling { joint: "m1".into(), leaders: vec![("m2".into(), f64::NAN)], ..Coupling::default() }, "expected a finite number"),
        (Coupling { joint: "m1".into(), leaders: vec![], ..Coupling::default() }, "follows this joint"),
    ] {
        let told = tree.couple(&change).unwrap_err().to_string();
        assert!(told.contains(what), "{told}");
    }
}

const DIFFERENTIAL: &str = "<robot name='differential'><link name='base'/>
    <joint name='m1' type='continuous'><parent link='base'/><child link='r1'/><axis xyz='0 0 1'/></joint>
    <link name='r1'><inertial><mass value='0.1'/><inertia ixx='1e-4' ixy='0' ixz='0' iyy='1e-4' iyz='0' izz='1e-4'/></inertial></link>
    <joint name='m2' type='continuous'><parent link='base'/><child link='r2'/><axis xyz='0 0 1'/></joint>
    <link name='r2'><inertial><mass value='0.1'/><inertia ixx='1e-4' ixy='0' ixz='0' iyy='1e-4' iyz='0' izz='1e-4'/></inertial></link>
    <joint name='pitch' type='continuous'><parent link='base'/><child link='p'/><axis xyz='0 1 0'/>
      <mimic joint='m1' multiplier='0.05'/><mimic joint='m2' multiplier='-0.05'/></joint>
    <link name='p'><inertial><mass value='1'/><inertia ixx='0.01' ixy='0' ixz='0' iyy='0.01' iyz='0' izz='0.01'/></inertial></link></robot>";
