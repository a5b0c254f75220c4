//! What comes from files and arguments, and how an answer gets into one.
//!
//! The promise: whatever is read is either understood, in SI units, or refused in one sentence on one line that names the file,
//! the line and the column where there is one, and the remedy. What had to be inferred on the way is said in notes. No input
//! makes a function of this crate panic.
//!
//! ```
//! use fluxfit_files::{LogOptions, parse_log, parse_map};
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
//! | `csv` | a table of text, whatever its dialect |
//! | [`mod@unit`] | units of a log's columns: given, or named by the header |
//! | [`quantity`] | numbers with units, as people write them |
//! | [`number`] | numbers with units, as people read them |
//! | [`argument`] | `key=value` arguments |
//! | [`motor_file`] | `MOTOR.toml` |
//! | [`given_motor`] | a motor of which everything is known |
//! | [`scenario_file`] | `SCENARIO.toml` |
//! | [`recording`] | a simulated log as CSV |
//! | [`truth`] | the true parameters of a simulated log |
//! | [`mod@export`] | an answer as the file that another tool takes |
//! | [`output`] | writing whole files only |
//! | [`error`] | the sentence |
//! | `channel`, `input`, `toml_table`, `wording` | what a log's columns are called; bytes and text; TOML; lists and quotations |

pub mod argument;
mod channel;
mod container;
mod csv;
pub mod error;
pub mod export;
pub mod given_motor;
mod input;
pub mod motor_file;
pub mod number;
pub mod output;
pub mod quantity;
pub mod reading;
pub mod recording;
pub mod scenario_file;
mod toml_table;
pub mod truth;
pub mod unit;
mod wording;

pub use argument::{parse_bounds, parse_export, parse_fix, parse_frequency, parse_map, parse_maps, parse_prior, parse_unit, parse_window};
pub use error::FileError;
pub use given_motor::{GivenMotor, read_given_motor};
pub use motor_file::{MotorFile, Rating, read_motor};
pub use output::{Output, check_writable, discard_unfinished, is_replaceable, write_atomically};
pub use quantity::{Dimension, parse_quantity};
pub use reading::{
    LogOptions, ReadLog,
    inspect::{Inspection, inspect},
    layout::{LAYOUTS, Layout},
    mapping::{Mapping, read_mapping},
    parse_log, read_log, read_log_watched,
};
pub use recording::write_recording;
pub use scenario_file::{ReadScenario, paper_scenario, read_scenario};
pub use truth::{Truth, read_truth, truth_of, truth_path};
pub use unit::Unit;
