//! The JSON documents: what scripts read of an identification, a validation, a study and a simulation.
//!
//! Each document is a type that serde writes; its fields are the document's keys, in this order, and their comments are the
//! descriptions of its JSON Schema (`docs/schema`, feature `schema`). Fields are added, never renamed. What is not known is null, and so
//! is every number that is not finite.
//!
//! ```
//! # use fluxfit::{Columns, Log, Motor, Request, document::IdentificationDocument, frames::Dq, identify};
//! # let motor = Motor { rs: 0.958, ld: 5.25e-3, lq: 12e-3, psi_f: 0.1827 };
//! # let mut columns = Columns::default();
//! # for (k, (d, q)) in (0..200).map(|k| (k, if k < 100 { (0.0, 9.0) } else { (-2.0, 8.5) })) {
//! #     let u = motor.steady_voltage(Dq { d, q }, 400.0);
//! #     for (column, value) in [&mut columns.t, &mut columns.ud, &mut columns.uq, &mut columns.id, &mut columns.iq, &mut columns.omega_e]
//! #         .into_iter().zip([k as f64 * 1e-3, u.d, u.q, d, q, 400.0]) { column.push(value); }
//! # }
//! # let log = Log::new(columns)?;
//! let answer = identify(&log, &Request::default())?;
//! let json = serde_json::to_string_pretty(&answer)?;
//! assert_eq!(json, serde_json::to_string_pretty(&IdentificationDocument::of(&answer))?);
//! assert!(json.starts_with("{\n  \"schema\": \"fluxfit.identification/1\",\n  \"log\": {\n    \"rows\": 200,"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod by_key;
mod by_parameter;
mod channel;
mod characteristics;
mod convention;
mod current_loop;
mod diagnostics;
mod finite;
mod identification;
#[cfg(feature = "schema")]
mod keys;
mod log;
mod nuisance;
mod output_error;
mod saturation;
#[cfg(feature = "schema")]
mod schema;
mod steady;
mod study;
mod temperature;
mod truth;
mod validation;
mod warning;

pub use by_key::ByKey;
pub use by_parameter::{ByParameter, MotorWithCost};
pub use channel::PerChannel;
pub use characteristics::{CHARACTERISTICS, CharacteristicsDocument, EstimateEntry, InstrumentEntry, TableEntry};
pub use convention::{CandidateEntry, ColumnFactors, ConventionEntry, PatternEntry};
pub use current_loop::{AxisGains, CurrentLoopEntry, GainEntry};
pub use diagnostics::{Diagnostics, SystematicEntry};
pub use identification::{FitEntry, IDENTIFICATION, IdentificationDocument, ParameterEntry, SearchEntry};
pub use log::{LogDocument, OperatingPointEntry, SpikeEntry, ValidatedLogEntry};
pub use nuisance::{NuisanceEntries, NuisanceEntry, VoltageTimingEntry};
pub use output_error::{OutputErrorEntry, TermEntry, TimingEntry};
pub use saturation::{ApparentEntry, FluxEntry, IncrementalEntry, SaturationEntry};
#[cfg(feature = "schema")]
pub use schema::schema_of;
pub use steady::{ExcitationEntry, MisfitEntry, SteadyEntry};
pub use study::{ConvergenceEntry, CostAboveOptimum, MethodEntry, QuartileEntry, STUDY, StudyDocument};
pub use temperature::{ReferredEntry, TemperatureEntry};
pub use truth::{TRUTH, TruthDocument};
pub use validation::{ChannelEntry, DifferenceEntry, LimitsEntry, TestEntry, VALIDATION, ValidationDocument};
pub use warning::{CountedEntry, UnseenEntry, WarningEntry};

/// The name and the schema of each document of this crate.
#[cfg(feature = "schema")]
pub fn schemas() -> Vec<(&'static str, schemars::Schema)> {
    vec![
        (IDENTIFICATION, schema_of::<IdentificationDocument>()),
        (STUDY, schema_of::<StudyDocument>()),
        (VALIDATION, schema_of::<ValidationDocument>()),
        (CHARACTERISTICS, schema_of::<CharacteristicsDocument>()),
        (TRUTH, schema_of::<TruthDocument<()>>()),
    ]
}
