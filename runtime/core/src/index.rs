//! Index types, and arrays that accept only their own index type.
//!
//! A link of a description is not a body of a model, and neither is a frame: with an index type for
//! each, a program that takes one for the other does not compile. At run time an index is a
//! `usize`.
//!
//! ```
//! use articulated_core::model::{Frame, Model};
//!
//! fn mass_of_body(model: &Model<f64>, frame: &Frame<f64>) -> f64 {
//!     model.bodies()[frame.body].inertia.mass
//! }
//! ```
//!
//! ```compile_fail,E0308
//! use articulated_core::model::{Frame, Model};
//!
//! fn placement_of_link(model: &Model<f64>, frame: &Frame<f64>) -> [f64; 12] {
//!     model.frames()[frame.body].placement.to_array() // the index of a body
//! }
//! ```
//!
//! Coordinates and degrees of freedom are places in the slices q and v that a caller gives, and
//! stay `usize`.

use alloc::vec::Vec;
use core::marker::PhantomData;
use core::ops::{Deref, DerefMut, Index, IndexMut};

/// An index of one kind of thing.
pub trait Id: Copy {
    /// The index of the thing at this place.
    fn of(place: usize) -> Self;
    /// The place of the thing among those of its kind, from 0.
    fn place(self) -> usize;
}

/// Index types: for each a wrapper of `usize` with its documentation.
macro_rules! ids {
    ($($(#[$attribute:meta])+ $name:ident;)+) => {$(
        $(#[$attribute])+
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[repr(transparent)]
        pub struct $name(pub usize);

        impl Id for $name {
            #[inline(always)]
            fn of(place: usize) -> Self { Self(place) }
            #[inline(always)]
            fn place(self) -> usize { self.0 }
        }

        impl core::fmt::Display for $name {
            fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result { self.0.fmt(f) }
        }
    )+};
}

ids! {
    /// A link among those of a [`Description`](crate::description::Description), in the order of
    /// the file.
    LinkId;
    /// A joint among those of a [`Description`](crate::description::Description), in the order of
    /// the file, fixed joints too.
    JointId;
    /// A body of a [`Model`](crate::model::Model). The base is [`BodyId::BASE`].
    BodyId;
    /// A frame of a [`Model`](crate::model::Model).
    FrameId;
}

impl BodyId {
    /// The base, the first body, which hangs on nothing.
    pub const BASE: Self = Self(0);

    /// Whether it is the base.
    #[inline(always)]
    pub fn is_base(self) -> bool {
        self.0 == 0
    }
}

/// A list that accepts only indices of the kind `I`. Its slice has no ids: it is for methods that
/// do not depend on them, such as `iter` and `len`.
#[derive(Clone, Debug, PartialEq)]
pub struct ById<I, T> {
    all: Vec<T>,
    kind: PhantomData<I>,
}

impl<I: Id, T> ById<I, T> {
    /// Adds a thing at the end and returns its index.
    pub fn push(&mut self, thing: T) -> I {
        self.all.push(thing);
        I::of(self.all.len() - 1)
    }

    /// The thing with this index, if there is one.
    #[inline(always)]
    pub fn get(&self, id: I) -> Option<&T> {
        self.all.get(id.place())
    }

    /// The thing with this index, to be changed, if there is one.
    #[inline(always)]
    pub fn get_mut(&mut self, id: I) -> Option<&mut T> {
        self.all.get_mut(id.place())
    }

    /// All indices in order.
    pub fn ids(&self) -> impl ExactSizeIterator<Item = I> + DoubleEndedIterator + use<I, T> {
        (0..self.all.len()).map(I::of)
    }

    /// All things in order, each with its index.
    pub fn with_ids(&self) -> impl ExactSizeIterator<Item = (I, &T)> + DoubleEndedIterator + Clone {
        self.all.iter().enumerate().map(|(place, thing)| (I::of(place), thing))
    }

    /// All things in order, each with its index, to be changed.
    pub fn with_ids_mut(&mut self) -> impl ExactSizeIterator<Item = (I, &mut T)> + DoubleEndedIterator {
        self.all.iter_mut().enumerate().map(|(place, thing)| (I::of(place), thing))
    }

    /// The index of the first thing for which `is` holds.
    pub fn position(&self, is: impl FnMut(&T) -> bool) -> Option<I> {
        self.all.iter().position(is).map(I::of)
    }

    /// The index that the next thing gets.
    pub fn next_id(&self) -> I {
        I::of(self.all.len())
    }

    /// Takes a thing out. Those after it get other indices.
    ///
    /// # Panics
    /// If there is no such thing.
    pub fn remove(&mut self, id: I) -> T {
        self.all.remove(id.place())
    }

    /// Takes the last thing out.
    pub fn pop(&mut self) -> Option<T> {
        self.all.pop()
    }

    /// The things without their ids.
    pub fn into_vec(self) -> Vec<T> {
        self.all
    }
}

impl<I, T> Default for ById<I, T> {
    fn default() -> Self {
        Vec::new().into()
    }
}

impl<I, T> From<Vec<T>> for ById<I, T> {
    fn from(all: Vec<T>) -> Self {
        Self { all, kind: PhantomData }
    }
}

impl<I, T, const N: usize> From<[T; N]> for ById<I, T> {
    fn from(all: [T; N]) -> Self {
        Vec::from(all).into()
    }
}

impl<I, T> FromIterator<T> for ById<I, T> {
    fn from_iter<A: IntoIterator<Item = T>>(all: A) -> Self {
        all.into_iter().collect::<Vec<T>>().into()
    }
}

impl<I, T> Extend<T> for ById<I, T> {
    fn extend<A: IntoIterator<Item = T>>(&mut self, more: A) {
        self.all.extend(more);
    }
}

impl<I: Id, T> Index<I> for ById<I, T> {
    type Output = T;

    #[inline(always)]
    fn index(&self, id: I) -> &T {
        &self.all[id.place()]
    }
}

impl<I: Id, T> IndexMut<I> for ById<I, T> {
    #[inline(always)]
    fn index_mut(&mut self, id: I) -> &mut T {
        &mut self.all[id.place()]
    }
}

impl<I, T> Deref for ById<I, T> {
    type Target = [T];

    #[inline(always)]
    fn deref(&self) -> &[T] {
        &self.all
    }
}

impl<I, T> DerefMut for ById<I, T> {
    #[inline(always)]
    fn deref_mut(&mut self) -> &mut [T] {
        &mut self.all
    }
}

impl<'a, I, T> IntoIterator for &'a ById<I, T> {
    type Item = &'a T;
    type IntoIter = core::slice::Iter<'a, T>;

    fn into_iter(self) -> Self::IntoIter {
        self.all.iter()
    }
}

impl<'a, I, T> IntoIterator for &'a mut ById<I, T> {
    type Item = &'a mut T;
    type IntoIter = core::slice::IterMut<'a, T>;

    fn into_iter(self) -> Self::IntoIter {
        self.all.iter_mut()
    }
}

impl<I, T> IntoIterator for ById<I, T> {
    type Item = T;
    type IntoIter = alloc::vec::IntoIter<T>;

    fn into_iter(self) -> Self::IntoIter {
        self.all.into_iter()
    }
}
