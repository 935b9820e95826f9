//! Elements that change the motion and are not read: errors, or warnings where an option leaves
//! them out.

use std::collections::BTreeSet;

use articulated_core::diagnostic::{Code, Diagnostics, quote};

use super::element::Element;
use super::grammar::subject;
use crate::LeaveOut;

/// The elements that the options leave out, and the reported ones.
pub(crate) struct Gate<'a> {
    leave_out: &'a BTreeSet<LeaveOut>,
    /// By the addresses of the tags: a document may be in the tree several times.
    reported: BTreeSet<*const Element>,
}

impl<'a> Gate<'a> {
    pub(crate) fn new(leave_out: &'a BTreeSet<LeaveOut>) -> Self {
        Self { leave_out, reported: BTreeSet::new() }
    }

    /// Reports a tag, once.
    pub(crate) fn report(&mut self, element: &Element, kind: LeaveOut, what: &str, log: &mut Diagnostics) {
        if !self.reported.insert(element) {
            return;
        }
        let name = ["name", "plugin", "instance", "prefix"].iter().find_map(|field| element.text(field)).unwrap_or_default();
        let name = if name.is_empty() { String::new() } else { format!(" {}", quote(name)) };
        let found = format!("{what}{name}");
        let subject = subject(element);
        if self.leave_out.contains(&kind) {
            let expected = format!("a robot without it: `leave_out` has {}, and the motion is that without it", quote(kind.name()));
            element.warning((&subject, &element.name), Code::LostDynamics, found, expected, log);
        } else {
            let expected = format!("a robot without it; {} leaves it out", kind.option());
            element.error((&subject, &element.name), Code::Unsupported, found, expected, log);
        }
    }

    /// Reports the plugin of a geom or of its mesh, and returns whether there is one.
    pub(crate) fn has_plugin(&mut self, element: &Element, what: &str, log: &mut Diagnostics) -> bool {
        let plugins: Vec<&Element> = element.all("plugin").collect();
        for plugin in &plugins {
            self.report(plugin, LeaveOut::Plugin, what, log);
        }
        !plugins.is_empty()
    }

    /// Reports the flexible bodies of a document.
    pub(crate) fn document(&mut self, root: &Element, log: &mut Diagnostics) {
        for flex in root.all("deformable").flat_map(|section| section.all("flex")) {
            self.report(flex, LeaveOut::Flex, "a flexible body", log);
        }
    }

    /// Reports unread elements of a body.
    pub(crate) fn body(&mut self, element: &Element, log: &mut Diagnostics) {
        match element.name.as_str() {
            "flexcomp" => self.report(element, LeaveOut::Flex, "a flexible body", log),
            "composite" => self.report(element, LeaveOut::Composite, "a composite of bodies", log),
            "plugin" => self.report(element, LeaveOut::Plugin, "a plugin of a body", log),
            // Other unused tags have been reported.
            _ => {}
        }
    }
}
