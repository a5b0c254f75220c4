//! Independent pieces of work on all cores, where the feature `rayon` is on. Each result depends on its own item alone, and results are
//! in the order of the items, so the bits are the same with and without it, on any number of threads.

#[cfg(feature = "rayon")]
use rayon::prelude::*;

/// The results of all items.
pub(crate) fn map<T: Sync, R: Send>(items: &[T], work: impl Fn(&T) -> R + Sync + Send) -> Vec<R> {
    #[cfg(feature = "rayon")]
    let results = items.par_iter().map(work).collect();
    #[cfg(not(feature = "rayon"))]
    let results = items.iter().map(work).collect();
    results
}
