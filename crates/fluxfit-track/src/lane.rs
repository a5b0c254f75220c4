//! One timing of the voltages, and what follows from it: periods, a lead-in, an estimator.

use crate::{
    ekf::WatchedEkf,
    faults::DriveFaults,
    lead_in::LeadIn,
    method::{Beginning, Estimator, Method},
    start::Start,
    stream::{Event, Stream},
    timing::Timing,
};
use fluxfit::{log::Row, motor::PARAMETERS};
use serde::{Deserialize, Serialize};

/// The timing, and what follows from it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Lane {
    pub(crate) stream: Stream,
    lead_in: Option<LeadIn>,
    pub(crate) estimator: Option<Estimator>,
    /// Beside an estimator without a likelihood, while timings are in question: a Kalman filter, which has one.
    racer: Option<Estimator>,
    /// Minus twice the log-likelihood of the periods that are compared, but for a constant.
    pub(crate) surprise: f64,
    /// Parameters that its filter has come to know, when the comparison began.
    pub(crate) known: u32,
}

/// What a row told about a timing.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Told {
    /// Minus twice the logarithm of how likely its currents were, but for a constant.
    pub(crate) surprise: f64,
    /// Whether this is the doing of the timing, and not of how the filter began.
    pub(crate) is_settled: bool,
}

impl Lane {
    pub(crate) fn new(timing: Timing, faults: DriveFaults) -> Self {
        Self { stream: Stream::new(timing, faults), lead_in: Some(LeadIn::new()), estimator: None, racer: None, surprise: 0.0, known: 0 }
    }

    /// The filter whose likelihood counts, once it runs.
    pub(crate) fn filter(&self) -> Option<&WatchedEkf> {
        match self.racer.as_ref().or(self.estimator.as_ref()) {
            Some(Estimator::Ekf(filter)) => Some(filter),
            _ => None,
        }
    }

    /// Takes a row. What it told, if it ends a period and a filter runs that can tell.
    pub(crate) fn push(&mut self, row: &Row, method: Method, start: &Start, is_racing: bool) -> Option<Told> {
        let event = self.stream.push(row)?;
        if let Some(estimator) = &mut self.estimator {
            estimator.take(&event);
            if let Some(racer) = &mut self.racer {
                racer.take(&event);
            }
        } else if let Some(lead_in) = &mut self.lead_in
            && lead_in.keep(event)
        {
            let largest = self.stream.largest();
            let (seed, is_found) = lead_in.values(start, largest);
            let is_given: [bool; PARAMETERS] = std::array::from_fn(|j| start.values[j].is_some());
            // Without anything to begin with, it waits for the motor to run.
            if is_found.contains(&true) || is_given == [true; PARAMETERS] || lead_in.is_full() {
                let beginning = Beginning {
                    start: *start,
                    nominal: std::array::from_fn(|j| start.values[j].filter(|value| *value > 0.0).unwrap_or(seed[j])),
                    seed,
                    is_guessed: std::array::from_fn(|j| !is_found[j] && !is_given[j]),
                    scale: [largest[0], largest[1], lead_in.noise()],
                };
                let run = |method| {
                    let mut estimator = Estimator::new(method, &beginning);
                    lead_in.events().iter().for_each(|event| estimator.take(event));
                    estimator
                };
                self.racer = (is_racing && !method.has_likelihood()).then(|| run(Method::Ekf));
                self.estimator = Some(run(method));
                self.lead_in = None;
            }
        }
        let filter = self.filter().filter(|_| matches!(event, Event::Period(..)))?;
        Some(Told { surprise: filter.filter().last_surprise(), is_settled: filter.is_settled() })
    }

    /// Goes on alone.
    pub(crate) fn win(&mut self) {
        self.racer = None;
    }
}
