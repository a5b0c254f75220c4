//! What a method is handed: to lay out its first trials, and for each generation of trials.

use crate::{bounds::Bounds, draws::Draws, population::Population};

/// What a method starts from.
pub(crate) struct Setup<'a> {
    /// Candidates asked for.
    pub(crate) size: usize,
    pub(crate) bounds: &'a Bounds,
    pub(crate) draws: &'a mut Draws,
}

impl Setup<'_> {
    /// As many positions uniform in the box as candidates were asked for.
    pub(crate) fn uniform(&mut self) -> Vec<f64> {
        self.uniform_rows(self.size)
    }

    /// Positions uniform in the box, row after row. Draws one number per component.
    pub(crate) fn uniform_rows(&mut self, rows: usize) -> Vec<f64> {
        let mut positions = Vec::with_capacity(rows * self.bounds.dimension());
        for _ in 0..rows {
            positions.extend(self.bounds.iter().map(|(lower, upper)| lower + self.draws.uniform() * (upper - lower)));
        }
        positions
    }
}

/// What a method works on when it proposes a generation of trials, and when it accepts them.
pub(crate) struct Generation<'a> {
    /// The iteration of the search, from 1. A method whose generations are as large as the population has one in each iteration.
    pub(crate) number: usize,
    /// The last iteration of the search.
    pub(crate) limit: usize,
    /// Candidates asked for.
    pub(crate) size: usize,
    pub(crate) bounds: &'a Bounds,
    pub(crate) draws: &'a mut Draws,
    pub(crate) population: &'a mut Population,
}

impl Generation<'_> {
    /// The part of the evaluations after the first `size` that are done or, with generations as large as the population, will be done
    /// with this one: from `1 / limit` to 1, the `t / T` of many methods.
    pub(crate) fn progress(&self) -> f64 {
        let all = self.size as f64 * self.limit as f64;
        (self.population.evaluations() as f64 / all.max(1.0)).min(1.0)
    }

    /// Lets `propose` move each candidate's trial, which stands where its last one was, then keeps it in the box.
    pub(crate) fn try_each(&mut self, propose: impl FnMut(usize, &Population, &mut [f64], &mut Draws)) {
        self.try_some(self.population.len(), propose);
    }

    /// [`try_each`](Self::try_each) with another number of trials than candidates.
    pub(crate) fn try_some(&mut self, count: usize, mut propose: impl FnMut(usize, &Population, &mut [f64], &mut Draws)) {
        let draws = &mut *self.draws;
        self.population.propose(count, self.bounds, |k, population, trial| propose(k, population, trial, draws));
    }

    /// Trials at these positions, row after row, each kept in the box.
    pub(crate) fn try_these(&mut self, positions: &[f64]) {
        let d = self.bounds.dimension();
        self.population.propose(positions.len() / d, self.bounds, |k, _, trial| trial.copy_from_slice(&positions[k * d..(k + 1) * d]));
    }
}
