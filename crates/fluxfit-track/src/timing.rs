//! When the voltages of a row act, of the timings that a stream can have.

use fluxfit::{VoltageFrame, VoltageTiming};
use serde::{Deserialize, Serialize};

/// Longest delay, in rows.
pub(crate) const LONGEST_DELAY: usize = 2;

/// What `ud, uq` of a row mean.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Timing {
    /// The mean of the periods before and after the row, in the frame at the row.
    Centered,
    /// The vector of the period that begins so many rows later.
    Delayed {
        /// Rows, at most two.
        delay: usize,
        /// Whether it is in the frame at the row, in place of the frame at the middle of its period.
        at_row: bool,
    },
}

impl Timing {
    /// The timings among which a stream itself decides: those of drives that compensate their delay.
    pub const USUAL: [Self; 4] = [
        Self::Centered,
        Self::Delayed { delay: 0, at_row: false },
        Self::Delayed { delay: 1, at_row: false },
        Self::Delayed { delay: 2, at_row: false },
    ];

    /// The same as the batch identification has it; none for a timing that a stream does not support.
    pub fn of(timing: VoltageTiming) -> Option<Self> {
        match timing {
            VoltageTiming::Centered => Some(Self::Centered),
            VoltageTiming::Delayed { delay, frame: VoltageFrame::Middle } if delay <= LONGEST_DELAY => {
                Some(Self::Delayed { delay, at_row: false })
            }
            VoltageTiming::Delayed { delay, frame: VoltageFrame::Row } if delay <= LONGEST_DELAY => {
                Some(Self::Delayed { delay, at_row: true })
            }
            VoltageTiming::Delayed { .. }
            | VoltageTiming::Ended
            | VoltageTiming::MidPeriod { .. }
            | VoltageTiming::Averaged { .. }
            | VoltageTiming::Euler { .. } => None,
        }
    }

    /// Name on the command line and in documents.
    pub fn key(self) -> &'static str {
        let frame = |at_row| if at_row { VoltageFrame::Row } else { VoltageFrame::Middle };
        match self {
            Self::Centered => VoltageTiming::Centered.key(),
            Self::Delayed { delay, at_row } => VoltageTiming::Delayed { delay, frame: frame(at_row) }.key(),
        }
    }
}
