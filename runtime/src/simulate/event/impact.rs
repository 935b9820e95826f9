//! The impact of a point of the robot on a free ball: an instantaneous map of the state.

use articulated_core::algorithm::check_length;
use articulated_core::dynamics::Dynamics;
use articulated_core::effect::unit;

use super::{Action, ContactPoint, Points, value, wrong_place};
use crate::simulate::{SimulateError, StateError};

/// A frictionless impact along a normal:
///
/// ```text
/// p = (1 + e)·(v_n − v_b)·m_b/(m_b·nᵀ J M⁻¹ Jᵀ n + 1)      v += −M⁻¹ Jᵀ n p      v_b += p/m_b
/// ```
///
/// with v_n = nᵀ J v, the velocity of the point along n, and J its translational Jacobian: Newton's
/// law of restitution with the momentum of the whole robot, Brach, *Mechanical Impact Dynamics*,
/// 1991, §3. A ball at rest leaves at (1 + e)·v_n·m_h/(m_h + m_b), where 1/m_h = nᵀ J M⁻¹ Jᵀ n.
/// Energy lost: ½(1 − e²)(v_n − v_b)²·m_h m_b/(m_h + m_b).
///
/// The robot needs the functions `placements`, `jacobians_world_aligned` and `solve_mass_matrix`.
pub struct Impact<'r, R: Dynamics<f64>> {
    points: Points<'r, R>,
    point: [f64; 3],
    normal: [f64; 3],
    mass: f64,
    restitution: f64,
    jacobians: Vec<f64>,
    row: Vec<f64>,
    response: Vec<f64>,
}

/// The result of an impact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Struck {
    /// The ball's speed along the normal after it, m/s.
    pub ball_speed: f64,
    /// Transferred momentum, N·s; zero if point and ball were not approaching.
    pub impulse: f64,
    /// m_h, kg: the effective mass of the robot at the point.
    pub effective_mass: f64,
    /// Speed of the point towards the ball before it, m/s.
    pub approach: f64,
}

impl<'r, R: Dynamics<f64>> Impact<'r, R> {
    /// At a point whose normal points to the ball; the ball's mass, kg; the coefficient of
    /// restitution, from 0 to 1. Errors: all invalid numbers, at once.
    pub fn new(robot: &'r R, at: ContactPoint, mass: f64, restitution: f64) -> Result<Self, SimulateError> {
        let ContactPoint { frame, point, normal } = at;
        let wrong_mass = value("mass of the ball", mass, "finite, greater than 0, kg", mass > 0.0);
        let wrong_restitution = value("restitution", restitution, "from 0 to 1", (0.0..=1.0).contains(&restitution));
        StateError::none(wrong_place(robot, &at).chain(wrong_mass).chain(wrong_restitution))?;
        let (points, shape) = (Points::new(robot, frame)?, robot.shape());
        let (nv, vectors) = (shape.nv, || vec![0.0; shape.nv]);
        let jacobians = vec![0.0; 6 * nv * shape.frames];
        let (row, response) = (vectors(), vectors());
        let mut impact = Self { points, point, normal: unit(normal).unwrap_or(normal), mass, restitution, jacobians, row, response };
        impact.strike(&vec![0.5; shape.nq], &mut vectors(), 0.0)?;
        Ok(impact)
    }

    /// The state before becomes the state after: v `[nv]` is changed; `ball` is the ball's speed
    /// along the normal before, m/s.
    pub fn strike(&mut self, q: &[f64], v: &mut [f64], ball: f64) -> Result<Struck, SimulateError> {
        let nv = self.row.len();
        check_length("v", v.len(), nv)?;
        StateError::none(
            (!ball.is_finite()).then_some(StateError::Value { what: "ball", found: ball, right: "a speed, m/s".into() }).into_iter(),
        )?;
        self.points.point(q, self.point)?;
        let [x, y, z] = self.points.turned(self.point);
        let robot = self.points.robot;
        robot.jacobians_world_aligned(&mut self.points.ws, q, &mut self.jacobians)?;
        let j = &self.jacobians[6 * nv * self.points.frame..];
        let n = self.normal;
        // nᵀ(ṗ + ω × r) = nᵀ ṗ + ωᵀ(r × n)
        let arm = [y * n[2] - z * n[1], z * n[0] - x * n[2], x * n[1] - y * n[0]];
        for (i, row) in self.row.iter_mut().enumerate() {
            *row = (0..3).map(|k| arm[k] * j[k * nv + i] + n[k] * j[(3 + k) * nv + i]).sum();
        }
        robot.solve_mass_matrix(&mut self.points.ws, q, &self.row, &mut self.response)?;
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let (inverse, approach) = (dot(&self.row, &self.response), dot(&self.row, v) - ball);
        // p/m_b, for balls of next to no mass too.
        let gain = (1.0 + self.restitution) * approach.max(0.0) / (inverse * self.mass + 1.0);
        let impulse = gain * self.mass;
        v.iter_mut().zip(&self.response).for_each(|(v, r)| *v -= r * impulse);
        Ok(Struck { ball_speed: ball + gain, impulse, effective_mass: 1.0 / inverse, approach })
    }

    /// The impact on a ball at rest, as the action of an event; the map returns the ball's speed,
    /// m/s.
    pub fn action<'a>(mut self) -> Action<'a>
    where
        Self: 'a,
    {
        Action::Map(Box::new(move |_, q, v| Ok(Some(self.strike(q, v, 0.0)?.ball_speed))))
    }
}
