//! From tags to a graph of frames: names resolved, poses known, links and joints listed.
//!
//! Each model, link, joint and `<frame>` is a node. A node has a pose in another node, so that the
//! nodes are a tree below the world, and it is attached to a body: the world or a link.

use std::cell::Cell;
use std::collections::HashMap;

use articulated_core::diagnostic::{Code, Diagnostics, Subject, quote};
use articulated_core::listed;
use articulated_core::suggest::Suggester;

use super::grammar::subject;
use super::joints::{self, Joint};
use super::links::{self, Link};
use super::names::{MODEL, ROOT, ROOT_FRAME, Reference, Version, WORLD_NAME, relative_to, version};
use super::values::{self, flag, only, text, yes};
use crate::Options;
use crate::cycles::{around, cycles};
use crate::pose::{Pose, conjugate, rotate, scale};
use crate::xml::tree::Element;

/// Maximum number of models, links, joints and frames of a document.
const MOST_NODES: usize = 200_000;
/// Maximum length of a name, bytes, with those of the surrounding models.
const MOST_NAME: usize = 1024;
/// Maximum total length of all names, bytes.
const MOST_LETTERS: usize = 32 << 20;
/// Maximum total number of steps from frame to frame, so that no document takes hours.
const MOST_STEPS: u64 = 200_000_000;

/// The node of the world, and its body.
pub(crate) const WORLD: usize = 0;

/// Where names are looked up.
pub(crate) struct Scope {
    /// Prefix of the keys of its names.
    prefix: String,
    /// Prefix of the names in the description.
    shown: String,
    /// The node of the model; the world outside of all.
    pub(crate) model: usize,
    pub(crate) version: Version,
    is_static: bool,
}

/// Target of a node's reference.
#[derive(Clone, Copy)]
pub(crate) enum To<'a> {
    Node(usize),
    Named(Reference<'a>),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum What {
    World,
    Model,
    Link,
    Joint,
    Frame,
}

impl What {
    /// As in messages.
    fn word(self) -> &'static str {
        match self {
            Self::World => "world",
            Self::Model => "model",
            Self::Link => "link",
            Self::Joint => "joint",
            Self::Frame => "frame",
        }
    }
}

pub(crate) struct Node<'a> {
    pub(crate) what: What,
    pub(crate) element: &'a Element,
    /// As in the description.
    pub(crate) name: String,
    pose: Pose,
    relative_to: To<'a>,
    attached_to: To<'a>,
    /// For a model: the frame that its pose places.
    placement: Option<Reference<'a>>,
}

pub(crate) struct Graph<'a> {
    pub(crate) name: String,
    /// Gravity of the world, m/s², if the file contains it.
    pub(crate) gravity: Option<[f64; 3]>,
    pub(crate) nodes: Vec<Node<'a>>,
    pub(crate) scopes: Vec<Scope>,
    pub(crate) links: Vec<Link<'a>>,
    pub(crate) joints: Vec<Joint<'a>>,
    /// Nodes by their names with the models around them.
    keys: HashMap<String, usize>,
    /// Nodes of joints with the name of a link; elsewhere the name means the link.
    shadowed: HashMap<String, usize>,
    /// For each node, the node that it is placed in, and its pose there.
    edges: Vec<(usize, Pose)>,
    depths: Vec<u32>,
    /// For each node, the body that it moves with: 0 for the world, or one more than the number of
    /// the link.
    pub(crate) bodies: Vec<usize>,
    steps: Cell<u64>,
}

impl<'a> Graph<'a> {
    /// The graph of a model, or of all models of a world; `None` if errors make it meaningless.
    pub(crate) fn of(root: &'a Element, options: &Options, log: &mut Diagnostics) -> Option<Self> {
        let version = version(root, log);
        let worlds: Vec<&Element> = root.children.iter().filter(|child| child.is(WORLD_NAME)).collect();
        let (alone, inside) = (models(root, log), worlds.iter().flat_map(|world| models(world, log)).collect::<Vec<_>>());
        let all: Vec<&Element> = alone.iter().chain(&inside).copied().collect();
        let name = match (alone.as_slice(), inside.as_slice(), worlds.as_slice()) {
            ([_], [], _) | ([], [_], _) => None,
            ([], [_, _, ..], [world]) => Some(world.text("name").map(str::trim).filter(|name| !name.is_empty()).unwrap_or(WORLD_NAME)),
            _ => {
                let names = listed(all.iter().map(|model| format!("{} in line {}", quote(name_of(model)), model.at.line().unwrap_or(0))));
                let (code, found) = match all.len() {
                    0 => (Code::NoLinks, "no model".to_owned()),
                    count => (Code::DuplicateTag, format!("{count} models: {names}")),
                };
                let last = all.last().copied().unwrap_or(root);
                last.error((&Subject::Document, "model"), code, found, "one <model>, or one <world> with models", log);
                return None;
            }
        };
        let mut build = Build { graph: Graph::empty(root, version), options, suggester: Suggester::default(), letters: 0 };
        // A single model adds no prefix to names.
        name.unwrap_or_default().clone_into(&mut build.graph.name);
        for model in &all {
            build.any_model(model, WORLD, &Over::default(), log);
        }
        if let Some(world) = worlds.first() {
            build.content(world, WORLD, log);
            build.graph.gravity = gravity(world, log);
        }
        let mut graph = build.graph;
        if graph.links.is_empty() && log.is_ok() {
            all[0].error((&Subject::Document, "link"), Code::NoLinks, "no link", "a model with at least one link", log);
        }
        let has_names = graph.resolve_joints(log);
        (graph.connect(log) && has_names).then_some(graph)
    }

    fn empty(root: &'a Element, version: Version) -> Self {
        let world = Node {
            what: What::World,
            element: root,
            name: WORLD_NAME.to_owned(),
            pose: Pose::default(),
            relative_to: To::Node(WORLD),
            attached_to: To::Node(WORLD),
            placement: None,
        };
        let scope = Scope { prefix: String::new(), shown: String::new(), model: WORLD, version, is_static: false };
        Self {
            name: String::new(),
            gravity: None,
            nodes: vec![world],
            scopes: vec![scope],
            links: Vec::new(),
            joints: Vec::new(),
            keys: HashMap::new(),
            shadowed: HashMap::new(),
            edges: Vec::new(),
            depths: Vec::new(),
            bodies: Vec::new(),
            steps: Cell::new(0),
        }
    }

    /// The node of a name; a missing one is reported.
    pub(crate) fn resolve(&self, reference: &Reference<'_>, log: &mut Diagnostics) -> Option<usize> {
        let Reference { element, field, name, scope } = *reference;
        let scope = &self.scopes[scope];
        let is_outside = scope.model == WORLD;
        let found = match name {
            MODEL if !is_outside => Some(scope.model),
            ROOT_FRAME => Some(WORLD),
            // A parent, in any model; before 1.7, any frame.
            WORLD_NAME if is_outside || field == "parent" || scope.version < Version::V1_7 => Some(WORLD),
            _ => self.keys.get(&format!("{}{name}", scope.prefix)).copied(),
        };
        if found.is_none() {
            let code = if matches!(field, "parent" | "child") { Code::UnknownLink } else { Code::UnknownName };
            let expected = "the name of a link, joint, frame or model of this model";
            element.error((&subject(element), field), code, quote(name), expected, log);
        }
        found
    }

    /// Finds the parents of joints and the frames of their axes; false if one is missing.
    fn resolve_joints(&mut self, log: &mut Diagnostics) -> bool {
        let mut is_good = true;
        let mut joints = std::mem::take(&mut self.joints);
        for joint in &mut joints {
            match self.resolve(&joint.parent, log) {
                Some(node) => joint.parent_node = node,
                None => is_good = false,
            }
            for axis in &mut joint.axes {
                let Some(reference) = &axis.expressed_in else { continue };
                axis.frame = self.resolve(reference, log);
                is_good &= axis.frame.is_some();
            }
        }
        self.joints = joints;
        is_good
    }

    /// The node of the name of a joint, if there is one.
    pub(crate) fn find_joint(&self, reference: &Reference<'_>) -> Option<usize> {
        let key = format!("{}{}", self.scopes[reference.scope].prefix, reference.name);
        self.shadowed.get(&key).or_else(|| self.keys.get(&key)).copied()
    }

    fn to(&self, to: &To<'_>, log: &mut Diagnostics) -> Option<usize> {
        match to {
            To::Node(node) => Some(*node),
            To::Named(reference) => self.resolve(reference, log),
        }
    }

    /// Resolves all references of nodes; false if that is impossible.
    fn connect(&mut self, log: &mut Diagnostics) -> bool {
        let all = |log: &mut Diagnostics, of: &dyn Fn(&Node<'a>) -> To<'a>| -> Vec<Option<usize>> {
            self.nodes.iter().map(|node| self.to(&of(node), log)).collect()
        };
        let above = all(log, &|node| node.relative_to);
        // If both are one name, it is reported once.
        let mut again = log.apart();
        let attached = all(&mut again, &|node| node.attached_to);
        let is_reported = |error: &articulated_core::diagnostic::Diagnostic| {
            log.errors.iter().any(|other| other.span == error.span && other.found == error.found)
        };
        let new: Vec<_> = again.errors.into_iter().filter(|error| !is_reported(error)).collect();
        log.extend(new);
        let (Some(above), Some(attached)) = (complete(above), complete(attached)) else { return false };
        // The world is in no other frame. A link, and a model without links, are attached to
        // themselves.
        let moves_alone = |node: usize| node == WORLD || matches!(self.nodes[node].attached_to, To::Node(own) if own == node);
        let in_poses = self.report_rings("poses that are relative to each other", |node| (node != WORLD).then(|| above[node]), log);
        let in_frames =
            self.report_rings("frames that are attached to each other", |node| (!moves_alone(node)).then(|| attached[node]), log);
        if in_poses || in_frames {
            return false;
        }
        self.edges = above.iter().zip(&self.nodes).map(|(above, node)| (*above, node.pose)).collect();
        self.depths = depths(&above);
        self.bodies = self.attach(&attached);
        self.place_models(log)
    }

    /// Reports nodes that depend on themselves, and returns whether there are any.
    fn report_rings(&self, what: &str, on: impl Fn(usize) -> Option<usize>, log: &mut Diagnostics) -> bool {
        let rings = cycles(self.nodes.len(), &on);
        for node in &rings {
            let names = listed(around(*node, &on).take(10).map(|node| quote(&self.nodes[node].name)));
            let element = self.nodes[*node].element;
            let expected = "frames of which each depends on the ones before";
            element.error((&subject(element), "pose"), Code::Ring, format!("{what}: {names}"), expected, log);
        }
        !rings.is_empty()
    }

    /// The body of each node. The links are their own.
    fn attach(&self, attached: &[usize]) -> Vec<usize> {
        let mut bodies = vec![usize::MAX; attached.len()];
        bodies[WORLD] = 0;
        self.links.iter().enumerate().for_each(|(index, link)| bodies[link.node] = index + 1);
        for start in 0..attached.len() {
            let mut chain = Vec::new();
            let mut next = start;
            while bodies[next] == usize::MAX {
                chain.push(next);
                next = attached[next];
                // A model without links is attached to itself.
                if chain.last() == Some(&next) {
                    bodies[next] = 0;
                }
            }
            let body = bodies[next];
            chain.into_iter().for_each(|node| bodies[node] = body);
        }
        bodies
    }

    /// Applies the placement frames of models, the innermost first.
    fn place_models(&mut self, log: &mut Diagnostics) -> bool {
        let mut is_good = true;
        for node in (0..self.nodes.len()).rev() {
            let Some(reference) = self.nodes[node].placement else { continue };
            let Some(placed) = self.resolve(&reference, log) else {
                is_good = false;
                continue;
            };
            let inside = self.relative(node, placed);
            self.edges[node].1 = self.edges[node].1.then(&inverse(&inside));
        }
        is_good
    }

    /// The pose of a node in another one. Frames that contain both are not used, so that they add
    /// no rounding errors.
    pub(crate) fn relative(&self, frame: usize, node: usize) -> Pose {
        let (mut a, mut b) = (frame, node);
        let (mut to_a, mut to_b) = (Pose::default(), Pose::default());
        let mut parts = 0;
        while a != b && self.steps.get() < MOST_STEPS {
            self.steps.set(self.steps.get() + 1);
            let is_lower = self.depths[a] > self.depths[b];
            let (at, pose) = if is_lower { (&mut a, &mut to_a) } else { (&mut b, &mut to_b) };
            let (above, own) = &self.edges[*at];
            parts += usize::from(*own != Pose::default());
            *pose = own.then(pose);
            *at = *above;
        }
        let pose = inverse(&to_a).then(&to_b);
        if parts > 1 { without_dust(pose, &[to_a, to_b]) } else { pose }
    }

    /// Whether poses were left out because there were too many.
    pub(crate) fn is_exhausted(&self) -> bool {
        self.steps.get() >= MOST_STEPS
    }
}

fn complete(all: Vec<Option<usize>>) -> Option<Vec<usize>> {
    all.into_iter().collect()
}

/// How many nodes are above each.
fn depths(above: &[usize]) -> Vec<u32> {
    let mut depths = vec![u32::MAX; above.len()];
    depths[WORLD] = 0;
    for start in 0..above.len() {
        let mut chain = Vec::new();
        let mut next = start;
        while depths[next] == u32::MAX {
            chain.push(next);
            next = above[next];
        }
        let mut depth = depths[next];
        for node in chain.into_iter().rev() {
            depth += 1;
            depths[node] = depth;
        }
    }
    depths
}

pub(crate) fn inverse(pose: &Pose) -> Pose {
    let rotation = conjugate(pose.rotation);
    Pose { position: scale(rotate(rotation, pose.position), -1.0), rotation }
}

/// The pose without components due to rounding: those far below the last digit of the numbers that
/// it is computed from.
fn without_dust(pose: Pose, parts: &[Pose]) -> Pose {
    const DUST: f64 = 4.0 * f64::EPSILON;
    let largest = parts.iter().flat_map(|part| part.position).fold(0.0_f64, |most, x| most.max(x.abs()));
    let length = pose.rotation.iter().fold(0.0_f64, |most, q| most.max(q.abs()));
    let clean = |x: f64, size: f64| if x.abs() <= DUST * size { 0.0 } else { x };
    let position = pose.position.map(|x| clean(x, largest));
    let mut rotation = pose.rotation.map(|q| clean(q, length));
    // A quarter turn has two equal numbers.
    for k in 1..4 {
        let near = (rotation[k].abs() - length).abs() <= DUST * length && (rotation[0].abs() - length).abs() <= DUST * length;
        if near {
            rotation[k] = rotation[0].abs().copysign(rotation[k]);
        }
    }
    Pose { position, rotation }
}

/// The models of a document or of a world. Included lights and the like are listed as unused.
fn models<'a>(of: &'a Element, log: &mut Diagnostics) -> Vec<&'a Element> {
    let mut all = Vec::new();
    for child in &of.children {
        let included = child.children.iter().find(|inner| inner.is(ROOT)).filter(|_| child.is("include"));
        let is_model = |element: &Element| element.is("model") || element.is(WORLD_NAME) || element.is("include");
        match included {
            Some(root) if !root.children.is_empty() && !root.children.iter().any(is_model) => {
                child.unused(&Subject::Document, None, "the file that it includes has no model", log);
            }
            _ if child.is("model") || child.is("include") => all.push(child),
            _ => {}
        }
    }
    all
}

/// The name of a model or an `<include>`, for messages.
fn name_of(element: &Element) -> &str {
    let child = |name: &str| element.children.iter().find(|child| child.is(name)).map(text);
    element.text("name").or(child("name")).or(child("uri")).unwrap_or_default()
}

/// Gravity of a world, m/s².
fn gravity(world: &Element, log: &mut Diagnostics) -> Option<[f64; 3]> {
    values::exactly::<3>(only(world, "gravity", &Subject::Document, log)?, &Subject::Document, log)
}

/// Elements of an `<include>` that replace those of the model in the file.
#[derive(Clone, Copy, Default)]
struct Over<'a> {
    name: Option<&'a str>,
    pose: Option<(&'a Element, usize)>,
    is_static: Option<bool>,
    placement: Option<(&'a Element, &'a str)>,
    merge: bool,
}

struct Build<'a, 'o> {
    graph: Graph<'a>,
    options: &'o Options,
    suggester: Suggester,
    /// Bytes of all names.
    letters: usize,
}

impl<'a> Build<'a, '_> {
    /// A new node with a name of its own; `None`, with an error, if the name is not available.
    fn add(&mut self, node: Node<'a>, key: Option<String>, log: &mut Diagnostics) -> Option<usize> {
        let element = node.element;
        let about = subject(element);
        let index = self.graph.nodes.len();
        if index >= MOST_NODES {
            if index == MOST_NODES {
                element.error((&about, ""), Code::TooLarge, "very many links, joints and frames", format!("at most {MOST_NODES}"), log);
                self.graph.nodes.push(node);
            }
            return None;
        }
        let had_room = self.letters <= MOST_LETTERS;
        self.letters += node.name.len();
        if self.letters > MOST_LETTERS {
            if had_room {
                let expected = format!("at most {MOST_LETTERS} bytes of names together");
                element.error((&about, "name"), Code::TooLarge, "very long names", expected, log);
            }
            return None;
        }
        if let Some(key) = key {
            if key.len() > MOST_NAME {
                element.error(
                    (&about, "name"),
                    Code::TooLarge,
                    format!("a name of {} bytes", key.len()),
                    format!("at most {MOST_NAME}"),
                    log,
                );
                return None;
            }
            let is_joint = |node: &Node<'_>| node.what == What::Joint;
            match self.graph.keys.get(&key).map(|first| &self.graph.nodes[*first]) {
                None => {
                    self.graph.keys.insert(key, index);
                }
                // In older versions a joint may have the name of a link.
                Some(first) if is_joint(first) != is_joint(&node) => {
                    let (line, [a, b]) = (first.element.at.line().unwrap_or_default(), [first.what, node.what].map(What::word));
                    let found = format!("a {b} with the name of the {a} of line {line}, {}", quote(&node.name));
                    let other = if is_joint(first) { b } else { a };
                    let expected = format!("a name of its own: sdformat refuses this from version 1.7 on; references mean the {other}");
                    element.warning((&about, "name"), Code::DuplicateName, found, expected, log);
                    match is_joint(first) {
                        true => self.graph.keys.insert(key.clone(), index).and_then(|joint| self.graph.shadowed.insert(key, joint)),
                        false => self.graph.shadowed.insert(key, index),
                    };
                }
                Some(first) => {
                    let line = first.element.at.line().unwrap_or_default();
                    let found = format!("a duplicate: line {line} already has the name {}", quote(&node.name));
                    element.error((&about, "name"), Code::DuplicateName, found, "a name of its own", log);
                }
            }
        }
        self.graph.nodes.push(node);
        Some(index)
    }

    /// The own name of a tag.
    fn own_name(&self, element: &'a Element, log: &mut Diagnostics) -> Option<&'a str> {
        let about = subject(element);
        let Some(name) = element.text("name") else {
            let expected = format!("the attribute name in <{}>", element.name);
            element.error((&about, "name"), Code::MissingAttribute, "none", expected, log);
            return None;
        };
        self.checked_name(element, name, log)
    }

    fn checked_name(&self, element: &Element, name: &'a str, log: &mut Diagnostics) -> Option<&'a str> {
        let about = subject(element);
        if name.trim().is_empty() {
            element.error((&about, "name"), Code::EmptyName, "an empty name", "a name", log);
            return None;
        }
        if name == WORLD_NAME || (name.starts_with("__") && name.ends_with("__")) {
            let expected = "another name: world and __…__ belong to the format";
            element.error((&about, "name"), Code::DuplicateName, quote(name), expected, log);
            return None;
        }
        Some(name)
    }

    /// The pose of a tag and the frame that it is relative to; `otherwise` by default.
    pub(crate) fn pose(&self, element: &'a Element, scope: usize, otherwise: To<'a>, log: &mut Diagnostics) -> (Pose, To<'a>) {
        let about = subject(element);
        let Some(tag) = only(element, "pose", &about, log) else { return (Pose::default(), otherwise) };
        (values::pose(tag, self.options.snap_angles, &about, log), relative_to(tag, scope).map_or(otherwise, To::Named))
    }

    /// A `<model>`, or an `<include>` of one.
    fn any_model(&mut self, element: &'a Element, scope: usize, over: &Over<'a>, log: &mut Diagnostics) -> Option<usize> {
        if element.is("model") {
            return self.model(element, scope, over, log);
        }
        let none = &Subject::Document;
        // Errors of the file have been reported.
        let Some(root) = element.children.iter().find(|child| child.is(ROOT)) else {
            if !element.children.iter().any(|child| child.is("uri")) {
                element.error((none, "uri"), Code::MissingTag, "none", "<uri> inside <include>", log);
            }
            return None;
        };
        let version = version(root, log);
        let mut models = models(root, log);
        root.children.iter().filter(|child| child.is(WORLD_NAME)).for_each(|world| models.extend(self::models(world, log)));
        let [model] = models.as_slice() else {
            let found = format!("a file with {} models", models.len());
            element.error((none, "uri"), Code::Unsupported, found, "a file with one model", log);
            return None;
        };
        let pose = only(element, "pose", none, log).map(|pose| (pose, scope));
        let placement = only(element, "placement_frame", none, log).map(|tag| (tag, text(tag)));
        let over = Over {
            name: over.name.or(only(element, "name", none, log).map(text).filter(|name| !name.is_empty())),
            pose: over.pose.or(pose),
            is_static: over.is_static.or(yes(element, "static", none, log)),
            placement: over.placement.or(placement.filter(|(_, name)| !name.is_empty())),
            merge: over.merge || flag(element, "merge", none, log),
        };
        // The scope around the model, in the version of its file.
        let around = &self.graph.scopes[scope];
        let inner = Scope { prefix: around.prefix.clone(), shown: around.shown.clone(), version, ..*around };
        self.graph.scopes.push(inner);
        self.any_model(model, self.graph.scopes.len() - 1, &over, log)
    }

    fn model(&mut self, element: &'a Element, scope: usize, over: &Over<'a>, log: &mut Diagnostics) -> Option<usize> {
        let none = &Subject::Document;
        let name = match over.name {
            Some(name) => self.checked_name(element, name, log)?,
            None => self.own_name(element, log)?,
        };
        let is_top = self.graph.name.is_empty();
        if is_top {
            name.clone_into(&mut self.graph.name);
        }
        let around = &self.graph.scopes[scope];
        let (around_prefix, around_shown, version) = (around.prefix.clone(), around.shown.clone(), around.version);
        let is_static = yes(element, "static", none, log);
        let is_static = around.is_static || over.is_static.or(is_static).unwrap_or(false);
        let otherwise = To::Node(around.model);
        let own_scope = self.graph.scopes.len();
        let (own_pose, own_to) = self.pose(element, scope, otherwise, log);
        let (pose, relative_to) = match over.pose {
            Some((tag, scope)) => {
                let pose = values::pose(tag, self.options.snap_angles, none, log);
                (pose, relative_to(tag, scope).map_or(otherwise, To::Named))
            }
            None => (own_pose, own_to),
        };
        let own_placement = element.attribute("placement_frame").map(|attribute| (element, attribute.value.trim()));
        let placement = over.placement.or(own_placement.filter(|(_, name)| !name.is_empty()));
        let placement = placement.map(|(element, name)| Reference { element, field: "placement_frame", name, scope: own_scope });
        let shown = format!("{around_shown}{name}");
        let node = self.graph.nodes.len();
        // By default it is attached to itself: the world.
        let model = Node { what: What::Model, element, name: shown.clone(), pose, relative_to, attached_to: To::Node(node), placement };
        let key = (!over.merge).then(|| format!("{around_prefix}{name}"));
        self.add(model, key, log)?;
        let (prefix, shown) = match over.merge {
            true => (around_prefix, around_shown),
            false => (format!("{around_prefix}{name}::"), if is_top { String::new() } else { format!("{shown}::") }),
        };
        if !over.merge {
            self.graph.keys.insert(format!("{prefix}{MODEL}"), node);
        }
        self.graph.scopes.push(Scope { prefix, shown, model: node, version, is_static });
        let first = self.content(element, own_scope, log);
        let canonical = element.attribute("canonical_link").map(|attribute| attribute.value.trim()).filter(|name| !name.is_empty());
        let attached_to = match (canonical, first) {
            (Some(name), _) => To::Named(Reference { element, field: "canonical_link", name, scope: own_scope }),
            (None, Some(first)) => To::Node(first),
            (None, None) => To::Node(node),
        };
        self.graph.nodes[node].attached_to = attached_to;
        Some(node)
    }

    /// The tags of a model or a world. Returns its first link, or else its first model.
    fn content(&mut self, element: &'a Element, scope: usize, log: &mut Diagnostics) -> Option<usize> {
        let is_world = element.is(WORLD_NAME);
        let (mut first_link, mut first_model) = (None, None);
        for child in &element.children {
            match child.name.as_str() {
                "link" => {
                    let link = self.link(child, scope, log);
                    first_link = first_link.or(link);
                }
                "joint" => self.joint(child, scope, log),
                "frame" => self.frame(child, scope, log),
                // The models of a world are read already.
                "model" | "include" if !is_world => {
                    let model = self.any_model(child, scope, &Over::default(), log);
                    first_model = first_model.or(model);
                }
                _ => {}
            }
        }
        first_link.or(first_model)
    }

    fn names(&self, scope: usize, name: &str) -> (String, String) {
        let scope = &self.graph.scopes[scope];
        (format!("{}{name}", scope.prefix), format!("{}{name}", scope.shown))
    }

    fn link(&mut self, element: &'a Element, scope: usize, log: &mut Diagnostics) -> Option<usize> {
        let name = self.own_name(element, log);
        let otherwise = To::Node(self.graph.scopes[scope].model);
        let (pose, relative_to) = self.pose(element, scope, otherwise, log);
        let inertial = links::inertial(element, self.graph.scopes[scope].is_static, self.options, log);
        let (key, name) = self.names(scope, name?);
        let own = self.graph.nodes.len();
        let attached_to = To::Node(own);
        let node = self.add(Node { what: What::Link, element, name, pose, relative_to, attached_to, placement: None }, Some(key), log)?;
        let is_static = self.graph.scopes[scope].is_static;
        self.graph.links.push(Link { element, node, scope, inertial, is_static });
        Some(node)
    }

    fn frame(&mut self, element: &'a Element, scope: usize, log: &mut Diagnostics) {
        let name = self.own_name(element, log);
        let attached = element.attribute("attached_to").map(|attribute| attribute.value.trim()).filter(|name| !name.is_empty());
        let attached_to = match attached {
            Some(name) => To::Named(Reference { element, field: "attached_to", name, scope }),
            None => To::Node(self.graph.scopes[scope].model),
        };
        let (pose, relative_to) = self.pose(element, scope, attached_to, log);
        let Some(name) = name else { return };
        let (key, name) = self.names(scope, name);
        self.add(Node { what: What::Frame, element, name, pose, relative_to, attached_to, placement: None }, Some(key), log);
    }

    fn joint(&mut self, element: &'a Element, scope: usize, log: &mut Diagnostics) {
        let name = self.own_name(element, log);
        let version = self.graph.scopes[scope].version;
        let draft = joints::joint(element, scope, version, &mut self.suggester, log);
        let (Some(name), Some(mut joint)) = (name, draft) else { return };
        let attached_to = To::Named(joint.child);
        let (pose, relative_to) = self.pose(element, scope, attached_to, log);
        let (key, name) = self.names(scope, name);
        let node = self.add(Node { what: What::Joint, element, name, pose, relative_to, attached_to, placement: None }, Some(key), log);
        let Some(node) = node else { return };
        joint.node = node;
        self.graph.joints.push(joint);
    }
}
