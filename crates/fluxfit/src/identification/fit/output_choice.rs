//! The choice of the voltage timing and of the drive's faults, on a part of the rows.

use super::{
    super::{
        prepare::stretches,
        progress::{Progress, Step},
        request::Request,
    },
    output_start::{self, free},
    readings::{self, ReadingTrial},
    terms::{self, Candidate, LEAST_RESIDUAL},
};
use crate::{
    error::{Error, ErrorKind},
    levenberg_marquardt::Belief,
    log::Log,
    objective::{
        acting_voltage::VoltageReading,
        adjustable::{Adjustable, Unknown},
        output_error::OutputError,
    },
};
use std::ops::Range;

/// What is to be fitted to all rows.
pub(super) struct Chosen {
    pub(super) reading: VoltageReading,
    pub(super) drive: Adjustable,
    pub(super) unknowns: Vec<Unknown>,
    pub(super) beliefs: Vec<Belief>,
    /// Every reading with these unknowns, the best first.
    pub(super) readings: Vec<ReadingTrial>,
    pub(super) terms: Vec<terms::Tried>,
    /// Independent residuals of the rows by which it was chosen.
    pub(super) independent: f64,
    /// Logarithm of the mean square that is left, and what the unknowns cost: Schwarz's criterion per residual.
    criterion: f64,
    /// Whether what is left is noise, and no observer was needed to make it so.
    explained: bool,
}

/// Readings from which faults are looked for, where the first one leaves something unexplained: a fault may pass for a delay.
const TRIED_READINGS: usize = 2;

/// Correlation of neighbours below which residuals are white enough.
const WHITE: f64 = 0.1;

/// Chooses the reading of the voltages and the faults of the drive.
pub(super) fn choose(
    log: &Log,
    stretches: &[Range<usize>],
    start: &Adjustable,
    request: &Request,
    progress: Progress,
) -> Result<Chosen, Error> {
    let _ = progress(Step::VoltageTiming);
    let free = free(request);
    let objectives = readings::objectives(log, &stretches::spread(stretches), request)?;
    let rough = readings::readings(&objectives, start, &free, &[]);
    let beliefs = output_start::beliefs(request, rough.first().map_or(0.0, |(_, best)| best.mean_square()));
    let mut best: Option<Chosen> = None;
    let tried = readings::readings(&objectives, start, &free, &beliefs);
    let _ = progress(Step::Faults);
    for (place, tried) in tried.into_iter().take(TRIED_READINGS) {
        let (drive, cost, voltage_accuracy) = (tried.polished.drive, tried.polished.cost, request.voltage_accuracy);
        let candidate =
            Candidate { objectives: &objectives, reading: place, beliefs: &beliefs, drive, unknowns: free.clone(), cost, voltage_accuracy };
        let one = with_faults(candidate, &objectives, &beliefs);
        let explained = one.explained;
        if best.as_ref().is_none_or(|best| one.criterion < best.criterion) {
            best = Some(one);
        }
        if explained {
            break;
        }
    }
    let mut best = best.ok_or(ErrorKind::TooShort { rows: log.rows(), least: 2 })?;
    let readings = readings::readings(&objectives, &best.drive, &best.unknowns, &beliefs);
    best.readings = readings.into_iter().map(|(_, tried)| tried).collect();
    Ok(best)
}

/// The faults that a log carries under a reading, and the reading that suits them.
fn with_faults(mut candidate: Candidate, objectives: &[(VoltageReading, OutputError)], beliefs: &[Belief]) -> Chosen {
    let terms = candidate.add_terms();
    let Candidate { drive, unknowns, cost, reading, .. } = candidate;
    let (reading, objective) = &objectives[reading];
    let residuals = objective.residuals(&drive);
    let count = residuals.len() as f64;
    let independent = terms::independent(&residuals);
    Chosen {
        reading: *reading,
        readings: Vec::new(),
        independent,
        criterion: (cost / count).ln() + unknowns.len() as f64 * count.ln() / count,
        explained: (cost / count).sqrt() <= LEAST_RESIDUAL * objective.peak_current()
            || !unknowns.contains(&Unknown::GainD) && independent > (1.0 - WHITE) / (1.0 + WHITE) * count,
        drive,
        unknowns,
        beliefs: beliefs.to_vec(),
        terms,
    }
}
