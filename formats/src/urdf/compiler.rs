//! `<mujoco><compiler …/></mujoco>`: MuJoCo changes masses and inertias while it reads a URDF. Here
//! they are used as the file states them.

use articulated_core::description::PrincipalMoments;
use articulated_core::diagnostic::{Code, Diagnostics};

use super::ast::DraftLink;
use crate::xml::element::Tag;
use crate::xml::number::silently;

/// Warns of settings that change an inertia of this file in MuJoCo.
pub(crate) fn warn(robot: &Tag<'_>, links: &[DraftLink], log: &mut Diagnostics) {
    let sections = robot.children().filter(|tag| tag.is("mujoco"));
    for compiler in sections.flat_map(|tag| tag.children().collect::<Vec<_>>()).filter(|tag| tag.is("compiler")) {
        for (name, change) in SETTINGS {
            if let Some((value, _)) = compiler.attribute(name)
                && change(value, silently(&compiler, name), links)
            {
                let field = format!("<compiler {name}={value:?}>");
                let expected = "the masses and inertias that the file states: they are used as written";
                log.warning(
                    compiler.place(&field),
                    Code::LostDynamics,
                    "a setting with which MuJoCo changes inertias of this robot",
                    expected,
                );
            }
        }
    }
}

/// Whether a setting of this value, a number or not, changes the inertia of a link.
type Change = fn(&str, Option<[f64; 1]>, &[DraftLink]) -> bool;

const SETTINGS: [(&str, Change); 5] = [
    ("inertiafromgeom", |value, _, _| value.trim() == "true"),
    ("balanceinertia", |value, _, links| value.trim() == "true" && moments(links).any(|moments| moments.miss_triangle())),
    ("boundmass", |_, least, links| least.is_some_and(|[least]| masses(links).any(|mass| mass < least))),
    ("boundinertia", |_, least, links| least.is_some_and(|[least]| moments(links).any(|moments| moments.least() < least))),
    ("settotalmass", |_, total, links| {
        let sum: f64 = masses(links).sum();
        total.is_some_and(|[total]| total > 0.0 && (total - sum).abs() > 1e-9 * sum)
    }),
];

fn masses(links: &[DraftLink]) -> impl Iterator<Item = f64> {
    links.iter().filter_map(|link| Some(link.inertial?.mass))
}

fn moments(links: &[DraftLink]) -> impl Iterator<Item = PrincipalMoments> {
    links.iter().filter_map(|link| Some(PrincipalMoments::of(link.inertial?.inertia)))
}
