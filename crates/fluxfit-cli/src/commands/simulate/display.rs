//! What was simulated, where it is, and what to do with it.

use crate::shell;
use crate::terminal::HEADING;
use fluxfit_drive::{Recording, Scenario};
use fluxfit_units::significant;
use std::{io::Write, path::Path};

/// Shows the files of a simulation.
pub(crate) fn show(name: &str, scenario: &Scenario, recording: &Recording, log: &Path, truth: Option<&Path>) -> std::io::Result<()> {
    let mut out = anstream::stdout().lock();
    let (rows, rate) = (recording.columns.t.len(), scenario.row_rate());
    writeln!(out, "{HEADING}{name}{HEADING:#}")?;
    writeln!(out, "{rows} rows at {:.1} kHz, {} s", rate * 1e-3, significant(scenario.duration, 3))?;
    let log = shell::word(log.as_os_str());
    writeln!(out, "\n  log    {log}")?;
    // What went to a device cannot be read again.
    if let Some(truth) = truth.map(|truth| shell::word(truth.as_os_str())) {
        writeln!(out, "  truth  {truth}\n\nNext: fluxfit identify {log}")?;
        if scenario.motor.constant_parameters().is_some() {
            writeln!(out, "      fluxfit compare {log} --truth {truth}")?;
        }
    }
    out.flush()
}
