//! The first 0.15 s of a stream: kept until block least squares has found values to begin with, then replayed to the estimator.
//!
//! A row that replays all of them takes some ten milliseconds, and a stream has to wait. So each later row replays only a few, and is kept
//! until those before it are done.

use crate::{
    rls::{Form, Rls},
    start::{Start, guessed},
    stream::Event,
};
use fluxfit::motor::PARAMETERS;
use serde::{Deserialize, Serialize};

/// Length, s.
pub const LEAD_IN: f64 = 0.15;

/// Fewest periods, so that block least squares has several blocks of a slow log too.
const FEWEST: usize = 500;

/// Most periods that are kept: half a minute of a log of 1 kHz, a tenth of a second of one of 200 kHz.
const MOST: usize = 20_000;

/// If the samples do not tell a value, they are looked at again when there are more of them by this part. A motor may stand still for long,
/// and each look takes all samples.
const GROWTH: f64 = 0.05;

/// Largest relative standard error with which a value of least squares is one to begin with.
const STARTS: f64 = 0.3;

/// The first samples.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct LeadIn {
    events: Vec<Event>,
    elapsed: f64,
    /// Events at which the next look is due.
    enough: usize,
    /// Events that the estimator has taken.
    replayed: usize,
}

impl LeadIn {
    pub(crate) fn new() -> Self {
        Self { events: Vec::with_capacity(MOST), elapsed: 0.0, enough: FEWEST, replayed: 0 }
    }

    /// Keeps an event.
    pub(crate) fn keep(&mut self, event: Event) {
        if let Event::Period(period, _) = event {
            self.elapsed += period.length;
        }
        self.events.push(event);
    }

    /// Whether a look for values to begin with is due. The next one is due when there are some more events.
    pub(crate) fn is_due(&mut self) -> bool {
        let is_due = self.elapsed >= LEAD_IN && self.events.len() >= self.enough || self.is_full();
        if is_due {
            self.enough = self.events.len() + (GROWTH * self.events.len() as f64) as usize;
        }
        is_due
    }

    /// The next events for the estimator, at most so many.
    pub(crate) fn replay(&mut self, most: usize) -> &[Event] {
        let first = self.replayed;
        self.replayed = first.saturating_add(most).min(self.events.len());
        &self.events[first..self.replayed]
    }

    /// Whether the estimator has taken all events.
    pub(crate) fn is_over(&self) -> bool {
        self.replayed == self.events.len()
    }

    /// Whether no more can be kept.
    pub(crate) fn is_full(&self) -> bool {
        self.events.len() >= MOST
    }

    /// Standard deviation of the noise of each current, A, from their second differences, in which changes of the current count as noise.
    pub(crate) fn noise(&self) -> f64 {
        let current = |event: &Event| match event {
            Event::Begin(i) | Event::Period(_, i) => *i,
        };
        let second = |three: &[Event]| -> f64 {
            let [a, b, c] = [0, 1, 2].map(|k| current(&three[k]));
            (0..2).map(|axis| (a[axis] - 2.0 * b[axis] + c[axis]).powi(2)).sum()
        };
        let within = |three: &&[Event]| !three[1..].iter().any(|event| matches!(event, Event::Begin(_)));
        let (mut sum, mut count) = (0.0, 0.0);
        for three in self.events.windows(3).filter(within) {
            sum += second(three);
            count += 2.0;
        }
        // 1 + 4 + 1 times the variance of one sample.
        if count > 0.0 { (sum / count / 6.0_f64).sqrt() } else { 0.0 }
    }

    /// Values to begin with, and which of them come from the samples: from least squares where it tells them, else those that
    /// were given, else guesses from the largest current, A, voltage, V, and speed.
    pub(crate) fn values(&self, start: &Start, largest: [f64; 3]) -> ([f64; PARAMETERS], [bool; PARAMETERS]) {
        let guessed = guessed(largest);
        let nominal: [f64; PARAMETERS] = std::array::from_fn(|j| start.values[j].filter(|value| *value > 0.0).unwrap_or(guessed[j]));
        let mut rls = Rls::new(start, nominal, Form::Constant);
        for event in &self.events {
            match event {
                Event::Begin(i) => rls.begin(*i),
                Event::Period(period, i) => {
                    rls.advance(period, *i);
                }
            }
        }
        let found = rls.estimate();
        let errors = found.standard_errors.unwrap_or([f64::INFINITY; PARAMETERS]);
        let is_found = |j: usize| found.values[j] > 0.0 && errors[j] < STARTS * found.values[j];
        let values = std::array::from_fn(|j| if is_found(j) { found.values[j] } else { nominal[j] });
        (values, std::array::from_fn(is_found))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fluxfit_core::Period;

    /// A look takes all samples of a motor that stands still: there must be few looks.
    #[test]
    fn what_tells_nothing_is_looked_at_seldom() {
        let mut lead_in = LeadIn::new();
        let period = Period { u: [0.0; 2], omega_e: 0.0, length: 1e-4 };
        let mut looked_at = 0;
        while !lead_in.is_full() {
            lead_in.keep(Event::Period(period, [0.0; 2]));
            if lead_in.is_due() {
                looked_at += lead_in.events.len();
            }
        }
        // A geometric series: at most 1 / GROWTH + 1 times the last look, and the end.
        assert!(looked_at as f64 <= (1.0 / GROWTH + 2.0) * MOST as f64, "{looked_at}");
    }
}
