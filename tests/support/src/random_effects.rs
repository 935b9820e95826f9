//! Effects at random.

use articulated_core::description::Origin;
use articulated_core::effect::{Applied, Effect, EffectId, Enters, On, effects};
use articulated_core::index::BodyId;
use articulated_core::model::{FLOATING_BASE, Model};

use crate::random::Random;

/// Effects of the kinds accepted by `wanted`, each on about half of the joints or moving links that
/// can have it.
pub fn random_effects(random: &mut Random, model: &Model<f64>, wanted: impl Fn(EffectId) -> bool) -> Vec<Applied> {
    let mut applied = Vec::new();
    for effect in effects().iter().filter(|e| wanted(e.id)) {
        let names: Vec<&String> = match effect.on {
            On::Joint => model.outward().filter(|&i| can_have(model, effect.id, i)).map(|i| &model.bodies()[i].name).collect(),
            On::Link => model.frames().iter().filter(|f| !f.body.is_base()).map(|f| &f.name).collect(),
        };
        let mut taken = Vec::new();
        for name in names {
            if !taken.contains(&name) && random.chance(0.5) {
                taken.push(name);
                let origin = Origin::new(random.three(0.3), random.three(2.0));
                let at = if effect.on == On::Link { origin } else { Origin::default() };
                let is_ball = effect.on == On::Joint && is_ball(model, effect, name);
                let parameters = if is_ball { on_ball(random, effect.id) } else { parameters(random, effect.id) };
                applied.push(Applied { effect: effect.id, on: name.clone(), at, parameters });
            }
        }
    }
    applied
}

/// Whether the effect has numbers of its own on this joint, a ball.
fn is_ball(model: &Model<f64>, effect: &Effect, name: &str) -> bool {
    model.bodies().iter().skip(1).any(|body| body.name == name && effect.is_of_rotation(body.joint))
}

/// A spring acts on no free joint, and is left out of joints that follow. A motor drives no joint
/// that follows another.
fn can_have(model: &Model<f64>, effect: EffectId, i: BodyId) -> bool {
    let (row, joint) = (effect.row(), model.bodies()[i].joint);
    let follows = model.bodies()[i].coordinates.mimic.is_some();
    match effect {
        _ if model.bodies()[i].name == FLOATING_BASE => false,
        _ if row.enters == Enters::ForceOfCoordinate => row.acts_on(joint) && !follows,
        _ if row.enters == Enters::Drive => !follows,
        _ => true,
    }
}

/// Numbers that make the effect felt on a ball joint.
fn on_ball(random: &mut Random, effect: EffectId) -> Vec<f64> {
    match effect {
        EffectId::polynomial_spring => (0..6).map(|_| random.within(0.2, 2.0)).collect(),
        EffectId::spring => (0..5).map(|_| random.within(0.2, 2.0)).collect(),
        // Most bounds are passed.
        EffectId::limit => vec![0.4, random.within(0.2, 2.0), random.within(0.2, 2.0)],
        other => unreachable!("{} has no numbers of its own on a ball", other.name()),
    }
}

/// Numbers that make the effect felt.
fn parameters(random: &mut Random, effect: EffectId) -> Vec<f64> {
    let mut some = |n: usize| -> Vec<f64> { (0..n).map(|_| random.within(0.2, 2.0)).collect() };
    match effect {
        // Most bounds are passed.
        EffectId::limit => [vec![-0.3, 0.2], some(2)].concat(),
        EffectId::motor => [some(3), vec![0.8, 0.1]].concat(),
        EffectId::friction => [some(1), vec![0.3]].concat(),
        EffectId::buoyancy => [vec![0.002], vec![900.0]].concat(),
        EffectId::gravity_compensation => vec![0.4],
        EffectId::added_mass => {
            let (mut angular, mut linear) = (some(6), some(6));
            for matrix in [&mut angular, &mut linear] {
                [0, 3, 5].into_iter().for_each(|k| matrix[k] += 4.0);
            }
            [angular, linear, some(9).iter().map(|x| x * 0.3).collect()].concat()
        }
        EffectId::contact => [some(4), vec![0.2], vec![0.3, -0.2, 2.0], vec![0.5], some(1)].concat(),
        other => some(other.row().len()),
    }
}
