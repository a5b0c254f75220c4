//! The whole: rows in, what is known of the motor out.
//!
//! ```text
//! rows -> periods (one stream for each voltage timing in question) -> lead-in -> estimator -> verdicts
//! ```
//!
//! Nothing is allocated after the lead-in but for a timing that is given up. A tracker that is saved and resumed goes on to the same bits.

use crate::{
    lead_in::LeadIn,
    method::{Estimator, Method},
    start::{Start, guessed},
    stream::{LeftOut, Stream},
    timing::Timing,
    verdict::{Excitation, Tracked},
};
use fluxfit::{log::Row, motor::PARAMETERS};
use serde::{Deserialize, Serialize};

/// Time after which a timing that explains the currents better is taken, s.
const EARLIEST_CHOICE: f64 = 0.5;

/// Time after which the best timing is taken in any case, s.
const LATEST_CHOICE: f64 = 5.0;

/// Rows between two looks at the timings.
const RACE: u64 = 64;

/// By how much minus twice the log-likelihood of the best timing must be less than that of any other: far beyond chance.
const CLEAR: f64 = 100.0;

/// What is asked of a tracker.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct TrackSettings {
    /// Which estimator.
    pub method: Method,
    /// When the voltages act; none: the stream decides among the usual timings.
    pub timing: Option<Timing>,
    /// What is known beforehand.
    pub start: Start,
}

/// One reading of the voltages, and what follows from it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Lane {
    stream: Stream,
    lead_in: Option<LeadIn>,
    estimator: Option<Estimator>,
}

/// The tracker.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Tracker {
    settings: TrackSettings,
    lanes: Vec<Lane>,
    t: f64,
    /// Time since all timings in question have run.
    raced: f64,
    rows: u64,
    excitation: Excitation,
}

impl Lane {
    fn new(timing: Timing) -> Self {
        Self { stream: Stream::new(timing), lead_in: Some(LeadIn::new()), estimator: None }
    }

    fn push(&mut self, row: &Row, method: Method, start: &Start) {
        let Some(event) = self.stream.push(row) else { return };
        if let Some(estimator) = &mut self.estimator {
            estimator.take(&event);
        } else if let Some(lead_in) = &mut self.lead_in
            && lead_in.keep(event)
        {
            let largest = self.stream.largest();
            let (seed, is_found) = lead_in.values(start, largest);
            let is_given = start.values.iter().all(Option::is_some);
            // Without anything to begin with, it waits for the motor to run.
            if is_found || is_given || lead_in.is_full() {
                let guessed = guessed(largest);
                let nominal = std::array::from_fn(|j| start.values[j].filter(|value| *value > 0.0).unwrap_or(if is_found { seed[j] } else { guessed[j] }));
                let mut estimator = Estimator::new(method, start, nominal, seed, [largest[0], largest[1]]);
                lead_in.events().iter().for_each(|event| estimator.take(event));
                self.estimator = Some(estimator);
                self.lead_in = None;
            }
        }
    }

    fn surprise(&self) -> Option<f64> {
        match self.estimator.as_ref()? {
            Estimator::Ekf(filter) => Some(filter.filter().surprise()),
            Estimator::Rls(_) => None,
        }
    }
}

impl Tracker {
    /// A tracker before its first row.
    pub fn new(settings: TrackSettings) -> Self {
        let lanes = match settings.timing {
            Some(timing) => vec![Lane::new(timing)],
            None => Timing::USUAL.map(Lane::new).to_vec(),
        };
        Self { settings, lanes, t: 0.0, raced: 0.0, rows: 0, excitation: Excitation::default() }
    }

    /// Takes a row.
    pub fn push(&mut self, row: &Row) {
        self.rows += 1;
        let is_racing = self.lanes.len() > 1;
        // Only the likelihood of a Kalman filter tells which timing is right.
        let method = if is_racing { self.racing_method() } else { self.settings.method };
        for lane in &mut self.lanes {
            lane.push(row, method, &self.settings.start);
        }
        if row.t.is_finite() {
            self.t = row.t;
        }
        if is_racing && self.rows.is_multiple_of(RACE) {
            self.race();
        }
        if let Some(estimator) = &self.lanes[0].estimator {
            self.excitation.note(self.t, estimator.is_excited());
        }
    }

    fn racing_method(&self) -> Method {
        match self.settings.method {
            Method::EkfTracking | Method::Ekf => self.settings.method,
            Method::Rls => Method::Ekf,
        }
    }

    /// Puts the most likely timing first, and gives the others up when it is clear.
    fn race(&mut self) {
        if !self.lanes.iter().all(|lane| lane.estimator.is_some()) {
            return;
        }
        self.lanes.sort_by(|a, b| {
            let [a, b] = [a, b].map(|lane| lane.surprise().unwrap_or(f64::INFINITY));
            a.total_cmp(&b)
        });
        self.raced += RACE as f64 * self.lanes[0].stream.usual_period();
        let margin = self.lanes[1].surprise().zip(self.lanes[0].surprise()).map_or(0.0, |(second, first)| second - first);
        if self.raced > EARLIEST_CHOICE && margin > CLEAR || self.raced > LATEST_CHOICE {
            self.lanes.truncate(1);
            if self.racing_method() != self.settings.method {
                (self.lanes[0].estimator, self.lanes[0].lead_in) = (None, Some(LeadIn::new()));
            }
        }
    }

    /// Time of the last row, s.
    pub fn time(&self) -> f64 {
        self.t
    }

    /// Rows so far, with those that were left out.
    pub fn rows(&self) -> u64 {
        self.rows
    }

    /// What was asked.
    pub fn settings(&self) -> &TrackSettings {
        &self.settings
    }

    /// When the voltages act, and whether that is settled.
    pub fn timing(&self) -> (Timing, bool) {
        (self.lanes[0].stream.timing(), self.lanes.len() == 1)
    }

    /// Rows that were left out.
    pub fn left_out(&self) -> LeftOut {
        self.lanes[0].stream.left_out()
    }

    /// The estimator; none during the lead-in.
    pub fn estimator(&self) -> Option<&Estimator> {
        self.lanes[0].estimator.as_ref()
    }

    /// What may be said of rs, ld, lq and psi_f now; nothing during the lead-in.
    pub fn parameters(&self) -> Option<[Tracked; PARAMETERS]> {
        let estimator = self.lanes[0].estimator.as_ref()?;
        Some(self.excitation.judge(&estimator.estimate()))
    }
}
