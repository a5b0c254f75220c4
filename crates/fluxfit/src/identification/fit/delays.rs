//! An angle that is late, or voltages that lag: both turn the voltages with the speed, and only the first turns the currents with them.
//! Where little tells them apart, the one that was taken first stands in for the other, and inductances are off by tens of percent. So at
//! the end of a search the one is tried in the place of the other, of both the one that is not needed goes, and what the one that is not
//! part of the answer would do to it is in doubt. Here a lag may stand beside a filter of the voltages, which is not tried before.
//!
//! At one speed an angle that is off by a constant does the same as a late one. Where rows are not the drive's periods, such an offset and
//! a reading "in the frame at the row" took the place of a lag, of a drive that does not turn its voltages forward: from means of four
//! periods, inductances were 10 % off at 0.3 %. So a lag is tried in the place of an offset, too, under every reading that allows one.
//! And as such rows do not hold what the controller answers to noise within them, a lag that leaves more than an angle is in doubt still.

use super::{
    fault_search::{FaultSearch, NOTICEABLE, WITHIN_ROWS},
    fault_trial::{FaultOutcome, FaultTrial},
    long_run::effective_sample_size,
    readings::{HOPELESS_AFTER_A_FIT, Rules, TimingTrial, VERY_STRONG, contest},
};
use crate::{
    faults::Fault,
    levenberg_marquardt::Polished,
    motor::{PARAMETERS, Parameter},
    objective::adjustable::Unknown,
};

/// Part of the residual's power by which an angle may fit better than a lag that is there, where rows are not the drive's periods: what the
/// controller answers to noise within a row is not in the log, and an angle, which turns the currents too, follows it better. Of 160
/// simulated drives that do not turn their voltages forward: up to 0.44. Of means with a late angle a lag leaves 2.6 times as much; of
/// every n-th row with one 0.9 to 1.7 times: such a log tells neither.
const OF_ANSWERS: f64 = 0.5;

/// The two.
const DELAYS: [Fault; 2] = [Fault::AngleDelay, Fault::VoltageLag];

/// A fit with only one of the two.
struct WithOne {
    it: Fault,
    reading: usize,
    trial: TimingTrial,
    unknowns: Vec<Unknown>,
}

impl FaultSearch<'_> {
    /// Chooses between lag and angle, if any was taken. Returns what the other, which may be there, would do.
    pub(super) fn choose_delay(&mut self, taken: &mut Vec<FaultTrial>) -> Vec<FaultTrial> {
        let mut others = self.choose_between(taken);
        if self.may_hide_lag() {
            others.extend(self.lag_alone(taken));
        }
        others
    }

    /// What a lag would do without the angle beside it, where that leaves not much more.
    fn lag_alone(&self, taken: &[FaultTrial]) -> Vec<FaultTrial> {
        let is_there = |fault| taken.iter().any(|trial| trial.fault == fault);
        let angles = [Fault::AngleOffset, Fault::AngleDelay].into_iter().filter(|angle| is_there(Fault::VoltageLag) && is_there(*angle));
        let alone = angles.filter_map(|angle| {
            let fit = self.with_only(Fault::VoltageLag, [angle, Fault::VoltageLag])?;
            let (fault, outcome, moves) = (Fault::VoltageLag, FaultOutcome::Covered, self.moves_to(&fit));
            let is_possible = self.mean_square() > (1.0 - OF_ANSWERS) * fit.mean_square();
            is_possible.then_some(FaultTrial { fault, gain: 0.0, outcome, moves })
        });
        alone.collect()
    }

    /// The choice itself: the other one in the place of the one that was taken, or the lesser of both away.
    fn choose_between(&mut self, taken: &mut Vec<FaultTrial>) -> Vec<FaultTrial> {
        let here: Vec<Fault> = DELAYS.into_iter().filter(|delay| taken.iter().any(|trial| trial.fault == *delay)).collect();
        match here[..] {
            [] if self.may_hide_lag() && taken.iter().any(|trial| trial.fault == Fault::AngleOffset) => {
                self.in_its_place([Fault::AngleOffset, Fault::VoltageLag], taken).into_iter().collect()
            }
            [] => Vec::new(),
            [one] => self.in_its_place(with_other(one), taken).into_iter().collect(),
            _ => self.without_the_lesser(taken),
        }
    }

    /// Whether the reading may hide a lag: all do but those of a drive whose periods the rows are, and not in the frame at the row.
    fn may_hide_lag(&self) -> bool {
        let reading = self.objectives[self.reading].0;
        !self.every_period || !reading.tells_lag() || reading.is_in_frame_of_row()
    }

    /// Of both the lesser goes, if it explains little beside the other, or if one is early and the other late, as of no drive.
    fn without_the_lesser(&mut self, taken: &mut Vec<FaultTrial>) -> Vec<FaultTrial> {
        let fits = DELAYS.into_iter().filter_map(|it| self.with_only(it, DELAYS));
        let Some(fit) = fits.min_by(|one, other| one.mean_square().total_cmp(&other.mean_square())) else { return Vec::new() };
        let faults = &self.drive.faults;
        let are_opposed = faults.angle_delay.time * faults.voltage_lag.time < 0.0;
        let gain = self.lead(&fit) - self.independent().ln();
        if !are_opposed && gain > VERY_STRONG && fit.mean_square() >= (1.0 + NOTICEABLE) * self.mean_square() {
            return Vec::new();
        }
        let (left, moves) = (fit.it, self.moves_to(&fit).map(|by| -by));
        let goes = |trial: &FaultTrial| DELAYS.contains(&trial.fault) && trial.fault != left;
        let lesser = taken.iter().find(|trial| goes(trial)).map(|trial| trial.fault);
        taken.retain(|trial| !goes(trial));
        self.adopt(fit);
        // What is as of no drive says nothing of where the parameters are.
        let outcome = if are_opposed { FaultOutcome::NotPhysical } else { FaultOutcome::NotNeeded };
        let lesser = lesser.map(|fault| FaultTrial { fault, gain, outcome, moves });
        self.in_its_place(with_other(left), taken).into_iter().chain(lesser).collect()
    }

    /// The other one in the place of this one, if it fits better. Where they differ by less than what voltages do within rows, the log does
    /// not tell which of them is there: each is as likely as the other.
    fn in_its_place(&mut self, [one, other]: [Fault; 2], taken: &mut [FaultTrial]) -> Option<FaultTrial> {
        let fit = self.with_only(other, [one, other])?;
        let (lead, moves) = (self.lead(&fit), self.moves_to(&fit));
        let (least, most) = (fit.mean_square().min(self.mean_square()), fit.mean_square().max(self.mean_square()));
        let left = if lead >= 0.0 { other } else { one };
        let may_be_answers = left == Fault::VoltageLag && self.may_hide_lag();
        let within_rows = if may_be_answers { OF_ANSWERS } else { WITHIN_ROWS };
        let gain = if least > (1.0 - within_rows) * most { 0.0 } else { -lead.abs() };
        let covered = |fault, moves| Some(FaultTrial { fault, gain, outcome: FaultOutcome::Covered, moves });
        if lead >= 0.0 {
            return covered(other, moves);
        }
        for trial in taken.iter_mut().filter(|trial| trial.fault == one) {
            (trial.fault, trial.gain) = (other, trial.gain - lead);
        }
        self.adopt(fit);
        covered(one, moves.map(|by| -by))
    }

    /// How much better the present drive is than this one, by Schwarz's criterion for as many unknowns; where neither leaves anything, not
    /// at all.
    fn lead(&self, fit: &WithOne) -> f64 {
        let (other, own) = (fit.mean_square(), self.mean_square());
        if other > 0.0 && own > 0.0 { self.independent() * (other / own).ln() } else { 0.0 }
    }

    fn independent(&self) -> f64 {
        effective_sample_size(&self.objective().residuals(&self.drive))
    }

    fn moves_to(&self, fit: &WithOne) -> [f64; PARAMETERS] {
        Parameter::ALL.map(|parameter| fit.trial.polished.drive.motor.get(parameter) - self.drive.motor.get(parameter))
    }

    fn adopt(&mut self, fit: WithOne) {
        let Polished { drive, cost, .. } = fit.trial.polished;
        (self.reading, self.drive, self.cost, self.unknowns) = (fit.reading, drive, cost, fit.unknowns);
        if !self.open.contains(&fit.reading) {
            self.open.push(fit.reading);
        }
        self.choose_reading();
    }

    /// A fit with only one of the two, which begins with the sum of both, under the reading that suits it; nothing if no drive has it so.
    fn with_only(&self, it: Fault, both: [Fault; 2]) -> Option<WithOne> {
        let of_both = || both.into_iter().flat_map(Unknown::of_fault);
        // An angle cannot be added to a time; and the readings that fit beside an angle offset are those that no lag may stand beside.
        let are_times = both.iter().all(|fault| DELAYS.contains(fault));
        let present = |unknown: Unknown| self.drive.get(unknown);
        let sum = if are_times { of_both().map(present).sum() } else { Unknown::of_fault(it).map(present).sum() };
        let all: Vec<usize> = (0..self.objectives.len()).collect();
        let among = if are_times && !self.objectives[self.reading].0.is_in_frame_of_row() { &self.open } else { &all };
        let goes = |unknown: &Unknown| unknown.fault().is_some_and(|fault| both.contains(&fault));
        let start = self.unknowns.iter().filter(|unknown| goes(unknown)).fold(self.drive, |drive, unknown| drive.with(*unknown, 0.0));
        let start = Unknown::of_fault(it).fold(start, |drive, unknown| drive.with(unknown, sum));
        let unknowns: Vec<Unknown> = self.unknowns.iter().copied().filter(|unknown| !goes(unknown)).chain(Unknown::of_fault(it)).collect();
        let may_be = |place: &&usize| it != Fault::VoltageLag || self.objectives[**place].0.may_lag();
        let starts = among.iter().filter(may_be).map(|place| (*place, start)).collect();
        let fitted = contest(self.objectives, starts, &unknowns, self.priors, &Rules::all(HOPELESS_AFTER_A_FIT));
        let (reading, trial) = *fitted.first()?;
        let Polished { drive, .. } = trial.polished;
        let is_physical = it.is_physical(&drive.faults, &drive.motor, self.objective().peak_current());
        is_physical.then_some(WithOne { it, reading, trial, unknowns })
    }
}

/// It and the other of the two.
fn with_other(one: Fault) -> [Fault; 2] {
    let [first, second] = DELAYS;
    if one == first { DELAYS } else { [second, first] }
}

impl WithOne {
    fn mean_square(&self) -> f64 {
        self.trial.mean_square()
    }
}
