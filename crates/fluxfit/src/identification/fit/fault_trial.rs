//! A fault that was tried, and what came of it.

use crate::{faults::Fault, motor::PARAMETERS};

/// A fault that was tried.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct FaultTrial {
    /// The fault.
    pub fault: Fault,
    /// Schwarz's criterion: what it gains, less what its unknowns cost; positive is evidence for it. The fit's own where it was fitted,
    /// else as the score test expects it.
    pub gain: f64,
    /// Taken or not, and why.
    pub outcome: FaultOutcome,
    /// How far each parameter would move with it, SI: as fitted where it was, else as the score test expects; zeros where it was not
    /// judged.
    pub moves: [f64; PARAMETERS],
}

impl FaultTrial {
    pub(super) fn not_judged(fault: Fault, outcome: FaultOutcome) -> Self {
        Self { fault, gain: 0.0, outcome, moves: [0.0; PARAMETERS] }
    }
}

/// Whether a fault was taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum FaultOutcome {
    /// It is part of the answer.
    Taken,
    /// It does not explain enough of the residual.
    NotNeeded,
    /// What fits has no physical meaning.
    NotPhysical,
    /// It stands in for what voltages do within rows that are not the drive's own periods.
    WithinRows,
    /// It explains something, but nothing that matters to a parameter.
    NoMatter,
    /// Another fault explains the same.
    Covered,
    /// It needs the electrical angle, which the log does not have.
    NeedsAngle,
    /// It needs a rotor that turns.
    NeedsTurning,
    /// It needs rows between which the rotor turns less.
    NeedsCloserRows,
    /// It needs more operating points, or rows that are the drive's own periods: only what goes on between the rows speaks for it.
    NeedsMorePoints,
}

impl FaultOutcome {
    /// In prose.
    pub fn label(self) -> &'static str {
        match self {
            Self::Taken => "taken",
            Self::NotNeeded => "explains too little of the residual",
            Self::NotPhysical => "what fits has no physical meaning",
            Self::WithinRows => "is faster than the rows, within which nothing is logged, and explains little",
            Self::NoMatter => "moves no parameter by more than its standard error",
            Self::Covered => "another term explains the same",
            Self::NeedsAngle => "needs the electrical angle, theta_e",
            Self::NeedsTurning => "needs a rotor that turns",
            Self::NeedsCloserRows => "needs rows between which the rotor turns less",
            Self::NeedsMorePoints => "needs more operating points: only what goes on between the rows speaks for it",
        }
    }
}
