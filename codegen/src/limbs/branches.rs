//! Isomorphic branches: the legs of a quadruped are one program with four sets of constants.

use articulated_core::effect::{EffectId, JointEffect, Zeros, effects};
use articulated_core::index::{BodyId, ById};
use articulated_core::joint::Joint;
use articulated_core::model::Model;

/// A set of branches of the same structure on the same body.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Limbs {
    /// First body of each branch, in the order of the model.
    pub(crate) roots: Vec<BodyId>,
    /// Number of bodies of each branch: those from its root on.
    pub(crate) bodies: usize,
}

impl Limbs {
    /// Body `k` of each branch.
    pub(crate) fn aligned(&self, k: usize) -> Vec<BodyId> {
        self.roots.iter().map(|root| BodyId(root.0 + k)).collect()
    }
}

/// Properties that isomorphic bodies share; numbers may differ.
#[derive(PartialEq, Eq)]
struct Kind {
    joint: Joint,
    /// Distance of the body from its parent, in bodies.
    behind: usize,
    /// Offsets in q and v from the branch's first body; of a follower, those of its leader.
    at: (usize, usize),
    follows: bool,
    /// Whether it follows by a polynomial.
    is_bent: bool,
    is_link: bool,
    effects: Vec<(EffectId, usize)>,
}

/// First body of a branch and the kinds of its bodies, if it is independent of other branches.
type Branch = (BodyId, Option<Vec<Kind>>);

/// The sets of `width` isomorphic branches, from the base outward: the same joints and effects in
/// the same order, whatever frames they carry. Constants may differ, so that mirrored limbs are
/// isomorphic. More branches than `width` form several sets in order; left-over branches are
/// searched for sets inside.
///
/// No branch is in two sets: fingers of isomorphic arms belong to the arms.
pub(crate) fn isomorphic_branches(model: &Model, width: usize) -> Vec<Limbs> {
    branches(model, width, true)
}

/// The same robot with effects of no strength on joints of a branch whose counterparts in other
/// branches have these effects, as the spring of one knee alone. `None` if there are none.
pub(crate) fn completed(model: &Model, width: usize) -> Option<Model> {
    let mut missing: Vec<(BodyId, JointEffect<f64>)> = Vec::new();
    for limbs in branches(model, width, false) {
        for bodies in (0..limbs.bodies).map(|k| limbs.aligned(k)) {
            let of = |body: BodyId| &model.bodies()[body].effects.joint;
            for own in bodies.iter().flat_map(|&body| of(body)) {
                let is_same = |other: &JointEffect<f64>| (other.effect, other.freedom) == (own.effect, own.freedom);
                let lacks = |body: &BodyId| !of(*body).iter().any(is_same) && !missing.iter().any(|(b, other)| b == body && is_same(other));
                let lacking: Vec<BodyId> = bodies.iter().copied().filter(lacks).collect();
                missing.extend(lacking.into_iter().filter_map(|body| Some((body, without_strength(own)?))));
            }
        }
    }
    let place = |own: &JointEffect<f64>| (effects().iter().position(|row| row.id == own.effect), own.freedom);
    (!missing.is_empty()).then(|| {
        model.clone().changed(|parts| {
            for (body, own) in missing {
                let all = &mut parts.bodies[body].effects.joint;
                all.push(own);
                all.sort_by_key(place);
            }
        })
    })
}

/// The effect with zeros for the numbers without which it vanishes; `None` if there are none.
fn without_strength(own: &JointEffect<f64>) -> Option<JointEffect<f64>> {
    let (mut parameters, mut at, row) = (own.parameters.clone(), 0, own.effect.row());
    for field in row.fields_of(own.parameters.len()) {
        let numbers = parameters.iter_mut().skip(at).take(field.len);
        at += field.len;
        if field.zeros == Zeros::Nothing {
            numbers.for_each(|x| *x = 0.0);
        }
    }
    row.is_nothing(&parameters).then(|| JointEffect { parameters, ..own.clone() })
}

/// As [`isomorphic_branches`]; `with_effects`: effects on joints must be the same.
fn branches(model: &Model, width: usize, with_effects: bool) -> Vec<Limbs> {
    let sizes = branch_sizes(model);
    let mut found = Vec::new();
    let mut open = vec![BodyId::BASE];
    let mut children: ById<BodyId, Vec<BodyId>> = vec![Vec::new(); model.bodies().len()].into();
    model.outward().for_each(|i| children[model.bodies()[i].parent].push(i));
    while let Some(body) = open.pop() {
        let mut branches: Vec<Branch> = children[body].iter().map(|&i| (i, None)).collect();
        if branches.len() >= width {
            branches.iter_mut().for_each(|(i, kinds)| *kinds = branch_kinds(model, *i, sizes[*i], with_effects));
        }
        while let Some((first, kinds)) = branches.first() {
            let alike = |(_, others): &&Branch| kinds.is_some() && others == kinds;
            let roots: Vec<BodyId> = branches.iter().filter(alike).take(width).map(|(i, _)| *i).collect();
            if roots.len() == width {
                branches.retain(|(i, _)| !roots.contains(i));
                found.push(Limbs { bodies: sizes[roots[0]], roots });
            } else {
                open.push(*first);
                branches.remove(0);
            }
        }
    }
    found.sort_by_key(|limbs| limbs.roots.first().copied());
    found
}

/// Number of bodies from each body outward, itself included.
fn branch_sizes(model: &Model) -> ById<BodyId, usize> {
    let mut sizes: ById<BodyId, usize> = vec![1; model.bodies().len()].into();
    for i in model.inward() {
        sizes[model.bodies()[i].parent] += sizes[i];
    }
    sizes
}

/// The kinds of the bodies of a branch; `None` if one follows a joint outside of it, or is followed
/// from there.
fn branch_kinds(model: &Model, root: BodyId, size: usize, with_effects: bool) -> Option<Vec<Kind>> {
    let places = root.0..root.0 + size;
    let branch = places.clone().map(BodyId);
    let (first, last) = (&model.bodies()[root].coordinates, &model.bodies()[BodyId(root.0 + size - 1)]);
    let inside = |i: BodyId| places.contains(&i.0);
    let own_v = |i: BodyId| model.bodies()[i].coordinates.v;
    let shared = model.outward().any(|i| !inside(i) && branch.clone().any(|k| own_v(k) == own_v(i)));
    if shared || last.coordinates.v < first.v {
        return None;
    }
    let kind = |i: BodyId| {
        let body = &model.bodies()[i];
        let at = (body.coordinates.q.checked_sub(first.q)?, body.coordinates.v.checked_sub(first.v)?);
        Some(Kind {
            joint: body.joint,
            behind: if i == root { 0 } else { i.0 - body.parent.0 },
            at,
            follows: body.coordinates.mimic.is_some(),
            is_bent: body.coordinates.is_bent(),
            is_link: body.link.is_some(),
            effects: if with_effects { body.effects.kinds() } else { body.effects.body.iter().map(|own| (own.effect, 0)).collect() },
        })
    };
    branch.clone().map(kind).collect()
}

#[cfg(test)]
mod tests {
    use articulated_core::description::{Base, Description, JointId, JointKind, Link, LinkId, Mimic};
    use articulated_core::effect::JointEffect;
    use articulated_core::model::ModelParts;

    use super::*;

    /// A tree of revolute joints, given the parent of each body; some follow others.
    fn tree(parents: &[usize], follows: &[(usize, usize)]) -> ModelParts {
        let link = |k: usize| Link { name: format!("{k}"), ..Link::default() };
        let joint = |(k, &parent): (usize, &usize)| {
            let leader = follows.iter().find(|(follower, _)| *follower == k + 1);
            let mimic = leader.map(|(_, leader)| Mimic::linear(JointId(leader - 1), 2.0, 0.5));
            let (name, kind, axis) = (format!("{}", k + 1), JointKind::Continuous, [0.0, 0.0, 1.0]);
            articulated_core::description::Joint {
                name,
                kind,
                parent: LinkId(parent),
                child: LinkId(k + 1),
                axis,
                mimic,
                ..Default::default()
            }
        };
        let links = (0..=parents.len()).map(link).collect();
        let joints = parents.iter().enumerate().map(joint).collect();
        let robot = Description { links, joints, ..Description::default() };
        Model::new(&robot, Base::Fixed).unwrap().into_parts()
    }

    fn roots(parts: ModelParts, width: usize) -> Vec<(Vec<usize>, usize)> {
        let model = Model::from_parts(parts).unwrap();
        isomorphic_branches(&model, width).into_iter().map(|l| (l.roots.iter().map(|root| root.0).collect(), l.bodies)).collect()
    }

    /// A trunk with two legs of two joints.
    const LEGS: [usize; 5] = [0, 1, 2, 1, 4];

    #[test]
    fn branches_of_the_same_structure_are_alike_whatever_their_numbers() {
        // A trunk with two legs of two and two arms of one.
        let mut parts = tree(&[0, 1, 2, 1, 4, 1, 1], &[]);
        parts.bodies.iter_mut().enumerate().for_each(|(i, body)| body.placement.position.x = i as f64);
        assert_eq!(roots(parts.clone(), 2), [(vec![2, 4], 2), (vec![6, 7], 1)]);
        assert_eq!(roots(parts, 4), []);
    }

    #[test]
    fn another_joint_or_a_follower_from_outside_makes_a_branch_stand_alone() {
        assert_eq!(roots(tree(&LEGS, &[]), 2), [(vec![2, 4], 2)]);
        let mut parts = tree(&LEGS, &[]);
        parts.bodies[BodyId(5)].joint = Joint::Prismatic;
        assert_eq!(roots(parts, 2), []);
        assert_eq!(roots(tree(&LEGS, &[(5, 3)]), 2), []);
    }

    /// The leader may be in the trunk or in another branch.
    #[test]
    fn a_branch_that_is_followed_from_outside_stands_alone() {
        assert_eq!(roots(tree(&LEGS, &[(1, 3)]), 2), []);
        assert_eq!(roots(tree(&[0, 1, 2, 1, 4, 1], &[]), 2), [(vec![2, 4], 2)]);
        assert_eq!(roots(tree(&[0, 1, 2, 1, 4, 1], &[(3, 4), (5, 6)]), 2), []);
    }

    #[test]
    fn another_effect_or_a_follower_within_makes_a_branch_stand_alone() {
        let damped = |bodies: &[usize]| {
            let mut parts = tree(&LEGS, &[]);
            for &i in bodies {
                parts.bodies[BodyId(i)].effects.joint =
                    vec![JointEffect { effect: EffectId::damping, freedom: 0, parameters: vec![i as f64] }];
            }
            roots(parts, 2)
        };
        assert_eq!((damped(&[3]), damped(&[3, 5])), (vec![], vec![(vec![2, 4], 2)]));
        let followed = |follows: &[(usize, usize)]| roots(tree(&LEGS, follows), 2);
        assert_eq!((followed(&[(3, 2)]), followed(&[(3, 2), (5, 4)])), (vec![], vec![(vec![2, 4], 2)]));
    }

    #[test]
    fn a_spring_of_one_limb_alone_has_no_strength_in_the_others() {
        let mut parts = tree(&LEGS, &[]);
        let [damping, spring] = [(EffectId::damping, vec![0.3]), (EffectId::spring, vec![2.0, 0.1])]
            .map(|(effect, parameters)| JointEffect { effect, freedom: 0, parameters });
        parts.bodies[BodyId(3)].effects.joint = vec![damping.clone(), spring.clone()];
        parts.bodies[BodyId(5)].effects.joint = vec![damping];
        let model = Model::from_parts(parts).unwrap();
        assert_eq!(isomorphic_branches(&model, 2), []);
        let whole = completed(&model, 2).unwrap();
        assert_eq!(isomorphic_branches(&whole, 2).len(), 1);
        let kinds = |k: usize| whole.bodies()[BodyId(k)].effects.kinds();
        assert_eq!(kinds(3), kinds(5));
        let added = whole.bodies()[BodyId(5)].effects.joint.iter().find(|own| own.effect == EffectId::spring).unwrap();
        assert_eq!(added.parameters, [0.0, 0.1]);
        assert!(completed(&whole, 2).is_none());
    }

    #[test]
    fn what_is_left_over_is_looked_through() {
        // Three legs of one, and an arm with two fingers.
        assert_eq!(roots(tree(&[0, 1, 1, 1, 1, 5, 5], &[]), 2), [(vec![2, 3], 1), (vec![6, 7], 1)]);
    }
}
