// f64 without vector instructions of its own: what the compiler makes of it.
pub(super) type Real = f64;
type Bits = u64;
