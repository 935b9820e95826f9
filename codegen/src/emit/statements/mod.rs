//! A graph as statements: in plain arithmetic, on sums of two doubles, in lanes.

pub(crate) mod dialect;
pub(crate) mod flat;
pub(crate) mod literal;
pub(crate) mod order;
pub(crate) mod pairs;
pub(crate) mod plain;
pub(crate) mod several;
pub(crate) mod vector;
