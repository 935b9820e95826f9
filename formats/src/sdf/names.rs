//! Other names for tags, and the version, which defines their meaning.

use articulated_core::diagnostic::{Code, Diagnostics, Subject, quote};

use crate::xml::tree::Element;

/// The root element of a document.
pub(crate) const ROOT: &str = "sdf";

/// Names that the format uses itself.
pub(crate) const MODEL: &str = "__model__";
pub(crate) const ROOT_FRAME: &str = "__root__";
pub(crate) const WORLD_NAME: &str = "world";

/// The version of the format.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Version(u32);

impl Version {
    pub(crate) const V1_5: Self = Self(5);
    pub(crate) const V1_7: Self = Self(7);
    const NEWEST: Self = Self(12);
    const OLDEST: Self = Self(4);
}

/// The version that a document names.
pub(crate) fn version(root: &Element, log: &mut Diagnostics) -> Version {
    let expected = "1.4 to 1.12";
    let Some(written) = root.text("version").map(str::trim) else {
        let expected = format!("the attribute version in <sdf>: {expected}");
        root.error((&Subject::Document, "version"), Code::MissingAttribute, "none", expected, log);
        return Version::NEWEST;
    };
    let number = written.strip_prefix("1.").and_then(|minor| minor.parse().ok()).map(Version);
    match number {
        Some(version) if version < Version::OLDEST => {
            root.error((&Subject::Document, "version"), Code::Version, quote(written), expected, log);
        }
        Some(version) if version <= Version::NEWEST => return version,
        _ => {
            let expected = format!("{expected}; read as 1.12");
            root.warning((&Subject::Document, "version"), Code::Version, quote(written), expected, log);
        }
    }
    Version::NEWEST
}

/// A name that a tag uses for another.
#[derive(Clone, Copy)]
pub(crate) struct Reference<'a> {
    pub(crate) element: &'a Element,
    /// The tag or attribute with the name.
    pub(crate) field: &'static str,
    pub(crate) name: &'a str,
    pub(crate) scope: usize,
}

/// The frame that a `<pose>` is relative to.
pub(crate) fn relative_to(tag: &Element, scope: usize) -> Option<Reference<'_>> {
    // Up to 1.6 the attribute is called frame.
    let (field, attribute) = ["relative_to", "frame"].into_iter().find_map(|field| Some((field, tag.attribute(field)?)))?;
    let name = attribute.value.trim();
    (!name.is_empty()).then_some(Reference { element: tag, field, name, scope })
}
