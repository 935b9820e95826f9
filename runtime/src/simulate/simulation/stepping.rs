//! Steps one by one, for a loop of the caller.

use super::{Run, Simulation};
use crate::simulate::{Control, Counts, SimulateError, StateError};

impl Simulation<'_> {
    /// Puts the robot at q `[nq]` and v `[nv]` at the start time, for [`Simulation::step`]. Errors:
    /// all errors in the state.
    ///
    /// ```
    /// use articulated::simulate::{IntegratorId, NoTorque, Settings, Simulation};
    /// use articulated::{Base, load_bytes};
    ///
    /// # fn main() -> Result<(), Box<dyn std::error::Error>> {
    /// # let urdf = r#"<robot name="slider"><link name="base"/>
    /// #   <link name="cart"><inertial><mass value="2"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
    /// #   <joint name="rail" type="prismatic"><parent link="base"/><child link="cart"/><axis xyz="1 0 0"/>
    /// #     <limit lower="-9" upper="9" effort="9" velocity="9"/></joint></robot>"#;
    /// let robot = load_bytes("slider.urdf", urdf.as_bytes(), Base::Fixed)?;
    /// let settings = Settings { integrator: IntegratorId::rk4, step: Some(1e-3), end: 1.0, ..Settings::default() };
    /// let mut simulation = Simulation::new(&robot, settings)?;
    /// let mut push = |_t: f64, q: &[f64], _v: &[f64], tau: &mut [f64]| tau[0] = -8.0 * q[0];
    /// simulation.start(&[1.0], &[0.0])?;
    /// while simulation.step(&mut push)? {
    ///     // The state may be read after every step: simulation.t(), simulation.q(), simulation.v().
    /// }
    /// // A mass of 2 kg on a spring of 8 N/m.
    /// assert!((simulation.q()[0] - 2.0_f64.cos()).abs() < 1e-9);
    /// # Ok(()) }
    /// ```
    pub fn start(&mut self, q: &[f64], v: &[f64]) -> Result<(), SimulateError> {
        StateError::none(self.system.manifold.wrong_state(&self.system.robot, q, v))?;
        self.begin(q, v)
    }

    /// One step of the integrator from the present state. Returns `false` once the end time of the
    /// settings is reached; then the state no longer changes.
    ///
    /// The step is that of a run: of length [`Settings::step`](super::super::Settings::step) or
    /// chosen by the tolerances, and cut where a sampled control is sampled. Nothing is recorded,
    /// no event is looked for, and [`Settings::max_steps`](super::super::Settings::max_steps) is
    /// ignored. Nothing is allocated after the first step. Before the first call of
    /// [`Simulation::start`] all coordinates are 0 and the robot rests. Errors: as
    /// [`Simulation::run`]; the state is then that before the step.
    pub fn step(&mut self, control: &mut dyn Control) -> Result<bool, SimulateError> {
        if self.t >= self.settings.end {
            return Ok(false);
        }
        let mut unrecorded = self.unrecorded.take().unwrap_or_default();
        let mut run = Run { control, events: &mut [], recording: &mut unrecorded };
        let result = self.unrecorded_step(&mut run).map_err(|error| self.blamed(error));
        self.unrecorded = Some(unrecorded);
        result.map(|()| true)
    }

    fn unrecorded_step(&mut self, run: &mut Run) -> Result<(), SimulateError> {
        if !self.progress.started {
            StateError::none(self.wrong_control(run.control))?;
            self.prepare(run)?;
        }
        self.one_step(run).map(drop)
    }

    /// The time that was reached, s.
    pub fn t(&self) -> f64 {
        self.t
    }

    /// The configuration that was reached, `[nq]`.
    #[expect(clippy::misnamed_getters, reason = "the state is the origin of the chart between steps")]
    pub fn q(&self) -> &[f64] {
        &self.system.origin
    }

    /// The velocity that was reached, `[nv]`.
    pub fn v(&self) -> &[f64] {
        let nv = self.shape.nv;
        &self.y[nv..2 * nv]
    }

    /// Counts since the start.
    pub fn counts(&self) -> &Counts {
        &self.system.counts
    }
}
