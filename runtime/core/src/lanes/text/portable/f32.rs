// f32 without vector instructions of its own: what the compiler makes of it.
pub(super) type Real = f32;
type Bits = u32;
