//! What compilers do badly with long functions, done here: pieces, what waits in memory, stores side by side.

pub(crate) mod apart;
pub(crate) mod chunks;
pub(crate) mod registers;
pub(crate) mod spill;
pub(crate) mod together;
