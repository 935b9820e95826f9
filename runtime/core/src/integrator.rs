//! The one table of integrators, from which simulations, scenes, documentation and tests read.
//!
//! Adding one: its file in `runtime/src/simulate/integrator`, its line in the `method` of that
//! folder, its row here.

use alloc::string::String;
use core::fmt;

use crate::algorithm::FunctionId;

/// One row: an integrator.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Integrator {
    /// Which one.
    pub id: IntegratorId,
    /// Its name everywhere: in scenes, on the command line.
    pub name: &'static str,
    /// The error of a motion of fixed length falls as this power of the step.
    pub order: u32,
    /// Whether it chooses its steps by tolerances where no step is given.
    pub adaptive: bool,
    /// Whether it solves equations in each step, so that stiffness does not bound the step.
    pub implicit: bool,
    /// When to take it.
    pub what_for: &'static str,
    /// Names of methods for the same problems in other programs, in lower case without `_` and `-`.
    pub elsewhere: &'static str,
    /// Where it is from.
    pub source: &'static str,
    /// Functions that the robot must have. A robot with a quaternion among its coordinates needs
    /// `integrate` as well, for all of them.
    pub needs: &'static [FunctionId],
}

const EXPLICIT: &[FunctionId] = &[FunctionId::forward_dynamics];

macro_rules! integrators {
    ($($(#[$doc:meta])* $name:ident { order: $order:literal, adaptive: $adaptive:literal, implicit: $implicit:literal, what_for: $what_for:literal,
        elsewhere: $elsewhere:literal, source: $source:literal, needs: $needs:expr })*) => {
        /// The integrators by name: each variant is called as scenes call it.
        #[allow(non_camel_case_types)]
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub enum IntegratorId {
            $($(#[$doc])* $name,)*
        }

        const ROWS: &[Integrator] = &[$(
            Integrator {
                id: IntegratorId::$name,
                name: stringify!($name),
                order: $order,
                adaptive: $adaptive,
                implicit: $implicit,
                what_for: $what_for,
                elsewhere: $elsewhere,
                source: $source,
                needs: $needs,
            },
        )*];
    };
}

integrators! {
    /// Velocities first, then configurations with the new velocities.
    semi_implicit_euler {
        order: 1, adaptive: false, implicit: false,
        what_for: "one evaluation a step, energy bounded where the mass matrix is constant: games, sketches, comparison",
        elsewhere: "euler expliciteuler forwardeuler symplecticeuler",
        source: "Hairer, Lubich & Wanner, Geometric Numerical Integration, 2006, (I.1.9)",
        needs: EXPLICIT
    }
    /// The classical method of four stages.
    rk4 {
        order: 4, adaptive: false, implicit: false,
        what_for: "fixed steps: a controller's clock, a cost that is known beforehand",
        elsewhere: "rungekutta rungekutta4 classicalrk4",
        source: "Hairer, Nørsett & Wanner, Solving Ordinary Differential Equations I, 1993, Table II.1.2",
        needs: EXPLICIT
    }
    /// Dormand's and Prince's pair of orders 5 and 4.
    dopri5 {
        order: 5, adaptive: true, implicit: false,
        what_for: "the first to try: errors from 1e-3 to 1e-8, motions that are not stiff",
        elsewhere: "rk45 rk23 rkf45 ode45 ode23 dopri dopri45 dormandprince dp5 dp45 bs3 tsit5",
        source: "Dormand & Prince, J. Comput. Appl. Math. 6, 1980; dense output Hairer, Nørsett & Wanner 1993, (II.6.12)",
        needs: EXPLICIT
    }
    /// Dormand's, Prince's and Hairer's method of order 8.
    dop853 {
        order: 8, adaptive: true, implicit: false,
        what_for: "errors below 1e-8, long smooth motions, references",
        elsewhere: "ode78 ode89 ode113 dp8 vern7 vern8 vern9",
        source: "Hairer, Nørsett & Wanner, Solving Ordinary Differential Equations I, 1993, §II.5 and §II.10",
        needs: EXPLICIT
    }
    /// Hairer's and Wanner's linearly implicit method of order 4.
    rodas4 {
        order: 4, adaptive: true, implicit: true,
        what_for: "stiff damping, springs, limits, contact: L-stable, and a decay never changes its sign, whatever the step",
        elsewhere: "radau radau5 radauiia5 bdf lsoda vode cvode cvodebdf qndf fbdf trbdf2 kencarp4 rosenbrock rosenbrock23 rodas rodas5 rodas5p ode15s ode15i ode23s ode23t ode23tb",
        source: "Hairer & Wanner, Solving Ordinary Differential Equations II, 1996, §IV.7 and §VI.4",
        needs: &[FunctionId::forward_dynamics, FunctionId::forward_dynamics_derivatives]
    }
    /// The implicit midpoint rule on the manifold.
    lie_midpoint {
        order: 2, adaptive: false, implicit: true,
        what_for: "long free motion: a body by itself keeps energy and momentum to rounding, other robots do not drift",
        elsewhere: "midpoint implicitmidpoint",
        source: "Simo & Wong, Int. J. Numer. Methods Eng. 31, 1991; Hairer, Lubich & Wanner 2006, §IV.2",
        needs: EXPLICIT
    }
}

/// All integrators, in the order of printed lists.
pub fn integrators() -> &'static [Integrator] {
    ROWS
}

/// The integrator called `name`.
pub fn integrator(name: &str) -> Option<&'static Integrator> {
    ROWS.iter().find(|row| row.name == name)
}

/// The integrator that other programs call `name`, in any case.
pub fn resolve_synonym(name: &str) -> Option<&'static Integrator> {
    let plain: String = name.chars().filter(|c| !"_- ".contains(*c)).flat_map(char::to_lowercase).collect();
    ROWS.iter().find(|row| row.elsewhere.split(' ').any(|word| word == plain))
}

impl IntegratorId {
    /// Its row.
    pub fn row(self) -> &'static Integrator {
        &ROWS[self as usize]
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        self.row().name
    }
}

impl fmt::Display for IntegratorId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

#[cfg(test)]
mod tests {
    use super::{integrator, integrators, resolve_synonym};

    #[test]
    fn every_name_finds_its_own_row() {
        for row in integrators() {
            assert_eq!(integrator(row.name), Some(row));
            assert_eq!(row.id.row(), row);
        }
        assert_eq!(integrator("euler"), None);
    }

    #[test]
    fn what_others_call_them_finds_one_for_the_same_problems() {
        let named = |name| resolve_synonym(name).map(|row| row.name);
        assert_eq!(
            ["RK45", "ode15s", "Radau", "DOP853", "midpoint", "verlet"].map(named),
            [Some("dopri5"), Some("rodas4"), Some("rodas4"), None, Some("lie_midpoint"), None]
        );
        for row in integrators() {
            assert!(row.elsewhere.split(' ').all(|word| integrator(word).is_none() && resolve_synonym(word) == Some(row)), "{}", row.name);
        }
    }
}
