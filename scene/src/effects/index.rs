//! Index of a robot and a scene by names.

use std::collections::{HashMap, HashSet};

use articulated_core::description::{Id, JointId, LinkId};
use articulated_core::effect::{Applied, EffectId};

use super::resolve::Edited;
use super::{EffectRequest, Selector};
use crate::shaft::ShaftRequest;

/// Links, joints and shafts by their names.
pub(super) struct Index<'a> {
    pub(super) joints: HashMap<&'a str, JointId>,
    pub(super) links: HashMap<&'a str, LinkId>,
    /// The joints of shafts.
    pub(super) of_shafts: HashSet<&'a str>,
    /// Effects of shafts on their joints.
    pub(super) by_shafts: HashMap<(EffectId, &'a str), (&'a ShaftRequest, &'a Applied)>,
}

impl<'a> Index<'a> {
    pub(super) fn of(robot: &Edited<'a>, shafts: &'a [ShaftRequest]) -> Self {
        let mut by_shafts = HashMap::new();
        for (asked, own) in
            shafts.iter().zip(robot.shafts).flat_map(|(asked, applied)| applied.iter().flatten().map(move |own| (asked, own)))
        {
            by_shafts.entry((own.effect, own.on.as_str())).or_insert((asked, own));
        }
        Self {
            joints: indices(robot.description.joints.iter().map(|j| j.name.as_str())),
            links: indices(robot.description.links.iter().map(|l| l.name.as_str())),
            of_shafts: robot.shafts.iter().flatten().flatten().map(|a| a.on.as_str()).collect(),
            by_shafts,
        }
    }
}

/// Index of each name; the first one of duplicates.
pub(crate) fn indices<'a, I: Id>(names: impl Iterator<Item = &'a str>) -> HashMap<&'a str, I> {
    let mut indices = HashMap::new();
    names.enumerate().for_each(|(k, name)| {
        indices.entry(name).or_insert(I::of(k));
    });
    indices
}

/// Requests for joints or links by name, in the order of the scene.
pub(super) struct Named<'a>(HashMap<&'a str, Vec<&'a EffectRequest>>);

impl<'a> Named<'a> {
    pub(super) fn of(asked: &[&'a EffectRequest]) -> Self {
        let mut by_name: HashMap<&str, Vec<&EffectRequest>> = HashMap::new();
        for &one in asked {
            if let Selector::Named(name) = &one.on {
                by_name.entry(name).or_default().push(one);
            }
        }
        Self(by_name)
    }

    pub(super) fn get(&self, name: &str) -> &[&'a EffectRequest] {
        self.0.get(name).map_or(&[], Vec::as_slice)
    }
}
