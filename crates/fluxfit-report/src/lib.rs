//! Reports of a log, of a validation and of a fleet: one HTML file that opens offline, and its figures as SVG and PNG.
//!
//! The page loads nothing, and its one script makes no request; without scripts it has the same content. It is readable on a telephone, on
//! a wide screen, in a dark scheme and on paper. A parameter that is not identifiable has no number on it. The same input gives the same
//! bytes, except for the times of runs.
//!
//! ```
//! use fluxfit::{Columns, Log, Request, identify};
//! use fluxfit_report::{Options, Origin, Report, html};
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
//! let found = identify(&log, &Request::default())?.identification;
//! let origin = Origin { command: "fluxfit identify drive.csv".to_owned(), version: "0.2.0".to_owned(), seed: 1 };
//! let page = html(&Report {
//!     title: "drive.csv",
//!     log: &log,
//!     notes: &[],
//!     operating_points: found.operating_points(),
//!     identification: Some((&found, None)),
//!     held_out: None,
//!     study: None,
//!     online: None,
//!     json: None,
//!     options: Options::default(),
//!     origin: &origin,
//! });
//! assert!(page.starts_with("<!DOCTYPE html>"));
//! # Ok::<(), fluxfit::Error>(())
//! ```
//!
//! | file | concept |
//! |---|---|
//! | `report` | what a page is made from |
//! | `page` | the HTML document: summary, sections in order, each with its figures |
//! | `headline` | the summary below the heading |
//! | `section`, `sections` | a section; the list of all sections, one file each |
//! | `figure`, `figures` | a figure; the list of all figures, one file each |
//! | `figure_file` | figures as SVG and PNG files |
//! | `interactive` | the data of interactive figures, and the script that draws them |
//! | `drawing` | axes, plots, colours, conversion to SVG |
//! | `current_comparison`, `residual_correlation` | measured against modelled currents, and the autocorrelation of their differences |
//! | `row_times` | times of the rows of joined logs |
//! | `operating_point_uncertainty`, `judgement` | uncertainty of voltage residuals; questions to a judgement |
//! | `table`, `typography` | frames of tables; symbols, units and numbers |

mod current_comparison;
mod drawing;
mod figure;
mod figure_file;
mod figures;
mod headline;
mod interactive;
mod judgement;
mod operating_point_uncertainty;
mod page;
mod report;
mod residual_correlation;
mod row_times;
mod section;
mod sections;
mod table;
mod typography;

pub use drawing::size::Size;
pub use figure_file::{FigureFile, figures, fleet_figures, screen_figures, validation_figures};
pub use page::{fleet_html, html, validation_html};
pub use report::{FleetReport, Options, Origin, Report, ValidationReport};
