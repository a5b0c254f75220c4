//! Finds the electrical parameters of a permanent magnet synchronous motor from a log of its drive: stator resistance, two
//! inductances, magnet flux; each with an interval and a verdict, or a reason why the log cannot tell it.
//!
//! ```
//! use fluxfit::{Columns, Log, Motor, Request, frames::Dq, identify};
//!
//! // A log of 200 rows at two operating points; yours comes from a drive.
//! let motor = Motor { rs: 0.958, ld: 5.25e-3, lq: 12e-3, psi_f: 0.1827 };
//! let mut columns = Columns::default();
//! for row in 0..200 {
//!     let i = if row < 100 { Dq { d: 0.0, q: 9.0 } } else { Dq { d: -2.0, q: 8.5 } };
//!     let u = motor.steady_voltage(i, 400.0);
//!     columns.t.push(row as f64 * 1e-3);
//!     (columns.ud.push(u.d), columns.uq.push(u.q), columns.id.push(i.d), columns.iq.push(i.q));
//!     columns.omega_e.push(400.0);
//! }
//! let answer = identify(&Log::new(columns)?, &Request::default())?;
//! println!("R_s: {:?} ohm, 95 % within {:?}: {}", answer.rs().value(), answer.rs().interval(), answer.rs().verdict.key());
//! # assert!((answer.rs().value().unwrap() - 0.958).abs() < 1e-3);
//! # Ok::<(), fluxfit::Error>(())
//! ```
//!
//! | | |
//! |---|---|
//! | [`identify`], [`Request`], [`Answer`] | the one call, what is asked, everything that comes back |
//! | [`validate`](fn@validate), [`Given`], [`Validation`] | given parameters against another log |
//! | [`Log`], [`Columns`] | what a drive recorded, checked on the way in |
//! | [`Motor`], [`Parameter`], [`frames`] | the motor's equations; the dq frame and its convention |
//! | [`Judgement`], [`Verdict`], [`Reason`], [`Remedy`], [`Warning`] | facts about an answer; each prints as an English sentence |
//! | `document` | the JSON documents of all that, where the feature `serde` is on |
//! | [`evidence`] | what an answer rests on: the fits, their uncertainty, what was tried |
//! | [`steady`], [`objective`], [`least_squares`], [`levenberg_marquardt`] | the methods, for those who compare them |
//! | [`optimizer`], [`study`], [`paper`] | swarms, many runs of them, and what the paper states |
//! | [`current_loop`] | the current controllers' gains for a wanted bandwidth |
//!
//! Results depend on the log, the request and the seed: not on files, clocks or the number of threads.

mod answer;
pub mod current_loop;
#[cfg(feature = "serde")]
pub mod document;
pub mod error;
pub mod evidence;
pub mod faults;
pub mod frames;
mod identification;
pub mod least_squares;
pub mod levenberg_marquardt;
pub mod log;
pub mod motor;
pub mod objective;
pub mod paper;
mod parallel;
mod quantization;
mod singular_values;
pub mod steady;
pub mod study;
pub mod validation;
mod words;

pub use answer::{Answer, HeldOut, identify, identify_with_progress, suspect_units};
pub use error::{Error, ErrorKind};
pub use fluxfit_optimize as optimizer;
pub use identification::{
    explain::{judgement::Judgement, remedy::Remedy, warning::Warning},
    judge::{reason::Reason, verdict::Verdict},
    nameplate::{Nameplate, Rating},
    prepare::model::Model,
    progress::{Progress, Step},
    request::{Known, Request, Swarm},
};
pub use log::{Columns, Log};
pub use motor::{Motor, Parameter};
pub use validation::{
    given::Given,
    validate::{Validation, validate},
};
