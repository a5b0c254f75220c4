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
    /// The first events, until the estimator has taken all of them.
    lead_in: Option<LeadIn>,
    estimator: Option<Estimator>,
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

    /// The estimator, once it has taken all rows so far.
    pub(crate) fn estimator(&self) -> Option<&Estimator> {
        self.estimator.as_ref().filter(|_| self.lead_in.is_none())
    }

    /// The filter whose likelihood counts, once it runs.
    pub(crate) fn filter(&self) -> Option<&WatchedEkf> {
        match self.racer.as_ref().or(self.estimator.as_ref()) {
            Some(Estimator::Ekf(filter)) => Some(filter),
            _ => None,
        }
    }

    /// Takes a row, and replays at most so many events of the lead-in. What it told, if it ends a period and a filter runs that can tell.
    pub(crate) fn push(&mut self, row: &Row, method: Method, start: &Start, is_racing: bool, most: usize) -> Option<Told> {
        let event = self.stream.push(row)?;
        let Some(lead_in) = &mut self.lead_in else {
            [&mut self.estimator, &mut self.racer].into_iter().flatten().for_each(|estimator| estimator.take(&event));
            let filter = self.filter().filter(|_| matches!(event, Event::Period(..)))?;
            return Some(Told { surprise: filter.filter().last_surprise(), is_settled: filter.is_settled() });
        };
        lead_in.keep(event);
        if self.estimator.is_none() {
            let beginning = beginning(lead_in, self.stream.largest(), start)?;
            self.racer = (is_racing && !method.has_likelihood()).then(|| Estimator::new(Method::Ekf, &beginning));
            self.estimator = Some(Estimator::new(method, &beginning));
        }
        self.replay(most);
        None
    }

    /// Replays at most so many events of the lead-in to an estimator that has begun.
    pub(crate) fn replay(&mut self, most: usize) {
        let Self { lead_in: Some(lead_in), estimator: Some(estimator), racer, .. } = self else { return };
        for event in lead_in.replay(most) {
            estimator.take(event);
            if let Some(racer) = racer {
                racer.take(event);
            }
        }
        if lead_in.is_over() {
            self.lead_in = None;
        }
    }

    /// Goes on alone.
    pub(crate) fn win(&mut self) {
        self.racer = None;
    }
}

/// What an estimator begins with, if it is time to begin; `largest` current, A, voltage, V, and speed. Without anything to begin with, it
/// waits for the motor to run.
fn beginning(lead_in: &mut LeadIn, largest: [f64; 3], start: &Start) -> Option<Beginning> {
    if !lead_in.is_due() {
        return None;
    }
    let (seed, is_found) = lead_in.values(start, largest);
    let is_given: [bool; PARAMETERS] = std::array::from_fn(|j| start.values[j].is_some());
    (is_found.contains(&true) || is_given == [true; PARAMETERS] || lead_in.is_full()).then(|| Beginning {
        start: *start,
        nominal: std::array::from_fn(|j| start.values[j].filter(|value| *value > 0.0).unwrap_or(seed[j])),
        seed,
        is_guessed: std::array::from_fn(|j| !is_found[j] && !is_given[j]),
        scale: [largest[0], largest[1], lead_in.noise()],
    })
}
