//! Constants of the model that stay inputs of the generated functions.
//!
//! ```text
//! payload(link)      ten numbers, added to what the link has; nothing at first
//! inertia(link)      ten numbers in the place of the link's own; those of the file at first
//! origin(joint)      three numbers in the place of the joint's origin xyz, m; the file's at first
//! gravity            three numbers in the world frame, m/s²; those of the request at first
//! damping(joint)     the numbers of an effect on a joint, any of those that are on; those of the request at first
//! contact(link)      the same of an effect on a link, which is the only one of its kind there
//! ```
//!
//! The ten are the inertial parameters m, m·c, and I_xx, I_xy, I_xz, I_yy, I_yz, I_zz about the
//! origin of the link's frame, in its axes: all of dynamics is linear in them.

use std::collections::HashMap;

use articulated_core::Scalar;
use articulated_core::algorithm::PARAMETERS;
use articulated_core::description::{Description, JointId, LinkId};
use articulated_core::diagnostic::{Code, Diagnostic, Diagnostics};
use articulated_core::effect::{Applied, Effect, EffectId, On, effect};
use articulated_core::index::{BodyId, FrameId};
use articulated_core::model::{Model, ModelParts};
use articulated_core::spatial::{Placement, SpatialInertia, Vector3};
use articulated_scene::BuiltRobot;

use crate::{Options, Sym, identifier, nearest};

/// Kind of a constant that stays an input.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Payload,
    Inertia,
    Origin,
    Gravity,
    Effect(EffectId),
}

/// Kinds for a link or joint that need no effect.
const KINDS: [(&str, Kind); 3] = [("payload", Kind::Payload), ("inertia", Kind::Inertia), ("origin", Kind::Origin)];

const GRAVITY: &str = "gravity";

const EXPECTED: &str =
    "expected payload(link), inertia(link), origin(joint), gravity, or an effect that is on, as damping(joint) or contact(link)";

/// One parameter of a robot.
#[derive(Clone, Debug)]
pub struct Parameter {
    /// Its description.
    pub what: String,
    /// Its name: that of the link or joint, or its new name, and its kind.
    pub name: String,
    /// First index among all numbers.
    pub at: usize,
    /// The values in the robot's file.
    pub nominal: Vec<f64>,
    kind: Kind,
    /// The body that it changes, and the frame that it is given in, in that body or, for an origin,
    /// in the parent's.
    body: BodyId,
    frame: Placement<f64>,
    /// The joint or link.
    on: String,
}

/// The parameters of the list that can be read, taken out of the robot's description: they will be
/// inputs. A joint or link that is renamed in code is renamed here too.
pub(crate) fn parse(options: &Options, built: &mut BuiltRobot, log: &mut Diagnostics) -> Vec<Parameter> {
    let mut robot = Robot::of(&mut built.reading.description, &built.model);
    let mut parameters: Vec<Parameter> = Vec::new();
    let mut identifiers: HashMap<String, usize> = HashMap::new();
    for text in &options.parameters {
        let mut wrong = |reason: String| {
            let sentence = format!("`{}`: {reason}", text.trim());
            log.push(Diagnostic::refusal("", (Default::default(), "parameters"), Code::Parameter, sentence).at(text));
        };
        let at = parameters.last().map_or(0, |p| p.at + p.nominal.len());
        let mut parameter = match robot.one(text, at) {
            Ok(parameter) => parameter,
            Err(reason) => {
                wrong(reason);
                continue;
            }
        };
        if let Some(reason) = off(text, &built.effects) {
            wrong(reason);
            continue;
        }
        if let Some((from, to)) = options.rename.iter().map(|names| &names.value).find(|(from, _)| *from == parameter.on) {
            parameter.name = format!("{to}{}", &parameter.name[from.len()..]);
        }
        let name = identifier(&parameter.name);
        if let Some(other) = identifiers.get(&name).map(|k| &parameters[*k]) {
            wrong(match other.what == parameter.what {
                true => "is there twice, expected once".into(),
                false => format!(
                    "is {name} in Rust, as the {} is; `--rename` (key `rename`, method `Build::rename`) gives one another name",
                    other.what
                ),
            });
            continue;
        }
        identifiers.insert(name, parameters.len());
        parameters.push(parameter);
    }
    parameters
}

/// Why an entry is not a parameter, if it names an effect that is off.
fn off(text: &str, effects: &[Applied]) -> Option<String> {
    let (kind, name) = parts(text)?;
    let row = effect(kind)?;
    let is_on = |one: &Applied| one.effect == row.id && one.on == name && !row.is_nothing(&one.parameters);
    let on = if row.on == On::Joint { "joint" } else { "link" };
    let reason = || format!("{kind} is off on {on} {name:?}; ask for it among `effects` with numbers that are not all 0");
    (!effects.iter().any(is_on)).then(reason)
}

/// `kind(name)`, or `kind("name")`.
fn parts(text: &str) -> Option<(&str, &str)> {
    let (kind, rest) = text.split_once('(')?;
    let name = rest.trim_end().strip_suffix(')')?.trim();
    Some((kind.trim(), name.strip_prefix('"').and_then(|n| n.strip_suffix('"')).unwrap_or(name)))
}

/// The robot whose constants they are, with its names.
struct Robot<'a> {
    description: &'a mut Description,
    model: &'a Model<f64>,
    links: HashMap<String, LinkId>,
    joints: HashMap<String, JointId>,
    frames: HashMap<String, FrameId>,
    /// The first body of each joint: a planar or universal joint has several.
    bodies: HashMap<String, BodyId>,
}

impl<'a> Robot<'a> {
    fn of(description: &'a mut Description, model: &'a Model<f64>) -> Self {
        let links = indices(description.links.iter().map(|l| &l.name), LinkId);
        let joints = indices(description.joints.iter().map(|j| &j.name), JointId);
        let frames = indices(model.frames().iter().map(|f| &f.name), FrameId);
        let bodies = indices(model.bodies().iter().skip(1).map(|b| &b.name), |k| BodyId(k + 1));
        Self { description, model, links, joints, frames, bodies }
    }

    fn one(&mut self, text: &str, at: usize) -> Result<Parameter, String> {
        if text.trim() == GRAVITY {
            return Ok(self.gravity(at));
        }
        let (kind, name) = parts(text).ok_or_else(|| EXPECTED.to_owned())?;
        match (KINDS.iter().find(|(k, _)| *k == kind), effect(kind)) {
            (Some((_, Kind::Origin)), _) => self.origin(name, at),
            (Some((_, kind)), _) => self.mass(*kind, name, at),
            (None, Some(row)) => self.effect(row, name, at),
            (None, None) => Err(EXPECTED.to_owned()),
        }
    }

    fn gravity(&self, at: usize) -> Parameter {
        let what = "gravity in the world frame, m/s²".to_owned();
        let nominal = self.model.gravity().as_slice().to_vec();
        Parameter {
            what,
            name: GRAVITY.into(),
            at,
            nominal,
            kind: Kind::Gravity,
            body: BodyId::BASE,
            frame: Placement::identity(),
            on: String::new(),
        }
    }

    fn effect(&self, row: &Effect, name: &str, at: usize) -> Result<Parameter, String> {
        let (kind, on, body) = match row.on {
            On::Joint => ("joint", self.on_joint(row, name)?, self.bodies.get(name).copied()),
            On::Link => ("link", self.on_link(row, name)?, self.frames.get(name).map(|k| self.model.frames()[*k].body)),
        };
        // An effect that is off is refused, see `off`.
        let nominal = on.map_or_else(|| vec![0.0; row.len()], <[f64]>::to_vec);
        let fields: Vec<String> = row.fields_of(nominal.len()).iter().map(|field| format!("{} ({})", field.name, field.unit)).collect();
        let what = format!("{} on {kind} {name:?}: {}", row.name, fields.join(", "));
        let (body, frame, on) = (body.unwrap_or_default(), Placement::identity(), name.to_owned());
        Ok(Parameter { what, name: format!("{name}_{}", row.name), at, nominal, kind: Kind::Effect(row.id), body, frame, on })
    }

    /// Its numbers, if it is on.
    fn on_joint(&self, row: &Effect, name: &str) -> Result<Option<&[f64]>, String> {
        let names = || self.model.bodies().iter().skip(1).map(|body| &body.name);
        self.bodies.get(name).ok_or_else(|| format!("there is no joint {name:?} that moves{}", meant(name, names())))?;
        // A joint may have several bodies.
        let mut on = self.model.bodies().iter().filter(|body| body.name == name).flat_map(|body| &body.effects.joint);
        Ok(on.find(|on| on.effect == row.id).map(|on| on.parameters.as_slice()))
    }

    /// Its numbers, if it is on.
    fn on_link(&self, row: &Effect, name: &str) -> Result<Option<&[f64]>, String> {
        let frame = self.frames.get(name).map(|k| &self.model.frames()[*k]).ok_or_else(|| self.no_link(name))?;
        let mut on = self.model.bodies()[frame.body].effects.body.iter().filter(|on| on.effect == row.id && on.link == name);
        match (on.next(), on.count()) {
            (first, 0) => Ok(first.map(|on| on.parameters.as_slice())),
            (_, others) => Err(format!("there are {} on link {name:?}, expected one", others + 1)),
        }
    }

    fn no_link(&self, name: &str) -> String {
        format!("there is no link {name:?}{}", meant(name, self.model.frames().iter().map(|f| &f.name)))
    }

    fn mass(&mut self, kind: Kind, name: &str, at: usize) -> Result<Parameter, String> {
        let Some(&link) = self.links.get(name) else {
            return Err(self.no_link(name));
        };
        let frame = self.frames.get(name).map(|k| &self.model.frames()[*k]).ok_or_else(|| "the link is no frame".to_owned())?;
        if frame.body == BodyId::BASE {
            return Err(format!("link {name:?} is fixed to the base: no function depends on it"));
        }
        // The link itself loses the numbers that become inputs.
        let own = if kind == Kind::Inertia { self.description.links[link].inertial.take() } else { None };
        let nominal = own.map_or([0.0; PARAMETERS], |own| own.spatial_inertia().parameters());
        let what = match kind {
            Kind::Inertia => format!("inertial parameters of link {name:?}"),
            _ => format!("inertial parameters of a payload on link {name:?}"),
        };
        let (on, nominal) = (name.to_owned(), nominal.to_vec());
        let name = format!("{name}_{}", if kind == Kind::Inertia { "inertia" } else { "payload" });
        Ok(Parameter { what, name, at, nominal, kind, body: frame.body, frame: frame.placement, on })
    }

    fn origin(&self, name: &str, at: usize) -> Result<Parameter, String> {
        let Some(joint) = self.joints.get(name).map(|k| &self.description.joints[*k]) else {
            return Err(format!("there is no joint {name:?}{}", meant(name, self.description.joints.iter().map(|j| &j.name))));
        };
        let body = self.bodies.get(name).copied();
        let body = body.ok_or_else(|| format!("joint {name:?} does not move; only the origin of a moving joint can stay an input"))?;
        let parent = &self.description.links[joint.parent].name;
        let frame = self.frames.get(parent).map(|k| &self.model.frames()[*k]).ok_or_else(|| format!("link {parent:?} is no frame"))?;
        let (what, nominal) = (format!("origin of joint {name:?} in its parent link, m"), joint.origin.xyz.to_vec());
        let on = name.to_owned();
        Ok(Parameter { what, name: format!("{name}_origin"), at, nominal, kind: Kind::Origin, body, frame: frame.placement, on })
    }
}

/// Index of each name; the first, where there are several.
fn indices<'a, I>(names: impl Iterator<Item = &'a String>, of: impl Fn(usize) -> I) -> HashMap<String, I> {
    let mut indices = HashMap::new();
    names.enumerate().for_each(|(k, name)| {
        indices.entry(name.clone()).or_insert(of(k));
    });
    indices
}

/// `, did you mean "upper"?`, or an empty text.
fn meant<'a>(name: &str, names: impl Iterator<Item = &'a String>) -> String {
    nearest(name, names.map(String::as_str)).map(|n| format!(", did you mean {n:?}?")).unwrap_or_default()
}

impl Parameter {
    /// Whether its numbers are inertial parameters.
    pub(crate) fn is_inertial(&self) -> bool {
        matches!(self.kind, Kind::Payload | Kind::Inertia)
    }

    /// Puts the numbers that `input` gives into the model.
    pub(crate) fn put(&self, model: &mut ModelParts<Sym>, input: impl Fn(usize) -> Sym) {
        let number = |k: usize| input(self.at + k);
        let frame = cast(&self.frame);
        let vector = || Vector3::new(number(0), number(1), number(2));
        let body = &mut model.bodies[self.body];
        match self.kind {
            Kind::Gravity => model.gravity = vector(),
            Kind::Origin => body.placement.position = frame.transform(vector()),
            Kind::Payload | Kind::Inertia => body.inertia += SpatialInertia::from_parameters(std::array::from_fn(number)).moved(&frame),
            Kind::Effect(id) => {
                let numbers = id.row().with_unit_vectors((0..self.nominal.len()).map(number).collect());
                // A joint may have several bodies.
                let joint = model.bodies.iter_mut().filter(|body| body.name == self.on).flat_map(|body| &mut body.effects.joint);
                joint.filter(|on| on.effect == id).for_each(|on| on.parameters.clone_from(&numbers));
                let link = model.bodies[self.body].effects.body.iter_mut();
                link.filter(|on| on.effect == id && on.link == self.on).for_each(|on| on.parameters.clone_from(&numbers));
            }
        }
    }
}

fn cast(x: &Placement<f64>) -> Placement<Sym> {
    Placement { rotation: x.rotation.map(Sym::from_f64), position: x.position.map(Sym::from_f64) }
}

#[cfg(test)]
mod tests;
