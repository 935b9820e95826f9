//! Branches that are alike: the legs of a quadruped are one program with four sets of constants.

use alloc::vec;
use alloc::vec::Vec;

use super::Model;
use crate::Scalar;
use crate::effect::EffectId;
use crate::joint::Joint;

/// A set of branches of the same structure on the same body.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Limbs {
    /// First body of each branch, in the order of the model.
    pub roots: Vec<usize>,
    /// Number of bodies of each branch: those from its root on.
    pub bodies: usize,
}

impl Limbs {
    /// Body `k` of each branch.
    pub fn aligned(&self, k: usize) -> Vec<usize> {
        self.roots.iter().map(|root| root + k).collect()
    }
}

/// What makes two bodies alike, numbers apart.
#[derive(PartialEq, Eq)]
struct Kind {
    joint: Joint,
    /// How far the body is behind its parent, in bodies.
    behind: usize,
    /// How far its numbers are behind those of its branch's first body, in q and v; these tell whom it follows, if it follows.
    at: (usize, usize),
    follows: bool,
    is_link: bool,
    effects: Vec<(EffectId, usize)>,
}

/// First body of a branch and the kinds of its bodies, if it is no isomorphic limb.
type Branch = (usize, Option<Vec<Kind>>);

impl<S: Scalar> Model<S> {
    /// The sets of `width` branches that are alike, from the base outward: the same joints and effects in the same order, whatever frames they carry.
    /// Constants may differ, so that mirrored limbs are alike. Where more are alike than `width`, the first go together, then the next; what is left over
    /// stands for itself.
    ///
    /// No branch is in two sets: fingers of arms that are alike belong to the arms.
    pub fn limbs(&self, width: usize) -> Vec<Limbs> {
        let sizes = self.branch_sizes();
        let mut found = Vec::new();
        let mut open = vec![0];
        let mut children = vec![Vec::new(); self.bodies.len()];
        self.outward().for_each(|i| children[self.bodies[i].parent].push(i));
        while let Some(body) = open.pop() {
            let mut branches: Vec<Branch> = children[body].iter().map(|&i| (i, None)).collect();
            if branches.len() >= width {
                branches.iter_mut().for_each(|(i, kinds)| *kinds = self.kinds(*i, sizes[*i]));
            }
            while let Some((first, kinds)) = branches.first() {
                let alike = |(_, others): &&Branch| kinds.is_some() && others == kinds;
                let roots: Vec<usize> = branches.iter().filter(alike).take(width).map(|(i, _)| *i).collect();
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
    fn branch_sizes(&self) -> Vec<usize> {
        let mut sizes = vec![1; self.bodies.len()];
        for i in self.inward() {
            sizes[self.bodies[i].parent] += sizes[i];
        }
        sizes
    }

    /// The kinds of the bodies of a branch; `None` if one follows a joint outside of it, or is followed from there.
    fn kinds(&self, root: usize, size: usize) -> Option<Vec<Kind>> {
        let branch = root..root + size;
        let (first, last) = (&self.bodies[root].coordinates, &self.bodies[root + size - 1]);
        let inside = |i: usize| branch.contains(&i);
        let own_v = |i: usize| self.bodies[i].coordinates.v;
        let shared = self.outward().any(|i| !inside(i) && branch.clone().any(|k| own_v(k) == own_v(i)));
        if shared || last.coordinates.v < first.v {
            return None;
        }
        let kind = |i: usize| {
            let body = &self.bodies[i];
            let at = (body.coordinates.q.checked_sub(first.q)?, body.coordinates.v.checked_sub(first.v)?);
            Some(Kind {
                joint: body.joint,
                behind: if i == root { 0 } else { i - body.parent },
                at,
                follows: body.coordinates.mimic.is_some(),
                is_link: body.link.is_some(),
                effects: body.effects.kinds(),
            })
        };
        branch.clone().map(kind).collect()
    }
}

#[cfg(test)]
mod tests {
    use alloc::format;
    use alloc::string::String;
    use alloc::vec;
    use alloc::vec::Vec;

    use crate::effect::{EffectId, Effects, JointEffect};
    use crate::joint::{Coordinates, Follow, Joint};
    use crate::model::{Body, Model};
    use crate::spatial::{Placement, Reference, SpatialInertia};
    use nalgebra::{Matrix3, Vector3};

    /// A tree of revolute joints: the parent of each body.
    fn tree(parents: &[usize]) -> Model<f64> {
        let body = |i: usize, parent: usize| Body {
            name: format!("{i}"),
            parent,
            placement: Placement { rotation: Matrix3::identity(), position: Vector3::new(i as f64, 0.0, 0.0) },
            joint: Joint::Revolute,
            coordinates: Coordinates { q: i.saturating_sub(1), v: i.saturating_sub(1), mimic: None, pitch: 0.0 },
            inertia: SpatialInertia::zero(),
            link: None,
            effects: Effects::none(),
        };
        let mut bodies = vec![body(0, 0)];
        bodies.extend(parents.iter().enumerate().map(|(k, &parent)| body(k + 1, parent)));
        let n = parents.len();
        Model {
            name: String::new(),
            gravity: Vector3::zeros(),
            wrench_reference: Reference::Body,
            bodies,
            frames: Vec::new(),
            joints: Vec::new(),
            nq: n,
            nv: n,
        }
    }

    fn roots(model: &Model<f64>, width: usize) -> Vec<(Vec<usize>, usize)> {
        model.limbs(width).into_iter().map(|l| (l.roots, l.bodies)).collect()
    }

    #[test]
    fn branches_of_the_same_structure_are_alike_whatever_their_numbers() {
        // A trunk with two legs of two and two arms of one.
        let model = tree(&[0, 1, 2, 1, 4, 1, 1]);
        assert_eq!(roots(&model, 2), [(vec![2, 4], 2), (vec![6, 7], 1)]);
        assert_eq!(roots(&model, 4), []);
    }

    #[test]
    fn another_joint_or_a_follower_from_outside_makes_a_branch_stand_alone() {
        let mut model = tree(&[0, 1, 2, 1, 4]);
        assert_eq!(roots(&model, 2), [(vec![2, 4], 2)]);
        model.bodies[5].joint = Joint::Prismatic;
        assert_eq!(roots(&model, 2), []);
        let mut model = tree(&[0, 1, 2, 1, 4]);
        model.bodies[5].coordinates.v = model.bodies[3].coordinates.v;
        assert_eq!(roots(&model, 2), []);
    }

    /// Whatever the others look like: what is outside may be the trunk, or another branch, to which all follow alike.
    #[test]
    fn a_branch_that_is_followed_from_outside_stands_alone() {
        let mut model = tree(&[0, 1, 2, 1, 4]);
        model.bodies[1].coordinates = model.bodies[3].coordinates;
        assert_eq!(roots(&model, 2), []);
        let mut model = tree(&[0, 1, 2, 1, 4, 1]);
        assert_eq!(roots(&model, 2), [(vec![2, 4], 2)]);
        model.bodies[3].coordinates = model.bodies[4].coordinates;
        model.bodies[5].coordinates = model.bodies[6].coordinates;
        assert_eq!(roots(&model, 2), []);
    }

    #[test]
    fn another_effect_or_a_follower_within_makes_a_branch_stand_alone() {
        let damped = |bodies: &[usize]| {
            let mut model = tree(&[0, 1, 2, 1, 4]);
            for &i in bodies {
                model.bodies[i].effects.joint = vec![JointEffect { effect: EffectId::damping, freedom: 0, parameters: vec![i as f64] }];
            }
            roots(&model, 2)
        };
        assert_eq!((damped(&[3]), damped(&[3, 5])), (vec![], vec![(vec![2, 4], 2)]));
        let followed = |bodies: &[usize]| {
            let mut model = tree(&[0, 1, 2, 1, 4]);
            for i in [3, 5] {
                let mimic = bodies.contains(&i).then_some(Follow { multiplier: 2.0, offset: 0.5 });
                model.bodies[i].coordinates = Coordinates { mimic, ..model.bodies[i - 1].coordinates };
            }
            roots(&model, 2)
        };
        assert_eq!((followed(&[3]), followed(&[3, 5])), (vec![], vec![(vec![2, 4], 2)]));
    }

    #[test]
    fn what_is_left_over_is_looked_through() {
        // Three legs of one, and an arm with two fingers.
        let model = tree(&[0, 1, 1, 1, 1, 5, 5]);
        assert_eq!(roots(&model, 2), [(vec![2, 3], 1), (vec![6, 7], 1)]);
    }
}
