//! Logs of drives, read.
//!
//! The promise: whatever is read is either understood, in SI units, or refused in one sentence on one line that names the file,
//! the line and the column where there is one, and the remedy. What had to be inferred on the way is said in notes. No input
//! makes a function of this crate panic.
//!
//! ```
//! use fluxfit_log::{LogOptions, parse_log, parse_map};
//!
//! let csv = b"t_ms;u_d;uq;id;iq;speed_rpm\n0;1,5;20;0;3;500\n1;1,5;20;0;3;500\n";
//! let map = vec![parse_map("ud=u_d")?, parse_map("omega=speed_rpm")?];
//! let options = LogOptions { map, pole_pairs: Some(4), ..LogOptions::default() };
//! let read = parse_log("drive.csv", csv, &options)?;
//! assert_eq!(read.log.columns().t, [0.0, 0.001]);
//! assert_eq!(read.notes[1], "omega_e: column 'speed_rpm' read as mechanical r/min with 4 pole pairs");
//! # Ok::<(), fluxfit_files::FileError>(())
//! ```
//!
//! | file | concept |
//! |---|---|
//! | [`reading`] | a log from a table: its layout, its columns, its repairs |
//! | [`argument`] | `column=value` arguments |
//! | `csv` | a table of text, whatever its dialect |
//! | `container` | tables that are not text |
//! | `block` | columns of a table, and blocks of their values |
//! | `channel` | what a log's columns are called |
//! | `problem` | what is wrong with a log |

pub mod argument;
mod block;
mod channel;
mod container;
mod csv;
mod problem;
pub mod reading;

pub use argument::{parse_map, parse_maps, parse_unit};
pub use reading::{
    LogOptions, ReadLog,
    inspect::{Inspection, inspect},
    layout::{LAYOUTS, Layout},
    mapping::{Mapping, read_mapping},
    parse_log, read_log, read_log_watched,
};
