//! What xacro should have replaced.

pub(crate) use crate::xml::number::is_expression;

use crate::xml::element::Tag;
use articulated_core::diagnostic::{Code, Diagnostics, Place, Subject, quote};

const EXPECTED: &str = "an expanded file: run xacro first";

/// Reports macros and expressions that are left over. Whether there are macros: without what they
/// stand for, the rest of the file means nothing.
pub(crate) fn report(robot: &Tag<'_>, log: &mut Diagnostics) -> bool {
    report_expressions(robot, log);
    let mut macros = false;
    for child in robot.children() {
        if is_macro(&child) {
            macros |= report_macro(&child, log);
        } else if child.is("link") || child.is("joint") {
            let name = child.name_for_messages();
            let subject = if child.is("link") { Subject::Link(name) } else { Subject::Joint(name) };
            // Content of other tags (of plugins, say) is not used and may hold anything.
            for tag in child.of(&subject).descendants() {
                match is_macro(&tag) {
                    true => macros |= report_macro(&tag, log),
                    false => report_expressions(&tag, log),
                }
            }
        }
    }
    macros
}

fn is_macro(tag: &Tag<'_>) -> bool {
    tag.name().starts_with("xacro:")
}

fn report_macro(tag: &Tag<'_>, log: &mut Diagnostics) -> bool {
    log.error(tag.place("xacro"), Code::Xacro, format!("the tag <{}>", tag.name()), EXPECTED);
    true
}

/// Names of files are left out: meshes and textures play no part in the dynamics.
fn report_expressions(tag: &Tag<'_>, log: &mut Diagnostics) {
    for (name, value, at) in tag.attributes_with_lines().filter(|(name, value, _)| *name != "filename" && is_expression(value)) {
        let field = format!("{} {name}", tag.name());
        let place = Place { at, ..tag.place(&field) };
        log.error(place, Code::Xacro, format!("the xacro expression {}", quote(value)), EXPECTED);
    }
}
