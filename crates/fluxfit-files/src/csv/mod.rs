//! Tables of text: the header with what separates its cells, and the records.

mod beside_settings;
pub mod header;
mod levels;
pub mod record;
mod scope;
pub mod tidy;
mod unit_names;
