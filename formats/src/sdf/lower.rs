//! From the graph to a [`Description`]: a tree below the world.

use std::collections::{BTreeSet, HashMap, VecDeque};

use articulated_core::description::{Base, Description, Frame, Joint, JointId, JointKind, Limit, Link, LinkId, Mimic, Origin};
use articulated_core::diagnostic::{Code, Diagnostics, Subject, quote};
use articulated_core::listed;

use super::auto;
use super::grammar::subject;
use super::graph::{Graph, WORLD, What};
use super::joints::{self, Axis, Type};
use super::names::WORLD_NAME;
use super::shapes;
use crate::Options;
use crate::cycles::{around, cycles};
use crate::pose::{Pose, Vector, cross, rotate, scalar_last, scale};
use crate::reading::HELD;
use crate::taken::Taken;
use crate::world::{Document, Keyframe, Plane, World};

/// Maximum number of described loops, and of listed joints of each.
const MOST_LOOPS: usize = 100;
const MOST_LISTED: usize = 20;

/// The description of all links, with planes and the initial state of free models; `None` if errors
/// make it meaningless.
pub(crate) fn lower(graph: &Graph<'_>, options: &Options, log: &mut Diagnostics) -> Option<Document> {
    let tree = Tree::of(graph, log)?;
    let mut lower = Lower {
        graph,
        description: Description { name: graph.name.clone(), ..Description::default() },
        links: Taken::with(WORLD_NAME),
        joints: Taken::default(),
        first: vec![None; graph.joints.len()],
        frames: Vec::new(),
        start: Vec::new(),
        planes: Vec::new(),
        leaders: graph.joints.iter().flat_map(|joint| &joint.axes).filter_map(|axis| graph.find_joint(&axis.mimic?.leader)).collect(),
    };
    lower.links(options, log);
    lower.hang_on_the_world(&tree);
    for (index, joint) in graph.joints.iter().enumerate() {
        if let Some(Hangs { on, is_reversed, .. }) = tree.joints[index].map(|body| tree.above[body]) {
            let body = tree.joints[index].unwrap_or_default();
            lower.joint(index, joint, (on, body), is_reversed, log);
        }
    }
    lower.mimics(log);
    lower.frames(log);
    report_held(graph, &tree, options, log);
    if graph.is_exhausted() {
        let element = graph.nodes[WORLD].element;
        element.error((&Subject::Document, "pose"), Code::TooLarge, "very long chains of frames", "shorter ones", log);
    }
    let Lower { description, start, planes, .. } = lower;
    let home = (!start.is_empty()).then(|| Keyframe { name: "poses".to_owned(), q: start, ..Keyframe::default() });
    Some(Document { description, world: World { gravity: graph.gravity, home, planes, ..World::default() } })
}

/// Connection of a body to its parent.
#[derive(Clone, Copy)]
struct Hangs {
    /// The body before it.
    on: usize,
    /// Its joint; `None` for a body on the world without a joint.
    joint: Option<usize>,
    /// Whether it is the parent of the joint.
    is_reversed: bool,
}

/// Which joint each body hangs on. Body 0 is the world.
struct Tree {
    above: Vec<Hangs>,
    /// For each joint, the body that hangs on it.
    joints: Vec<Option<usize>>,
    /// Whether a body without a joint is fixed to the world, rather than free.
    is_static: Vec<bool>,
    /// All bodies, each after the one that it hangs on.
    order: Vec<usize>,
}

impl Tree {
    fn of(graph: &Graph<'_>, log: &mut Diagnostics) -> Option<Self> {
        let count = graph.links.len() + 1;
        let is_static: Vec<bool> = std::iter::once(true).chain(graph.links.iter().map(|link| link.is_static)).collect();
        let ends: Vec<[usize; 2]> = graph.joints.iter().map(|joint| [graph.bodies[joint.parent_node], graph.bodies[joint.node]]).collect();
        let mut groups = Groups::of(count);
        (1..count).filter(|body| is_static[*body]).for_each(|body| {
            groups.join(WORLD, body);
        });
        let (mut beside, mut has_joint_above, mut loops) = (vec![Vec::new(); count], vec![false; count], Vec::new());
        let mut is_good = true;
        for (index, (joint, [parent, child])) in graph.joints.iter().zip(&ends).enumerate() {
            let about = subject(joint.element);
            if is_static[*parent] && is_static[*child] {
                joint.element.unused(&about, None, "its links belong to a static model", log);
            } else if parent == child {
                let found = "a parent and a child that are frames of one link";
                joint.element.error((&about, "child"), Code::Ring, found, "two links", log);
                is_good = false;
            } else if joint.is_cut {
                let expected = "no loop: the model is the one without this joint";
                joint.element.warning((&about, "must_be_loop_joint"), Code::LostDynamics, "a loop that is cut here", expected, log);
            } else if groups.join(*parent, *child) {
                beside[*parent].push((index, *child, false));
                beside[*child].push((index, *parent, true));
                has_joint_above[*child] = true;
            } else {
                loops.push(index);
            }
        }
        let mut tree = Self {
            above: vec![Hangs { on: WORLD, joint: None, is_reversed: false }; count],
            joints: vec![None; graph.joints.len()],
            is_static,
            order: Vec::with_capacity(count),
        };
        let mut is_reached = vec![false; count];
        let statics = (1..count).filter(|body| tree.is_static[*body]);
        // The first body of each group that is not a child, or else the first one.
        let roots = (1..count).filter(|body| !has_joint_above[*body]).chain(1..count);
        for root in std::iter::once(WORLD).chain(statics.collect::<Vec<_>>()).chain(roots) {
            let mut next = VecDeque::from([root]);
            while let Some(body) = next.pop_front() {
                // Those in a static model hang on the world already.
                if std::mem::replace(&mut is_reached[body], true) {
                    continue;
                }
                tree.order.push(body);
                for (joint, other, is_reversed) in &beside[body] {
                    if !is_reached[*other] && !tree.is_static[*other] {
                        tree.above[*other] = Hangs { on: body, joint: Some(*joint), is_reversed: *is_reversed };
                        tree.joints[*joint] = Some(*other);
                        next.push_back(*other);
                    }
                }
            }
        }
        tree.report_loops(graph, &loops, &ends, log);
        (is_good && loops.is_empty()).then_some(tree)
    }

    fn report_loops(&self, graph: &Graph<'_>, loops: &[usize], ends: &[[usize; 2]], log: &mut Diagnostics) {
        let mut depths = vec![0_usize; self.above.len()];
        self.order.iter().skip(1).for_each(|body| depths[*body] = depths[self.above[*body].on] + 1);
        for index in loops.iter().take(MOST_LOOPS) {
            let [mut a, mut b] = ends[*index];
            let mut joints = vec![*index];
            while a != b && joints.len() <= MOST_LISTED {
                let lower = if depths[a] > depths[b] { &mut a } else { &mut b };
                joints.extend(self.above[*lower].joint);
                *lower = self.above[*lower].on;
            }
            let names =
                listed(joints.iter().take(MOST_LISTED).map(|joint| graph.nodes[graph.joints[*joint].node].name.as_str()).map(quote));
            let element = graph.joints[*index].element;
            let expected = "a tree of links; <physics><simbody><must_be_loop_joint>true in one of them cuts the loop there";
            element.error((&subject(element), "child"), Code::Ring, format!("a loop of the joints {names}"), expected, log);
        }
        if loops.len() > MOST_LOOPS {
            let element = graph.nodes[WORLD].element;
            let found = format!("{} more loops", loops.len() - MOST_LOOPS);
            element.error((&Subject::Document, "joint"), Code::Ring, found, "a tree of links", log);
        }
    }
}

/// Groups of bodies that are connected (Tarjan's union and find).
struct Groups(Vec<usize>);

impl Groups {
    fn of(count: usize) -> Self {
        Self((0..count).collect())
    }

    fn first(&mut self, mut body: usize) -> usize {
        while self.0[body] != body {
            self.0[body] = self.0[self.0[body]];
            body = self.0[body];
        }
        body
    }

    /// Whether they were not connected before.
    fn join(&mut self, a: usize, b: usize) -> bool {
        let (a, b) = (self.first(a), self.first(b));
        self.0[a.max(b)] = a.min(b);
        a != b
    }
}

/// One degree of freedom of a joint, or two of a universal joint, in axes of the link that it
/// moves.
struct Motion {
    name: String,
    kind: JointKind,
    axis: Vector,
    second_axis: Vector,
    limit: Option<Limit>,
    dynamics: articulated_core::description::JointDynamics,
    /// Index of the joint's axis.
    of: usize,
}

struct Lower<'a, 'g> {
    graph: &'g Graph<'a>,
    description: Description,
    /// Names of links and frames, and of joints, that are taken.
    links: Taken,
    joints: Taken,
    /// For each joint, the description's joints of its first axis and of its second.
    first: Vec<Option<[JointId; 2]>>,
    /// Names of `<frame>`s, in their order.
    frames: Vec<String>,
    /// The non-zero coordinates of free joints at the poses of the file.
    start: Vec<(String, Vec<f64>)>,
    /// Planes of links that do not move.
    planes: Vec<Plane>,
    /// Nodes of joints that others follow.
    leaders: BTreeSet<usize>,
}

impl Lower<'_, '_> {
    /// The world and all links, and the names of links and joints.
    fn links(&mut self, options: &Options, log: &mut Diagnostics) {
        self.description.links.push(Link { name: WORLD_NAME.to_owned(), ..Link::default() });
        for link in &self.graph.links {
            let name = self.links.free(self.graph.nodes[link.node].name.clone());
            let collision = shapes::collisions(link, self.graph, options, &mut self.planes, log);
            let visual = shapes::visuals(link, self.graph, options, log);
            let inertial = link.inertial.or_else(|| auto::inertial(link, self.graph, options, log));
            self.description.links.push(Link { name, inertial, collision, visual, intermediate: false });
        }
        let frames = self.graph.nodes.iter().filter(|node| node.what == What::Frame);
        self.frames = frames.map(|frame| self.links.free(frame.name.clone())).collect();
        for joint in &self.graph.joints {
            self.joints.insert(self.graph.nodes[joint.node].name.clone());
        }
    }

    fn node(&self, body: usize) -> usize {
        body.checked_sub(1).map_or(WORLD, |link| self.graph.links[link].node)
    }

    /// Free joints, and fixed ones for the links of static models.
    fn hang_on_the_world(&mut self, tree: &Tree) {
        for body in tree.order.iter().copied().filter(|body| *body != WORLD && tree.above[*body].joint.is_none()) {
            let name = self.description.links[link_id(body)].name.clone();
            let pose = self.graph.relative(WORLD, self.node(body));
            let (kind, word, origin) = match tree.is_static[body] {
                true => (JointKind::Fixed, "fixed", pose.origin()),
                false => (JointKind::Floating, "free", Origin::default()),
            };
            let name = self.joints.free(format!("{name}_{word}"));
            if kind == JointKind::Floating && pose != Pose::default() {
                let ([x, y, z, w], [px, py, pz]) = (scalar_last(pose.rotation), pose.position);
                self.start.push((name.clone(), vec![px, py, pz, x, y, z, w]));
            }
            self.description.joints.push(Joint { name, kind, parent: LinkId(0), child: link_id(body), origin, ..Joint::default() });
        }
    }

    fn joint(&mut self, index: usize, joint: &joints::Joint<'_>, (on, body): (usize, usize), is_reversed: bool, log: &mut Diagnostics) {
        let graph = self.graph;
        let (before, own) = (self.node(on), self.node(body));
        let name = graph.nodes[joint.node].name.clone();
        if is_reversed {
            let why = "the tree reaches the parent from the child: the joint is reversed, with the same coordinate";
            joint.parent.element.unused(&subject(joint.element), None, why, log);
        }
        let anchor = graph.relative(own, joint.node).position;
        let motions = self.motions(joint, &name, own, is_reversed, log);
        let is_beside = motions.iter().any(|motion| match motion.kind {
            JointKind::Prismatic => false,
            JointKind::Spherical | JointKind::Universal => anchor != [0.0; 3],
            _ => cross(anchor, motion.axis) != [0.0; 3],
        });
        let mut pose = graph.relative(before, own);
        if is_beside {
            pose.position = graph.relative(before, joint.node).position;
        }
        if !pose.position.iter().chain(&pose.rotation).chain(&anchor).all(|x| x.is_finite()) {
            joint.element.error((&subject(joint.element), "pose"), Code::NotFinite, "a pose beyond all numbers", "finite poses", log);
        }
        let (on, body) = (link_id(on), link_id(body));
        let link = self.description.links[body].name.clone();
        let (mut parent, mut origin) = (on, pose.origin());
        let mut indices = [self.description.joints.next_id(); 2];
        let last = motions.len();
        let dummy = |lower: &mut Self, number: usize| {
            let name = lower.links.free(format!("{link}_{number}"));
            lower.description.links.push(Link { name, intermediate: true, ..Link::default() })
        };
        for (k, motion) in motions.into_iter().enumerate() {
            let child = if k + 1 == last && !is_beside { body } else { dummy(self, k + 1) };
            let of = motion.of;
            let Motion { name, kind, axis, second_axis, limit, dynamics, .. } = motion;
            let pitch = if kind == JointKind::Helical { joint.pitch } else { 0.0 };
            let joint = Joint { name, kind, parent, child, origin, axis, second_axis, pitch, limit, dynamics, ..Joint::default() };
            indices[of] = self.description.joints.push(joint);
            (parent, origin) = (child, Origin::default());
        }
        if is_beside || last == 0 {
            let (name, origin) = match last {
                0 => (name, origin),
                _ => (self.joints.free(format!("{name}_fixed")), Origin::at(scale(anchor, -1.0))),
            };
            self.description.joints.push(Joint { name, kind: JointKind::Fixed, parent, child: body, origin, ..Joint::default() });
        }
        if last > 0 {
            self.first[index] = Some(indices);
        }
    }

    /// The motions of a joint, in the order from the parent link.
    fn motions(&mut self, joint: &joints::Joint<'_>, name: &str, own: usize, is_reversed: bool, log: &mut Diagnostics) -> Vec<Motion> {
        let about = subject(joint.element);
        let axis_of = |axis: &Axis<'_>| {
            let turn = self.graph.relative(own, axis.frame.unwrap_or(joint.node)).rotation;
            let turned = rotate(turn, axis.direction);
            let largest = turned.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
            // Rounding errors are set to zero.
            turned.map(|x| if x.abs() <= 4.0 * f64::EPSILON * largest { 0.0 } else { x }).map(|x| if is_reversed { -x + 0.0 } else { x })
        };
        let plain = |name: String, kind: JointKind| Motion {
            name,
            kind,
            axis: Joint::default().axis,
            second_axis: [0.0; 3],
            limit: None,
            dynamics: articulated_core::description::JointDynamics::default(),
            of: 0,
        };
        match (joint.kind, joint.axes.as_slice()) {
            (Type::Ball, _) => return vec![plain(name.to_owned(), JointKind::Spherical)],
            (Type::Universal, [first, second])
                if first.is_plain() && second.is_plain() && !is_reversed && !self.leaders.contains(&joint.node) =>
            {
                let (axis, second_axis) = (axis_of(first), axis_of(second));
                if cross(axis, second_axis) == [0.0; 3] {
                    let found = "two axes of one direction";
                    second.element.error((&about, "axis2"), Code::ParallelAxes, found, "an axis across the first", log);
                }
                return vec![Motion { axis, second_axis, ..plain(name.to_owned(), JointKind::Universal) }];
            }
            _ => {}
        }
        let mut motions: Vec<Motion> = joint
            .axes
            .iter()
            .enumerate()
            .map(|(k, axis)| Motion {
                name: if k == 0 { name.to_owned() } else { String::new() },
                kind: axis.kind,
                axis: axis_of(axis),
                second_axis: [0.0; 3],
                limit: axis.limit,
                dynamics: axis.dynamics,
                of: k,
            })
            .collect();
        for motion in motions.iter_mut().skip(1) {
            motion.name = self.joints.free(format!("{name}_2"));
        }
        if is_reversed {
            motions.reverse();
        }
        motions
    }

    /// Joints that follow others.
    fn mimics(&mut self, log: &mut Diagnostics) {
        let graph = self.graph;
        let by_node: HashMap<usize, usize> = graph.joints.iter().enumerate().map(|(index, joint)| (joint.node, index)).collect();
        for (index, joint) in graph.joints.iter().enumerate() {
            let about = subject(joint.element);
            for (k, axis) in joint.axes.iter().enumerate() {
                let Some(mimic) = axis.mimic else { continue };
                let element = mimic.leader.element;
                let Some(leader) = graph.find_joint(&mimic.leader).and_then(|node| by_node.get(&node).copied()) else {
                    element.error(
                        (&about, "joint"),
                        Code::UnknownLeader,
                        quote(mimic.leader.name),
                        "the name of a joint of this model",
                        log,
                    );
                    continue;
                };
                let Some(follower) = self.first[index].map(|first| first[k]) else {
                    element.unused(&about, None, "the joint is cut, or belongs to a static model", log);
                    continue;
                };
                let moves = self.first[leader].map(|first| first[mimic.axis]);
                let is_one = |j: JointId| self.description.joints[j].kind.sizes() == (1, 1);
                let has_axis = mimic.axis < graph.joints[leader].axes.len();
                let Some(leads) = moves.filter(|leads| has_axis && is_one(*leads)) else {
                    let found = format!("{}, which has no such coordinate", quote(mimic.leader.name));
                    element.error((&about, "joint"), Code::LeaderCannotLead, found, "a joint that moves about or along this axis", log);
                    continue;
                };
                let mimic = Mimic::linear(leads, mimic.multiplier, mimic.offset);
                self.description.joints[follower].mimic = Some(mimic);
            }
        }
        let joints = &self.description.joints;
        let on = |joint: usize| joints[JointId(joint)].mimic.map(|mimic| mimic.joint.0);
        for joint in cycles(joints.len(), on).into_iter().map(JointId) {
            let names = listed(around(joint.0, on).take(MOST_LISTED).map(|joint| quote(&joints[JointId(joint)].name)));
            let about = Subject::Joint(joints[joint].name.clone());
            let node = graph.joints.iter().zip(&self.first).find(|(_, first)| first.is_some_and(|first| first.contains(&joint)));
            let element = node.map_or(graph.nodes[WORLD].element, |(joint, _)| joint.element);
            element.error(
                (&about, "mimic"),
                Code::MimicRing,
                format!("a ring of followers: {names}"),
                "a leader that moves by itself",
                log,
            );
        }
    }

    fn frames(&mut self, log: &mut Diagnostics) {
        let names = std::mem::take(&mut self.frames);
        let frames = self.graph.nodes.iter().enumerate().filter(|(_, node)| node.what == What::Frame);
        for ((index, node), name) in frames.zip(names) {
            let body = self.graph.bodies[index];
            let (link, origin) = (link_id(body), self.graph.relative(self.node(body), index).origin());
            if name != node.name {
                let why = format!("a link has this name: the frame is called {}", quote(&name));
                node.element.unused(&Subject::Document, node.element.attribute("name"), &why, log);
            }
            self.description.frames.push(Frame { name, link, origin });
        }
    }
}

/// The link of a body of the graph: the world is the first one of both.
fn link_id(body: usize) -> LinkId {
    LinkId(body)
}

/// Reports mass that the fixed world carries.
fn report_held(graph: &Graph<'_>, tree: &Tree, options: &Options, log: &mut Diagnostics) {
    let mut is_held = vec![false; tree.above.len()];
    for body in &tree.order {
        let Hangs { on, joint, .. } = tree.above[*body];
        let is_fixed = joint.map_or(tree.is_static[*body], |joint| graph.joints[joint].kind == Type::Fixed);
        is_held[*body] = *body == WORLD || is_fixed && is_held[on];
        if *body == WORLD || !is_held[*body] || options.base != Base::Fixed {
            continue;
        }
        let link = &graph.links[*body - 1];
        if link.inertial.is_some_and(|inertial| inertial.mass != 0.0) {
            link.element.unused(&subject(link.element), None, HELD, log);
        }
    }
}
