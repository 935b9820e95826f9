//! Functions on a hard robot, judged in many digits.
//!
//! The reference is the generic library on the constants of the judged program, in 320 bits (other
//! tests compare it with the textbook's form, which shares no formula with it). Solutions are
//! judged by the torques that they need:
//!
//! ```text
//! η = max_i |ID_exact(q, v, a) − τ|_i / (|M| |a| + |h| + |τ|)_i
//! ```
//!
//! with τ the torques that the motors deliver. If joints follow others, or effects act, terms of M
//! and h may cancel: then |M| and |h| mean the sums of their magnitudes; so they do for every
//! user's robot ([`Case::by_terms`]).

use articulated_codegen::model_pass::View;
use articulated_core::algorithm::checked::{Factor, Singular, Solver};
use articulated_core::algorithm::{Argument, FunctionId, Workspace, checked_forward_dynamics};
use articulated_core::model::Model;
use articulated_reference::{Big, Exact, is_plain, scales};

use super::condition::{condition, diagonal, norm, sensitivity};
use super::machine::{Machine, cast, exact, wide, widened};
use super::row::{Case, Row};
use crate::residual::worse;
use crate::table::counted;

/// Robots of more degrees of freedom than this are judged without derivatives: 96 digits of its
/// cube take minutes.
pub(super) const DERIVATIVES: usize = 12;

/// Allowed η, and allowed errors of other results, in units of u times the magnitude of the terms.
pub const BACKWARD: f64 = 64.0;

/// Forward errors of solutions with the mass matrix allowed, ‖x − x_exact‖₂/‖x_exact‖₂: in units of
/// uκ₂(M), and, M scaled to a diagonal of ones and x with it, of u‖M⁻¹‖₂‖T‖₂, T the sums of
/// magnitudes of M's terms. That does not depend on units, and is much the smaller one wherever
/// masses or lengths differ. It is κ₂ where no element of M is the rest of larger terms; where one
/// is, M itself is off by that much before anything is solved.
pub const FORWARD: f64 = 4.0;

/// A motion and torques, in double precision.
#[derive(Clone, Debug, PartialEq)]
pub struct State {
    /// `[nq]`.
    pub q: Vec<f64>,
    /// `[nv]`.
    pub v: Vec<f64>,
    /// `[nv]`.
    pub a: Vec<f64>,
    /// `[nv]`.
    pub tau: Vec<f64>,
}

/// Accelerations and the remainder of the smallest pivot, or the singular joint.
type Outcome<F> = Result<(Vec<F>, f64), Singular<F>>;

/// Outcome of forward dynamics.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ends {
    /// A solution.
    Solved,
    /// An error that names this joint.
    Singular(&'static str),
    /// An error or a solution.
    Either,
}

/// A judge in one precision: the robot in it, and in many digits with the same constants.
pub struct Judge<'a, F: Machine> {
    case: &'a Case,
    model: Model<F>,
    wide: Model<f64>,
}

impl<'a, F: Machine> Judge<'a, F> {
    /// For a model, its constants rounded to this precision.
    pub fn new(case: &'a Case, model: &Model<f64>) -> Self {
        let model = model.cast::<F>();
        Self { case, wide: wide(&model), model }
    }

    /// A row with a limit; one with an infinite limit is only shown.
    fn row(&self, what: &str, measured: f64, limit: f64, unit: &'static str) -> Row {
        let what = format!("{what}, {}", F::NAME);
        if limit.is_finite() { self.case.row(what, measured, limit, unit) } else { self.case.shown(what, measured, unit) }
    }

    /// Inverse dynamics and mass matrix, and derivatives of small robots: forward errors over the
    /// sums of magnitudes of terms.
    pub fn forward(&self, states: &[State], derivatives: bool) -> Vec<Row> {
        let mut functions = vec![FunctionId::inverse_dynamics, FunctionId::mass_matrix];
        functions.extend(derivatives.then_some(FunctionId::inverse_dynamics_derivatives));
        let error = |f: &FunctionId| states.iter().map(|s| self.error(*f, s)).fold(0.0, worse);
        functions.iter().map(|f| self.row(f.name(), error(f), BACKWARD, "u")).collect()
    }

    /// Everything: [`Judge::forward`] with derivatives, then [`Judge::solved`].
    pub fn all(&self, states: &[State], ends: Ends, limit: f64) -> Vec<Row> {
        let mut rows = self.forward(states, true);
        rows.extend(self.solved(states, ends, limit));
        rows
    }

    /// Inverse dynamics, and forward dynamics by ABA: functions of linear time in the number of
    /// joints.
    pub fn recursions(&self, states: &[State]) -> Vec<Row> {
        let worst = |f: &dyn Fn(&State) -> f64| states.iter().map(f).fold(0.0, worse);
        let by_aba = |s: &State| self.checked(s).map_or(f64::NAN, |(a, _)| self.solution(&a, s)[0]);
        vec![
            self.row("inverse_dynamics", worst(&|s| self.error(FunctionId::inverse_dynamics, s)), BACKWARD, "u"),
            self.row("forward_dynamics by ABA, η", worst(&by_aba), BACKWARD, "u"),
        ]
    }

    /// The largest error of a function in units of u times the magnitude of its terms.
    fn error(&self, function: FunctionId, state: &State) -> f64 {
        let of = |a: &Argument| match *a {
            Argument::Q => &state.q,
            Argument::V => &state.v,
            Argument::A => &state.a,
            Argument::Tau => &state.tau,
            _ => unreachable!("functions of motion and torques"),
        };
        let takes = function.row::<F>().takes;
        let given: Vec<Vec<F>> = takes.iter().map(|a| cast(of(a))).collect();
        let found = call(function, &self.model, &given);
        let given: Vec<Vec<f64>> = given.iter().map(|x| widened(x)).collect();
        exact_error(function, &self.wide, &given, &found)
    }

    /// Forward dynamics: backward errors by ABA, by LᵀDL and refined, forward errors by LᵀDL, and
    /// how it ends.
    pub fn solved(&self, states: &[State], ends: Ends, limit: f64) -> Vec<Row> {
        let mut rows = Vec::new();
        let outcomes: Vec<_> = states.iter().map(|s| self.checked(s)).collect();
        rows.push(self.verdict(&outcomes, ends));
        let found = outcomes.iter().zip(states).filter_map(|(x, s)| Some(self.solution(&x.as_ref().ok()?.0, s)));
        let errors: Vec<[f64; 2]> = found.collect();
        let most = |errors: &[[f64; 2]], k: usize| errors.iter().map(|e| e[k]).fold(0.0, worse);
        if !errors.is_empty() {
            rows.push(self.row("forward_dynamics by ABA, η", most(&errors, 0), limit, "u"));
            rows.push(self.case.shown(format!("the same, forward error, {}", F::NAME), most(&errors, 1), "u"));
        }
        let errors: Vec<[f64; 3]> = states.iter().filter_map(|s| self.by_matrix(s)).collect();
        let most = |k: usize| errors.iter().map(|e| e[k]).fold(0.0, worse);
        if !errors.is_empty() {
            rows.push(self.row("forward_dynamics by LTDL, η", most(0), limit, "u"));
            rows.extend(self.refined(states));
            if is_plain(&self.wide) {
                rows.push(self.row("solve_mass_matrix by LTDL, error over κ₂(M)", most(1), FORWARD, "u"));
            }
            rows.push(self.row(
                "solve_mass_matrix by LTDL, error over ‖M⁻¹‖₂‖terms of M‖₂, scaled to a diagonal of ones",
                most(2),
                FORWARD,
                "u",
            ));
        }
        rows
    }

    fn wide_mass_matrix(&self, state: &State) -> Vec<f64> {
        call(FunctionId::mass_matrix, &self.wide, &[widened::<F>(&cast(&state.q))])
    }

    /// Accelerations, and the remainder of the smallest pivot.
    pub(super) fn checked(&self, state: &State) -> Outcome<F> {
        let [q, v, tau] = [&state.q, &state.v, &state.tau].map(|x| cast::<F>(x));
        let mut a = vec![F::zero(); self.model.nv()];
        let left = checked_forward_dynamics(&self.model, &mut Workspace::new(&self.model), &q, &v, &tau, &mut a)?;
        Ok((a, left.to_f64()))
    }

    /// The solver, which refines: η, where M is regular in this precision.
    pub(super) fn refined(&self, states: &[State]) -> Option<Row> {
        let eta = |s: &State| {
            let [q, v, tau] = [&s.q, &s.v, &s.tau].map(|x| cast::<F>(x));
            let mut a = vec![F::zero(); self.model.nv()];
            let mut solver = Solver::new(self.model.shape());
            solver.forward_dynamics(&self.model, &mut Workspace::new(&self.model), [&q, &v, &tau], &mut a).ok()?;
            Some(self.solution(&a, s)[0])
        };
        let most = states.iter().filter_map(eta).reduce(worse)?;
        Some(self.row("forward_dynamics by Solver, refined, η", most, BACKWARD, "u"))
    }

    /// By LᵀDL, where M is regular in this precision: η of forward dynamics; errors of M⁻¹τ over κ₂
    /// in units of u, of M as it is and of M scaled.
    fn by_matrix(&self, state: &State) -> Option<[f64; 3]> {
        let [q, v, tau] = [&state.q, &state.v, &state.tau].map(|x| cast::<F>(x));
        let m = call(FunctionId::mass_matrix, &self.model, std::slice::from_ref(&q));
        let mut factor = Factor::<F>::new(self.model.nv());
        factor.factor(&m).ok()?;
        let h = call(FunctionId::bias_forces, &self.model, &[q.clone(), v.clone()]);
        let driven = call(FunctionId::motor_torques, &self.model, &[v, tau.clone()]);
        let mut a: Vec<F> = driven.iter().zip(h).map(|(t, h)| *t - h).collect();
        factor.solve(&mut a);
        let mut x = tau.clone();
        factor.solve(&mut x);
        let difference: Vec<[f64; 2]> = Big::scope(|| {
            let [q, tau] = [&q, &tau].map(|x| cast::<Big>(&widened(x)));
            let expected = called(&exact(&self.model), FunctionId::solve_mass_matrix, &[q, tau]);
            expected.iter().zip(&x).map(|(e, x)| [e.error_of(x.to_f64(), 1.0), e.to_f64()]).collect()
        });
        let (m, one) = (self.wide_mass_matrix(state), vec![1.0; x.len()]);
        let terms = scale(FunctionId::mass_matrix, &self.wide, &[&widened::<F>(&q)])?;
        let far = |s: &[f64], by: f64| {
            let norm = |k: usize| norm(&difference.iter().zip(s).map(|(x, s)| x[k] * s).collect::<Vec<_>>());
            let error = norm(0);
            if error == 0.0 { 0.0 } else { error / norm(1) / by.max(1.0) / F::ROUNDOFF }
        };
        let s = diagonal(&m);
        Some([self.solution(&a, state)[0], far(&one, condition(&m, &one)), far(&s, sensitivity(&m, &terms, &s))])
    }

    fn verdict(&self, outcomes: &[Outcome<F>], ends: Ends) -> Row {
        let right = |outcome: &Result<_, Singular<F>>| match (ends, outcome) {
            (Ends::Either, _) | (Ends::Solved, Ok(_)) => true,
            (Ends::Singular(joint), Err(error)) => error.joint == joint,
            _ => false,
        };
        let wrong = outcomes.iter().find(|o| !right(o));
        let told = match wrong {
            Some(Err(error)) => format!("found an error: {error}"),
            Some(Ok((_, left))) => format!("found a solution, {left:e} of a pivot left"),
            None if ends == Ends::Solved => "a solution".to_owned(),
            None if ends == Ends::Either => either(outcomes),
            None => outcomes[0].as_ref().err().map_or_else(String::new, |e| format!("an error of joint {:?}", e.joint)),
        };
        self.case.holds(format!("checked_forward_dynamics, {}: {told}", F::NAME), wrong.is_none())
    }

    /// |M| and |h|.
    fn sizes(&self, q: &[f64], v: &[f64]) -> [Vec<f64>; 2] {
        let zeros = vec![0.0; v.len()];
        let terms =
            || Some([scale(FunctionId::mass_matrix, &self.wide, &[q])?, scale(FunctionId::inverse_dynamics, &self.wide, &[q, v, &zeros])?]);
        if let Some(terms) = (self.case.by_terms || !is_plain(&self.wide)).then(terms).flatten() {
            return terms;
        }
        let of = |function, arguments: &[&[f64]]| {
            let arguments: Vec<Vec<f64>> = arguments.iter().map(|x| x.to_vec()).collect();
            call(function, &self.wide, &arguments).into_iter().map(f64::abs).collect()
        };
        [of(FunctionId::mass_matrix, &[q]), of(FunctionId::bias_forces, &[q, v])]
    }

    /// η, and the forward error relative to the largest acceleration, in units of u.
    pub(super) fn solution(&self, a: &[F], state: &State) -> [f64; 2] {
        let [q, v, tau] = [&state.q, &state.v, &state.tau].map(|x| widened::<F>(&cast(x)));
        let (a, n) = (widened(a), a.len());
        let [m, h] = self.sizes(&q, &v);
        let driven = call(FunctionId::motor_torques, &self.wide, &[v.clone(), tau.clone()]);
        let scale = |i: usize| (0..n).map(|k| (m[i * n + k] * a[k]).abs()).sum::<f64>() + h[i] + driven[i].abs();
        Big::scope(|| {
            let model = exact(&self.model);
            let [q, v, precise] = [&q, &v, &a].map(|x| cast::<Big>(x));
            let needed = called(&model, FunctionId::inverse_dynamics, &[q.clone(), v.clone(), precise]);
            let backward = needed.iter().enumerate().map(|(i, t)| off(*t, F::from_f64(driven[i]), scale(i))).fold(0.0, worse);
            [backward, forward_error(&model, [&q, &v, &cast(&tau)], &a) / F::ROUNDOFF]
        })
    }
}

/// How it ended where both ways are right.
fn either<F: Machine>(outcomes: &[Outcome<F>]) -> String {
    let errors: Vec<&Singular<F>> = outcomes.iter().filter_map(|o| o.as_ref().err()).collect();
    let joint = errors.first().map_or("", |e| &e.joint);
    match (outcomes.len() - errors.len(), errors.len()) {
        (_, 0) => "a solution".to_owned(),
        (0, _) => format!("an error of joint {joint:?}"),
        (solved, refused) => format!("a solution in {}, an error of joint {joint:?} in {refused}", counted(solved, "state")),
    }
}

/// The largest error of a result in units of u times the magnitude of its terms, with the model's
/// constants and the arguments of the judged program.
pub fn exact_error<F: Machine>(function: FunctionId, model: &Model<f64>, given: &[Vec<f64>], found: &[F]) -> f64 {
    let slices: Vec<&[f64]> = given.iter().map(Vec::as_slice).collect();
    let Some(scale) = scale(function, model, &slices) else { return f64::NAN };
    Big::scope(|| {
        let given: Vec<Vec<Big>> = given.iter().map(|x| cast(x)).collect();
        let expected = called(&exact(model), function, &given);
        expected.iter().zip(found).zip(&scale).map(|((e, f), s)| off(*e, *f, *s)).fold(0.0, worse)
    })
}

/// The magnitudes of the terms of a function's results.
pub fn scale(function: FunctionId, model: &Model<f64>, arguments: &[&[f64]]) -> Option<Vec<f64>> {
    scales(model, function.name(), arguments).ok()
}

/// max |a − a_exact| / max |a_exact|.
fn forward_error(model: &Exact, state: [&[Big]; 3], a: &[f64]) -> f64 {
    let by_table = || called(model, FunctionId::forward_dynamics, &state.map(<[Big]>::to_vec));
    let expected = model.articulated_body(state).unwrap_or_else(by_table);
    let size = expected.iter().map(|x| x.to_f64().abs()).fold(0.0, worse);
    let far = expected.iter().zip(a).map(|(e, f)| e.error_of(*f, 1.0)).fold(0.0, worse);
    if far == 0.0 { 0.0 } else { far / size }
}

/// |found − expected| in units of u times the scale.
fn off<F: Machine>(expected: Big, found: F, scale: f64) -> f64 {
    expected.error_of(found.to_f64(), F::ROUNDOFF * scale)
}

/// A function of the table, in the first way that applies.
pub fn call<S: articulated_core::Scalar>(function: FunctionId, model: &Model<S>, arguments: &[Vec<S>]) -> Vec<S> {
    let row = function.row::<S>();
    let arguments: Vec<&[S]> = arguments.iter().map(Vec::as_slice).collect();
    let mut out = vec![S::zero(); row.len(model.shape())];
    row.call(model, &mut Workspace::new(model), &arguments, &mut out).expect("arguments of the lengths that the model says");
    out
}

/// The same for a view of the generator.
pub fn call_on_view(function: FunctionId, view: &View<f64>, arguments: &[Vec<f64>]) -> Vec<f64> {
    let row = function.row::<f64>();
    let arguments: Vec<&[f64]> = arguments.iter().map(Vec::as_slice).collect();
    let mut out = vec![0.0; row.len(view.model.shape())];
    row.call(&view.model, &mut view.workspace(), &arguments, &mut out).expect("arguments of the lengths that the model says");
    out
}

/// The same for a robot in many digits.
pub fn called(robot: &Exact, function: FunctionId, arguments: &[Vec<Big>]) -> Vec<Big> {
    let arguments: Vec<&[Big]> = arguments.iter().map(Vec::as_slice).collect();
    robot.call(function, &arguments).expect("arguments of the lengths that the robot says")
}
