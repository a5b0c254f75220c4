//! Reading the logs of drives: text of any dialect, JSON, LVM, CAN frames, Parquet, MATLAB, HDF5 and MDF 4.
//!
//! A log is either understood, in SI units, or refused in one sentence on one line that names the file, the line and the column where
//! there is one, and what to do. Everything that was inferred or repaired is reported in a [`Note`]. No input makes a function of this
//! crate panic.
//!
//! ```
//! use fluxfit_log::{LogOptions, parse_log, parse_map};
//!
//! let csv = b"t_ms;u_d;uq;id;iq;speed_rpm\n0;1,5;20;0;3;500\n1;1,5;20;0;3;500\n";
//! let map = vec![parse_map("ud=u_d")?, parse_map("omega=speed_rpm")?];
//! let options = LogOptions { map, pole_pairs: Some(4), ..LogOptions::default() };
//! let read = parse_log("drive.csv", csv, &options)?;
//! assert_eq!(read.log.columns().t, [0.0, 0.001]);
//! assert_eq!(read.log.source().notes[1], "omega_e: column 'speed_rpm' read as mechanical r/min with 4 pole pairs");
//! # Ok::<(), fluxfit_files::FileError>(())
//! ```
//!
//! | file | concept |
//! |---|---|
//! | `reading` | from a table to a log: layout, columns, units, repairs |
//! | `csv` | tables of text |
//! | `records` | other logs of text: JSON, LVM, CAN frames |
//! | `container` | tables in other formats |
//! | `block` | columns of a table, and blocks of their values |
//! | `groups` | a table of many motors, cut into theirs |
//! | `file_part` | some rows of a table in a file |
//! | `memory_table` | a table that a program holds in memory |
//! | [`document`] | the JSON document of an inspection |
//! | `in_order` | work on all cores, with results in order |
//! | `channel` | the channels of a log and their names |
//! | `instant` | dates and times in tables of text |
//! | `header_unit` | units in the headers of columns |
//! | `argument` | arguments of the form `channel=value` |
//! | `note`, `problem` | what is reported: notes and errors |

mod argument;
mod block;
mod channel;
mod container;
mod csv;
pub mod document;
mod file_part;
mod groups;
mod header_unit;
mod in_order;
mod instant;
mod memory_table;
mod missing_columns;
mod note;
mod problem;
mod quantity;
mod reading;
mod records;
mod unclear_table;

pub use argument::{parse_map, parse_maps, parse_unit};
pub use container::{CONTAINERS, Container, guarded};
pub use file_part::FilePart;
pub use groups::{Group, GroupColumn, GroupRows, no_motor_names, no_motors_column, read_groups};
pub use memory_table::{MemoryColumn, MemoryTable, ReadRows};
pub use note::Note;
pub use reading::{
    InspectedColumn, Inspection, LAYOUTS, Layout, LiveLog, LogOptions, Mapping, Park, ReadCharacteristic, ReadColumn, ReadLog,
    are_volts_written, column_findings, inspect, parse_log, read_characteristic, read_characteristic_among, read_log, read_log_from,
    read_log_with_progress, read_mapping, read_part, read_table,
};
