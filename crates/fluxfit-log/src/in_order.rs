//! Work on a sequence of unknown length, on all cores: items are produced and results consumed in order on the calling thread, while
//! the threads of the pool work on the items between. At most two batches are in memory, however long the sequence.

use fluxfit_files::FileError;

/// Items of a batch for each thread: so many that a thread that is done early finds another one.
const ITEMS_PER_THREAD: usize = 8;

/// Maximum number of items of a batch, which bounds the memory on a machine with many cores.
const MOST_ITEMS: usize = 128;

/// Applies `work` to every item of `next`, and passes the results to `take` in the order of the items, so the outcome is the same on
/// any number of threads. An error of `next` is returned after the results of the items before it.
///
/// # Errors
/// The first error of `take`, else that of `next`.
pub(crate) fn in_order<T: Send, R: Send>(
    mut next: impl FnMut() -> Result<Option<T>, FileError>,
    work: impl Fn(T) -> R + Sync,
    mut take: impl FnMut(R) -> Result<(), FileError>,
) -> Result<(), FileError> {
    let threads = rayon::current_num_threads();
    let most = (threads * ITEMS_PER_THREAD).min(MOST_ITEMS);
    let mut end = None;
    let mut batch = batch(&mut next, most, &mut end);
    let mut results = Vec::new();
    while !batch.is_empty() || !results.is_empty() {
        if threads == 1 || batch.len() + results.len() == 1 {
            results.drain(..).try_for_each(&mut take)?;
            batch.drain(..).try_for_each(|item| take(work(item)))?;
            batch = self::batch(&mut next, 1, &mut end);
            continue;
        }
        let mut slots: Vec<Option<R>> = batch.iter().map(|_| None).collect();
        let (work, before) = (&work, std::mem::take(&mut results));
        let (items, taken) = (std::mem::take(&mut batch), &mut batch);
        rayon::in_place_scope(|scope| {
            for (item, slot) in items.into_iter().zip(&mut slots) {
                scope.spawn(move |_| *slot = Some(work(item)));
            }
            before.into_iter().try_for_each(&mut take)?;
            *taken = self::batch(&mut next, most, &mut end);
            Ok::<(), FileError>(())
        })?;
        results.extend(slots.into_iter().flatten());
    }
    end.unwrap_or(Ok(()))
}

/// The next items, at most `most`. `end` is set at the end of the sequence.
fn batch<T>(next: &mut impl FnMut() -> Result<Option<T>, FileError>, most: usize, end: &mut Option<Result<(), FileError>>) -> Vec<T> {
    let mut items = Vec::new();
    while items.len() < most && end.is_none() {
        match next() {
            Ok(Some(item)) => items.push(item),
            Ok(None) => *end = Some(Ok(())),
            Err(error) => *end = Some(Err(error)),
        }
    }
    items
}

#[cfg(test)]
mod tests {
    use super::*;
    use fluxfit_files::FileErrorKind;

    fn on(threads: usize, work: impl FnOnce() + Send) {
        rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(work);
    }

    #[test]
    fn results_come_in_the_order_of_the_items_on_any_number_of_threads() {
        for threads in [1, 2, 5] {
            for count in [0, 1, 2, 100] {
                on(threads, || {
                    let (mut at, mut squares) = (0u64, Vec::new());
                    let next = || {
                        at += 1;
                        Ok((at <= count).then_some(at))
                    };
                    let take = |square| {
                        squares.push(square);
                        Ok(())
                    };
                    assert_eq!(in_order(next, |k| k * k, take), Ok(()));
                    assert_eq!(squares, (1..=count).map(|k| k * k).collect::<Vec<_>>());
                });
            }
        }
    }

    #[test]
    fn an_error_comes_after_the_results_before_it() {
        let error = |text: &str| FileError::new(FileErrorKind::Value, text);
        for threads in [1, 3] {
            on(threads, || {
                let (mut at, mut taken) = (0, Vec::new());
                let next = || {
                    at += 1;
                    if at == 50 { Err(error("source")) } else { Ok(Some(at)) }
                };
                let take = |k: i32| {
                    taken.push(k);
                    Ok(())
                };
                assert_eq!(in_order(next, |k| k, take), Err(error("source")));
                assert_eq!(taken, (1..50).collect::<Vec<_>>());
                // An error of an earlier result comes first.
                let mut at = 0;
                let next = || {
                    at += 1;
                    if at == 50 { Err(error("source")) } else { Ok(Some(at)) }
                };
                assert_eq!(in_order(next, |k| k, |k| if k == 49 { Err(error("row")) } else { Ok(()) }), Err(error("row")));
            });
        }
    }
}
