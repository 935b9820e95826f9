//! Names of the robot's file as names in Rust.

use std::collections::btree_map::Entry;
use std::collections::{BTreeMap, BTreeSet};

use articulated_core::diagnostic::{Code, Diagnostic, Diagnostics, Span, Spanned};
use articulated_core::model::Model;
use unicode_security::GeneralSecurityProfile;
use unicode_security::confusable_detection::skeleton;
use unicode_security::mixed_script::{AugmentedScriptSet, is_potential_mixed_script_confusable_char};

use crate::{Request, is_keyword};

/// The constant's name for a name of the robot's file: letters in upper case, everything that
/// cannot be in an identifier as `_`, `_` in front of a digit. `shoulder pan-joint` is
/// `SHOULDER_PAN_JOINT`, `1st-link` is `_1ST_LINK`. Letters beyond ASCII stay where the compiler
/// takes them without a warning: it warns of a crate, and only the root of that crate could allow
/// it. Other names are written by code points.
pub fn identifier(name: &str) -> String {
    let upper: String = name.trim_matches('_').chars().flat_map(char::to_uppercase).collect();
    let mut ident: String = upper.chars().map(|c| if c == '_' || c.is_alphanumeric() { c } else { '_' }).collect();
    if !ident.starts_with(|c: char| c.is_alphabetic()) {
        ident.insert(0, '_');
    }
    // An underscore alone is not a name, nor is a text that the compiler rejects.
    if ident.chars().all(|c| c == '_') || !is_identifier(&ident) || !passes_lints(&ident) { ascii(name) } else { ident }
}

/// Whether an identifier alone in a crate causes no warning: neither `uncommon_codepoints` nor
/// `mixed_script_confusables`, nor `confusable_idents` beside any in ASCII.
fn passes_lints(ident: &str) -> bool {
    let beyond = || ident.chars().filter(|c| !c.is_ascii());
    let looks_ascii = skeleton(ident).all(|c| c.is_ascii());
    let distinct: Vec<AugmentedScriptSet> =
        beyond().filter(|c| !is_potential_mixed_script_confusable_char(*c)).chain(['A']).map(AugmentedScriptSet::for_char).collect();
    // A script is safe if one of its letters looks like none of another script. Latin is safe.
    let is_safe = |c: char| {
        let own = AugmentedScriptSet::for_char(c);
        let shared = |other: &AugmentedScriptSet| {
            let mut both = own;
            both.intersect_with(*other);
            !both.is_empty() && !both.is_all()
        };
        own.is_all() || distinct.iter().any(shared)
    };
    ident.is_ascii() || !looks_ascii && ident.chars().all(GeneralSecurityProfile::identifier_allowed) && beyond().all(is_safe)
}

/// The identifiers that look like others among them.
fn look_alikes<'a>(idents: impl Iterator<Item = &'a String>) -> BTreeSet<String> {
    let mut alike: BTreeMap<String, BTreeSet<&String>> = BTreeMap::new();
    idents.filter(|ident| !ident.is_ascii()).for_each(|ident| _ = alike.entry(skeleton(ident).collect()).or_default().insert(ident));
    alike.into_values().filter(|idents| idents.len() > 1).flatten().cloned().collect()
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

/// Whether Rust parses `ident` as one plain identifier.
fn is_identifier(ident: &str) -> bool {
    let tokens = ident.parse::<proc_macro2::TokenStream>().map(|t| t.into_iter().collect::<Vec<_>>());
    matches!(tokens.as_deref(), Ok([proc_macro2::TokenTree::Ident(i)]) if i == ident)
}

/// Whether a constant can have this name.
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
    /// Reports all names for code that are not identifiers, and all that two have.
    pub(crate) fn check(model: &Model<f64>, request: &Request, log: &mut Diagnostics) {
        wrong_renames(model, request, log);
        log.extend(Self::and_clashes(model, request).1);
    }

    /// Names for everything, of a request whose names were checked.
    pub(crate) fn of(model: &Model<f64>, request: &Request) -> Self {
        Self::and_clashes(model, request).0
    }

    fn and_clashes(model: &Model<f64>, request: &Request) -> (Self, Vec<Diagnostic>) {
        let joints = model.joints().iter().map(|j| j.name.as_str());
        let frames = model.frames().iter().map(|f| f.name.as_str());
        let plain: Vec<String> = joints.clone().chain(frames.clone()).map(identifier).collect();
        let alike = look_alikes(plain.iter());
        let mut clashes = Vec::new();
        let names = Self {
            joints: idents("joint", joints, request, &alike, &mut clashes),
            frames: idents("link", frames, request, &alike, &mut clashes),
        };
        (names, clashes)
    }
}

/// The Rust names of all; look-alikes are written by code points. A name that another has already
/// is a clash.
fn idents<'a>(
    kind: &'static str,
    names: impl Iterator<Item = &'a str>,
    request: &Request,
    alike: &BTreeSet<String>,
    clashes: &mut Vec<Diagnostic>,
) -> Vec<String> {
    let mut seen: BTreeMap<String, &str> = BTreeMap::new();
    let renamed: BTreeMap<&str, &String> = request.options.rename.iter().map(|names| (names.0.as_str(), &names.1)).collect();
    let mut ident = |name: &'a str| {
        let ident = renamed.get(name).map_or_else(|| distinct(name, alike), |to| (*to).clone());
        match seen.entry(ident.clone()) {
            Entry::Vacant(free) => {
                free.insert(name);
            }
            Entry::Occupied(first) => {
                let (first, second) = ((*first.get()).to_owned(), name.to_owned());
                clashes.push(clash(kind, [&first, &second], &ident, request));
            }
        }
        ident
    };
    names.map(&mut ident).collect()
}

/// Names in Rust of all; look-alikes are written by code points.
pub(crate) fn identifiers<'a>(names: impl Iterator<Item = &'a str> + Clone) -> Vec<String> {
    let plain: Vec<String> = names.clone().map(identifier).collect();
    let alike = look_alikes(plain.iter());
    names.map(|name| distinct(name, &alike)).collect()
}

/// The name in Rust, by code points where it looks like another.
fn distinct(name: &str, alike: &BTreeSet<String>) -> String {
    let ident = identifier(name);
    if alike.contains(&ident) { ascii(name) } else { ident }
}

/// The error of two names that become one, at the place where a file renames one of them, if any.
fn clash(kind: &str, [first, second]: [&String; 2], ident: &str, request: &Request) -> Diagnostic {
    let renamed = |name: &&String| request.options.rename.iter().rfind(|names| names.0 == **name && names.span.is_some());
    let entry = [second, first].into_iter().find_map(|name| renamed(&name));
    let both = format!("{kind}s {first:?} and {second:?} are both `{ident}` in Rust");
    let (key, sentence) = match entry {
        Some(entry) => (format!("rename.{}", entry.0), format!("{both}; give one another name")),
        None => (String::new(), format!("{both}; `--rename` (key `rename`, method `Build::rename`) gives one another name")),
    };
    let span = entry.map_or_else(|| Span { file: request.file.clone(), ..Span::default() }, |entry| entry.span_or(&request.file));
    Diagnostic::refusal(&span.file, (span.at, &key), Code::NameClash, sentence)
}

/// Reports all renamings that cannot be, each once.
fn wrong_renames(model: &Model<f64>, request: &Request, log: &mut Diagnostics) {
    let names: BTreeSet<&str> = model.joints().iter().map(|j| &*j.name).chain(model.frames().iter().map(|f| &*f.name)).collect();
    let (mut seen, mut told) = (BTreeSet::new(), BTreeSet::new());
    for entry in &request.options.rename {
        let Spanned { value: (from, to), span } = entry;
        let is_first = seen.insert(from);
        let reason = if !is_name(to) {
            "this is not an identifier of Rust"
        } else if !names.contains(from.as_str()) {
            "no joint that moves and no link that is a frame has this name"
        } else if !is_first {
            "it is renamed twice, expected once"
        } else {
            continue;
        };
        if told.insert((from, to)) {
            let (key, sentence) = match span {
                Some(_) => (format!("rename.{from}"), format!("to `{to}`: {reason}")),
                None => (String::new(), format!("rename {from:?} to `{to}`: {reason}")),
            };
            let span = entry.span_or(&request.file);
            log.push(Diagnostic::refusal(&span.file, (span.at, &key), Code::Rename, sentence));
        }
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
            ("бедро", "БЕДРО"),
            ("локоть", "_U43B_U43E_U43A_U43E_U442_U44C_"),
            ("рука", "_U440_U443_U43A_U430_"),
            ("рука robot", "_U440_U443_U43A_U430_U20_ROBOT"),
            ("Λ", "_U39B_"),
            ("ώμος", "ΏΜΟΣ"),
            ("ömer", "ÖMER"),
            ("肘", "肘"),
            ("ひじ", "ひじ"),
            ("팔꿈치", "팔꿈치"),
            ("कोहनी", "कोहनी"),
            ("ﬁnger", "FINGER"),
            ("ａｒｍ", "_UFF41_UFF52_UFF4D_"),
            ("🤚", "_U1F91A_"),
            ("_", "_U5F_"),
            ("hand/tool0", "HAND_TOOL0"),
        ];
        for (name, ident) in cases {
            assert_eq!(identifier(name), ident);
            assert!(is_identifier(ident), "{ident}");
        }
    }

    /// Each robot alone in a crate, as the lints are of a crate.
    #[test]
    fn the_compiler_warns_of_no_name() {
        let folder = std::env::temp_dir().join(format!("articulated-names-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        for names in [
            ["рука", "локоть"],
            ["рука", "нос"],
            ["орех", "ЗАЗ"],
            ["рука левая", "left рука"],
            ["αβγ", "Λ"],
            ["ώμος", "ΑΒ"],
            ["արմունկ", "օ"],
            ["מרפק", "ס"],
            ["كوع", "ه"],
            ["कोहनी", "०"],
            ["肘", "一"],
            ["ひじ", "エ"],
            ["カロ工", "ニ"],
            ["팔꿈치", "ㅣ"],
            ["ข้อศอก", "แ"],
            ["ömer", "ﬁnger"],
            ["ａｒｍ", "𝐚𝐫𝐦"],
            ["əl", "ſ"],
            ["ª", "Ǆ"],
            ["e\u{301}x", "éx"],
            ["ЛАЗ", "ЛA3"],
            ["Л1О", "Л1O"],
            ["土土", "士士"],
            ["\u{202e}mra", "a\u{200d}b"],
            ["🤚", "a\u{9b}31m"],
        ] {
            let link = |name: &str| format!("<link name='{name}'/>");
            let joint = |name: &str, parent: &str| {
                format!("<joint name='{name}' type='continuous'><parent link='{parent}'/><child link='{name}'/></joint>")
            };
            let urdf = format!(
                "<robot name='arm'>{}{}{}{}{}</robot>",
                link("base"),
                link(names[0]),
                link(names[1]),
                joint(names[0], "base"),
                joint(names[1], names[0])
            );
            let mut request = Request::new("arm.urdf", urdf);
            request.options.parameters = names.iter().map(|name| format!("payload({name})").into()).collect();
            let (file, out) = (folder.join("arm.rs"), folder.join("arm.rmeta"));
            std::fs::write(&file, crate::generate(&request).unwrap_or_else(|error| panic!("{names:?}: {error}")).source).unwrap();
            let mut rustc = std::process::Command::new(std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into()));
            rustc.args(["--crate-type=lib", "--edition=2024", "--emit=metadata", "-Dwarnings", "-o"]).args([&out, &file]);
            let done = rustc.output().unwrap();
            assert!(done.status.success(), "{names:?}: {}", String::from_utf8_lossy(&done.stderr));
        }
        std::fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn names_are_those_asked_for_and_no_two_are_one() {
        let urdf = "<robot name='arm'><link name='base'/><link name='tip-1'/><link name='tip 1'/>\
            <joint name='base' type='continuous'><parent link='base'/><child link='tip-1'/></joint>\
            <joint name='fixed' type='fixed'><parent link='base'/><child link='tip 1'/></joint></robot>";
        let mut request = Request::new("arm.urdf", urdf);
        let model = request.build_robot().unwrap().model;
        let told = |request: &Request| {
            let mut log = Diagnostics::default();
            Names::check(&model, request, &mut log);
            log.to_string()
        };
        assert!(told(&request).starts_with("arm.urdf: links \"tip-1\" and \"tip 1\" are both `TIP_1` in Rust"), "{}", told(&request));
        for (from, to, fits) in [("tip 1", "other", true), ("tip 1", "BASE", false), ("fixed", "OTHER", false), ("tip 1", "fn", false)] {
            request.options.rename = vec![(from.to_owned(), to.to_owned()).into()];
            assert_eq!(told(&request).is_empty(), fits, "{from} {to}");
        }
        // A joint and a link may have one name.
        request.options.rename = vec![("tip 1".to_owned(), "other".to_owned()).into()];
        let names = Names::of(&model, &request);
        assert_eq!((names.joints.concat(), names.frames.join(" ")), ("BASE".into(), "BASE TIP_1 other".into()));
    }

    #[test]
    fn all_clashes_and_all_wrong_renamings_are_told_at_once() {
        let links = ["base", "a-x", "a x", "a.x", "b-x", "b x"].map(|name| format!("<link name='{name}'/>")).concat();
        let joint = |(k, child): (usize, &str)| {
            let joint = ["c-x", "c x", "d", "e", "f"][k];
            format!("<joint name='{joint}' type='continuous'><parent link='base'/><child link='{child}'/></joint>")
        };
        let joints: String = ["a-x", "a x", "a.x", "b-x", "b x"].into_iter().enumerate().map(joint).collect();
        let mut request = Request::new("arm.urdf", format!("<robot name='arm'>{links}{joints}</robot>"));
        let model = request.build_robot().unwrap().model;
        let told = |request: &Request, code: Code| {
            let mut log = Diagnostics::default();
            Names::check(&model, request, &mut log);
            log.errors.into_iter().filter(|error| error.code == code).map(|error| error.found).collect::<Vec<_>>()
        };
        let found = told(&request, Code::NameClash);
        let pairs = [("joint", "c-x", "c x"), ("link", "a-x", "a x"), ("link", "a-x", "a.x"), ("link", "b-x", "b x")];
        let expected = pairs.map(|(kind, first, second)| format!("{kind}s {first:?} and {second:?} are both "));
        assert!(found.len() == expected.len() && found.iter().zip(&expected).all(|(found, start)| found.starts_with(start)), "{found:?}");
        let renamings = [("d", "D_1"), ("d", "D_2"), ("none", "X"), ("e", "fn"), ("d", "D_2")];
        request.options.rename = renamings.map(|(from, to)| (from.to_owned(), to.to_owned()).into()).to_vec();
        let found = told(&request, Code::Rename);
        let expected = renamings[1..4].iter().map(|(from, to)| format!("rename {from:?} to `{to}`: "));
        assert!(found.len() == 3 && found.iter().zip(expected).all(|(found, start)| found.starts_with(&start)), "{found:?}");
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
