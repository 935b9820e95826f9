//! Effects at frames that are not links.

use std::borrow::Cow;
use std::collections::HashMap;

use articulated_core::description::{Description, Frame};
use articulated_core::diagnostic::{Code, Diagnostics};
use articulated_core::effect::On;

use super::{EffectRequest, Selector};

/// The requests of a scene. A request at a frame becomes one of the link that carries the frame,
/// with its place relative to the frame. A request that a frame cannot have is an error and left
/// out.
pub(super) fn on_links<'a>(requests: &'a [EffectRequest], robot: &Description, log: &mut Diagnostics) -> Cow<'a, [EffectRequest]> {
    let frames: HashMap<&str, &Frame> = robot.frames.iter().map(|frame| (frame.name.as_str(), frame)).collect();
    let frame_of = |one: &EffectRequest| match &one.on {
        Selector::Named(name) if one.effect.row().on == On::Link => frames.get(name.as_str()).copied(),
        _ => None,
    };
    if !requests.iter().any(|one| frame_of(one).is_some()) {
        return Cow::Borrowed(requests);
    }
    let on_link = |one: &EffectRequest| {
        let Some(frame) = frame_of(one) else { return Some(one.clone()) };
        let link = robot.links.get(frame.link).map(|link| link.name.clone())?;
        let Some(says) = one.says.as_ref().filter(|says| !says.from_collision) else {
            let found = format!("the frame {:?}, which has no geometry and no effects of its own", frame.name);
            log.error((one.place, &one.key), Code::Robot, found, format!("the link {link:?} that carries it"));
            return None;
        };
        let all = requests.iter().find(|other| other.effect == one.effect && other.on == Selector::All);
        let at = says.at.or_else(|| all?.says.as_ref()?.at).unwrap_or_default();
        let mut one = one.clone();
        one.on = Selector::Named(link);
        one.says.iter_mut().for_each(|says| says.at = Some(frame.origin.then(&at)));
        Some(one)
    };
    Cow::Owned(requests.iter().filter_map(on_link).collect())
}
