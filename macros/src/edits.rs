//! The keys that edit the robot: `lock`, `payload`, `append`; and names of links and joints, as words or in quotation marks.

use articulated_codegen::{Appended, Origin, Payload};
use proc_macro2::Span;
use syn::ext::IdentExt;
use syn::parse::{Parse, ParseStream};
use syn::punctuated::Punctuated;
use syn::{Ident, LitStr, Result, Token, braced, bracketed, token};

use crate::keys::{Number, numbers};
use crate::table::Key;

/// The name of a link or joint: `tool` or `"left foot"`.
pub(crate) struct Name {
    pub(crate) text: String,
    pub(crate) span: Span,
}

/// `joint = coordinate` or `joint = [coordinates]`.
pub(crate) struct Lock {
    pub(crate) joint: Name,
    pub(crate) at: Vec<f64>,
}

/// A payload's table.
#[derive(Default)]
pub(crate) struct Load {
    pub(crate) link: Option<Name>,
    name: Option<Name>,
    mass: Option<f64>,
    center_of_mass: [f64; 3],
    inertia: [f64; 6],
}

/// The table of a robot to append.
#[derive(Default)]
pub(crate) struct Other {
    pub(crate) urdf: Option<LitStr>,
    pub(crate) at: Option<Name>,
    prefix: Option<Name>,
    origin: Origin,
}

impl Load {
    /// The payload, if nothing is missing.
    pub(crate) fn payload(&self) -> Option<Payload> {
        Some(Payload {
            link: self.link.as_ref()?.text.clone(),
            name: self.name.as_ref().map(|name| name.text.clone()),
            mass: self.mass?,
            center_of_mass: self.center_of_mass,
            inertia: self.inertia,
        })
    }
}

impl Other {
    /// All but the bytes, if nothing is missing.
    pub(crate) fn appended(&self) -> Option<Appended> {
        Some(Appended {
            urdf: Vec::new(),
            file: self.urdf.as_ref()?.value(),
            at: self.at.as_ref()?.text.clone(),
            prefix: self.prefix.as_ref().map(|name| name.text.clone()).unwrap_or_default(),
            origin: self.origin,
        })
    }
}

/// Of a payload.
pub(crate) const LOAD: &[Key<Load>] = &[
    Key { name: "link", required: true, expected: NAME, read: |l, value| value.parse().map(|name| l.link = Some(name)) },
    Key {
        name: "mass",
        required: true,
        expected: "a number of kg, as 1.2",
        read: |l, value| value.parse().map(|Number(mass)| l.mass = Some(mass)),
    },
    Key {
        name: "center_of_mass",
        required: false,
        expected: "three finite numbers in m, in the link's frame, as [0.0, 0.0, 0.1]",
        read: |l, value| numbers(value).map(|center| l.center_of_mass = center),
    },
    Key {
        name: "inertia",
        required: false,
        expected: "six finite numbers in kg·m², about the centre of mass: xx, xy, xz, yy, yz, zz",
        read: |l, value| numbers(value).map(|inertia| l.inertia = inertia),
    },
    Key {
        name: "name",
        required: false,
        expected: "a name for the payload's link, as bottle or \"a bottle\"",
        read: |l, value| value.parse().map(|name| l.name = Some(name)),
    },
];

/// Of a robot to append.
pub(crate) const OTHER: &[Key<Other>] = &[
    Key {
        name: "urdf",
        required: true,
        expected: "the path of a URDF from the folder of Cargo.toml, as \"robots/gripper.urdf\"",
        read: |o, value| value.parse().map(|path| o.urdf = Some(path)),
    },
    Key { name: "at", required: true, expected: NAME, read: |o, value| value.parse().map(|name| o.at = Some(name)) },
    Key {
        name: "prefix",
        required: false,
        expected: "what stands before its names, as \"left_\"",
        read: |o, value| value.parse().map(|name| o.prefix = Some(name)),
    },
    Key {
        name: "xyz",
        required: false,
        expected: "three finite numbers in m, in the link's frame, as [0.0, 0.0, 0.1]",
        read: |o, value| numbers(value).map(|xyz| o.origin.xyz = xyz),
    },
    Key {
        name: "rpy",
        required: false,
        expected: "roll, pitch and yaw in rad, as [0.0, 0.0, 1.57]",
        read: |o, value| numbers(value).map(|rpy| o.origin.rpy = rpy),
    },
];

const NAME: &str = "the name of a link, as tool or \"left foot\"";

/// `[name, …]`.
pub(crate) fn names(value: ParseStream) -> Result<Vec<Name>> {
    let names;
    bracketed!(names in value);
    Ok(Punctuated::<Name, Token![,]>::parse_terminated(&names)?.into_iter().collect())
}

/// `{ joint = coordinates, … }`.
pub(crate) fn locks(value: ParseStream) -> Result<Vec<Lock>> {
    let locks;
    braced!(locks in value);
    Ok(Punctuated::<Lock, Token![,]>::parse_terminated(&locks)?.into_iter().collect())
}

impl Parse for Name {
    fn parse(input: ParseStream) -> Result<Self> {
        if input.peek(LitStr) {
            let name: LitStr = input.parse()?;
            return Ok(Self { text: name.value(), span: name.span() });
        }
        let name = Ident::parse_any(input)?;
        Ok(Self { text: name.unraw().to_string(), span: name.span() })
    }
}

impl Parse for Lock {
    fn parse(input: ParseStream) -> Result<Self> {
        let joint = input.parse()?;
        input.parse::<Token![=]>()?;
        if !input.peek(token::Bracket) {
            return Ok(Self { joint, at: vec![input.parse::<Number>()?.0] });
        }
        let at;
        bracketed!(at in input);
        let at = Punctuated::<Number, Token![,]>::parse_terminated(&at)?;
        Ok(Self { joint, at: at.into_iter().map(|n| n.0).collect() })
    }
}
