//! Xacro, the macro language of URDF files: properties, macros, conditions, included files and
//! expressions.
//!
//! A document is expanded into one without them. Each tag and each attribute of the expanded
//! document has the file, line and column of its source, so that findings of the URDF reader are
//! reported there. The crate `xacro-rs` (0.2.2) keeps no places, opens files by itself, has no
//! bound on the work, no `<xacro:element>`, no `… if … else …`, and brings a command line and a
//! logger: this is a separate reader.
//!
//! # What is read
//!
//! * `<xacro:property>` with `value`, `default`, `remove`, `scope`, `lazy_eval`, or a block.
//! * `<xacro:macro>` with defaults (`:=`), forwarded properties (`^`), `*block` and `**block`;
//!   `<xacro:call>`, `<xacro:insert_block>`.
//! * `<xacro:if>`, `<xacro:unless>`, `<xacro:arg>`, `<xacro:element>`, `<xacro:attribute>`.
//! * `<xacro:include>` with `ns`, `optional`, and `*`, `?` and `[…]` in the name of the file.
//! * `$(arg)`, `$(find)`, `$(env)`, `$(optenv)`, `$(dirname)`, `$(cwd)`, `$(eval)`.
//! * `${…}`: a part of Python, with numbers, texts, lists, dictionaries, comprehensions, methods of
//!   texts and dictionaries, and the functions of `math`, `python` and `xacro`; no lambda.
//! * `xacro.load_yaml`: block and flow mappings and sequences, quoted texts, anchors, and units.
//!
//! # Where it differs from the program `xacro`
//!
//! * All errors are reported, not only the first.
//! * `$(find name)` is `package://name` in the expanded document.
//! * An expression without a value in the `filename` of a tag is a warning: names of meshes do not
//!   affect the dynamics.
//! * Integers have 127 bits.
//!
//! # Bounds
//!
//! Depth, steps of evaluation, bytes of texts, included files, and the size of the expanded
//! document are bounded: no input makes the reader hang, overflow its stack, or take more than
//! 512 MB.

mod directives;
mod evaluate;
mod expander;
mod files;
mod functions;
mod operators;
mod scope;
mod source;
mod syntax;
mod text;
mod value;
mod work;
mod yaml;

use articulated_core::diagnostic::Diagnostics;
use roxmltree::{Document, Node};

pub(crate) use files::Packages;
pub use files::declares_package;
pub(crate) use source::Expanded;

use crate::Input;
use crate::xml::lines::Lines;
use crate::xml::number::is_expression;

/// Whether a document needs expansion: it has tags of xacro, or expressions in parts of the robot.
pub(crate) fn is_needed(document: &Document<'_>, file: &str) -> bool {
    let root = document.root_element();
    let has_expression = |node: Node<'_, '_>| node.attributes().any(|a| a.name() != "filename" && is_expression(a.value()));
    let is_part = |node: &Node<'_, '_>| node.has_tag_name("link") || node.has_tag_name("joint");
    file.ends_with(".xacro")
        || root.descendants().any(|node| node.is_element() && node.tag_name().name().starts_with(source::PREFIX))
        || has_expression(root)
        || root.children().filter(is_part).any(|part| part.descendants().any(has_expression))
}

/// The expanded document. `None`: a part of the robot is missing, and errors name it.
pub(crate) fn expand(document: &Document<'_>, lines: &Lines<'_>, input: &Input<'_>, log: &mut Diagnostics) -> Option<Expanded> {
    let mut nodes = 0;
    let root = source::tree(document, lines, None, &mut nodes, log)?;
    let mut expander = expander::Expander::new(input, nodes, log);
    let expanded = expander.expand(&root);
    let (is_complete, declared) = (!expander.incomplete, std::mem::take(&mut expander.declared));
    input.options.warn_of_arguments(&declared, log);
    expanded.filter(|_| is_complete).map(|root| source::write(&root))
}
