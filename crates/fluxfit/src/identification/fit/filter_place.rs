//! Where a filter of the currents lies: in the phases, as an RC filter before the converter, behind their transform to d and q, or there
//! with one of the voltages alike. While the rotor turns they differ by a turn of the current, which is as much of the resistance as
//! `omega_e² L tau`; an observer and other faults hide most of it. So where one was found each other one is tried in its place.

use super::{
    fault_search::{FaultSearch, KINDS, unphysical},
    fault_trial::FaultTrial,
    long_run::effective_sample_size,
    readings::{Rules, TimingTrial, VERY_STRONG, contest},
};
use crate::{faults::Fault, objective::adjustable::Unknown};

/// They have the same numbers: a time constant, and the noise before it.
const FILTERS: [Fault; 3] = [Fault::CurrentFilter, Fault::DqCurrentFilter, Fault::DqFilter];

impl FaultSearch<'_> {
    /// Puts another filter in the place of the one that was taken, if the evidence for it is very strong; whether it did.
    pub(super) fn choose_filter(&mut self, taken: &mut [FaultTrial]) -> bool {
        let Some(place) = taken.iter().position(|trial| FILTERS.contains(&trial.fault)) else { return false };
        let it = taken[place].fault;
        let is_beside = |trial: &FaultTrial, other: &Fault| trial.fault != it && trial.fault.excludes(*other);
        let is_possible = |other: &Fault| {
            let is_excluded = taken.iter().any(|trial| is_beside(trial, other));
            *other != it && !is_excluded && !self.ruled_out.contains(other) && self.objective().turns()
        };
        let beside: Vec<FaultTrial> = taken.iter().filter(|trial| trial.fault != it).cloned().collect();
        let fits = FILTERS.into_iter().filter(is_possible).filter_map(|other| self.with_filter(it, other, &beside));
        let best = fits.min_by(|(_, _, one), (_, _, other)| one.rank().total_cmp(&other.rank()));
        let independent = effective_sample_size(&self.objective().residuals(&self.drive));
        let gain = |trial: &TimingTrial| independent * (self.mean_square() / trial.mean_square()).ln();
        let is_better = |(_, _, best): &(Fault, usize, TimingTrial)| gain(best) > VERY_STRONG && best.rank() < self.present().rank();
        let Some((other, reading, best)) = best.filter(is_better) else { return false };
        let gain = gain(&best);
        self.unknowns = self.in_place_of(it, other);
        (self.reading, self.drive, self.cost) = (reading, best.polished.drive, best.polished.cost);
        (taken[place].fault, taken[place].gain) = (other, taken[place].gain + gain);
        self.choose_reading();
        true
    }

    /// The fit with another filter, and its reading; nothing if no drive has it so.
    fn with_filter(&self, it: Fault, other: Fault, beside: &[FaultTrial]) -> Option<(Fault, usize, TimingTrial)> {
        let numbers = Unknown::of_fault(it).map(|unknown| self.drive.get(unknown));
        let without = Unknown::of_fault(it).fold(self.drive, |drive, unknown| drive.with(unknown, 0.0));
        let start = Unknown::of_fault(other).zip(numbers).fold(without, |drive, (unknown, number)| drive.with(unknown, number));
        let starts = self.open.iter().map(|reading| (*reading, start)).collect();
        let rules = Rules { to_beat: self.mean_square(), ..KINDS };
        let fitted = contest(self.objectives, starts, &self.in_place_of(it, other), self.priors, &rules);
        let (reading, best) = *fitted.first()?;
        let drive = &best.polished.drive;
        let peak = self.objective().peak_current();
        let is_possible = other.is_physical(&drive.faults, &drive.motor, peak) && unphysical(beside, drive, peak).is_none();
        is_possible.then_some((other, reading, best))
    }

    /// The unknowns with those of one fault in the place of another's.
    fn in_place_of(&self, it: Fault, other: Fault) -> Vec<Unknown> {
        let others = self.unknowns.iter().copied().filter(|unknown| unknown.fault() != Some(it));
        others.chain(Unknown::of_fault(other)).collect()
    }
}
