//! From tags to bodies: frames, copies and attached models are gone, and classes are applied.

use std::collections::BTreeSet;
use std::ops::Range;
use std::rc::Rc;

use articulated_core::description::{JointDynamics, Limit};
use articulated_core::diagnostic::{Code, Diagnostics, Subject, quote};

use super::contact;
use super::documents::Documents;
use super::element::Element;
use super::geometry::{self, Geom};
use super::grammar::subject;
use super::left_out::Gate;
use super::mass::Mass;
use super::settings::{Compiler, Settings};
use super::simulation::{Flags, Rules};
use super::values::Values;
use crate::LeaveOut;
use crate::pose::{IDENTITY, Pose, Vector, about, diagonal, multiply, rotate, unit};

/// Maximum total number of bodies, joints, geoms and sites of a model.
const MOST_ITEMS: usize = 100_000;
/// Maximum total length of all names, bytes, including those of copies and attached models.
const MOST_LETTERS: usize = 32 << 20;
/// Maximum depth of nested tags; tags of attached models count inside the attaching ones.
const MOST_DEPTH: usize = 256;
/// Maximum depth of models attached inside attached models.
const MOST_ATTACHED: usize = 16;

/// A body with its content, in its own frame. The first body of a model is the world.
pub(crate) struct Body<'a> {
    /// With prefixes and suffixes; `None` if it has no name.
    pub(crate) name: Option<String>,
    pub(crate) element: &'a Element,
    pub(crate) settings: Rc<Settings<'a>>,
    /// Index of the parent, which is before it.
    pub(crate) parent: usize,
    /// In the parent's frame, where the joints have not moved it.
    pub(crate) pose: Pose,
    pub(crate) joints: Vec<Joint<'a>>,
    pub(crate) geoms: Vec<Geom<'a>>,
    pub(crate) sites: Vec<Site<'a>>,
    pub(crate) inertial: Option<Explicit<'a>>,
    /// The part of its weight that is compensated (`gravcomp`).
    pub(crate) compensated: f64,
    /// The part of the tree that it is in.
    pub(crate) part: usize,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Free,
    Ball,
    Slide,
    Hinge,
}

pub(crate) struct Joint<'a> {
    pub(crate) name: Option<String>,
    pub(crate) element: &'a Element,
    pub(crate) kind: Kind,
    /// In the body's frame.
    pub(crate) anchor: Vector,
    /// Of length 1, in the body's frame.
    pub(crate) axis: Vector,
    /// The coordinate at which the body has its `pos`, rad or m.
    pub(crate) reference: f64,
    /// Whether its range is a bound.
    pub(crate) is_limited: bool,
    /// Its range, bound or not, rad or m.
    pub(crate) range: [f64; 2],
    pub(crate) limit: Option<Limit>,
    /// Bounds of the sum of all actuators on it, N·m or N.
    pub(crate) force_range: Option<[f64; 2]>,
    pub(crate) dynamics: JointDynamics,
    /// The coordinate at which tendons are measured for `springlength="-1"`, rad or m.
    pub(crate) rest: f64,
    /// `springdamper`: time constant, s, and damping ratio, which define stiffness and damping if
    /// both are above zero.
    pub(crate) spring_damper: [f64; 2],
    /// Stiffness of a free joint, and that per distance and per square of the distance.
    pub(crate) tether: [f64; 3],
    pub(crate) armature: f64,
    /// Its numbers of the law of constraints.
    pub(crate) soft: contact::SoftJoint,
    /// The part of the tree that it is in.
    pub(crate) part: usize,
}

pub(crate) struct Site<'a> {
    pub(crate) element: &'a Element,
    pub(crate) name: Option<String>,
    pub(crate) pose: Pose,
    /// The part of the tree that it is in.
    pub(crate) part: usize,
}

/// The numbers of `<inertial>`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Explicit<'a> {
    pub(crate) element: &'a Element,
    pub(crate) own: Mass,
    /// Whether it has moments of inertia.
    pub(crate) has_inertia: bool,
}

fn explicit<'a>(values: &Values<'a>, compiler: &Compiler, log: &mut Diagnostics) -> Option<Explicit<'a>> {
    for name in ["pos", "mass"].iter().filter(|name| !values.has_numbers(name)) {
        values.error(name, Code::MissingAttribute, "none", format!("the attribute {name} in <inertial>"), log);
    }
    let pose = values.pose(&compiler.angles, log);
    let mass = values.number("mass", log)?;
    // The axes of a diagonal inertia are those of the tag.
    let (inertia, axes) = match values.exactly::<6>("fullinertia", log) {
        Some([xx, yy, zz, xy, xz, yz]) => {
            let turns = ["quat", "axisangle", "xyaxes", "zaxis", "euler", "diaginertia"];
            if let Some(name) = turns.iter().find(|name| values.has_numbers(name)) {
                values.error("fullinertia", Code::Together, format!("both fullinertia and {name}"), "one of them", log);
            }
            ([xx, xy, xz, yy, yz, zz], None)
        }
        None => (diagonal(values.exactly::<3>("diaginertia", log).unwrap_or_default()), Some(IDENTITY)),
    };
    let has_inertia = values.has_numbers("fullinertia") || values.has_numbers("diaginertia");
    Some(Explicit { element: values.element, own: Mass { pose, mass, inertia, axes }, has_inertia })
}

/// The bodies of a model, and their documents.
pub(crate) struct Tree<'a> {
    /// Parents first; the first body is the world.
    pub(crate) bodies: Vec<Body<'a>>,
    /// The main document, then the attached ones, in the order of attachment.
    pub(crate) parts: Vec<Part<'a>>,
}

/// The extent of a part in its document.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Extent {
    /// All of it.
    Whole,
    /// A body or a frame. The rest of the document applies if it refers to nothing outside.
    Attached,
    /// One of several copies. The rest of the document applies if it refers to the copy.
    Copy,
}

/// A document, or a part of one, at one place in the tree.
pub(crate) struct Part<'a> {
    pub(crate) settings: Rc<Settings<'a>>,
    pub(crate) prefix: String,
    pub(crate) suffix: String,
    pub(crate) extent: Extent,
    /// The part that it is in; of the main document itself.
    pub(crate) parent: usize,
    /// Whether it is outside all copies except the first.
    pub(crate) is_first: bool,
    /// Indices of its bodies, and of the parts from it to those that are attached inside.
    pub(crate) bodies: Range<usize>,
    pub(crate) parts: Range<usize>,
}

/// Where a tag is.
#[derive(Clone)]
struct Context<'a> {
    settings: Rc<Settings<'a>>,
    document: usize,
    /// The frame of the tags in that of the body.
    frame: Pose,
    class: usize,
    prefix: String,
    suffix: String,
    attached: usize,
    part: usize,
    is_first: bool,
}

/// All bodies of a model, with these flags. Elements in `leave_out` are left out.
pub(crate) fn tree<'a>(documents: &'a Documents, flags: Flags, leave_out: &'a BTreeSet<LeaveOut>, log: &mut Diagnostics) -> Tree<'a> {
    let settings: Vec<Rc<Settings<'a>>> = documents.roots().map(|root| Rc::new(Settings::of(root, log))).collect();
    let fit_corners = settings.first().is_some_and(|main| main.compiler.fit_aabb);
    let (rules, gate) = (Rules { flags, fit_corners }, Gate::new(leave_out));
    let (bodies, parts) = (Vec::new(), Vec::new());
    let mut build = Build { documents, settings, rules, gate, bodies, parts, items: 0, letters: 0, depth: 0 };
    let root = documents.root(0);
    let context = build.context(0);
    build.add(None, root, 0, Pose::default(), &context);
    build.begin(&context, Extent::Whole, root, log);
    for section in root.all("worldbody") {
        build.content(section, 0, &context, log);
    }
    build.end(0);
    Tree { bodies: build.bodies, parts: build.parts }
}

struct Build<'a> {
    documents: &'a Documents,
    settings: Vec<Rc<Settings<'a>>>,
    rules: Rules,
    gate: Gate<'a>,
    bodies: Vec<Body<'a>>,
    parts: Vec<Part<'a>>,
    items: usize,
    /// Bytes of all names.
    letters: usize,
    depth: usize,
}

impl<'a> Build<'a> {
    fn context(&self, document: usize) -> Context<'a> {
        let settings = self.settings[document].clone();
        let (prefix, suffix) = (String::new(), String::new());
        Context { settings, document, frame: Pose::default(), class: 0, prefix, suffix, attached: 0, part: 0, is_first: true }
    }

    /// Begins a part of the tree, and returns its index.
    fn begin(&mut self, context: &Context<'a>, extent: Extent, element: &Element, log: &mut Diagnostics) -> usize {
        self.spell(context.prefix.len() + context.suffix.len(), element, log);
        self.gate.document(self.documents.root(context.document), log);
        let index = self.parts.len();
        self.parts.push(Part {
            settings: context.settings.clone(),
            prefix: context.prefix.clone(),
            suffix: context.suffix.clone(),
            extent,
            parent: context.part,
            is_first: context.is_first,
            bodies: self.bodies.len()..self.bodies.len(),
            parts: index..index + 1,
        });
        index
    }

    fn end(&mut self, part: usize) {
        let (bodies, parts) = (self.bodies.len(), self.parts.len());
        let part = &mut self.parts[part];
        (part.bodies.end, part.parts.end) = (bodies, parts);
    }

    fn add(&mut self, name: Option<String>, element: &'a Element, parent: usize, pose: Pose, context: &Context<'a>) -> usize {
        self.bodies.push(Body {
            name,
            element,
            settings: context.settings.clone(),
            parent,
            pose,
            joints: Vec::new(),
            geoms: Vec::new(),
            sites: Vec::new(),
            inertial: None,
            compensated: 0.0,
            part: context.part,
        });
        self.bodies.len() - 1
    }

    /// Whether there is room for one more item; an error if not.
    fn has_room(&mut self, element: &Element, log: &mut Diagnostics) -> bool {
        self.items += 1;
        if self.items == MOST_ITEMS {
            element.error((&Subject::Document, ""), Code::TooLarge, "very many bodies and geoms", format!("at most {MOST_ITEMS}"), log);
        }
        self.items < MOST_ITEMS && self.letters <= MOST_LETTERS
    }

    /// Counts the bytes of a name; an error, and no more room, if there are too many.
    fn spell(&mut self, letters: usize, element: &Element, log: &mut Diagnostics) {
        let had_room = self.letters <= MOST_LETTERS;
        self.letters += letters;
        if had_room && self.letters > MOST_LETTERS {
            let expected = format!("at most {MOST_LETTERS} bytes of names, those of all copies together");
            element.error((&Subject::Document, "name"), Code::TooLarge, "very long names", expected, log);
        }
    }

    /// The name of a tag's item.
    fn name(&mut self, element: &Element, context: &Context<'a>, log: &mut Diagnostics) -> Option<String> {
        let name = element.text("name").filter(|name| !name.is_empty())?;
        let full = format!("{}{name}{}", context.prefix, context.suffix);
        self.spell(full.len(), element, log);
        Some(full)
    }

    /// The tags inside a body, a frame or the world.
    fn content(&mut self, section: &'a Element, body: usize, context: &Context<'a>, log: &mut Diagnostics) {
        self.depth += 1;
        if self.depth > MOST_DEPTH {
            self.depth -= 1;
            section.error((&Subject::Document, ""), Code::TooLarge, "tags nested very deeply", format!("at most {MOST_DEPTH}"), log);
            return;
        }
        self.tags(section, body, context, log);
        self.depth -= 1;
    }

    fn tags(&mut self, section: &'a Element, body: usize, context: &Context<'a>, log: &mut Diagnostics) {
        for element in &section.children {
            if !self.has_room(element, log) {
                return;
            }
            let subject = subject(element);
            let class = context.settings.classes.find(element, "class", log).unwrap_or(context.class);
            let values = |name: &str| Values::new(element, context.settings.classes.tags(class, name), &subject);
            match element.name.as_str() {
                "inertial" | "joint" | "freejoint" if body == 0 => {
                    let found = format!("<{}> in the world", element.name);
                    element.error((&subject, ""), Code::Misplaced, found, "it in a body: the world does not move", log);
                }
                "inertial" => {
                    let values = Values::alone(element, &subject);
                    self.bodies[body].inertial = explicit(&values, &context.settings.compiler, log);
                }
                "joint" => {
                    let name = self.name(element, context, log);
                    if let Some(joint) = joint(name, &values("joint"), context, self.rules.flags, log) {
                        self.bodies[body].joints.push(joint);
                    }
                }
                "freejoint" => {
                    let free = Joint {
                        name: self.name(element, context, log),
                        element,
                        kind: Kind::Free,
                        anchor: [0.0; 3],
                        axis: [0.0, 0.0, 1.0],
                        reference: 0.0,
                        is_limited: false,
                        range: [0.0; 2],
                        limit: None,
                        force_range: None,
                        dynamics: JointDynamics::default(),
                        rest: 0.0,
                        spring_damper: [0.0; 2],
                        tether: [0.0; 3],
                        armature: 0.0,
                        soft: contact::SoftJoint::default(),
                        part: context.part,
                    };
                    self.bodies[body].joints.push(free);
                }
                "geom" => {
                    let values = values("geom");
                    let geom = geometry::geom(&values, &context.settings, &context.frame, (self.rules, &mut self.gate), log);
                    if let Some(mut geom) = geom {
                        (geom.name, geom.part) = (self.name(element, context, log), context.part);
                        self.bodies[body].geoms.push(geom);
                    }
                }
                "site" => {
                    let pose = site(&values("site"), context, log);
                    let site = Site { element, name: self.name(element, context, log), pose, part: context.part };
                    self.bodies[body].sites.push(site);
                }
                "body" => self.body(element, body, context, log),
                "frame" => {
                    let values = Values::alone(element, &subject);
                    let pose = values.pose(&context.settings.compiler.angles, log);
                    let class = context.settings.classes.find(element, "childclass", log).unwrap_or(context.class);
                    let context = Context { frame: context.frame.then(&pose), class, ..context.clone() };
                    self.content(element, body, &context, log);
                }
                "replicate" => self.replicate(element, body, context, log),
                "attach" => self.attach(element, body, context, log),
                _ => self.gate.body(element, log),
            }
        }
    }

    fn body(&mut self, element: &'a Element, parent: usize, context: &Context<'a>, log: &mut Diagnostics) {
        let subject = subject(element);
        let values = Values::alone(element, &subject);
        let pose = values.pose(&context.settings.compiler.angles, log);
        let class = context.settings.classes.find(element, "childclass", log).unwrap_or(context.class);
        if values.yes("mocap", log) == Some(true) {
            let attribute = element.attribute("mocap");
            element.unused(&subject, attribute, "the body is fixed at its place: nothing moves it", log);
        }
        let compensated = values.number("gravcomp", log).unwrap_or(0.0);
        let name = self.name(element, context, log);
        let body = self.add(name, element, parent, context.frame.then(&pose), context);
        self.bodies[body].compensated = compensated;
        let context = Context { frame: Pose::default(), class, ..context.clone() };
        self.content(element, body, &context, log);
    }

    fn replicate(&mut self, element: &'a Element, body: usize, context: &Context<'a>, log: &mut Diagnostics) {
        let values = Values::alone(element, &Subject::Document);
        let angles = &context.settings.compiler.angles;
        let Some(count) = values.integer("count", log).and_then(|count| usize::try_from(count).ok()) else {
            element.error((&Subject::Document, "count"), Code::MissingAttribute, "no number", "how many copies there are", log);
            return;
        };
        let offset = values.exactly::<3>("offset", log).unwrap_or_default();
        let euler = values.exactly::<3>("euler", log).unwrap_or_default();
        let class = context.settings.classes.find(element, "childclass", log).unwrap_or(context.class);
        let separator = values.text("sep").unwrap_or_default();
        let digits = count.to_string().len();
        let mut position = [0.0; 3];
        for copy in 0..count {
            if !self.has_room(element, log) {
                return;
            }
            let rotation = angles.euler(euler.map(|angle| angle * copy as f64));
            let pose = Pose { position, rotation };
            let suffix = format!("{separator}{copy:0digits$}{}", context.suffix);
            let mut context = Context { frame: context.frame.then(&pose), class, suffix, ..context.clone() };
            context.is_first &= copy == 0;
            context.part = self.begin(&context, Extent::Copy, element, log);
            self.content(element, body, &context, log);
            self.end(context.part);
            position = pose.then(&Pose::at(offset)).position;
        }
    }

    fn attach(&mut self, element: &'a Element, body: usize, context: &Context<'a>, log: &mut Diagnostics) {
        let text = |name: &str| element.text(name);
        if context.attached >= MOST_ATTACHED {
            let found = format!("models in models, {MOST_ATTACHED} deep");
            element.error((&Subject::Document, "model"), Code::TooLarge, found, "a model that does not attach itself", log);
            return;
        }
        let document = match text("model") {
            None => context.document,
            Some(name) => match self.documents.model(context.document, name) {
                Some(document) => document,
                None => {
                    // An unreadable file has an error already.
                    if !context.settings.models.contains_key(name) {
                        element.error(
                            (&Subject::Document, "model"),
                            Code::UnknownName,
                            quote(name),
                            "the name of a <model> of <asset>",
                            log,
                        );
                    }
                    return;
                }
            },
        };
        let root = self.documents.root(document);
        let settings = self.settings[document].clone();
        let prefix = format!("{}{}", context.prefix, text("prefix").unwrap_or_default());
        let mut inner = Context { settings, document, prefix, attached: context.attached + 1, ..context.clone() };
        let (tag, name) = match (text("body"), text("frame")) {
            (Some(name), _) => ("body", name),
            (None, Some(name)) => ("frame", name),
            (None, None) if text("model").is_some() => {
                inner.class = 0;
                inner.part = self.begin(&inner, Extent::Whole, element, log);
                for section in root.all("worldbody") {
                    self.content(section, body, &inner, log);
                }
                self.end(inner.part);
                return;
            }
            (None, None) => {
                element.error((&Subject::Document, "body"), Code::MissingAttribute, "none", "the attribute model, body or frame", log);
                return;
            }
        };
        let Some((source, class)) = find(root, tag, name, &inner.settings, log) else {
            element.error((&Subject::Document, tag), Code::UnknownName, quote(name), format!("the name of a {tag} of the model"), log);
            return;
        };
        inner.class = class;
        inner.part = self.begin(&inner, Extent::Attached, element, log);
        if tag == "body" {
            self.body(source, body, &inner, log);
            self.end(inner.part);
            return;
        }
        let pose = Values::alone(source, &Subject::Document).pose(&inner.settings.compiler.angles, log);
        inner.class = inner.settings.classes.find(source, "childclass", log).unwrap_or(class);
        inner.frame = inner.frame.then(&pose);
        self.content(source, body, &inner, log);
        self.end(inner.part);
    }
}

/// The body or frame of a name, and the default class that surrounds it.
fn find<'a>(root: &'a Element, tag: &str, name: &str, settings: &Settings<'a>, log: &mut Diagnostics) -> Option<(&'a Element, usize)> {
    let mut next: Vec<(&Element, usize)> = root.all("worldbody").map(|section| (section, 0)).collect();
    while let Some((element, class)) = next.pop() {
        if element.is(tag) && element.text("name") == Some(name) {
            return Some((element, class));
        }
        let class = settings.classes.find(element, "childclass", &mut log.apart()).unwrap_or(class);
        next.extend(element.children.iter().map(|child| (child, class)));
    }
    None
}

fn site(values: &Values<'_>, context: &Context<'_>, log: &mut Diagnostics) -> Pose {
    let angles = &context.settings.compiler.angles;
    let pose = match values.has_numbers("fromto") {
        true => geometry::between(values, log).map(|(pose, _)| pose).unwrap_or_default(),
        false => values.pose(angles, log),
    };
    context.frame.then(&pose)
}

fn joint<'a>(name: Option<String>, values: &Values<'a>, context: &Context<'a>, flags: Flags, log: &mut Diagnostics) -> Option<Joint<'a>> {
    use Kind::{Ball, Free, Hinge, Slide};
    let compiler = &context.settings.compiler;
    let kind = match values.has("type") {
        true => values.word("type", &[("free", Free), ("ball", Ball), ("slide", Slide), ("hinge", Hinge)], log)?,
        false => Hinge,
    };
    let is_scalar = matches!(kind, Slide | Hinge);
    let angle = |angle: f64| if kind == Hinge { compiler.angles.radians(angle) } else { angle };
    let (mut anchor, mut axis) = ([0.0; 3], [0.0, 0.0, 1.0]);
    if kind != Free {
        anchor = context.frame.then(&Pose::at(values.exactly("pos", log).unwrap_or_default())).position;
    }
    if is_scalar {
        let given = values.exactly::<3>("axis", log).unwrap_or(axis);
        let Some(unit) = unit(given) else {
            let [x, y, z] = given;
            values.error("axis", Code::ZeroAxis, format!("({x:?} {y:?} {z:?})"), "a vector that is not zero", log);
            return None;
        };
        // As written, if it is a multiple of a unit vector already.
        axis = rotate(context.frame.rotation, if is_of_length_one(given) { given } else { unit });
    }
    let (is_limited, limit, force_range) = limits(values, kind, context, flags, log);
    // A number that does not exist for the kind is not parsed.
    let scalar = |name: &str, log: &mut Diagnostics| if is_scalar { values.number(name, log).map_or(0.0, angle) } else { 0.0 };
    if force_range.is_some() && values.yes("actuatorgravcomp", log) == Some(true) {
        let expected = "none: the bounds are those of the actuators alone, without the weight that is compensated";
        values.element.warning((&values.subject, "actuatorgravcomp"), Code::LostDynamics, "actuatorgravcomp beside bounds", expected, log);
    }
    // Errors in these are reported here and below.
    let mut reported = log.apart();
    let (dynamics, tether) = dynamics(values, kind, flags, &angle, log);
    Some(Joint {
        name,
        element: values.element,
        kind,
        anchor,
        axis,
        reference: scalar("ref", log),
        is_limited,
        range: if is_scalar { values.exactly("range", &mut reported).unwrap_or_default().map(angle) } else { [0.0; 2] },
        limit,
        force_range,
        rest: scalar("springref", &mut reported),
        spring_damper: values.exactly("springdamper", log).unwrap_or_default(),
        armature: values.number("armature", &mut reported).unwrap_or(0.0),
        soft: contact::SoftJoint::of(values, flags, log),
        dynamics,
        tether,
        part: context.part,
    })
}

fn is_of_length_one(axis: Vector) -> bool {
    axis.iter().filter(|x| **x == 0.0).count() == 2 && axis.iter().any(|x| x.abs() == 1.0)
}

/// Whether a range is a bound.
fn is_bound(values: &Values<'_>, (flag, field): (&str, &str), range: [f64; 2], auto: bool, log: &mut Diagnostics) -> bool {
    match values.yes_or_auto(flag, log) {
        Some(yes) => yes,
        None if !auto && range != [0.0; 2] => {
            let expected = format!("{flag}, since <compiler autolimits=\"false\">");
            values.error(field, Code::LimitIncomplete, "a range alone", expected, log);
            false
        }
        None => range[0] < range[1],
    }
}

/// Whether the range is a bound, the bounds, and the bounds on the force of all actuators.
fn limits(
    values: &Values<'_>,
    kind: Kind,
    context: &Context<'_>,
    flags: Flags,
    log: &mut Diagnostics,
) -> (bool, Option<Limit>, Option<[f64; 2]>) {
    if kind == Kind::Free {
        return (false, None, None);
    }
    let compiler = &context.settings.compiler;
    let range = values.exactly::<2>("range", log).unwrap_or_default();
    let is_limited = is_bound(values, ("limited", "range"), range, compiler.auto_limits, log);
    let ordered = |field: &str, [lower, upper]: [f64; 2], log: &mut Diagnostics| {
        if lower >= upper {
            values.error(field, Code::LimitOrder, format!("{lower} and {upper}"), "the lower bound, then a greater one", log);
        }
    };
    if kind == Kind::Ball {
        if is_limited && range[0] != 0.0 {
            let expected = "0: the range of a ball joint is that of the angle of its rotation, which is not negative";
            values.error("range", Code::LimitOrder, format!("the lower bound {}", range[0]), expected, log);
        }
        let is_limited = is_limited && !flags.no_limit;
        // MuJoCo takes the greater of both bounds.
        let upper = compiler.angles.radians(range[1].max(0.0));
        if is_limited && upper == 0.0 {
            let expected = "an upper bound above 0: a limit of no rotation gives no torque here";
            values.element.warning((&values.subject, "range"), Code::LostDynamics, "a ball joint that is limited to 0", expected, log);
        }
        return (is_limited, is_limited.then_some(Limit { upper, ..Limit::NONE }), None);
    }
    let mut limit = Limit::NONE;
    if is_limited {
        ordered("range", range, log);
    }
    let is_limited = is_limited && !flags.no_limit;
    if is_limited {
        let convert = |bound: f64| if kind == Kind::Hinge { compiler.angles.radians(bound) } else { bound };
        [limit.lower, limit.upper] = range.map(convert);
    }
    let force = values.exactly::<2>("actuatorfrcrange", log).unwrap_or_default();
    let is_force_limited = is_bound(values, ("actuatorfrclimited", "actuatorfrcrange"), force, compiler.auto_limits, log);
    if is_force_limited {
        ordered("actuatorfrcrange", force, log);
        limit.effort = force[0].abs().max(force[1].abs());
    }
    (is_limited, (limit != Limit::NONE).then_some(limit), is_force_limited.then_some(force))
}

/// The numbers of a joint's forces, and the stiffnesses of a free joint.
fn dynamics(values: &Values<'_>, kind: Kind, flags: Flags, angle: &dyn Fn(f64) -> f64, log: &mut Diagnostics) -> (JointDynamics, [f64; 3]) {
    let [damping, stiffness] = [("damping", flags.no_damper), ("stiffness", flags.no_spring)].map(|(name, is_off)| {
        if !values.has_numbers(name) {
            return [None; 3];
        }
        let numbers @ [_, second, third] = values.at_most(name, [0.0; 3], log);
        let has_terms = (second != 0.0 || third != 0.0) && !is_off;
        if has_terms && kind == Kind::Free && name == "damping" {
            let expected = "one coefficient: the damping of a free joint is linear, and the others are not used";
            values.element.warning((&values.subject, name), Code::LostDynamics, "a damping of higher degree", expected, log);
        }
        numbers.map(|number| Some(number).filter(|_| !is_off))
    });
    let terms = |[_, second, third]: [Option<f64>; 3]| Some([second?, third?]).filter(|terms| *terms != [0.0; 2]);
    let (damping_terms, stiffness_terms) = (terms(damping), terms(stiffness));
    let tether = if kind == Kind::Free { stiffness.map(|own| own.unwrap_or(0.0)) } else { [0.0; 3] };
    let [damping, stiffness] = [damping[0], stiffness[0]];
    let friction = values.number("frictionloss", log).filter(|_| !flags.no_friction);
    let armature = values.number("armature", log);
    let has_spring = stiffness.is_some_and(|k| k != 0.0) || stiffness_terms.is_some();
    if has_spring && values.number("springyield", log).is_some_and(|most| most > 0.0) {
        let expected = "a spring that does not: it is elastic";
        values.element.warning((&values.subject, "springyield"), Code::LostDynamics, "a spring that yields", expected, log);
    }
    if kind != Kind::Free {
        // A ball joint is relaxed at the identity.
        let rest = if kind == Kind::Ball { None } else { values.number("springref", log).map(angle) };
        let rest = rest.filter(|_| stiffness.is_some());
        return (JointDynamics { damping, damping_terms, friction, armature, stiffness, stiffness_terms, rest }, tether);
    }
    if friction.is_some_and(|number| number != 0.0) {
        let expected = "none, or functions with constraints, which alone keep it";
        values.element.warning((&values.subject, "frictionloss"), Code::LostDynamics, "frictionloss of a free joint", expected, log);
    }
    // Armature and stiffness of a free joint are effects on its body: see `surroundings`.
    (JointDynamics { damping, ..JointDynamics::default() }, tether)
}

/// The pose of a joint in the body's frame, turned or moved back by its reference, so that the
/// coordinate equals the file's.
pub(crate) fn at_reference(joint: &Joint<'_>, before: Pose) -> Pose {
    match joint.kind {
        _ if joint.reference == 0.0 => before,
        Kind::Slide => before.then(&Pose::at(joint.axis.map(|x| -joint.reference * x))),
        _ => Pose { rotation: multiply(before.rotation, about(joint.axis, -joint.reference)), ..before },
    }
}
