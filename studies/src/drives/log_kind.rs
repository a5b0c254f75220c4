//! Kinds of logs: at the drive's own sample rate with and without the angle, every few samples, means.

use super::pick;
use fluxfit::optimizer::Draws;
use fluxfit_drive::scenario::{LoggedRows, Logging};

/// Samples per row of a decimated or averaged log.
const EVERY: [u32; 2] = [4, 10];

/// What is logged.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum LogKind {
    /// Every sample with all columns.
    Complete,
    /// Every sample without angle and DC voltage.
    WithoutAngle,
    /// Every few samples.
    Decimated {
        /// Samples per row.
        every: u32,
        /// Whether angle and DC voltage are logged.
        angle: bool,
    },
    /// Means of a few samples.
    Averaged {
        /// Samples per row.
        every: u32,
        /// Whether angle and DC voltage are logged.
        angle: bool,
    },
}

impl LogKind {
    /// What they are called, for all numbers of samples.
    pub const LABELS: [&'static str; 4] = ["full rate", "full rate, no angle", "decimated", "averaged"];

    /// One of four kinds; of the last two, half are without an angle.
    pub(super) fn drawn(draws: &mut Draws) -> Option<Self> {
        let label = *pick(draws, &Self::LABELS)?;
        let every = *pick(draws, &EVERY)?;
        let angle = draws.uniform() < 0.5;
        let kinds = [Self::Complete, Self::WithoutAngle, Self::Decimated { every, angle }, Self::Averaged { every, angle }];
        kinds.into_iter().find(|kind| kind.label() == label)
    }

    /// What it is called.
    pub fn label(self) -> &'static str {
        let [complete, without_angle, decimated, averaged] = Self::LABELS;
        match self {
            Self::Complete => complete,
            Self::WithoutAngle => without_angle,
            Self::Decimated { .. } => decimated,
            Self::Averaged { .. } => averaged,
        }
    }

    /// The settings.
    pub(super) fn logging(self) -> Logging {
        let (every, rows, angle) = match self {
            Self::Complete => (1, LoggedRows::First, true),
            Self::WithoutAngle => (1, LoggedRows::First, false),
            Self::Decimated { every, angle } => (every, LoggedRows::First, angle),
            Self::Averaged { every, angle } => (every, LoggedRows::Mean, angle),
        };
        Logging { every, rows, theta_e: angle, u_dc: angle, ..Logging::COMPLETE }
    }
}
