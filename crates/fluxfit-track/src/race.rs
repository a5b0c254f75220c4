//! Which of several timings of the voltages is right: the one with which the measured currents are most likely.
//!
//! Not every period is compared. A filter that starts with a wrong inductance is surprised by the first steps of the current, and by its
//! own noise's variance until that has adapted, by more than a wrong timing ever is; and each timing starts with other values. At first the
//! wrong timing won for this reason alone. So periods count where all filters are settled and the samples excite the parameters, and the
//! comparison begins anew where a filter comes to know a parameter.
//!
//! While a wrong timing may still be the right one, the intervals hold those of all timings that are in question.

use crate::{
    ekf::WatchedEkf,
    estimate::Estimate,
    lane::{Lane, Told},
    method::Estimator,
    verdict::HALF_WIDTH95,
};
use fluxfit::motor::PARAMETERS;
use fluxfit_core::SURPRISE_MEMORY;
use serde::{Deserialize, Serialize};

/// Time that is compared before a timing is given up, s.
const EARLIEST_CHOICE: f64 = 0.5;

/// Time that is compared after which the best timing is taken in any case, s.
const LATEST_CHOICE: f64 = 5.0;

/// By how much minus twice the log-likelihood of the best timing must be less than that of another: far beyond chance.
const CLEAR: f64 = 100.0;

/// The comparison.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Race {
    /// Time that was compared, s.
    compared: f64,
    /// Of a timing that was taken though another was as likely: by how much the standard errors grow for it, as parts of the values.
    doubt: Option<[f64; PARAMETERS]>,
}

impl Race {
    /// What a row told about each timing. Only rows that all of them used are compared: a timing that loses more rows after a gap is no
    /// less likely for it.
    pub(crate) fn note(&mut self, lanes: &mut [Lane], told: &[Option<Told>]) {
        let told = told.iter().flatten();
        if told.clone().count() < lanes.len() {
            return;
        }
        let is_settled = told.clone().all(|told| told.is_settled);
        // Until then all rows count for the order, and for nothing else.
        if !is_settled && self.compared > 0.0 {
            return;
        }
        if is_settled {
            if self.compared == 0.0 {
                lanes.iter_mut().for_each(|lane| lane.surprise = 0.0);
            }
            self.compared += lanes[0].stream.usual_period();
        }
        for (lane, told) in lanes.iter_mut().zip(told) {
            lane.surprise += told.surprise - lane.surprise / f64::from(SURPRISE_MEMORY);
        }
    }

    /// Puts the most likely timing first, and gives up those of which it is clear that they are wrong.
    pub(crate) fn decide(&mut self, lanes: &mut Vec<Lane>) {
        if !lanes.iter().all(|lane| lane.estimator().is_some()) {
            return;
        }
        let mut is_new = false;
        for lane in lanes.iter_mut() {
            let known = lane.filter().map_or(0, WatchedEkf::known);
            is_new |= known != lane.known;
            lane.known = known;
        }
        if is_new {
            lanes.iter_mut().for_each(|lane| lane.surprise = 0.0);
            self.compared = 0.0;
        }
        lanes.sort_by(|a, b| a.surprise.total_cmp(&b.surprise));
        if self.compared < EARLIEST_CHOICE {
            return;
        }
        let best = lanes[0].surprise;
        lanes.retain(|lane| lane.surprise - best <= CLEAR);
        if self.compared > LATEST_CHOICE {
            self.doubt = (lanes.len() > 1).then(|| self.growth(lanes));
            lanes.truncate(1);
        }
        if lanes.len() == 1 {
            lanes[0].win();
        }
    }

    /// Whether the timing is known.
    pub(crate) fn is_settled(&self, lanes: &[Lane]) -> bool {
        lanes.len() == 1 && self.doubt.is_none()
    }

    /// What the most likely timing's estimator knows, with standard errors so large that the intervals hold those of the others.
    pub(crate) fn estimate(&self, lanes: &[Lane]) -> Option<Estimate> {
        let mut estimate = lanes[0].estimator()?.estimate();
        let growth = self.doubt.unwrap_or_else(|| self.growth(lanes));
        if let Some(errors) = &mut estimate.standard_errors {
            for j in 0..PARAMETERS {
                errors[j] += growth[j] * estimate.values[j].abs();
            }
        }
        Some(estimate)
    }

    /// By how much the standard errors of the first timing must grow for that, as parts of its values: only what both determine can differ.
    fn growth(&self, lanes: &[Lane]) -> [f64; PARAMETERS] {
        let mut growth = [0.0_f64; PARAMETERS];
        let known = |lane: &Lane| lane.estimator().map(Estimator::estimate);
        let Some(Estimate { values: best, standard_errors: Some(best_errors), .. }) = known(&lanes[0]) else { return growth };
        let in_question = lanes[1..].iter().filter(|lane| self.compared == 0.0 || lane.surprise - lanes[0].surprise <= CLEAR);
        for other in in_question.filter_map(known) {
            let (Some(errors), Some(identifiable)) = (other.standard_errors, other.identifiable) else { continue };
            for j in (0..PARAMETERS).filter(|j| identifiable[*j]) {
                let beyond = (other.values[j] - best[j]).abs() / HALF_WIDTH95 + errors[j] - best_errors[j];
                growth[j] = growth[j].max(beyond / best[j].abs());
            }
        }
        growth
    }
}
