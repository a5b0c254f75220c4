//! Candidates, their costs and the best seen: the state that every method steps.

use crate::bounds::Bounds;
#[cfg(test)]
use crate::objective::Objective;
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// Stands for a cost that is not finite: no finite cost is worse, and files can hold it.
pub const WORST_COST: f64 = f64::MAX;

/// Candidates in rows, with the trials of the generation at hand beside them.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct Population {
    dimension: usize,
    positions: Vec<f64>,
    costs: Vec<f64>,
    trials: Vec<f64>,
    trial_costs: Vec<f64>,
    /// Trials evaluated so far.
    evaluated: usize,
    best: Vec<f64>,
    best_cost: f64,
    evaluations: u64,
}

impl Population {
    /// Candidates at these positions, row after row; they are the first trials too, and still to be evaluated.
    pub(crate) fn laid_out(positions: Vec<f64>, dimension: usize) -> Self {
        let rows = positions.len() / dimension;
        Self {
            dimension,
            trials: positions.clone(),
            positions,
            costs: vec![WORST_COST; rows],
            trial_costs: vec![WORST_COST; rows],
            evaluated: 0,
            best: vec![0.0; dimension],
            best_cost: WORST_COST,
            evaluations: 0,
        }
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

    /// Lets `propose` move each of `count` trials, then keeps it in the box. A trial stands where the last one of its number was.
    pub(crate) fn propose(&mut self, count: usize, bounds: &Bounds, mut propose: impl FnMut(usize, &Self, &mut [f64])) {
        let mut trials = std::mem::take(&mut self.trials);
        trials.resize(count * self.dimension, 0.0);
        for (k, trial) in trials.chunks_exact_mut(self.dimension).enumerate() {
            propose(k, self, trial);
        }
        // All of them in a second pass: a component that is read as soon as it is written waits until it is.
        trials.chunks_exact_mut(self.dimension).for_each(|trial| bounds.clamp(trial));
        self.trials = trials;
        self.trial_costs.clear();
        self.trial_costs.resize(count, WORST_COST);
        self.evaluated = 0;
    }

    /// Whether no trial is left to be evaluated.
    pub(crate) fn is_evaluated(&self) -> bool {
        self.evaluated >= self.trial_costs.len()
    }

    /// The next trials to be evaluated, at most `most`, row after row.
    pub(crate) fn waiting(&self, most: usize) -> &[f64] {
        let end = self.trial_costs.len().min(self.evaluated.saturating_add(most));
        &self.trials[self.evaluated * self.dimension..end * self.dimension]
    }

    /// The costs of the first trials that wait; no more than wait.
    pub(crate) fn tell(&mut self, costs: &[f64]) {
        let waiting = self.trials[self.evaluated * self.dimension..].chunks_exact(self.dimension);
        for ((held, told), trial) in self.trial_costs[self.evaluated..].iter_mut().zip(costs).zip(waiting) {
            *held = if told.is_finite() { *told } else { WORST_COST };
            if *held < self.best_cost {
                self.best_cost = *held;
                self.best.copy_from_slice(trial);
            }
        }
        self.evaluated += costs.len();
        self.evaluations += costs.len() as u64;
    }

    /// Counts evaluations that are not made.
    pub(crate) fn forgo(&mut self, evaluations: usize) {
        self.evaluations += evaluations as u64;
    }

    /// Evaluates the next trials as one batch, at most `most`.
    #[cfg(test)]
    pub(crate) fn evaluate(&mut self, objective: &dyn Objective, most: usize) {
        let mut costs = vec![WORST_COST; self.waiting(most).len() / self.dimension];
        objective.evaluate(self.waiting(most), &mut costs);
        self.tell(&costs);
    }

    /// Takes the trials that are better than their candidates.
    pub(crate) fn accept_better(&mut self) {
        self.accept(|trial, held| trial < held);
    }

    /// Takes the trials that are at least as good as their candidates.
    pub(crate) fn accept_no_worse(&mut self) {
        self.accept(|trial, held| trial <= held);
    }

    /// Takes every trial.
    pub(crate) fn accept_all(&mut self) {
        self.accept(|_, _| true);
    }

    fn accept(&mut self, takes: impl Fn(f64, f64) -> bool) {
        for i in 0..self.len().min(self.trial_costs.len()) {
            if takes(self.trial_costs[i], self.costs[i]) {
                self.take(i, i);
            }
        }
    }

    /// Moves a candidate to a trial.
    pub(crate) fn take(&mut self, i: usize, trial: usize) {
        let d = self.dimension;
        self.costs[i] = self.trial_costs[trial];
        self.positions[i * d..(i + 1) * d].copy_from_slice(&self.trials[trial * d..(trial + 1) * d]);
    }

    /// Moves a candidate to a trial that is better; returns whether it is.
    pub(crate) fn take_if_better(&mut self, i: usize, trial: usize) -> bool {
        let is_better = self.trial_costs[trial] < self.costs[i];
        if is_better {
            self.take(i, trial);
        }
        is_better
    }

    /// Costs of the trials.
    pub(crate) fn trial_costs(&self) -> &[f64] {
        &self.trial_costs
    }

    /// The candidates' numbers, from the lowest cost to the highest.
    pub(crate) fn ranking(&self) -> Vec<usize> {
        let mut ranking: Vec<usize> = (0..self.len()).collect();
        ranking.sort_by(|a, b| self.costs[*a].total_cmp(&self.costs[*b]));
        ranking
    }

    /// The candidates of these numbers, in this order, become the candidates.
    pub(crate) fn keep(&mut self, chosen: &[usize]) {
        self.positions = chosen.iter().flat_map(|i| self.position(*i)).copied().collect();
        self.costs = chosen.iter().map(|i| self.costs[*i]).collect();
    }

    /// The trials become the candidates.
    pub(crate) fn replace(&mut self) {
        self.positions.clone_from(&self.trials);
        self.costs.clone_from(&self.trial_costs);
    }

    /// Whether all parts have the sizes that this box asks for: what is read back may have been damaged.
    #[cfg(feature = "serde")]
    pub(crate) fn fits(&self, bounds: &Bounds) -> bool {
        let fill = |rows: &[f64], numbers: &[f64]| rows.len().checked_mul(self.dimension) == Some(numbers.len());
        self.dimension == bounds.dimension()
            && !self.is_empty()
            && fill(&self.costs, &self.positions)
            && fill(&self.trial_costs, &self.trials)
            && self.evaluated <= self.trial_costs.len()
            && self.best.len() == self.dimension
    }
}
