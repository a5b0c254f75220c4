//! A log from a table, whatever format it came in.
//!
//! Everything that is inferred or repaired is reported in a note. Plausible but meaningless data are refused: a standardized file,
//! references in place of measured currents, a flux map.
//!
//! Angle and DC voltage are optional. Unless the user mapped them, nothing about them refuses a log: what cannot be read is left
//! out, with a note.

mod alias;
mod align;
mod axis_currents;
mod bench_columns;
mod bench_convention;
mod bench_units;
mod called;
mod channels;
mod characteristic;
mod chosen;
mod clock;
mod columns;
mod counts;
mod doubt;
mod duty;
mod even_time;
mod event_times;
mod finder;
mod gather;
mod inspect;
mod layout;
mod line_to_line;
mod lines;
mod live;
mod mapping;
mod mapping_template;
mod names;
mod options;
mod own_times;
mod phases;
mod plausibility;
mod polar;
mod power_meter;
mod proposal;
mod read;
mod repair;
mod resemblance;
mod rms;
mod rounded_time;
mod runs;
mod scaling;
mod scope_trace;
mod selection;
mod shaft_angle;
mod steady_points;
mod steady_test;
mod survey;
mod table;
mod turned_frame;
mod turning;
mod vocabulary;

pub(crate) use called::channel_called;
pub use characteristic::{read_characteristic, read_characteristic_among};
pub use inspect::{InspectedColumn, Inspection, inspect};
pub use layout::{LAYOUTS, Layout};
pub use live::LiveLog;
pub use mapping::{Mapping, Park, read_mapping};
pub use options::LogOptions;
pub use read::{
    ReadColumn, ReadLog, are_volts_written, column_findings, parse_log, read_log, read_log_from, read_log_with_progress, read_part,
    read_table,
};
pub use steady_test::ReadCharacteristic;
