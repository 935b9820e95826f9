//! Statistics over the steps of a motion, independent of the outputs.

use articulated::Dynamics;
use articulated::simulate::Settings;
use articulated_core::algorithm::Workspace;

use crate::creep::{Creep, Creeping};
use crate::penetration::{Depths, Penetration};
use crate::rolling::{Rollers, Rolling};
use crate::session::Session;
use crate::slide::{Slide, Sliding};
use crate::touch::{Contact, Frames, Touch};

/// Statistics of contacts and of joints with dry friction over the steps of a motion.
pub(crate) struct Statistics<'s> {
    session: &'s Session,
    workspace: Workspace<f64>,
    contacts: Vec<Contact>,
    creeping: Creeping<'s>,
    sliding: Vec<Sliding>,
    rollers: Rollers,
    depths: Depths<'s>,
    /// The state before the step.
    t: f64,
    q: Vec<f64>,
    v: Vec<f64>,
    touches: Vec<Touch>,
    /// Room for the next one.
    next: Vec<Touch>,
    places: Vec<f64>,
    twists: Vec<f64>,
}

/// Results of the statistics.
pub(crate) struct Found {
    pub(crate) creep: Vec<Creep>,
    pub(crate) penetrations: Vec<Penetration>,
    pub(crate) slides: Vec<Slide>,
    pub(crate) rolling: Vec<Rolling>,
}

impl<'s> Statistics<'s> {
    /// For a motion from this state on.
    pub(crate) fn from(session: &'s Session, settings: &Settings, q: &[f64], v: &[f64]) -> Self {
        let contacts = session.contacts();
        let (frames, t) = (session.model.frames().len(), settings.start);
        let mut statistics = Self {
            session,
            workspace: session.model.workspace(),
            creeping: Creeping::of(session, &contacts),
            sliding: Sliding::of(&contacts),
            rollers: Rollers::of(&contacts, settings, session.model.nv()),
            depths: Depths::of(session),
            contacts,
            t,
            q: q.to_vec(),
            v: v.to_vec(),
            touches: Vec::new(),
            next: Vec::new(),
            places: vec![0.0; 12 * frames],
            twists: vec![0.0; 6 * frames],
        };
        statistics.look(t, q, v);
        std::mem::swap(&mut statistics.touches, &mut statistics.next);
        statistics
    }

    /// Contacts and depths of a state, into `next`. Empty if the model refuses the state.
    fn look(&mut self, t: f64, q: &[f64], v: &[f64]) {
        self.next.clear();
        let (model, ws) = (&self.session.model, &mut self.workspace);
        let placed = !self.contacts.is_empty()
            && model.placements(ws, q, &mut self.places).is_ok()
            && model.twists_world_aligned(ws, q, v, &mut self.twists).is_ok();
        if placed {
            let frames = Frames { places: &self.places, twists: &self.twists, gravity: model.gravity() };
            self.next.extend(self.contacts.iter().map(|contact| contact.at(&frames)));
            self.depths.add(t, &self.places);
        }
    }

    /// One more step, up to this state.
    pub(crate) fn step(&mut self, t: f64, q: &[f64], v: &[f64]) {
        let time = t - self.t;
        self.creeping.step_of_joints(time, [&self.q, &self.v], [q, v]);
        self.look(t, q, v);
        if self.touches.len() == self.next.len() {
            for (k, contact) in self.contacts.iter().enumerate() {
                self.creeping.step_of_contact(k, contact, time, &self.touches[k], &self.next[k]);
            }
            self.rollers.step(&self.contacts, time, &self.touches, &self.next);
            for link in &mut self.sliding {
                link.step(&self.contacts, time, &self.touches, &self.next);
            }
        }
        std::mem::swap(&mut self.touches, &mut self.next);
        self.t = t;
        self.q.copy_from_slice(q);
        self.v.copy_from_slice(v);
    }

    /// The results.
    pub(crate) fn found(self) -> Found {
        let (file, gravity) = (&self.session.scene.file, self.session.model.gravity().norm());
        let slides = self.sliding.into_iter().filter_map(|link| link.found(file, gravity)).collect();
        let rolling = self.rollers.found(&self.contacts, file);
        Found { creep: self.creeping.found(), penetrations: self.depths.found(), slides, rolling }
    }
}
