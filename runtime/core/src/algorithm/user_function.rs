//! Functions of users: a task error, a cost, a constraint, a controller, written once over the
//! scalar as the functions of the table are.

use alloc::boxed::Box;
use alloc::vec;
use alloc::vec::Vec;

use super::registry::Inputs;
use super::{Argument, Dim, Function, FunctionError, FunctionId, Group, Needs, Port, Variant, Workspace, check_count, check_length};
use crate::Scalar;
use crate::model::Model;

/// A function of a robot beyond the table. [`user_function!`](crate::user_function) makes one from
/// a generic function.
///
/// It runs with `f64` and `f32`; with symbols it becomes generated code, with all derivatives; with
/// dual numbers and big floats it is checked. A comparison of values is
/// `S::select(x.positive(), …)`.
pub trait UserFunction: Send + Sync + 'static {
    /// Its name in generated code: lower case letters, digits and `_`.
    const NAME: &'static str;
    /// The equation and its meaning, for documentation.
    const SUMMARY: &'static str;
    /// Its arguments: those that functions of the table take (`Argument::Q`), and others
    /// ([`Argument::new`]).
    const INPUTS: &'static [Argument];
    /// Its results: at least one.
    const OUTPUTS: &'static [Port];

    /// Computes the results; `out` has room for all of them, one after the other, and is zero at
    /// the start.
    fn run<S: Scalar>(&self, robot: &Model<S>, work: &mut Workspace<S>, given: &Inputs<'_, S>, out: &mut [S]);

    /// Evaluates the function; arguments in the order of `INPUTS`.
    ///
    /// # Errors
    /// Arguments or results of another length than the ports say, and another robot's workspace.
    fn call<S: Scalar>(&self, robot: &Model<S>, work: &mut Workspace<S>, arguments: &[&[S]], out: &mut [S]) -> Result<(), FunctionError> {
        if !work.fits(robot) {
            return Err(FunctionError::Workspace);
        }
        check_count(Self::NAME, arguments.len(), Self::INPUTS.len())?;
        let shape = robot.shape();
        for (argument, given) in Self::INPUTS.iter().zip(arguments) {
            check_length(argument.name(), given.len(), argument.len(shape))?;
        }
        check_length("out", out.len(), Self::OUTPUTS.iter().map(|port| port.len(shape)).sum())?;
        let given: Vec<(Argument, &[S])> = Self::INPUTS.iter().copied().zip(arguments.iter().copied()).collect();
        out.fill(S::zero());
        self.run(robot, work, &Inputs::of_own(&given), out);
        Ok(())
    }
}

impl<S: Scalar> Function<S> {
    /// A user's function as a row beside those of the table. It lives as long as the program.
    pub fn of_user<F: UserFunction>(function: F) -> &'static Self {
        let function: &'static F = Box::leak(Box::new(function));
        let run = move |model: &Model<S>, work: &mut Workspace<S>, given: &Inputs<'_, S>, out: &mut [S]| {
            out.fill(S::zero());
            function.run(model, work, given, out);
        };
        let variant = Variant { name: "", applies: |_| true, least: |_| 0, run: Box::leak(Box::new(run)) };
        let (gives, unit): (&'static [Dim], &'static str) = match F::OUTPUTS {
            [one] => (one.dims, one.unit),
            _ => (&[], ""),
        };
        Box::leak(Box::new(Self {
            id: FunctionId::user,
            general: FunctionId::user,
            name: F::NAME,
            summary: F::SUMMARY,
            source: "a user's function",
            takes: F::INPUTS,
            gives,
            outputs: if F::OUTPUTS.len() == 1 { &[] } else { F::OUTPUTS },
            unit,
            group: Group::User,
            needs: Needs::Nothing,
            regrouped: false,
            ways: Box::leak(vec![variant].into_boxed_slice()),
            contains: &[],
            unsolved: None,
        }))
    }
}

/// Makes a [`UserFunction`](crate::algorithm::UserFunction) from a generic function.
///
/// An argument with a name and dimensions of the table (`q: [Nq]`, `v: [Nv]`, …) is that of the
/// table. Dimensions are those of [`Dim`](crate::algorithm::Dim). Arguments are slices, results
/// mutable slices of zeros, all row by row; `S` is the scalar.
///
/// ```
/// use articulated_core::algorithm::{UserFunction, Workspace, center_of_mass};
/// use articulated_core::description::{Base, Description};
/// use articulated_core::model::Model;
/// use articulated_core::user_function;
///
/// user_function! {
///     /// c = ½ |p − target|²: how far the centre of mass is from a place.
///     pub struct Reach;
///     fn reach<S>(robot, work, q: [Nq] "rad", target: [Of(3)] "m, world axes")
///         -> (cost: [] "m²") {
///         let mut p = [S::zero(); 3];
///         center_of_mass(robot, work, q, &mut p);
///         for (p, target) in p.iter().zip(target) {
///             let off = *p - *target;
///             cost[0] += S::from_f64(0.5) * off * off;
///         }
///     }
/// }
///
/// # fn main() {
/// # let robot: Description = Default::default();
/// # let _ = (robot, Reach::NAME, Base::Fixed);
/// assert_eq!(Reach::INPUTS.iter().map(|a| a.name()).collect::<Vec<_>>(), ["q", "target"]);
/// # }
/// ```
#[macro_export]
macro_rules! user_function {
    ($(#[doc = $doc:literal])+ $visibility:vis struct $type:ident; fn $($function:tt)+) => {
        $(#[doc = $doc])+
        #[derive(Clone, Copy, Debug, Default)]
        $visibility struct $type;
        $crate::user_function!(@implement $type, [$($doc),+], $($function)+);
    };
    ($(#[doc = $doc:literal])+ $visibility:vis struct $type:ident { $($fields:tt)* } fn $($function:tt)+) => {
        $(#[doc = $doc])+
        #[derive(Clone, Debug)]
        $visibility struct $type { $($fields)* }
        $crate::user_function!(@implement $type, [$($doc),+], $($function)+);
    };
    (@implement $type:ident, [$($doc:literal),+],
     $name:ident<S>($(&$this:ident,)? $robot:ident, $work:ident $(, $argument:ident: [$($dim:ident $(($n:literal))?),*] $unit:literal)* $(,)?)
        -> ($($output:ident: [$($output_dim:ident $(($m:literal))?),*] $output_unit:literal),+ $(,)?) $body:block) => {
        impl $crate::algorithm::UserFunction for $type {
            const NAME: &'static str = stringify!($name);
            const SUMMARY: &'static str = concat!($($doc),+).trim_ascii();
            const INPUTS: &'static [$crate::algorithm::Argument] = &[$(
                $crate::algorithm::Argument::named(&$crate::algorithm::Port::new(
                    stringify!($argument),
                    &[$($crate::algorithm::Dim::$dim $(($n))?),*],
                    $unit,
                )),
            )*];
            const OUTPUTS: &'static [$crate::algorithm::Port] = &[$(
                $crate::algorithm::Port::new(
                    stringify!($output),
                    &[$($crate::algorithm::Dim::$output_dim $(($m))?),*],
                    $output_unit,
                ),
            )+];

            #[allow(unused_variables, unused_assignments)]
            fn run<S: $crate::Scalar>(
                &self,
                $robot: &$crate::model::Model<S>,
                $work: &mut $crate::algorithm::Workspace<S>,
                given: &$crate::algorithm::Inputs<'_, S>,
                out: &mut [S],
            ) {
                $(let $this = self;)?
                let (shape, mut number, mut rest) = ($robot.shape(), 0, out);
                $(
                    let $argument: &[S] = given.get(<Self as $crate::algorithm::UserFunction>::INPUTS[number]);
                    number += 1;
                )*
                number = 0;
                $(
                    let length = <Self as $crate::algorithm::UserFunction>::OUTPUTS[number].len(shape);
                    let ($output, others) = rest.split_at_mut(length);
                    (rest, number) = (others, number + 1);
                )+
                $body
            }
        }
    };
}

#[cfg(test)]
mod tests {
    use alloc::vec;

    use super::*;
    use crate::algorithm::{center_of_mass, kinetic_energy};
    use crate::description::{Base, Description, Inertial, Link, Origin};

    user_function! {
        /// c = ½ k |p − target|²: how far the centre of mass is from a place.
        pub(super) struct Reach {
            stiffness: f64,
        }
        fn reach<S>(&this, robot, work, q: [Nq] "rad", v: [Nv] "rad/s", target: [Of(3)] "m, world axes")
            -> (cost: [] "m²", energy: [] "J") {
            let mut p = [S::zero(); 3];
            center_of_mass(robot, work, q, &mut p);
            for (p, target) in p.iter().zip(target) {
                let off = *p - *target;
                cost[0] += S::from_f64(0.5 * this.stiffness) * off * off;
            }
            kinetic_energy(robot, work, q, v, energy);
        }
    }

    #[test]
    fn a_generic_function_becomes_a_row_with_ports() {
        assert_eq!((Reach::NAME, Reach::INPUTS[0], Reach::INPUTS[1]), ("reach", Argument::Q, Argument::V));
        assert!(Reach::SUMMARY.starts_with("c = ½ k") && Reach::SUMMARY.ends_with("from a place."));
        let inertial = Inertial { origin: Origin::default(), mass: 2.0, inertia: [1.0, 0.0, 0.0, 1.0, 0.0, 1.0] };
        let link = Link { name: "stone".into(), inertial: Some(inertial), ..Link::default() };
        let robot = Description { links: Vec::from([link]).into(), ..Description::default() };
        let model = Model::<f64>::new(&robot, Base::Floating).unwrap();
        let mut work = Workspace::new(&model);
        let (q, v, target) = ([1.0, 2.0, 3.0, 0.0, 0.0, 0.0, 1.0], [0.0, 0.0, 0.0, 3.0, 0.0, 0.0], [1.0, 0.0, 3.0]);
        let mut out = [9.0; 2];
        let reach = Reach { stiffness: 10.0 };
        reach.call(&model, &mut work, &[&q, &v, &target], &mut out).unwrap();
        assert_eq!(out, [20.0, 9.0]);
        let row = Function::<f64>::of_user(reach.clone());
        let mut again = vec![0.0; row.len(model.shape())];
        row.call(&model, &mut work, &[&q, &v, &target], &mut again).unwrap();
        assert_eq!((again.as_slice(), row.outputs.len(), row.takes.len()), (&out[..], 2, 3));
        let short = reach.call(&model, &mut work, &[&q, &v, &target[..2]], &mut out);
        assert_eq!(short, Err(FunctionError::Length { argument: "target", found: 2, expected: 3 }));
        assert_eq!(
            reach.call(&model, &mut work, &[&q, &v], &mut out).unwrap_err(),
            FunctionError::Arguments { function: "reach", found: 2, expected: 3 }
        );
    }
}
