//! A tracker whose state is told at a rate in the log's time.

use crate::error::CommandError;
use fluxfit::log::Row;
use fluxfit_track::{Thermometer, Tracker, document::TrackDocument};

/// A tracker, a thermometer beside it, and when the state is told.
pub(crate) struct Tracking {
    pub(crate) tracker: Tracker,
    pub(crate) thermometer: Option<Thermometer>,
    every: f64,
    /// Number of the interval in which the state was told last.
    told: Option<f64>,
}

impl Tracking {
    /// The state is told every so many seconds.
    pub(crate) fn new(tracker: Tracker, thermometer: Option<Thermometer>, every: f64) -> Self {
        Self { tracker, thermometer, every, told: None }
    }

    /// Takes a row. Whether the state is due to be told.
    ///
    /// # Errors
    /// If the row has no angle, and the faults of the drive need one.
    pub(crate) fn take(&mut self, row: &Row) -> Result<bool, CommandError> {
        if row.theta_e.is_none() && self.tracker.settings().faults.need_angle() {
            let sentence = "--faults: dead time and sensor offsets stand still in the stator, so each row needs the electrical angle; add a column theta_e, or leave --faults out";
            return Err(CommandError::Usage(sentence.to_owned()));
        }
        self.tracker.push_in_time(row);
        // A sample at a multiple of the interval belongs to it, whatever the rounding.
        let interval = (self.tracker.time() / self.every + 1e-9).floor();
        let is_due = self.told.is_none_or(|told| told != interval);
        self.told = Some(interval);
        if let Some(thermometer) = self.thermometer.as_mut().filter(|_| is_due) {
            thermometer.note(self.tracker.time(), &self.tracker.parameters_or_nothing());
        }
        Ok(is_due)
    }

    /// The stream has ended: the estimator takes what it has not taken yet.
    pub(crate) fn end(&mut self) {
        self.tracker.catch_up();
    }

    /// What is known now; `last` at the end.
    pub(crate) fn document(&self, last: bool) -> TrackDocument {
        TrackDocument::of(&self.tracker, self.thermometer.as_ref(), last)
    }
}
