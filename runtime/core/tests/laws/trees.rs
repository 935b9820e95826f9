//! How many random trees a law runs on.

use articulated_test_support::case::{self, Case};
use articulated_test_support::random::Random;
use articulated_test_support::random_tree::Flavour;

/// Its value `all` runs every law on all of its trees.
const VARIABLE: &str = "ARTICULATED_TREES";

/// One of this many trees is run unless all are requested.
const SHARE: u64 = 4;

/// Laws with at most this many trees run on all of them.
const FEW: u64 = 4;

/// Of `count` trees, those that are run: a quarter, at least four, or all if [`VARIABLE`] says so.
pub(crate) fn share(count: u64) -> u64 {
    if std::env::var_os(VARIABLE).is_some_and(|value| value == "all") { count } else { count.div_ceil(SHARE).max(count.min(FEW)) }
}

/// Runs a law on its [`share`] of `count` trees, see [`case::for_each_tree`].
pub(crate) fn for_each_tree(count: u64, flavour: Flavour, law: impl Fn(&Case, &mut Random)) {
    case::for_each_tree(share(count), flavour, law);
}
