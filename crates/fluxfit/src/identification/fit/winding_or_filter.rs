//! While the rotor stands, the winding and a filter of its current are two lags one after the other, and next to nothing tells their
//! order: a motor of the time constant of the filter behind a filter of the time constant of the motor fits nearly as well. Only two
//! different inductances tell them apart, of which no filter has the time constants. So where a filter was found, the one in the place of
//! the other is tried, and counts as doubt.

use super::{
    fault_search::FaultSearch,
    fault_trial::{FaultOutcome, FaultTrial},
    long_run::effective_sample_size,
    readings::VERY_STRONG,
};
use crate::{
    faults::Fault,
    levenberg_marquardt::{Polished, polish_to_choose},
    motor::{Motor, Parameter},
    objective::adjustable::Unknown,
};

/// The filters, which are the same while the rotor stands.
const FILTERS: [Fault; 2] = [Fault::DqCurrentFilter, Fault::CurrentFilter];

impl FaultSearch<'_> {
    /// Tries them exchanged. What fits better stays; of two that fit about alike the one with the faster filter. Returns what the other
    /// would do, as that of the other filter.
    pub(super) fn exchange_winding(&mut self, taken: &[FaultTrial]) -> Vec<FaultTrial> {
        self.exchanged(taken).into_iter().collect()
    }

    fn exchanged(&mut self, taken: &[FaultTrial]) -> Option<FaultTrial> {
        let filter = FILTERS.into_iter().find(|filter| taken.iter().any(|trial| trial.fault == *filter))?;
        let other = FILTERS.into_iter().find(|other| *other != filter)?;
        let time_constant = Unknown::of_fault(filter).next().filter(|_| !self.objective().turns())?;
        let (Motor { rs, ld, lq, .. }, of_filter) = (self.drive.motor, self.drive.get(time_constant));
        let exchanged = [(Parameter::Ld, rs * of_filter), (Parameter::Lq, rs * of_filter)];
        let start = exchanged.into_iter().fold(self.drive, |drive, (parameter, henry)| {
            let unknown = Unknown::Motor(parameter);
            if self.unknowns.contains(&unknown) { drive.with(unknown, henry) } else { drive }
        });
        let start = start.with(time_constant, 0.5 * (ld + lq) / rs);
        let Polished { drive, cost, .. } = polish_to_choose(self.objective(), &start, &self.unknowns, self.priors);
        if !(cost > 0.0 && self.cost > 0.0 && filter.is_physical(&drive.faults, &drive.motor, self.objective().peak_current())) {
            return None;
        }
        // How much better the present drive is.
        let lead = effective_sample_size(&self.objective().residuals(&self.drive)) * (cost / self.cost).ln();
        let is_faster = drive.get(time_constant) < of_filter;
        let moves = Parameter::ALL.map(|parameter| drive.motor.get(parameter) - self.drive.motor.get(parameter));
        let is_better = lead < -VERY_STRONG || is_faster && lead < VERY_STRONG;
        if is_better {
            (self.drive, self.cost) = (drive, cost);
            self.compared.clear();
        }
        let moves = moves.map(|by| if is_better { -by } else { by });
        Some(FaultTrial { fault: other, gain: -lead.abs(), outcome: FaultOutcome::Covered, moves })
    }
}
