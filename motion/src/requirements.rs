//! Requirements of a scene on the robot that it moves: frames, functions, shape.

use articulated::simulate::IntegratorId;
use articulated::{Dynamics, FunctionId};
use articulated_core::effect::EffectId;
use articulated_scene::EventClass;

use crate::error::Fault;
use crate::session::Session;

impl Session {
    /// The links whose frames the scene's events need, without duplicates. A robot generated for
    /// this motion must have these frames.
    pub fn frames(&self) -> Vec<String> {
        let mut all: Vec<String> = self.frame_users().map(|(_, link)| link.to_owned()).collect();
        all.sort_unstable();
        all.dedup();
        all
    }

    /// Names of the functions to generate for this motion, each once: those that it needs with this
    /// integrator, and those by which its recording reports energies, losses and momentum. The word
    /// `motion` in lists of functions means these
    /// ([`Scene::calls`](articulated_scene::Scene::calls)). A robot without the latter moves as
    /// well; [`Recording::missing`](articulated::simulate::Recording::missing) lists them.
    pub fn functions(&self, integrator: IntegratorId) -> Vec<&'static str> {
        let reported = self.scene.calls_with(integrator).reported.into_iter().filter(|function| match function {
            FunctionId::centroidal_momentum => self.model.moving_mass() > 0.0,
            FunctionId::dissipation | FunctionId::motor_torques => !self.effects.is_empty(),
            _ => true,
        });
        self.required(integrator).into_iter().chain(reported).map(FunctionId::name).collect()
    }

    /// The keys that need a frame, and its link.
    pub(crate) fn frame_users(&self) -> impl Iterator<Item = (&'static str, &str)> {
        let contacts = self.effects_of(EffectId::contact).filter(|_| self.requested_events().contains(&EventClass::Contacts));
        let contacts = contacts.map(|a| ("effects.contact", a.on.as_str()));
        contacts.chain(self.scene.impact.iter().map(|impact| ("impact.link", impact.link.as_str())))
    }

    /// The requested classes of events.
    pub(crate) fn requested_events(&self) -> &[EventClass] {
        self.scene.simulation.as_ref().map_or(&[], |s| &s.events)
    }

    /// Functions that the motion requires.
    fn required(&self, integrator: IntegratorId) -> Vec<FunctionId> {
        let mut functions = self.scene.calls_with(integrator).required;
        functions.retain(|function| match function {
            FunctionId::integrate => self.model.nq() != self.model.nv(),
            FunctionId::placements => self.frame_users().next().is_some(),
            _ => true,
        });
        functions
    }

    /// Required functions that this robot lacks.
    pub(crate) fn missing_functions<R: Dynamics<f64>>(&self, robot: &R, integrator: IntegratorId) -> impl Iterator<Item = Fault> {
        let mut ws = robot.workspace();
        self.required(integrator).into_iter().filter_map(move |function| robot.check_function(&mut ws, function).err().map(Fault::Function))
    }

    /// Differences between the shape and frame names of a robot and those of the scene's robot.
    pub(crate) fn shape_mismatches<R: Dynamics<f64>, S: AsRef<str>>(&self, robot: &R, frames: &[S]) -> Vec<Fault> {
        let (own, shape) = (self.model.shape(), robot.shape());
        let counts = [("coordinates", shape.nq, own.nq), ("degrees of freedom", shape.nv, own.nv)];
        let counts = counts.into_iter().filter(|(_, found, expected)| found != expected);
        let mut faults: Vec<Fault> = counts.map(|(what, found, expected)| Fault::Shape { what, found, expected }).collect();
        if frames.len() != shape.frames {
            faults.push(Fault::Frames { found: frames.len(), expected: shape.frames });
            return faults;
        }
        let names = frames.iter().enumerate().filter_map(|(k, name)| Some((k, name.as_ref(), robot.frame_name(k)?)));
        let otherwise = names.filter(|(_, name, own)| name != own);
        faults.extend(otherwise.map(|(index, name, own)| Fault::FrameName { index, found: name.to_owned(), expected: own.to_owned() }));
        faults
    }
}
