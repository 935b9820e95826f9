//! Files that still have to go through xacro.

use crate::element::Tag;
use crate::log::Log;
use crate::problem::{Kind, quote};

/// Whether macros are left over. Says so once: what else is wrong with such a file means nothing.
pub(crate) fn is_left_over(robot: &Tag<'_>, log: &mut Log) -> bool {
    let found = robot.children().find_map(|child| left_over_in(&child)).or_else(|| robot_name(robot));
    let Some((tag, found)) = found else {
        return false;
    };
    log.error(&tag.place("xacro"), Kind::Xacro, found, "an expanded file: run xacro first");
    true
}

fn robot_name<'a>(robot: &Tag<'a>) -> Option<(Tag<'a>, String)> {
    Some((*robot, expression(robot)?))
}

/// Content of other tags (of plugins, say) is not used and may hold anything.
fn left_over_in<'a>(child: &Tag<'a>) -> Option<(Tag<'a>, String)> {
    if is_macro(child) {
        return Some((*child, format!("the tag <{}>", child.name())));
    }
    if !(child.is("link") || child.is("joint")) {
        return None;
    }
    child.descendants().find_map(|tag| match is_macro(&tag) {
        true => Some((tag, format!("the tag <{}>", tag.name()))),
        false => Some((tag, expression(&tag)?)),
    })
}

fn is_macro(tag: &Tag<'_>) -> bool {
    tag.name().starts_with("xacro:")
}

fn expression(tag: &Tag<'_>) -> Option<String> {
    let value = tag.attributes().map(|a| a.value()).find(|v| v.contains("${") || v.contains("$("))?;
    Some(format!("the expression {}", quote(value)))
}
