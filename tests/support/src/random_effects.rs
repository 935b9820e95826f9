//! Effects at random.

use articulated_core::description::Origin;
use articulated_core::effect::{Applied, EffectId, Enters, On, effects};
use articulated_core::model::{FLOATING_BASE, Model};

use crate::random::Random;

/// Effects of the kinds that `wanted` says, each on about half of the joints or moving links that
/// can have it.
pub fn random_effects(random: &mut Random, model: &Model<f64>, wanted: impl Fn(EffectId) -> bool) -> Vec<Applied> {
    let mut applied = Vec::new();
    for effect in effects().iter().filter(|e| wanted(e.id)) {
        let names: Vec<&String> = match effect.on {
            On::Joint => model.outward().filter(|&i| can_have(model, effect.id, i)).map(|i| &model.bodies()[i].name).collect(),
            On::Link => model.frames().iter().filter(|f| f.body != 0).map(|f| &f.name).collect(),
        };
        let mut taken = Vec::new();
        for name in names {
            if !taken.contains(&name) && random.chance(0.5) {
                taken.push(name);
                let origin = Origin::new(random.three(0.3), random.three(2.0));
                let at = if effect.on == On::Link { origin } else { Origin::default() };
                applied.push(Applied { effect: effect.id, on: name.clone(), at, parameters: parameters(random, effect.id) });
            }
        }
    }
    applied
}

/// A spring needs a coordinate for each degree of freedom; a motor drives no joint that follows
/// another.
fn can_have(model: &Model<f64>, effect: EffectId, i: usize) -> bool {
    let ball = model.bodies()[i].joint.quaternion().is_some();
    let follows = model.bodies()[i].coordinates.mimic.is_some();
    match effect {
        _ if model.bodies()[i].name == FLOATING_BASE => false,
        _ if effect.row().needs_coordinate() => !ball && !follows,
        _ if effect.row().enters == Enters::Drive => !follows,
        _ => true,
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
        EffectId::added_mass => {
            let (mut angular, mut linear) = (some(6), some(6));
            for matrix in [&mut angular, &mut linear] {
                [0, 3, 5].into_iter().for_each(|k| matrix[k] += 4.0);
            }
            [angular, linear, some(9).iter().map(|x| x * 0.3).collect()].concat()
        }
        EffectId::contact => [some(4), vec![0.2], vec![0.3, -0.2, 2.0], vec![0.5]].concat(),
        other => some(other.row().len()),
    }
}
