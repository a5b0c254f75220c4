//! An angle that is off or late, of a log that holds few operating points in rows that are not the drive's own periods.
//!
//! Points of one load along q and one speed do not tell an angle: it and the inductance along the current explain each other, and only
//! the currents' changes from row to row tell them apart. Where rows span several of the drive's periods, voltages between them are not
//! logged, and inductances by these changes come out some percent off; an observer makes the residuals white, but not these inductances
//! right. An angle reconciles them with the points, so Schwarz's criterion speaks for one however exact the drive's is: of simulated drives
//! of two loads, every n-th row or means, L_q came out 4 to 57 % too large beside angles of 2 to 10 degrees that were not there. So the
//! drive is fitted without it, and with it or without are equally likely.

use super::{
    fault_search::{FaultSearch, schwarz},
    fault_trial::{FaultOutcome, FaultTrial},
    long_run::effective_sample_size,
    output_choice::is_a_motor,
};
use crate::{
    faults::Fault,
    levenberg_marquardt::{Polished, polish_to_choose},
    motor::{PARAMETERS, Parameter},
    objective::adjustable::Unknown,
};

impl FaultSearch<'_> {
    /// Takes such an angle away, unless nothing is a motor without; returns its trial. A reading that says by how many periods the voltages
    /// lag is that of a drive which logs each of them.
    pub(super) fn drop_angle_of_points(&mut self, taken: &mut Vec<FaultTrial>) -> Vec<FaultTrial> {
        let are_periods = self.objectives[self.reading].0.tells_lag();
        let corrects = self.unknowns.iter().any(|unknown| unknown.is_observer_gain()) || self.drive.faults.filter.noise_before > 0.0;
        let is_told = !self.points_tell_no_angle || are_periods || self.every_period && !corrects;
        let is_angle = |fault: Fault| matches!(fault, Fault::AngleOffset | Fault::AngleDelay);
        let angles: Vec<Fault> = taken.iter().map(|trial| trial.fault).filter(|fault| is_angle(*fault)).collect();
        if is_told || angles.is_empty() {
            return Vec::new();
        }
        let own = |unknown: &Unknown| unknown.fault().is_some_and(is_angle);
        let start = self.unknowns.iter().filter(|unknown| own(unknown)).fold(self.drive, |drive, unknown| drive.with(*unknown, 0.0));
        let unknowns: Vec<Unknown> = self.unknowns.iter().copied().filter(|unknown| !own(unknown)).collect();
        let Polished { drive, cost, .. } = polish_to_choose(self.objective(), &start, &unknowns, self.priors);
        if !(cost.is_finite() && is_a_motor(&drive.motor)) {
            return Vec::new();
        }
        let independent = effective_sample_size(&self.objective().residuals(&self.drive));
        let gain = schwarz(cost, self.cost, self.unknowns.len() - unknowns.len(), independent);
        let with_angle = self.drive.motor;
        (self.drive, self.cost, self.unknowns) = (drive, cost, unknowns);
        taken.retain(|trial| !is_angle(trial.fault));
        self.choose_reading();
        let moves = Parameter::ALL.map(|parameter| with_angle.get(parameter) - self.drive.motor.get(parameter));
        // Both of two go at once, so their moves count once.
        let told = |place: usize| if place == 0 { moves } else { [0.0; PARAMETERS] };
        let trial = |(place, fault)| FaultTrial { fault, gain, outcome: FaultOutcome::NeedsMorePoints, moves: told(place) };
        angles.into_iter().enumerate().map(trial).collect()
    }
}
