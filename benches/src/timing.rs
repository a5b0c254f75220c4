//! The stopwatch.

use cpu_time::ProcessTime;
use std::{hint::black_box, time::Instant};

/// Calls before the first that counts: caches, clock frequency and the allocator settle.
const WARM_UP: usize = 10;

/// Median wall time of `repeats` calls, s. What a call returns is dropped on its own time.
pub(crate) fn median_seconds<T>(repeats: usize, call: impl FnMut(usize) -> T) -> f64 {
    median_of(repeats, call, Instant::now, |start| start.elapsed().as_secs_f64())
}

/// The same in CPU time, so that other work on the machine does not count; for calls that take much longer than the clock is read.
pub(crate) fn median_cpu_seconds<T>(repeats: usize, call: impl FnMut(usize) -> T) -> f64 {
    median_of(repeats, call, ProcessTime::now, |start| start.elapsed().as_secs_f64())
}

fn median_of<T, C>(repeats: usize, mut call: impl FnMut(usize) -> T, clock: fn() -> C, elapsed: fn(&C) -> f64) -> f64 {
    (0..WARM_UP).for_each(|_| drop(black_box(call(0))));
    let mut seconds: Vec<f64> = (0..repeats)
        .map(|repeat| {
            let start = clock();
            drop(black_box(call(repeat)));
            elapsed(&start)
        })
        .collect();
    median(&mut seconds)
}

/// The middle value; of an even number of them, the upper of both.
pub(crate) fn median(values: &mut [f64]) -> f64 {
    values.sort_unstable_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}
