//! `fluxfit inspect`: what is understood of a log, before an answer hangs on it.

mod display;

use super::{Status, input, not_a_log};
use crate::{
    arguments::ColumnArguments,
    error::CommandError,
    json, shell,
    terminal::{self, mending, told::Told},
};
use clap::Args;
use fluxfit::check_samples;
use fluxfit_files::{check_writable, write_atomically};
use fluxfit_log::{Inspection, LogOptions, ReadCharacteristic, column_findings, document::InspectionDocument, inspect};
use std::{
    fs,
    path::{Path, PathBuf},
};

#[derive(Debug, Args)]
pub(crate) struct Inspect {
    /// The log; - is standard input
    #[arg(value_name = "LOG")]
    pub(crate) log: PathBuf,
    #[command(flatten)]
    pub(crate) columns: ColumnArguments,
    /// Print the result as one JSON document and nothing else
    #[arg(long, help_heading = "Output")]
    json: bool,
    /// Write a mapping file with the columns recognized, to be completed by hand
    #[arg(short, long, help_heading = "Output", value_name = "MAPPING.toml")]
    output: Option<PathBuf>,
}

/// Runs the verb.
pub(crate) fn run(arguments: &Inspect) -> Result<Status, CommandError> {
    if let Some(path) = arguments.output.as_deref() {
        check_output(path, arguments)?;
    }
    let options = input::options(&arguments.columns, None)?;
    let inspection = terminal::working("reading".to_owned(), || inspect(&arguments.log, &options));
    let inspection = not_a_log::or_what_it_is(inspection, &arguments.log)?;
    if inspection.is_table && arguments.output.is_some() {
        // With one that names columns of a log, the table would be read as a log.
        let name = input::name(&arguments.log);
        let sentence =
            format!("{name} is a table of a test bench, which takes no mapping file; leave -o out, and see what inspect says of it");
        return Err(CommandError::Usage(sentence));
    }
    if arguments.json {
        terminal::print(&json::text(&InspectionDocument::of(&inspection))?)?;
    } else if arguments.output.as_deref() != Some(Path::new("-")) {
        let name = input::name(&arguments.log);
        match &inspection.table {
            Some(read) => display::show_table(&name, &inspection, read, &command_for_table(arguments, &options, read))?,
            None => display::show(&name, &inspection, &findings(&inspection, options.pole_pairs), &samples(&inspection))?,
        }
    }
    if let Some(path) = arguments.output.as_deref() {
        write_atomically(path, mapping_file(&inspection.mapping(&options)).as_bytes())?;
        terminal::wrote("mapping", path);
    }
    match inspection.log {
        Err(error) if inspection.table.is_none() => Err(error.into()),
        _ => Ok(Status::Complete),
    }
}

/// What identifies from a table, to be pasted: of the options that read logs, two are for tables too.
fn command_for_table(arguments: &Inspect, options: &LogOptions, read: &ReadCharacteristic) -> String {
    // A name with a dash in front would be an option.
    let is_dashed = arguments.log.as_os_str().as_encoded_bytes().starts_with(b"-");
    let log = if is_dashed { Path::new(".").join(&arguments.log) } else { arguments.log.clone() };
    let pole_pairs = options.pole_pairs.or(options.mapping.pole_pairs).map(|pole_pairs| format!(" --pole-pairs {pole_pairs}"));
    let pairs = options.map.iter().map(|(quantity, header)| format!("{quantity}={header}")).collect::<Vec<_>>().join(",");
    let map = if pairs.is_empty() { String::new() } else { format!(" --map {}", shell::word(pairs.as_ref())) };
    let other = if read.table.needs_another() { " OPEN_CIRCUIT.csv" } else { "" };
    format!("fluxfit identify {}{other}{map}{}", shell::word(log.as_os_str()), pole_pairs.unwrap_or_default())
}

/// What the columns contradict each other in, with what mends it.
fn findings(inspection: &Inspection, pole_pairs: Option<u32>) -> Vec<Told> {
    let Ok(read) = &inspection.log else { return Vec::new() };
    column_findings(&read.log, &read.columns).iter().map(|finding| mending::told(finding, &read.columns, pole_pairs)).collect()
}

/// Outliers and stale samples.
fn samples(inspection: &Inspection) -> Vec<Told> {
    let Ok(read) = &inspection.log else { return Vec::new() };
    check_samples(&read.log).iter().map(Told::of_samples).collect()
}

/// The proposed mapping file, with the command that takes it.
fn mapping_file(mapping: &str) -> String {
    format!("# fluxfit identify LOG --mapping THIS_FILE\n{mapping}")
}

/// Refuses to write over what is read, or into the document.
fn check_output(path: &Path, arguments: &Inspect) -> Result<(), CommandError> {
    if arguments.json && path.as_os_str() == "-" {
        return Err(CommandError::Usage("--json and -o - both print on standard output; name a file for the mapping".to_owned()));
    }
    let place = |path: &Path| fs::canonicalize(path).ok().filter(|path| path.is_file());
    let read = [Some(arguments.log.as_path()), arguments.columns.mapping.as_deref()];
    if place(path).is_some_and(|written| read.into_iter().flatten().filter_map(place).any(|read| read == written)) {
        return Err(CommandError::Usage(format!("{} is read, and would be overwritten; name another file with -o", path.display())));
    }
    Ok(check_writable(path)?)
}
