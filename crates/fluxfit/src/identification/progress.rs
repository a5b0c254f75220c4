//! Progress of an identification: what it is doing, and whether to go on.

use std::ops::ControlFlow;

/// What an identification is about to do.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Step {
    /// Find the operating points and solve their equations.
    OperatingPoints,
    /// Choose the timing of the voltage columns.
    VoltageTiming,
    /// Look for faults of the drive.
    Faults,
    /// Fit all rows.
    Fit {
        /// Simulations of all rows so far.
        simulations: usize,
        /// As many as it usually takes.
        usual: usize,
    },
    /// Compute the uncertainty of the answer.
    Uncertainty,
    /// Run the swarm's search.
    Search {
        /// Iterations done.
        iteration: usize,
        /// Their limit.
        limit: usize,
    },
    /// Compare the answer with the nameplate.
    Nameplate,
    /// Predict the part of the log that was held out.
    Validation,
}

/// A callback that is told each step as it begins, for [`identify_with_progress`](crate::identify_with_progress).
///
/// If it answers [`ControlFlow::Break`], a running search of a swarm ends after its current iteration; the fits are short and always run
/// to their end.
pub type Progress<'a> = &'a dyn Fn(Step) -> ControlFlow<()>;

/// A callback that ignores every step.
pub(crate) fn silent(_: Step) -> ControlFlow<()> {
    ControlFlow::Continue(())
}
