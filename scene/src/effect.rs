//! Stand-in for `articulated_core::effect` until it is there.
#![allow(missing_docs, dead_code, unreachable_pub, non_camel_case_types)]
use articulated_core::description::Origin;
/// What an effect acts on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum On {
    /// Each degree of freedom of a joint.
    Joint,
    /// A frame in a link.
    Link,
}

/// A parameter of an effect: one number or several.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Field {
    /// Its key in scenes.
    pub name: &'static str,
    /// How many numbers.
    pub len: usize,
    /// Its unit.
    pub unit: &'static str,
    /// What it is where a scene does not say, as many numbers as it has; `None`: a scene must say.
    pub default: Option<&'static [f64]>,
    /// No number may be less.
    pub at_least: f64,
    /// Nor be equal to that.
    pub strictly: bool,
    /// What it means.
    pub what: &'static str,
}

impl Field {
    /// Any number, to be given.
    const fn number(name: &'static str, unit: &'static str, what: &'static str) -> Self {
        Self { name, len: 1, unit, default: None, at_least: f64::NEG_INFINITY, strictly: false, what }
    }

    /// Not negative.
    const fn at_least_zero(self) -> Self {
        Self { at_least: 0.0, ..self }
    }

    const fn positive(self) -> Self {
        Self { at_least: 0.0, strictly: true, ..self }
    }

    const fn or(self, default: &'static [f64]) -> Self {
        Self { default: Some(default), ..self }
    }

    const fn of(self, len: usize) -> Self {
        Self { len, ..self }
    }
}

/// One row: an effect that a scene may call for.
#[derive(Clone, Copy, Debug)]
pub struct Effect {
    /// Its number.
    pub id: EffectId,
    /// Its name in scenes.
    pub name: &'static str,
    /// What it acts on.
    pub on: On,
    /// The law.
    pub what: &'static str,
    /// Where the law is from.
    pub source: &'static str,
    /// Its parameters, in order.
    pub fields: &'static [Field],
}

impl Effect {
    /// How many numbers its parameters are.
    pub fn len(&self) -> usize {
        self.fields.iter().map(|f| f.len).sum()
    }

    /// Whether it has none.
    pub fn is_empty(&self) -> bool {
        self.fields.is_empty()
    }
}

/// An effect as a scene asks for it.
#[derive(Clone, Debug, PartialEq)]
pub struct Applied {
    /// Which.
    pub effect: EffectId,
    /// Name of the joint or the link.
    pub on: String,
    /// The effect's frame in the link's frame; of no meaning for joints.
    pub at: Origin,
    /// All its fields' numbers, one after the other.
    pub parameters: Vec<f64>,
}

macro_rules! effects {
    ($($on:ident $law:ident $file:ident $conservative:literal $what:literal $source:literal;)*) => {
        /// The effects by number: each variant is called as scenes call it.
        #[allow(non_camel_case_types)]
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub enum EffectId {
            $(#[doc = $what] $file,)*
        }

        const ROWS: &[Effect] = &[$(
            Effect { id: EffectId::$file, name: stringify!($file), on: On::$on, what: $what, source: $source, fields: $file::FIELDS },
        )*];

        impl EffectId {
        }

    };
}

effects! {
    Joint inertia armature true "M_ii += I n²: a rotor of inertia I behind a gear n, that turns about the joint's axis alone" "Featherstone 2008, §9.6";
    Joint force damping false "−d v" "Rayleigh 1873";
    Joint force friction false "−μ v/√(v² + s²): Coulomb friction, smooth for rates below s" "Coulomb 1781; smoothed as in Hairer & Wanner 1996";
    Joint force spring true "−k (q − q₀)" "Hooke 1678";
    Joint force limit false "∓k x max(0, 1 + c ẋ) beyond a bound, x the depth: a stop that pushes and never pulls"
        "Hunt & Crossley, J. Appl. Mech. 42, 1975";
    Joint drive motor false "τ clipped to the torque–speed line of a motor behind a gear, less (1 − η) |τ| v/√(v² + s²)"
        "Hughes & Drury, Electric Motors and Drives, 2013, ch. 3";
    Link wrench drag false "−c |v| v at a point" "Newton 1687; Batchelor 1967, §5.11";
    Link wrench box_drag false "for each axis −c_i |v_i| v_i − b_i v_i and −C_i |ω_i| ω_i − B_i ω_i" "Batchelor 1967, §5.11, §4.9";
    Link wrench buoyancy true "−ρ V g at the centre of the displaced volume" "Archimedes; Fossen 2011, §4.1";
    Link added added_mass true "[m; f] += G V̇ + V ×* G V: fluid that is at rest without the link, moved along" "Fossen 2011, §6.3; Lamb 1932, §124";
    Link wrench contact false "a sphere on the plane nᵀx = h: k x max(0, 1 + c ẋ) along n, and −μ F v_t/√(v_t² + s²)"
        "Hunt & Crossley, J. Appl. Mech. 42, 1975";
}

/// All effects, in the order in which they are listed to people.
pub fn effects() -> &'static [Effect] {
    ROWS
}

/// The effect called `name`.
pub fn effect(name: &str) -> Option<&'static Effect> {
    ROWS.iter().find(|e| e.name == name)
}

impl EffectId {
    /// Its row.
    pub fn row(self) -> &'static Effect {
        &ROWS[self as usize]
    }

    /// Its name in scenes.
    pub fn name(self) -> &'static str {
        self.row().name
    }
}

mod armature {
    use super::Field;
    pub(super) const FIELDS: &[Field] = &[
        Field::number("inertia", "kg·m²|kg", "inertia of the rotor about its own axis").at_least_zero(),
        Field::number("gear", "1", "turns of the rotor a turn of the joint").or(&[1.0]),
    ];
}
mod damping {
    use super::Field;
    pub(super) const FIELDS: &[Field] = &[Field::number("damping", "N·m·s/rad|N·s/m", "torque at the unit rate").at_least_zero()];
}
mod friction {
    use super::Field;
    pub(super) const FIELDS: &[Field] = &[
        Field::number("friction", "N·m|N", "torque of sliding").at_least_zero(),
        Field::number("speed", "rad/s|m/s", "rate below which the law is smooth").positive().or(&[1e-3]),
    ];
}
mod spring {
    use super::Field;
    pub(super) const FIELDS: &[Field] = &[
        Field::number("stiffness", "N·m/rad|N/m", "torque a unit of the coordinate").at_least_zero(),
        Field::number("rest", "rad|m", "coordinate at which it is slack").or(&[0.0]),
    ];
}
mod limit {
    use super::Field;
    pub(super) const FIELDS: &[Field] = &[
        Field::number("lower", "rad|m", "lower bound"),
        Field::number("upper", "rad|m", "upper bound, above the lower"),
        Field::number("stiffness", "N·m/rad|N/m", "torque a unit of depth").at_least_zero(),
        Field::number("damping", "s/rad|s/m", "what a unit rate into the stop adds to the torque, in parts of it")
            .at_least_zero()
            .or(&[0.0]),
    ];
}
mod motor {
    use super::Field;
    pub(super) const FIELDS: &[Field] = &[
        Field::number("torque", "N·m|N", "largest torque of the motor, at a standstill").positive(),
        Field::number("speed", "rad/s|m/s", "speed of the motor at which it has no torque left").positive(),
        Field::number("gear", "1", "turns of the motor a turn of the joint").positive().or(&[1.0]),
        Field::number("efficiency", "1", "of the gear, at most 1").positive().or(&[1.0]),
        Field::number("smooth", "rad/s|m/s", "rate of the joint below which the loss is smooth").positive().or(&[1e-3]),
    ];
}
mod drag {
    use super::Field;
    pub(super) const FIELDS: &[Field] =
        &[Field::number("coefficient", "N·s²/m²", "½ ρ C A: density, drag coefficient and area").at_least_zero()];
}
mod box_drag {
    use super::Field;
    pub(super) const FIELDS: &[Field] = &[
        Field::number("linear", "N·s²/m²", "force along each axis at the unit speed, quadratic").at_least_zero().of(3),
        Field::number("angular", "N·m·s²", "moment about each axis at the unit rate, quadratic").at_least_zero().of(3),
        Field::number("viscous_linear", "N·s/m", "force at the unit speed, linear").at_least_zero().or(&[0.0]),
        Field::number("viscous_angular", "N·m·s", "moment at the unit rate, linear").at_least_zero().or(&[0.0]),
    ];
}
mod buoyancy {
    use super::Field;
    pub(super) const FIELDS: &[Field] = &[
        Field::number("volume", "m³", "displaced volume; its centre is the origin of the effect's frame").at_least_zero(),
        Field::number("density", "kg/m³", "of the fluid").at_least_zero().or(&[1000.0]),
    ];
}
mod added_mass {
    use super::Field;
    pub(super) const FIELDS: &[Field] = &[
        Field::number("angular", "kg·m²", "moments about the axes: xx, xy, xz, yy, yz, zz").of(6),
        Field::number("linear", "kg", "masses along the axes: xx, xy, xz, yy, yz, zz").of(6),
        Field::number("coupling", "kg·m", "row by row: moment about an axis at the unit acceleration along another").or(&[0.0; 9]).of(9),
    ];
}
mod contact {
    use super::Field;
    pub(super) const FIELDS: &[Field] = &[
        Field::number("radius", "m", "of the sphere about the origin of the effect's frame").at_least_zero(),
        Field::number("stiffness", "N/m", "force a unit of depth").at_least_zero(),
        Field::number("damping", "s/m", "what a unit speed into the plane adds to the force, in parts of it").at_least_zero(),
        Field::number("friction", "1", "coefficient of friction").at_least_zero(),
        Field::number("speed", "m/s", "sliding speed below which friction is smooth").positive().or(&[1e-2]),
        Field::number("normal", "1", "outward normal of the plane in the base frame, of any length").or(&[0.0, 0.0, 1.0]).of(3),
        Field::number("height", "m", "of the plane along its normal, from the base frame's origin").or(&[0.0]),
    ];
}
