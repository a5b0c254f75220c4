//! The log, as the documents describe it.

use crate::{
    log::{Log, Spike},
    steady::OperatingPoint,
};
use serde::Serialize;

/// The log that was identified from.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct LogDocument {
    /// Rows; of several logs together.
    pub rows: usize,
    /// Time covered, gaps left out, s.
    pub duration_s: f64,
    /// Segments between gaps in time; each log has at least one.
    pub segments: usize,
    /// Time between two rows of the first segment, s.
    pub sample_period_s: Option<f64>,
    /// Steady operating points; empty where there is none.
    pub operating_points: Vec<OperatingPointEntry>,
    /// Which column of the file was read as which quantity and in which unit; one sentence for each log.
    pub columns: Vec<String>,
    /// What reading the log inferred or repaired; one sentence each.
    pub notes: Vec<String>,
    /// Rows that were left out because no drive had their values; they do not count as rows.
    pub spikes: Vec<SpikeEntry>,
}

/// A short run of rows that were left out.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct SpikeEntry {
    /// The column with the value.
    pub column: &'static str,
    /// Number of the log, from 0, among those given.
    pub log: usize,
    /// First row that was left out, from 0, among the rows of that log.
    pub row: usize,
    /// Number of rows.
    pub rows: usize,
    /// Time of the row with the largest value, s.
    pub t: f64,
    /// That value, SI units.
    pub value: f64,
}

impl SpikeEntry {
    fn of(spike: &Spike) -> Self {
        let Spike { column, log, time, value, .. } = *spike;
        Self { column, log, row: spike.rows.start, rows: spike.rows.len(), t: time, value }
    }
}

impl LogDocument {
    pub(super) fn of(log: &Log, operating_points: &[OperatingPoint]) -> Self {
        Self {
            rows: log.rows(),
            duration_s: log.duration(),
            segments: log.segments().len(),
            sample_period_s: log.segments().first().map(|segment| segment.sample_period),
            operating_points: operating_points.iter().map(OperatingPointEntry::of).collect(),
            columns: log.source().columns.clone(),
            notes: log.source().notes.clone(),
            spikes: log.spikes().all().iter().map(SpikeEntry::of).collect(),
        }
    }
}

/// A stretch of rows with steady currents and speed, and its mean values.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct OperatingPointEntry {
    /// Time of the first row, s.
    pub t0: f64,
    /// Time of the last row, s.
    pub t1: f64,
    /// Rows.
    pub rows: usize,
    /// Current along d, A.
    pub id: f64,
    /// Current along q, A.
    pub iq: f64,
    /// Electrical speed, rad/s.
    pub omega_e: f64,
    /// Voltage along d, V.
    pub ud: f64,
    /// Voltage along q, V.
    pub uq: f64,
}

impl OperatingPointEntry {
    fn of(point: &OperatingPoint) -> Self {
        let (u, i) = (point.voltage(), point.current());
        Self { t0: point.time.0, t1: point.time.1, rows: point.rows.len(), id: i.d, iq: i.q, omega_e: point.omega_e(), ud: u.d, uq: u.q }
    }
}

/// The log that parameters were validated on.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct ValidatedLogEntry {
    /// Rows; of several logs together.
    pub rows: usize,
    /// Time covered, gaps left out, s.
    pub duration_s: f64,
    /// Segments between gaps in time.
    pub segments: usize,
}

impl ValidatedLogEntry {
    pub(super) fn of(log: &Log) -> Self {
        Self { rows: log.rows(), duration_s: log.duration(), segments: log.segments().len() }
    }
}
