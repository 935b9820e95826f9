//! `articulated simulate`.
#![allow(dead_code)]

mod columns;
mod csv;
mod page;
mod parquet;
mod plot;
pub(crate) mod recording;
