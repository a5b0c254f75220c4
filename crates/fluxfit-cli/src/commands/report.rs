//! `--report FILE.html` and `--figures DIR`: what the verbs do about them. They are refused before anything is computed, and written
//! after the answer is printed.

use crate::{
    arguments::LogArguments,
    error::CommandError,
    interrupt, invocation, shell,
    terminal::{self, options},
};
use fluxfit_files::write_atomically;
use fluxfit_report::{FigureFile, Options, Origin};
use fluxfit_units::wording::one_line;
use std::{fs, path::Path};

/// Refuses a report where it would mix with the answer or destroy what is read.
pub(crate) fn check<'a>(arguments: &'a LogArguments, others_read: impl IntoIterator<Item = &'a Path>) -> Result<(), CommandError> {
    check_directory(arguments.figures.as_deref())?;
    let Some(path) = arguments.report.as_deref() else { return Ok(()) };
    let mut read = arguments.logs.iter().map(AsRef::as_ref).chain(arguments.motor.as_deref()).chain(others_read);
    // A report that does not exist yet is none of them.
    let mut is_one = |report: &Path| report.is_file() && read.any(|read| fs::canonicalize(read).is_ok_and(|read| read == report));
    if fs::canonicalize(path).is_ok_and(|report| is_one(&report)) {
        return Err(CommandError::Usage(format!("--report {}: this file is read; name another one", path.display())));
    }
    check_name(path)
}

/// Refuses standard output, and names of files that are no pages.
pub(crate) fn check_name(path: &Path) -> Result<(), CommandError> {
    if path.as_os_str() == "-" {
        return Err(CommandError::Usage("--report needs the name of a file: standard output is for the answer".to_owned()));
    }
    let extension = path.extension().map(|extension| extension.to_string_lossy().to_lowercase());
    if let Some(other) = extension.filter(|extension| !["html", "htm", "xhtml"].contains(&extension.as_str())) {
        let why = format!("--report writes an HTML page, not {}; name it .html, and print it from a browser", one_line(&other));
        return Err(CommandError::Usage(why));
    }
    Ok(())
}

/// Refuses a directory for figures that is something else.
pub(crate) fn check_directory(path: Option<&Path>) -> Result<(), CommandError> {
    let Some(path) = path else { return Ok(()) };
    let problem = match fs::metadata(path) {
        _ if path.as_os_str() == "-" => "standard output is for the answer",
        Ok(there) if !there.is_dir() => "this is a file",
        _ => return Ok(()),
    };
    Err(CommandError::Usage(format!("--figures {}: {problem}; name a directory", path.display())))
}

/// How the results can be made again.
pub(crate) fn origin(seed: u64) -> Origin {
    Origin { command: command(), version: env!("CARGO_PKG_VERSION").to_owned(), seed }
}

/// The options that the page states beside remedies and warnings, as the terminal does.
pub(crate) fn options() -> Options {
    Options { of_remedy: options::of_remedy, of_warning: options::of_warning }
}

/// Writes the report and the figures, as far as they are wanted, and says so.
pub(crate) fn write(
    report: Option<&Path>,
    page: impl FnOnce() -> String,
    directory: Option<&Path>,
    figures: impl FnOnce() -> Vec<FigureFile>,
) -> Result<(), CommandError> {
    if let Some(path) = report {
        interrupt::doing("writing the report");
        write_atomically(path, page().as_bytes())?;
        terminal::wrote("report", path);
    }
    if let Some(directory) = directory {
        interrupt::doing("drawing the figures");
        fs::create_dir_all(directory).map_err(|error| {
            CommandError::Usage(format!("--figures {}: {error}; name a directory that can be made", directory.display()))
        })?;
        for figure in figures() {
            let path = |ending: &str| directory.join(format!("{}.{ending}", figure.name));
            write_atomically(&path("svg"), figure.svg.as_bytes())?;
            write_atomically(&path("png"), &figure.png())?;
        }
        terminal::wrote("figures", directory);
    }
    Ok(())
}

/// The command line, as a shell takes it.
fn command() -> String {
    let arguments = invocation::words().iter().map(|argument| shell::word(argument));
    ["fluxfit".to_owned()].into_iter().chain(arguments).collect::<Vec<_>>().join(" ")
}
