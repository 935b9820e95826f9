//! The command `articulated`.
fn main() {}
