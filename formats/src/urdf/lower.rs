//! From a draft to a [`Description`].

use articulated_core::description::{Description, Joint, JointId, Link, LinkId, Mimic};

use super::ast::{Draft, DraftMimic};
use super::mimic::Leaders;
use super::tree::Tree;

/// The description of the draft; `None` if a part is missing, which is already reported.
pub(crate) fn lower(draft: &Draft, tree: &Tree, leaders: &Leaders) -> Option<Description> {
    let links = draft.links.iter().map(|link| {
        let (name, collision, visual) = (link.name.clone()?, link.collision.clone(), link.visual.clone());
        Some(Link { name, inertial: link.inertial, collision, visual, ..Link::default() })
    });
    let joints = draft.joints.iter().enumerate().map(|(i, joint)| {
        let follow = |mimic: &DraftMimic, leader: usize| {
            Mimic::linear(JointId(leader), mimic.multiplier.unwrap_or(1.0), mimic.offset.unwrap_or(0.0))
        };
        let mimic = joint.mimic.as_ref().zip(leaders.first[i]).map(|(mimic, leader)| follow(mimic, leader));
        let also = joint.also.iter().zip(&leaders.also[i]).map(|(mimic, leader)| Some(follow(mimic, (*leader)?)));
        Some(Joint {
            name: joint.name.clone()?,
            kind: joint.kind?,
            parent: LinkId(tree.parent[i]),
            child: LinkId(tree.child[i]),
            origin: joint.origin,
            axis: joint.axis,
            second_axis: joint.second_axis,
            pitch: joint.pitch,
            locked: None,
            mimic,
            also: also.collect::<Option<_>>()?,
            limit: joint.limit,
            dynamics: joint.dynamics,
        })
    });
    let (links, joints) = (links.collect::<Option<_>>()?, joints.collect::<Option<_>>()?);
    Some(Description { name: draft.name.clone(), links, joints, ..Description::default() })
}
