//! Explicit integrators that meet a stiff motion.

use articulated_core::dynamics::Dynamics;

use super::{Run, Simulation};
use crate::simulate::{SimulateError, Stiffness};

impl<R: Dynamics<f64>> Simulation<'_, R> {
    /// Refuses a fixed step that an explicit integrator is not stable at.
    pub(super) fn check_stability(&mut self, run: &mut Run) -> Result<(), SimulateError> {
        let (nv, counts) = (self.shape.nv, &self.system.counts);
        let Some(h) = self.settings.step.filter(|_| !self.settings.integrator.row().implicit) else { return Ok(()) };
        if counts.stiff_at.is_some() || !self.stability.due(counts.steps, &self.y[nv..2 * nv]) {
            return Ok(());
        }
        let here = (self.t, &self.y[..], &self.f[..]);
        let found = self.stability.exceeded(&mut self.system, run.control, &*self.method, here, h)?;
        self.refuse(h, found)
    }

    /// The same where the last step saw something fast, on its way.
    pub(super) fn check_suspect(&mut self, run: &mut Run) -> Result<(), SimulateError> {
        let Some(h) = self.settings.step else { return Ok(()) };
        for place in 0..2 {
            let Some((rate, suspects)) = self.method.fastest() else { return Ok(()) };
            let suspect = suspects[place];
            let at = if rate == 0.0 || suspect.iter().any(|x| !x.is_finite()) { &self.y } else { suspect };
            self.point.y.copy_from_slice(at);
            self.system.rate(run.control, self.t, &self.point.y, &mut self.spare)?;
            self.stability.begin_anew();
            let here = (self.t, &self.point.y[..], &self.spare[..]);
            let found = self.stability.exceeded(&mut self.system, run.control, &*self.method, here, h)?;
            self.refuse(h, found)?;
        }
        Ok(())
    }

    fn refuse(&mut self, h: f64, found: Option<(f64, f64)>) -> Result<(), SimulateError> {
        let Some((admissible, rate)) = found else { return Ok(()) };
        self.stiff(SimulateError::Unstable { integrator: self.settings.integrator, t: self.t, step: h, admissible, rate })
    }

    fn stiff(&mut self, error: SimulateError) -> Result<(), SimulateError> {
        if self.settings.stiffness == Stiffness::Refuse {
            return Err(error);
        }
        self.system.counts.stiff_at.get_or_insert(self.t);
        Ok(())
    }

    /// Hairer & Wanner 1996, §IV.2: fifteen steps held back by stability, with no six between that are not; looked for every thousand steps.
    pub(super) fn check_stiffness(&mut self, run: &mut Run, h: f64) -> Result<(), SimulateError> {
        let due = self.system.counts.steps.is_multiple_of(1000) || run.stiff.0 > 0;
        if run.controller.is_none() || !due {
            return Ok(());
        }
        let Some((found, most)) = self.method.stiffness(h, &self.end) else { return Ok(()) };
        if found > most {
            run.stiff = (run.stiff.0 + 1, 0);
        } else {
            run.stiff.1 += 1;
            if run.stiff.1 >= 6 {
                run.stiff = (0, 0);
            }
        }
        if run.stiff.0 < 15 {
            return Ok(());
        }
        run.stiff = (0, 0);
        self.stiff(SimulateError::Stiff { integrator: self.settings.integrator, t: self.t, step: h })
    }
}
