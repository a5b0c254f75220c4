//! Simulation of a motor in a drive: from a scenario to a log with known true parameters.
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
//! | [`scenario`] | all settings of a simulation and what they require of each other; the paper's rig |
//! | [`schedule`] | references and loads over time |
//! | [`mod@drive`] | the simulation loop: sample, command, integrate |
//! | [`direction`] | cosine and sine of an angle, computed once for several vectors |
//! | [`plant`], [`flux_map`], [`harmonics`] | motor and mechanics in continuous time; measured saturation; harmonics of the magnets' flux |
//! | [`inverter`] | settings of the inverter; duty ratios to terminal voltages: modulation, dead time, voltage drops |
//! | [`control`] | current loop, speed loop, field weakening |
//! | [`sensors`] | settings of the sensors; noise, offsets, A/D converters, encoder |
//! | [`logging`] | what the drive writes of its samples: filters, decimation, means, columns |
//! | [`recording`] | the columns of the log |
//! | [`error`] | why a scenario is refused, or its simulation stops |
//!
//! The same scenario and noise stream give the same bits on any thread; streams are independent and can be simulated in parallel.

pub mod control;
pub mod direction;
pub mod drive;
pub mod error;
pub mod flux_map;
pub mod harmonics;
pub mod inverter;
pub mod logging;
mod machine;
pub mod plant;
mod range;
pub mod recording;
pub mod scenario;
pub mod schedule;
pub mod sensors;

pub use drive::{Drive, simulate};
pub use error::{Error, ErrorKind};
pub use flux_map::FluxMap;
pub use recording::Recording;
pub use scenario::Scenario;
