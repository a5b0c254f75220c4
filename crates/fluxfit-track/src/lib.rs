//! Follows R_s, L_d, L_q and psi_f of a running motor: rows of a log as they arrive, values with intervals and verdicts at any time.
//!
//! ```
//! use fluxfit::{Motor, frames::Dq, log::Row};
//! use fluxfit_track::{Method, TrackSettings, Tracker};
//!
//! let mut tracker = Tracker::new(TrackSettings::new(Method::EkfTracking, None));
//! tracker.push(&Row { t: 0.0, ud: 0.0, uq: 1.0, id: 0.0, iq: 0.1, omega_e: 5.0, ..Row::default() });
//! assert!(tracker.parameters().is_none()); // Too few rows yet.
//! ```
//!
//! | file | concept |
//! |---|---|
//! | [`tracker`] | the whole: rows in, what is known of the motor out |
//! | [`timing`], [`stream`], `alternation` | rows become periods: voltage timing, gaps, garbage; the first voltage of a stretch |
//! | `lane`, `race` | what follows from one timing of the voltages; which timing is right |
//! | [`faults`] | faults of the drive that are known |
//! | [`start`], [`lead_in`] | what is known before the first sample; the first samples |
//! | [`method`] | the estimators, as one choice |
//! | [`ekf`], [`rls`], [`forgetting`], [`instrumental_variable`], [`bias_compensated`], [`mras`], [`adaline`] | one estimator each |
//! | [`bank`] | filters with different settings on the same samples, side by side |
//! | [`comparison`] | all estimators on one log |
//! | [`temperature`], [`document`] | temperatures of winding and magnets; the JSON document |
//! | [`estimate`], [`verdict`] | what an estimator says; what may be said of a parameter |
#![allow(clippy::needless_range_loop, reason = "the formulas of matrices have indices")]

pub mod adaline;
mod alternation;
pub mod bank;
pub mod bias_compensated;
mod cholesky;
pub mod comparison;
pub mod document;
pub mod ekf;
pub mod estimate;
pub mod faults;
pub mod forgetting;
pub mod instrumental_variable;
mod lane;
pub mod lead_in;
pub mod method;
pub mod mras;
mod race;
pub mod rls;
pub mod start;
pub mod stream;
pub mod temperature;
pub mod timing;
pub mod tracker;
pub mod verdict;

pub use estimate::Estimate;
pub use faults::DriveFaults;
pub use method::{Beginning, Estimator, Method};
pub use start::Start;
pub use stream::{Event, LeftOut, Stream};
pub use temperature::Thermometer;
pub use timing::Timing;
pub use tracker::{TrackSettings, Tracker};
pub use verdict::{Tracked, Verdict};
