//! The joints of a tree four to a group, for loops that go through all of them four at a time.
//!
//! A chain of joints is a lane of groups that follow one another, so that what a group hands to the next, or takes from it, is a vector. Once the sweeps are over, four groups are turned: then the
//! joints of a chain are side by side, as their columns are in the matrices.

mod pairs;

use articulated_core::joint::Joint;
use articulated_core::model::Model;

pub(crate) use pairs::{Chunk, Pair, Path};

/// Where each joint stands. Bodies count from the base, which is 0; the root is 1.
pub(crate) struct Groups {
    /// Body of each slot; as many as there are in whole groups.
    pub(crate) slots: Vec<Option<usize>>,
    /// Slot of each body; of the base and of the root one behind all others.
    pub(crate) slot: Vec<usize>,
}

/// Joints of a group.
pub(crate) const LANES: usize = 4;

/// Of more groups than this no use is made: the stack holds two kilobytes of each.
const MOST: usize = 64;

/// The root's body.
pub(crate) const ROOT: usize = 1;

impl Groups {
    /// Of a tree that hangs on one floating joint and has revolute and prismatic joints besides, with nothing that acts on it; nothing for any other.
    pub(crate) fn of(model: &Model<f64>) -> Option<Self> {
        let bodies = &model.bodies;
        let root =
            bodies.get(ROOT).is_some_and(|b| b.joint.is_unconstrained() && b.parent == 0 && (b.coordinates.q, b.coordinates.v) == (0, 0));
        let single = |joint: Joint| joint.is_rotation_about_axis() || joint.is_translation_along_axis();
        let fits = root
            && bodies.iter().skip(ROOT + 1).all(|b| single(b.joint) && b.parent >= ROOT)
            && bodies.iter().all(|b| b.coordinates.mimic.is_none() && b.effects.joint.is_empty() && b.effects.body.is_empty());
        fits.then(|| Self::placed(model, chains(model))).filter(|groups| groups.groups() <= MOST)
    }

    /// Each chain, the longest way to a tip first, where it ends early and needs few blocks.
    fn placed(model: &Model<f64>, chains: Vec<Vec<usize>>) -> Self {
        let mut slot = vec![usize::MAX; model.bodies.len()];
        let mut lanes: Vec<[bool; LANES]> = Vec::new();
        let taken = |lanes: &[[bool; LANES]], group: usize, lane: usize| lanes.get(group).is_some_and(|g| g[lane]);
        for chain in chains {
            let parent = model.bodies[chain[0]].parent;
            let first = if parent == ROOT { 0 } else { slot[parent] / LANES + 1 };
            let end = lanes.len().max(first) + LANES;
            let free = (first..=end)
                .flat_map(|group| (0..LANES).map(move |lane| (group, lane)))
                .filter(|&(group, lane)| (group..group + chain.len()).all(|g| !taken(&lanes, g, lane)));
            // A block more costs about as much as a group and a half.
            let price = |&(group, lane): &(usize, usize)| {
                let beside = parent == ROOT || slot[parent] % LANES == lane;
                (10 * (group + chain.len()) + 15 * (group % LANES + chain.len()).div_ceil(LANES) + usize::from(!beside), group, lane)
            };
            let Some((group, lane)) = free.min_by_key(price) else { continue };
            lanes.resize(lanes.len().max(group + chain.len()), [false; LANES]);
            for (k, &body) in chain.iter().enumerate() {
                lanes[group + k][lane] = true;
                slot[body] = (group + k) * LANES + lane;
            }
        }
        let mut slots = vec![None; lanes.len() * LANES];
        slot.iter().enumerate().skip(ROOT + 1).for_each(|(body, &slot)| slots[slot] = Some(body));
        slot[..=ROOT].fill(slots.len().next_multiple_of(LANES * LANES));
        Self { slots, slot }
    }

    /// Number of groups.
    pub(crate) fn groups(&self) -> usize {
        self.slots.len() / LANES
    }

    /// The body of slot `lane` of a group.
    pub(crate) fn body(&self, group: usize, lane: usize) -> Option<usize> {
        self.slots.get(group * LANES + lane).copied().flatten()
    }

    /// The block and the lane in which a body's joint stands once groups are turned.
    pub(crate) fn turned(&self, body: usize) -> (usize, usize) {
        let (group, lane) = (self.slot[body] / LANES, self.slot[body] % LANES);
        (group / LANES * LANES + lane, group % LANES)
    }

    /// The bodies of a block once groups are turned.
    pub(crate) fn block(&self, at: usize) -> [Option<usize>; LANES] {
        std::array::from_fn(|k| self.body(at / LANES * LANES + k, at % LANES))
    }
}

/// Joints that follow one another without a branch, and have columns side by side. Chains on which others hang come before these, and of those the one first from which the way to a tip is longest.
fn chains(model: &Model<f64>) -> Vec<Vec<usize>> {
    let bodies = &model.bodies;
    let mut height = vec![1; bodies.len()];
    for i in (ROOT + 1..bodies.len()).rev() {
        height[bodies[i].parent] = height[bodies[i].parent].max(height[i] + 1);
    }
    let children = |i: usize| bodies.iter().filter(|b| b.parent == i).count();
    let follows = |i: usize| {
        let parent = bodies[i].parent;
        parent != ROOT && children(parent) == 1 && bodies[i].coordinates.v == bodies[parent].coordinates.v + 1
    };
    let mut chains: Vec<Vec<usize>> = Vec::new();
    for (i, body) in bodies.iter().enumerate().skip(ROOT + 1) {
        match chains.iter_mut().find(|chain| follows(i) && chain.last() == Some(&body.parent)) {
            Some(chain) => chain.push(i),
            None => chains.push(vec![i]),
        }
    }
    // Stable, and a parent is always higher than its child.
    chains.sort_by_key(|chain| usize::MAX - height[chain[0]]);
    chains
}

#[cfg(test)]
mod tests {
    use articulated_core::description::Base;
    use articulated_core::effect::{BodyEffect, EffectId, JointEffect};
    use articulated_core::joint::Follow;

    use super::*;
    use crate::Request;

    /// A trunk, and on it joints of which each stands on the link that it names.
    fn tree(joints: &[(&str, &str)], base: Base) -> Model<f64> {
        let link = |name: &str| {
            format!(
                "<link name='{name}'><inertial><mass value='1'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial></link>"
            )
        };
        let mut urdf = format!("<robot name='tree'>{}", link("trunk"));
        for (name, parent) in joints {
            urdf += &format!(
                "<joint name='{name}' type='continuous'><parent link='{parent}'/><child link='{name}'/><axis xyz='0 0 1'/></joint>{}",
                link(name)
            );
        }
        let mut request = Request::new("tree", urdf + "</robot>");
        request.options.robot.base = base;
        crate::model(&request, &crate::read(&request).unwrap().description).unwrap()
    }

    /// Two legs of three, and arms of two on a back of two.
    const WALKER: [(&str, &str); 12] = [
        ("back", "trunk"),
        ("chest", "back"),
        ("left", "chest"),
        ("left_hand", "left"),
        ("right", "chest"),
        ("right_hand", "right"),
        ("hip", "trunk"),
        ("knee", "hip"),
        ("foot", "knee"),
        ("other_hip", "trunk"),
        ("other_knee", "other_hip"),
        ("other_foot", "other_knee"),
    ];

    #[test]
    fn each_joint_has_a_slot_behind_that_of_its_parent() {
        let model = tree(&WALKER, Base::Floating);
        let groups = Groups::of(&model).unwrap();
        assert_eq!(groups.groups(), 4);
        for body in ROOT + 1..model.bodies.len() {
            let (slot, parent) = (groups.slot[body], model.bodies[body].parent);
            assert_eq!(groups.slots[slot], Some(body));
            assert!(parent == ROOT || groups.slot[parent] / LANES < slot / LANES);
            let (block, lane) = groups.turned(body);
            assert_eq!(groups.block(block)[lane], Some(body));
        }
        assert_eq!(groups.slots.iter().flatten().count(), model.bodies.len() - 2);
        // The base and the root stand in a block of their own, however many groups the joints fill.
        for joints in 1..=WALKER.len() {
            let groups = Groups::of(&tree(&WALKER[..joints], Base::Floating)).unwrap();
            let root = groups.slot[ROOT];
            assert!(groups.slot[0] == root && root.is_multiple_of(LANES * LANES) && root >= groups.slots.len(), "{joints}: {root}");
            assert!(root < groups.slots.len() + LANES * LANES);
        }
    }

    #[test]
    fn chunks_and_pairs_are_of_chains() {
        let model = tree(&WALKER, Base::Floating);
        let groups = Groups::of(&model).unwrap();
        for chunk in groups.chunks(&model) {
            let bodies: Vec<(usize, usize)> = chunk.bodies.into_iter().enumerate().filter_map(|(lane, body)| Some((lane, body?))).collect();
            assert!(bodies.windows(2).all(|w| model.bodies[w[1].1].parent == w[0].1 && w[1].0 == w[0].0 + 1));
            assert!(bodies.iter().all(|(lane, body)| model.bodies[*body].coordinates.v == chunk.column + lane));
        }
        let ([before, beyond], paths) = groups.pairs(&model);
        let all = |pairs: &[Pair]| pairs.iter().flat_map(|p| p.which).filter(|w| *w).count();
        // Of a joint with itself and those before it: the back 1 + 2, arms 3 + 4 each, legs 1 + 2 + 3 each.
        assert_eq!([all(&before), all(&beyond)], [29, 17]);
        assert!(before.iter().chain(&beyond).all(|p| p.path <= paths.len()));
        assert!(paths.iter().enumerate().all(|(k, p)| p.before <= k && model.bodies[p.first].parent == p.on));
    }

    #[test]
    fn what_stands_behind_a_chain_by_chance_is_no_part_of_its_chunk() {
        // The longer branch stands behind the back, though the shorter one has the next column.
        let forked = [("back", "trunk"), ("short", "back"), ("long", "back"), ("longer", "long"), ("longest", "longer")];
        // The fifth stands behind the first, and has the next column.
        let legs = ["a", "b", "c", "d", "e"].map(|name| (name, "trunk"));
        let feet = [("foot_a", "a"), ("foot_c", "c"), ("foot_d", "d"), ("foot_e", "e")];
        let five = [legs[0], feet[0], legs[1], legs[2], feet[1], legs[3], feet[2], legs[4], feet[3]];
        // What is left for the third finger is a lane before that of its hand.
        let hand = [("hand", "trunk"), ("thumb", "hand"), ("tip", "thumb"), ("second", "hand"), ("third", "hand")];
        let of = |arm: &'static str, one: &'static str, two: &'static str| [(arm, "trunk"), (one, arm), (two, one)];
        let full = [&of("p", "p1", "p2")[..], &hand, &of("r", "r1", "r2"), &of("s", "s1", "s2")].concat();
        for joints in [&forked[..], &five, &full] {
            let model = tree(joints, Base::Floating);
            let groups = Groups::of(&model).unwrap();
            let chunks = groups.chunks(&model);
            for chunk in &chunks {
                let bodies: Vec<(usize, usize)> =
                    chunk.bodies.iter().enumerate().filter_map(|(lane, body)| Some((lane, (*body)?))).collect();
                assert!(bodies.windows(2).all(|w| model.bodies[w[1].1].parent == w[0].1 && w[1].0 == w[0].0 + 1));
                assert!(bodies.iter().all(|(lane, body)| model.bodies[*body].coordinates.v == chunk.column + lane));
            }
            let all = chunks.iter().flat_map(|chunk| chunk.bodies).flatten().count();
            assert_eq!(all, joints.len());
            // A chunk comes behind the one that it stands on.
            let place = |body: usize| chunks.iter().position(|chunk| chunk.bodies.contains(&Some(body)));
            assert!(chunks.iter().enumerate().all(|(k, chunk)| place(model.bodies[chunk.first()].parent).is_none_or(|on| on < k)));
        }
    }

    #[test]
    fn a_path_leads_from_the_chunk_before_to_that_beyond() {
        let fingers = [("thumb", "left_hand"), ("finger", "left_hand"), ("tip", "finger"), ("nail", "tip"), ("other_nail", "tip")];
        let model = tree(&[&WALKER[..], &fingers].concat(), Base::Floating);
        let groups = Groups::of(&model).unwrap();
        let chunks = groups.chunks(&model);
        let has = |chunk: &Chunk, body: usize| chunk.bodies.contains(&Some(body));
        let of = |body: usize| chunks.iter().find(|chunk| has(chunk, body)).unwrap();
        let ([before, beyond], paths) = groups.pairs(&model);
        assert!(paths.iter().all(|p| p.on > ROOT && of(p.first).first() == p.first));
        for (pair, turned) in before.iter().map(|p| (p, false)).chain(beyond.iter().map(|p| (p, true))) {
            let other = chunks.iter().find(|chunk| (chunk.at, chunk.column) == (pair.at, pair.column)).unwrap();
            let (from, to) = if turned { (of(pair.own), other) } else { (other, of(pair.own)) };
            let (mut at, mut path) = (to, pair.path);
            while let Some(p) = path.checked_sub(1).map(|k| &paths[k]) {
                assert!(has(at, p.first));
                (at, path) = (of(p.on), p.before);
            }
            assert_eq!((at.at, at.column), (from.at, from.column), "joint {}", pair.own);
        }
        assert!([before, beyond].iter().all(|pairs| pairs.iter().any(|p| p.path > 0 && paths[p.path - 1].before > 0)));
    }

    #[test]
    fn joints_on_which_anything_acts_or_that_follow_others_have_no_groups() {
        let has_groups = |change: &dyn Fn(&mut Model<f64>)| {
            let mut model = tree(&WALKER, Base::Floating);
            change(&mut model);
            Groups::of(&model).is_some()
        };
        assert!(has_groups(&|_| ()));
        let (parameters, placement) = (vec![1.0], tree(&WALKER, Base::Floating).frames[0].placement);
        let joint = JointEffect { effect: EffectId::damping, freedom: 0, parameters: parameters.clone() };
        assert!(!has_groups(&|model| model.bodies[3].effects.joint.push(joint.clone())));
        let body = BodyEffect { effect: EffectId::drag, link: String::new(), placement, parameters };
        for k in [ROOT, 3] {
            assert!(!has_groups(&|model| model.bodies[k].effects.body.push(body.clone())));
        }
        assert!(!has_groups(&|model| model.bodies[4].coordinates.mimic = Some(Follow { multiplier: 1.0, offset: 0.0 })));
        assert!(!has_groups(&|model| model.bodies[5].parent = 0));
    }

    #[test]
    fn only_trees_on_one_floating_joint_have_groups() {
        assert!(Groups::of(&tree(&WALKER, Base::Fixed)).is_none());
        let mut model = tree(&WALKER, Base::Floating);
        model.bodies[5].joint = Joint::Helical;
        assert!(Groups::of(&model).is_none());
    }
}
