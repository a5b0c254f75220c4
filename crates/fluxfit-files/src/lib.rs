//! Files in and out, for every reader and writer of fluxfit.
//!
//! Content is either understood or refused in one sentence on one line that names the file, the line and the column where there is
//! one, and what to do. Files are written atomically: a reader never sees half of one.
//!
//! | file | concept |
//! |---|---|
//! | [`error`] | an error with its place, kind and advice |
//! | [`advice`] | what the user can state to resolve an error |
//! | [`problem`] | problems that several readers share |
//! | [`input`] | bytes and text of a file or of standard input |
//! | [`toml_table`] | TOML files whose keys are all known |
//! | [`csv`] | tables of text: header and records |
//! | `json` | what is wrong with a text that should be JSON |
//! | [`output`] | atomic writing |

pub mod advice;
pub mod csv;
pub mod error;
pub mod input;
mod json;
pub mod output;
pub mod problem;
pub mod toml_table;

pub use advice::Advice;
pub use error::{FileError, FileErrorKind};
pub use json::json_fault;
pub use output::{Output, check_writable, discard_unfinished, is_replaceable, write_atomically};
pub use problem::Problem;
