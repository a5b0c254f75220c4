//! What the numbers of a fault mean, where their names do not say it.

use crate::faults::Fault;

impl Fault {
    /// What its numbers mean, as half a sentence; `None` where their names say it.
    pub fn meaning(self) -> Option<&'static str> {
        (self == Self::Disturbance).then_some(
            "the observer gain is no fault of the drive, but the share of the measured difference by which each prediction is corrected, row by row; 0 would be no \
             correction",
        )
    }
}
