//! The whole: rows in, what is known of the motor out.
//!
//! ```text
//! rows -> periods (one stream for each voltage timing in question) -> lead-in -> estimator -> verdicts
//! ```
//!
//! Nothing is allocated after the lead-in but for a timing that is given up. A tracker that is saved and resumed goes on to the same bits.

use crate::{
    faults::DriveFaults,
    lead_in::LeadIn,
    method::{Beginning, Estimator, Method},
    start::Start,
    stream::{Event, LeftOut, Stream},
    timing::Timing,
    verdict::{Excitation, Tracked, Verdict},
};
use fluxfit::{log::Row, motor::PARAMETERS};
use serde::{Deserialize, Serialize};

/// Time after which a timing that explains the currents better is taken, s.
const EARLIEST_CHOICE: f64 = 0.5;

/// Time after which the best timing is taken in any case, s.
const LATEST_CHOICE: f64 = 5.0;

/// Rows between two looks at the timings.
const RACE: u64 = 64;

/// Periods over which the likelihood of a timing is remembered: a filter that started badly must not decide for ever.
const SURPRISE_MEMORY: f64 = 2e4;

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
    /// Faults of the drive that are known.
    #[serde(default)]
    pub faults: DriveFaults,
}

impl TrackSettings {
    /// Of a motor of which nothing is known, in a drive without faults.
    pub fn new(method: Method, timing: Option<Timing>) -> Self {
        Self { method, timing, start: Start::default(), faults: DriveFaults::default() }
    }
}

/// One reading of the voltages, and what follows from it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Lane {
    stream: Stream,
    lead_in: Option<LeadIn>,
    estimator: Option<Estimator>,
    /// Beside an estimator without a likelihood, while timings are in question: a Kalman filter, which has one.
    racer: Option<Estimator>,
    /// Minus twice the log-likelihood of the last periods, but for a constant.
    surprise: f64,
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
    fn new(timing: Timing, faults: DriveFaults) -> Self {
        Self { stream: Stream::new(timing, faults), lead_in: Some(LeadIn::new()), estimator: None, racer: None, surprise: 0.0 }
    }

    /// Takes a row. How unlikely its currents were, if it ends a period and a filter runs that can tell.
    fn push(&mut self, row: &Row, method: Method, start: &Start, is_racing: bool) -> Option<f64> {
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
        match self.racer.as_ref().or(self.estimator.as_ref()) {
            Some(Estimator::Ekf(filter)) if matches!(event, Event::Period(..)) => Some(filter.filter().last_surprise()),
            _ => None,
        }
    }
}

impl Tracker {
    /// A tracker before its first row.
    pub fn new(settings: TrackSettings) -> Self {
        let lanes = match settings.timing {
            Some(timing) => vec![Lane::new(timing, settings.faults)],
            None => Timing::USUAL.map(|timing| Lane::new(timing, settings.faults)).to_vec(),
        };
        Self { settings, lanes, t: 0.0, raced: 0.0, rows: 0, excitation: Excitation::default() }
    }

    /// Takes a row.
    pub fn push(&mut self, row: &Row) {
        self.rows += 1;
        let is_racing = self.lanes.len() > 1;
        let Self { lanes, settings, .. } = self;
        let mut surprises = [None; Timing::USUAL.len()];
        for (lane, surprise) in lanes.iter_mut().zip(&mut surprises) {
            *surprise = lane.push(row, settings.method, &settings.start, is_racing);
        }
        // Only rows that all of them used are compared: a timing that loses more rows after a gap is no less likely for it.
        if is_racing && surprises[..lanes.len()].iter().all(Option::is_some) {
            for (lane, surprise) in lanes.iter_mut().zip(surprises.into_iter().flatten()) {
                lane.surprise += surprise - lane.surprise / SURPRISE_MEMORY;
            }
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

    /// Puts the most likely timing first, and gives the others up when it is clear.
    fn race(&mut self) {
        if !self.lanes.iter().all(|lane| lane.estimator.is_some()) {
            return;
        }
        self.lanes.sort_by(|a, b| a.surprise.total_cmp(&b.surprise));
        self.raced += RACE as f64 * self.lanes[0].stream.usual_period();
        let margin = self.lanes[1].surprise - self.lanes[0].surprise;
        if self.raced > EARLIEST_CHOICE && margin > CLEAR || self.raced > LATEST_CHOICE {
            self.lanes.truncate(1);
            self.lanes[0].racer = None;
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

    /// The same, as not identifiable during the lead-in.
    pub fn parameters_or_nothing(&self) -> [Tracked; PARAMETERS] {
        let nothing = Tracked { value: None, standard_error: None, verdict: Verdict::NotIdentifiable };
        self.parameters().unwrap_or([nothing; PARAMETERS])
    }

    /// Steps of parameters that were found.
    pub fn steps(&self) -> u32 {
        match self.estimator() {
            Some(Estimator::Ekf(filter)) => filter.steps(),
            _ => 0,
        }
    }
}
