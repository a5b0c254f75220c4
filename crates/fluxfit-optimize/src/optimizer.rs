//! A search under way: one optimizer for all methods.
//!
//! An [`Optimizer`] is data and a [`step`](Optimizer::step): as many evaluations as the population has candidates. Its method proposes a
//! generation of trials; they are evaluated as one batch; then it accepts some. A generation of another size than the population may end
//! within a step, or go on in the next one, so that every method keeps to the same number of evaluations. From that one piece come
//! running, stopping, saving (with serde), resuming and history.
//! A step depends on nothing but the state and the objective: running `N` times one iteration is running `N` iterations, and a
//! restored optimizer goes on to the same bits.

use crate::{
    bounds::Bounds,
    draws::Draws,
    error::Error,
    iteration::{Generation, Setup},
    methods::{Method, State},
    objective::Objective,
    population::{Population, WORST_COST},
    report::{Record, SearchReport, StopReason},
    setting::SearchSettings,
};
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};
use std::ops::ControlFlow;

/// A search under way.
#[derive(Debug, Clone)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize), serde(try_from = "Saved"))]
pub struct Optimizer {
    settings: SearchSettings,
    bounds: Bounds,
    draws: Draws,
    population: Population,
    state: State,
    /// Whether the first candidates are all evaluated.
    begun: bool,
    iteration: usize,
    history: Vec<Record>,
}

impl Optimizer {
    /// Lays out and evaluates the first population.
    ///
    /// # Errors
    /// As [`asking`](Self::asking); or if the box has another dimension than the objective, or no candidate of the start has a finite cost.
    pub fn start(method: Method, settings: SearchSettings, bounds: Bounds, objective: &impl Objective) -> Result<Self, Error> {
        let draws = Draws::seeded(settings.seed, settings.run);
        Self::start_from(method, settings, bounds, draws, objective)
    }

    /// [`start`](Self::start) with random numbers of the caller's.
    ///
    /// # Errors
    /// As [`start`](Self::start).
    pub fn start_from(
        method: Method,
        settings: SearchSettings,
        bounds: Bounds,
        draws: Draws,
        objective: &impl Objective,
    ) -> Result<Self, Error> {
        if bounds.dimension() != objective.dimension() {
            return Err(Error::Dimension { bounds: bounds.dimension(), objective: objective.dimension() });
        }
        let mut new = Self::asking_from(method, settings, bounds, draws)?;
        new.advance(objective);
        if new.population.best_cost() == WORST_COST {
            return Err(Error::NonFiniteStart { population: settings.population });
        }
        Ok(new)
    }

    /// Lays out the first population and evaluates nothing: for who [asks](Self::ask) for candidates and [tells](Self::tell) their costs.
    ///
    /// # Errors
    /// If the population is too small for the method, population or iterations are [too many](SearchSettings::check), or a setting of the
    /// method is out of range.
    pub fn asking(method: Method, settings: SearchSettings, bounds: Bounds) -> Result<Self, Error> {
        Self::asking_from(method, settings, bounds, Draws::seeded(settings.seed, settings.run))
    }

    fn asking_from(method: Method, settings: SearchSettings, bounds: Bounds, mut draws: Draws) -> Result<Self, Error> {
        let (size, facts) = (settings.population, method.facts());
        if size < facts.smallest_population {
            return Err(Error::Population { method: facts.label, given: size, least: facts.smallest_population });
        }
        settings.check()?;
        let (positions, state) = method.start(&mut Setup { size, bounds: &bounds, draws: &mut draws })?;
        let population = Population::laid_out(positions, bounds.dimension());
        Ok(Self { settings, bounds, draws, population, state, begun: false, iteration: 0, history: Vec::new() })
    }

    /// One iteration: as many evaluations as the population has candidates. Of one that was begun by [`ask`](Self::ask), the rest.
    pub fn step(&mut self, objective: &impl Objective) {
        self.begin_iteration();
        self.advance(objective);
    }

    /// The candidates whose costs are wanted next, row after row; the same ones until they are told. Those of a whole iteration are asked
    /// for at once or in parts, as the method's generations are. None once a criterion stops the search.
    pub fn ask(&mut self) -> &[f64] {
        if self.left() == 0 {
            if self.stop_reason().is_some() {
                return &[];
            }
            self.begin_iteration();
        }
        self.waiting()
    }

    /// The costs of the candidates that were [asked](Self::ask) for, in their order. One that is not finite counts as the worst.
    ///
    /// # Errors
    /// If they are not as many as were asked for, or no candidate of the start has a finite cost.
    pub fn tell(&mut self, costs: &[f64]) -> Result<(), Error> {
        let asked = self.ask().len() / self.bounds.dimension();
        if costs.len() != asked {
            return Err(Error::Told { told: costs.len(), asked });
        }
        if asked > 0 {
            self.take(costs);
        }
        if self.iteration == 0 && self.left() == 0 && self.population.best_cost() == WORST_COST {
            return Err(Error::NonFiniteStart { population: self.settings.population });
        }
        Ok(())
    }

    /// Evaluations that are left of this iteration.
    fn left(&self) -> usize {
        due(&self.settings, self.iteration).saturating_sub(self.population.evaluations()) as usize
    }

    fn begin_iteration(&mut self) {
        if self.left() == 0 {
            self.iteration += 1;
        }
    }

    /// The next trials of this iteration; proposes some if none is left.
    fn waiting(&mut self) -> &[f64] {
        let left = self.left();
        if self.population.is_evaluated() {
            let (state, mut generation) = self.generation();
            state.propose(&mut generation);
        }
        self.population.waiting(left)
    }

    /// Takes the costs of the next trials, accepts where a generation is done, and records where an iteration is.
    fn take(&mut self, costs: &[f64]) {
        self.population.tell(costs);
        if self.population.is_evaluated() {
            let begun = std::mem::replace(&mut self.begun, true);
            let (state, mut generation) = self.generation();
            if begun {
                state.accept(&mut generation);
            } else {
                generation.population.accept_all();
                state.begin(&mut generation);
            }
        }
        if self.left() == 0 {
            self.record();
        }
    }

    /// What the method works with.
    fn generation(&mut self) -> (&mut State, Generation<'_>) {
        let Self { settings, bounds, draws, population, state, iteration, .. } = self;
        (state, Generation { number: *iteration, limit: settings.iterations, size: settings.population, bounds, draws, population })
    }

    /// Proposes, evaluates and accepts until the evaluations of this iteration are done.
    fn advance(&mut self, objective: &impl Objective) {
        let mut costs = Vec::new();
        while self.left() > 0 {
            let dimension = self.bounds.dimension();
            if self.waiting().is_empty() {
                // Every method proposes something; a loop that rests on it alone would be one that may not end.
                self.population.forgo(self.left());
            }
            let waiting = self.waiting();
            costs.clear();
            costs.resize(waiting.len() / dimension, WORST_COST);
            objective.evaluate(waiting, &mut costs);
            self.take(&costs);
        }
    }

    /// Steps until a criterion stops it.
    pub fn run(&mut self, objective: &impl Objective) -> SearchReport {
        self.run_while(objective, || ControlFlow::Continue(()))
    }

    /// Steps until a criterion stops it, or `go_on`, asked after each iteration, does. What was interrupted can be run on.
    pub fn run_while(&mut self, objective: &impl Objective, mut go_on: impl FnMut() -> ControlFlow<()>) -> SearchReport {
        let stop_reason = loop {
            if let Some(reason) = self.stop_reason() {
                break reason;
            }
            self.step(objective);
            if go_on().is_break() {
                break self.stop_reason().unwrap_or(StopReason::Interrupted);
            }
        };
        SearchReport {
            best: self.population.best().to_vec(),
            cost: self.population.best_cost(),
            evaluations: self.population.evaluations(),
            stop_reason,
            history: self.history.clone(),
        }
    }

    /// The criterion that holds now, if any.
    pub fn stop_reason(&self) -> Option<StopReason> {
        let cost = self.population.best_cost();
        if self.settings.target_cost.is_some_and(|target| cost <= target) {
            Some(StopReason::TargetCost)
        } else if self.settings.close_to_optimum.is_some_and(|close| cost - close.optimum <= close.tolerance) {
            Some(StopReason::CloseToOptimum)
        } else if self.iteration >= self.settings.iterations {
            Some(StopReason::IterationLimit)
        } else {
            None
        }
    }

    /// The candidates and the best of them.
    pub fn population(&self) -> &Population {
        &self.population
    }

    /// The best after each iteration so far.
    pub fn history(&self) -> &[Record] {
        &self.history
    }

    fn record(&mut self) {
        self.history.push(Record {
            iteration: self.iteration,
            evaluations: self.population.evaluations(),
            cost: self.population.best_cost(),
            best: self.population.best().to_vec(),
        });
    }
}

/// Evaluations at the end of an iteration.
fn due(settings: &SearchSettings, iteration: usize) -> u64 {
    (settings.population as u64).saturating_mul((iteration as u64).saturating_add(1))
}

/// A search as it is read back, before it is checked.
#[cfg(feature = "serde")]
#[derive(Deserialize)]
struct Saved {
    settings: SearchSettings,
    bounds: Bounds,
    draws: Draws,
    population: Population,
    state: State,
    begun: bool,
    iteration: usize,
    history: Vec<Record>,
}

#[cfg(feature = "serde")]
impl TryFrom<Saved> for Optimizer {
    type Error = Error;

    /// Refuses parts that do not belong together, so that no step can fail.
    fn try_from(saved: Saved) -> Result<Self, Error> {
        let Saved { settings, bounds, draws, population, state, begun, iteration, history } = saved;
        settings.check()?;
        let due = due(&settings, iteration);
        let is_in_iteration = (due.saturating_sub(settings.population as u64)..=due).contains(&population.evaluations());
        if !is_in_iteration || !population.fits(&bounds) || !state.fits(&population) {
            return Err(Error::SavedSearch);
        }
        state.check()?;
        Ok(Self { settings, bounds, draws, population, state, begun, iteration, history })
    }
}
