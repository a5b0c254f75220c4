//! `fluxfit simulate`: a scenario to a log, and its truth beside it.

mod display;

use super::Status;
use crate::{
    error::CommandError,
    interrupt, json,
    terminal::{self, Progress},
};
use clap::Args;
use fluxfit_drive::{Recording, simulate};
use fluxfit_files::{Output, check_writable, is_replaceable};
use fluxfit_setup::{ReadScenario, paper_scenario, read_scenario, scenario_file::PAPER_RIG, truth_of, truth_path, write_recording};
use std::{
    fs,
    io::{self, Write},
    path::{Path, PathBuf},
};

#[derive(Debug, Args)]
#[command(override_usage = "fluxfit simulate [SCENARIO.toml] -o <LOG> [OPTIONS]\n       fluxfit simulate --template")]
pub(crate) struct Simulate {
    /// The scenario; - is standard input [default: the paper's rig]
    #[arg(value_name = "SCENARIO.toml")]
    scenario: Option<PathBuf>,
    /// The log, as CSV; - is standard output. The true parameters are written beside it: rig.truth.json for rig.csv
    #[arg(short, long, value_name = "LOG", required_unless_present = "template")]
    output: Option<PathBuf>,
    /// Seed of all noise [default: that of the scenario]
    // No larger than TOML can hold: with the truth's scenario the log can be made again.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(..=i64::MAX as u64))]
    seed: Option<u64>,
    /// Number of the noise realization; each is independent of the others
    #[arg(long, value_name = "K", default_value_t = 0)]
    draw: u64,
    /// Print the paper's rig as a scenario to start from; nothing is simulated
    #[arg(long, exclusive = true)]
    template: bool,
}

/// Rows between two movements of the progress bar.
const STRIDE: usize = 1024;

/// Runs the verb.
pub(crate) fn run(arguments: &Simulate) -> Result<Status, CommandError> {
    let Some(log) = arguments.output.as_deref() else {
        terminal::print(PAPER_RIG)?;
        return Ok(Status::Complete);
    };
    let read = read(arguments)?;
    let truth = is_replaceable(log).then(|| truth_path(log));
    for written in [Some(log), truth.as_deref()].into_iter().flatten() {
        refuse_to_overwrite([arguments.scenario.as_deref(), read.flux_map.as_deref()], written)?;
    }
    // Before the work, not after.
    [Some(log), truth.as_deref()].into_iter().flatten().try_for_each(check_writable)?;
    let recording = record(arguments, &read)?;
    if log.as_os_str() == "-" {
        interrupt::doing("writing the log");
        terminal::stream(|out| write_recording(out, &recording))?;
    } else {
        write(log, truth.as_deref(), &recording, &json::text(&truth_of(&read, arguments.draw))?)?;
        display::show(&name(arguments), &read.scenario, &recording, log, truth.as_deref())?;
    }
    Ok(Status::Complete)
}

fn read(arguments: &Simulate) -> Result<ReadScenario, CommandError> {
    let mut read = arguments.scenario.as_deref().map_or_else(paper_scenario, read_scenario)?;
    if let Some(seed) = arguments.seed {
        read.scenario.seed = seed;
        // The truth must lead to the same log again.
        read.document["seed"] = seed.into();
    }
    Ok(read)
}

/// A slip of the hand must not cost a scenario or a map.
fn refuse_to_overwrite(read: [Option<&Path>; 2], written: &Path) -> Result<(), CommandError> {
    let place = |path: &Path| fs::canonicalize(path).ok().filter(|path| path.is_file());
    let Some(place_written) = place(written) else { return Ok(()) };
    if read.into_iter().flatten().filter_map(place).any(|read| read == place_written) {
        return Err(CommandError::Usage(format!("{} is read, and would be overwritten; name another file with -o", written.display())));
    }
    Ok(())
}

fn record(arguments: &Simulate, read: &ReadScenario) -> Result<Recording, CommandError> {
    let progress = terminal::counting("simulating", read.scenario.rows());
    let mut done = 0;
    let recording = simulate(&read.scenario, arguments.draw, || {
        done += 1;
        if done % STRIDE == 0 {
            progress.add(STRIDE);
        }
    });
    recording.map_err(|error| CommandError::Simulation { scenario: name(arguments), error })
}

/// Both files or none: neither gets its name before both are on the disk, and no signal comes between.
fn write(log: &Path, truth: Option<&Path>, recording: &Recording, text: &str) -> Result<(), CommandError> {
    let mut outputs = Vec::new();
    if let Some(path) = truth {
        let mut output = Output::open(path)?;
        output.fill(|writer| writer.write_all(text.as_bytes()))?;
        outputs.push(output);
    }
    let mut output = Output::open(log)?;
    let progress = terminal::counting(&format!("writing {}", log.display()), recording.columns.t.len());
    output.fill(|writer| write_recording(&mut Lines { writer, written: 0, progress: &progress }, recording))?;
    outputs.push(output);
    progress.turn_to("writing to the disk");
    Ok(interrupt::gently(|| outputs.into_iter().try_for_each(Output::commit))?)
}

/// A writer that counts lines.
struct Lines<'a> {
    writer: &'a mut dyn Write,
    written: usize,
    progress: &'a Progress,
}

impl Write for Lines<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let count = self.writer.write(bytes)?;
        // A recording is written line by line.
        if bytes[..count].ends_with(b"\n") {
            self.written += 1;
            if self.written.is_multiple_of(STRIDE) {
                self.progress.add(STRIDE);
            }
        }
        Ok(count)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.writer.flush()
    }
}

/// What the scenario is called.
fn name(arguments: &Simulate) -> String {
    match arguments.scenario.as_deref() {
        None => "the paper's rig".to_owned(),
        Some(path) if path.as_os_str() == "-" => "standard input".to_owned(),
        Some(path) => path.display().to_string(),
    }
}
