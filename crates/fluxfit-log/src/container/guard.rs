//! Calls into crates that panic on damaged files.
//!
//! 200 000 mutated files made parquet 59 panic at five places (an index out of bounds in its byte stream split decoder, a missing
//! dictionary, an overflow in its delta decoder and its bit reader). A damaged file must give an error, so a panic in these crates is
//! caught here and becomes one, without a message on the terminal. The object that panicked is dropped and not used again. This needs
//! the default `panic = "unwind"`.

use super::fault::damaged;
use fluxfit_files::FileError;
use std::{
    cell::Cell,
    panic::{self, AssertUnwindSafe},
    sync::Once,
};

thread_local! {
    /// This thread is inside a guarded call.
    static INSIDE: Cell<bool> = const { Cell::new(false) };
}

/// Calls `foreign`, and turns a panic in it into an error: for the containers, and for readers of such files that are no logs.
/// `foreign` must not call code of this project that could panic.
///
/// # Errors
/// That of `foreign`, or that the file is damaged.
pub fn guarded<T>(format: &'static str, foreign: impl FnOnce() -> Result<T, FileError>) -> Result<T, FileError> {
    static QUIET: Once = Once::new();
    // The panic hook belongs to the whole process: outside of guarded calls it works as before.
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
    fn a_panic_becomes_an_error() {
        let result: Result<(), FileError> = guarded("Parquet", || panic!("out of bounds"));
        let sentence = "this Parquet file cannot be read: its data are damaged; export it again";
        assert_eq!(result.unwrap_err().to_string(), sentence);
        assert_eq!(guarded("Parquet", || Ok(7)), Ok(7));
    }
}
