//! The whole: rows in, what is known of the motor out.
//!
//! ```text
//! rows -> periods (one stream for each voltage timing in question) -> lead-in -> estimator -> verdicts
//! ```
//!
//! Nothing is allocated after the lead-in but for a timing that is given up. A tracker that is saved and resumed goes on to the same bits.

use crate::{
    faults::DriveFaults,
    lane::Lane,
    method::{Estimator, Method},
    race::Race,
    start::Start,
    stream::LeftOut,
    timing::Timing,
    verdict::{Excitation, Tracked, Verdict},
};
use fluxfit::{log::Row, motor::PARAMETERS};
use serde::{Deserialize, Serialize};

/// Rows between two looks at the timings.
const RACE: u64 = 64;

/// Events of the lead-in that a row of a stream replays: so few that estimators of four timings keep up with rows of 10 kHz.
const REPLAYED: usize = 3;

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

/// The tracker.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Tracker {
    settings: TrackSettings,
    lanes: Vec<Lane>,
    t: f64,
    race: Race,
    rows: u64,
    excitation: Excitation,
}

impl Tracker {
    /// A tracker before its first row.
    pub fn new(settings: TrackSettings) -> Self {
        let lanes = match settings.timing {
            Some(timing) => vec![Lane::new(timing, settings.faults)],
            None => Timing::USUAL.map(|timing| Lane::new(timing, settings.faults)).to_vec(),
        };
        Self { settings, lanes, t: 0.0, race: Race::default(), rows: 0, excitation: Excitation::default() }
    }

    /// Takes a row.
    pub fn push(&mut self, row: &Row) {
        self.take(row, usize::MAX);
    }

    /// Takes a row of a stream that must not wait. After the first 0.15 s each row replays a few of the first ones to the estimator, and
    /// nothing is told for another 0.08 s, or until [`catch_up`](Self::catch_up), which belongs at the end of a stream.
    pub fn push_in_time(&mut self, row: &Row) {
        self.take(row, REPLAYED);
    }

    /// Replays all that the estimator has not taken yet.
    pub fn catch_up(&mut self) {
        self.lanes.iter_mut().for_each(|lane| lane.replay(usize::MAX));
    }

    fn take(&mut self, row: &Row, most: usize) {
        self.rows += 1;
        let is_racing = self.lanes.len() > 1;
        let Self { lanes, settings, race, .. } = self;
        let mut told = [None; Timing::USUAL.len()];
        for (lane, told) in lanes.iter_mut().zip(&mut told) {
            *told = lane.push(row, settings.method, &settings.start, is_racing, most);
        }
        if is_racing {
            race.note(lanes, &told);
        }
        if row.t.is_finite() {
            self.t = row.t;
        }
        if is_racing && self.rows.is_multiple_of(RACE) {
            race.decide(lanes);
        }
        if let Some(estimator) = self.lanes[0].estimator() {
            self.excitation.note(self.t, estimator.is_excited());
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
        (self.lanes[0].stream.timing(), self.race.is_settled(&self.lanes))
    }

    /// Rows that were left out.
    pub fn left_out(&self) -> LeftOut {
        self.lanes[0].stream.left_out()
    }

    /// The estimator; none during the lead-in.
    pub fn estimator(&self) -> Option<&Estimator> {
        self.lanes[0].estimator()
    }

    /// What may be said of rs, ld, lq and psi_f now; nothing during the lead-in.
    pub fn parameters(&self) -> Option<[Tracked; PARAMETERS]> {
        Some(self.excitation.judge(&self.race.estimate(&self.lanes)?))
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
