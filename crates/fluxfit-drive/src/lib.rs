//! A motor in a drive, simulated: from a scenario to a log whose truth is known.
//!
//! ```
//! use fluxfit_drive::{Scenario, simulate};
//!
//! let scenario = Scenario { duration: 0.05, ..Scenario::paper() };
//! let recording = simulate(&scenario, 0, || ())?;
//! assert_eq!(recording.columns.t.len(), 501);
//! # Ok::<(), fluxfit_drive::Error>(())
//! ```
//!
//! | file | concept |
//! |---|---|
//! | [`scenario`] | everything that a simulation depends on; the paper's rig |
//! | [`schedule`] | what is asked of the drive over time |
//! | [`mod@drive`] | sample, command, let the plant run |
//! | [`plant`], [`flux_map`] | motor and mechanics in continuous time; measured saturation |
//! | [`inverter`] | duties to terminal voltages: modulation, dead time, drops |
//! | [`control`] | current loop, speed loop, field weakening |
//! | [`sensors`] | noise, offsets, converters, encoder |
//! | [`recording`] | the log's columns |
//! | [`error`] | why a scenario is refused, or its drive trips |
//!
//! The same scenario and draw give the same bits on any machine thread; draws are independent, so that they may run in parallel.

pub mod control;
pub mod drive;
pub mod error;
pub mod flux_map;
pub mod inverter;
pub mod plant;
pub mod recording;
pub mod scenario;
pub mod schedule;
pub mod sensors;

pub use drive::{Drive, simulate};
pub use error::Error;
pub use flux_map::FluxMap;
pub use recording::Recording;
pub use scenario::Scenario;
