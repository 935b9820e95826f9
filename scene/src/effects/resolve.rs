//! Effects against a robot: names looked up, `*` spread over joints and links, numbers taken from
//! the robot's file, defaults filled in.

use crate::table::bare;
use articulated_core::diagnostic::{At, Code, Diagnostic, Diagnostics, Subject, Unused};
use std::collections::HashSet;

use articulated_core::description::{Base, ById, Description, Joint, JointId, JointKind, Link, LinkId, Origin};

use super::index::{Index, Named};
use super::still::{moving, still};
use super::{EffectRequest, Numbers, Selector, collision, file, placed, plane};
use crate::report::{EffectOff, EffectOn, Number, Report, Why};
use crate::scene::Scene;
use crate::shaft;
use articulated_core::effect::{Applied, Effect, EffectId, Enters, Field, On, Zeros, effects};
use articulated_core::model::FLOATING_BASE;
use articulated_formats::world::World;

/// A robot after the scene's edits.
#[derive(Clone, Copy, Debug)]
pub struct Edited<'a> {
    /// The robot.
    pub description: &'a Description,
    /// The name of its file, for messages.
    pub file: &'a str,
    /// Its base.
    pub base: Base,
    /// Unused content of the robot's file.
    pub unused: &'a [Unused],
    /// The world of the robot's file, with its planes.
    pub world: &'a World,
    /// The springs and dampings of each of the scene's shafts; `None` for a refused one.
    pub shafts: &'a [Option<Vec<Applied>>],
}

/// Effects with all their numbers.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Resolved {
    /// In the order of the list of effects, then of the robot; independent of the scene's order.
    pub effects: Vec<Applied>,
    /// The place of each effect in the scene.
    pub places: Vec<At>,
    /// By which key.
    pub keys: Vec<String>,
    /// Active, inactive and unused content.
    pub report: Report,
    /// Warnings about them.
    pub warnings: Vec<Diagnostic>,
}

impl Scene {
    /// The effects on `robot`.
    ///
    /// # Errors
    /// Joints and links that do not exist or do not move, and missing numbers; all at once.
    pub fn resolve(&self, robot: &Edited<'_>) -> Result<Resolved, Diagnostics> {
        let mut log = Diagnostics::new(&self.file);
        let resolved = self.resolve_into(robot, &mut log);
        log.result(resolved)
    }

    /// As [`resolve`](Self::resolve), without the invalid effects.
    pub(crate) fn resolve_into(&self, robot: &Edited<'_>, log: &mut Diagnostics) -> Resolved {
        let (still, moving) = (still(robot.description, robot.base), moving(robot.description));
        let index = Index::of(robot, &self.shafts);
        let requests = placed::on_links(&self.effects, robot.description, log);
        let mut at_work = Resolving {
            scene: self,
            requests: &requests,
            robot,
            still,
            moving,
            index,
            resolved: Resolved::default(),
            used: HashSet::new(),
        };
        at_work.resolved.report.joints = at_work.moving_joints().count();
        at_work.resolved.report.links = at_work.still.iter().filter(|still| !**still).count();
        at_work.known_impact(log);
        for row in effects() {
            at_work.effect(row, log);
        }
        at_work.ignored();
        at_work.resolved
    }
}

pub(super) struct Resolving<'a> {
    pub(super) scene: &'a Scene,
    /// Its requests, those at frames on their links.
    requests: &'a [EffectRequest],
    pub(super) robot: &'a Edited<'a>,
    /// Links fixed to the base.
    pub(super) still: ById<LinkId, bool>,
    /// Joints that let their links move.
    moving: ById<JointId, bool>,
    index: Index<'a>,
    pub(super) resolved: Resolved,
    /// (joint or link, tag) of the robot's file that is used.
    used: HashSet<(&'a str, &'static str)>,
}

/// A field's numbers, and the tag of the robot's file that they are from.
pub(super) type Filled = (Vec<f64>, Option<&'static str>);

impl<'a> Resolving<'a> {
    fn effect(&mut self, row: &'static Effect, log: &mut Diagnostics) {
        let asked: Vec<&EffectRequest> = self.requests.iter().filter(|a| a.effect == row.id).collect();
        let (before, errors) = (self.resolved.effects.len(), log.count());
        self.known_names(row, &asked, log);
        match row.on {
            On::Joint => self.on_joints(row, &asked, log),
            On::Link => self.on_links(row, &asked, log),
        }
        self.warn_of_no_numbers(row, &asked);
        if self.resolved.effects.len() == before {
            self.refuse_no_geometry(&asked, errors, log);
            self.resolved.report.off.push(EffectOff { effect: row.name, why: why(&asked) });
        }
    }

    fn moving_joints(&self) -> impl Iterator<Item = &'a Joint> + use<'a> {
        let moving = self.moving.clone();
        self.robot.description.joints.iter().zip(moving).filter(|(_, moving)| *moving).map(|(joint, _)| joint)
    }

    /// Whether all named joints and links exist and move.
    fn known_names(&self, row: &'static Effect, asked: &[&EffectRequest], log: &mut Diagnostics) {
        for one in asked {
            let Selector::Named(name) = &one.on else { continue };
            match row.on {
                On::Joint => self.known_joint(row, one, name, log),
                On::Link => self.known_link(one, name, log),
            }
        }
    }

    fn known_joint(&self, row: &'static Effect, one: &EffectRequest, name: &str, log: &mut Diagnostics) {
        let joints = &self.robot.description.joints;
        let Some(&at) = self.index.joints.get(name) else {
            if name == FLOATING_BASE && self.robot.base == Base::Floating {
                log.error((one.place, &one.key), Code::Robot, "the floating base", "a joint: effects on joints do not act on the base");
                return;
            }
            let place = ((one.place, one.key.as_str()), Code::UnknownName);
            let names = self.moving_joints().map(|j| j.name.as_str());
            log.unknown(place, ("no such joint".into(), name), "a joint of the robot that moves", names);
            return;
        };
        let joint = &joints[at];
        let (found, expected) = match joint.kind {
            _ if one.says.is_none() => return,
            JointKind::Fixed => ("a fixed joint".to_owned(), "a joint that moves"),
            _ if !self.moving[at] => ("a joint that is locked".to_owned(), "a joint that moves"),
            kind if !has_room(row, kind) => {
                (format!("a {} joint, which has no coordinate of its own for each degree of freedom", kind.name()), "another joint")
            }
            kind if one.says.as_ref().is_some_and(|says| !fits(row, says, kind)) => {
                log.error((one.place, &one.key), Code::Robot, unfit(row, one, kind), on_joint(row, kind));
                return;
            }
            _ if row.enters == Enters::Drive && joint.mimic.is_some() => {
                ("a joint that follows another".to_owned(), "the joint that it follows: that is what a motor drives")
            }
            _ => return,
        };
        log.error((one.place, &one.key), Code::Robot, found, expected);
    }

    /// Names of links and frames.
    fn places(&self) -> impl Iterator<Item = &'a str> + use<'a> {
        let Description { links, frames, .. } = self.robot.description;
        links.iter().map(|link| link.name.as_str()).chain(frames.iter().map(|frame| frame.name.as_str()))
    }

    fn known_link(&self, one: &EffectRequest, name: &str, log: &mut Diagnostics) {
        match self.index.links.get(name) {
            None => {
                let place = ((one.place, one.key.as_str()), Code::UnknownName);
                log.unknown(place, ("no such link".into(), name), "a link or frame of the robot", self.places());
            }
            Some(&link) if self.still[link] && one.says.is_some() => {
                log.error((one.place, &one.key), Code::Robot, "a link that is fixed to the base", "a link that moves");
            }
            Some(_) => {}
        }
    }

    fn known_impact(&self, log: &mut Diagnostics) {
        let Some(impact) = &self.scene.impact else { return };
        let frame = || self.robot.description.frames.iter().find(|frame| frame.name == impact.link);
        match self.index.links.get(impact.link.as_str()).copied().or_else(|| frame().map(|frame| frame.link)) {
            None => {
                let place = ((impact.place, "impact.link"), Code::UnknownName);
                let found = ("no such link".into(), impact.link.as_str());
                log.unknown(place, found, "a link or frame of the robot", self.places());
            }
            Some(link) if self.still[link] => {
                log.error((impact.place, "impact.link"), Code::Robot, "a link that is fixed to the base", "a link that moves");
            }
            Some(_) => {}
        }
    }

    fn on_joints(&mut self, row: &'static Effect, asked: &[&'a EffectRequest], log: &mut Diagnostics) {
        let (all, by_name) = (for_all(asked), Named::of(asked));
        for joint in self.moving_joints().filter(|j| has_room(row, j.kind)) {
            if let Some((one, place, key)) = self.of_shaft(row.id, &joint.name) {
                self.put(row, one, (place, key), &vec![None; row.fields.len()]);
            }
            let named = by_name.get(&joint.name).first().copied();
            // A request for all joints applies to those with such numbers.
            let fits = |one: &&EffectRequest| one.says.as_ref().is_none_or(|says| fits(row, says, joint.kind));
            let all = all.filter(fits);
            let spread = all.filter(|_| self.is_spread_over(row.id, joint));
            // Wrong numbers of a named joint are already reported.
            let Some(one) = named.or(spread).filter(fits) else { continue };
            let layers = [named, all].map(|asked| asked.and_then(|a| a.says.as_ref()));
            let Some(layers) = one.says.as_ref().map(|_| layers) else { continue };
            match fill((row, fields_on(row, joint.kind)), &layers, &|tag: &str| file::number(joint, tag)) {
                Ok(mut filled) => {
                    if named.is_some() {
                        self.warn_of_zero(row, one, joint, &filled);
                    }
                    file::before_the_gear(row.id, &mut filled);
                    self.put_filled(row, &joint.name, Origin::default(), one, &filled);
                }
                // A request for all joints skips those without numbers in the file.
                Err(field) if named.is_none() && file::tag(row.id, field).is_some() => {}
                Err(field) => missing(row, field, one, &format!("joint {:?}", joint.name), log),
            }
        }
    }

    fn on_links(&mut self, row: &'static Effect, asked: &[&'a EffectRequest], log: &mut Diagnostics) {
        let (all, by_name) = (for_all(asked), Named::of(asked));
        let description = self.robot.description;
        for (id, link) in description.links.with_ids() {
            if self.still[id] {
                continue;
            }
            let mut ones = by_name.get(&link.name).to_vec();
            let named = !ones.is_empty();
            let heavy = link.inertial.is_some_and(|inertial| inertial.mass > 0.0);
            let is_meant = |one: &EffectRequest| if collision::is_requested(one) { !link.collision.is_empty() } else { heavy };
            // Each entry of a list for all links applies.
            ones.extend(asked.iter().filter(|one| !named && one.on == Selector::All && is_meant(one)));
            for one in ones {
                let Some(says) = &one.says else { continue };
                if says.from_urdf {
                    self.of_file(row, link, one, named, log);
                    continue;
                }
                let rest = all.filter(|_| named).and_then(|a| a.says.as_ref());
                let Some(planes) = plane::of(row, one, says, rest, &self.robot.world.planes, log) else { continue };
                for (own, mask) in &planes {
                    if collision::is_taken(row, says, rest) {
                        self.of_collision(row, link, (one, own), (rest, *mask), log);
                        continue;
                    }
                    let at = says.at.or(rest.and_then(|r| r.at)).unwrap_or_default();
                    match fill((row, row.fields), &[Some(own), rest], &|_| None) {
                        Ok(filled) => self.put_filled(row, &link.name, at, one, &filled),
                        Err(field) => missing(row, field, one, &format!("link {:?}", link.name), log),
                    }
                }
            }
        }
    }

    /// The effects of the file on a link. A link by its name must have one.
    fn of_file(&mut self, row: &'static Effect, link: &'a Link, asked: &EffectRequest, named: bool, log: &mut Diagnostics) {
        let own = self.robot.world.effects.iter().filter(|(own, _)| own.effect == row.id && own.on == link.name);
        let own: Vec<&Applied> = own.map(|(own, _)| own).collect();
        if own.is_empty() && named {
            let found = format!("no {} of link {:?} in {}", row.name, link.name, self.robot.file);
            log.error((asked.place, &asked.key), Code::NoNumbers, found, "a link with such an effect in the robot's file, or numbers here");
        }
        for own in own.into_iter().filter(|own| !row.is_nothing(&own.parameters)) {
            self.put(row, own.clone(), (asked.place, asked.key.clone()), &vec![file::of_link(row.id); row.fields.len()]);
        }
    }

    /// Warns if the numbers of all joints are requested from the robot's file, which has them for
    /// no joint, not even a locked one, or has zeros.
    fn warn_of_no_numbers(&mut self, row: &'static Effect, asked: &[&EffectRequest]) {
        let Some((one, says)) =
            for_all(asked).and_then(|one| Some((one, one.says.as_ref()?))).filter(|(_, says)| says.from_urdf && !says.if_any)
        else {
            return;
        };
        if row.on == On::Link {
            if !self.robot.world.effects.iter().any(|(own, _)| own.effect == row.id) {
                let found = format!("no link of {} has numbers for effects.{}", self.robot.file, row.name);
                self.warn(one, &Subject::Document, Code::NoNumbers, &found, "numbers in the scene: the effect does nothing");
            }
            return;
        }
        let of = |joint: &Joint| fill((row, fields_on(row, joint.kind)), &[Some(says)], &|tag: &str| file::number(joint, tag)).ok();
        let mut all = self.robot.description.joints.iter().filter_map(|joint| Some((joint, of(joint)?)));
        let has_tag = |filled: &[Filled]| filled.iter().any(|(_, tag)| tag.is_some());
        if all.any(|(joint, filled)| has_tag(&filled) && !is_zero_in_file(fields_on(row, joint.kind), &filled)) {
            return;
        }
        let has_zeros = self.robot.description.joints.iter().filter_map(of).any(|filled| has_tag(&filled));
        let other = if has_zeros { " other than 0" } else { "" };
        let tags: Vec<String> = row.fields.iter().filter_map(|field| Some(format!("<{}>", file::tag(row.id, field.name)?))).collect();
        let found = format!("no joint of {} has numbers{other} for effects.{}", self.robot.file, row.name);
        let expected = format!("joints with {}, or numbers in the scene: the effect does nothing", tags.join(" or "));
        self.warn(one, &Subject::Document, Code::NoNumbers, &found, &expected);
    }

    /// Warns if the number of the file for a joint by its name is 0.
    fn warn_of_zero(&mut self, row: &'static Effect, one: &EffectRequest, joint: &Joint, filled: &[Filled]) {
        if is_zero_in_file(fields_on(row, joint.kind), filled) {
            let (found, expected) = ("0 in the robot's file", "another number there or in the scene: the effect does nothing");
            self.warn(one, &Subject::Joint(joint.name.clone()), Code::NoNumbers, found, expected);
        }
    }

    /// Whether a request for all joints includes this one.
    fn is_spread_over(&self, effect: EffectId, joint: &Joint) -> bool {
        let of_shaft = self.index.of_shafts.contains(joint.name.as_str());
        // Drive effects do not apply to a joint that follows another.
        let follows = effect.row().enters == Enters::Drive && joint.mimic.is_some();
        !of_shaft && !follows
    }

    /// The effect of a shaft on one of its joints.
    fn of_shaft(&self, effect: EffectId, joint: &str) -> Option<(Applied, At, String)> {
        let (asked, own) = self.index.by_shafts.get(&(effect, joint))?;
        Some(((*own).clone(), asked.place, format!("effects.{}.{}", shaft::NAME, bare(&asked.shaft.joint))))
    }

    pub(super) fn put_filled(&mut self, row: &'static Effect, on: &'a str, at: Origin, asked: &EffectRequest, filled: &[Filled]) {
        let parameters: Vec<f64> = filled.iter().flat_map(|(numbers, _)| numbers.iter().copied()).collect();
        let tags: Vec<Option<&'static str>> = filled.iter().map(|(_, tag)| *tag).collect();
        self.used.extend(tags.iter().flatten().map(|tag| (on, *tag)));
        if !row.is_nothing(&parameters) {
            self.put(row, Applied { effect: row.id, on: on.to_owned(), at, parameters }, (asked.place, asked.key.clone()), &tags);
        }
    }

    pub(super) fn put(&mut self, row: &'static Effect, one: Applied, (place, key): (At, String), tags: &[Option<&'static str>]) {
        let mut rest = one.parameters.as_slice();
        let mut number = |(field, from): (&Field, &Option<&'static str>)| {
            let (own, others) = rest.split_at(field.len.min(rest.len()));
            rest = others;
            Number { name: field.name, values: own.to_vec(), unit: field.unit, from: *from }
        };
        let mut numbers: Vec<Number> = row.fields_of(one.parameters.len()).iter().zip(tags).map(&mut number).collect();
        if tags.contains(&Some(collision::WORD)) {
            numbers.push(Number { name: "xyz", values: one.at.xyz.to_vec(), unit: "m", from: Some(collision::WORD) });
        }
        self.resolved.report.on.push(EffectOn { effect: row.id, on: one.on.clone(), numbers, place });
        self.resolved.effects.push(one);
        self.resolved.places.push(place);
        self.resolved.keys.push(key);
    }

    /// Unused content of the robot's file: content that the reader could not use, except numbers
    /// that effects use, and bounds without an effect that keeps them.
    fn ignored(&mut self) {
        if self.scene.shafts.is_empty() {
            self.resolved.report.off.push(EffectOff { effect: shaft::NAME, why: Why::NotAsked });
        }
        let used = |joint: &str, tag: &str| self.used.contains(&(joint, tag));
        let is_used = |u: &Unused| matches!(&u.subject, Subject::Joint(name) | Subject::Link(name) if used(name, &u.tag));
        let unused = self.robot.unused.iter().filter(|u| !is_used(u));
        let mut ignored: Vec<Unused> = unused.cloned().collect();
        for joint in self.moving_joints() {
            let bounds = [("limit lower", "limit"), ("limit upper", "limit"), ("limit effort", "motor"), ("limit velocity", "motor")];
            for (tag, effect) in bounds {
                if file::number(joint, tag).is_some() && !used(&joint.name, tag) {
                    let why = format!("kept by nothing: the effect {effect} is off here or has numbers of its own");
                    ignored.push(Unused { line: None, subject: Subject::Joint(joint.name.clone()), tag: tag.to_owned(), why });
                }
            }
        }
        self.resolved.report.ignored = ignored;
    }
}

/// The request for all joints or links.
fn for_all<'a>(asked: &[&'a EffectRequest]) -> Option<&'a EffectRequest> {
    asked.iter().find(|a| a.on == Selector::All).copied()
}

/// Whether the effect is defined for a joint of this kind.
fn has_room(row: &Effect, kind: JointKind) -> bool {
    let is_of_rotation = kind == JointKind::Spherical && row.ball_fields.is_some();
    kind.quaternion().is_none() || row.enters != Enters::ForceOfCoordinate || is_of_rotation
}

/// The fields of an effect on a joint of this kind.
fn fields_on(row: &'static Effect, kind: JointKind) -> &'static [Field] {
    row.ball_fields.filter(|_| kind == JointKind::Spherical).unwrap_or(row.fields)
}

/// The given fields that a joint of this kind does not have, or has with a different length.
fn unfit_fields<'n>(row: &'static Effect, says: &'n Numbers, kind: JointKind) -> impl Iterator<Item = (&'static Field, &'n [f64])> {
    let fields = fields_on(row, kind);
    let given = row.fields.iter().zip(&says.fields).filter_map(|(field, numbers)| Some((field, numbers.as_deref()?)));
    given.filter(move |(field, numbers)| !fields.iter().any(|own| own.name == field.name && own.len == numbers.len()))
}

/// Whether a joint of this kind has the given fields.
fn fits(row: &'static Effect, says: &Numbers, kind: JointKind) -> bool {
    unfit_fields(row, says, kind).next().is_none()
}

/// The given fields that do not fit.
fn unfit(row: &'static Effect, one: &EffectRequest, kind: JointKind) -> String {
    let all = one.says.iter().flat_map(|says| unfit_fields(row, says, kind));
    let each: Vec<String> = all.map(|(field, numbers)| format!("{} with {}", field.name, count(numbers.len()))).collect();
    format!("{} for a {} joint", each.join(", "), kind.name())
}

/// The fields of a joint of this kind.
fn on_joint(row: &'static Effect, kind: JointKind) -> String {
    let each: Vec<String> =
        fields_on(row, kind).iter().map(|field| format!("{} with {} ({})", field.name, count(field.len), field.what)).collect();
    each.join(", ")
}

/// Whether a zero of the file makes the effect vanish.
fn is_zero_in_file(fields: &[Field], filled: &[Filled]) -> bool {
    let is_zero = |(field, (numbers, tag)): (&Field, &Filled)| {
        field.zeros == Zeros::Nothing && tag.is_some() && numbers.iter().all(|number| *number == 0.0)
    };
    fields.iter().zip(filled).any(is_zero)
}

fn count(numbers: usize) -> String {
    if numbers == 1 { "1 number".into() } else { format!("{numbers} numbers") }
}

/// All numbers: from the first layer that gives them or takes them from the file, otherwise the
/// defaults. An error names a field without numbers. `layers`: entries of the joint's name and of
/// all joints. A field without default that files may contain is required in the joint's own entry:
/// that of all joints does not supply it.
pub(super) fn fill(
    (row, fields): (&'static Effect, &'static [Field]),
    layers: &[Option<&Numbers>],
    number: &dyn Fn(&str) -> Option<f64>,
) -> Result<Vec<Filled>, &'static str> {
    let of = |field: &'static Field| {
        let i = row.fields.iter().position(|other| other.name == field.name);
        for (k, layer) in layers.iter().enumerate().filter_map(|(k, layer)| Some((k, (*layer)?))) {
            if let Some(numbers) = i.and_then(|i| layer.fields[i].as_ref()) {
                return Ok((numbers.clone(), None));
            }
            let tag = file::tag(row.id, field.name).filter(|_| layer.from_urdf && field.len == 1);
            if let Some((tag, x)) = tag.and_then(|tag| Some((tag, number(tag)?))) {
                return Ok((vec![x], Some(tag)));
            }
            if k == 0 && tag.is_some() && field.default.is_none() {
                return Err(field.name);
            }
        }
        default_of(row, field, layers.iter().flatten().copied()).map(|x| (x, None)).ok_or(field.name)
    };
    fields.iter().map(of).collect()
}

/// The default of a field that no layer gives; `None`: it is required.
pub(super) fn default_of<'n>(row: &Effect, field: &Field, mut layers: impl Iterator<Item = &'n Numbers>) -> Option<Vec<f64>> {
    if let Some(default) = field.default {
        return Some(default.to_vec());
    }
    let other = row.fields.iter().position(|other| Some(other.name) == field.unless)?;
    layers.any(|numbers| numbers.fields[other].is_some()).then(|| vec![0.0; field.len])
}

pub(super) fn missing(row: &Effect, field: &str, one: &EffectRequest, on: &str, log: &mut Diagnostics) {
    let lacking = row.fields.iter().find(|f| f.name == field);
    let unit = lacking.map_or("", |f| f.unit);
    let or_other = lacking.and_then(|f| f.unless).map(|other| format!(", or {other}")).unwrap_or_default();
    let found = match file::tag(row.id, field).filter(|_| one.says.as_ref().is_some_and(|s| s.from_urdf)) {
        Some(tag) => format!("no {field} for {on}, whose file has no <{tag}>"),
        None => format!("no {field} for {on}"),
    };
    log.error((one.place, &one.key), Code::MissingKey, found, format!("{field}, {unit}{or_other}"));
}

fn why(asked: &[&EffectRequest]) -> Why {
    let on: Vec<&Numbers> = asked.iter().filter_map(|a| a.says.as_ref()).collect();
    let zeros = |n: &&Numbers| n.fields.iter().flatten().any(|x| x.iter().all(|x| *x == 0.0));
    match on.is_empty() {
        _ if asked.is_empty() => Why::NotAsked,
        true => Why::SaidSo,
        false if on.iter().any(|n| n.from_urdf) => Why::NotInUrdf,
        false if on.iter().any(zeros) => Why::SaidSo,
        false => Why::Nowhere,
    }
}
