//! A robot as it is drawn: lines between joints, the shapes of links, and for each link the box of
//! even density that has its mass and inertia.

use std::collections::HashMap;

use articulated_core::description::{Base, ById, CollisionShape, Description, Inertial, JointKind, Link, LinkId, Origin};
use articulated_core::index::BodyId;
use articulated_core::model::{Frame, Model};
use articulated_core::spatial::Placement;
use nalgebra::{Matrix3, Rotation3, SymmetricEigen, Vector3};
use serde::Serialize;

use super::geometry::Geometry;
use super::mesh::Meshes;
use crate::simulate::label;

/// Size of a joint's label, and the room for it, px.
const LABEL: (f64, f64) = (11.0, 120.0);

/// The drawn robot. Bodies are numbered: 0 does not move, k + 1 is the k-th of [`Figure::frames`].
#[derive(Clone, Debug, Default, Serialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Figure {
    /// One link of each moving body: the body's placement is that of the link.
    #[serde(skip)]
    pub(super) frames: Vec<String>,
    /// The body that is followed.
    pub(super) root: usize,
    /// Whether a visual shape is a mesh.
    has_meshes: bool,
    pub(super) sticks: Vec<Stick>,
    pub(super) joints: Vec<Mark>,
    pub(super) boxes: Vec<Box>,
    pub(super) balls: Vec<Ball>,
    pub(super) geometries: Vec<Geometry>,
    pub(super) solids: Vec<Solid>,
}

/// A line from a point of a body to a point of another, or of the same.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Stick {
    pub(super) from: usize,
    pub(super) start: [f64; 3],
    pub(super) to: usize,
    pub(super) end: [f64; 3],
}

/// A joint that moves.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Mark {
    body: usize,
    place: [f64; 3],
    name: String,
    /// The name, cut to the available room.
    label: String,
}

/// A link's box: its centre, its axes as columns of a rotation, and half its edges.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Box {
    pub(super) body: usize,
    pub(super) center: [f64; 3],
    axes: [[f64; 3]; 3],
    pub(super) half: [f64; 3],
    name: String,
    mass: f64,
    /// Index of its limb of the base, for its colour.
    pub(super) limb: usize,
    /// No visual shape of the link is drawn: the box is its only drawing.
    alone: bool,
}

/// A shape of a link: its place in the body, and its appearance.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Solid {
    pub(super) body: usize,
    kind: Kind,
    /// Index in [`Figure::geometries`].
    pub(super) geometry: usize,
    pub(super) center: [f64; 3],
    /// As columns of a rotation.
    axes: [[f64; 3]; 3],
    name: String,
    /// Empty if it has none.
    material: String,
    color: Option<[f64; 4]>,
    limb: usize,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
enum Kind {
    Visual,
    Collision,
}

/// A sphere that touches the ground.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Ball {
    pub(super) body: usize,
    pub(super) center: [f64; 3],
    pub(super) radius: f64,
}

impl Figure {
    /// For a robot; `model` has a frame for each link. The shapes of its links are drawn if
    /// `meshes` are given.
    pub(super) fn of(description: &Description, model: &Model<f64>, base: Base, meshes: Option<&Meshes<'_>>) -> Self {
        let mut figure = Self::default();
        let links = figure.links(description, model);
        figure.root = usize::from(base == Base::Floating && !figure.frames.is_empty());
        for joint in &description.joints {
            let (Some(parent), Some(child)) = (&links[joint.parent], &links[joint.child]) else { continue };
            let (start, end) = (parent.place.position.into(), child.place.position.into());
            // What floats is held by nothing.
            let holds = joint.kind != JointKind::Floating || joint.locked.is_some();
            if holds && (parent.body != child.body || start != end) {
                figure.sticks.push(Stick { from: parent.body, start, to: child.body, end });
            }
            if !joint.kind.is_fixed() && joint.locked.is_none() {
                let (name, label) = (joint.name.clone(), String::new());
                figure.joints.push(Mark { body: child.body, place: end, name, label });
            }
        }
        let names: Vec<String> = figure.joints.iter().map(|joint| joint.name.clone()).collect();
        for (joint, label) in figure.joints.iter_mut().zip(label::told_apart(&names, LABEL.0, LABEL.1)) {
            joint.label = label;
        }
        if let Some(meshes) = meshes {
            figure.shapes(description, &links, meshes);
        }
        // From the last joint of a limb to the centre of mass that it moves.
        for (link, place) in description.links.iter().zip(&links) {
            let (Some(place), Some(inertial)) = (place, &link.inertial) else { continue };
            let center = place.place.transform(Vector3::from(inertial.origin.xyz));
            let is_last = place.body != 0 && !figure.sticks.iter().any(|stick| stick.from == place.body);
            if is_last && inertial.mass > 0.0 && center != place.place.position {
                let (start, end) = (place.place.position.into(), center.into());
                figure.sticks.push(Stick { from: place.body, start, to: place.body, end });
            }
        }
        for (link, place) in description.links.iter().zip(&links) {
            let (Some(place), Some(inertial)) = (place, &link.inertial) else { continue };
            if inertial.mass > 0.0 {
                let alone = !figure.solids.iter().any(|solid| solid.kind == Kind::Visual && solid.name == link.name);
                figure.boxes.push(inertia_box(&link.name, inertial, place, alone));
            }
        }
        figure
    }

    /// Adds the visual and the collision shapes of all links.
    fn shapes(&mut self, description: &Description, links: &[Option<Linked>], meshes: &Meshes<'_>) {
        let drawn = description.links.iter().zip(links).filter(|(_, place)| place.is_some());
        let all = drawn.flat_map(|(link, _)| link.visual.iter().map(|v| &v.shape).chain(link.collision.iter().map(|c| &c.shape)));
        let share = meshes.share(all.filter_map(|shape| match shape {
            CollisionShape::Mesh { file, .. } => Some(file.as_str()),
            _ => None,
        }));
        let mut known: HashMap<String, Option<usize>> = HashMap::new();
        for (link, place) in description.links.iter().zip(links) {
            let Some(place) = place else { continue };
            for visual in &link.visual {
                let Some(geometry) = self.geometry(&link.name, &visual.shape, share, meshes, &mut known) else { continue };
                let solid = solid(link, place, Kind::Visual, geometry, &visual.origin);
                self.has_meshes |= matches!(visual.shape, CollisionShape::Mesh { .. });
                self.solids.push(Solid { material: visual.material.clone(), color: visual.color, ..solid });
            }
            for piece in &link.collision {
                let Some(geometry) = self.geometry(&link.name, &piece.shape, share, meshes, &mut known) else { continue };
                self.solids.push(solid(link, place, Kind::Collision, geometry, &piece.origin));
            }
        }
    }

    /// The index of a shape's geometry; equal meshes share one.
    fn geometry(
        &mut self,
        link: &str,
        shape: &CollisionShape,
        share: f64,
        meshes: &Meshes<'_>,
        known: &mut HashMap<String, Option<usize>>,
    ) -> Option<usize> {
        let key = format!("{shape:?}");
        if let CollisionShape::Mesh { .. } = shape
            && let Some(index) = known.get(&key)
        {
            return *index;
        }
        let geometry = match shape {
            CollisionShape::Mesh { file, scale, .. } => meshes.mesh(link, file, share).map(|mesh| mesh.scaled(*scale)),
            other => Geometry::of(other),
        };
        let index = geometry.map(|geometry| {
            self.geometries.push(geometry);
            self.geometries.len() - 1
        });
        known.insert(key, index);
        index
    }

    /// Points that enclose all drawings of a body, each with a radius, m.
    pub(super) fn points(&self, body: usize) -> Vec<(Vector3<f64>, f64)> {
        // Boxes of links with another drawing are hidden at first.
        let corners = self.boxes.iter().filter(|b| b.body == body && b.alone).flat_map(Box::corners).map(|p| (p, 0.0));
        let starts = self.sticks.iter().filter(|s| s.from == body).map(|s| (Vector3::from(s.start), 0.0));
        let ends = self.sticks.iter().filter(|s| s.to == body).map(|s| (Vector3::from(s.end), 0.0));
        let balls = self.balls.iter().filter(|b| b.body == body).map(|b| (Vector3::from(b.center), b.radius));
        let solids = self.solids.iter().filter(|s| s.body == body && s.kind == Kind::Visual);
        let shapes = solids.flat_map(|s| {
            let place = s.placement();
            self.geometries[s.geometry].bounds().into_iter().map(move |p| (place.transform(p), 0.0))
        });
        corners.chain(starts).chain(ends).chain(balls).chain(shapes).collect()
    }

    /// A sphere at a place of a link.
    pub(super) fn ball(&mut self, description: &Description, model: &Model<f64>, link: &str, center: [f64; 3], radius: f64) {
        let links = Self::default().links(description, model);
        if let Some(Some(at)) = description.link(link).map(|k| &links[k]) {
            let center = at.place.transform(Vector3::from(center)).into();
            self.balls.push(Ball { body: at.body, center, radius });
        }
    }

    /// The place of each link in its body, relative to the body's first link.
    fn links(&mut self, description: &Description, model: &Model<f64>) -> ById<LinkId, Option<Linked>> {
        let mut drawn: ById<BodyId, Option<(usize, Placement<f64>)>> = vec![None; model.bodies().len()].into();
        drawn[BodyId::BASE] = Some((0, Placement::identity()));
        let mut place = |frame: &Frame<f64>| {
            let (body, first) = drawn[frame.body].get_or_insert_with(|| {
                self.frames.push(frame.name.clone());
                (self.frames.len(), frame.placement)
            });
            Linked { body: *body, place: relative(first, &frame.placement), limb: limb(model, frame.body) }
        };
        description.links.iter().map(|link| model.frames().iter().find(|f| f.name == link.name).map(&mut place)).collect()
    }
}

impl Solid {
    fn placement(&self) -> Placement<f64> {
        Placement { rotation: Matrix3::from_columns(&self.axes.map(Vector3::from)), position: Vector3::from(self.center) }
    }
}

impl Box {
    pub(super) fn corners(&self) -> [Vector3<f64>; 8] {
        std::array::from_fn(|k| {
            let along = |axis: usize| Vector3::from(self.axes[axis]) * if k >> axis & 1 == 1 { self.half[axis] } else { -self.half[axis] };
            Vector3::from(self.center) + along(0) + along(1) + along(2)
        })
    }
}

/// A link in its body.
struct Linked {
    body: usize,
    place: Placement<f64>,
    limb: usize,
}

/// The first body on the way to `body` that hangs on one that more than one hangs on.
fn limb(model: &Model<f64>, mut body: BodyId) -> usize {
    let children = |parent: BodyId| model.outward().filter(move |&i| model.bodies()[i].parent == parent).count();
    let mut limb = 0;
    while !body.is_base() {
        let parent = model.bodies()[body].parent;
        if children(parent) > 1 {
            limb = 1 + model.outward().filter(|&i| i < body && children(model.bodies()[i].parent) > 1).count();
        }
        body = parent;
    }
    limb
}

/// b in axes of a, both given in the same frame.
fn relative(a: &Placement<f64>, b: &Placement<f64>) -> Placement<f64> {
    let back = a.rotation.transpose();
    Placement { rotation: back * b.rotation, position: back * (b.position - a.position) }
}

fn placement(origin: &Origin) -> Placement<f64> {
    let [roll, pitch, yaw] = origin.rotation.rpy();
    Placement { rotation: *Rotation3::from_euler_angles(roll, pitch, yaw).matrix(), position: Vector3::from(origin.xyz) }
}

/// A shape of a link without colour.
fn solid(link: &Link, linked: &Linked, kind: Kind, geometry: usize, origin: &Origin) -> Solid {
    let place = linked.place.compose(&placement(origin));
    let axes = [0, 1, 2].map(|k| place.rotation.column(k).into_owned().into());
    let (name, material) = (link.name.clone(), String::new());
    Solid { body: linked.body, kind, geometry, center: place.position.into(), axes, name, material, color: None, limb: linked.limb }
}

fn inertia_box(name: &str, inertial: &Inertial, link: &Linked, alone: bool) -> Box {
    let [xx, xy, xz, yy, yz, zz] = inertial.inertia;
    let principal = SymmetricEigen::new(Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz));
    let place = link.place.compose(&placement(&inertial.origin));
    let axes = place.rotation * principal.eigenvectors;
    let axis = |k: usize| axes.column(k).into_owned().into();
    Box {
        body: link.body,
        center: place.position.into(),
        axes: [axis(0), axis(1), axis(2)],
        half: half_edges(principal.eigenvalues.into(), inertial.mass),
        name: name.to_owned(),
        mass: inertial.mass,
        limb: link.limb,
        alone,
    }
}

/// I₁ = m (b² + c²)/3 for half edges a, b, c, and so on round: a² = 3 (I₂ + I₃ − I₁) / 2m.
fn half_edges(i: [f64; 3], mass: f64) -> [f64; 3] {
    let sum: f64 = i.iter().sum();
    i.map(|own| (1.5 * (sum - 2.0 * own).max(0.0) / mass).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::robot::bundled_model;

    fn bundled(name: &str) -> (Description, Base) {
        let robot = articulated_models::robot(name).unwrap();
        let options = articulated_formats::Options { base: robot.base, ..articulated_formats::Options::default() };
        (articulated_formats::read(robot.urdf.as_bytes(), &options).unwrap().description, robot.base)
    }

    #[test]
    fn a_box_has_the_moments_that_it_was_made_of() {
        let (m, [a, b, c]) = (3.0, [0.1, 0.2, 0.5]);
        let moments = [b * b + c * c, a * a + c * c, a * a + b * b].map(|s| m * s / 3.0);
        for (found, edge) in half_edges(moments, m).iter().zip([a, b, c]) {
            assert!((found - edge).abs() < 1e-12);
        }
        assert_eq!(half_edges([0.0; 3], 1.0), [0.0; 3]);
    }

    #[test]
    fn every_joint_that_moves_is_marked_and_every_mass_has_its_box() {
        for name in ["simple_pendulum", "gripper_arm", "quadruped", "humanoid"] {
            let (description, base) = bundled(name);
            let figure = Figure::of(&description, &bundled_model(name), base, None);
            let moving = description.joints.iter().filter(|j| !j.kind.is_fixed()).count();
            assert_eq!(figure.joints.len(), moving, "{name}");
            assert_eq!(figure.frames.len(), moving + usize::from(base == Base::Floating), "{name}");
            assert_eq!(figure.boxes.len(), description.links.iter().filter(|l| l.inertial.is_some()).count(), "{name}");
            assert!(figure.sticks.iter().all(|s| s.from <= figure.frames.len() && s.to <= figure.frames.len()));
        }
    }
}
