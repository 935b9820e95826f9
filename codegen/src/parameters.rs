//! Constants of the model that stay inputs of the generated functions.
//!
//! ```text
//! payload(link)      ten numbers, added to what the link has; nothing at first
//! inertia(link)      ten numbers in the place of the link's own; the URDF's at first
//! origin(joint)      three numbers in the place of the joint's origin xyz, m; the URDF's at first
//! gravity            three numbers in the world frame, m/s²; those of the request at first
//! damping(joint)     the numbers of an effect on a joint, any of those that are on; those of the request at first
//! ```
//!
//! The ten are the inertial parameters m, m·c, and I_xx, I_xy, I_xz, I_yy, I_yz, I_zz about the origin of the link's frame, in its axes: all of dynamics is linear
//! in them.

use std::collections::HashMap;

use articulated_core::Scalar;
use articulated_core::algorithm::PARAMETERS;
use articulated_core::description::Description;
use articulated_core::effect::{Applied, Effect, EffectId, On, effects};
use articulated_core::model::Model;
use articulated_core::spatial::{Placement, SpatialInertia, Vector3};

use crate::{Error, Options, Sym, identifier, nearest};

/// What stays an input.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Payload,
    Inertia,
    Origin,
    Gravity,
    Effect(EffectId),
}

/// Those of a link or joint that need no effect.
const KINDS: [(&str, Kind); 3] = [("payload", Kind::Payload), ("inertia", Kind::Inertia), ("origin", Kind::Origin)];

const GRAVITY: &str = "gravity";

const EXPECTED: &str = "expected payload(link), inertia(link), origin(joint), gravity, or an effect on a joint, as damping(joint)";

/// One parameter of a robot.
#[derive(Clone, Debug)]
pub struct Parameter {
    /// What it is, in words.
    pub what: String,
    /// Its name: of the link or joint, and its kind.
    pub name: String,
    /// First index among all numbers.
    pub at: usize,
    /// What the URDF says.
    pub nominal: Vec<f64>,
    kind: Kind,
    /// The body that it changes, and the frame that it is given in, in that body or, for an origin, in the parent's.
    body: usize,
    frame: Placement<f64>,
}

/// Reads the list, and takes out of the description what will be an input.
pub(crate) fn parse(list: &[String], description: &mut Description, model: &Model<f64>) -> Result<Vec<Parameter>, Error> {
    let mut robot = Robot::of(description, model);
    let mut parameters: Vec<Parameter> = Vec::new();
    let mut identifiers: HashMap<String, usize> = HashMap::new();
    for text in list {
        let wrong = |reason: String| Error::Parameter { found: text.trim().into(), reason };
        let at = parameters.last().map_or(0, |p| p.at + p.nominal.len());
        let parameter = robot.one(text, at).map_err(wrong)?;
        let name = identifier(&parameter.name);
        if let Some(other) = identifiers.get(&name).map(|k| &parameters[*k]) {
            return Err(wrong(match other.what == parameter.what {
                true => "is there twice, expected once".into(),
                false => format!("is {name} in Rust, as the {} is", other.what),
            }));
        }
        identifiers.insert(name, parameters.len());
        parameters.push(parameter);
    }
    Ok(parameters)
}

/// What is wrong with the entries that are numbers of effects, all of which are known: those that are off.
pub(crate) fn of_effects_that_are_off(options: &Options) -> Vec<Error> {
    let off = |text: &String| {
        let (kind, name) = parts(text)?;
        let row = of_joints(kind)?;
        let is_on = |one: &Applied| one.effect == row.id && one.on == name && !row.is_nothing(&one.parameters);
        let reason = format!("{kind} is off on joint {name:?}; ask for it among `effects` with numbers that are not all 0");
        (!options.robot.effects.iter().any(is_on)).then(|| Error::Parameter { found: text.trim().into(), reason })
    };
    options.parameters.iter().filter_map(off).collect()
}

/// `kind(name)`, or `kind("name")`.
fn parts(text: &str) -> Option<(&str, &str)> {
    let (kind, rest) = text.split_once('(')?;
    let name = rest.trim_end().strip_suffix(')')?.trim();
    Some((kind.trim(), name.strip_prefix('"').and_then(|n| n.strip_suffix('"')).unwrap_or(name)))
}

/// The effect on joints of this name.
fn of_joints(name: &str) -> Option<&'static Effect> {
    effects().iter().find(|row| row.name == name && row.on == On::Joint)
}

/// The robot whose constants they are, with its names.
struct Robot<'a> {
    description: &'a mut Description,
    model: &'a Model<f64>,
    links: HashMap<String, usize>,
    joints: HashMap<String, usize>,
    frames: HashMap<String, usize>,
    /// The first body of each joint: a planar or universal joint has several.
    bodies: HashMap<String, usize>,
}

impl<'a> Robot<'a> {
    fn of(description: &'a mut Description, model: &'a Model<f64>) -> Self {
        let links = indices(description.links.iter().map(|l| &l.name));
        let joints = indices(description.joints.iter().map(|j| &j.name));
        let frames = indices(model.frames.iter().map(|f| &f.name));
        let mut bodies = indices(model.bodies.iter().skip(1).map(|b| &b.name));
        bodies.values_mut().for_each(|k| *k += 1);
        Self { description, model, links, joints, frames, bodies }
    }

    fn one(&mut self, text: &str, at: usize) -> Result<Parameter, String> {
        if text.trim() == GRAVITY {
            return Ok(self.gravity(at));
        }
        let (kind, name) = parts(text).ok_or_else(|| EXPECTED.to_owned())?;
        match (KINDS.iter().find(|(k, _)| *k == kind), of_joints(kind)) {
            (Some((_, Kind::Origin)), _) => self.origin(name, at),
            (Some((_, kind)), _) => self.mass(*kind, name, at),
            (None, Some(row)) => self.effect(row, name, at),
            (None, None) => Err(EXPECTED.to_owned()),
        }
    }

    fn gravity(&self, at: usize) -> Parameter {
        let what = "gravity in the world frame, m/s²".to_owned();
        let nominal = self.model.gravity.as_slice().to_vec();
        Parameter { what, name: GRAVITY.into(), at, nominal, kind: Kind::Gravity, body: 0, frame: Placement::identity() }
    }

    fn effect(&self, row: &Effect, name: &str, at: usize) -> Result<Parameter, String> {
        let body = self.bodies.get(name).copied();
        let body = body.ok_or_else(|| {
            format!("there is no joint {name:?} that moves{}", meant(name, self.model.bodies.iter().skip(1).map(|body| &body.name)))
        })?;
        let on = self.model.bodies[body].effects.joint.iter().find(|on| on.effect == row.id);
        // Effects may not be known yet, see `of_effects_that_are_off`.
        let nominal = on.map_or_else(|| vec![0.0; row.len()], |on| on.parameters.clone());
        let fields: Vec<String> = row.fields.iter().map(|field| format!("{} ({})", field.name, field.unit)).collect();
        let what = format!("{} on joint {name:?}: {}", row.name, fields.join(", "));
        let name = format!("{name}_{}", row.name);
        Ok(Parameter { what, name, at, nominal, kind: Kind::Effect(row.id), body, frame: Placement::identity() })
    }

    fn mass(&mut self, kind: Kind, name: &str, at: usize) -> Result<Parameter, String> {
        let Some(&link) = self.links.get(name) else {
            return Err(format!("there is no link {name:?}{}", meant(name, self.model.frames.iter().map(|f| &f.name))));
        };
        let frame = self.frames.get(name).map(|k| &self.model.frames[*k]).ok_or_else(|| "the link is no frame".to_owned())?;
        if frame.body == 0 {
            return Err(format!("link {name:?} is fixed to the base: no function depends on it"));
        }
        // The link itself is left without what becomes an input.
        let own = if kind == Kind::Inertia { self.description.links[link].inertial.take() } else { None };
        let nominal = own.map_or([0.0; PARAMETERS], |own| own.spatial_inertia().parameters());
        let what = match kind {
            Kind::Inertia => format!("inertial parameters of link {name:?}"),
            _ => format!("inertial parameters of a payload on link {name:?}"),
        };
        let name = format!("{name}_{}", if kind == Kind::Inertia { "inertia" } else { "payload" });
        Ok(Parameter { what, name, at, nominal: nominal.to_vec(), kind, body: frame.body, frame: frame.placement })
    }

    fn origin(&self, name: &str, at: usize) -> Result<Parameter, String> {
        let Some(joint) = self.joints.get(name).map(|k| &self.description.joints[*k]) else {
            return Err(format!("there is no joint {name:?}{}", meant(name, self.description.joints.iter().map(|j| &j.name))));
        };
        let body = self.bodies.get(name).copied();
        let body = body.ok_or_else(|| format!("joint {name:?} does not move; only the origin of a moving joint can stay an input"))?;
        let parent = &self.description.links[joint.parent].name;
        let frame = self.frames.get(parent).map(|k| &self.model.frames[*k]).ok_or_else(|| format!("link {parent:?} is no frame"))?;
        let (what, nominal) = (format!("origin of joint {name:?} in its parent link, m"), joint.origin.xyz.to_vec());
        Ok(Parameter { what, name: format!("{name}_origin"), at, nominal, kind: Kind::Origin, body, frame: frame.placement })
    }
}

/// Index of each name; the first, where there are several.
fn indices<'a>(names: impl Iterator<Item = &'a String>) -> HashMap<String, usize> {
    let mut indices = HashMap::new();
    names.enumerate().for_each(|(k, name)| {
        indices.entry(name.clone()).or_insert(k);
    });
    indices
}

/// `, did you mean "upper"?`, or nothing.
fn meant<'a>(name: &str, names: impl Iterator<Item = &'a String>) -> String {
    nearest(name, names.map(String::as_str)).map(|n| format!(", did you mean {n:?}?")).unwrap_or_default()
}

impl Parameter {
    /// Whether its numbers are the inertial parameters of something.
    pub(crate) fn is_inertial(&self) -> bool {
        matches!(self.kind, Kind::Payload | Kind::Inertia)
    }

    /// Puts the numbers that `input` gives into the model.
    pub(crate) fn put(&self, model: &mut Model<Sym>, input: impl Fn(usize) -> Sym) {
        let number = |k: usize| input(self.at + k);
        let frame = cast(&self.frame);
        let vector = || Vector3::new(number(0), number(1), number(2));
        let body = &mut model.bodies[self.body];
        match self.kind {
            Kind::Gravity => model.gravity = vector(),
            Kind::Origin => body.placement.position = frame.transform(vector()),
            Kind::Payload | Kind::Inertia => body.inertia += SpatialInertia::from_parameters(std::array::from_fn(number)).moved(&frame),
            Kind::Effect(id) => {
                let joint = body.name.clone();
                let bodies = model.bodies.iter_mut().filter(|body| body.name == joint);
                let on = bodies.flat_map(|body| &mut body.effects.joint).filter(|on| on.effect == id);
                on.for_each(|on| on.parameters = (0..self.nominal.len()).map(number).collect());
            }
        }
    }
}

fn cast(x: &Placement<f64>) -> Placement<Sym> {
    Placement { rotation: x.rotation.map(Sym::from_f64), position: x.position.map(Sym::from_f64) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Request;
    use crate::program::Choice;
    use crate::trace::{trace, ways};
    use crate::wanted::Wanted;

    /// A table that slides and turns in a plane, and on it an arm with a tool; these numbers are the robot's.
    fn robot([origin, mass, com, shoulder]: [&str; 4]) -> Request {
        let inertial = |mass: &str, com: &str| {
            format!(
                "<inertial><origin xyz='{com}' rpy='0.3 0.1 -0.2'/><mass value='{mass}'/>\
                 <inertia ixx='0.3' ixy='0.01' ixz='0.02' iyy='0.4' iyz='-0.01' izz='0.5'/></inertial>"
            )
        };
        let joint = |name: &str, kind: &str, parent: &str, child: &str, xyz: &str| {
            format!(
                "<joint name='{name}' type='{kind}'><parent link='{parent}'/><child link='{child}'/><origin xyz='{xyz}' rpy='0.4 -0.7 1.1'/>\
                 <axis xyz='0 0.6 0.8'/></joint>"
            )
        };
        let links = ["ground", "rail"].map(|name| format!("<link name='{name}'/>")).concat()
            + &["table", "arm"].map(|name| format!("<link name='{name}'>{}</link>", inertial("1.5", "0.1 0 0.2"))).concat()
            + &format!("<link name='tool'>{}</link>", inertial(mass, com));
        let joints = joint("foot", "fixed", "ground", "rail", "0.1 0.2 0.3")
            + &joint("slide", "planar", "rail", "table", origin)
            + &joint("shoulder", "continuous", "table", "arm", shoulder)
            + &joint("grip", "fixed", "arm", "tool", "0.3 0.1 -0.2");
        Request::new("robot.urdf", format!("<robot name='robot'>{links}{joints}</robot>"))
    }

    /// The model, with what stays an input taken out of it.
    fn read(request: &Request, list: &[&str]) -> (Model<f64>, Vec<Parameter>) {
        let mut description = crate::read(request).unwrap().description;
        let whole = crate::model(request, &description).unwrap();
        let list: Vec<String> = list.iter().map(|p| (*p).to_owned()).collect();
        let parameters = parse(&list, &mut description, &whole).unwrap();
        (crate::model(request, &description).unwrap(), parameters)
    }

    #[test]
    fn the_numbers_of_another_robot_make_it_that_robot() {
        const LIST: [&str; 3] = ["origin(slide)", "inertia(tool)", "origin(\"shoulder\")"];
        let here = robot(["0.1 0.5 -0.3", "2", "0.05 0.2 0.1", "0 0 0.4"]);
        let there = robot(["-0.4 0.2 0.7", "3.5", "-0.1 0.3 0.2", "0.6 -0.1 0.2"]);
        let (model, parameters) = read(&here, &LIST);
        let numbers: Vec<f64> = read(&there, &LIST).1.into_iter().flat_map(|p| p.nominal).collect();
        let input = |argument: usize, k: usize| (argument * 5 + k * 3) as f64 * 0.37 % 1.9 - 0.8;
        for name in ["inverse_dynamics", "placements", "potential_energy"] {
            let wanted = Wanted::parse(name).unwrap();
            for passes in [0, usize::MAX] {
                let choice = [Choice::plain(ways(&wanted.parts[0], &model)[0].0, passes)];
                let found = trace(&wanted, &choice, &model, &parameters);
                let expected = trace(&wanted, &choice, &read(&there, &[]).0, &[]);
                let given = |argument: usize, k: usize| if argument == wanted.arguments().len() { numbers[k] } else { input(argument, k) };
                for (found, expected) in found.evaluate(given).into_iter().zip(expected.evaluate(input)) {
                    assert!((found - expected).abs() < 1e-12 * (1.0 + expected.abs()), "{name}: {found} {expected}");
                }
            }
        }
    }

    /// On a joint of several bodies too.
    #[test]
    fn other_gravity_and_other_effects_are_those_of_a_request_that_asks_for_them() {
        let robot = |gravity: [f64; 3], numbers: [f64; 5]| {
            let mut request = robot(["0.1 0.5 -0.3", "2", "0.05 0.2 0.1", "0 0 0.4"]);
            let on = |effect, on: &str, parameters: &[f64]| crate::Applied {
                effect,
                on: on.into(),
                at: crate::Origin::default(),
                parameters: parameters.to_vec(),
            };
            let [damping, loss, speed, inertia, ratio] = numbers;
            request.options.robot.gravity = gravity;
            request.options.robot.effects = vec![
                on(EffectId::damping, "slide", &[damping]),
                on(EffectId::friction, "shoulder", &[loss, speed]),
                on(EffectId::armature, "shoulder", &[inertia, ratio]),
            ];
            request
        };
        let list = ["damping(slide)", "gravity", "friction(shoulder)", "armature(\"shoulder\")"];
        let here = robot([0.0, 0.0, -9.81], [0.5, 0.2, 0.01, 0.03, 10.0]);
        let there = robot([0.3, -1.6, 0.7], [1.5, 0.7, 0.2, 0.02, -30.0]);
        let (model, parameters) = read(&here, &list);
        assert_eq!(parameters[1].nominal, [0.0, 0.0, -9.81]);
        let numbers: Vec<f64> = read(&there, &list).1.into_iter().flat_map(|p| p.nominal).collect();
        let input = |argument: usize, k: usize| (argument * 5 + k * 3) as f64 * 0.37 % 1.9 - 0.8;
        for name in ["inverse_dynamics", "forward_dynamics", "effect_forces", "potential_energy", "inverse_dynamics_derivatives"] {
            let wanted = Wanted::parse(name).unwrap();
            for passes in [0, usize::MAX] {
                let choice = [Choice::plain(ways(&wanted.parts[0], &model)[0].0, passes)];
                let found = trace(&wanted, &choice, &model, &parameters);
                let expected = trace(&wanted, &choice, &read(&there, &[]).0, &[]);
                let given = |argument: usize, k: usize| if argument == wanted.arguments().len() { numbers[k] } else { input(argument, k) };
                for (found, expected) in found.evaluate(given).into_iter().zip(expected.evaluate(input)) {
                    assert!((found - expected).abs() < 1e-11 * (1.0 + expected.abs()), "{name}: {found} {expected}");
                }
            }
        }
    }

    #[test]
    fn a_payload_is_added_to_what_the_link_has() {
        let request = robot(["0.1 0.5 -0.3", "2", "0.05 0.2 0.1", "0 0 0.4"]);
        let own = read(&request, &["inertia(tool)"]).1.remove(0).nominal;
        let wanted = Wanted::parse("inverse_dynamics").unwrap();
        let input = |argument: usize, k: usize| (argument * 5 + k * 3) as f64 * 0.37 % 1.9 - 0.8;
        let values = |list: &[&str], factor: f64| {
            let (model, parameters) = read(&request, list);
            let choice = [Choice::plain(ways(&wanted.parts[0], &model)[0].0, usize::MAX)];
            trace(&wanted, &choice, &model, &parameters)
                .evaluate(|argument, k| if argument == 3 { factor * own[k] } else { input(argument, k) })
        };
        for (twice, with) in values(&["inertia(tool)"], 2.0).into_iter().zip(values(&["payload(tool)"], 1.0)) {
            assert!((twice - with).abs() < 1e-12 * (1.0 + twice.abs()), "{twice} {with}");
        }
        assert_eq!(read(&request, &["payload(tool)"]).1[0].nominal, [0.0; PARAMETERS]);
    }

    #[test]
    fn what_there_is_not_is_told_with_what_was_meant() {
        let request = robot(["0 0 0", "2", "0 0 0", "0 0 0"]);
        let mut description = crate::read(&request).unwrap().description;
        let model = crate::model(&request, &description).unwrap();
        let mut told = |one: &str| parse(&[one.to_owned()], &mut description, &model).map(|_| ()).unwrap_err().to_string();
        for (one, said) in [
            ("payload(tol)", "there is no link \"tol\", did you mean \"tool\"?"),
            ("inertia(slide)", "there is no link \"slide\""),
            ("origin(slid)", "there is no joint \"slid\", did you mean \"slide\"?"),
            ("origin(grip)", "joint \"grip\" does not move; only the origin of a moving joint can stay an input"),
            ("payload(ground)", "link \"ground\" is fixed to the base: no function depends on it"),
            ("inertia(rail)", "link \"rail\" is fixed to the base: no function depends on it"),
            ("mass(tool)", EXPECTED),
            ("payload(tool", EXPECTED),
            ("drag(tool)", EXPECTED),
            ("damping(grip)", "there is no joint \"grip\" that moves"),
        ] {
            assert_eq!(told(one), format!("parameters: `{one}`: {said}"));
        }
        let mut request = request;
        request.options.parameters = ["damping(shoulder)", " friction(shoulder)", "gravity"].map(String::from).to_vec();
        let friction = |loss: f64| Applied {
            effect: EffectId::friction,
            on: "shoulder".into(),
            at: crate::Origin::default(),
            parameters: vec![loss, 0.01],
        };
        request.options.robot.effects = vec![friction(0.0)];
        let off = |kind: &str| {
            format!(
                "parameters: `{kind}(shoulder)`: {kind} is off on joint \"shoulder\"; ask for it among `effects` with numbers that are not all 0"
            )
        };
        let told = |request: &Request| crate::generate(request).unwrap_err().to_string();
        assert_eq!(told(&request), [off("damping"), off("friction")].join("\n"));
        request.options.robot.effects = vec![friction(0.3)];
        assert_eq!(told(&request), off("damping"));
    }

    #[test]
    fn two_that_have_one_name_in_rust_are_refused() {
        let request = robot(["0 0 0", "2", "0 0 0", "0 0 0"]);
        let mut description = crate::read(&request).unwrap().description;
        let model = crate::model(&request, &description).unwrap();
        let list = ["payload(tool)", "payload(\"tool\")"].map(String::from);
        let told = parse(&list, &mut description, &model).map(|_| ()).unwrap_err().to_string();
        assert_eq!(told, "parameters: `payload(\"tool\")`: is there twice, expected once");
        // Constants of Rust have one case.
        let mut request = request;
        request.urdf = String::from_utf8(request.urdf).unwrap().replace("'table'", "'TOOL'").into_bytes();
        let mut description = crate::read(&request).unwrap().description;
        let model = crate::model(&request, &description).unwrap();
        let mut told = |list: [&str; 2]| parse(&list.map(String::from), &mut description, &model).err().map(|error| error.to_string());
        assert!(told(["payload(tool)", "payload(TOOL)"]).is_some_and(|told| told.contains("is TOOL_PAYLOAD in Rust, as the")));
        assert_eq!(told(["payload(tool)", "inertia(TOOL)"]), None);
    }
}
