//! Candidates, their costs and the best seen: the state that every method steps.

use crate::{bounds::Bounds, error::Error, objective::Objective};
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// Stands for a cost that is not finite: no finite cost is worse, and files can hold it.
pub const WORST_COST: f64 = f64::MAX;

/// Candidates in rows, with the trials of the step at hand beside them.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct Population {
    dimension: usize,
    positions: Vec<f64>,
    costs: Vec<f64>,
    trials: Vec<f64>,
    trial_costs: Vec<f64>,
    best: Vec<f64>,
    best_cost: f64,
    evaluations: u64,
}

impl Population {
    /// Evaluates the candidates at these positions, row after row.
    ///
    /// # Errors
    /// If none of them has a finite cost.
    pub(crate) fn evaluated(positions: Vec<f64>, objective: &dyn Objective) -> Result<Self, Error> {
        let dimension = objective.dimension();
        let population = positions.len() / dimension;
        let mut new = Self {
            dimension,
            trials: positions.clone(),
            positions,
            costs: vec![WORST_COST; population],
            trial_costs: vec![WORST_COST; population],
            best: vec![0.0; dimension],
            best_cost: WORST_COST,
            evaluations: 0,
        };
        new.evaluate(objective);
        new.accept_all();
        if new.best_cost == WORST_COST { Err(Error::NonFiniteStart { population }) } else { Ok(new) }
    }

    /// How many candidates.
    pub fn len(&self) -> usize {
        self.costs.len()
    }

    /// Whether there is no candidate; never so.
    pub fn is_empty(&self) -> bool {
        self.costs.is_empty()
    }

    /// Costs of the candidates.
    pub fn costs(&self) -> &[f64] {
        &self.costs
    }

    /// Candidates, row after row.
    pub fn positions(&self) -> &[f64] {
        &self.positions
    }

    /// The best position seen.
    pub fn best(&self) -> &[f64] {
        &self.best
    }

    /// Its cost.
    pub fn best_cost(&self) -> f64 {
        self.best_cost
    }

    /// How many candidates were evaluated so far.
    pub fn evaluations(&self) -> u64 {
        self.evaluations
    }

    /// One candidate.
    pub(crate) fn position(&self, i: usize) -> &[f64] {
        &self.positions[i * self.dimension..(i + 1) * self.dimension]
    }

    /// Adds `factor (x_to - x_from)` to a trial.
    pub(crate) fn add_difference(&self, trial: &mut [f64], factor: f64, to: usize, from: usize) {
        for ((x, to), from) in trial.iter_mut().zip(self.position(to)).zip(self.position(from)) {
            *x += factor * (to - from);
        }
    }

    /// Sets a trial to its candidate's position.
    pub(crate) fn copy_position(&self, i: usize, trial: &mut [f64]) {
        trial.copy_from_slice(self.position(i));
    }

    /// Lets `propose` move each candidate's trial, which stands where its last one was, then keeps it in the box.
    pub(crate) fn propose_each(&mut self, bounds: &Bounds, mut propose: impl FnMut(usize, &Self, &mut [f64])) {
        let mut trials = std::mem::take(&mut self.trials);
        for (i, trial) in trials.chunks_exact_mut(self.dimension).enumerate() {
            propose(i, self, trial);
            bounds.clamp(trial);
        }
        self.trials = trials;
    }

    /// Evaluates the trials as one batch.
    pub(crate) fn evaluate(&mut self, objective: &dyn Objective) {
        objective.evaluate(&self.trials, &mut self.trial_costs);
        for cost in &mut self.trial_costs {
            if !cost.is_finite() {
                *cost = WORST_COST;
            }
        }
        self.evaluations += self.trial_costs.len() as u64;
    }

    /// Takes the trials that are better than their candidates.
    pub(crate) fn accept_better(&mut self) {
        self.accept(|trial, held| trial < held);
    }

    /// Takes every trial.
    pub(crate) fn accept_all(&mut self) {
        self.accept(|_, _| true);
    }

    fn accept(&mut self, takes: impl Fn(f64, f64) -> bool) {
        let d = self.dimension;
        for i in 0..self.costs.len() {
            let cost = self.trial_costs[i];
            if takes(cost, self.costs[i]) {
                self.costs[i] = cost;
                self.positions[i * d..(i + 1) * d].copy_from_slice(&self.trials[i * d..(i + 1) * d]);
            }
            if cost < self.best_cost {
                self.best_cost = cost;
                self.best.copy_from_slice(&self.trials[i * d..(i + 1) * d]);
            }
        }
    }
    /// Whether all parts have the sizes that this box asks for: what is read back may have been damaged.
    #[cfg(feature = "serde")]
    pub(crate) fn fits(&self, bounds: &Bounds) -> bool {
        let (rows, numbers) = (self.costs.len(), self.positions.len());
        self.dimension == bounds.dimension()
            && rows > 0
            && rows.checked_mul(self.dimension) == Some(numbers)
            && self.trials.len() == numbers
            && self.trial_costs.len() == rows
            && self.best.len() == self.dimension
    }
}
