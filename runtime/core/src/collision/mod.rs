//! Where two shapes touch: a file for each sort of pair.
//!
//! Each pair has a fixed number of places where it may touch. All of them are computed; whether one
//! exists is a number, 1 or 0. The points, distances and axes are those of MuJoCo, which gives the
//! same number of contacts in the same places. Other pairs need an iteration (GJK) and have none
//! here.

mod capsule_box;
mod cuboids;
mod plane;
mod round;
mod solid;

use alloc::string::String;
use alloc::vec::Vec;

use crate::Scalar;
use crate::index::BodyId;
use crate::scalar::flag;
use crate::spatial::{Matrix3, Placement, Vector3};

/// A shape of a body.
#[derive(Clone, Debug, PartialEq)]
pub struct Shape<S = f64> {
    /// Its name.
    pub name: String,
    /// The body; the base for shapes of the world.
    pub body: BodyId,
    /// Its frame in the body's frame.
    pub placement: Placement<S>,
    /// Its form.
    pub form: Form<S>,
}

/// The form of a shape, about the origin of its frame. Sizes in m.
#[derive(Clone, Debug, PartialEq)]
pub enum Form<S = f64> {
    /// Everything below z = 0.
    Plane,
    /// A ball.
    Sphere {
        /// Its radius.
        radius: S,
    },
    /// A cylinder along z with half a ball on each end.
    Capsule {
        /// Its radius.
        radius: S,
        /// Half the length of the cylinder alone.
        half: S,
    },
    /// An ellipsoid along the axes.
    Ellipsoid {
        /// Half its axes.
        radii: [S; 3],
    },
    /// A cylinder along z.
    Cylinder {
        /// Its radius.
        radius: S,
        /// Half its length.
        half: S,
    },
    /// A box along the axes.
    Box {
        /// Half its sides.
        half: [S; 3],
    },
}

/// A place where two shapes may touch.
#[derive(Clone, Debug)]
pub struct Touch<S> {
    /// 1, or 0 where the pair has no such place in this state.
    pub exists: S,
    /// From shape to shape, m: negative where they overlap.
    pub distance: S,
    /// Half way between both shapes, m.
    pub point: Vector3<S>,
    /// From the first shape to the second, of length one.
    pub normal: Vector3<S>,
    /// An axis that is not along the normal. `None`: y, or z where the normal is near y.
    pub tangent: Option<Vector3<S>>,
}

impl<S: Scalar> Touch<S> {
    /// The normal, and two axes across it.
    pub fn frame(&self) -> [Vector3<S>; 3] {
        let n = self.normal;
        let (zero, one, half) = (S::zero(), S::one(), S::from_f64(0.5));
        let tangent = self.tangent.unwrap_or_else(|| {
            let is_near_y = flag::<S>((n.y.abs() - half).positive());
            let at_half = one - flag::<S>((half - n.y.abs()).positive());
            let along_z = S::select((is_near_y + at_half).positive(), one, zero);
            Vector3::new(zero, one - along_z, along_z)
        });
        let across = tangent - n * n.dot(&tangent);
        let length = across.dot(&across).sqrt();
        let across = across.map(|x| x / length);
        [n, across, n.cross(&across)]
    }
}

/// A shape at its place.
pub(crate) struct Placed<'a, S> {
    pub(crate) form: &'a Form<S>,
    pub(crate) rotation: Matrix3<S>,
    pub(crate) position: Vector3<S>,
}

impl<S: Scalar> Placed<'_, S> {
    fn axis(&self, k: usize) -> Vector3<S> {
        self.rotation.column(k).into_owned()
    }
}

impl<S: Scalar> Shape<S> {
    /// The same with `f` of each constant, always in the same order.
    pub fn map<T: Scalar>(&self, f: impl Fn(S) -> T + Copy) -> Shape<T> {
        let form = self.form.map(f);
        Shape { name: self.name.clone(), body: self.body, placement: self.placement.map(f), form }
    }
}

impl<S: Scalar> Form<S> {
    /// The same with `f` of each size, always in the same order.
    pub(crate) fn map<T: Scalar>(&self, f: impl Fn(S) -> T) -> Form<T> {
        match *self {
            Self::Plane => Form::Plane,
            Self::Sphere { radius } => Form::Sphere { radius: f(radius) },
            Self::Capsule { radius, half } => Form::Capsule { radius: f(radius), half: f(half) },
            Self::Ellipsoid { radii } => Form::Ellipsoid { radii: radii.map(f) },
            Self::Cylinder { radius, half } => Form::Cylinder { radius: f(radius), half: f(half) },
            Self::Box { half } => Form::Box { half: half.map(f) },
        }
    }

    /// The radius of a sphere around it; of a plane 0.
    fn radius(&self) -> S {
        match self {
            Self::Plane => S::zero(),
            Self::Sphere { radius } => *radius,
            Self::Capsule { radius, half } => *radius + *half,
            Self::Cylinder { radius, half } => (*radius * *radius + *half * *half).sqrt(),
            Self::Ellipsoid { radii: [a, b, c] } | Self::Box { half: [a, b, c] } => (*a * *a + *b * *b + *c * *c).sqrt(),
        }
    }
}

impl<S> Form<S> {
    /// Its name.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Plane => "plane",
            Self::Sphere { .. } => "sphere",
            Self::Capsule { .. } => "capsule",
            Self::Ellipsoid { .. } => "ellipsoid",
            Self::Cylinder { .. } => "cylinder",
            Self::Box { .. } => "box",
        }
    }

    /// The place in the order of shapes of a pair.
    pub fn rank(&self) -> usize {
        match self {
            Self::Plane => 0,
            Self::Sphere { .. } => 1,
            Self::Capsule { .. } => 2,
            Self::Ellipsoid { .. } => 3,
            Self::Cylinder { .. } => 4,
            Self::Box { .. } => 5,
        }
    }

    /// In how many places two shapes may touch, the one of lower rank first. `None`: the pair is
    /// not computed.
    pub fn places(first: &Self, second: &Self) -> Option<usize> {
        match (first, second) {
            (Self::Plane, Self::Plane) => None,
            (Self::Plane, Self::Sphere { .. } | Self::Ellipsoid { .. }) => Some(1),
            (Self::Plane, Self::Capsule { .. }) => Some(2),
            (Self::Plane, Self::Cylinder { .. }) => Some(4),
            (Self::Plane, Self::Box { .. }) => Some(8),
            (Self::Sphere { .. }, Self::Ellipsoid { .. }) => None,
            (Self::Sphere { .. }, _) => Some(1),
            (Self::Capsule { .. }, Self::Capsule { .. }) => Some(2),
            (Self::Capsule { .. }, Self::Box { .. }) => Some(2),
            (Self::Box { .. }, Self::Box { .. }) => Some(cuboids::PLACES),
            _ => None,
        }
    }
}

/// Positive where two shapes may be less than `reach` apart, by spheres around them. The first may
/// be a plane.
pub(crate) fn are_near<S: Scalar>([first, second]: &[Placed<'_, S>; 2], reach: S) -> S {
    let apart = second.position - first.position;
    let most = (first.form.radius() + second.form.radius()) * S::from_f64(SLACK) + reach;
    match first.form {
        Form::Plane => most - first.axis(2).dot(&apart),
        _ => most * most - apart.dot(&apart),
    }
}

/// Spheres around shapes are larger by this factor, so that rounding does not count.
const SLACK: f64 = 1.0 + 1e-6;

/// The places where two shapes may touch, the one of lower rank first, as many as
/// [`Form::places`] says. `reach`: a place beyond this distance does not count, m.
pub(crate) fn touches<S: Scalar>(first: &Placed<'_, S>, second: &Placed<'_, S>, reach: S) -> Vec<Touch<S>> {
    use Form::{Box, Capsule, Cylinder, Ellipsoid, Plane, Sphere};
    match (first.form, second.form) {
        (Plane, Sphere { radius }) => [plane::sphere(first, second.position, *radius)].into(),
        (Plane, Capsule { radius, half }) => plane::capsule(first, second, *radius, *half).into(),
        (Plane, Ellipsoid { radii }) => [plane::ellipsoid(first, second, *radii)].into(),
        (Plane, Cylinder { radius, half }) => plane::cylinder(first, second, *radius, *half, reach).into(),
        (Plane, Box { half }) => plane::cuboid(first, second, *half, reach),
        (Sphere { radius }, Sphere { radius: other }) => [round::spheres(first, second, *radius, *other)].into(),
        (Sphere { radius }, Capsule { radius: other, half }) => [round::sphere_capsule(first, second, *radius, *other, *half)].into(),
        (Sphere { radius }, Cylinder { radius: other, half }) => [solid::sphere_cylinder(first, second, *radius, *other, *half)].into(),
        (Sphere { radius }, Box { half }) => [solid::sphere_box(first, second, *radius, *half)].into(),
        (Capsule { radius, half }, Capsule { radius: other, half: length }) => {
            round::capsules(first, second, [*radius, *half], [*other, *length]).into()
        }
        (Capsule { radius, half }, Box { half: sides }) => capsule_box::capsule_box(first, second, [*radius, *half], *sides, reach).into(),
        (Box { half }, Box { half: other }) => cuboids::boxes(first, second, [*half, *other], reach),
        _ => Vec::new(),
    }
}
