//! `articulated simulate`.
#![allow(dead_code)]

mod columns;
mod csv;
mod page;
mod parquet;
pub(crate) mod plot;
pub(crate) mod recording;
