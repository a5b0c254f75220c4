//! What fluxfit found, for people: one HTML file that opens offline, and its figures as SVG and PNG.
//!
//! The promise: nothing is loaded from anywhere, and the one script in it asks for nothing; without it the page says the same; it
//! reads on a telephone, on a wide screen, in the dark and on paper; a number without a meaning is not on it. The same input makes
//! the same bytes, times of runs apart.
//!
//! ```
//! use fluxfit::{Columns, Log, identify::{self, identify}};
//! use fluxfit_report::{Origin, Report, html};
//!
//! # let (n, omega) = (200, 400.0);
//! # let motor = fluxfit::paper::MOTOR;
//! # let mut columns = Columns::default();
//! # for (k, (d, q)) in (0..n).map(|k| (k, if k < n / 2 { (0.0, 9.0) } else { (-2.0, 8.5) })) {
//! #     let u = motor.steady_voltage(fluxfit::frames::Dq { d, q }, omega);
//! #     for (column, value) in [&mut columns.t, &mut columns.ud, &mut columns.uq, &mut columns.id, &mut columns.iq, &mut columns.omega_e]
//! #         .into_iter().zip([k as f64 * 1e-3, u.d, u.q, d, q, omega]) { column.push(value); }
//! # }
//! let log = Log::new(columns)?;
//! let settings = identify::Settings::default();
//! let found = identify(&log, &settings)?;
//! let origin = Origin { command: "fluxfit identify drive.csv".to_owned(), version: "0.1.0".to_owned(), seed: 1 };
//! let page = html(&Report {
//!     title: "drive.csv",
//!     log: &log,
//!     notes: &[],
//!     operating_points: found.operating_points(),
//!     identification: Some((&found, settings.method)),
//!     held_out: None,
//!     study: None,
//!     origin: &origin,
//! });
//! assert!(page.starts_with("<!DOCTYPE html>"));
//! # Ok::<(), fluxfit::Error>(())
//! ```
//!
//! | file | concept |
//! |---|---|
//! | `page` | the document: head, heading, sections in order |
//! | `answer` | the parameters, their intervals, verdicts, reasons and warnings |
//! | `currents` | measured against simulated currents; whether the residual is noise |
//! | `fit` | operating points, measured against fitted |
//! | `flux` | flux per operating point of a motor that saturates |
//! | `correlation` | how the parameters' errors hang together |
//! | `tried` | faults of the drive and readings of the voltages that were tried |
//! | `search` | the swarm's answer beside the exact one |
//! | `study`, `table_2` | the methods compared; estimates beside the paper's |
//! | `validation` | given parameters held against a log: a page of its own |
//! | `measured` | measured currents and a model's beside them |
//! | `interactive` | figures that answer to the pointer: their numbers, and the one script |
//! | `figures` | every figure as files of its own, SVG and PNG |
//! | `origin` | what was read, and how to make the page again |
//! | `frame` | what stands around figures and tables |
//! | `typography` | symbols, units and numbers as a page sets them |
//! | [`figure`] | every figure, as SVG |

mod answer;
mod correlation;
mod currents;
pub mod figure;
mod figures;
mod fit;
mod flux;
mod frame;
mod interactive;
mod measured;
mod origin;
mod page;
mod search;
mod study;
mod table_2;
mod tried;
mod typography;
mod validation;

use fluxfit::{
    identify::Identification,
    log::Log,
    optimizer::Method,
    steady::OperatingPoint,
    study::{MethodStudy, facts::StudyFacts},
    validate::Validation,
};

/// What is shown; what is `None` is left out.
#[derive(Debug, Clone, Copy)]
pub struct Report<'a> {
    /// Heading of the page, such as the log's name.
    pub title: &'a str,
    /// The log.
    pub log: &'a Log,
    /// What reading had to infer, or how the log was simulated: a sentence each.
    pub notes: &'a [String],
    /// The windows used: those of the identification, or those that the study's fitness sums over.
    pub operating_points: &'a [OperatingPoint],
    /// The answer, and the method of the swarm beside it.
    pub identification: Option<(&'a Identification, Option<Method>)>,
    /// What was held out of the identification, and how well the answer predicts it; `None` beside it, if it lacks a parameter.
    pub held_out: Option<(&'a Log, Option<&'a Validation>)>,
    /// What the methods have in common, and each method with the seconds that one of its runs took.
    pub study: Option<(&'a StudyFacts<'a>, &'a [(MethodStudy, f64)])>,
    /// Where the page comes from.
    pub origin: &'a Origin,
}

/// How to make the page again.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Origin {
    /// The command, as a shell takes it.
    pub command: String,
    /// Version of the program.
    pub version: String,
    /// Seed of all random numbers.
    pub seed: u64,
}

/// A validation to be shown.
#[derive(Debug, Clone, Copy)]
pub struct ValidationReport<'a> {
    /// Heading of the page, such as the log's name.
    pub title: &'a str,
    /// Name of the motor that is validated.
    pub motor: &'a str,
    /// The log.
    pub log: &'a Log,
    /// What reading had to infer: a sentence each.
    pub notes: &'a [String],
    /// What was found.
    pub found: &'a Validation,
    /// Where the page comes from.
    pub origin: &'a Origin,
}

pub use figures::{FigureFile, figures, validation_figures};

/// A validation as one HTML document.
pub fn validation_html(report: &ValidationReport) -> String {
    validation::document(report).into_string()
}

/// The report as one HTML document.
pub fn html(report: &Report) -> String {
    page::document(report).into_string()
}
