//! Files in and out, for every reader and writer of fluxfit.
//!
//! Whatever is read is either understood or refused in one sentence on one line that names the file, the line and the column where
//! there is one, and the remedy. Whatever is written is written whole or not at all.
//!
//! | file | concept |
//! |---|---|
//! | [`error`] | where something is wrong, and the sentence |
//! | [`problem`] | sentences that several readers share |
//! | [`input`] | bytes and text of a file or of standard input |
//! | [`toml_table`] | TOML whose keys are all known |
//! | [`csv`] | tables of text: header and records |
//! | [`output`] | writing whole files only |

pub mod csv;
pub mod error;
pub mod input;
pub mod output;
pub mod problem;
pub mod toml_table;

pub use error::FileError;
pub use output::{Output, check_writable, discard_unfinished, is_replaceable, write_atomically};
pub use problem::Problem;
