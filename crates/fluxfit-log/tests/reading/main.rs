//! Reading of whole logs: the corpus, the dialects of text, errors, optional columns, and files that once made a reader fail.

#![allow(
    clippy::expect_used,
    clippy::panic,
    clippy::print_stderr,
    clippy::unwrap_used,
    reason = "a test may fail, and says why it was skipped"
)]

mod angles;
mod characteristics;
mod corpus;
mod dialects;
mod errors;
mod exports;
mod fixtures;
mod layouts;
mod optional_columns;
#[path = "../promises/mod.rs"]
mod promises;
mod real_logs;
mod regressions;
mod threads;
