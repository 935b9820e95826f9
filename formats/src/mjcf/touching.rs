//! Limits, dry friction and contacts of a model, and the section `<contact>`.

use std::collections::{BTreeMap, BTreeSet};

use articulated_core::diagnostic::{Code, Diagnostics, Subject};

use super::bodies::Kind;
use super::contact::{Both, DIMENSION, FRICTION, IMPEDANCE, REFERENCE, dimension};
use super::mass::Mass;
use super::scope::{Scope, Sort};
use super::simulation::Simulation;
use super::tendons::{Course, Tendon};
use super::values::Values;
use crate::LeaveOut;
use crate::world::{Touching, TouchingFriction, TouchingLaw, TouchingLimit, TouchingPair, TouchingShape, TouchingSum, Unread};

/// The least coefficient of friction in MuJoCo.
const LEAST_FRICTION: f64 = 1e-5;
/// Maximum number of pairs of shapes, and of those that are examined: functions of constraints are
/// refused beyond them.
const MOST_PAIRS: usize = 100_000;
const MOST_EXAMINED: usize = 20_000_000;

/// What touches. `links`: the name of the link of each body.
pub(crate) fn touching(
    scope: &mut Scope<'_>,
    inertials: &[Option<Mass>],
    links: &[&str],
    (simulation, tendons): (&Simulation<'_>, &[Tendon]),
    log: &mut Diagnostics,
) -> Touching {
    let flags = simulation.flags();
    let mut all = Touching {
        cone: simulation.cone.unwrap_or_default(),
        impedance_ratio: simulation.impedance_ratio.unwrap_or(1.0),
        safe_step: (!flags.any_time_constant).then(|| simulation.stepping().step),
        bodies: bodies(scope, inertials, links),
        ..Touching::default()
    };
    joints(scope, flags.no_limit, &mut all);
    let mut names: Vec<String> = Vec::new();
    for (body, place) in &scope.geoms {
        let geom = &scope.tree.bodies[*body].geoms[*place];
        if geom.surface.is_unread && geom.collides() {
            names.push(geom.name.clone().unwrap_or_else(|| "without a name".to_owned()));
        }
    }
    let mut unread = |kind: LeaveOut, what: String| all.unread.push(Unread { kind, what, place: Default::default() });
    if let Some(solver) = simulation.solver.filter(|solver| *solver != "Newton") {
        unread(LeaveOut::Solver, format!("the solver {solver}: Newton's method finds the optimum"));
    }
    if simulation.noslip > 0 {
        unread(LeaveOut::Solver, "noslip_iterations: Newton's method finds the optimum, and contacts slip softly".to_owned());
    }
    let mut unread = |what: String| unread(LeaveOut::Constraint, what);
    names.into_iter().for_each(|name| unread(format!("adhesion or surfacevel of the geom {name}")));
    let spatial = tendons.iter().filter(|tendon| matches!(tendon.course, Course::Unread));
    for (tendon, what) in spatial.filter_map(|tendon| Some((tendon, tendon.constraint()?))) {
        unread(format!("{what} of the tendon {}", tendon.name));
    }
    for flag in &simulation.constraint_flags {
        unread(format!("the flag {flag}"));
    }
    all.sums = tendons.iter().flat_map(|tendon| of_tendon(tendon, scope)).collect();
    if !flags.no_contact {
        contacts(scope, links, flags.parents_touch, &mut all, log);
    }
    all
}

fn bodies(scope: &Scope<'_>, inertials: &[Option<Mass>], links: &[&str]) -> Vec<(String, [f64; 3], bool)> {
    let tree = &scope.tree.bodies;
    let has_children: BTreeSet<usize> = tree.iter().skip(1).map(|body| body.parent).collect();
    let is_static = |index: usize| tree[index].joints.is_empty();
    let of = |(index, own): (usize, &Option<Mass>)| {
        let body = &tree[index];
        // In MuJoCo the centre of a body without mass is at its own `pos`, in its own frame.
        let center = own.map_or(body.pose.position, |own| own.pose.position);
        // MuJoCo's simple bodies without rotation
        let is_at_root = body.parent == 0 || (tree[body.parent].parent == 0 && is_static(body.parent));
        let is_plain = own.is_some_and(|own| own.pose.position == [0.0; 3] && own.axes.is_none_or(|axes| axes[1..] == [0.0; 3]));
        let along_axes = body.joints.iter().all(|joint| {
            let is_along = joint.axis.iter().filter(|x| x.abs() > 1e-14).count() == 1;
            joint.kind == Kind::Slide && joint.anchor == [0.0; 3] && is_along
        });
        let slides = !body.joints.is_empty() && along_axes && is_plain && is_at_root && !has_children.contains(&index);
        (links[index].to_owned(), center, slides)
    };
    inertials.iter().enumerate().map(of).collect()
}

/// Limits and dry friction of a tendon.
fn of_tendon(tendon: &Tendon, scope: &Scope<'_>) -> Vec<TouchingSum> {
    let Some((length, _)) = tendon.length(scope) else { return Vec::new() };
    let of = |what: &str, law: TouchingLaw, (reference, impedance): ([f64; 2], [f64; 5])| TouchingSum {
        what: format!("{what} of the tendon {}", tendon.name),
        length: length.clone(),
        law,
        is_of_tendons: true,
        coupling: None,
        reference,
        impedance,
    };
    let soft = &tendon.soft;
    let limit = TouchingLaw::Between { range: tendon.range, margin: soft.margin };
    let limit = tendon.is_limited.then(|| of("the limit", limit, soft.limit));
    let friction = (soft.loss != 0.0).then(|| of("dry friction", TouchingLaw::DryFriction(soft.loss), soft.friction));
    limit.into_iter().chain(friction).collect()
}

/// Limits and dry friction of joints.
fn joints(scope: &Scope<'_>, no_limit: bool, all: &mut Touching) {
    for known in &scope.joints {
        let (joint, soft, name) = (known.joint, known.joint.soft, known.name.to_owned());
        if let Some(limit) = joint.limit.filter(|_| joint.is_limited && !no_limit) {
            let range = if joint.kind == Kind::Ball { [0.0, limit.upper] } else { [limit.lower, limit.upper] };
            let (reference, impedance) = soft.limit;
            all.limits.push(TouchingLimit { joint: name.clone(), range, margin: soft.margin, reference, impedance });
        }
        if soft.loss != 0.0 {
            let (reference, impedance) = soft.friction;
            all.friction.push(TouchingFriction { joint: name, loss: soft.loss, reference, impedance });
        }
    }
}

/// The pairs of shapes: those of the section `<contact>`, and those that masks and the tree allow.
fn contacts(scope: &mut Scope<'_>, links: &[&str], parents_touch: bool, all: &mut Touching, log: &mut Diagnostics) {
    // A pair that is there twice makes contact twice.
    let mut chosen: Vec<TouchingPair> = Vec::new();
    let mut excluded: BTreeSet<[usize; 2]> = BTreeSet::new();
    for index in 0..scope.tree.parts.len() {
        if scope.is_full() {
            break;
        }
        let part = scope.part(index);
        for element in part.settings.contacts.iter().copied() {
            let (sort, fields) = match element.name.as_str() {
                "pair" => (Sort::Geom, ["geom1", "geom2"]),
                "exclude" => (Sort::Body, ["body1", "body2"]),
                _ => continue,
            };
            for field in fields.iter().filter(|field| element.attribute(field).is_none()) {
                element.error((&Subject::Document, field), Code::MissingAttribute, "none", format!("the attribute {field}"), log);
            }
            let is_world = |name: &str| sort == Sort::Body && name == "world";
            let names = fields.map(|field| element.text(field).unwrap_or_default());
            let references = fields.iter().zip(names).filter(|(_, name)| !name.is_empty() && !is_world(name));
            let references = references.map(|(field, name)| (sort, *field, name)).collect();
            let Some(found) = scope.resolve(index, element, &references, log) else { continue };
            let mut found = found.into_iter();
            let [Some(first), Some(second)] = names.map(|name| if is_world(name) { Some(0) } else { found.next() }) else { continue };
            let both = [first.min(second), first.max(second)];
            if sort == Sort::Body {
                excluded.insert(both);
                continue;
            }
            let class = part.settings.classes.find(element, "class", log).unwrap_or(0);
            let values = Values::new(element, part.settings.classes.tags(class, "pair"), &Subject::Document);
            chosen.push(pair(both, &values, log));
        }
    }
    let explicit: BTreeSet<[usize; 2]> = chosen.iter().map(|pair| pair.shapes).collect();
    if !automatic(scope, (&explicit, &excluded), parents_touch, &mut chosen) {
        let what = format!("very many pairs of geoms, of which {MOST_PAIRS} are computed at most");
        all.unread.push(Unread { kind: LeaveOut::Contact, what, place: Default::default() });
        chosen.clear();
    }
    keep(scope, links, chosen, all);
}

/// The numbers of a tag `<pair>`; what it does not have are MuJoCo's defaults, not those of the
/// geoms.
fn pair(shapes: [usize; 2], values: &Values<'_>, log: &mut Diagnostics) -> TouchingPair {
    let [slide, turn, roll] = FRICTION;
    TouchingPair {
        shapes,
        dimension: dimension(values, log).unwrap_or(DIMENSION) as usize,
        friction: values.at_most("friction", [slide, slide, turn, roll, roll], log),
        reference: values.at_most("solref", REFERENCE, log),
        reference_across: values.at_most("solreffriction", [0.0; 2], log),
        impedance: values.at_most("solimp", IMPEDANCE, log),
        margin: values.number("margin", log).unwrap_or(0.0),
    }
}

/// The pairs that masks and the tree allow; whether they are not too many.
fn automatic(
    scope: &Scope<'_>,
    (explicit, excluded): (&BTreeSet<[usize; 2]>, &BTreeSet<[usize; 2]>),
    parents_touch: bool,
    chosen: &mut Vec<TouchingPair>,
) -> bool {
    let (bodies, mut examined) = (&scope.tree.bodies, 0);
    // The body that each one is fixed to, and the parent of that one, fixed to another
    let mut fixed_to: Vec<usize> = Vec::with_capacity(bodies.len());
    for (index, body) in bodies.iter().enumerate() {
        fixed_to.push(if index == 0 || body.joints.is_empty() { if index == 0 { 0 } else { fixed_to[body.parent] } } else { index });
    }
    let above = |body: usize| fixed_to[bodies[fixed_to[body]].parent];
    let geoms: Vec<(usize, usize, &super::geometry::Geom<'_>)> = scope
        .geoms
        .iter()
        .enumerate()
        .map(|(k, (body, place))| (k, *body, &bodies[*body].geoms[*place]))
        .filter(|(.., geom)| geom.collides())
        .collect();
    for (k, (i, a, first)) in geoms.iter().enumerate() {
        examined += geoms.len() - k;
        if examined > MOST_EXAMINED || chosen.len() > MOST_PAIRS {
            return false;
        }
        for (j, b, second) in &geoms[k + 1..] {
            let [one, other] = [fixed_to[*a], fixed_to[*b]];
            let is_parent = one != 0 && other != 0 && (one == above(*b) || other == above(*a));
            let is_out = one == other || (is_parent && !parents_touch) || excluded.contains(&[*a.min(b), *a.max(b)]);
            if is_out || explicit.contains(&[*i, *j]) || !first.mask.meets(second.mask) {
                continue;
            }
            let Both { dimension, friction: [slide, turn, roll], reference, impedance } = first.surface.with(&second.surface);
            chosen.push(TouchingPair {
                shapes: [*i, *j],
                dimension: dimension as usize,
                friction: [slide, slide, turn, roll, roll],
                reference,
                reference_across: [0.0; 2],
                impedance,
                margin: first.surface.margin + second.surface.margin,
            });
        }
    }
    true
}

/// Keeps the shapes that are in a pair.
fn keep(scope: &Scope<'_>, links: &[&str], chosen: Vec<TouchingPair>, all: &mut Touching) {
    let mut places: BTreeMap<usize, usize> = BTreeMap::new();
    for mut pair in chosen {
        pair.friction = pair.friction.map(|mu| mu.max(LEAST_FRICTION));
        pair.shapes = pair.shapes.map(|shape| {
            *places.entry(shape).or_insert_with(|| {
                let (body, place) = scope.geoms[shape];
                let geom = &scope.tree.bodies[body].geoms[place];
                let (pose, form) = geom.form();
                let name = geom.name.clone().unwrap_or_else(|| format!("geom_{shape}"));
                let place = scope.place(geom.element);
                all.shapes.push(TouchingShape { name, link: links[body].to_owned(), origin: pose.origin(), form, place });
                all.shapes.len() - 1
            })
        });
        all.pairs.push(pair);
    }
}
