//! The constraints of a file on a model of its robot.

use articulated_core::actuator::path_at;
use articulated_core::algorithm::Workspace;
use articulated_core::collision::{Form, Shape};
use articulated_core::constraint::{
    Anchor, Bound, Cone, Constraints, DryFriction, Length, Limit, Pair, Soft, Sum, SumLaw, Term, poses, weights,
};
use articulated_core::description::{Description, Joint, Origin};
use articulated_core::diagnostic::At;
use articulated_core::effect::{Applied, EffectId, Effects};
use articulated_core::index::BodyId;
use articulated_core::model::Model;
use articulated_core::spatial::{Placement, Vector3};

use crate::LeaveOut;
use crate::actuation::strands_of;
use crate::world::{Touching, TouchingAnchor, TouchingLaw, TouchingLength, TouchingPair, TouchingSum, Unread, World};

/// Robots with more have no constraints here: their strengths need the inverse of M.
const MOST_FREEDOMS: usize = 500;

impl World {
    /// Limits, dry friction and contacts of the file on a model of its robot, and what is not
    /// computed of them. Joints that the model does not have, locked ones, have none.
    ///
    /// The strengths of constraints come from inverse inertias in the reference pose of the file,
    /// with all its rotors.
    pub fn constraints_of(&self, description: &Description, model: &Model<f64>) -> (Constraints, Vec<Unread>) {
        let Some(touching) = self.touching.as_ref().filter(|_| model.nv() > 0) else { return (Constraints::default(), Vec::new()) };
        if !touching.has_read() {
            return (Constraints::default(), touching.unread.clone());
        }
        if model.nv() > MOST_FREEDOMS {
            let what = format!("constraints of {} degrees of freedom, of which {MOST_FREEDOMS} are computed at most", model.nv());
            return (Constraints::default(), [Unread { kind: LeaveOut::Constraint, what, place: At::Nowhere }].into());
        }
        let rotors = self.rotors(description, model);
        // Of the file alone, whichever effects the model has
        let bare = model.clone().changed(|parts| parts.bodies.iter_mut().for_each(|body| body.effects = Effects::default()));
        let heavy = bare.with_effects(&rotors);
        let mut made = Made {
            touching,
            model,
            heavy: heavy.as_ref().unwrap_or(model),
            unread: touching.unread.clone(),
            reference: self.reference_pose(model),
        };
        if let Err(error) = &heavy {
            made.lost(LeaveOut::Constraint, format!("rotors in the strengths of constraints: {error}"), At::Nowhere);
        }
        let constraints = made.constraints();
        (constraints, made.unread)
    }

    /// Inertia of rotors, and that of free joints.
    fn rotors(&self, description: &Description, model: &Model<f64>) -> Vec<Applied> {
        let of_joint = |joint: &Joint| {
            let armature = joint.dynamics.armature.filter(|x| *x != 0.0 && model.bodies().iter().any(|body| body.name == joint.name))?;
            Some(Applied { effect: EffectId::armature, on: joint.name.clone(), at: Origin::default(), parameters: vec![armature, 1.0] })
        };
        let of_bodies = self.effects.iter().map(|(effect, _)| effect).filter(|effect| effect.effect == EffectId::added_mass);
        description.joints.iter().filter_map(of_joint).chain(of_bodies.cloned()).collect()
    }

    /// The coordinates at which bodies have the poses of the file.
    fn reference_pose(&self, model: &Model<f64>) -> Vec<f64> {
        let mut q = model.neutral();
        for (name, own) in self.home.iter().flat_map(|home| &home.q) {
            if let Some(joint) = model.joints().iter().find(|joint| joint.name == *name && joint.q.1 == own.len()) {
                q[joint.q.0..][..joint.q.1].copy_from_slice(own);
            }
        }
        q
    }
}

fn other(law: &SumLaw) -> Option<&Length> {
    if let SumLaw::Equation { other, .. } = law { other.as_ref() } else { None }
}

struct Made<'a> {
    touching: &'a Touching,
    model: &'a Model<f64>,
    /// The same with rotors.
    heavy: &'a Model<f64>,
    unread: Vec<Unread>,
    reference: Vec<f64>,
}

impl Made<'_> {
    fn constraints(&mut self) -> Constraints {
        let (touching, model) = (self.touching, self.model);
        let frame = |link: &str| model.frames().iter().find(|frame| frame.name == link);
        let placed = |link: &str| frame(link).map_or((BodyId::BASE, Placement::identity()), |frame| (frame.body, frame.placement));
        let centers = touching.bodies.iter().map(|(link, center, _)| {
            let (body, placement) = placed(link);
            (body, (placement.rotation * Vector3::from(*center) + placement.position).into())
        });
        let centers: Vec<(BodyId, [f64; 3])> = centers.collect();
        let sums: Vec<(&TouchingSum, Length, SumLaw)> =
            touching.sums.iter().filter_map(|sum| self.sum(sum).map(|(length, law)| (sum, length, law))).collect();
        let mut ws = Workspace::new(model);
        let mut row = |length: &Length| match length {
            Length::Sum(terms) => terms.iter().map(|term| (term.v, term.factor)).collect(),
            Length::Path(strands) => path_at(model, &mut ws, &self.reference, strands).1,
        };
        let of_lengths: Vec<Vec<(usize, f64)>> =
            sums.iter().flat_map(|(_, length, law)| [row(length), other(law).map_or(Vec::new(), &mut row)]).collect();
        let mut weights = weights(self.heavy, &self.reference, &centers, &of_lengths);
        // Bodies that slide alone have the inverse of their mass.
        for (k, (_, _, slides)) in touching.bodies.iter().enumerate() {
            if *slides && !centers[k].0.is_base() {
                let inverse = 1.0 / model.bodies()[centers[k].0].inertia.mass;
                weights.points[k] = [inverse, 0.0];
                model.freedoms_of(centers[k].0).into_iter().for_each(|v| weights.freedoms[v] = inverse);
            }
        }
        let of_link = |link: &str| touching.bodies.iter().position(|(own, ..)| own == link).map_or([0.0; 2], |k| weights.points[k]);
        let mut all = Constraints { cone: touching.cone, ..Constraints::default() };
        for limit in &touching.limits {
            let Some(joint) = model.joints().iter().find(|joint| joint.name == limit.joint) else {
                self.follower(&limit.joint, "the limit");
                continue;
            };
            let Some(soft) = self.soft(limit.reference, limit.impedance, &format!("the limit of joint {:?}", limit.joint)) else {
                continue;
            };
            let bound = if joint.v.1 == 3 { Bound::Angle(limit.range[1]) } else { Bound::Between(limit.range) };
            let (q, v) = (joint.q.0, joint.v.0);
            all.limits.push(Limit { q, v, bound, margin: limit.margin, soft, weight: weights.freedoms[v] });
        }
        for own in &touching.friction {
            let Some(joint) = model.joints().iter().find(|joint| joint.name == own.joint) else {
                self.follower(&own.joint, "dry friction");
                continue;
            };
            let Some(soft) = self.soft(own.reference, own.impedance, &format!("dry friction of joint {:?}", own.joint)) else { continue };
            all.friction.extend((0..joint.v.1).map(|k| {
                // A free joint: turns in axes of the body, translations in axes of the world
                let along = (joint.v.1 == 6 && k >= 3).then(|| (joint.q.0 + 3, k - 3));
                let v = joint.v.0 + if along.is_some() { 3 } else { k };
                DryFriction { v, along, loss: own.loss, soft: soft.clone(), weight: weights.freedoms[v] }
            }));
        }
        for (k, (own, length, law)) in sums.into_iter().enumerate() {
            let Some(soft) = self.soft(own.reference, own.impedance, &own.what) else { continue };
            // Of joints, that of each degree of freedom, whatever is between them
            let weight = match own.is_of_tendons {
                true => weights.sums[2 * k..][..2].iter().sum(),
                false => of_lengths[2 * k..][..2].iter().flatten().map(|(v, _)| weights.freedoms[*v]).sum(),
            };
            all.sums.push(Sum { length, law, soft, weight });
        }
        for own in &touching.anchors {
            all.anchors.extend(self.anchor(own, placed, of_link));
        }
        let mut places: Vec<Option<usize>> = vec![None; touching.shapes.len()];
        for pair in &touching.pairs {
            let bodies = pair.shapes.map(|shape| placed(&touching.shapes[shape].link).0);
            // Of links that are one body, such as behind a locked joint
            if bodies[0] == bodies[1] {
                continue;
            }
            let given = touching.given.iter().find_map(|own| Some((touching.is_of(pair, &own.shapes)?, own.places)));
            let found = match given {
                Some((shapes, places)) => self.soft(pair.reference, pair.impedance, "a given contact").map(|soft| (shapes, soft, places)),
                None => self.pair(pair).map(|(shapes, soft)| (shapes, soft, 0)),
            };
            let Some((shapes, soft, given)) = found else { continue };
            let shapes = shapes.map(|shape| {
                *places[shape].get_or_insert_with(|| {
                    let own = &touching.shapes[shape];
                    let (body, placement) = placed(&own.link);
                    let form = own.form.clone().unwrap_or(Form::Plane);
                    all.shapes.push(Shape { name: own.name.clone(), body, placement: placement.compose(&own.origin.placement()), form });
                    all.shapes.len() - 1
                })
            });
            let moves = pair.shapes.iter().map(|shape| of_link(&touching.shapes[*shape].link)[0]).sum::<f64>();
            let mu = pair.friction[0];
            let is_pyramid = pair.dimension > 1 && touching.cone == Cone::Pyramid;
            let across = pair.reference_across != [0.0; 2];
            all.pairs.push(Pair {
                shapes,
                given,
                dimension: pair.dimension,
                friction: pair.friction,
                mu: mu / touching.impedance_ratio.max(1e-15).sqrt(),
                margin: pair.margin,
                tangential_damping: if across && !is_pyramid {
                    Soft::of(pair.reference_across, pair.impedance, touching.safe_step).map_or(soft.damping, |own| own.damping)
                } else {
                    soft.damping
                },
                soft,
                weight: if is_pyramid { moves * (1.0 + mu * mu) } else { moves },
            });
        }
        all
    }

    /// The length and the law of a constraint on the model. `None`: it is applied to the model, or
    /// not computed.
    fn sum(&mut self, own: &TouchingSum) -> Option<(Length, SumLaw)> {
        let is_follower = |joint: &String| self.model.bodies().iter().any(|body| body.name == *joint && body.coordinates.mimic.is_some());
        if own.coupling.as_ref().is_some_and(is_follower) {
            return None;
        }
        let of = |(joint, factor): &(String, f64)| {
            let joint = self.model.joints().iter().find(|own| own.name == *joint)?;
            Some(Term { q: joint.q.0, v: joint.v.0, factor: *factor })
        };
        let all = |length: &TouchingLength| match length {
            TouchingLength::Sum(terms) => terms.iter().map(of).collect::<Option<_>>().map(Length::Sum),
            TouchingLength::Path(strands) => strands_of(self.model, strands).map(Length::Path),
        };
        let length = all(&own.length);
        let law = match &own.law {
            TouchingLaw::Between { range, margin } => Some(SumLaw::Between { range: *range, margin: *margin }),
            TouchingLaw::DryFriction(loss) => Some(SumLaw::DryFriction(*loss)),
            TouchingLaw::Equation { other, references, coefficients } => {
                let (references, coefficients) = (*references, *coefficients);
                match other {
                    Some(other) => all(other).map(|other| SumLaw::Equation { other: Some(other), references, coefficients }),
                    None => Some(SumLaw::Equation { other: None, references, coefficients }),
                }
            }
        };
        let found = length.zip(law);
        if found.is_none() {
            self.lost(LeaveOut::Constraint, format!("{}, with a joint that is locked or follows others", own.what), At::Nowhere);
        }
        found
    }

    /// Two frames that are held together. `None`: they are on one body.
    fn anchor(
        &mut self,
        own: &TouchingAnchor,
        placed: impl Fn(&str) -> (BodyId, Placement<f64>),
        weights: impl Fn(&str) -> [f64; 2],
    ) -> Option<Anchor> {
        let [first, second] = [0, 1].map(|k| placed(&own.links[k]));
        if first.0 == second.0 {
            return None;
        }
        let soft = self.soft(own.reference, own.impedance, &own.what)?;
        let inside = |(_, link): &(BodyId, Placement<f64>), frame: Origin| link.compose(&frame.placement());
        // Where the frame of one is on the other, in the reference pose
        let beside = |from: &(BodyId, Placement<f64>), frame: Origin, on: BodyId| {
            let both = poses(self.model, &self.reference, &[(from.0, inside(from, frame)), (on, Placement::identity())]);
            let turn = both[1].rotation.transpose();
            Placement { rotation: turn * both[0].rotation, position: turn * (both[0].position - both[1].position) }
        };
        let placements = match own.frames {
            [Some(one), Some(other)] => [inside(&first, one), inside(&second, other)],
            [Some(one), None] => [inside(&first, one), beside(&first, one, second.0)],
            [None, other] => {
                let other = other.unwrap_or_default();
                [beside(&second, other, first.0), inside(&second, other)]
            }
        };
        let [one, other] = [0, 1].map(|k| weights(&own.links[k]));
        let weights = [one[0] + other[0], one[1] + other[1]];
        Some(Anchor { bodies: [first.0, second.0], placements, turns: own.turns, soft, weights })
    }

    fn lost(&mut self, kind: LeaveOut, what: String, place: At) {
        self.unread.push(Unread { kind, what, place });
    }

    /// A constraint of a joint that follows others is not computed.
    fn follower(&mut self, joint: &str, what: &str) {
        if self.model.bodies().iter().any(|body| body.name == joint) {
            self.lost(LeaveOut::Constraint, format!("{what} of joint {joint:?}, which follows another"), At::Nowhere);
        }
    }

    fn soft(&mut self, reference: [f64; 2], impedance: [f64; 5], what: &str) -> Option<Soft> {
        let soft = Soft::of(reference, impedance, self.touching.safe_step);
        if soft.is_none() {
            self.lost(LeaveOut::Constraint, format!("{what}, with the power {} in solimp: no multiple of 1/2", impedance[4]), At::Nowhere);
        }
        soft
    }

    /// The shapes of a pair in order, and how it gives way.
    fn pair(&mut self, pair: &TouchingPair) -> Option<([usize; 2], Soft)> {
        let shapes = pair.shapes.map(|shape| &self.touching.shapes[shape]);
        let what = |own: &crate::world::TouchingShape| match &own.form {
            Ok(form) => format!("{:?} ({})", own.name, form.name()),
            Err(name) => format!("{:?} ({name})", own.name),
        };
        let names = format!("the contact of {} and {}", what(shapes[0]), what(shapes[1]));
        let [Ok(first), Ok(second)] = [&shapes[0].form, &shapes[1].form] else {
            self.lost(LeaveOut::Contact, names, shapes[1].place);
            return None;
        };
        let ordered = if first.rank() <= second.rank() { pair.shapes } else { [pair.shapes[1], pair.shapes[0]] };
        let [first, second] = if first.rank() <= second.rank() { [first, second] } else { [second, first] };
        if Form::places(first, second).is_none() {
            self.lost(LeaveOut::Contact, names, shapes[1].place);
            return None;
        }
        Some((ordered, self.soft(pair.reference, pair.impedance, &names)?))
    }
}
