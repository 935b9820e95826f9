//! The contacts of a scene in a state: position, whether they press, and force.

use articulated_core::effect::{Applied, EffectId, Station, unit, wrench};
use articulated_core::index::FrameId;
use articulated_core::spatial::{Matrix3, Placement, Twist, Vector3};

use crate::session::{Session, field};

/// A contact: a sphere of a link on a plane.
pub(crate) struct Contact {
    /// The link.
    pub(crate) on: String,
    frame: FrameId,
    /// The sphere's centre in the link's frame, m.
    point: Vector3<f64>,
    /// The numbers of its law; the normal has length one.
    parameters: Vec<f64>,
    /// Outward normal of the plane in the world frame.
    pub(crate) normal: Vector3<f64>,
    /// Distance of the centre from the origin along the normal, m, below which it presses.
    reach: f64,
    pub(crate) radius: f64,
    pub(crate) stiffness: f64,
    pub(crate) friction: f64,
    /// Sliding speed below which friction is smooth, m/s.
    pub(crate) speed: f64,
}

/// Frames in a state, `[frames][12]` and `[frames][6]`.
pub(crate) struct Frames<'a> {
    /// Rotations row by row, then positions.
    pub(crate) places: &'a [f64],
    /// [ω; ṗ] in world axes.
    pub(crate) twists: &'a [f64],
    /// m/s².
    pub(crate) gravity: Vector3<f64>,
}

/// A contact in a state, in world axes.
#[derive(Clone, Copy)]
pub(crate) struct Touch {
    /// The sphere's centre, m.
    pub(crate) centre: Vector3<f64>,
    /// The axes of the link.
    rotation: Matrix3<f64>,
    /// Whether it presses.
    pub(crate) presses: bool,
    /// Force along the normal, N.
    pub(crate) press: f64,
    /// Force across the normal, N.
    pub(crate) drag: Vector3<f64>,
    /// Sliding speed of the lowest point, m/s, and the sum of the two speeds whose difference it
    /// is: the centre's speed, and that of the lowest point about the centre.
    pub(crate) sliding: f64,
    pub(crate) rates: f64,
}

impl Session {
    /// All contacts of the scene.
    pub(crate) fn contacts(&self) -> Vec<Contact> {
        self.effects_of(EffectId::contact).filter_map(|applied| Contact::of(self, applied)).collect()
    }
}

impl Contact {
    fn of(session: &Session, applied: &Applied) -> Option<Self> {
        let one = |name: &str| field(applied, name).first().copied();
        let normal = unit(field(applied, "normal").try_into().ok()?)?;
        let frame = session.model.frames().position(|frame| frame.name == applied.on)?;
        let mut parameters = applied.parameters.clone();
        let at = applied.effect.row().fields.iter().take_while(|f| f.name != "normal").map(|f| f.len).sum::<usize>();
        parameters.get_mut(at..at + 3)?.copy_from_slice(&normal);
        Some(Self {
            on: applied.on.clone(),
            frame,
            point: Vector3::from(applied.at.xyz),
            parameters,
            normal: Vector3::from(normal),
            reach: one("height")? + one("radius")?,
            radius: one("radius")?,
            stiffness: one("stiffness")?,
            friction: one("friction")?,
            speed: one("speed")?,
        })
    }

    /// The contact in a state; at rest at the origin if the state has no such frame.
    pub(crate) fn at(&self, frames: &Frames<'_>) -> Touch {
        let number = |x: &[f64], each: usize, k: usize| x.get(each * self.frame.0 + k).copied().unwrap_or(0.0);
        let place = |k: usize| number(frames.places, 12, k);
        let rotation = Matrix3::from_fn(|i, j| place(3 * i + j));
        let [position, omega, rate] = [
            Vector3::from_fn(|k, _| place(9 + k)),
            Vector3::from_fn(|k, _| number(frames.twists, 6, k)),
            Vector3::from_fn(|k, _| number(frames.twists, 6, 3 + k)),
        ];
        let arm = rotation * self.point;
        let centre = position + arm;
        let station = Station {
            placement: Placement { rotation: Matrix3::identity(), position: centre },
            twist: Twist { angular: omega, linear: rate + omega.cross(&arm) },
            gravity: frames.gravity,
        };
        let force = wrench(EffectId::contact, &self.parameters, &station).map_or_else(Vector3::zeros, |wrench| wrench.force);
        let press = self.normal.dot(&force);
        let about = omega.cross(&(self.normal * -self.radius));
        let [carried, turned, sliding] = [station.twist.linear, about, station.twist.linear + about].map(|v| self.along_plane(v).norm());
        let presses = self.normal.dot(&centre) < self.reach;
        Touch { centre, rotation, presses, press, drag: force - self.normal * press, sliding, rates: carried + turned }
    }

    /// The component of a vector along the plane.
    pub(crate) fn along_plane(&self, x: Vector3<f64>) -> Vector3<f64> {
        x - self.normal * self.normal.dot(&x)
    }

    /// Path of the sphere's lowest point along the plane from one state to a close one, m: less
    /// than that of its centre if it rolls.
    pub(crate) fn slip(&self, from: &Touch, to: &Touch) -> Vector3<f64> {
        let turn = to.rotation * from.rotation.transpose();
        let angle = Vector3::new(turn[(2, 1)] - turn[(1, 2)], turn[(0, 2)] - turn[(2, 0)], turn[(1, 0)] - turn[(0, 1)]) * 0.5;
        self.along_plane(to.centre - from.centre - angle.cross(&(self.normal * self.radius)))
    }
}
