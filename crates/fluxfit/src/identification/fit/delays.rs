//! An angle that is late, or voltages that lag: both turn the voltages with the speed, and only the first turns the currents with them.
//! Where little tells them apart, the one that was taken first stands in for the other, and inductances are off by tens of percent. So at
//! the end of a search the one is tried in the place of the other, of both the one that is not needed goes, and what the one that is not
//! part of the answer would do to it is in doubt.

use super::{
    fault_search::{FaultOutcome, FaultSearch, FaultTrial, NOTICEABLE},
    long_run::effective_sample_size,
    readings::{HOPELESS_AFTER_A_FIT, Rules, VERY_STRONG, contest},
};
use crate::{
    faults::Fault,
    motor::Parameter,
    objective::adjustable::{Adjustable, Unknown},
};

/// The two.
const DELAYS: [Fault; 2] = [Fault::AngleDelay, Fault::VoltageLag];

/// A fit with only one of the two.
struct WithOne {
    it: Fault,
    reading: usize,
    drive: Adjustable,
    cost: f64,
    mean_square: f64,
    unknowns: Vec<Unknown>,
}

impl FaultSearch<'_> {
    /// Chooses between the two, if any of them was taken. Returns the trial of one that may be there and is not part of the answer.
    pub(super) fn choose_delay(&mut self, taken: &mut Vec<FaultTrial>) -> Option<FaultTrial> {
        let here: Vec<Fault> = DELAYS.into_iter().filter(|delay| taken.iter().any(|trial| trial.fault == *delay)).collect();
        let are_both = here.len() == DELAYS.len();
        let others = DELAYS.into_iter().filter(|delay| !here.is_empty() && (are_both || !here.contains(delay)));
        let fits = others.filter_map(|it| self.with_only(it)).filter(|fit| self.is_physical(fit));
        let fit = fits.min_by(|one, other| one.mean_square.total_cmp(&other.mean_square))?;
        let other = DELAYS.into_iter().find(|delay| *delay != fit.it)?;
        let independent = effective_sample_size(&self.objective().residuals(&self.drive));
        let own = self.mean_square();
        // How much better the present drive is by Schwarz's criterion; where both leave nothing, it is no worse.
        let more = self.unknowns.len() as f64 - fit.unknowns.len() as f64;
        let lead =
            if fit.mean_square > 0.0 && own > 0.0 { independent * (fit.mean_square / own).ln() - more * independent.ln() } else { 0.0 };
        let moves = Parameter::ALL.map(|parameter| fit.drive.motor.get(parameter) - self.drive.motor.get(parameter));
        let stays = if are_both { lead > VERY_STRONG && fit.mean_square >= (1.0 + NOTICEABLE) * own } else { lead >= 0.0 };
        if stays {
            let covered = FaultTrial { fault: fit.it, gain: -lead, outcome: FaultOutcome::Covered, moves };
            return (!are_both).then_some(covered);
        }
        let outcome = if are_both { FaultOutcome::NotNeeded } else { FaultOutcome::Covered };
        for trial in taken.iter_mut().filter(|trial| trial.fault == other && !are_both) {
            (trial.fault, trial.gain) = (fit.it, trial.gain - lead);
        }
        taken.retain(|trial| trial.fault != other);
        (self.reading, self.drive, self.cost, self.unknowns) = (fit.reading, fit.drive, fit.cost, fit.unknowns);
        self.choose_reading();
        Some(FaultTrial { fault: other, gain: lead, outcome, moves: moves.map(|by| -by) })
    }

    /// A fit with only one of the two, which begins with the sum of both, under the reading that suits it.
    fn with_only(&self, it: Fault) -> Option<WithOne> {
        let of_both = || DELAYS.into_iter().flat_map(Unknown::of_fault);
        let sum = of_both().map(|unknown| self.drive.get(unknown)).sum();
        let goes = |unknown: &Unknown| unknown.fault().is_some_and(|fault| DELAYS.contains(&fault));
        let start = self.unknowns.iter().filter(|unknown| goes(unknown)).fold(self.drive, |drive, unknown| drive.with(*unknown, 0.0));
        let start = Unknown::of_fault(it).fold(start, |drive, unknown| drive.with(unknown, sum));
        let unknowns: Vec<Unknown> = self.unknowns.iter().copied().filter(|unknown| !goes(unknown)).chain(Unknown::of_fault(it)).collect();
        let may_be = |place: &&usize| it != Fault::VoltageLag || self.objectives[**place].0.may_lag();
        let starts = self.open.iter().filter(may_be).map(|place| (*place, start)).collect();
        let fitted = contest(self.objectives, starts, &unknowns, self.priors, &Rules::all(HOPELESS_AFTER_A_FIT));
        let (reading, best) = fitted.first()?;
        let (drive, cost) = (best.polished.drive, best.polished.cost);
        Some(WithOne { it, reading: *reading, drive, cost, mean_square: best.mean_square(), unknowns })
    }

    fn is_physical(&self, fit: &WithOne) -> bool {
        fit.it.is_physical(&fit.drive.faults, &fit.drive.motor, self.objective().peak_current())
    }
}
