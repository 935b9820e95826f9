//! What is odd about edits, and what is no more so because of them.

use std::collections::HashSet;

use articulated_core::Plain;
use articulated_core::description::PrincipalMoments;
use articulated_core::effect::{Applied, EffectId};
use articulated_urdf::{Kind, Problem, Reading, Subject, Unused};

use super::edit::Editing;
use crate::effects::still;

impl Editing<'_> {
    /// What is odd about the edits, or no more so because of them.
    pub(super) fn warn(&mut self) {
        self.let_go();
        self.warn_of_limits();
        self.warn_of_loads();
        self.warn_of_moments();
        self.leave_what_is_used();
    }

    /// Mass behind a shaft moves, and so does what the shaft has taken for its own.
    fn let_go(&mut self) {
        if self.asked.options.shafts.is_empty() {
            return;
        }
        let description = &self.reading.description;
        let still = still(description, self.asked.options.base);
        let held = description.links.iter().zip(still).filter(|(link, still)| *still && link.inertial.is_some());
        let held: HashSet<String> = held.map(|(link, _)| link.name.clone()).collect();
        self.reading.release(|link| !held.contains(link));
    }

    /// A lock beyond the joint's limits is odd, and used.
    fn warn_of_limits(&mut self) {
        let joints = self.asked.options.lock.iter().filter_map(|(name, at)| {
            let joint = self.reading.description.joints.iter().find(|j| j.name == *name)?;
            let limit = joint.limit.filter(|_| joint.locked.is_some())?;
            let &[at] = at.as_slice() else { return None };
            (at < limit.lower || limit.upper < at).then(|| Problem {
                file: self.asked.file.to_owned(),
                line: None,
                subject: Subject::Joint(name.clone()),
                kind: Kind::BeyondLimit,
                field: "lock".into(),
                found: format!("{}, beyond its limits", Plain(at)),
                expected: format!("{} to {}; used as asked for", Plain(limit.lower), Plain(limit.upper)),
            })
        });
        self.reading.warnings.extend(joints.collect::<Vec<_>>());
    }

    /// A load on what the base holds is odd, and of no account.
    fn warn_of_loads(&mut self) {
        let (options, description) = (&self.asked.options, &self.reading.description);
        let still = still(description, options.base);
        let held = |link: &str| description.links.iter().zip(&still).any(|(l, still)| l.name == link && *still);
        let loads = options.payloads.iter().filter(|load| load.mass != 0.0 && held(&load.link)).map(|load| Problem {
            file: self.asked.file.to_owned(),
            line: None,
            subject: Subject::Link(load.link.clone()),
            kind: Kind::UnusedInertia,
            field: "payload".into(),
            found: format!("{} kg on a link that a fixed base holds", load.mass),
            expected: "a link that moves: here it plays no part in the dynamics".into(),
        });
        self.reading.warnings.extend(loads.collect::<Vec<_>>());
    }

    /// An inertia of a load that no body has is odd, and used, as that of a link is.
    fn warn_of_moments(&mut self) {
        let odd = self.asked.options.payloads.iter().filter_map(|load| {
            let moments = PrincipalMoments::of(load.inertia);
            moments.miss_triangle().then(|| Problem {
                file: self.asked.file.to_owned(),
                line: None,
                subject: Subject::Link(load.link.clone()),
                kind: Kind::InertiaTriangle,
                field: "payload".into(),
                found: moments.to_string(),
                expected: format!("{}; used as asked for", PrincipalMoments::TRIANGLE),
            })
        });
        self.reading.warnings.extend(odd);
    }

    /// Numbers of the URDF that an effect has taken are used.
    fn leave_what_is_used(&mut self) {
        let Reading { description, unused, .. } = &mut self.reading;
        let used = |u: &Unused| {
            let Subject::Joint(name) = &u.subject else { return false };
            let dynamics = description.joints.iter().find(|j| j.name == *name).and_then(|j| j.dynamics.as_ref());
            // The first number of each.
            let taken = dynamics.and_then(|d| match u.tag.as_str() {
                "dynamics damping" => Some((EffectId::damping, d.damping)),
                "dynamics friction" => Some((EffectId::friction, d.friction)),
                _ => None,
            });
            let is = |e: &Applied| taken.is_some_and(|(id, x)| e.effect == id && e.on == *name && e.parameters.first() == Some(&x));
            self.asked.options.effects.iter().any(is)
        };
        unused.retain(|u| !used(u));
    }
}
