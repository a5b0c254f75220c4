//! Logs as they are found: the corpus, the dialects of text, and files that once broke a promise.

#![allow(
    clippy::expect_used,
    clippy::panic,
    clippy::print_stderr,
    clippy::unwrap_used,
    reason = "a test may fail, and says why it was skipped"
)]

mod corpus;
mod csv_dialects;
#[path = "../promises/mod.rs"]
mod promises;
mod regressions;
