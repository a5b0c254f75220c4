//! The observer of a disturbed motor, which comes first of all faults and goes again where they have made it useless.

use super::{
    fault_search::{FaultSearch, RIPPLE, schwarz},
    fault_trial::{FaultOutcome, FaultTrial},
    readings::{HOPELESS, Rules, VERY_STRONG, contest},
};
use crate::{faults::Fault, objective::adjustable::Unknown};
use std::collections::BTreeSet;

/// Of all kinds and readings where an observer would stay: what it hides may be one of them, and its numbers far from those found here.
const WITHOUT_OBSERVER: Rules = Rules { stepped: 30, fitted: 12, ..Rules::all(HOPELESS) };

impl FaultSearch<'_> {
    /// Adds the observer of a disturbed motor, if it would help: beside it residuals are white, and faults are judged by their true worth.
    /// At rest nothing of the motor disturbs it, and an observer would take what dead time does.
    pub(super) fn observe(&mut self) -> Option<FaultTrial> {
        if !self.objective().turns() || self.mean_square().sqrt() <= RIPPLE * self.objective().peak_current() {
            return None;
        }
        let observer = self.take_best(&[Fault::Disturbance], &[]).pop().filter(|trial| trial.outcome == FaultOutcome::Taken)?;
        self.choose_reading();
        Some(observer)
    }

    /// Whether the observer is still worth its unknowns; if not, it goes.
    pub(super) fn drop_observer(&mut self, taken: &[FaultTrial]) -> FaultTrial {
        let trial = |gain, outcome| FaultTrial { gain, ..FaultTrial::not_judged(Fault::Disturbance, outcome) };
        let unknowns: Vec<Unknown> = self.unknowns.iter().copied().filter(|unknown| !unknown.is_observer_gain()).collect();
        let alone = self.drive.without_observer();
        let as_found = self.open.iter().map(|reading| (*reading, alone));
        let starts = as_found.chain(self.kinds(taken, &alone)).collect();
        let (rows, peak) = (2.0 * self.objective().rows() as f64, self.objective().peak_current());
        let own = self.unknowns.len() - unknowns.len();
        let is_physical = Fault::Disturbance.is_physical(&self.drive.faults, &self.drive.motor, peak);
        // Above both of these it stays.
        let (needed, nothing) = (cost_to_lose(self.cost, own, rows), rows * (RIPPLE * peak).powi(2));
        let to_beat = if is_physical { needed.max(nothing) / rows } else { 0.0 };
        let mut compared = contest(self.objectives, starts, &unknowns, self.priors, &Rules { to_beat, ..WITHOUT_OBSERVER });
        // The best of each reading.
        let mut seen = BTreeSet::new();
        compared.retain(|(reading, _)| seen.insert(*reading));
        let Some(&(place, without)) = compared.first() else { return trial(0.0, FaultOutcome::Taken) };
        let gain = schwarz(without.polished.cost, self.cost, own, rows);
        let nothing_left = (without.polished.cost / rows).sqrt() <= RIPPLE * peak;
        let outcome = if gain <= VERY_STRONG || nothing_left {
            FaultOutcome::NotNeeded
        } else if is_physical {
            return trial(gain, FaultOutcome::Taken);
        } else {
            FaultOutcome::NotPhysical
        };
        (self.reading, self.drive, self.cost, self.unknowns) = (place, without.polished.drive, without.polished.cost, unknowns);
        self.compared = compared;
        trial(gain, outcome)
    }
}

/// The cost without so many unknowns up to which they are not needed, given the cost with them: [`schwarz`], solved for it.
fn cost_to_lose(cost: f64, unknowns: usize, independent: f64) -> f64 {
    cost * ((VERY_STRONG + unknowns as f64 * independent.ln()) / independent).exp()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_cost_to_lose_is_where_the_evidence_is_just_strong() {
        let without = cost_to_lose(3.0, 2, 400.0);
        assert!((schwarz(without, 3.0, 2, 400.0) - VERY_STRONG).abs() < 1e-9, "{without}");
    }
}
