//! The intermediate representation between a graph and text: typed statements.
//!
//! ```text
//! graph ──lower──▶ LIR ──passes──▶ LIR ──target──▶ text
//! ```
//!
//! Invariants:
//!
//! * LIR knows no robot and no language. A target knows no graph.
//! * No pass reads text. Printing comes last.
//! * [`verify`] holds before and after each pass: every operand is defined before its use, masks
//!   are
//!   used as masks only, and every number of the result is stored once.
//! * [`interpret`](interpret::interpret) computes a body: before and after each pass it gives the
//!   same numbers.

pub(crate) mod function;
pub mod interpret;
pub(crate) mod lower;
mod order;
pub(crate) mod pass;
mod verify;

pub use verify::verify;

use crate::graph::{Lanes, Op};

/// The type of the values of a body. Comparisons give masks, whatever the type.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Ty {
    /// `f64`.
    F64,
    /// `f32`.
    F32,
    /// A sum of two `f64`.
    Pair,
    /// This many `f64`: one for each of several isomorphic limbs.
    Vector(usize),
    /// A number of each of several states. The target chooses how many states a vector has.
    States,
}

impl Ty {
    /// How many lanes a value has for the interpreter. Of many states it computes one.
    #[must_use]
    pub fn lanes(self) -> usize {
        if let Self::Vector(lanes) = self { lanes } else { 1 }
    }
}

/// A value of a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Temp {
    /// Its number.
    pub id: u32,
    /// How many times it was loaded from a spill slot before: each load defines a value of its own.
    pub load: u32,
}

impl Temp {
    pub(crate) fn of(id: usize) -> Self {
        Self { id: id as u32, load: 0 }
    }

    pub(crate) fn index(self) -> usize {
        self.id as usize
    }
}

/// A spill slot: memory in which a value waits while the registers are full.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Slot {
    /// Whether it is rarely used. Slots that are often used lie where an instruction addresses them
    /// by one byte.
    pub is_far: bool,
    /// Its number among these.
    pub number: usize,
}

/// An operand of an operation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Operand {
    /// A value.
    Temp(Temp),
    /// A number, in every lane.
    Constant(f64),
    /// A constant of [`Body::lanes`]: a number for each lane.
    Lanes(u32),
    /// A value that is read from its spill slot.
    Slot(Slot),
}

impl Operand {
    /// The value that it is.
    #[must_use]
    pub fn temp(self) -> Option<Temp> {
        if let Self::Temp(temp) = self { Some(temp) } else { None }
    }
}

/// A number of the result: an operand, or a lane of it where operands are vectors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Number {
    /// The operand.
    pub of: Operand,
    /// The lane of a vector, else 0.
    pub lane: usize,
}

impl Number {
    /// Whether it is the constant zero.
    #[must_use]
    pub fn is_zero(&self) -> bool {
        self.of == Operand::Constant(0.0)
    }
}

/// The right-hand side of a `Let`.
#[derive(Clone, Debug, PartialEq)]
pub enum Expr {
    /// An element of an argument, in every lane.
    Input {
        /// Number of the argument.
        argument: u32,
        /// Index in it, row by row.
        index: u32,
    },
    /// Elements of an argument, one for each lane.
    LaneInput {
        /// Number of the argument.
        argument: u32,
        /// The number of the indices in [`Body::lanes`].
        indices: u32,
    },
    /// A lane in every lane.
    Broadcast(Number),
    /// An operation; operands beyond its arity are ignored.
    Op(Op, [Operand; 3]),
}

/// An angle, and where its sine and cosine go.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Angle {
    /// The angle, rad.
    pub angle: Operand,
    /// The sine, if it is used.
    pub sin: Option<Temp>,
    /// The cosine, if it is used.
    pub cos: Option<Temp>,
}

/// How the lanes of a few vectors lie in the result.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rows {
    /// Three numbers of each lane, the lanes one after the other.
    InTurn(usize),
    /// Four numbers of each lane, the first at these places.
    Fours([usize; 4]),
    /// Two numbers of each lane, the first at these places.
    Twos([usize; 4]),
}

/// Writes into the result. Places are indices in all its numbers, in order.
#[derive(Clone, Debug, PartialEq)]
pub enum Store {
    /// One number.
    One(usize, Number),
    /// Two numbers side by side, from a place on.
    Two(usize, [Number; 2]),
    /// Equal neighbouring numbers: first place, count, value.
    Fill(usize, usize, f64),
    /// All lanes of a vector side by side, from a place on.
    Whole(usize, Operand),
    /// The lanes of several vectors: number k of a lane is of vector k.
    Rows(Rows, Vec<Operand>),
}

/// A statement.
#[derive(Clone, Debug, PartialEq)]
pub enum Stmt {
    /// Defines a value.
    Let(Temp, Expr),
    /// Sines and cosines of several angles at once. `alone`: each is computed by itself, as there
    /// are few.
    SinCos {
        /// The angles.
        angles: Vec<Angle>,
        /// Whether there are too few to compute them together.
        alone: bool,
    },
    /// Twelve elements of an argument as three vectors of four lanes: vector k has elements k, k +
    /// 3, k + 6, k + 9.
    Thirds {
        /// The three vectors.
        dst: [Temp; 3],
        /// Number of the argument.
        argument: u32,
        /// Index of the first element.
        first: u32,
    },
    /// Sums over the lanes of two to four vectors, each in a lane of its own.
    SumLanes(Temp, Vec<Operand>),
    /// Puts a value where later pieces of the function find it.
    Keep(usize, Temp),
    /// Takes a value that an earlier piece of the function kept.
    Recall(Temp, usize),
    /// Puts a value into a spill slot.
    Spill(Slot, Temp),
    /// Loads a value from a spill slot.
    Load(Temp, Slot),
    /// Writes into the result.
    Store(Store),
    /// A number of the result, by its place: the result is built from all of them at the end.
    Result(usize, Number),
    /// Statements that run several times, once, or not at all.
    Region(Box<Region>),
}

/// A value that a region changes.
#[derive(Clone, Debug, PartialEq)]
pub struct Carried {
    /// The value in a turn. It is defined before the region, and changed at the end of each turn.
    pub temp: Temp,
    /// Its value at the start.
    pub start: Operand,
    /// Its value after the turn, an operand of the body.
    pub next: Operand,
}

/// The rows of a region.
#[derive(Clone, Debug, PartialEq)]
pub enum Table {
    /// Values.
    Values(Vec<Operand>),
    /// The numbers of a whole argument.
    Argument(u32),
}

/// How often a region runs.
#[derive(Clone, Debug, PartialEq)]
pub enum Turns {
    /// Until a mask of the body holds, at most so many times.
    Until {
        /// The bound.
        most: usize,
        /// The mask, or the number 0 or 1.
        mask: Operand,
        /// 1 after a turn in which the mask holds, before that 0.
        held: Temp,
    },
    /// Once where a mask holds.
    Where(Operand),
    /// Once for each row of a table.
    Each {
        /// The number of the table and of its results: part of their names.
        name: u32,
        /// The rows, one after the other.
        table: Table,
        /// The values of a row in a turn.
        row: Vec<Temp>,
        /// More values of a row, each with its column.
        fixed: Vec<(Temp, TableColumn)>,
        /// The results of a turn, operands of the body.
        results: Vec<Operand>,
        /// The number of turns.
        turns: usize,
        /// The results that are read after the region: turn, number of the result, value.
        read: Vec<(usize, usize, Temp)>,
        /// The places of the function's result to which all results of all turns go.
        stored: Option<Stored>,
        /// Whether regions after it read its results where they are.
        is_kept: bool,
    },
}

/// Where a region stores its results: those of a turn side by side.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stored {
    /// The first place.
    pub first: usize,
    /// Whether the results of the last turn are first.
    pub is_backward: bool,
}

/// A column of a table that is not copied into it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TableColumn {
    /// One of [`Region::columns`], by its name.
    Named(Temp),
    /// A result of an earlier region: in turn k that of its turn `first` + k, or `first` − k.
    Results {
        /// The name of that region.
        region: u32,
        /// The number of the result.
        number: usize,
        /// Its turn for turn 0 of this region.
        first: usize,
        /// Whether turns go back.
        is_backward: bool,
    },
    /// Numbers of an argument: in turn k number `first` + k · `stride`, or `first` − k · `stride`.
    Argument {
        /// Which one.
        argument: u32,
        /// The number of turn 0.
        first: usize,
        /// From turn to turn.
        stride: usize,
        /// Whether turns go back.
        is_backward: bool,
    },
}

impl TableColumn {
    /// The place in a turn, of results and of numbers of an argument.
    pub(crate) fn place(self, turn: usize) -> usize {
        let (first, step, is_backward) = match self {
            Self::Named(_) => (0, 1, false),
            Self::Results { first, is_backward, .. } => (first, 1, is_backward),
            Self::Argument { first, stride, is_backward, .. } => (first, stride, is_backward),
        };
        if is_backward { first - turn * step } else { first + turn * step }
    }
}

impl Stored {
    /// The first place of a turn with so many results.
    pub(crate) fn of_turn(self, turn: usize, (turns, results): (usize, usize)) -> usize {
        self.first + results * if self.is_backward { turns - 1 - turn } else { turn }
    }
}

/// Statements that run several times, once, or not at all.
#[derive(Clone, Debug, PartialEq)]
pub struct Region {
    /// How often it runs.
    pub turns: Turns,
    /// The values that it changes.
    pub carried: Vec<Carried>,
    /// The values of before that its body reads, each with its name there.
    pub captured: Vec<(Temp, Operand)>,
    /// Columns of tables of regions in its body, which are the same whenever those run: a name, and
    /// a number for each turn.
    pub columns: Vec<(Temp, Vec<Operand>)>,
    /// The statements of a turn.
    pub body: Vec<Stmt>,
    /// The values that it defines for the statements after it, each with its value then.
    pub after: Vec<(Temp, Temp)>,
}

/// Spill slots of a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Slots {
    /// How many are often used.
    pub near: usize,
    /// How many of these lie side by side, addressable by one byte.
    pub per_shelf: usize,
    /// How many are rarely used.
    pub far: usize,
}

/// An array of the result.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Array {
    /// The place of its first number in the result.
    pub start: usize,
    /// Its lengths; empty for a number.
    pub lengths: Vec<usize>,
}

impl Array {
    /// How many numbers it has.
    #[must_use]
    pub fn numbers(&self) -> usize {
        self.lengths.iter().product()
    }
}

/// The body of a function.
#[derive(Clone, Debug)]
pub struct Body {
    /// The type of its values.
    pub ty: Ty,
    /// Constants and indices with a number for each lane.
    pub lanes: Lanes,
    /// The arrays of the result.
    pub results: Vec<Array>,
    /// Its statements, in one piece or several that follow one another.
    pub pieces: Vec<Vec<Stmt>>,
    /// How many values are kept from one piece to another.
    pub kept: usize,
    /// Its spill slots, if it spills by itself.
    pub slots: Option<Slots>,
    /// Whether neighbouring numbers of the result are hidden as such from the compiler; reason:
    /// `lir/pass/alias_barrier.rs`.
    pub barrier: bool,
    /// Whether not all numbers of the result are stored: the others are zero from the start, or a
    /// loop that follows computes them.
    pub is_partial: bool,
}

/// The lowered bodies of a generated function: targets print these, and print nothing else but a
/// loop over columns.
#[derive(Clone, Debug)]
pub struct Bodies {
    /// The function of one state.
    pub single: Body,
    /// The same with spill slots, for processors with few registers.
    pub few_registers: Option<Body>,
    /// The same with plain numbers, where the values of the first are vectors.
    pub scalar: Option<Body>,
    /// The function of many states.
    pub states: Option<Body>,
    /// The same with spill slots.
    pub states_few_registers: Option<Body>,
    /// Whether a loop over the columns of a system of equations follows the function of one state.
    /// The loop is not part of a body.
    pub is_followed_by_columns: bool,
}

impl Bodies {
    /// All bodies with their names.
    pub fn all(&self) -> impl Iterator<Item = (&'static str, &Body)> {
        let Self { single, few_registers, scalar, states, states_few_registers, .. } = self;
        let rest = [few_registers, scalar, states, states_few_registers].map(Option::as_ref);
        let names = ["few registers", "scalar", "states", "states, few registers"];
        std::iter::once(("single", single)).chain(names.into_iter().zip(rest).filter_map(|(name, body)| Some((name, body?))))
    }
}

impl Body {
    /// All statements, those of regions included.
    pub(crate) fn statements(&self) -> Vec<&Stmt> {
        let mut all = Vec::new();
        self.pieces.iter().flatten().for_each(|statement| statement.walk(&mut |s| all.push(s)));
        all
    }

    /// How many different values are stored in the result: constants and copies of the same value
    /// are not computed.
    pub(crate) fn computed(&self) -> usize {
        let mut values = std::collections::HashSet::new();
        for statement in self.pieces.iter().flatten() {
            if let Stmt::Store(Store::One(_, number)) | Stmt::Result(_, number) = statement {
                values.extend(number.of.temp().map(|temp| (temp.id, number.lane)));
            }
        }
        values.len()
    }
}

impl Stmt {
    /// The values that it defines.
    pub(crate) fn defines(&self, mut see: impl FnMut(Temp)) {
        match self {
            Self::Let(dst, _) | Self::SumLanes(dst, _) | Self::Recall(dst, _) | Self::Load(dst, _) => see(*dst),
            Self::SinCos { angles, .. } => angles.iter().map(|a| a.sin).chain(angles.iter().map(|a| a.cos)).flatten().for_each(see),
            Self::Thirds { dst, .. } => dst.iter().copied().for_each(see),
            Self::Region(region) => region.defines().for_each(see),
            Self::Keep(..) | Self::Spill(..) | Self::Store(_) | Self::Result(..) => {}
        }
    }

    /// Its operands, in order.
    pub(crate) fn operands(&self, mut see: impl FnMut(&Operand)) {
        match self {
            Self::Let(_, Expr::Op(op, operands)) => operands[..op.row().arity].iter().for_each(see),
            Self::Let(_, Expr::Broadcast(number)) | Self::Result(_, number) => see(&number.of),
            Self::SinCos { angles, .. } => angles.iter().for_each(|a| see(&a.angle)),
            Self::SumLanes(_, operands) | Self::Store(Store::Rows(_, operands)) => operands.iter().for_each(see),
            Self::Keep(_, temp) | Self::Spill(_, temp) => see(&Operand::Temp(*temp)),
            Self::Store(Store::One(_, number)) => see(&number.of),
            Self::Store(Store::Two(_, numbers)) => numbers.iter().for_each(|n| see(&n.of)),
            Self::Store(Store::Whole(_, operand)) => see(operand),
            Self::Region(region) => region.given().for_each(see),
            Self::Let(..) | Self::Thirds { .. } | Self::Recall(..) | Self::Load(..) | Self::Store(Store::Fill(..)) => {}
        }
    }

    /// The same with other operands.
    pub(crate) fn map_operands(&mut self, mut change: impl FnMut(&mut Operand)) {
        match self {
            Self::Let(_, Expr::Op(op, operands)) => operands[..op.row().arity].iter_mut().for_each(change),
            Self::Let(_, Expr::Broadcast(number)) | Self::Result(_, number) => change(&mut number.of),
            Self::SinCos { angles, .. } => angles.iter_mut().for_each(|a| change(&mut a.angle)),
            Self::SumLanes(_, operands) | Self::Store(Store::Rows(_, operands)) => operands.iter_mut().for_each(change),
            Self::Store(Store::One(_, number)) => change(&mut number.of),
            Self::Store(Store::Two(_, numbers)) => numbers.iter_mut().for_each(|n| change(&mut n.of)),
            Self::Store(Store::Whole(_, operand)) => change(operand),
            Self::Region(region) => region.given_mut().for_each(change),
            Self::Let(..)
            | Self::Thirds { .. }
            | Self::Keep(..)
            | Self::Recall(..)
            | Self::Spill(..)
            | Self::Load(..)
            | Self::Store(Store::Fill(..)) => {}
        }
    }

    /// Calls `see` for it and for all statements in it.
    pub(crate) fn walk<'a>(&'a self, see: &mut impl FnMut(&'a Self)) {
        see(self);
        if let Self::Region(region) = self {
            region.body.iter().for_each(|statement| statement.walk(see));
        }
    }

    /// Whether it defines a mask.
    pub(crate) fn compares(&self) -> bool {
        matches!(self, Self::Let(_, Expr::Op(Op::Positive, _)))
    }

    /// The places of the result that it writes.
    pub(crate) fn writes(&self) -> Vec<usize> {
        match self {
            Self::Result(at, _) | Self::Store(Store::One(at, _)) => vec![*at],
            Self::Store(Store::Two(at, _)) => vec![*at, at + 1],
            Self::Store(Store::Fill(at, count, _)) => (*at..at + count).collect(),
            Self::Store(Store::Whole(at, _)) => (*at..at + 4).collect(),
            Self::Region(region) => region.stores().collect(),
            Self::Store(Store::Rows(rows, columns)) => rows.starts().iter().flat_map(|at| *at..at + columns.len()).collect(),
            _ => Vec::new(),
        }
    }
}

impl Region {
    /// The operands that are known before it.
    pub(crate) fn given(&self) -> impl Iterator<Item = &Operand> {
        let more: &[Operand] = match &self.turns {
            Turns::Until { .. } => &[],
            Turns::Where(mask) => std::slice::from_ref(mask),
            Turns::Each { table: Table::Values(values), .. } => values,
            Turns::Each { .. } => &[],
        };
        let columns = self.columns.iter().flat_map(|(_, values)| values);
        self.carried.iter().map(|carried| &carried.start).chain(self.captured.iter().map(|(_, of)| of)).chain(columns).chain(more)
    }

    fn given_mut(&mut self) -> impl Iterator<Item = &mut Operand> {
        let more: &mut [Operand] = match &mut self.turns {
            Turns::Until { .. } => &mut [],
            Turns::Where(mask) => std::slice::from_mut(mask),
            Turns::Each { table: Table::Values(values), .. } => values,
            Turns::Each { .. } => &mut [],
        };
        let columns = self.columns.iter_mut().flat_map(|(_, values)| values);
        self.carried
            .iter_mut()
            .map(|carried| &mut carried.start)
            .chain(self.captured.iter_mut().map(|(_, of)| of))
            .chain(columns)
            .chain(more)
    }

    /// The values that statements after it read.
    pub(crate) fn defines(&self) -> impl Iterator<Item = Temp> {
        let read = if let Turns::Each { read, .. } = &self.turns { read.as_slice() } else { &[] };
        self.after.iter().map(|(temp, _)| *temp).chain(read.iter().map(|(.., temp)| *temp))
    }

    /// The places of the function's result that it writes.
    pub(crate) fn stores(&self) -> std::ops::Range<usize> {
        match &self.turns {
            Turns::Each { stored: Some(stored), turns, results, .. } => stored.first..stored.first + turns * results.len(),
            _ => 0..0,
        }
    }

    /// Whether it is read whether the mask of an iteration held.
    pub(crate) fn is_held_read(&self) -> bool {
        matches!(self.turns, Turns::Until { held, .. } if self.after.iter().any(|(_, last)| *last == held))
    }

    /// The operands of the end of a turn.
    pub(crate) fn ends(&self) -> impl Iterator<Item = &Operand> {
        let more: &[Operand] = match &self.turns {
            Turns::Until { .. } | Turns::Where(_) => &[],
            Turns::Each { results, .. } => results,
        };
        self.carried.iter().map(|carried| &carried.next).chain(more)
    }
}

impl Rows {
    /// The place of the first number of each lane.
    pub(crate) fn starts(&self) -> [usize; 4] {
        match self {
            Self::InTurn(at) => std::array::from_fn(|lane| at + 3 * lane),
            Self::Fours(at) | Self::Twos(at) => *at,
        }
    }
}
