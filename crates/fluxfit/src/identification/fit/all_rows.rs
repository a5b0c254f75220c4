//! The fit of all rows, with the reading of the voltages and the faults that were chosen on a part of them.
//!
//! A fault whose values come out of all rows as no drive has them took the place of something else, or has nothing left to explain beside
//! a fault that was taken after it. It is left out where the fit is as good without it, by the criterion that it was taken by; where it is
//! not, the fit is not to be trusted.

use super::{
    super::request::Request,
    fault_search::{schwarz, unphysical},
    fault_trial::FaultOutcome,
    long_run,
    output_choice::{Chosen, is_a_motor},
    readings::{self, VERY_STRONG},
};
use crate::{
    error::{Error, ErrorKind},
    faults::Fault,
    levenberg_marquardt::{Polished, polish_to_choose, polish_with_progress},
    log::Log,
    objective::{
        adjustable::{Adjustable, Unknown},
        output_error::OutputError,
    },
};
use std::ops::Range;

/// What was chosen, fitted to all rows.
pub(super) struct AllRows {
    pub(super) chosen: Chosen,
    pub(super) objective: OutputError,
    pub(super) drive: Adjustable,
    pub(super) cost: f64,
    pub(super) residuals: Vec<f64>,
    /// A fault whose values no drive has, and without which the fit is worse.
    pub(super) runaway: Option<Fault>,
}

impl AllRows {
    /// Of a log whose speed was advanced by a lag, s, or by zero. `to_compare` ends where only a comparison with other fits is asked for.
    ///
    /// # Errors
    /// If no stretch is long enough, or nothing finite fits.
    pub(super) fn of(
        (log, lag): (&Log, f64),
        stretches: &[Range<usize>],
        chosen: Chosen,
        request: &Request,
        (to_compare, fitting): (bool, &dyn Fn(usize)),
    ) -> Result<Self, Error> {
        let polished = |chosen| Self::polished(log, stretches, chosen, (to_compare, fitting));
        let mut fit = polished(chosen)?;
        if !fit.cost.is_finite() {
            return Err(ErrorKind::NoFiniteFit.into());
        }
        while let Some(fault) = fit.unphysical(lag) {
            let chosen = fit.chosen.without(fault, &fit.drive).again(log, stretches, &readings::asked(log, request))?;
            let without = polished(chosen)?;
            let further = fit.chosen.unknowns.len() - without.chosen.unknowns.len();
            if schwarz(without.cost, fit.cost, further, long_run::effective_sample_size(&fit.residuals)) > VERY_STRONG {
                fit.runaway = Some(fault);
                break;
            }
            fit = without;
        }
        Ok(fit)
    }

    fn polished(
        log: &Log,
        stretches: &[Range<usize>],
        chosen: Chosen,
        (to_compare, fitting): (bool, &dyn Fn(usize)),
    ) -> Result<Self, Error> {
        let mut objective = OutputError::of_rows(log, stretches, chosen.reading)?;
        let (unknowns, priors) = (&chosen.unknowns, &chosen.priors);
        let polish = |objective: &OutputError, start: &Adjustable| {
            if to_compare {
                polish_to_choose(objective, start, unknowns, priors)
            } else {
                polish_with_progress(objective, start, unknowns, priors, fitting)
            }
        };
        let mut polished = polish(&objective, &chosen.drive);
        if chosen.reading.has_halves() && is_a_motor(&polished.drive.motor) {
            objective = objective.with_halves_weighed(&polished.drive.motor);
            polished = polish(&objective, &polished.drive);
        }
        let Polished { drive, cost, .. } = polished;
        let residuals = objective.residuals(&drive);
        Ok(Self { chosen, objective, drive, cost, residuals, runaway: None })
    }

    /// The first fault whose values no drive has. Of a lag of the speed only the rest is left to find, after it was undone.
    fn unphysical(&self, lag: f64) -> Option<Fault> {
        let mut drive = self.drive;
        drive.faults.speed_lag.time += lag;
        unphysical(&self.chosen.terms, &drive, self.objective.peak_current())
    }
}

impl Chosen {
    /// The same without a fault, from what was found beside it.
    fn without(&self, fault: Fault, drive: &Adjustable) -> Self {
        let mut terms = self.terms.clone();
        terms.iter_mut().filter(|trial| trial.fault == fault).for_each(|trial| trial.outcome = FaultOutcome::NotPhysical);
        terms.sort_by_key(|trial| trial.outcome != FaultOutcome::Taken);
        Self {
            drive: Unknown::of_fault(fault).fold(*drive, |drive, unknown| drive.with(unknown, 0.0)),
            unknowns: self.unknowns.iter().copied().filter(|unknown| unknown.fault() != Some(fault)).collect(),
            terms,
            priors: self.priors.iter().copied().filter(|prior| prior.unknown.fault() != Some(fault)).collect(),
            readings: self.readings.clone(),
            ..*self
        }
    }
}
