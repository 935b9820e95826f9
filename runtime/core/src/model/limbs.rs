//! Branches that are alike: the legs of a quadruped are one program with four sets of constants.

use alloc::vec;
use alloc::vec::Vec;

use super::Model;
use crate::Scalar;
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
    frames: usize,
}

/// First body of a branch and the kinds of its bodies, if it stands for itself.
type Branch = (usize, Option<Vec<Kind>>);

impl<S: Scalar> Model<S> {
    /// The sets of `width` branches that are alike, from the base outward: the same joints in the same order with as many frames on each body.
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
                frames: self.frames.iter().filter(|f| f.body == i).count(),
            })
        };
        branch.clone().map(kind).collect()
    }
}
