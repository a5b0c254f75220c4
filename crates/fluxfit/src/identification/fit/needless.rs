//! Faults that were taken early in a search and are not needed at its end: others explain the same, or the small part of a loss that its
//! model lacks. They go, and what they would do to the parameters is in doubt.

use super::{
    fault_search::{FaultSearch, WITHIN_ROWS, schwarz},
    fault_trial::{FaultOutcome, FaultTrial},
    long_run::effective_sample_size,
    readings::VERY_STRONG,
};
use crate::{
    faults::Fault,
    levenberg_marquardt::{Linearized, Polished, linearized_one, polish_to_choose, with_priors},
    motor::Parameter,
    normal_matrix::NormalMatrix,
    objective::adjustable::Unknown,
};
use nalgebra::{DMatrix, DVector};

/// The evidence that a fault needs beside dead time: twice as much. The loss is right to some hundredths only, and of ten simulated logs of
/// two points a small offset or delay of the angle stood in for the rest in two, with L_q 1.6 % off.
const BESIDE_LOSS: f64 = 2.0 * VERY_STRONG;

/// A fault is fitted without only if its numbers promise less than so many times the evidence that it needs.
const NEAR: f64 = 3.0;

impl FaultSearch<'_> {
    /// Takes those away that are not needed, the one that is missed least first; returns their trials.
    pub(super) fn drop_needless(&mut self, taken: &mut Vec<FaultTrial>) -> Vec<FaultTrial> {
        let mut dropped = Vec::new();
        while let Some(trial) = self.needless(taken) {
            let goes = trial.fault;
            taken.retain(|other| other.fault != goes);
            dropped.push(trial);
        }
        dropped
    }

    /// The fault that is missed least, if it is not needed: the drive is fitted without it.
    fn needless(&mut self, taken: &[FaultTrial]) -> Option<FaultTrial> {
        let loses = |fault: Fault| fault.family() == Fault::DeadTime.family();
        let beside_loss = taken.iter().any(|trial| loses(trial.fault));
        let needed = if beside_loss { BESIDE_LOSS } else { VERY_STRONG };
        // Others depend on the loss; it is never small.
        let candidates = taken.iter().map(|trial| trial.fault).filter(|fault| !loses(*fault));
        let Linearized { residuals, slopes } = linearized_one(self.objective(), &self.drive, &self.unknowns);
        let independent = effective_sample_size(&residuals);
        let inverse = NormalMatrix::of(&with_priors(slopes, &self.unknowns, self.priors)).inverse();
        let cost_without = |fault: Fault| self.cost + self.cost_of(fault, &inverse);
        let (fault, cost) = candidates.map(|fault| (fault, cost_without(fault))).min_by(|(_, one), (_, other)| one.total_cmp(other))?;
        let own = Unknown::of_fault(fault).count();
        // What may be the error of the loss model goes even with strong evidence, if it explains little.
        let may_be_loss = self.may_be_loss(fault, &self.drive);
        let explains_little = |cost: f64| may_be_loss && self.cost > (1.0 - WITHIN_ROWS) * cost;
        if schwarz(cost, self.cost, own, independent) > NEAR * needed && !explains_little(cost) {
            return None;
        }
        let start = Unknown::of_fault(fault).fold(self.drive, |drive, unknown| drive.with(unknown, 0.0));
        let unknowns: Vec<Unknown> = self.unknowns.iter().copied().filter(|unknown| unknown.fault() != Some(fault)).collect();
        let Polished { drive, cost, .. } = polish_to_choose(self.objective(), &start, &unknowns, self.priors);
        let gain = schwarz(cost, self.cost, own, independent);
        let outcome = if gain <= needed {
            FaultOutcome::NotNeeded
        } else if explains_little(cost) {
            FaultOutcome::NoMatter
        } else {
            return None;
        };
        let moves = Parameter::ALL.map(|parameter| self.drive.motor.get(parameter) - drive.motor.get(parameter));
        (self.drive, self.cost, self.unknowns) = (drive, cost, unknowns);
        self.choose_reading();
        Some(FaultTrial { fault, gain, outcome, moves })
    }

    /// By how much the cost grows without a fault, to second order, A²: `x' C^-1 x` for its numbers `x` and their part `C` of the inverse
    /// of the normal matrix.
    fn cost_of(&self, fault: Fault, inverse: &DMatrix<f64>) -> f64 {
        // A filter much faster than a row keeps nothing from one row to the next: its number for the noise has no effect.
        let acts = |k: &usize| self.unknowns[*k].fault() == Some(fault) && inverse[(*k, *k)] > 0.0;
        let places: Vec<usize> = (0..self.unknowns.len()).filter(acts).collect();
        let values = DVector::from_iterator(places.len(), places.iter().map(|k| self.drive.get(self.unknowns[*k])));
        let part = DMatrix::from_fn(places.len(), places.len(), |p, q| inverse[(places[p], places[q])]);
        part.cholesky().map_or(0.0, |factor| values.dot(&factor.solve(&values)))
    }
}
