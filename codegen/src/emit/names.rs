//! Names of the URDF as names in Rust.

use std::collections::BTreeMap;

use articulated_core::model::Model;

use crate::{Error, Request, is_keyword};

/// The constant's name for a name of the URDF: letters in upper case, everything that cannot be in an identifier as `_`, `_` in front of a
/// digit. `shoulder pan-joint` is `SHOULDER_PAN_JOINT`, `1st-link` is `_1ST_LINK`. Letters beyond ASCII stay; where all of a crate's
/// look like Latin ones, the compiler warns (`mixed_script_confusables`), which only the root of that crate can allow: there another name helps.
pub fn identifier(name: &str) -> String {
    let upper: String = name.trim_matches('_').chars().flat_map(char::to_uppercase).collect();
    let mut ident: String = upper.chars().map(|c| if c == '_' || c.is_alphanumeric() { c } else { '_' }).collect();
    if !ident.starts_with(|c: char| c.is_alphabetic()) {
        ident.insert(0, '_');
    }
    // An underscore alone is no name, and neither is what the compiler does not take for one.
    if ident.chars().all(|c| c == '_') || !is_identifier(&ident) { ascii(name) } else { ident }
}

/// A name of code points, where letters will not do.
fn ascii(name: &str) -> String {
    name.chars().fold(String::from("_"), |mut ident, c| {
        if c.is_ascii_alphanumeric() {
            ident.push(c.to_ascii_uppercase());
        } else {
            ident += &format!("U{:X}_", u32::from(c));
        }
        ident
    })
}

/// Whether Rust takes `ident` for one plain identifier.
fn is_identifier(ident: &str) -> bool {
    let tokens = ident.parse::<proc_macro2::TokenStream>().map(|t| t.into_iter().collect::<Vec<_>>());
    matches!(tokens.as_deref(), Ok([proc_macro2::TokenTree::Ident(i)]) if i == ident)
}

/// Whether a constant can be called so.
pub(crate) fn is_name(ident: &str) -> bool {
    is_identifier(ident) && !is_keyword(ident) && !matches!(ident, "_" | "Self")
}

/// The Rust names of a robot's joints and links.
#[derive(Clone, Debug)]
pub(crate) struct Names {
    /// One for each joint that is a coordinate.
    pub(crate) joints: Vec<String>,
    /// One for each frame.
    pub(crate) frames: Vec<String>,
}

impl Names {
    /// Names for everything, or the first clash.
    pub(crate) fn new(model: &Model<f64>, request: &Request) -> Result<Self, Error> {
        check_renames(model, request)?;
        let joints = model.joints.iter().map(|j| j.name.as_str());
        let frames = model.frames.iter().map(|f| f.name.as_str());
        Ok(Self { joints: unique("joint", joints, request)?, frames: unique("link", frames, request)? })
    }
}

fn unique<'a>(kind: &'static str, names: impl Iterator<Item = &'a str>, request: &Request) -> Result<Vec<String>, Error> {
    let mut seen: BTreeMap<String, &str> = BTreeMap::new();
    let mut idents = Vec::new();
    for name in names {
        let renamed = request.options.rename.iter().find(|(from, _)| from == name);
        let ident = renamed.map_or_else(|| identifier(name), |(_, to)| to.clone());
        if let Some(first) = seen.insert(ident.clone(), name) {
            let (first, second) = (first.to_owned(), name.to_owned());
            return Err(Error::NameClash { file: request.file.clone(), kind, first, second, ident });
        }
        idents.push(ident);
    }
    Ok(idents)
}

fn check_renames(model: &Model<f64>, request: &Request) -> Result<(), Error> {
    let known = |name: &str| model.joints.iter().any(|j| j.name == name) || model.frames.iter().any(|f| f.name == name);
    let rename = &request.options.rename;
    let wrong = rename.iter().enumerate().find_map(|(k, (from, to))| {
        let reason = if !is_name(to) {
            "this is not an identifier of Rust"
        } else if !known(from) {
            "no joint that moves and no link that is a frame has this name"
        } else if rename[..k].iter().any(|(name, _)| name == from) {
            "it is renamed twice, expected once"
        } else {
            return None;
        };
        Some((from, to, reason))
    });
    match wrong {
        Some((from, to, reason)) => Err(Error::Rename { file: request.file.clone(), from: from.clone(), to: to.clone(), reason }),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_become_constants() {
        let cases = [
            ("shoulder pan-joint", "SHOULDER_PAN_JOINT"),
            ("1st-link", "_1ST_LINK"),
            ("type", "TYPE"),
            ("__floating_base__", "FLOATING_BASE"),
            ("локоть", "ЛОКОТЬ"),
            ("🤚", "_U1F91A_"),
            ("_", "_U5F_"),
            ("hand/tool0", "HAND_TOOL0"),
        ];
        for (name, ident) in cases {
            assert_eq!(identifier(name), ident);
            assert!(is_identifier(ident), "{ident}");
        }
    }

    #[test]
    fn names_are_those_asked_for_and_no_two_are_one() {
        let urdf = "<robot name='arm'><link name='base'/><link name='tip-1'/><link name='tip 1'/>\
            <joint name='base' type='continuous'><parent link='base'/><child link='tip-1'/></joint>\
            <joint name='fixed' type='fixed'><parent link='base'/><child link='tip 1'/></joint></robot>";
        let mut request = Request::new("arm.urdf", urdf);
        let model = crate::model(&request, &crate::read(&request).unwrap().description).unwrap();
        let clash = Names::new(&model, &request);
        assert!(matches!(&clash, Err(Error::NameClash { kind: "link", ident, .. }) if ident == "TIP_1"), "{clash:?}");
        for (from, to, fits) in [("tip 1", "other", true), ("tip 1", "BASE", false), ("fixed", "OTHER", false), ("tip 1", "fn", false)] {
            request.options.rename = vec![(from.into(), to.into())];
            assert_eq!(Names::new(&model, &request).is_ok(), fits, "{from} {to}");
        }
        // A joint and a link may have one name.
        request.options.rename = vec![("tip 1".into(), "other".into())];
        let names = Names::new(&model, &request).unwrap();
        assert_eq!((names.joints.concat(), names.frames.join(" ")), ("BASE".into(), "BASE TIP_1 other".into()));
    }

    #[test]
    fn a_word_that_rust_keeps_for_itself_is_no_name() {
        for word in ["type", "self", "Self", "crate", "_", "a-b", "a b", "", "1"] {
            assert!(!is_name(word), "{word}");
        }
        for name in ["TIP", "tip_2", "_1", "TYPE", "r#type"] {
            assert!(is_name(name), "{name}");
        }
    }
}
