//! What an export needs to know about a tool.

use super::{
    entry::{Entry, File},
    quantity::Quantity,
};
use fluxfit::{current_loop::CurrentLoop, motor::Parameter};
use fluxfit_units::significant;
use std::f64::consts::TAU;

/// A tool that takes the parameters of a motor.
pub(super) struct Tool {
    /// Short name, as in arguments.
    pub(super) key: &'static str,
    /// Name in a sentence.
    pub(super) name: &'static str,
    /// Parameters that its file has.
    pub(super) parameters: &'static [Parameter],
    /// The entry that needs the number of pole pairs; none if all entries are electrical.
    pub(super) needs_pole_pairs: Option<&'static str>,
    /// The content of its file.
    pub(super) file: fn(&ExportedMotor<'_>) -> File,
    /// The text of its file, from the comments and the entries.
    pub(super) text: fn(&[String], &[Entry]) -> String,
}

/// A motor that may be exported. Parameters that the tool does not take may be anything.
pub(super) struct ExportedMotor<'a> {
    pub(super) rs: Quantity,
    pub(super) ld: Quantity,
    pub(super) lq: Quantity,
    pub(super) psi_f: Quantity,
    /// Correlation of the errors of L_d and L_q.
    pub(super) correlation: f64,
    /// Number of pole pairs; zero if the tool does not need it.
    pub(super) pole_pairs: u32,
    pub(super) current_loop: Option<&'a CurrentLoop>,
}

impl ExportedMotor<'_> {
    /// Peak voltage between two terminals, V, that the magnet induces at one mechanical revolution per second.
    pub(super) fn line_to_line_peak_per_hz(&self) -> Quantity {
        self.psi_f.map(|psi_f| 3.0_f64.sqrt() * TAU * f64::from(self.pole_pairs) * psi_f)
    }
}

/// The remark on exported gains.
pub(super) fn gains_remark(current_loop: &CurrentLoop) -> String {
    format!(
        "Current controllers for a bandwidth of {} Hz, by pole cancellation: phase margin {:.0} degrees with 1.5 periods of delay at {} Hz.",
        significant(current_loop.bandwidth, 4),
        current_loop.phase_margin(),
        significant(current_loop.control_rate.value, 5),
    )
}
