//! The places in a model where effects act.

use alloc::collections::BTreeMap;
use alloc::string::String;
use alloc::vec::Vec;

use super::{Applied, Fault, Field, On};
use crate::index::{BodyId, FrameId};
use crate::model::{FLOATING_BASE, Model};
use crate::suggest::Suggester;

/// The bodies of joints and the frames of links by their names, gathered once for all effects.
pub(super) struct Places {
    joints: BTreeMap<String, Vec<BodyId>>,
    frames: BTreeMap<String, FrameId>,
    suggester: Suggester,
}

impl Places {
    pub(super) fn of(model: &Model<f64>) -> Self {
        let (mut joints, mut frames) = (BTreeMap::<String, Vec<BodyId>>::new(), BTreeMap::new());
        for i in model.outward() {
            joints.entry(model.bodies[i].name.clone()).or_default().push(i);
        }
        for (k, frame) in model.frames.with_ids() {
            frames.entry(frame.name.clone()).or_insert(k);
        }
        Self { joints, frames, suggester: Suggester::default() }
    }

    /// The fields of an effect on its joint or link.
    pub(super) fn fields(&self, model: &Model<f64>, one: &Applied) -> &'static [Field] {
        let row = one.effect.row();
        let body = self.joints.get(&one.on).filter(|_| row.on == On::Joint).and_then(|bodies| bodies.first());
        body.map_or(row.fields, |&i| row.fields_on(model.bodies[i].joint))
    }

    /// The bodies of the joint of this name, which is not that of a floating base.
    pub(super) fn bodies(&mut self, model: &Model<f64>, name: &str) -> Result<&[BodyId], Fault> {
        match self.joints.get(name) {
            Some(_) if name == FLOATING_BASE => Err(Fault::Base),
            Some(bodies) => Ok(bodies),
            None => {
                let nearest = self.suggester.nearest(name, model.bodies.iter().skip(1).map(|b| b.name.as_str()));
                Err(Fault::Unknown { on: On::Joint, nearest: nearest.map(String::from) })
            }
        }
    }

    /// The frame of the link of this name, which moves.
    pub(super) fn frame(&mut self, model: &Model<f64>, name: &str) -> Result<FrameId, Fault> {
        let Some(&frame) = self.frames.get(name) else {
            let nearest = self.suggester.nearest(name, model.frames.iter().map(|f| f.name.as_str()));
            return Err(Fault::Unknown { on: On::Link, nearest: nearest.map(String::from) });
        };
        if model.frames[frame].body == BodyId::BASE { Err(Fault::Still) } else { Ok(frame) }
    }
}
