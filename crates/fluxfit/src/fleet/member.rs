//! A motor of a fleet with all its rows: the row that tells most, how many windows fail, and its rank among the worst.

use super::row::FleetRow;
use crate::Verdict;
use std::cmp::Ordering;

/// How well a motor is known, the worst first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Standing {
    /// There is no answer.
    NoAnswer,
    /// Some parameter has no value.
    Refused,
    /// All parameters have a value, some a weak one.
    Weak,
    /// All parameters are identified.
    Identified,
}

impl Standing {
    /// All of them, the worst first.
    pub const ALL: [Self; 4] = [Self::NoAnswer, Self::Refused, Self::Weak, Self::Identified];
}

/// A motor of a fleet.
#[derive(Debug, Clone, PartialEq)]
pub struct Member {
    /// The row that tells most; of equal ones the first.
    pub best: FleetRow,
    /// How well the motor is known from that row.
    pub standing: Standing,
    /// Its rows: the windows, or one.
    pub rows: usize,
    /// Rows without an answer.
    pub failed: usize,
}

impl Member {
    /// A motor from its rows; `None` without any.
    pub(super) fn of(rows: &[FleetRow]) -> Option<Self> {
        let mut best = rows.first()?;
        for row in rows {
            if Rank::of(row).worst_first(&Rank::of(best)) == Ordering::Greater {
                best = row;
            }
        }
        let failed = rows.iter().filter(|row| row.error.is_some()).count();
        Some(Self { best: best.clone(), standing: Rank::of(best).standing, rows: rows.len(), failed })
    }

    /// The order in which the worst stand first; equally bad ones by name.
    pub(super) fn worst_first(&self, other: &Self) -> Ordering {
        let (own, others) = (Rank::of(&self.best), Rank::of(&other.best));
        (own.by_verdicts(&others))
            .then(other.failed.cmp(&self.failed))
            .then_with(|| own.worst_first(&others))
            .then_with(|| self.best.motor.cmp(&other.best.motor))
    }
}

/// What ranks a row.
struct Rank {
    standing: Standing,
    refused: usize,
    weak: usize,
    /// The widest interval relative to its value.
    widest: f64,
}

impl Rank {
    fn of(row: &FleetRow) -> Self {
        let count = |verdict: Verdict| row.estimates.iter().filter(|estimate| estimate.verdict == verdict).count();
        let (refused, weak) = (count(Verdict::NotIdentifiable), count(Verdict::Weak));
        let standing = match (&row.error, refused, weak) {
            (Some(_), ..) => Standing::NoAnswer,
            (None, 1.., _) => Standing::Refused,
            (None, 0, 1..) => Standing::Weak,
            (None, 0, 0) => Standing::Identified,
        };
        let widths = row.estimates.iter().filter_map(|estimate| Some(estimate.found()?.relative_half_width()));
        Self { standing, refused, weak, widest: widths.fold(0.0, f64::max) }
    }

    fn by_verdicts(&self, other: &Self) -> Ordering {
        (self.standing.cmp(&other.standing)).then(other.refused.cmp(&self.refused)).then(other.weak.cmp(&self.weak))
    }

    fn worst_first(&self, other: &Self) -> Ordering {
        self.by_verdicts(other).then(other.widest.total_cmp(&self.widest))
    }
}
