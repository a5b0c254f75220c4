//! The page of a fleet: the rows of its results as the library takes them, and what is written.

use super::row::Row;
use crate::{arguments::LogArguments, commands::report, error::CommandError};
use fluxfit::{
    Parameter, Verdict,
    fleet::{FleetEstimate, FleetOverview, FleetRow, FleetValue},
};
use fluxfit_report::{FleetReport, fleet_figures, fleet_html};
use fluxfit_units::wording::one_line;
use serde_json::Value;

/// What rows without a motor are called.
const NAMELESS: &str = "(no name)";

/// Writes the page and the figures, as far as they are wanted.
///
/// # Errors
/// If they cannot be written.
pub(super) fn write(title: &str, rows: &[Row], log: &LogArguments) -> Result<(), CommandError> {
    if log.report.is_none() && log.figures.is_none() {
        return Ok(());
    }
    let (overview, origin) = (overview(rows), report::origin(log.seed));
    let shown = FleetReport { title, fleet: &overview, origin: &origin };
    report::write(log.report.as_deref(), || fleet_html(&shown), log.figures.as_deref(), || fleet_figures(&shown))
}

fn overview(rows: &[Row]) -> FleetOverview {
    FleetOverview::of(rows.iter().map(fleet_row).collect())
}

fn fleet_row(row: &Row) -> FleetRow {
    let text = |name: &str| row.get(name).and_then(Value::as_str);
    let number = |name: &str| row.get(name).and_then(Value::as_f64).filter(|number| number.is_finite());
    let estimate = |parameter: Parameter| {
        let of = |end: &str| format!("{}{end}", parameter.key());
        let ends = number(&of("_low")).zip(number(&of("_high")));
        let value = number(&of("")).zip(ends).map(|(value, (low, high))| FleetValue { value, half_width: 0.5 * (high - low) });
        FleetEstimate {
            verdict: text(&of("_verdict")).and_then(Verdict::of_key).unwrap_or(Verdict::NotIdentifiable),
            value,
            reason: text(&of("_reason")).map(str::to_owned),
        }
    };
    FleetRow {
        motor: text("motor").filter(|name| !name.is_empty()).map_or_else(|| NAMELESS.to_owned(), one_line),
        source: text("source").unwrap_or_default().to_owned(),
        window_start: number("window_start"),
        estimates: Parameter::ALL.map(estimate),
        warnings: text("warnings").unwrap_or_default().split_whitespace().map(str::to_owned).collect(),
        error: text("error").map(str::to_owned),
    }
}
