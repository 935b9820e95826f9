//! A function of the table: its arguments, its results, its requirements.

use alloc::vec::Vec;

use super::argument::size;
use super::{Argument, Dim, FunctionError, FunctionId, Port, Workspace, check_count, check_length, functions};
use crate::Scalar;
use crate::model::Model;

/// The sizes that the shapes of arguments and results depend on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Shape {
    /// Number of coordinates.
    pub nq: usize,
    /// Number of degrees of freedom.
    pub nv: usize,
    /// Number of frames.
    pub frames: usize,
    /// Number of moving links ([`Model::links`](crate::model::Model::links)).
    pub links: usize,
    /// Number of actuators ([`Model::actuators`](crate::model::Model::actuators)): of controls.
    pub controls: usize,
    /// Number of actuators with an activation.
    pub activations: usize,
    /// Number of places where shapes may touch
    /// ([`Constraints::contacts`](crate::constraint::Constraints::contacts)).
    pub contacts: usize,
    /// Number of contacts that a caller gives.
    pub given: usize,
}

impl<S: Scalar> Model<S> {
    /// For each degree of freedom its path to the root, the next first: the entries before the
    /// diagonal in row k of M and of the factors of M = Lᵀ D L.
    pub fn paths_to_root(&self) -> alloc::vec::Vec<alloc::vec::Vec<usize>> {
        let parent_dof = super::workspace::parent_dof(self);
        (0..self.nv).map(|k| super::ltdl::path_to_root(&parent_dof, k).collect()).collect()
    }

    /// The model's sizes.
    pub fn shape(&self) -> Shape {
        Shape {
            nq: self.nq,
            nv: self.nv,
            frames: self.frames.len(),
            links: self.links().count(),
            controls: self.actuators.laws.len(),
            activations: self.actuators.activations(),
            contacts: self.constraints.contacts(),
            given: self.constraints.pair_of_given().count(),
        }
    }
}

/// Requirements on a robot for a function to be defined.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Needs {
    /// Nothing.
    Nothing,
    /// Something that moves has mass.
    Mass,
    /// The mass matrix can be inverted: every joint moves something that has mass.
    MassMatrix,
    /// That, and every frame is carried by at least six degrees of freedom.
    FreeFrames,
}

/// Arguments of an algorithm; an empty slice means zeros.
pub struct Inputs<'a, S> {
    /// Those of the table, by their places.
    pub(super) known: [&'a [S]; Argument::ALL.len()],
    /// Those of a user's function.
    own: &'a [(Argument, &'a [S])],
}

impl<'a, S> Inputs<'a, S> {
    /// These arguments, and no others.
    #[inline]
    pub(super) fn new<const N: usize>(given: [(usize, &'a [S]); N]) -> Self {
        let mut inputs = Self { known: [&[]; Argument::ALL.len()], own: &[] };
        given.into_iter().for_each(|(place, given)| inputs.known[place] = given);
        inputs
    }

    /// These arguments of a user's function.
    pub(super) fn of_own(own: &'a [(Argument, &'a [S])]) -> Self {
        Self { known: [&[]; Argument::ALL.len()], own }
    }

    /// The numbers of an argument; none if it is not given.
    pub fn get(&self, argument: Argument) -> &'a [S] {
        let known = argument.place().and_then(|place| self.known.get(place)).filter(|given| !given.is_empty());
        let own = || self.own.iter().find(|(other, _)| *other == argument).map_or(&[][..], |(_, given)| *given);
        known.copied().unwrap_or_else(own)
    }
}

/// An algorithm as the table holds it, lengths checked.
pub(crate) type Run<S> = &'static (dyn Fn(&Model<S>, &mut Workspace<S>, &Inputs<'_, S>, &mut [S]) + Send + Sync);

/// One way to compute a function.
pub struct Variant<S: 'static> {
    /// Its name in the ledger.
    pub name: &'static str,
    /// Whether it is defined for a model.
    pub applies: fn(&Model<S>) -> bool,
    /// Lower bound of its multiplications if all joints feel each other; zero if the bound is
    /// unknown. A way that cannot be the cheapest need not be tried.
    pub least: fn(&Model<S>) -> u64,
    pub(crate) run: Run<S>,
}

/// A group of functions: for printed lists, and to request them by one word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Group {
    /// Of frames.
    Kinematics,
    /// Torques, accelerations and the mass matrix.
    Dynamics,
    /// Of placements and dynamics.
    Derivatives,
    /// With energy and the centre of mass.
    Momentum,
    /// Of torques and energy.
    Regressors,
    /// Λ and its inverse.
    OperationalSpace,
    /// Effects of a scene.
    Effects,
    /// Steps, differences and draws.
    Configurations,
    /// Whole steps of time, which are in a table of their own ([`crate::step`]).
    Steps,
    /// Forces of a robot's actuators and steps with them, which are in a table of their own.
    Actuators,
    /// What touches: accelerations with constraints and steps with them, which are in a table of
    /// their own.
    Constraints,
    /// The same with contacts that a caller finds.
    GivenContacts,
    /// States in MuJoCo's conventions, which are in a table of their own.
    Mujoco,
    /// Functions of users, which are not in the table.
    User,
}

impl Group {
    /// All of them, in the order in which they are listed.
    pub const ALL: [Self; 8] = [
        Self::Kinematics,
        Self::Dynamics,
        Self::Derivatives,
        Self::Momentum,
        Self::Regressors,
        Self::OperationalSpace,
        Self::Effects,
        Self::Configurations,
    ];

    /// The groups of the tables of [`crate::step`].
    pub const BESIDE: [Self; 5] = [Self::Steps, Self::Actuators, Self::Constraints, Self::GivenContacts, Self::Mujoco];

    /// Its name in lists of functions.
    pub fn name(self) -> &'static str {
        match self {
            Self::Kinematics => "kinematics",
            Self::Dynamics => "dynamics",
            Self::Derivatives => "derivatives",
            Self::Momentum => "momentum",
            Self::Regressors => "regressors",
            Self::OperationalSpace => "operational_space",
            Self::Effects => "effects",
            Self::Configurations => "configurations",
            Self::Steps => "steps",
            Self::Actuators => "actuators",
            Self::Constraints => "constraints",
            Self::GivenContacts => "given_contacts",
            Self::Mujoco => "mujoco",
            Self::User => "user",
        }
    }

    /// The group of this name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|group| group.name() == name)
    }

    /// Its title in lists.
    pub fn title(self) -> &'static str {
        match self {
            Self::Kinematics => "Kinematics of frames",
            Self::Dynamics => "Dynamics",
            Self::Derivatives => "Derivatives",
            Self::Momentum => "Energy, centre of mass and momentum",
            Self::Regressors => "Regressors",
            Self::OperationalSpace => "Operational space",
            Self::Effects => "Effects of a scene",
            Self::Configurations => "Configurations",
            Self::Steps => "Steps of time",
            Self::Actuators => "Actuators of the file, and steps of time with them",
            Self::Constraints => "What touches: accelerations and steps with limits, dry friction and contacts",
            Self::GivenContacts => "Accelerations and steps with constraints, and with contacts that a caller finds",
            Self::Mujoco => "States in MuJoCo's conventions",
            Self::User => "Functions of users",
        }
    }

    /// The group of a function.
    pub fn of(function: FunctionId) -> Self {
        function.row::<f64>().group
    }

    /// Names of its functions, in the table's order.
    pub fn functions(self) -> impl Iterator<Item = &'static str> {
        functions::<f64>().iter().filter(move |f| f.group == self).map(|f| f.name)
    }
}

/// One row, or a preset of one: a function that any robot can have.
pub struct Function<S: 'static> {
    /// Its number.
    pub id: FunctionId,
    /// The row: the function with all arguments. A preset is the function of another row, with
    /// zeros for the arguments that it does not take.
    pub general: FunctionId,
    /// Its name everywhere: in Rust, in scenes, on the command line.
    pub name: &'static str,
    /// The equation and its meaning.
    pub summary: &'static str,
    /// The algorithm and its source.
    pub source: &'static str,
    /// Its arguments, in order.
    pub takes: &'static [Argument],
    /// The dimensions of its result; empty for a single number.
    pub gives: &'static [Dim],
    /// The results, if there are several; empty for one.
    pub outputs: &'static [Port],
    /// The units of its result, and the meaning of the dimensions.
    pub unit: &'static str,
    /// Its group in lists.
    pub group: Group,
    /// Requirements on the robot.
    pub needs: Needs,
    /// Whether it depends only on joint torques and quantities that follow from them, so that mass
    /// may be moved along joints that cannot feel it, and frames along their axes.
    pub regrouped: bool,
    /// Ways to compute it. The generator takes the cheapest, [`Function::call`] the first that
    /// applies.
    pub ways: &'static [Variant<S>],
    /// The functions of the table that it consists of, one for each call; empty for those of the
    /// table and of users.
    pub contains: &'static [FunctionId],
    /// All of it but the solution of M X = −B for all columns of `[3][nv][nv]` numbers: two
    /// matrices B, and the factors of M = Lᵀ D L in the third, L below the diagonal and D⁻¹ on it;
    /// the third X is M⁻¹. For callers that solve column by column by themselves.
    pub unsolved: Option<Variant<S>>,
}

impl<S: Scalar> Function<S> {
    /// The row's arguments that are zero; none for a row.
    pub fn zeros(&self) -> impl Iterator<Item = Argument> + '_ {
        self.general.row::<S>().takes.iter().copied().filter(|argument| !self.takes.contains(argument))
    }

    /// The same function with some of its arguments at zero: of the presets of its row the one that
    /// takes the fewest, or the function itself.
    pub fn at_zero(&self, is_zero: impl Fn(Argument) -> bool) -> &'static Self {
        let fits = |f: &&Self| {
            let rest_is_zero = self.takes.iter().all(|a| f.takes.contains(a) || is_zero(*a));
            f.general == self.general && f.takes.iter().all(|a| self.takes.contains(a)) && rest_is_zero
        };
        functions().iter().filter(fits).min_by_key(|f| f.takes.len()).unwrap_or(self.id.row())
    }

    /// Whether the function divides by the mass matrix, so that a joint that moves no mass makes it
    /// undefined.
    pub fn inverts_mass_matrix(&self) -> bool {
        matches!(self.needs, Needs::MassMatrix | Needs::FreeFrames)
    }

    /// Whether it places the robot at its argument q alone. A step of several stages places it at
    /// others too.
    pub fn is_at_one_configuration(&self) -> bool {
        self.contains.len() <= 1
    }

    /// Whether it takes or returns something for each frame.
    pub fn asks_for_frames(&self) -> bool {
        let of_frames = |dims: &[Dim]| dims.contains(&Dim::Frames);
        // A user's function may use any frame.
        self.group == Group::User || of_frames(self.gives) || self.takes.iter().any(|a| of_frames(a.dims()))
    }

    /// The number of its results.
    pub fn len(&self, shape: Shape) -> usize {
        if self.outputs.is_empty() { size(self.gives, shape) } else { self.outputs.iter().map(|port| port.len(shape)).sum() }
    }

    /// The function of the table that is the Jacobian of this one, if there is one: an array
    /// `[blocks][nv][nv]`, and the arguments of each block.
    pub fn jacobian(&self) -> Option<(&'static Self, &'static [&'static [Argument]])> {
        const BLOCKS: &[&[Argument]] = &[&[Argument::Q], &[Argument::V], &[Argument::A, Argument::Tau]];
        use FunctionId as F;
        let id = match (self.general, self.takes.contains(&Argument::Wrenches)) {
            (F::inverse_dynamics_with_wrenches, false) => F::inverse_dynamics_derivatives,
            (F::inverse_dynamics_with_wrenches, true) => F::inverse_dynamics_derivatives_with_wrenches,
            (F::forward_dynamics_with_wrenches, false) => F::forward_dynamics_derivatives,
            (F::forward_dynamics_with_wrenches, true) => F::forward_dynamics_derivatives_with_wrenches,
            _ => return None,
        };
        Some((id.row(), BLOCKS))
    }

    /// Evaluates the function; `arguments` in the order of `takes`, `out` as `gives` says, row by
    /// row.
    pub fn call(&self, model: &Model<S>, ws: &mut Workspace<S>, arguments: &[&[S]], out: &mut [S]) -> Result<(), FunctionError> {
        let way = self.ways.iter().find(|w| (w.applies)(model)).ok_or(FunctionError::NoWay { function: self.name })?;
        self.call_by(way, model, ws, arguments, out)
    }

    /// Evaluates the function in one of its ways.
    pub fn call_by(
        &self,
        way: &Variant<S>,
        model: &Model<S>,
        ws: &mut Workspace<S>,
        arguments: &[&[S]],
        out: &mut [S],
    ) -> Result<(), FunctionError> {
        if !ws.fits(model) {
            return Err(FunctionError::Workspace);
        }
        let shape = ws.shape;
        check_count(self.name, arguments.len(), self.takes.len())?;
        let mut inputs = Inputs::new([]);
        for (argument, given) in self.takes.iter().zip(arguments) {
            check_length(argument.name(), given.len(), argument.len(shape))?;
            if let Some(slot) = argument.place().and_then(|place| inputs.known.get_mut(place)) {
                *slot = given;
            }
        }
        check_length("out", out.len(), self.len(shape))?;
        if self.id == FunctionId::user {
            let own: Vec<(Argument, &[S])> = self.takes.iter().copied().zip(arguments.iter().copied()).collect();
            (way.run)(model, ws, &Inputs::of_own(&own), out);
            return Ok(());
        }
        (way.run)(model, ws, &inputs, out);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use alloc::string::ToString;
    use alloc::vec::Vec;

    use super::*;
    use crate::description::{Base, Description, Link};

    #[test]
    fn a_preset_takes_a_part_of_what_its_row_takes_and_is_found_from_it() {
        for f in functions::<f64>() {
            let row = f.general.row::<f64>();
            let kept: Vec<Argument> = row.takes.iter().copied().filter(|a| f.takes.contains(a)).collect();
            assert_eq!((row.id, kept.as_slice()), (row.general, f.takes), "{}", f.name);
            let zeros: Vec<Argument> = f.zeros().collect();
            assert_eq!((zeros.is_empty(), row.at_zero(|a| zeros.contains(&a)).id), (f.id == row.id, f.id), "{}", f.name);
        }
    }

    #[test]
    fn a_function_without_a_way_is_told_and_gives_nothing() {
        let robot = Description { links: Vec::from([Link::default()]).into(), ..Description::default() };
        let model = Model::<f64>::new(&robot, Base::Floating).unwrap();
        let without = Function { ways: &[], unsolved: None, ..*super::super::function::<f64>("mass_matrix").unwrap() };
        let found = without.call(&model, &mut Workspace::new(&model), &[&[0.0; 7]], &mut [0.0; 36]);
        assert_eq!(found, Err(FunctionError::NoWay { function: "mass_matrix" }));
        assert!(found.unwrap_err().to_string().starts_with("mass_matrix: found no way"));
    }
}
