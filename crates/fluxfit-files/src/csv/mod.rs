//! A table of text: where its header is, what separates its cells, and its records.

pub mod header;
pub mod record;
