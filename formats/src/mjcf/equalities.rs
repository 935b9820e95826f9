//! The section `<equality>`: equations of joints and tendons, and loops.

use articulated_core::description::Coupling;
use articulated_core::diagnostic::{Code, Diagnostics, Subject};

use super::anchors;
use super::bodies::Kind;
use super::contact::{IMPEDANCE, REFERENCE};
use super::element::Element;
use super::scope::{References, Scope, Sort};
use super::tendons::{Tendon, length_of};
use super::values::Values;
use crate::world::{Loop, TouchingAnchor, TouchingLaw, TouchingLength, TouchingSum, World};

const OFF: &str = "the equation is not active";
const FLAG: &str = "a flag of <option> turns equations off";
const LOOP: &str = "loops are not read: the motion does not keep this equation";
const SUM: &str = "functions with constraints alone keep this equation";
const APPLY: &str = "`--coupling file` (key `coupling = \"file\"`, method `Build::file_coupling`), which applies it, or functions with constraints: other motions do not keep this equation";

/// Reads all equations. Returns those of joints and fixed tendons, and those of bodies and sites.
pub(crate) fn equalities(
    scope: &mut Scope<'_>,
    (tendons, links): (&[Tendon], &[&str]),
    is_off: bool,
    world: &mut World,
    log: &mut Diagnostics,
) -> (Vec<TouchingSum>, Vec<TouchingAnchor>) {
    let (mut sums, mut all) = (Vec::new(), Vec::new());
    for index in 0..scope.tree.parts.len() {
        if scope.is_full() {
            break;
        }
        let part = scope.part(index);
        for element in part.settings.equations.iter().copied() {
            let is_anchor = element.is("connect") || element.is("weld");
            let references = if is_anchor { anchors::references(element, log) } else { references(element, log) };
            let Some(found) = scope.resolve(index, element, &references, log) else { continue };
            let class = part.settings.classes.find(element, "class", log).unwrap_or(0);
            let values = Values::new(element, part.settings.classes.tags(class, "equality"), &Subject::Document);
            let polynomial = values.at_most("polycoef", [0.0, 1.0, 0.0, 0.0, 0.0], log);
            let is_active = values.yes("active", log).unwrap_or(true);
            if is_off || !is_active {
                scope.unread(element, if is_off { FLAG } else { OFF }, None, log);
                continue;
            }
            let place = scope.place(element);
            let soft = (values.at_most("solref", REFERENCE, log), values.at_most("solimp", IMPEDANCE, log));
            let name = scope.full(index, element).unwrap_or_default();
            let what = format!("the equation {name:?} of {}", references.iter().map(|(.., own)| *own).collect::<Vec<_>>().join(" and "));
            if is_anchor && (found.len() == 2 || references.iter().all(|(sort, ..)| *sort == Sort::Body)) && log.is_ok() {
                all.push(anchors::anchor(element, &found, (&values, links), scope, (what.clone(), soft.0, soft.1), log));
            }
            let sum = sum(element, &found, polynomial, scope, tendons).map(|(length, law)| TouchingSum {
                what,
                length,
                law,
                is_of_tendons: element.is("tendon"),
                coupling: None,
                reference: soft.0,
                impedance: soft.1,
            });
            match coupling(element, &found, polynomial, scope, tendons) {
                Ok(coupling) => {
                    // The field is the name of the option that withdraws the warning.
                    scope.warn(element, "coupling", ("an equation of joints", APPLY), log);
                    sums.extend(sum.map(|sum| TouchingSum { coupling: Some(coupling.joint.clone()), ..sum }));
                    world.couplings.push((coupling, place));
                }
                Err(kind) => {
                    let is_computed = sum.is_some() || is_anchor;
                    let (why, expected) = match is_computed {
                        true => (SUM, "functions with constraints: other motions do not keep this equation"),
                        false => (LOOP, "a tree: the motion does not keep this equation"),
                    };
                    scope.unread(element, why, Some((kind, expected)), log);
                    sums.extend(sum);
                    let full = |own: &str| format!("{}{own}{}", part.prefix, part.suffix);
                    world.loops.push(Loop {
                        name,
                        kind: element.name.clone(),
                        between: references.iter().map(|(_, _, own)| full(own)).collect(),
                        is_computed,
                        place,
                    });
                }
            }
        }
    }
    (sums, all)
}

/// The length and the law of an equation of joints or of tendons.
fn sum(
    element: &Element,
    found: &[usize],
    coefficients: [f64; 5],
    scope: &Scope<'_>,
    tendons: &[Tendon],
) -> Option<(TouchingLength, TouchingLaw)> {
    let is_number = |joint: usize| is_number(scope, joint);
    let of = |index: &usize| match element.name.as_str() {
        "joint" => is_number(*index).then(|| length_of(&[(*index, 1.0)], scope)),
        "tendon" if tendons[*index].terms().iter().all(|(joint, _)| is_number(*joint)) => tendons[*index].length(scope),
        _ => None,
    };
    let mut lengths = found.iter().map(of).collect::<Option<Vec<(TouchingLength, f64)>>>()?.into_iter();
    let ((first, at_reference), second) = (lengths.next()?, lengths.next());
    let references = [at_reference, second.as_ref().map_or(0.0, |(_, length)| *length)];
    Some((first, TouchingLaw::Equation { other: second.map(|(length, _)| length), references, coefficients }))
}

fn references<'a>(element: &'a Element, log: &mut Diagnostics) -> References<'a> {
    const ALL: [(&str, Sort, &str); 4] = [
        ("joint", Sort::Joint, "joint1"),
        ("joint", Sort::Joint, "joint2"),
        ("tendon", Sort::Tendon, "tendon1"),
        ("tendon", Sort::Tendon, "tendon2"),
    ];
    let own = ALL.iter().filter(|(tags, ..)| tags.split(' ').any(|tag| element.is(tag)));
    for (_, _, field) in own.clone().filter(|(_, _, field)| matches!(*field, "joint1" | "tendon1") && element.attribute(field).is_none()) {
        element.error((&Subject::Document, field), Code::MissingAttribute, "none", format!("the attribute {field}"), log);
    }
    own.filter_map(|(_, sort, field)| Some((*sort, *field, element.text(field)?))).collect()
}

/// Solves Σ aᵢ (qᵢ − refᵢ) = c₀ for the first coordinate, or a₁ (q₁ − ref₁) = Σ cₖ (a₂ (q₂ −
/// ref₂))ᵏ. The error states why it has no solution.
fn coupling(
    element: &Element,
    found: &[usize],
    [c0, c1, c2, c3, c4]: [f64; 5],
    scope: &Scope<'_>,
    tendons: &[Tendon],
) -> Result<Coupling, &'static str> {
    let of = |index: usize| match element.is("joint") {
        true => vec![(index, 1.0)],
        false => tendons[index].terms().to_vec(),
    };
    let (first, second) = match (element.name.as_str(), found) {
        ("joint" | "tendon", [first]) => (of(*first), Vec::new()),
        ("joint" | "tendon", [first, second]) => (of(*first), of(*second)),
        ("connect", _) => return Err("a loop that is closed at a point"),
        ("weld", _) => return Err("a loop of bodies that are welded"),
        _ => return Err("an equation of deformable bodies"),
    };
    if first.is_empty() || (second.is_empty() && found.len() > 1) {
        return Err("an equation of spatial tendons");
    }
    if !second.is_empty() && [c2, c3, c4] != [0.0; 3] {
        return polynomial([&first, &second], [c0, c1, c2, c3, c4], scope);
    }
    // l₁ − l₁(ref) = c₀ + c₁ (l₂ − l₂(ref))
    let mut terms = first;
    for (joint, factor) in second {
        let factor = -c1 * factor;
        match terms.iter_mut().find(|(known, _)| *known == joint) {
            Some((_, sum)) => *sum += factor,
            None => terms.push((joint, factor)),
        }
    }
    terms.retain(|(_, factor)| *factor != 0.0);
    if !terms.iter().all(|(joint, _)| is_number(scope, *joint)) {
        return Err(SEVERAL);
    }
    let Some(((joint, own), leaders)) = terms.split_first().filter(|(_, leaders)| !leaders.is_empty()) else {
        return Err("an equation that holds one joint");
    };
    let name = |joint: usize| scope.joints[joint].name.to_owned();
    let reference = |joint: usize| scope.joints[joint].joint.reference;
    let at_reference: f64 = terms.iter().map(|(joint, factor)| factor * reference(*joint)).sum();
    Ok(Coupling {
        joint: name(*joint),
        leaders: leaders.iter().map(|(leader, factor)| (name(*leader), -factor / own)).collect(),
        offset: (c0 + at_reference) / own,
        ..Coupling::default()
    })
}

const SEVERAL: &str = "an equation of joints with several coordinates";

/// An equation of higher degree between lengths that are one joint each.
fn polynomial(lengths: [&[(usize, f64)]; 2], coefficients: [f64; 5], scope: &Scope<'_>) -> Result<Coupling, &'static str> {
    let [[(joint, own)], [(leader, factor)]] = lengths else {
        return Err("an equation of higher degree between tendons of several joints");
    };
    if !is_number(scope, *joint) || !is_number(scope, *leader) {
        return Err(SEVERAL);
    }
    if joint == leader || *own == 0.0 {
        return Err("an equation that holds one joint");
    }
    // a₁ (q₁ − ref₁) = Σ cₖ a₂ᵏ (q₂ − ref₂)ᵏ
    let reference = |joint: usize| scope.joints[joint].joint.reference;
    let mut scale = 1.0 / own;
    let mut powers = coefficients.map(|c| {
        let found = c * scale;
        scale *= factor;
        found
    });
    powers[0] += reference(*joint);
    let [joint, leader_name] = [*joint, *leader].map(|joint| scope.joints[joint].name);
    Coupling::polynomial(joint, leader_name, &powers, reference(*leader)).map_err(|_| "an equation whose coefficients overflow")
}

/// Whether a joint has one coordinate.
fn is_number(scope: &Scope<'_>, joint: usize) -> bool {
    matches!(scope.joints[joint].joint.kind, Kind::Hinge | Kind::Slide)
}
