//! Many independent runs of one method on one objective.

use crate::{
    bounds::Bounds,
    error::Error,
    methods::Method,
    objective::Objective,
    optimizer::Optimizer,
    report::{SearchReport, StopReason},
    setting::SearchSettings,
};
#[cfg(feature = "rayon")]
use rayon::prelude::*;
use std::{
    ops::ControlFlow,
    sync::atomic::{AtomicBool, Ordering},
};

/// Runs a method `runs` times and returns what `summarize` makes of each report, in the order of the runs. Run `k` takes stream `k` of
/// the seed's random numbers, whatever `settings.run` says, so any number of threads gives the same bits.
///
/// `go_on` is asked after each iteration, from any thread. After a break only the runs that are finished are returned, each the same as
/// if all were.
///
/// # Errors
/// If `runs` is zero, all runs together need [too many evaluations](SearchSettings::check_runs), or a run cannot start.
pub fn run_many<T: Send>(
    method: Method,
    runs: usize,
    settings: SearchSettings,
    bounds: &Bounds,
    objective: &impl Objective,
    summarize: impl Fn(SearchReport) -> T + Sync,
    go_on: impl Fn() -> ControlFlow<()> + Sync,
) -> Result<Vec<T>, Error> {
    if runs == 0 {
        return Err(Error::Setting { setting: "the number of runs", value: 0.0, range: "at least 1" });
    }
    settings.check_runs(runs)?;
    let interrupted = AtomicBool::new(false);
    let run = |run: usize| {
        // A run that has not begun would evaluate its first population before `go_on` is asked.
        if interrupted.load(Ordering::Relaxed) {
            return Ok(None);
        }
        let settings = SearchSettings { run: run as u64, ..settings };
        let report = Optimizer::start(method, settings, bounds.clone(), objective)?.run_while(objective, || {
            let next = go_on();
            interrupted.fetch_or(next.is_break(), Ordering::Relaxed);
            next
        });
        Ok((report.stop_reason != StopReason::Interrupted).then(|| summarize(report)))
    };
    #[cfg(feature = "rayon")]
    let summaries = (0..runs).into_par_iter().map(run).collect::<Result<Vec<_>, Error>>()?;
    #[cfg(not(feature = "rayon"))]
    let summaries = (0..runs).map(run).collect::<Result<Vec<_>, Error>>()?;
    Ok(summaries.into_iter().flatten().collect())
}
