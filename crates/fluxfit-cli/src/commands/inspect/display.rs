//! What was understood of a file, to be checked at a glance: columns, units, ranges, rows, gaps, and the courses of the currents.

use crate::terminal::{self, BAD, DIM, GOOD, HEADING, frequency, plot, table, told::Told};
use fluxfit::log::Log;
use fluxfit_log::{InspectedColumn, Inspection, ReadCharacteristic, ReadLog};
use fluxfit_units::{significant, wording::shorten_name};

/// Most columns that are listed.
const LISTED: usize = 60;

/// Most gaps that are listed.
const GAPS: usize = 3;

/// Shows an inspection, what is wrong with it first; notes go to standard error.
pub(crate) fn show(name: &str, inspection: &Inspection, findings: &[Told], samples: &[Told]) -> std::io::Result<()> {
    let status = match (&inspection.log, findings.len()) {
        (Err(_), _) if inspection.is_table => {
            format!("{BAD}A table of a test bench, but nothing can be identified from it yet: the reason is below.{BAD:#}\n")
        }
        (Err(_), _) => format!("{BAD}Not a log yet: the reason is below.{BAD:#}\n"),
        (Ok(_), 0) if !samples.is_empty() => format!("{BAD}Readable, but some samples are no measurements.{BAD:#}\n"),
        (Ok(_), 0) => format!("{GOOD}Readable, and the columns agree with each other.{GOOD:#}\n"),
        (Ok(_), _) if findings.iter().all(|finding| !finding.refuses) => {
            format!("{BAD}Readable, but the voltages may be no volts.{BAD:#}\n")
        }
        (Ok(_), 1) => format!("{BAD}Readable, but the columns contradict each other.{BAD:#}\n"),
        (Ok(_), many) => format!("{BAD}Readable, but the columns contradict each other in {many} ways.{BAD:#}\n"),
    };
    terminal::print(&status)?;
    findings.iter().chain(samples).for_each(terminal::warn_of_columns);
    let layout = inspection.layout.map_or("a layout that is not known".to_owned(), |layout| format!("layout: {}", layout.name));
    let mut text = terminal::wrapped("", &format!("{HEADING}{name}{HEADING:#}: {}; {layout}", inspection.kind)) + "\n";
    let read = inspection.log.as_ref().ok();
    let log = read.map(|read| &read.log);
    text += &columns(inspection, log);
    if let Some((log, read)) = log.zip(read) {
        text += &format!("\n{}\n", rows(log, read));
        text += &format!("\n{}", plot::courses(log));
    } else {
        text += &format!("\n{}", plot::courses_of_columns(&candidates(inspection)));
    }
    terminal::print(&text)?;
    if let Ok(read) = &inspection.log {
        read.notes.iter().for_each(|note| terminal::note(&terminal::advice::with_options(&note.sentence, &note.advice)));
    }
    Ok(())
}

/// Shows a table of a test bench: its columns, what each is taken for, and the command that identifies from it, on a line of its own.
pub(crate) fn show_table(name: &str, inspection: &Inspection, read: &ReadCharacteristic, next: &str) -> std::io::Result<()> {
    let next_step = if read.table.needs_another() { "Next, with the open-circuit table of the same motor:" } else { "Next:" };
    let status = format!("A table of a test bench: {}. {next_step}", read.table.describe());
    let mut text = format!("{GOOD}{}{GOOD:#}\n    {next}\n\n", terminal::wrapped("", &status).trim_end());
    text += &format!("{}\n", terminal::wrapped("", &format!("{HEADING}{name}{HEADING:#}: {}", inspection.kind)));
    let rows = inspection.columns.iter().take(LISTED).map(|column| {
        let taken = read.columns.iter().find(|(_, header)| *header == column.header.trim()).map_or("-", |(quantity, _)| quantity);
        let of_range = column.range.map(range).unwrap_or_default();
        vec![shorten_name(&column.header), taken.to_owned(), of_range]
    });
    text += &table(&["column", "taken for", "range in the file"], 2, rows);
    terminal::print(&text)?;
    read.notes.iter().for_each(|note| terminal::note(&note.sentence));
    Ok(())
}

/// The columns of a file that is no log yet that are, or may be, channels of a motor: as they are in the file, over its rows.
fn candidates(inspection: &Inspection) -> Vec<(String, &[[f64; 2]])> {
    let of_column = |channel: &str| {
        let column = inspection.columns.iter().find(|column| column.channel.or(column.resembles) == Some(channel))?;
        let unit = column.read_as.map(|_| format!(", {}", unit(column, false))).unwrap_or_default();
        Some((format!("{channel} = {}{unit}", column.header), column.course.as_slice()))
    };
    PLOTTED.into_iter().filter_map(of_column).collect()
}

/// The channels that are plotted where they are found.
const PLOTTED: [&str; 11] = ["ud", "uq", "id", "iq", "ua", "ub", "ia", "ib", "omega_e", "theta_e", "u_dc"];

fn columns(inspection: &Inspection, log: Option<&Log>) -> String {
    let rows = inspection.columns.iter().take(LISTED).map(|column| {
        let taken = match (column.channel, column.resembles) {
            (Some(channel), _) => channel.to_owned(),
            (None, Some(channel)) => format!("{channel}?"),
            (None, None) => "-".to_owned(),
        };
        let of_log = || column.channel.zip(log).and_then(|(channel, log)| of_channel(log, channel));
        let range = column.range.or_else(of_log).map(range).unwrap_or_default();
        // A quantity of a table has the unit of its name.
        let unit = if inspection.is_table { column.unit.clone().unwrap_or_default() } else { unit(column, log.is_some()) };
        vec![shorten_name(&column.header), taken, unit, range]
    });
    let mut text = table(&["column", "taken for", "in", "range in the file"], 3, rows);
    if inspection.is_table {
        text += &format!("  {DIM}?: by its name and unit{DIM:#}\n");
    } else if inspection.columns.iter().any(|column| column.resembles.is_some()) {
        text += &format!("  {DIM}?: by its name. --map says that it is, or a mapping file: fluxfit inspect LOG -o MAPPING.toml{DIM:#}\n");
    }
    if inspection.columns.len() > LISTED {
        text += &format!("  {DIM}and {} more{DIM:#}\n", inspection.columns.len() - LISTED);
    }
    text
}

/// The unit of a column, and what of it is not stated.
fn unit(column: &InspectedColumn, is_read: bool) -> String {
    match column.read_as {
        Some((_, prose)) if is_read && column.channel.is_some() && !(column.is_unit_stated && column.is_rotation_stated) => {
            format!("{prose}, assumed")
        }
        Some((_, prose)) if !column.is_rotation_stated => format!("{}, elec. or mech.", prose.trim_start_matches("electrical ")),
        Some((_, prose)) => prose.to_owned(),
        None if column.channel.or(column.resembles).is_some() && column.share.is_none() => "not stated".to_owned(),
        None => column.unit.clone().unwrap_or_default(),
    }
}

/// Least and largest value of a channel, in SI: of what came through a pipe there is nothing else.
fn of_channel(log: &Log, channel: &str) -> Option<[f64; 2]> {
    let columns = log.columns();
    let (_, values) = columns.named().into_iter().chain(columns.optional()).find(|(name, _)| *name == channel)?;
    Some(values.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| [low.min(*value), high.max(*value)]))
}

fn range([low, high]: [f64; 2]) -> String {
    if low == high { significant(low, 4) } else { format!("{} .. {}", significant(low, 4), significant(high, 4)) }
}

/// Rows, rates and gaps, in a few lines.
fn rows(log: &Log, read: &ReadLog) -> String {
    let segments = log.segments();
    let rate = segments.first().map_or(String::new(), |segment| frequency(1.0 / segment.sample_period));
    let mut text = format!("{} rows at {rate}, {} s", log.rows(), significant(log.duration(), 4));
    let behind = |(end, start): (f64, f64)| format!("{} s behind t = {} s", significant(start - end, 3), significant(end, 6));
    let gaps: Vec<String> = read.breaks(true).into_iter().map(behind).collect();
    text += &match gaps.as_slice() {
        [] => ", without a gap".to_owned(),
        [one] => format!(", with a gap of {one}"),
        many if many.len() <= GAPS => format!(", with {} gaps: {}", many.len(), many.join("; ")),
        many => format!(", with {} gaps: {}; ..", many.len(), many[..GAPS].join("; ")),
    };
    text += &match read.breaks(false).len() {
        0 => String::new(),
        1 => "; rows left out in one place: see the notes".to_owned(),
        places => format!("; rows left out in {places} places: see the notes"),
    };
    if log.is_interpolated() {
        text += &format!("\n{BAD}channels at different instants{BAD:#}: for steady operating points only");
    }
    text
}
