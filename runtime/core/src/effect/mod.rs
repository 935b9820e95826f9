//! Effects beyond rigid bodies in a gravity field: of joints, links and their surroundings.
//!
//! One effect, one file: its law, generic over the scalar, with its source; and one row in the
//! table below. The effects on a robot are stored with its bodies ([`Effects`]) by
//! [`crate::model::Model::with_effects`]. An absent effect costs nothing.
//!
//! Forces are those on the robot: −d v for damping. Inverse dynamics includes the forces of the
//! actuators against them.

mod added_mass;
mod apply;
mod armature;
mod box_drag;
mod buoyancy;
mod contact;
mod damping;
mod drag;
mod ellipsoid_drag;
mod friction;
mod gravity_compensation;
mod limit;
mod motor;
mod places;
mod polynomial_damping;
mod polynomial_spring;
mod range;
mod spring;
mod station;
mod tether;
mod unit;

use alloc::string::String;
use alloc::vec::Vec;
use core::marker::PhantomData;

pub use apply::{EffectError, EffectErrors, Fault};
pub use range::{Range, Rule};
pub use station::Station;
pub use unit::unit;

use crate::Scalar;
use crate::description::Origin;
use crate::dual::Dual;
use crate::joint::Joint;
use crate::spatial::screw::Quaternion;
use crate::spatial::{ArticulatedInertia, Placement, Vector3, Wrench};

/// Target of an effect.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum On {
    /// Each degree of freedom of a joint.
    Joint,
    /// A frame in a link.
    Link,
}

/// How an effect enters the equations.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Enters {
    /// As inertia of a degree of freedom, on the diagonal of the mass matrix.
    Inertia,
    /// As a force on a degree of freedom, by its rate.
    ForceOfRate,
    /// As a force on a degree of freedom, by its coordinate and its rate; on a ball joint as a
    /// torque, by its rotation and its rates.
    ForceOfCoordinate,
    /// It transforms the commanded torque.
    Drive,
    /// As a wrench on a frame.
    Wrench,
    /// As inertia in a frame, of something that gravity does not act on.
    Added,
}

impl Enters {
    /// The target of such an effect.
    const fn on(self) -> On {
        match self {
            Self::Inertia | Self::ForceOfRate | Self::ForceOfCoordinate | Self::Drive => On::Joint,
            Self::Wrench | Self::Added => On::Link,
        }
    }
}

/// A parameter of an effect: one number or several.
#[derive(Clone, Copy, Debug)]
pub struct Field {
    /// Its key in scenes.
    pub name: &'static str,
    /// How many numbers.
    pub len: usize,
    /// Its unit.
    pub unit: &'static str,
    /// Its numbers if a scene does not have them; `None`: a scene must have them.
    pub default: Option<&'static [f64]>,
    /// The field that makes it optional: if a scene has that one, this one is 0.
    pub unless: Option<&'static str>,
    /// The range of each of its numbers.
    pub range: Range,
    /// A further condition.
    pub rule: Option<Rule>,
    /// Whether the effect vanishes if this field is zero.
    pub zeros: Zeros,
    /// Whether it is a vector of any length, of which only the direction counts.
    pub is_direction: bool,
    /// Its meaning.
    pub what: &'static str,
}

/// Role of a field in an effect when all its numbers are 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Zeros {
    /// The effect does not vanish.
    Count,
    /// The effect vanishes: all of it is multiplied by this.
    Nothing,
    /// The effect vanishes if all such fields are 0: it is a sum of parts, each multiplied by one
    /// of them.
    NothingTogether,
}

impl Field {
    /// Any number; required.
    const fn number(name: &'static str, unit: &'static str, what: &'static str) -> Self {
        Self {
            name,
            len: 1,
            unit,
            default: None,
            unless: None,
            range: Range::ALL,
            rule: None,
            zeros: Zeros::Count,
            is_direction: false,
            what,
        }
    }

    /// Not negative.
    const fn at_least_zero(self) -> Self {
        Self { range: Range::NOT_NEGATIVE, ..self }
    }

    const fn positive(self) -> Self {
        Self { range: Range::POSITIVE, ..self }
    }

    /// A rate below which a law is smooth: its square is a number in single precision too.
    const fn smooth(self) -> Self {
        Self { range: Range::from(1e-15), ..self }
    }

    const fn at_most(self, at_most: f64) -> Self {
        Self { range: Range { at_most, ..self.range }, ..self }
    }

    /// A rule on all numbers of the effect, and its text for this field.
    const fn rule(self, holds: fn(&[f64]) -> bool, expected: &'static str) -> Self {
        Self { rule: Some(Rule { holds, expected }), ..self }
    }

    const fn factor(self) -> Self {
        Self { zeros: Zeros::Nothing, ..self }
    }

    const fn part(self) -> Self {
        Self { zeros: Zeros::NothingTogether, ..self }
    }

    const fn or(self, default: &'static [f64]) -> Self {
        Self { default: Some(default), ..self }
    }

    /// Required unless another field is given.
    const fn unless(self, other: &'static str) -> Self {
        Self { unless: Some(other), ..self }
    }

    const fn of(self, len: usize) -> Self {
        Self { len, ..self }
    }

    const fn direction(self) -> Self {
        Self { is_direction: true, ..self }
    }

    /// A quaternion (x, y, z, w) of any length, from parameter `AT` of the effect on.
    const fn quaternion<const AT: usize>(self) -> Self {
        let holds = |p: &[f64]| p[AT..AT + 4].iter().any(|x| *x != 0.0);
        self.of(4).or(&[0.0, 0.0, 0.0, 1.0]).rule(holds, "a quaternion: four numbers that are not all 0").direction()
    }
}

/// One row: an effect that a scene may call for.
#[derive(Clone, Copy, Debug)]
pub struct Effect {
    /// Its number.
    pub id: EffectId,
    /// Its name in scenes.
    pub name: &'static str,
    /// Its target.
    pub on: On,
    /// How it does.
    pub enters: Enters,
    /// Whether no energy is lost or gained.
    pub conservative: bool,
    /// The law.
    pub what: &'static str,
    /// Where the law is from.
    pub source: &'static str,
    /// Its parameters, in order.
    pub fields: &'static [Field],
    /// The fields on a ball joint, in order, if its law is another one; each has the name of one of
    /// `fields`.
    pub ball_fields: Option<&'static [Field]>,
}

impl Effect {
    /// How many numbers its parameters are; those on a ball joint may be others.
    pub fn len(&self) -> usize {
        sum(self.fields)
    }

    /// Whether it has none.
    pub fn is_empty(&self) -> bool {
        self.fields.is_empty()
    }

    /// Its parameters on a joint of this kind; on a link those of any.
    pub fn fields_on(&self, joint: Joint) -> &'static [Field] {
        self.ball_fields.filter(|_| self.is_of_rotation(joint)).unwrap_or(self.fields)
    }

    /// Whether the law on a joint of this kind is one of its rotation about a point, with all its
    /// rates: it acts there once, not on each degree of freedom.
    pub fn is_of_rotation(&self, joint: Joint) -> bool {
        self.ball_fields.is_some() && joint.is_rotation_about_point()
    }

    /// The fields of `count` parameters: a ball joint has another number of them than other joints.
    /// Without such fields, those of other joints.
    pub fn fields_of(&self, count: usize) -> &'static [Field] {
        self.ball_fields.filter(|fields| sum(fields) == count).unwrap_or(self.fields)
    }

    /// The first field whose rule these numbers break, with its part of them; `None` also if their
    /// number is wrong.
    pub fn broken<'a>(&self, parameters: &'a [f64]) -> Option<(&'static Field, &'a [f64])> {
        let fields = self.fields_of(parameters.len());
        if parameters.len() != sum(fields) {
            return None;
        }
        let mut rest = parameters;
        fields.iter().find_map(|field| {
            let (own, others) = rest.split_at(field.len);
            rest = others;
            field.rule.filter(|rule| !(rule.holds)(parameters)).map(|_| (field, own))
        })
    }

    /// Whether these parameters make the effect vanish; then it is left out.
    pub fn is_nothing(&self, parameters: &[f64]) -> bool {
        let (mut rest, mut parts) = (parameters, Vec::new());
        let mut zero = |field: &Field| {
            let (own, others) = rest.split_at_checked(field.len).unwrap_or((rest, &[]));
            rest = others;
            own.iter().all(|x| *x == 0.0)
        };
        for field in self.fields_of(parameters.len()) {
            match (field.zeros, zero(field)) {
                (Zeros::Nothing, true) => return true,
                (Zeros::NothingTogether, zero) => parts.push(zero),
                _ => {}
            }
        }
        !parts.is_empty() && parts.into_iter().all(|zero| zero)
    }

    /// Whether a joint of this kind has the quantity of the law: a coordinate for each degree of
    /// freedom, or a rotation about a point.
    pub fn acts_on(&self, joint: Joint) -> bool {
        self.enters != Enters::ForceOfCoordinate || joint.quaternion().is_none() || self.is_of_rotation(joint)
    }
}

/// An effect as requested by a scene.
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

/// A law on a degree of freedom: the force at the coordinate q, rad|m, and the rate v. One of the
/// rate alone is a function, and stores no energy.
trait Force {
    fn force<S: Scalar>(p: &[S], q: S, v: S) -> S;

    /// The energy that it stores, J.
    fn energy<S: Scalar>(p: &[S], q: S) -> S;
}

/// A law on a ball joint: the torque at the rotation vector φ = log(q₀⁻¹ q), rad, and the rates ω,
/// rad/s, all in axes of the child; |φ| ≤ π.
trait BallForce {
    /// q₀.
    fn rest<S: Scalar>(_p: &[S]) -> Quaternion<S> {
        Quaternion::identity()
    }

    fn torque<S: Scalar>(p: &[S], phi: Vector3<S>, omega: Vector3<S>) -> Vector3<S>;

    /// The energy that it stores, J.
    fn energy<S: Scalar>(p: &[S], phi: Vector3<S>) -> S;
}

/// A law on a frame of a link: the wrench about the frame's origin, in its axes.
trait FrameForce {
    fn wrench<S: Scalar>(p: &[S], at: &Station<S>) -> Wrench<S>;

    /// The energy that it stores, J.
    fn energy<S: Scalar>(_p: &[S], _at: &Station<S>) -> S {
        S::zero()
    }

    /// Whether steps implicit in velocity use the slopes of the wrench in the twist.
    const HAS_DAMPING: bool = false;

    /// −∂(m, f)/∂(ω, v) in the axes of the frame.
    fn damping<S: Scalar>(_p: &[S], _at: &Station<S>) -> Slopes<S> {
        Slopes::Diagonal([S::zero(); 6])
    }
}

/// −∂(m, f)/∂(ω, v) of a wrench, N·m·s, N·s and N·s/m.
#[derive(Clone, Copy)]
pub(crate) enum Slopes<S> {
    /// Along and about the axes alone.
    Diagonal([S; 6]),
    /// Row by row.
    All([[S; 6]; 6]),
}

impl<S: Scalar> Slopes<S> {
    /// The moment and the force for a twist, by the part of the slopes that is symmetric.
    pub(crate) fn symmetric(&self, twist: &[S; 6]) -> [S; 6] {
        match self {
            Self::Diagonal(own) => core::array::from_fn(|k| own[k] * twist[k]),
            Self::All(own) => {
                let half = S::from_f64(0.5);
                core::array::from_fn(|i| (0..6).fold(S::zero(), |sum, j| sum + half * (own[i][j] + own[j][i]) * twist[j]))
            }
        }
    }

    /// The same by the part that is antisymmetric; `None`: there is none.
    pub(crate) fn antisymmetric(&self, twist: &[S; 6]) -> Option<[S; 6]> {
        let Self::All(own) = self else { return None };
        let half = S::from_f64(0.5);
        Some(core::array::from_fn(|i| (0..6).fold(S::zero(), |sum, j| sum + half * (own[i][j] - own[j][i]) * twist[j])))
    }
}

/// How an effect enters the equations. Laws come with their duals, for derivatives.
pub(crate) enum Law<S: 'static> {
    /// Inertia on the diagonal of the mass matrix.
    Inertia(fn(&[S]) -> S),
    /// A force on a degree of freedom. `ball` is the law on ball joints, if it is another one.
    Force {
        force: OnFreedom<S>,
        slope: OnFreedom<Dual<S>>,
        energy: fn(&[S], S) -> S,
        rise: fn(&[Dual<S>], Dual<S>) -> Dual<S>,
        ball: Option<BallLaw<S>>,
    },
    /// The torque at the joint for a commanded torque, depending on the rate.
    Drive { torque: OnFreedom<S>, slope: OnFreedom<Dual<S>> },
    /// A wrench on a frame.
    Wrench {
        wrench: AtStation<S, Wrench<S>>,
        slope: AtStation<Dual<S>, Wrench<Dual<S>>>,
        energy: AtStation<S, S>,
        rise: AtStation<Dual<S>, Dual<S>>,
        damping: Option<AtStation<S, Slopes<S>>>,
    },
    /// Inertia in a frame, of something that gravity does not act on.
    Added(fn(&[S]) -> ArticulatedInertia<S>),
}

/// A torque on a ball joint, at φ from the rotation `rest`.
pub(crate) struct BallLaw<S: 'static> {
    pub(crate) rest: fn(&[S]) -> Quaternion<S>,
    pub(crate) torque: OnBall<S>,
    pub(crate) slope: OnBall<Dual<S>>,
    pub(crate) energy: StoredOnBall<S>,
    pub(crate) rise: StoredOnBall<Dual<S>>,
}

type OnBall<S> = fn(&[S], Vector3<S>, Vector3<S>) -> Vector3<S>;
type StoredOnBall<S> = fn(&[S], Vector3<S>) -> S;
type OnFreedom<S> = fn(&[S], S, S) -> S;
type AtStation<S, T> = fn(&[S], &Station<S>) -> T;

macro_rules! law {
    (Inertia $file:ident) => {
        Law::Inertia($file::inertia)
    };
    (ForceOfRate $file:ident) => {
        Law::Force {
            force: |p, _, v| $file::force(p, v),
            slope: |p, _, v| $file::force(p, v),
            energy: |_, _| S::zero(),
            rise: |_, _| Dual::constant(S::zero()),
            ball: None,
        }
    };
    (ForceOfCoordinate $file:ident) => {
        Law::Force {
            force: <$file::Law as Force>::force,
            slope: <$file::Law as Force>::force,
            energy: <$file::Law as Force>::energy,
            rise: <$file::Law as Force>::energy,
            ball: Some(BallLaw {
                rest: $file::Law::rest,
                torque: $file::Law::torque,
                slope: $file::Law::torque,
                energy: <$file::Law as BallForce>::energy,
                rise: <$file::Law as BallForce>::energy,
            }),
        }
    };
    (Drive $file:ident) => {
        Law::Drive { torque: $file::torque, slope: $file::torque }
    };
    (Wrench $file:ident) => {
        Law::Wrench {
            wrench: $file::Law::wrench,
            slope: $file::Law::wrench,
            energy: $file::Law::energy,
            rise: $file::Law::energy,
            damping: if $file::Law::HAS_DAMPING { Some($file::Law::damping) } else { None },
        }
    };
    (Added $file:ident) => {
        Law::Added($file::inertia)
    };
}

macro_rules! ball_fields {
    (ForceOfCoordinate $file:ident) => {
        Some($file::BALL_FIELDS)
    };
    ($enters:ident $file:ident) => {
        None
    };
}

macro_rules! effects {
    ($($enters:ident $file:ident $conservative:literal $what:literal $source:literal;)*) => {
        /// The effects by number: each variant is called as scenes call it.
        #[allow(non_camel_case_types)]
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub enum EffectId {
            $(#[doc = $what] $file,)*
        }

        const ROWS: &[Effect] = &[$(
            Effect {
                id: EffectId::$file,
                name: stringify!($file),
                on: Enters::$enters.on(),
                enters: Enters::$enters,
                conservative: $conservative,
                what: $what,
                source: $source,
                fields: $file::FIELDS,
                ball_fields: ball_fields!($enters $file),
            },
        )*];

        struct Table<S>(PhantomData<S>);

        impl<S: Scalar> Table<S> {
            const LAWS: &'static [Law<S>] = &[$(law!($enters $file),)*];
        }
    };
}

effects! {
    Inertia armature true "M_ii += I n²: a rotor of inertia I behind a gear n, that rotates about the joint's axis alone" "Featherstone 2008, §9.6";
    ForceOfRate damping false "−d v" "Rayleigh 1873";
    ForceOfRate polynomial_damping false "−d₂ |v| v − d₃ v³, beside `damping`" "MuJoCo documentation, damping of joints";
    ForceOfRate friction false "−μ v/√(v² + s²): Coulomb friction, smooth for rates below s" "Coulomb 1781; smoothed as in Hairer & Wanner 1996";
    ForceOfCoordinate spring true "−k (q − q₀); on a ball −k log(q₀⁻¹ q), the rotation vector in axes of the child" "Hooke 1678";
    ForceOfCoordinate polynomial_spring true "x = q − q₀: −k₂ x² − k₃ x³, beside `spring`; on a ball −(k₂ |φ| + k₃ |φ|²) φ, φ = log(q₀⁻¹ q)"
        "MuJoCo documentation, stiffness of joints";
    ForceOfCoordinate limit false "∓k x max(0, 1 + c ẋ) beyond a bound, x the depth: a stop that pushes and never pulls; on a ball for the angle of the rotation"
        "Hunt & Crossley, J. Appl. Mech. 42, 1975";
    Drive motor false "τ clipped to the torque–speed line of a motor behind a gear, less (1 − η) |τ| v/√(v² + s²)"
        "Hughes & Drury, Electric Motors and Drives, 2013, ch. 3";
    Wrench drag false "−c |v| v at a point" "Newton 1687; Batchelor 1967, §5.11";
    Wrench box_drag false "for each axis −c_i |v_i| v_i − b v_i and −C_i |ω_i| ω_i − B ω_i" "Batchelor 1967, §5.11, §4.9";
    Wrench ellipsoid_drag false "an ellipsoid in a fluid that moves past it: drag along and about its axes, Magnus and Kutta lift, and the momentum of added mass"
        "MuJoCo documentation, Fluid forces, Ellipsoid model; virtual masses: Lamb 1932, ch. V";
    Wrench buoyancy true "−ρ V g at the centre of the displaced volume" "Archimedes; Fossen 2011, §4.1";
    Wrench gravity_compensation true "−m g at a centre of mass: the weight of a mass m is carried" "MuJoCo documentation, gravcomp";
    Wrench tether true "x of the frame from a place in the world: −(k₁ + k₂ |x| + k₃ |x|²) x; the same with the rotation vector from an orientation"
        "Hooke 1678; MuJoCo documentation, stiffness of free joints";
    Added added_mass true "[m; f] += G V̇ + V ×* G V: fluid that is at rest without the link, moved along" "Fossen 2011, §6.3; Lamb 1932, §124";
    Wrench contact false "a sphere on the plane nᵀx = h: k x max(0, 1 + c ẋ + T ẋ/√(x² + T²ẋ²)) along n, and −μ F v_t/√(v_t² + s²)"
        "Hunt & Crossley, J. Appl. Mech. 42, 1975; with T it rests as Kelvin and Voigt's spring and damper";
}

/// The wrench of an effect on a frame of a link, about the frame's origin and in its axes; `None`
/// for an effect that does not act by a wrench. `parameters` are those of the effect's fields, with
/// directions of length one.
///
/// # Panics
/// If there are fewer parameters than the effect has.
pub fn wrench(effect: EffectId, parameters: &[f64], at: &Station<f64>) -> Option<Wrench<f64>> {
    match effect.law::<f64>() {
        Law::Wrench { wrench, .. } => Some(wrench(parameters, at)),
        _ => None,
    }
}

/// All effects, in the order of printed lists.
pub fn effects() -> &'static [Effect] {
    ROWS
}

/// The largest number of parameters of an effect.
pub(crate) const fn most_parameters() -> usize {
    let (mut most, mut i) = (0, 0);
    while i < ROWS.len() {
        let len = sum(ROWS[i].fields);
        most = if len > most { len } else { most };
        if let Some(fields) = ROWS[i].ball_fields {
            // Fields are identified by the number of parameters.
            assert!(sum(fields) != len);
            most = if sum(fields) > most { sum(fields) } else { most };
        }
        i += 1;
    }
    most
}

/// How many numbers fields have.
const fn sum(fields: &[Field]) -> usize {
    let (mut len, mut k) = (0, 0);
    while k < fields.len() {
        len += fields[k].len;
        k += 1;
    }
    len
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

    pub(crate) fn law<S: Scalar>(self) -> &'static Law<S> {
        &Table::<S>::LAWS[self as usize]
    }
}

/// The effects on a body and on its joint.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Effects<S> {
    /// On the joint.
    pub joint: Vec<JointEffect<S>>,
    /// On frames of the body.
    pub body: Vec<BodyEffect<S>>,
}

/// An effect on one degree of freedom of a joint, or on the rotation of a ball joint.
#[derive(Clone, Debug, PartialEq)]
pub struct JointEffect<S> {
    /// Which.
    pub effect: EffectId,
    /// The degree of freedom, counted from the joint's first; the first, of a law on all those of a
    /// ball joint.
    pub freedom: usize,
    /// As the effect's fields say.
    pub parameters: Vec<S>,
}

/// An effect on a frame of a body.
#[derive(Clone, Debug, PartialEq)]
pub struct BodyEffect<S> {
    /// Which.
    pub effect: EffectId,
    /// The link that it is on, one of those of the body.
    pub link: String,
    /// Its frame in the body's frame.
    pub placement: Placement<S>,
    /// As the effect's fields say.
    pub parameters: Vec<S>,
}

impl<S: Scalar> Effects<S> {
    /// No effects.
    pub fn none() -> Self {
        Self { joint: Vec::new(), body: Vec::new() }
    }

    /// The same with `f` of each constant, always in the same order.
    pub fn map<T: Scalar>(&self, f: impl Fn(S) -> T + Copy) -> Effects<T> {
        let all = |p: &[S]| p.iter().map(|x| f(*x)).collect();
        let joint = |e: &JointEffect<S>| JointEffect { effect: e.effect, freedom: e.freedom, parameters: all(&e.parameters) };
        let body = |e: &BodyEffect<S>| {
            let (effect, link, placement) = (e.effect, e.link.clone(), e.placement.map(f));
            BodyEffect { effect, link, placement, parameters: all(&e.parameters) }
        };
        Effects { joint: self.joint.iter().map(joint).collect(), body: self.body.iter().map(body).collect() }
    }

    /// The effects and the places where they act, without their numbers.
    pub fn kinds(&self) -> Vec<(EffectId, usize)> {
        let joint = self.joint.iter().map(|e| (e.effect, e.freedom));
        joint.chain(self.body.iter().map(|e| (e.effect, 0))).collect()
    }
}

/// Parameters of a joint that torques are linear in: damping, dry friction and armature.
pub const JOINT_PARAMETERS: usize = 3;

/// The torque that a degree of freedom needs per unit of each: v, v/√(v² + s²) and a, at the rate v
/// and the acceleration a. s is that of its friction, or the default of friction.
pub(crate) fn joint_columns<S: Scalar>(effects: &[JointEffect<S>], freedom: usize, v: S, a: S) -> [S; JOINT_PARAMETERS] {
    let one = S::one();
    let own = effects.iter().find(|e| e.effect == EffectId::friction && e.freedom == freedom);
    let smooth = own.map_or(S::from_f64(friction::SPEED), |e| e.parameters[1]);
    [-damping::force(&[one], v), -friction::force(&[one, smooth], v), armature::inertia(&[one, one]) * a]
}

/// v / √(v² + s²): the sign of v, smooth for |v| below s.
#[inline(always)]
fn smooth_sign<S: Scalar>(v: S, s: S) -> S {
    v / (v * v + s * s).sqrt()
}

/// max(0, x), and 0 for NaN, which is not known to be above.
#[inline(always)]
fn ramp<S: Scalar>(x: S) -> S {
    S::select(x.positive(), x, S::zero())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_stand_in_the_order_of_their_numbers() {
        for (k, row) in effects().iter().enumerate() {
            assert_eq!(row.id as usize, k);
            assert_eq!(effect(row.name).map(|e| e.id), Some(row.id));
            assert!(row.broken(&[]).is_none());
            let named = |field: &Field| row.fields.iter().any(|other| other.name == field.name);
            assert!(row.ball_fields.unwrap_or_default().iter().all(named));
        }
    }
}
