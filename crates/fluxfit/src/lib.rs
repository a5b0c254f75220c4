//! Finds the electrical parameters of a permanent magnet synchronous motor from a log of its drive: stator resistance, two
//! inductances, magnet flux; each with an interval, and a plain word when the log cannot tell.
//!
//! ```
//! use fluxfit::{identify::{self, identify}, log::{Columns, Log}, motor::Parameter};
//!
//! # let (n, omega) = (200, 400.0);
//! # let motor = fluxfit::motor::Motor { rs: 0.958, ld: 5.25e-3, lq: 12e-3, psi_f: 0.1827 };
//! # let mut columns = Columns::default();
//! # for (k, (d, q)) in (0..n).map(|k| (k, if k < n / 2 { (0.0, 9.0) } else { (-2.0, 8.5) })) {
//! #     let u = motor.steady_voltage(fluxfit::frames::Dq { d, q }, omega);
//! #     for (column, value) in [&mut columns.t, &mut columns.ud, &mut columns.uq, &mut columns.id, &mut columns.iq, &mut columns.omega_e]
//! #         .into_iter().zip([k as f64 * 1e-3, u.d, u.q, d, q, omega]) { column.push(value); }
//! # }
//! # let Columns { t, ud, uq, id, iq, omega_e, .. } = columns;
//! let log = Log::new(Columns { t, ud, uq, id, iq, omega_e, ..Columns::default() })?;
//! let found = identify(&log, &identify::Settings::default())?;
//! let rs = found.parameter(Parameter::Rs);
//! println!("{:?} ohm, 95 % within {:?}: {}", rs.value(), rs.interval(), rs.verdict.key());
//! # assert!((rs.value().unwrap() - 0.958).abs() < 1e-3);
//! # Ok::<(), fluxfit::error::Error>(())
//! ```
//!
//! | room | what it knows |
//! |---|---|
//! | [`motor`], [`frames`] | the motor's equations; the dq frame and its convention |
//! | [`log`](mod@log) | what a drive recorded, checked on the way in |
//! | [`steady`] | operating points: windows, means, their covariance, the inverter's held vector |
//! | [`least_squares`] | the exact answer to linear fitness functions, merged block by block |
//! | [`objective`] | what is minimized: the paper's fitness (11); the output error of its Fig. 1 |
//! | [`levenberg_marquardt`] | the polish: from near a minimum of the output error into it |
//! | [`optimizer`] | who minimizes: tGFPA, FPA, LPSO, APSO; knows nothing of motors |
//! | [`identify`](mod@identify) | the main path: from a log to values, intervals, verdicts |
//! | [`current_loop`] | the current controllers' gains for a wanted bandwidth |
//! | [`validate`](mod@validate) | given parameters held against another log |
//! | [`study`] | many runs of many methods, as the paper compares them |
//! | [`document`] | the JSON documents of all that |
//! | [`paper`] | what the paper states: its motor, its rig, its results |
//! | [`error`] | the only error |
//!
//! Results depend on the log, the settings and the seed: not on files, clocks or the number of threads.

pub mod current_loop;
#[cfg(feature = "serde")]
pub mod document;
pub mod error;
pub mod frames;
pub mod identify;
pub mod least_squares;
pub mod levenberg_marquardt;
pub mod log;
pub mod motor;
pub mod objective;
pub mod optimizer;
pub mod paper;
mod resolution;
mod singular_values;
pub mod steady;
pub mod study;
pub mod validate;

pub use error::Error;
pub use identify::{Identification, identify, verdict::Verdict};
pub use log::{Columns, Log};
pub use motor::{Motor, Parameter};
pub use optimizer::{Method, Objective, Optimizer};
