//! The log: what a drive recorded, in SI units, checked on the way in.
//!
//! A [`Log`] always has equal columns, finite plausible numbers, increasing time, some current, some speed, and some voltage unless its
//! currents are those of a short circuit. Time may
//! jump: a jump ends a [segment](Log::segments), and nothing is ever computed across one. Several logs of one motor
//! [join](Log::join) into one. Single rows that no drive had are left out, as a gap: [`Log::spikes`].
//!
//! Whole columns become a log with [`Log::new`]; rows that arrive one by one or block by block with [`LogBuilder`].

mod builder;
mod checked;
mod columns;
mod segment;
mod short_circuit;
pub(crate) mod speed_lag;
mod spikes;
mod standstill;

pub use builder::{LogBuilder, check_values};
pub use checked::{Log, Source};
pub use columns::{Columns, Row};
pub(crate) use segment::CONTROL_RATE;
pub use segment::{Segment, without_gaps};
pub use spikes::{Spike, Spikes};
