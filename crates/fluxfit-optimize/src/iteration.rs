//! What a method is handed: to lay out its first population, and in each iteration.

use crate::{bounds::Bounds, draws::Draws, error::Error, objective::Objective, population::Population};

/// What a method starts from.
pub(crate) struct Setup<'a> {
    /// Candidates asked for.
    pub(crate) size: usize,
    pub(crate) bounds: &'a Bounds,
    pub(crate) draws: &'a mut Draws,
    pub(crate) objective: &'a dyn Objective,
}

impl Setup<'_> {
    /// Candidates uniform in the box, evaluated. Draws one number per component, row after row.
    pub(crate) fn uniform(&mut self) -> Result<Population, Error> {
        let mut positions = Vec::with_capacity(self.size * self.bounds.dimension());
        for _ in 0..self.size {
            positions.extend(self.bounds.iter().map(|(lower, upper)| lower + self.draws.uniform() * (upper - lower)));
        }
        self.at(positions)
    }

    /// Candidates at these positions, row after row, evaluated.
    pub(crate) fn at(&self, positions: Vec<f64>) -> Result<Population, Error> {
        Population::evaluated(positions, self.objective)
    }
}

/// What a method works on in one iteration.
pub(crate) struct Iteration<'a> {
    /// From 1.
    pub(crate) number: usize,
    /// The last iteration of the search.
    pub(crate) limit: usize,
    pub(crate) bounds: &'a Bounds,
    pub(crate) draws: &'a mut Draws,
    pub(crate) population: &'a mut Population,
    pub(crate) objective: &'a dyn Objective,
}

impl Iteration<'_> {
    /// Lets `propose` move each candidate's trial, which stands where its last one was, then keeps it in the box. Evaluates all
    /// trials as one batch.
    pub(crate) fn try_each(&mut self, mut propose: impl FnMut(usize, &Population, &mut [f64], &mut Draws)) {
        let draws = &mut *self.draws;
        self.population.propose_each(self.bounds, |i, population, trial| propose(i, population, trial, draws));
        self.population.evaluate(self.objective);
    }
}
