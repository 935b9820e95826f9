//! The keys of an invocation: one row each.

use articulated_codegen::urdf::{SNAP_EXPECTED, can_snap};
use articulated_codegen::{Base, Level, Real, Reference};
use proc_macro2::{TokenStream, TokenTree};
use syn::ext::IdentExt;
use syn::parse::{Parse, ParseStream};
use syn::punctuated::Punctuated;
use syn::{Error, Ident, Lit, LitBool, Path, Result, Token, braced, bracketed};

use crate::edits::{self, LOAD, OTHER};
use crate::settings::{Entry, Renaming, Settings};
use crate::table::{Key, tables};
use crate::tree;

/// All keys, in the order in which they are listed to people.
pub(crate) const KEYS: &[Key<Settings>] = &[
    Key {
        name: "urdf",
        required: true,
        expected: "the path of a URDF from the folder of Cargo.toml, as \"robots/arm.urdf\", here or in a `scene`",
        read: |s, value| value.parse().map(|path| s.urdf = Some(path)),
    },
    Key {
        name: "scene",
        required: false,
        expected: "the path of a scene from the folder of Cargo.toml, as \"scenes/arm.toml\"",
        read: |s, value| value.parse().map(|path| s.scene = Some(path)),
    },
    Key {
        name: "effects",
        required: false,
        expected: "effects as scenes have them, as { damping = { \"*\" = 0.1, elbow = 0.5 }, friction = urdf }",
        read: |s, value| tree::node(value, &mut s.spans).map(|node| s.effects = Some(node)),
    },
    Key { name: "base", required: false, expected: "`fixed` or `floating`", read: |s, value| base(value).map(|base| s.base = Some(base)) },
    Key {
        name: "gravity",
        required: false,
        expected: "three finite numbers in m/s², as [0.0, 0.0, -9.81]",
        read: |s, value| numbers(value).map(|g| s.gravity = Some(g)),
    },
    Key {
        name: "functions",
        required: false,
        expected: "a list of functions, as [placements, bias = inverse_dynamics(a = 0), both = inverse_dynamics + mass_matrix]",
        read: |s, value| entries(value).map(|entries| s.functions = Some(entries)),
    },
    Key {
        name: "parameters",
        required: false,
        expected: "a list of what stays an input, as [payload(tool), inertia(forearm), origin(elbow)]",
        read: |s, value| entries(value).map(|entries| s.parameters = Some(entries)),
    },
    Key {
        name: "frames",
        required: false,
        expected: "a list of links, as [tool, \"left foot\"]",
        read: |s, value| edits::names(value).map(|names| s.frames = Some(names)),
    },
    Key {
        name: "wrenches_in",
        required: false,
        expected: "`body`, `world` or `world_aligned`",
        read: |s, value| reference(value).map(|reference| s.wrench_reference = Some(reference)),
    },
    Key {
        name: "lock",
        required: false,
        expected: "joints with their coordinates in rad or m, as { elbow = 0.5, ball = [0.0, 0.0, 0.0, 1.0] }",
        read: |s, value| edits::locks(value).map(|locks| s.lock = Some(locks)),
    },
    Key {
        name: "payload",
        required: false,
        expected: "a load on a link, as { link = tool, mass = 1.2, center_of_mass = [0.0, 0.0, 0.1] }, or a list of such",
        read: |s, value| tables(value, LOAD, &mut s.faults).map(|loads| s.payloads = Some(loads)),
    },
    Key {
        name: "append",
        required: false,
        expected: "another robot on a link, as { urdf = \"gripper.urdf\", at = tool, prefix = \"left_\" }, or a list of such",
        read: |s, value| tables(value, OTHER, &mut s.faults).map(|others| s.append = Some(others)),
    },
    Key {
        name: "rename",
        required: false,
        expected: "names of the URDF with names in Rust, as { tool = TCP, \"a-b\" = A_MINUS_B }",
        read: |s, value| rename(value).map(|renamings| s.rename = Some(renamings)),
    },
    Key {
        name: "allow_unphysical_inertia",
        required: false,
        expected: "`true` or `false`",
        read: |s, value| value.parse::<LitBool>().map(|b| s.allow_unphysical_inertia = Some(b.value)),
    },
    Key {
        name: "snap_angles",
        required: false,
        expected: SNAP_EXPECTED,
        read: |s, value| angle(value).map(|angle| s.snap_angles = Some(angle)),
    },
    Key {
        name: "limbs",
        required: false,
        expected: "`true` or `false`",
        read: |s, value| value.parse::<LitBool>().map(|b| s.limbs = Some(b.value)),
    },
    Key {
        name: "batch",
        required: false,
        expected: "types of numbers, as [f64, f32]",
        read: |s, value| reals(value).map(|reals| s.batch = Some(reals)),
    },
    Key {
        name: "level",
        required: false,
        expected: "a level of accuracy, as f64, f32, f32_f64, compensated + two, double_double or f64 + fast_10 + no_fma",
        read: |s, value| level(value).map(|level| s.level = Some(level)),
    },
    Key {
        name: "forbid_unsafe",
        required: false,
        expected: "`true` or `false`",
        read: |s, value| value.parse::<LitBool>().map(|b| s.forbid_unsafe = Some(b.value)),
    },
    Key {
        name: "no_std",
        required: false,
        expected: "`true` or `false`",
        read: |s, value| value.parse::<LitBool>().map(|b| s.no_std = Some(b.value)),
    },
    Key {
        name: "crate",
        required: false,
        expected: "the absolute path of the crate `articulated`, as ::articulated or crate::path",
        read: |s, value| absolute(value).map(|path| s.runtime = Some(path)),
    },
    Key {
        name: "standalone",
        required: false,
        expected: "`true` or `false`",
        read: |s, value| value.parse::<LitBool>().map(|b| s.standalone = b.value),
    },
];

fn base(value: ParseStream) -> Result<Base> {
    let name: Ident = value.parse()?;
    match name.to_string().as_str() {
        "fixed" => Ok(Base::Fixed),
        "floating" => Ok(Base::Floating),
        _ => Err(value.error("no such base")),
    }
}

/// `[x, …]`, N of them.
pub(crate) fn numbers<const N: usize>(value: ParseStream) -> Result<[f64; N]> {
    let numbers;
    bracketed!(numbers in value);
    let numbers = Punctuated::<Number, Token![,]>::parse_terminated(&numbers)?;
    let numbers: Vec<f64> = numbers.into_iter().map(|n| n.0).collect();
    numbers.try_into().map_err(|_| value.error("too few or too many"))
}

fn reference(value: ParseStream) -> Result<Reference> {
    let name: Ident = value.parse()?;
    let all = [Reference::Body, Reference::World, Reference::WorldAligned];
    all.into_iter().find(|reference| name == reference.name()).ok_or_else(|| value.error("no such reference"))
}

/// `[f64, f32]`, each once.
fn reals(value: ParseStream) -> Result<Vec<Real>> {
    let names;
    bracketed!(names in value);
    let mut reals = Vec::new();
    for name in Punctuated::<Ident, Token![,]>::parse_terminated(&names)? {
        let real = match name.to_string().as_str() {
            "f64" => Real::F64,
            "f32" => Real::F32,
            other => return Err(Error::new(name.span(), format!("found `{other}`, expected `f64` or `f32`"))),
        };
        if reals.contains(&real) {
            return Err(Error::new(name.span(), format!("`{name}` is there twice")));
        }
        reals.push(real);
    }
    Ok(reals)
}

/// `f64 + fast_10 + no_fma`
fn level(value: ParseStream) -> Result<Level> {
    let words = Punctuated::<Ident, Token![+]>::parse_separated_nonempty(value)?;
    let words: Vec<String> = words.iter().map(Ident::to_string).collect();
    words.join("+").parse().map_err(|error| value.error(error))
}

/// Entries between commas, each as it stands: the generator reads them.
fn entries(value: ParseStream) -> Result<Vec<Entry>> {
    let entries;
    bracketed!(entries in value);
    Ok(Punctuated::<Entry, Token![,]>::parse_terminated(&entries)?.into_iter().collect())
}

impl Parse for Entry {
    fn parse(input: ParseStream) -> Result<Self> {
        let span = input.span();
        let mut tokens = TokenStream::new();
        while !input.is_empty() && !input.peek(Token![,]) {
            tokens.extend(input.parse::<TokenTree>());
        }
        if tokens.is_empty() { Err(input.error("nothing before the comma")) } else { Ok(Self { text: tokens.to_string(), span }) }
    }
}

fn rename(value: ParseStream) -> Result<Vec<Renaming>> {
    let renamings;
    braced!(renamings in value);
    Ok(Punctuated::<Renaming, Token![,]>::parse_terminated(&renamings)?.into_iter().collect())
}

fn angle(value: ParseStream) -> Result<f64> {
    let Number(angle) = value.parse()?;
    if can_snap(angle) { Ok(angle) } else { Err(value.error("too large, or not positive")) }
}

/// A path that means the same inside the generated module as outside of it.
fn absolute(value: ParseStream) -> Result<Path> {
    let path = Path::parse_mod_style(value)?;
    let absolute = path.leading_colon.is_some() || path.segments.first().is_some_and(|s| s.ident == "crate");
    if absolute { Ok(path) } else { Err(value.error("not absolute")) }
}

/// A finite number with or without a sign, a point, an exponent.
pub(crate) struct Number(pub(crate) f64);

impl Parse for Number {
    fn parse(input: ParseStream) -> Result<Self> {
        let span = input.span();
        let number = signed(input)?;
        if number.is_finite() { Ok(Self(number)) } else { Err(Error::new(span, "not finite")) }
    }
}

/// A number, finite or not, with or without a sign. Units are not guessed from what stands behind it: `90deg` is none.
pub(crate) fn signed(input: ParseStream) -> Result<f64> {
    let sign = if input.parse::<Option<Token![-]>>()?.is_some() { -1.0 } else { 1.0 };
    let literal: Lit = input.parse()?;
    let (number, suffix): (f64, &str) = match &literal {
        Lit::Float(x) => (x.base10_parse()?, x.suffix()),
        Lit::Int(x) => (x.base10_parse()?, x.suffix()),
        _ => return Err(Error::new(literal.span(), "not a number")),
    };
    if matches!(suffix, "" | "f64") { Ok(sign * number) } else { Err(Error::new(literal.span(), "a unit")) }
}

impl Parse for Renaming {
    fn parse(input: ParseStream) -> Result<Self> {
        let from = input.parse()?;
        input.parse::<Token![=]>()?;
        Ok(Self { from, to: Ident::parse_any(input)? })
    }
}
