//! Who minimizes: four population methods behind one optimizer.
//!
//! An [`Optimizer`] is data and a [`step`](Optimizer::step): it proposes a trial per candidate, evaluates all of them as one
//! batch, then accepts. From that one piece come running, stopping, saving (it implements serde's traits), resuming and history.
//! A step depends on nothing but the state and the objective: running `N` times one iteration is running `N` iterations, and a
//! restored optimizer goes on to the same bits.
//!
//! This room knows nothing of motors. Anything that implements [`Objective`] can be minimized.

pub mod apso;
pub mod bounds;
pub mod chaos;
pub mod draws;
pub mod fpa;
pub mod levy;
pub mod lpso;
pub mod particles;
pub mod population;
pub mod tgfpa;

use crate::error::Error;
use apso::Apso;
use bounds::Bounds;
use draws::Draws;
use fpa::Fpa;
use lpso::Lpso;
use particles::Particles;
use population::{Population, WORST_COST};
use serde::{Deserialize, Serialize};
use std::ops::ControlFlow;
use tgfpa::Tgfpa;

/// A function to minimize.
pub trait Objective: Sync {
    /// Length of a candidate; at least 1.
    fn dimension(&self) -> usize;

    /// The costs of many candidates. `candidates` holds them row after row, `costs.len()` rows of [`dimension`](Self::dimension) numbers.
    /// A cost that is not finite counts as worse than any finite one.
    fn evaluate(&self, candidates: &[f64], costs: &mut [f64]);
}

/// An objective from a function of one candidate.
pub fn objective_from<F: Fn(&[f64]) -> f64 + Sync>(dimension: usize, cost: F) -> impl Objective {
    struct Pointwise<F>(usize, F);
    impl<F: Fn(&[f64]) -> f64 + Sync> Objective for Pointwise<F> {
        fn dimension(&self) -> usize {
            self.0
        }
        fn evaluate(&self, candidates: &[f64], costs: &mut [f64]) {
            for (candidate, cost) in candidates.chunks_exact(self.0).zip(costs) {
                *cost = (self.1)(candidate);
            }
        }
    }
    Pointwise(dimension, cost)
}

/// The methods, each with its settings.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Method {
    /// Flower pollination with t and Gaussian perturbation: the paper's algorithm.
    Tgfpa(Tgfpa),
    /// Flower pollination.
    Fpa(Fpa),
    /// Particle swarm, inertia weight falling linearly.
    Lpso(Lpso),
    /// Particle swarm, inertia weight adapted to each particle's cost.
    Apso(Apso),
}

impl Method {
    /// All of them with their default settings, in the paper's order.
    pub fn all() -> [Self; 4] {
        [Self::Tgfpa(Tgfpa::default()), Self::Fpa(Fpa::default()), Self::Lpso(Lpso::default()), Self::Apso(Apso::default())]
    }

    /// The method of a [`key`](Self::key), with its default settings.
    pub fn named(key: &str) -> Option<Self> {
        Self::all().into_iter().find(|method| method.key() == key)
    }

    /// Name in files and on the command line.
    pub fn key(&self) -> &'static str {
        match self {
            Self::Tgfpa(_) => "tgfpa",
            Self::Fpa(_) => "fpa",
            Self::Lpso(_) => "lpso",
            Self::Apso(_) => "apso",
        }
    }

    /// Name in prose.
    pub fn label(&self) -> &'static str {
        match self {
            Self::Tgfpa(_) => "tGFPA",
            Self::Fpa(_) => "FPA",
            Self::Lpso(_) => "LPSO",
            Self::Apso(_) => "APSO",
        }
    }

    /// Smallest population that the method can work with.
    pub fn min_population(&self) -> usize {
        match self {
            Self::Tgfpa(_) => Tgfpa::MIN_POPULATION,
            Self::Fpa(_) => Fpa::MIN_POPULATION,
            Self::Lpso(_) | Self::Apso(_) => 1,
        }
    }
}

/// How long and from where a search runs.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Settings {
    /// Candidates. 50 in the paper.
    pub population: usize,
    /// Iteration limit. 300 in the paper.
    pub iterations: usize,
    /// Seed of the random numbers.
    pub seed: u64,
    /// Number of this run: its stream of the seed's random numbers.
    pub run: u64,
    /// Stop once the best cost is this close to a known optimum.
    pub close_to_optimum: Option<CloseTo>,
    /// Stop once the best cost is at or below this.
    pub target_cost: Option<f64>,
}

/// A known optimum and what counts as close to it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct CloseTo {
    /// The lowest cost there is.
    pub optimum: f64,
    /// Largest excess over it that is good enough.
    pub tolerance: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Self { population: 50, iterations: 300, seed: 1, run: 0, close_to_optimum: None, target_cost: None }
    }
}

/// Why a search ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum StopReason {
    /// All iterations were run.
    IterationLimit,
    /// The best cost came close enough to the known optimum.
    CloseToOptimum,
    /// The best cost reached the target.
    TargetCost,
    /// Whoever watched had seen enough.
    Interrupted,
}

/// The best so far, after an iteration.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// Iterations done; 0 is the start.
    pub iteration: usize,
    /// Candidates evaluated.
    pub evaluations: u64,
    /// Best cost.
    pub cost: f64,
    /// Its position.
    pub best: Vec<f64>,
}

/// What a search found.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Report {
    /// Best position.
    pub best: Vec<f64>,
    /// Its cost.
    pub cost: f64,
    /// Candidates evaluated.
    pub evaluations: u64,
    /// Why the search ended.
    pub stop_reason: StopReason,
    /// The best after each iteration, the start included.
    pub history: Vec<Record>,
}

/// A search under way.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Optimizer {
    method: Method,
    settings: Settings,
    bounds: Bounds,
    draws: Draws,
    population: Population,
    /// Of the swarms only.
    particles: Option<Particles>,
    iteration: usize,
    history: Vec<Record>,
}

impl Optimizer {
    /// Lays out and evaluates the first population.
    ///
    /// # Errors
    /// If the population is too small for the method, the box has another dimension than the objective, or no candidate of the
    /// start has a finite cost.
    pub fn start(method: Method, settings: Settings, bounds: Bounds, objective: &impl Objective) -> Result<Self, Error> {
        let draws = Draws::seeded(settings.seed, settings.run);
        Self::start_from(method, settings, bounds, draws, objective)
    }

    /// [`start`](Self::start) with random numbers of the caller's.
    ///
    /// # Errors
    /// As [`start`](Self::start).
    pub fn start_from(
        method: Method,
        settings: Settings,
        bounds: Bounds,
        mut draws: Draws,
        objective: &impl Objective,
    ) -> Result<Self, Error> {
        if settings.population < method.min_population() {
            return Err(Error::Population { method: method.label(), given: settings.population, least: method.min_population() });
        }
        if bounds.dimension() != objective.dimension() {
            return Err(Error::Dimension { bounds: bounds.dimension(), objective: objective.dimension() });
        }
        let positions = match &method {
            Method::Tgfpa(tgfpa) => tgfpa.start(settings.population, &bounds, &mut draws),
            _ => bounds.uniform_start(settings.population, &mut draws),
        };
        let population = Population::new(positions, objective);
        if population.best_cost() == WORST_COST {
            return Err(Error::NonFiniteStart { population: settings.population });
        }
        let particles = match &method {
            Method::Lpso(Lpso { flight, .. }) | Method::Apso(Apso { flight, .. }) => {
                Some(Particles::start(flight, &population, &bounds, &mut draws))
            }
            Method::Tgfpa(_) | Method::Fpa(_) => None,
        };
        let mut new = Self { method, settings, bounds, draws, population, particles, iteration: 0, history: Vec::new() };
        new.record();
        Ok(new)
    }

    /// One iteration: propose, evaluate as one batch, accept.
    pub fn step(&mut self, objective: &impl Objective) {
        self.iteration += 1;
        self.propose();
        self.population.evaluate(objective);
        self.accept();
        self.record();
    }

    /// Steps until a criterion stops it.
    pub fn run(&mut self, objective: &impl Objective) -> Report {
        self.run_while(objective, || ControlFlow::Continue(()))
    }

    /// Steps until a criterion stops it, or `go_on`, asked after each iteration, does. What was interrupted can be run on.
    pub fn run_while(&mut self, objective: &impl Objective, mut go_on: impl FnMut() -> ControlFlow<()>) -> Report {
        let stop_reason = loop {
            if let Some(reason) = self.stop_reason() {
                break reason;
            }
            self.step(objective);
            if go_on().is_break() {
                break self.stop_reason().unwrap_or(StopReason::Interrupted);
            }
        };
        Report {
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

    fn propose(&mut self) {
        let Self { method, settings, bounds, draws, population, particles, iteration, .. } = self;
        match (&*method, particles) {
            (Method::Tgfpa(tgfpa), _) => tgfpa.propose(*iteration, population, bounds, draws),
            (Method::Fpa(fpa), _) => fpa.propose(population, bounds, draws),
            (Method::Lpso(lpso), Some(particles)) => {
                let inertia = lpso.inertia(*iteration, settings.iterations);
                particles.propose(&lpso.flight, |_| inertia, population, bounds, draws);
            }
            (Method::Apso(apso), Some(particles)) => {
                let costs = population.costs().to_vec();
                let inertia = apso.inertia(&costs);
                particles.propose(&apso.flight, |i| inertia(costs[i]), population, bounds, draws);
            }
            (Method::Lpso(_) | Method::Apso(_), None) => {}
        }
    }

    fn accept(&mut self) {
        match &mut self.particles {
            None => self.population.accept_better(),
            Some(particles) => {
                self.population.accept_all();
                particles.remember(&self.population);
            }
        }
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
