//! Finds the electrical parameters of a permanent magnet synchronous motor from a log of its drive: stator resistance, two
//! inductances, magnet flux; each with a 95 % interval and a verdict, and where it is not well determined, the reason and a remedy.
//!
//! All quantities are in SI units, electrical (not mechanical) radians, and the amplitude-invariant dq frame: voltages, currents and flux
//! are peak values per phase, with d along the magnet and currents counted into the motor. [`frames`] has the transforms.
//!
//! ```
//! use fluxfit::{Columns, Log, Motor, Request, frames::Dq, identify};
//!
//! // A log of 300 rows at three operating points; yours comes from a drive.
//! let motor = Motor { rs: 0.958, ld: 5.25e-3, lq: 12e-3, psi_f: 0.1827 };
//! let mut columns = Columns::default();
//! for row in 0..300 {
//!     let i = [Dq { d: 0.0, q: 9.0 }, Dq { d: -2.0, q: 8.5 }, Dq { d: 0.0, q: 4.0 }][row / 100];
//!     let u = motor.steady_voltage(i, 400.0);
//!     columns.t.push(row as f64 * 1e-3);
//!     (columns.ud.push(u.d), columns.uq.push(u.q), columns.id.push(i.d), columns.iq.push(i.q));
//!     columns.omega_e.push(400.0);
//! }
//! let answer = identify(&Log::new(columns)?, &Request::default())?;
//! println!("R_s: {:?} ohm, 95 % within {:?}: {}", answer.rs().value(), answer.rs().interval(), answer.rs().verdict);
//! # assert!((answer.rs().value().unwrap() - 0.958).abs() < 1e-3);
//! # Ok::<(), fluxfit::Error>(())
//! ```
//!
//! | | |
//! |---|---|
//! | [`identify`], [`Request`], [`Answer`] | the one call, what is asked, everything that comes back |
//! | [`Known`], [`Nameplate`], [`Model`] | of a request: priors and fixed values, the data sheet, how the log is modelled |
//! | [`TimeWindow`], [`VoltageTiming`] | which part of the log is used; when its voltages act |
//! | [`validate`](fn@validate), [`Given`], [`Validation`] | given parameters against another log |
//! | [`Log`], [`Columns`], [`log::LogBuilder`] | what a drive recorded, checked on the way in: whole columns, or row by row |
//! | [`Motor`], [`Parameter`], [`frames`] | the motor's equations; the dq frame and its convention |
//! | [`Judgement`], [`Verdict`] | one parameter: value, interval and how well it is determined |
//! | [`Reason`], [`Remedy`], [`Warning`] | facts about an answer; each prints as an English sentence |
//! | [`Summary`], [`NextStep`] | the answer in a sentence, and the one thing to do next |
//! | [`Promised`], [`Measurement`], [`Place`], [`Also`] | of a remedy: what to measure, where, and what it would bring |
//! | [`IdentificationError`], [`Error`], [`ErrorKind`] | misuse, or data that is no log; what a log cannot tell is no error but a verdict |
//! | [`characteristics`] | tables of tests on a bench instead of a log: open and shorted terminals |
//! | [`check_columns`], [`ColumnFinding`], [`turned_frame`] | what the columns contradict each other in, before anything is fitted |
//! | [`check_samples`], [`SampleFinding`] | outliers and stale samples |
//! | [`Progress`], [`Step`] | a callback during the work, which can stop a search |
//! | `document` | the JSON documents of all that, where the feature `serde` is on |
//! | [`evidence`] | what an answer rests on: the fits, their uncertainty, what was tried |
//! | [`steady`], [`objective`], [`least_squares`], [`levenberg_marquardt`] | the methods, for those who compare them |
//! | [`faults`] | the drive's imperfections that are looked for: dead time, angle offset, current sensors, saturation |
//! | [`fleet`] | what the results of many motors say together: distributions, outliers, drift, causes |
//! | [`optimizer`], [`study`], [`paper`] | swarm optimizers, many runs of them, and what the paper states |
//! | [`current_loop`] | the current controllers' gains for a wanted bandwidth |
//!
//! Results depend on the log, the request and the seed: not on files, clocks or the number of threads.

mod answer;
pub mod characteristics;
pub mod column_check;
pub mod current_loop;
#[cfg(feature = "serde")]
pub mod document;
pub mod error;
pub mod evidence;
pub mod faults;
pub mod fleet;
pub mod frames;
mod identification;
mod lanes;
pub mod least_squares;
pub mod levenberg_marquardt;
pub mod log;
pub mod motor;
mod normal_matrix;
pub mod objective;
pub mod paper;
mod parallel;
mod quantization;
pub mod sample_check;
mod singular_values;
pub mod steady;
pub mod study;
pub mod validation;
mod words;

pub use answer::{Answer, HeldOut, IdentificationError, identify, identify_with_progress};
pub use column_check::{ColumnFinding, check_columns, turned_frame};
pub use error::{Error, ErrorKind};
pub use fluxfit_optimize as optimizer;
pub use identification::{
    explain::{
        judgement::Judgement,
        measurement::{Measurement, Place, Promised},
        remedy::{Also, Remedy},
        summary::{NextStep, Summary},
        temperature::{AtTemperature, REFERENCE_TEMPERATURE, Referred},
        unseen::{Counted, Unseen, UnseenError},
        warning::Warning,
    },
    judge::{reason::Reason, verdict::Verdict},
    nameplate::{Nameplate, Rating},
    prepare::model::Model,
    progress::{Progress, Step},
    request::{Known, Request, Swarm},
};
pub use log::{Columns, Log};
pub use motor::{Motor, Parameter};
pub use objective::acting_voltage::{MeansOf, VoltageFrame, VoltageTiming};
pub use sample_check::{SampleFinding, check_samples};
pub use steady::windows::TimeWindow;
pub use validation::{
    given::Given,
    validate::{Validation, validate},
};
