//! `--report FILE.html`: what the verbs do about it. The file is refused before anything is computed, and written after the
//! answer is printed.

use crate::{arguments::LogArguments, error::CommandError, interrupt, shell, terminal};
use fluxfit_files::write_atomically;
use fluxfit_report::Origin;
use std::{fs, path::Path};

/// Refuses a report where it would mix with the answer or destroy what is read.
pub(crate) fn check<'a>(arguments: &'a LogArguments, others_read: impl IntoIterator<Item = &'a Path>) -> Result<(), CommandError> {
    let Some(path) = arguments.report.as_deref() else { return Ok(()) };
    check_name(path)?;
    let read = arguments.logs.iter().map(AsRef::as_ref).chain(arguments.motor.as_deref()).chain(others_read);
    // A report that does not exist yet is none of them.
    let Ok(report) = fs::canonicalize(path) else { return Ok(()) };
    if read.into_iter().any(|read| fs::canonicalize(read).is_ok_and(|read| read == report && report.is_file())) {
        return Err(CommandError::Usage(format!("--report {}: this file is read; name another one", path.display())));
    }
    Ok(())
}

/// Refuses standard output.
pub(crate) fn check_name(path: &Path) -> Result<(), CommandError> {
    if path.as_os_str() == "-" {
        return Err(CommandError::Usage("--report needs the name of a file: standard output is for the answer".to_owned()));
    }
    Ok(())
}

/// Writes the report, if one is wanted, and says so.
pub(crate) fn write(path: Option<&Path>, seed: u64, report: impl FnOnce(&Origin) -> String) -> Result<(), CommandError> {
    let Some(path) = path else { return Ok(()) };
    let origin = Origin { command: command(), version: env!("CARGO_PKG_VERSION").to_owned(), seed };
    interrupt::doing("writing the report");
    write_atomically(path, report(&origin).as_bytes())?;
    terminal::wrote("report", path);
    Ok(())
}

/// The command line, as a shell takes it.
fn command() -> String {
    let arguments = std::env::args_os().skip(1).map(|argument| shell::word(&argument));
    ["fluxfit".to_owned()].into_iter().chain(arguments).collect::<Vec<_>>().join(" ")
}
