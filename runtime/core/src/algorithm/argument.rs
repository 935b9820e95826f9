//! Arguments of the functions of the table, and the dimensions of arguments and results.

use core::fmt;

use super::Shape;
#[cfg(doc)]
use crate::model::Model;

/// One dimension of an array.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Dim {
    /// One for each coordinate.
    Nq,
    /// One for each degree of freedom.
    Nv,
    /// One for each frame.
    Frames,
    /// One for each moving link.
    Links,
    /// One for each actuator: a control.
    Controls,
    /// One for each actuator with an activation.
    Activations,
    /// One for each place where shapes may touch.
    Contacts,
    /// One for each contact that a caller gives.
    Given,
    /// This many.
    Of(usize),
}

impl Dim {
    /// How many.
    pub fn len(self, shape: Shape) -> usize {
        match self {
            Self::Nq => shape.nq,
            Self::Nv => shape.nv,
            Self::Frames => shape.frames,
            Self::Links => shape.links,
            Self::Controls => shape.controls,
            Self::Activations => shape.activations,
            Self::Contacts => shape.contacts,
            Self::Given => shape.given,
            Self::Of(n) => n,
        }
    }
}

impl fmt::Display for Dim {
    /// The constant of generated code that is its length.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Nq => f.write_str("NQ"),
            Self::Nv => f.write_str("NV"),
            Self::Frames => f.write_str("FRAMES"),
            Self::Links => f.write_str("LINKS"),
            Self::Controls => f.write_str("NU"),
            Self::Activations => f.write_str("NA"),
            Self::Contacts => f.write_str("CONTACTS"),
            Self::Given => f.write_str("GIVEN"),
            Self::Of(n) => write!(f, "{n}"),
        }
    }
}

/// How many numbers an array of these dimensions has.
pub(super) fn size(dims: &[Dim], shape: Shape) -> usize {
    dims.iter().map(|d| d.len(shape)).product()
}

/// A dimension, or dimensions, as they are indexed; a single number is an array of one.
macro_rules! dims {
    () => { "[1]" };
    ($($dim:ident $(($n:literal))?),+) => { concat!($(dims!(one $dim $($n)?)),+) };
    (one Nq) => { "[nq]" };
    (one Nv) => { "[nv]" };
    (one Frames) => { "[frames]" };
    (one Links) => { "[links]" };
    (one Controls) => { "[nu]" };
    (one Activations) => { "[na]" };
    (one Contacts) => { "[contacts]" };
    (one Given) => { "[given]" };
    (one Of $n:literal) => { concat!("[", $n, "]") };
}

pub(crate) use dims;

/// An input of a function: its name, its dimensions and its units.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Port {
    /// Its name in signatures and files.
    pub name: &'static str,
    /// Its dimensions.
    pub dims: &'static [Dim],
    /// Its units, for documentation.
    pub unit: &'static str,
    /// Whether its numbers are coordinates of the robot, with unit quaternions.
    is_configuration: bool,
    /// Its place among the inputs of the table's algorithms.
    place: Option<Place>,
}

impl Port {
    /// An input of a user's function.
    pub const fn new(name: &'static str, dims: &'static [Dim], unit: &'static str) -> Self {
        Self { name, dims, unit, is_configuration: false, place: None }
    }

    /// The same for a configuration: coordinates of the robot, with unit quaternions. Derivatives
    /// of a result are in the tangent space.
    pub const fn configuration(name: &'static str, unit: &'static str) -> Self {
        Self { name, dims: &[Dim::Nq], unit, is_configuration: true, place: None }
    }

    /// Its dimensions in the tangent space: of a configuration one number for each degree of
    /// freedom.
    pub fn tangent_dims(&self) -> &'static [Dim] {
        if self.is_configuration { &[Dim::Nv] } else { self.dims }
    }

    /// Whether its numbers are coordinates of the robot, with unit quaternions.
    pub fn is_configuration(&self) -> bool {
        self.is_configuration
    }

    /// How many numbers.
    pub fn len(&self, shape: Shape) -> usize {
        size(self.dims, shape)
    }

    /// Whether it never has a number.
    pub fn is_empty(&self, shape: Shape) -> bool {
        self.len(shape) == 0
    }
}

/// An argument of a function: one of those that functions of the table share, or a function's own.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Argument(&'static Port);

impl Argument {
    /// An argument of a user's function.
    pub const fn new(port: &'static Port) -> Self {
        Self(port)
    }

    /// The argument of the table that has this name and these dimensions, or else one of a user's
    /// function.
    pub const fn named(port: &'static Port) -> Self {
        let mut k = 0;
        while k < Self::ALL.len() {
            if is_equal(Self::ALL[k].0.name, port.name) && have_same_lengths(Self::ALL[k].0.dims, port.dims) {
                return Self::ALL[k];
            }
            k += 1;
        }
        Self(port)
    }

    /// Its name in signatures and files.
    pub fn name(self) -> &'static str {
        self.0.name
    }

    /// Its dimensions.
    pub fn dims(self) -> &'static [Dim] {
        self.0.dims
    }

    /// Its units, for documentation.
    pub fn unit(self) -> &'static str {
        self.0.unit
    }

    /// Whether its numbers are coordinates of the robot, with unit quaternions.
    pub fn is_configuration(self) -> bool {
        self == Self::Q || self == Self::Target || self.0.is_configuration
    }

    /// The same in the tangent space: where it is a configuration, one number for each degree of
    /// freedom.
    pub fn tangent_dims(self) -> &'static [Dim] {
        if self.is_configuration() { Self::V.dims() } else { self.dims() }
    }
}

/// Whether two names are the same, for constants.
const fn is_equal(one: &str, other: &str) -> bool {
    let (one, other) = (one.as_bytes(), other.as_bytes());
    let mut k = 0;
    while k < one.len() && k < other.len() && one[k] == other[k] {
        k += 1;
    }
    k == one.len() && k == other.len()
}

/// Whether dimensions are the same, for constants.
const fn have_same_lengths(one: &[Dim], other: &[Dim]) -> bool {
    let mut k = 0;
    while k < one.len() && k < other.len() {
        match (one[k], other[k]) {
            (Dim::Nq, Dim::Nq) | (Dim::Nv, Dim::Nv) | (Dim::Frames, Dim::Frames) | (Dim::Links, Dim::Links) => {}
            (Dim::Controls, Dim::Controls)
            | (Dim::Activations, Dim::Activations)
            | (Dim::Contacts, Dim::Contacts)
            | (Dim::Given, Dim::Given) => {}
            (Dim::Of(n), Dim::Of(m)) if n == m => {}
            _ => return false,
        }
        k += 1;
    }
    k == one.len() && k == other.len()
}

impl fmt::Debug for Argument {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

macro_rules! arguments {
    ($($(#[$doc:meta])* $variant:ident $name:ident [$($dim:ident $(($n:literal))?),*] $unit:literal;)*) => {
        /// The arguments that functions of the table share.
        #[allow(non_upper_case_globals)]
        impl Argument {
            $($(#[$doc])* pub const $variant: Self =
                Self(&Port { name: stringify!($name), dims: &[$(Dim::$dim $(($n))?),*], unit: $unit, is_configuration: false, place: Some(Place::$variant) });)*
        }

        /// The place of each argument of the table among the inputs of an algorithm.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub(super) enum Place {
            $($variant,)*
        }

        /// The argument of a name.
        macro_rules! argument {
            $(($name) => { Argument::$variant };)*
        }

        /// Its place.
        macro_rules! place {
            $(($name) => { crate::algorithm::argument::Place::$variant as usize };)*
        }

        /// An argument with its dimensions and unit, for documentation.
        macro_rules! documentation {
            $(($name) => { concat!(stringify!($name), ": `", dims!($($dim $(($n))?),*), "` ", $unit) };)*
        }
    };
}

// The constant of each argument, its name, its dimensions, and its units for documentation.
arguments! {
    /// q, `[nq]`: rad, m, or position and unit quaternion.
    Q q [Nq] "rad|m|unit quaternion";
    /// v, `[nv]`: rad/s, m/s, or body twist [ω; v].
    V v [Nv] "rad/s|m/s";
    /// a = dv/dt, `[nv]`.
    A a [Nv] "rad/s²|m/s²";
    /// τ, `[nv]`: N·m or N.
    Tau tau [Nv] "N·m|N";
    /// Wrenches [m; f] on the frames, `[frames][6]`, N·m and N, as [`Model::wrench_reference`]
    /// says.
    Wrenches wrenches [Frames, Of(6)] "[m; f] on each frame, N·m and N";
    /// A step in the tangent space, `[nv]`: rad, m, or twist times time.
    Step step [Nv] "rad|m, a small motion in the tangent space";
    /// A second configuration, `[nq]`.
    Target target [Nq] "rad|m|unit quaternion";
    /// Numbers in [0, 1), `[nq]`.
    Uniform uniform [Nq] "each uniform in 0 to 1";
    /// sin q and cos q of each coordinate, `[nq][2]`, for callers that have them: generated
    /// functions take it on request.
    SinCos sines [Nq, Of(2)] "[sin q, cos q] of each coordinate that is an angle; the others are not read";
}

pub(crate) use documentation;
pub(super) use {argument, place};

impl Argument {
    /// All that functions of the table take.
    pub const ALL: [Self; 8] = [Self::Q, Self::V, Self::A, Self::Tau, Self::Wrenches, Self::Step, Self::Target, Self::Uniform];

    /// How many numbers.
    pub fn len(self, shape: Shape) -> usize {
        size(self.dims(), shape)
    }

    /// Its place among the inputs of the table's algorithms.
    pub(super) fn place(self) -> Option<usize> {
        self.0.place.map(|place| place as usize)
    }
}

#[cfg(test)]
mod tests {
    use alloc::format;
    use alloc::string::String;

    use super::Dim;

    /// As it is indexed: the names of dimensions in small letters.
    fn shown(dims: &[Dim]) -> String {
        dims.iter().map(|d| format!("[{}]", format!("{d}").to_lowercase())).collect()
    }

    #[test]
    fn dimensions_are_documented_as_they_are() {
        assert_eq!(dims!(Frames, Of(6), Nv), shown(&[Dim::Frames, Dim::Of(6), Dim::Nv]));
        assert_eq!((dims!(Nq, Links), dims!()), ("[nq][links]", "[1]"));
    }
}
