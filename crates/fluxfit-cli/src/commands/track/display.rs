//! What is told while a motor is followed, and at the end.

use super::{
    live::Courses,
    tracking::Tracking,
    value::{margin, shown},
};
use crate::terminal::{self, HEADING, table, wrapped};
use fluxfit::Parameter;
use fluxfit_track::{Thermometer, Tracker};
use fluxfit_units::significant;

/// How it is told.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Format {
    /// A table at the end; on a terminal, the courses while it runs.
    Table,
    Csv,
    Json,
}

/// Lines while it runs, and at the end.
#[derive(Debug)]
pub(super) struct Lines {
    format: Format,
    courses: Option<Courses>,
}

impl Lines {
    pub(super) fn new(format: Format) -> Self {
        Self { format, courses: (format == Format::Table && terminal::can_redraw()).then(Courses::new) }
    }

    /// The header.
    pub(super) fn begin(&self) -> std::io::Result<()> {
        if self.format != Format::Csv {
            return Ok(());
        }
        let mut header = "t".to_owned();
        for parameter in Parameter::ALL {
            let key = parameter.key();
            header += &format!(",{key},{key}_low,{key}_high,{key}_verdict");
        }
        row(&(header + ",winding_temperature,magnet_temperature\n"))
    }

    /// Tells what is known now.
    pub(super) fn show(&mut self, tracking: &Tracking, last: bool) -> std::io::Result<()> {
        match self.format {
            Format::Json => row(&(serde_json::to_string(&tracking.document(last))? + "\n")),
            Format::Csv => row(&csv(&tracking.tracker, tracking.thermometer.as_ref())),
            Format::Table => {
                if let Some(courses) = &mut self.courses {
                    courses.show(&tracking.tracker, last);
                }
                Ok(())
            }
        }
    }

    /// Tells the state at the end.
    pub(super) fn end(&mut self, name: &str, tracking: &Tracking) -> std::io::Result<()> {
        self.show(tracking, true)?;
        match self.format {
            Format::Table => terminal::print(&at_the_end(name, &tracking.tracker, tracking.thermometer.as_ref())),
            Format::Csv | Format::Json => Ok(()),
        }
    }
}

/// Prints a row of a stream, which ends where nobody reads it any more.
fn row(text: &str) -> std::io::Result<()> {
    terminal::stream(|out| out.write_all(text.as_bytes()))
}

fn csv(tracker: &Tracker, thermometer: Option<&Thermometer>) -> String {
    let number = |value: Option<f64>| value.map_or_else(String::new, |value| value.to_string());
    let parameters = tracker.parameters_or_nothing();
    let mut line = tracker.time().to_string();
    for tracked in &parameters {
        let [low, high] = tracked.interval().map_or([None; 2], |ends| ends.map(Some));
        line += &format!(",{},{},{},{}", number(tracked.value), number(low), number(high), tracked.verdict.key());
    }
    let told = thermometer.map(|thermometer| thermometer.read(&parameters));
    let winding = told.and_then(|told| told.winding).map(|(value, _)| value);
    let magnets = told.and_then(|told| told.magnets).map(|(value, _)| value);
    line + &format!(",{},{}\n", number(winding), number(magnets))
}

fn at_the_end(name: &str, tracker: &Tracker, thermometer: Option<&Thermometer>) -> String {
    let parameters = tracker.parameters_or_nothing();
    let (timing, is_settled) = tracker.timing();
    let settled = if is_settled { "" } else { ", which is not settled yet" };
    let about = format!(
        "{} rows to t = {} s; {}; voltages read as {}{settled}",
        tracker.rows(),
        significant(tracker.time(), 4),
        tracker.settings().method.label(),
        timing.key(),
    );
    let rows = Parameter::ALL.into_iter().zip(&parameters).map(|(parameter, tracked)| {
        let (value, unit) = shown(parameter, tracked);
        vec![parameter.symbol().to_owned(), value, unit, margin(tracked), tracked.verdict.to_string()]
    });
    let mut text = format!("{HEADING}{name}{HEADING:#}\n{}\n{}", wrapped("", &about), table(&["", "value", "", "95 %", "now"], 1, rows));
    let told = thermometer.map(|thermometer| thermometer.read(&parameters));
    let temperatures = [("winding", told.and_then(|told| told.winding)), ("magnets", told.and_then(|told| told.magnets))];
    for (what, (value, margin)) in temperatures.into_iter().filter_map(|(what, told)| Some((what, told?))) {
        text += &format!("\n{what}: {value:.1} ±{margin:.1} degC");
    }
    if text.ends_with('\n') { text } else { text + "\n" }
}
