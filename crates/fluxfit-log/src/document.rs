//! The JSON document of an inspection: schema `fluxfit.inspection/1`.
//!
//! Its fields are the document's keys, in this order, and their comments are the descriptions of its JSON Schema (`docs/schema`, feature
//! `schema`). Fields are added, never renamed.

use crate::reading::{InspectedColumn, Inspection, ReadLog, column_findings};
use fluxfit::{ColumnFinding, SampleFinding, check_samples};
use serde::Serialize;

/// The name of this document.
pub const INSPECTION: &str = "fluxfit.inspection/1";

/// The document that `fluxfit inspect --json` prints: how a file is read. Fields are added in later versions, never renamed. What is not
/// known is null.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema), schemars(title = INSPECTION))]
#[non_exhaustive]
pub struct InspectionDocument {
    /// Name and version of this document.
    #[cfg_attr(feature = "schema", schemars(extend("const" = INSPECTION)))]
    pub schema: &'static str,
    /// The format of the file, in a few words.
    pub format: String,
    /// The recognized layout; null if the columns have other names.
    pub layout: Option<&'static str>,
    /// The columns of the file, in order.
    pub columns: Vec<ColumnEntry>,
    /// The log; null if the file cannot be read as one.
    pub log: Option<InspectedLogEntry>,
    /// The table of a test bench that the file is in place of a log: `open-circuit characteristic`; null if it is none.
    pub table: Option<&'static str>,
    /// What reading the log, or the table, inferred or repaired; one sentence each.
    pub notes: Vec<String>,
    /// What the columns contradict each other in, and samples that are no measurements; empty if there is nothing of that, or no log.
    pub findings: Vec<FindingEntry>,
    /// Why the file cannot be read as a log, in one sentence; null if it can, or if it is a table of a test bench.
    pub error: Option<String>,
}

/// A column of the file.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct ColumnEntry {
    /// Its name in the file.
    pub name: String,
    /// Its unit, as the file spells it.
    pub unit: Option<String>,
    /// The channel that it is read as; null if it is not read.
    pub channel: Option<&'static str>,
    /// The channel that it may be by its name, if it is not read; of a table of a test bench the quantity.
    pub resembles: Option<&'static str>,
    /// The unit in which it is read, or would be; null if it is not read and nothing states its unit.
    pub read_as: Option<&'static str>,
    /// Its smallest and largest number, as the file has them; null if it has no numbers, or if the file came through a pipe.
    pub range: Option<[f64; 2]>,
    /// Whether the file states that it is the time of the columns of its group.
    pub is_time: bool,
}

/// Something that the columns contradict each other in, or samples that are no measurements.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct FindingEntry {
    /// The name of its kind, such as `speed-unit`; it stays the same from version to version.
    pub code: &'static str,
    /// What it is, in one sentence.
    pub message: String,
}

/// The log that the file holds.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct InspectedLogEntry {
    /// Rows.
    pub rows: usize,
    /// Time covered, gaps left out, s.
    pub duration_s: f64,
    /// Time between two rows of the first segment, s.
    pub sample_period_s: Option<f64>,
    /// Gaps in time, in order. Nothing is computed across them.
    pub gaps: Vec<GapEntry>,
    /// Times across which nothing is computed because rows were left out, which the notes tell; the file has no gap there.
    pub left_out: Vec<GapEntry>,
    /// Whether channels were sampled at different instants and are interpolated; only steady operating points can be used then.
    pub interpolated: bool,
}

/// A gap in time.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct GapEntry {
    /// Time of the last row before it, s.
    pub t0: f64,
    /// Time of the first row after it, s.
    pub t1: f64,
}

impl InspectionDocument {
    /// The document of an inspection.
    pub fn of(inspection: &Inspection) -> Self {
        let read = inspection.log.as_ref();
        let of_table = || inspection.table.as_ref().map(|table| table.notes.as_slice());
        let notes = read.ok().map(|read| read.notes.as_slice()).or_else(of_table).unwrap_or_default();
        Self {
            schema: INSPECTION,
            format: inspection.kind.clone(),
            layout: inspection.layout.map(|layout| layout.name),
            columns: inspection.columns.iter().map(ColumnEntry::of).collect(),
            log: read.ok().map(InspectedLogEntry::of),
            table: inspection.table.as_ref().map(|read| read.table.label()),
            notes: notes.iter().map(|note| note.sentence.clone()).collect(),
            findings: read.map_or(Vec::new(), findings),
            error: read.err().filter(|_| inspection.table.is_none()).map(ToString::to_string),
        }
    }
}

fn findings(read: &ReadLog) -> Vec<FindingEntry> {
    let (columns, samples) = (column_findings(&read.log, &read.columns), check_samples(&read.log));
    columns.iter().map(FindingEntry::of).chain(samples.iter().map(FindingEntry::of_samples)).collect()
}

impl ColumnEntry {
    fn of(column: &InspectedColumn) -> Self {
        Self {
            name: column.header.clone(),
            unit: column.unit.clone(),
            channel: column.channel,
            resembles: column.resembles,
            read_as: column.read_as.map(|(name, _)| name),
            range: column.range,
            is_time: column.is_time,
        }
    }
}

impl FindingEntry {
    fn of(finding: &ColumnFinding) -> Self {
        Self { code: finding.code(), message: finding.to_string() }
    }

    fn of_samples(finding: &SampleFinding) -> Self {
        Self { code: finding.code(), message: finding.to_string() }
    }
}

impl InspectedLogEntry {
    fn of(read: &ReadLog) -> Self {
        let (log, segments) = (&read.log, read.log.segments());
        let entries = |breaks: Vec<(f64, f64)>| breaks.into_iter().map(|(t0, t1)| GapEntry { t0, t1 }).collect();
        Self {
            rows: log.rows(),
            duration_s: log.duration(),
            sample_period_s: segments.first().map(|segment| segment.sample_period),
            gaps: entries(read.breaks(true)),
            left_out: entries(read.breaks(false)),
            interpolated: log.is_interpolated(),
        }
    }
}

/// The name and the schema of each document of this crate.
#[cfg(feature = "schema")]
pub fn schemas() -> Vec<(&'static str, schemars::Schema)> {
    vec![(INSPECTION, fluxfit::document::schema_of::<InspectionDocument>())]
}
