//! The border to crates that panic on damaged files.
//!
//! 200 000 mutated files made parquet 59 panic at five places (an index out of bounds in its byte stream split decoder, a missing
//! dictionary, an overflow in its delta decoder and its bit reader). A damaged file must give a sentence, so a panic below this border
//! becomes an error, without a message on the terminal. What panicked is dropped and never used again. It needs the default
//! `panic = "unwind"`.

use super::damaged;
use fluxfit_files::FileError;
use std::{
    cell::Cell,
    panic::{self, AssertUnwindSafe},
    sync::Once,
};

thread_local! {
    /// This thread is below the border.
    static INSIDE: Cell<bool> = const { Cell::new(false) };
}

/// Calls `foreign`, which calls nothing of this project that could panic itself.
pub(super) fn guarded<T>(format: &'static str, foreign: impl FnOnce() -> Result<T, FileError>) -> Result<T, FileError> {
    static QUIET: Once = Once::new();
    // The hook is the whole process's: it stays as it is for all that is not below the border.
    QUIET.call_once(|| {
        let before = panic::take_hook();
        panic::set_hook(Box::new(move |panic| {
            if !INSIDE.get() {
                before(panic);
            }
        }));
    });
    INSIDE.set(true);
    let result = panic::catch_unwind(AssertUnwindSafe(foreign));
    INSIDE.set(false);
    result.unwrap_or_else(|_| Err(damaged(format, "its data are damaged")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_becomes_a_sentence() {
        let result: Result<(), FileError> = guarded("Parquet", || panic!("out of bounds"));
        let sentence = "this Parquet file cannot be read: its data are damaged; export it again";
        assert_eq!(result.unwrap_err().to_string(), sentence);
        assert_eq!(guarded("Parquet", || Ok(7)), Ok(7));
    }
}
